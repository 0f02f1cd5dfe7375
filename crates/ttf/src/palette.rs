//! Default styles, so that a project can be rendered before any layer has a style.
//!
//! A layer whose name contains the name of a rock ("Zechstein salt", "Chalk Gp") gets the pattern of that
//! rock. The others take the patterns of a sequence in which neighbours differ in tone and in texture.

use crate::{Colour, LayerStyle, LayerTtf, TextureLibrary};

/// Patterns of layers whose name contains no word of [`WORDS`], bottom to top.
const SEQUENCE: [&str; 8] =
    ["granite", "shale", "sandstone-bedded", "limestone", "siltstone", "dolostone", "marl", "sand"];

/// Words in the name of a layer, and the pattern of each. The first word that is found decides.
const WORDS: [(&str, &str); 31] = [
    ("water", "water"),
    ("sea", "water"),
    ("conglomerate", "conglomerate"),
    ("gravel", "conglomerate"),
    ("breccia", "breccia"),
    ("till", "till"),
    ("oil shale", "oil-shale"),
    ("black shale", "carbonaceous-shale"),
    ("marl", "marl"),
    ("chalk", "chalk"),
    ("chert", "chert"),
    ("flint", "chert"),
    ("dolo", "dolostone"),
    ("ooli", "limestone-oolitic"),
    ("limestone", "limestone"),
    ("carbonate", "limestone"),
    ("salt", "salt"),
    ("halite", "salt"),
    ("gypsum", "gypsum"),
    ("anhydrite", "gypsum"),
    ("coal", "coal"),
    ("silt", "siltstone"),
    ("shale", "shale"),
    ("clay", "shale"),
    ("mud", "shale"),
    ("sand", "sandstone-bedded"),
    ("basalt", "basalt"),
    ("tuff", "tuff"),
    ("schist", "schist"),
    ("gneiss", "gneiss"),
    ("basement", "granite"),
];

impl LayerTtf {
    /// The style that layer number `index` (counted from the bottom) has unless it is given one.
    ///
    /// ```
    /// use ttf::{LayerTtf, TextureLibrary};
    /// let style = LayerTtf::default_style("Zechstein salt", 3, &TextureLibrary::builtin().unwrap());
    /// assert_eq!(style.texture_at(0.5), Some("salt"));
    /// ```
    pub fn default_style(layer: &str, index: usize, library: &TextureLibrary) -> LayerStyle {
        let lower = layer.to_lowercase();
        let by_name = WORDS.iter().find(|(word, _)| lower.contains(word)).map(|(_, pattern)| *pattern);
        let pattern = by_name.unwrap_or(SEQUENCE[index % SEQUENCE.len()]);
        match library.find(pattern) {
            Some(found) => LayerStyle::textured(layer, library.pattern(found).colour, pattern),
            None => LayerStyle::plain(layer, Colour::new(0xe6, 0xe0, 0xd2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_and_every_turn_has_a_pattern() {
        let library = TextureLibrary::builtin().unwrap();
        for pattern in SEQUENCE.iter().chain(WORDS.iter().map(|(_, pattern)| pattern)) {
            assert!(library.find(pattern).is_some(), "{pattern}");
        }
    }

    #[test]
    fn a_telling_name_decides_and_others_take_turns() {
        let library = TextureLibrary::builtin().unwrap();
        let texture = |name: &str, index| LayerTtf::default_style(name, index, &library).intervals[0].texture.clone();
        assert_eq!(texture("Zechstein SALT", 3), "salt");
        assert_eq!(texture("Oil shale member", 3), "oil-shale");
        assert_eq!(texture("Unit 3", 2), SEQUENCE[2]);
        assert_eq!(texture("Unit 11", 10), SEQUENCE[2]);
    }

    #[test]
    fn neighbours_in_the_sequence_differ_in_greyscale() {
        let library = TextureLibrary::builtin().unwrap();
        let lightness = |name: &str| {
            let index = library.find(name).unwrap();
            let colour = library.pattern(index).colour.to_unit();
            let average = Colour::from_unit(library.texture(index).unwrap().average_over(colour, None));
            116.0 * average.luminance().cbrt() - 16.0
        };
        for (lower, upper) in SEQUENCE.iter().zip(SEQUENCE.iter().cycle().skip(1)) {
            let step = (lightness(lower) - lightness(upper)).abs();
            assert!(step >= 4.0, "{lower} and {upper}: {step}");
        }
    }
}
