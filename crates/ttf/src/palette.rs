//! Default styles, so that a project can be rendered before any layer has a style.
//!
//! A layer with the name of a rock in its own name ("Zechstein salt", "Chalk Gp") gets the pattern of that rock. The
//! others take the patterns of a sequence in which neighbours differ in tone and in texture; so do layers that are
//! called after the horizons around them, since "above Top Chalk" and "Top Chalk - Base Chalk" are not the same rock.

use crate::{Colour, LayerStyle, LayerTtf, TextureLibrary};

/// Patterns of layers whose name contains no word of [`WORDS`], bottom to top.
const SEQUENCE: [&str; 8] =
    ["granite", "shale", "sandstone-bedded", "limestone", "siltstone", "dolostone", "marl", "sand"];

/// How words in the name of a layer begin, and the pattern of each. The first that is found decides.
const WORDS: [(&str, &str); 31] = [
    ("water", "water"),
    ("seawater", "water"),
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
        let by_name = WORDS.iter().find(|(word, _)| has_own_word(&lower, word)).map(|(_, pattern)| *pattern);
        let pattern = by_name.unwrap_or(SEQUENCE[index % SEQUENCE.len()]);
        match library.find(pattern) {
            Some(found) => LayerStyle::textured(layer, library.pattern(found).colour, pattern),
            None => LayerStyle::plain(layer, Colour::new(0xe6, 0xe0, 0xd2)),
        }
    }
}

/// Whether a word of a layer's own name, in small letters, begins so.
fn has_own_word(name: &str, beginning: &str) -> bool {
    let after_horizons = name.starts_with("above ") || name.starts_with("below ") || name.contains(" - ");
    let begins_word = |at: usize| !name[..at].ends_with(char::is_alphanumeric);
    // What lies on the sea floor is the sea.
    if ["above sea", "above water bottom"].iter().any(|sea| name.starts_with(sea)) {
        return beginning == "water";
    }
    !after_horizons && name.match_indices(beginning).any(|(at, _)| begins_word(at))
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
        assert_eq!(texture("Dolomitic marl", 3), "marl");
        assert_eq!(texture("Seawater", 3), "water");
        assert_eq!(texture("above Sea floor", 3), "water");
        // Not the rock of a name's middle, and not that of the horizons around a layer.
        assert_eq!(texture("Upper North Sea Group", 1), SEQUENCE[1]);
        assert_eq!(texture("Distilled", 1), SEQUENCE[1]);
        let generated = ["below Base Chalk", "Top Chalk - Base Chalk", "above Top Chalk"];
        let textures: Vec<String> = generated.iter().enumerate().map(|(index, name)| texture(name, index)).collect();
        assert_eq!(textures, SEQUENCE[..3]);
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
