//! From the name of a rock to a pattern.
//!
//! The names are the 265 terms of the CGI simple lithology vocabulary (`textures/rocks.tsv`, CC BY 4.0), in which each
//! term has broader ones. A term without a pattern of its own takes that of the nearest broader one. A name that is no
//! term is looked for among the patterns ("oolitic limestone" is `limestone-oolitic`), then among the other names that
//! terms have, and then by its last words, where English has the rock ("dark grey shale" is a shale).

use std::collections::{BTreeSet, VecDeque};

/// The vocabulary: term, alternatives, broader terms, pattern.
const ROCKS: &str = include_str!("../../../textures/rocks.tsv");

/// What a rock's name was found to mean.
///
/// ```
/// let found = |name: &str| ttf::rock(name, &["limestone", "limestone-oolitic", "shale", "basalt", "plain"]).unwrap();
/// assert_eq!(found("Limestone").pattern, "limestone");
/// assert_eq!(found("oolitic limestone").pattern, "limestone-oolitic");
/// // An olivine basalt is a basalt.
/// let olivine = found("alkali olivine basalt");
/// assert_eq!((olivine.pattern.as_str(), olivine.term.as_str()), ("basalt", "basalt"));
/// assert_eq!(found("dark grey shale").term, "shale");
/// assert!(ttf::rock("cheese", &["plain"]).is_none());
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RockPattern {
    /// The term or pattern that the name was taken for: itself, or a broader one.
    pub term: String,
    /// The name of the pattern.
    pub pattern: String,
}

/// A term of the vocabulary.
struct Term<'a> {
    name: &'a str,
    alternatives: Vec<&'a str>,
    broader: Vec<&'a str>,
    pattern: &'a str,
}

fn terms() -> impl Iterator<Item = Term<'static>> {
    ROCKS.lines().filter(|line| !line.starts_with('#')).map(|line| {
        let mut columns = line.split('\t');
        let mut next = || columns.next().unwrap_or_default();
        let several = |column: &'static str| column.split(';').filter(|name| !name.is_empty()).collect();
        let (name, alternatives, broader) = (next(), several(next()), several(next()));
        Term { name, alternatives, broader, pattern: next() }
    })
}

/// The names of all terms.
pub fn rock_terms() -> Vec<&'static str> {
    terms().map(|term| term.name).collect()
}

/// The words of a name, in lower case.
fn words(name: &str) -> Vec<String> {
    let parts = name.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty());
    parts.map(str::to_lowercase).collect()
}

/// The pattern of a rock among `patterns`, the names of those that there are; `None` of a name that is no rock's.
pub fn rock(name: &str, patterns: &[&str]) -> Option<RockPattern> {
    let asked = words(name);
    let known: Vec<Term> = terms().collect();
    let named = |asked: &[String]| {
        let found = known.iter().find(|term| words(term.name) == asked);
        found.and_then(|term| climbed(term, &known, patterns))
    };
    let of_pattern = |asked: &[String]| {
        let set = |words: &[String]| words.iter().cloned().collect::<BTreeSet<_>>();
        let found = patterns.iter().find(|pattern| set(&words(pattern)) == set(asked));
        found.map(|pattern| RockPattern { term: (*pattern).to_owned(), pattern: (*pattern).to_owned() })
    };
    let also_called = |asked: &[String]| {
        // Of terms that share an alternative the rocks come after the loose sediments.
        let is_also = |term: &&Term| term.alternatives.iter().any(|name| words(name) == asked);
        known.iter().rfind(is_also).and_then(|term| climbed(term, &known, patterns))
    };
    // A pattern says more than another name of a term: loess is drawn as loess, not as silt.
    let called = |asked: &[String]| named(asked).or_else(|| of_pattern(asked)).or_else(|| also_called(asked));
    (0..asked.len()).find_map(|from| called(&asked[from..]))
}

/// The pattern of a term or of the nearest broader one that has one.
fn climbed(term: &Term, known: &[Term], patterns: &[&str]) -> Option<RockPattern> {
    let mut open = VecDeque::from([term.name]);
    let mut seen = BTreeSet::new();
    while let Some(name) = open.pop_front() {
        let Some(term) = known.iter().find(|term| term.name == name).filter(|_| seen.insert(name)) else { continue };
        if patterns.contains(&term.pattern) {
            return Some(RockPattern { term: name.to_owned(), pattern: term.pattern.to_owned() });
        }
        open.extend(&term.broader);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TextureLibrary;

    #[test]
    fn every_term_has_a_pattern_of_the_library_and_most_are_not_plain() {
        let library = TextureLibrary::builtin().unwrap();
        let patterns: Vec<&str> = library.patterns().map(|pattern| pattern.name.as_str()).collect();
        let found: Vec<RockPattern> = rock_terms()
            .into_iter()
            .map(|term| rock(term, &patterns).unwrap_or_else(|| panic!("{term} has no pattern")))
            .collect();
        assert_eq!(found.len(), 265);
        assert!(terms().all(|term| term.pattern.is_empty() || patterns.contains(&term.pattern)));
        assert!(terms().all(|term| term.broader.iter().all(|name| rock_terms().contains(name))));
        assert!(found.iter().filter(|found| found.pattern == "plain").count() < 8);
    }

    #[test]
    fn identifiers_of_the_vocabulary_are_names_too() {
        for id in ["phonolilte", "high_magnesium_fine_grained_igneous_rocks", "alkali-olivine_basalt"] {
            assert!(rock(id, &["basalt", "dacite", "igneous"]).is_some(), "{id}");
        }
    }

    #[test]
    fn broader_terms_are_climbed_step_by_step() {
        let library = TextureLibrary::builtin().unwrap();
        let patterns: Vec<&str> = library.patterns().map(|pattern| pattern.name.as_str()).collect();
        let of = |name: &str| rock(name, &patterns).unwrap().pattern;
        let expected = [
            ("monzogranite", "granite"),
            ("bituminous coal", "coal"),
            ("mica schist", "schist"),
            ("boulder gravel size sediment", "gravel"),
            ("travertine", "limestone"),
            ("Marlstone", "marl"),
            ("rock salt", "salt"),
            ("foid bearing gabbro", "gabbro"),
            ("pyroxenite", "peridotite"),
            ("quartz latite", "dacite"),
            ("wacke", "graywacke"),
            ("migmatite", "gneiss-contorted"),
            ("obsidian or other glassy igneous rock", "vitrophyre"),
            ("loess", "loess"),
            ("red cross-bedded limestone", "limestone"),
            ("cherty dolostone", "dolostone-cherty"),
        ];
        assert_eq!(expected.map(|(name, _)| of(name)), expected.map(|(_, pattern)| pattern.to_owned()));
    }
}
