//! From the name of a rock to a pattern.
//!
//! The names are the 265 terms of the CGI simple lithology vocabulary (`textures/rocks.tsv`, CC BY 4.0), in which each
//! term has broader ones. A term without a pattern of its own takes that of the nearest broader one. A name that is no
//! term is looked for among the patterns ("oolitic limestone" is `limestone-oolitic`), then among the other names that
//! terms have, among names in common use that the vocabulary lacks (`textures/rock-names.tsv`), and then by its last
//! words, where English has the rock ("dark grey shale" is a shale). What stands in brackets and a plural's s do not count.

use crate::similar::alike;
use std::collections::{BTreeSet, VecDeque};

/// The vocabulary: term, alternatives, broader terms, pattern.
const ROCKS: &str = include_str!("../../../textures/rocks.tsv");

/// Names in common use, and the terms or patterns that they stand for.
const COMMON: &str = include_str!("../../../textures/rock-names.tsv");

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

/// Names in common use, each with the term or the pattern that it stands for.
fn common() -> impl Iterator<Item = (&'static str, &'static str)> {
    COMMON.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once('\t'))
}

/// The names of rocks that are most like a name, best first; none where no name is like it.
///
/// ```
/// assert_eq!(ttf::rocks_like("sandston")[0], "sandstone");
/// ```
pub fn rocks_like(name: &str) -> Vec<&'static str> {
    alike(name, terms().map(|term| term.name).chain(common().map(|(name, _)| name)))
}

/// The words of a name, in lower case.
fn words(name: &str) -> Vec<String> {
    let parts = name.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty());
    parts.map(str::to_lowercase).collect()
}

/// The pattern of a rock among `patterns`, the names of those that there are; `None` of a name that is no rock's.
pub fn rock(name: &str, patterns: &[&str]) -> Option<RockPattern> {
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
    let in_common_use = |asked: &[String]| {
        let stands_for = common().find(|(name, _)| words(name) == asked).map(|(_, meant)| words(meant))?;
        named(&stands_for).or_else(|| of_pattern(&stands_for))
    };
    // A pattern says more than another name of a term: loess is drawn as loess, not as silt.
    let called = |asked: &[String]| {
        named(asked).or_else(|| of_pattern(asked)).or_else(|| also_called(asked)).or_else(|| in_common_use(asked))
    };
    let any_part = |asked: &[String]| (0..asked.len()).find_map(|from| called(&asked[from..]));
    let (whole, short) = (words(name), words(&without_brackets(name)));
    called(&whole).or_else(|| any_part(&short)).or_else(|| any_part(&singular(&short))).or_else(|| any_part(&whole))
}

/// A name without what stands in brackets.
fn without_brackets(name: &str) -> String {
    let mut depth = 0;
    let outside = name.chars().filter(|c| {
        depth += i32::from(*c == '(');
        let is_outside = depth <= 0;
        depth -= i32::from(*c == ')');
        is_outside
    });
    outside.collect()
}

/// The words with the last one in the singular.
fn singular(words: &[String]) -> Vec<String> {
    let mut words = words.to_vec();
    if let Some(last) = words.last_mut().filter(|last| last.ends_with('s')) {
        last.pop();
    }
    words
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
        let names: Vec<&str> = terms().map(|term| term.name).collect();
        let found: Vec<RockPattern> =
            names.iter().map(|term| rock(term, &patterns).unwrap_or_else(|| panic!("{term} has no pattern"))).collect();
        assert_eq!(found.len(), 265);
        assert!(terms().all(|term| term.pattern.is_empty() || patterns.contains(&term.pattern)));
        assert!(terms().all(|term| term.broader.iter().all(|name| names.contains(name))));
        assert!(found.iter().filter(|found| found.pattern == "plain").count() < 8);
    }

    #[test]
    fn identifiers_of_the_vocabulary_are_names_too() {
        for id in ["phonolilte", "high_magnesium_fine_grained_igneous_rocks", "alkali-olivine_basalt"] {
            assert!(rock(id, &["basalt", "dacite", "igneous"]).is_some(), "{id}");
        }
    }

    #[test]
    fn names_in_common_use_plurals_and_remarks_are_understood() {
        let library = TextureLibrary::builtin().unwrap();
        let patterns: Vec<&str> = library.patterns().map(|pattern| pattern.name.as_str()).collect();
        let of = |name: &str| rock(name, &patterns).map(|found| found.pattern);
        let lost: Vec<&str> = common().map(|(name, _)| name).filter(|name| of(name).is_none()).collect();
        assert!(lost.is_empty(), "{lost:?}");
        let is_term = |name: &&str| terms().any(|term| words(term.name) == words(name));
        let twice: Vec<&str> = common().map(|(name, _)| name).filter(is_term).collect();
        assert!(twice.is_empty(), "terms of the vocabulary: {twice:?}");
        let expected = [
            ("arkose", "sandstone-bedded"),
            ("Greywackes", "graywacke"),
            ("Sandstone (fine grained)", "sandstone-bedded"),
            ("black shales", "shale"),
            ("anhydrite", "gypsum"),
            ("halite", "salt"),
            ("dolerite", "basalt"),
            ("volcanic ash", "tuff"),
            ("coal seams", "coal"),
            ("limestone (cherty)", "limestone-cherty"),
            ("Marl (with sand)", "marl"),
            ("gneiss", "gneiss"),
        ];
        assert_eq!(expected.map(|(name, _)| of(name)), expected.map(|(_, pattern)| Some(pattern.to_owned())));
        assert_eq!(of("(granite)").as_deref(), Some("granite"));
        assert_eq!([of("Kalkstein"), of("()"), of("")], [None, None, None]);
        assert_eq!(rocks_like("sandston")[0], "sandstone");
        assert_eq!(rocks_like("Gneis")[0], "gneiss");
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
