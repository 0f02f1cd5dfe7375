//! From the name of a unit of geological time to its colour on the international chart.

use crate::Colour;
use crate::similar::{alike, plain};

/// The chart: unit, rank, colour, base, top (`textures/ages.tsv`; International Commission on Stratigraphy, CC BY 4.0).
const AGES: &str = include_str!("../../../textures/ages.tsv");

/// A unit of the International Chronostratigraphic Chart.
///
/// ```
/// let age = ttf::age("upper cretaceous").unwrap();
/// assert_eq!((age.name, age.colour), ("Upper Cretaceous", ttf::Colour::new(0xa6, 0xd8, 0x4a)));
/// assert!(age.base_ma > age.top_ma);
/// assert!(ttf::age("Tuesday").is_none());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Age {
    /// Its name.
    pub name: &'static str,
    /// Its colour on the chart, sRGB.
    pub colour: Colour,
    /// When it began, million years ago.
    pub base_ma: f64,
    /// When it ended, million years ago.
    pub top_ma: f64,
}

/// All units in alphabetical order.
pub fn ages() -> impl Iterator<Item = Age> {
    AGES.lines().filter(|line| !line.starts_with('#')).filter_map(|line| {
        let columns: Vec<&'static str> = line.split('\t').collect();
        let [name, _, colour, base, top] = columns[..] else { return None };
        let colour = colour.parse().ok()?;
        Some(Age { name, colour, base_ma: base.parse().ok()?, top_ma: top.parse().ok()? })
    })
}

/// The unit of a name, in large or small letters; Early and Late stand for Lower and Upper.
pub fn age(name: &str) -> Option<Age> {
    let asked = plain(name);
    let formal = asked.strip_prefix("early").map(|rest| format!("lower{rest}"));
    let formal = formal.or_else(|| asked.strip_prefix("late").map(|rest| format!("upper{rest}")));
    ages().find(|age| plain(age.name) == asked || Some(plain(age.name)) == formal)
}

/// The names of units that are most like a name, best first; none where no name is like it.
pub(crate) fn ages_like(name: &str) -> Vec<&'static str> {
    alike(name, ages().map(|age| age.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chart_is_read_whole_and_units_are_found_however_they_are_written() {
        assert_eq!(ages().count(), AGES.lines().filter(|line| !line.starts_with('#')).count());
        assert!(ages().count() > 170 && ages().all(|age| age.base_ma > age.top_ma));
        let campanian = age("campanian").unwrap();
        assert!(campanian.base_ma > 72.0 && campanian.base_ma < 84.0);
        assert_eq!(age("Late Cretaceous"), age("Upper Cretaceous"));
        assert!(age("Late Cretaceous").is_some());
    }

    #[test]
    fn names_in_other_languages_and_misspelt_ones_are_like_units() {
        let best = |name: &str| ages_like(name).first().copied();
        let expected = [
            ("Campanien", "Campanian"),
            ("Kampanium", "Campanian"),
            ("Maastricht", "Maastrichtian"),
            ("upper cretacious", "Upper Cretaceous"),
            ("Cretácico", "Cretaceous"),
            ("Crétacé supérieur", "Cretaceous"),
            ("Oligocen", "Oligocene"),
            ("Oxfordium", "Oxfordian"),
            ("Late Campanian", "Campanian"),
            ("Mid Jurassic", "Middle Jurassic"),
        ];
        assert_eq!(expected.map(|(name, _)| best(name)), expected.map(|(_, unit)| Some(unit)));
        assert_eq!([best("xyzzy"), best(""), best("Tuesday")], [None; 3]);
        assert!(ages().all(|age| ages_like(age.name)[0] == age.name && ages_like(age.name).len() <= 3));
    }
}
