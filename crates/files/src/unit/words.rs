//! Reads units out of text: names of columns, comments, headers of SEG-Y, symbols in fields of their own.
//!
//! A text is cut into words; a unit is a whole word, or several (`US survey feet`), never a part of one. What a unit
//! belongs to is seen from what introduces it:
//!
//! ```text
//! statement   = quantity … "in" unit              DEPTH VOLUME IN FEET
//!             | quantity … "(" unit … ")"         TVDSS (FEET), z [usft]
//!             | quantity … "unit(s)" … unit       Unit in depth: ft, Trace unit: ft
//!             | quantity … unit "-UNITS"          DEPTH GIVEN IN ft-UNITS
//!             | quantity ":" unit                 VERTICAL: METRES
//!             | quantity "," unit                 VERTICAL AXIS: DEPTH, US-FT
//!             | number unit                       4 ms, 0,004 s
//! column      = quantity [preposition] unit       depth_ft, MD ft
//! unit        = [us | international] [survey] foot | a word of the table
//! ```
//!
//! The quantity is the last one named before the unit. A unit before `/` or `per` is a rate, and none of these. Words are
//! English, German, French, Spanish and Portuguese, in the singular and the plural.

use super::{Domain, ZUnit};

/// What a unit belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// A depth: along a well or below a datum.
    Depth,
    /// A time.
    Time,
    /// The vertical axis, whatever it is.
    Vertical,
    /// X and Y.
    Horizontal,
    /// Offsets to the east and the north.
    Offset,
    /// An angle, a velocity, a thickness …
    Other,
}

/// A unit as a text states it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Statement {
    /// What it belongs to, if the text says that.
    pub quantity: Option<Quantity>,
    pub unit: ZUnit,
    /// The number whose unit it is; none where it is the unit of all numbers of that kind.
    pub number: Option<f64>,
    /// The words.
    pub quote: String,
}

/// The words of each unit.
const UNITS: [(ZUnit, &str); 8] = [
    (ZUnit::Metres, "m mtr mtrs mts meter meters metre metres metern mètre mètres metro metros metri"),
    (
        ZUnit::Kilometres,
        "km kms kilometer kilometers kilometre kilometres kilometern kilomètre kilomètres kilometro \
         kilometros kilómetro kilómetros quilometro quilometros quilômetro quilômetros",
    ),
    (ZUnit::Centimetres, "cm centimeter centimeters centimetre centimetres"),
    (
        ZUnit::Milliseconds,
        "ms msec msecs mseg msek millisec millisecs millisecond milliseconds milliseconde millisecondes \
         millisekunde millisekunden milisegundo milisegundos milissegundo milissegundos",
    ),
    (ZUnit::Seconds, "s sec secs seg sek second seconds seconde secondes sekunde sekunden segundo segundos"),
    (
        ZUnit::Microseconds,
        "us µs μs usec usecs µsec μsec microsec microsecs microsecond microseconds microseconde microsecondes \
         mikrosekunde mikrosekunden microsegundo microsegundos microssegundo microssegundos",
    ),
    (ZUnit::SurveyFeet, "usft ftus ussft usfeet usfoot sft ftsurvey usftsurvey feetus footus usurvft"),
    (ZUnit::Inches, "in inch inches ins zoll pouce pouces pulgada pulgadas polegada polegadas"),
];

const FEET: &str = "ft fts feet foot ift fuß fuss pied pieds pie pies pé pés pes piedi fot feets";

/// The words of each quantity.
const QUANTITIES: [(Quantity, &str); 6] = [
    (
        Quantity::Depth,
        "depth depths md mdkb mdrkb mdrt tvd tvdkb tvdrkb tvdss tvdmsl tvdsd ssd subsea elevation elevations \
         elev dept tiefe tiefen teufe teufen profondeur profondeurs profundidad profundidades profundidade \
         profondità dyp",
    ),
    (
        Quantity::Time,
        "time times twt twtt owt owtt twtime zeit zeiten laufzeit laufzeiten temps tiempo tiempos tempo \
         tempos",
    ),
    (Quantity::Vertical, "z vertical vertically sample samples sampling interval trace vertikal verticale trc"),
    (
        Quantity::Horizontal,
        "x y xy easting eastings northing northings coordinate coordinates coord coords horizontal \
         horizontally map utm coordonnées koordinaten coordenadas",
    ),
    (Quantity::Offset, "dx dy ew ns dispew dispns"),
    (
        Quantity::Other,
        "velocity velocities slowness sonic thickness isochore isopach azimuth azimuths inclination angle \
         angles dip amplitude amplitudes gr density vitesse geschwindigkeit velocidad velocidade offset bin \
         bins cell cdp spacing",
    ),
];

/// Words that make what follows them a unit.
const PREPOSITIONS: &str = "in en em dans i as of";
const UNIT_WORDS: &str = "unit units einheit einheiten unité unités unidad unidade";

/// Whether a word is one of a list.
fn is_in(list: &str, word: &str) -> bool {
    list.split(' ').any(|one| one == word)
}

/// A word of a text, in lower case, and what stands between it and the one before.
struct Word {
    text: String,
    gap: String,
}

fn is_letter(c: char) -> bool {
    c.is_alphabetic() || c == 'µ'
}

/// The words of a text; a number and its unit are two, also where nothing is between them (`4MS`).
fn words(text: &str) -> (Vec<Word>, String) {
    let mut words: Vec<Word> = Vec::new();
    let (mut gap, mut chars) = (String::new(), text.chars().peekable());
    let mut last_is_letter = false;
    while let Some(c) = chars.next() {
        let mut word = String::new();
        let signed = matches!(c, '+' | '-' | '.') && chars.peek().is_some_and(char::is_ascii_digit);
        if c.is_ascii_digit() || signed && !last_is_letter {
            word.push(c);
            while let Some(&d) = chars.peek() {
                let in_number = d.is_ascii_digit() || matches!(d, '.' | ',' | '\'');
                if !in_number {
                    break;
                }
                word.push(d);
                chars.next();
            }
            let trimmed = word.trim_end_matches(['.', ',', '\'']).to_owned();
            words.push(Word { gap: std::mem::take(&mut gap), text: trimmed.clone() });
            gap.push_str(&word[trimmed.len()..]);
        } else if is_letter(c) {
            word.extend(c.to_lowercase());
            while let Some(&d) = chars.peek() {
                if !is_letter(d) {
                    break;
                }
                word.extend(d.to_lowercase());
                chars.next();
            }
            words.push(Word { text: word, gap: std::mem::take(&mut gap) });
        } else {
            gap.push(c);
        }
        last_is_letter = is_letter(c) || c.is_ascii_digit();
    }
    (words, gap)
}

/// The unit that begins at a word, and how many words it takes.
fn unit_at(words: &[&str]) -> Option<(ZUnit, usize)> {
    let survey = |word: &&str| matches!(*word, "survey" | "surv" | "svy");
    let american = match words {
        ["u", "s", ..] => 2,
        ["us" | "usa" | "american", ..] => 1,
        _ => 0,
    };
    let surveyed = usize::from(words.get(american).is_some_and(survey));
    let international =
        usize::from(american + surveyed == 0 && matches!(words.first(), Some(&("international" | "intl" | "int"))));
    let before = american + surveyed + international;
    if words.get(before).is_some_and(|word| is_in(FEET, word)) {
        let after = &words[before + 1..];
        let trailing = match after {
            ["us" | "usa", "survey" | "surv" | "svy", ..] => 2,
            ["us" | "usa" | "survey" | "surv" | "svy", ..] => 1,
            _ => 0,
        };
        let unit = if american + surveyed + trailing > 0 { ZUnit::SurveyFeet } else { ZUnit::Feet };
        return Some((unit, before + 1 + trailing));
    }
    let first = words.first()?;
    UNITS.iter().find(|(_, names)| is_in(names, first)).map(|(unit, _)| (*unit, 1))
}

/// The unit that a whole text is: `ft`, `[ms]`, `US survey feet`, `ft-UNITS`, `f`.
pub(crate) fn unit_of(text: &str) -> Option<ZUnit> {
    let (words, _) = words(text);
    let texts: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
    if texts == ["f"] {
        return Some(ZUnit::Feet);
    }
    if words.iter().skip(1).any(|word| word.gap.contains('/')) {
        return None;
    }
    let (unit, taken) = unit_at(&texts)?;
    let rest = &texts[taken..];
    let is_whole = rest.is_empty() || (rest.len() == 1 && is_in(UNIT_WORDS, rest[0]));
    (is_whole && (taken > 1 || !text.chars().any(|c| c.is_ascii_digit()))).then_some(unit)
}

/// A multiple of a unit, as LAS has it: `.1IN`, `0.1 in`, `FT`.
pub(crate) fn multiple_of(text: &str) -> Option<(f64, ZUnit)> {
    let (words, _) = words(text);
    match words.as_slice() {
        [number, unit] if number.text.parse::<f64>().is_ok() => Some((number.text.parse().ok()?, unit_of(&unit.text)?)),
        _ => Some((1.0, unit_of(text)?)),
    }
}

fn quantity_of(word: &str) -> Option<Quantity> {
    QUANTITIES.iter().find(|(_, names)| is_in(names, word)).map(|(quantity, _)| *quantity)
}

/// What introduces the unit at a word.
enum Introduction {
    Number(f64),
    Statement,
}

fn introduced(words: &[Word], at: usize, taken: usize, tail: &str) -> Option<Introduction> {
    let gap_after = words.get(at + taken).map_or(tail, |word| word.gap.as_str());
    let next = words.get(at + taken).map_or("", |word| word.text.as_str());
    // A rate: m/s, feet per second.
    if gap_after.trim_start().starts_with('/') || next == "per" || words[at].gap.trim_end().ends_with('/') {
        return None;
    }
    let gap = words[at].gap.as_str();
    let before = at.checked_sub(1).map(|n| &words[n])?;
    let in_bracket = gap.trim_end().ends_with(['(', '[', '{']);
    if let Some(number) = crate::number::of(&before.text) {
        let is_beside = gap.trim().is_empty() || in_bracket || gap.trim() == "-";
        return is_beside.then_some(Introduction::Number(number));
    }
    let said = in_bracket
        || (is_in(PREPOSITIONS, &before.text) && gap.trim().is_empty())
        || is_in(UNIT_WORDS, &before.text)
        || matches!((before.text.as_str(), at.checked_sub(2)), ("is" | "are" | "in", Some(n)) if is_in(UNIT_WORDS, &words[n].text))
        || (is_in(UNIT_WORDS, next) && matches!(gap_after, "-" | " "))
        || (gap.contains([':', '=']) && words[..at].iter().any(|word| is_in(UNIT_WORDS, &word.text)))
        || (gap.trim().starts_with([':', '=', ',']) && quantity_of(&before.text).is_some() && next.is_empty());
    said.then_some(Introduction::Statement)
}

/// Every unit that a line states.
pub(crate) fn statements(line: &str) -> Vec<Statement> {
    let (words, tail) = words(line);
    let texts: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        // Of a rate each side is a unit of its own.
        let end = (at + 1..words.len()).find(|&n| words[n].gap.contains('/')).unwrap_or(words.len());
        // "in" is a preposition here.
        let Some((unit, taken)) = unit_at(&texts[at..end]).filter(|_| texts[at] != "in") else {
            at += 1;
            continue;
        };
        if let Some(introduction) = introduced(&words, at, taken, &tail) {
            let quantity = texts[..at].iter().rev().find_map(|word| quantity_of(word));
            let number = match introduction {
                Introduction::Number(number) => Some(number),
                Introduction::Statement => None,
            };
            found.push(Statement { quantity, unit, number, quote: line.trim().to_owned() });
        }
        at += taken;
    }
    found
}

/// The parts of a column's name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ColumnName {
    /// Its words in lower case, joined by `_`, without type and unit.
    pub word: String,
    pub unit: Option<ZUnit>,
}

/// Types that Petrel writes before the name of a column.
const TYPES: &str = "int integer float double string bool discrete date";

/// Takes the name of a column apart: `Depth (ft)`, `z [usft]`, `twt_ms`, `INT,Inline`, `MD ft`, `TVDSS (ft MSL)`.
pub(crate) fn of_column(name: &str) -> ColumnName {
    let mut name = name.trim().trim_matches('"').trim();
    if let Some((kind, after)) = name.split_once(',')
        && is_in(TYPES, &kind.trim().to_ascii_lowercase())
    {
        name = after.trim();
    }
    let (stem, inside) = match name.find(['(', '[', '{']) {
        Some(open) => (&name[..open], Some(&name[open + 1..])),
        None => (name, None),
    };
    let bracketed = inside.and_then(|inside| {
        let inside = inside.split([')', ']', '}']).next().unwrap_or("");
        unit_of(inside).or_else(|| {
            // "ft MSL", "feet below sea level", and no "m/s".
            let (words, _) = words(inside);
            let texts: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
            let is_rate = inside.contains('/') || texts.contains(&"per");
            unit_at(&texts).filter(|_| !is_rate && texts.len() > 1).map(|(unit, _)| unit)
        })
    });
    let lower = stem.to_lowercase();
    let mut parts: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric() && c != 'µ').filter(|part| !part.is_empty()).collect();
    // The longest unit at the end; "in" there is a preposition or a name, and a name alone is no unit.
    let trailing = (1..parts.len()).find_map(|from| {
        let (unit, taken) = unit_at(&parts[from..])?;
        (from + taken == parts.len() && unit != ZUnit::Inches && !stem.contains('/')).then_some((unit, from))
    });
    if let Some((_, from)) = trailing {
        parts.truncate(from);
        if parts.len() > 1 && is_in(PREPOSITIONS, parts[parts.len() - 1]) {
            parts.pop();
        }
    }
    ColumnName { word: parts.join("_"), unit: bracketed.or(trailing.map(|(unit, _)| unit)) }
}

/// What the lines of a header state.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct HeaderUnits(Vec<Statement>);

impl HeaderUnits {
    /// Reads the lines of a header; comment marks are left out.
    pub(crate) fn of<'a>(lines: impl IntoIterator<Item = &'a str>) -> Self {
        let bare = |line: &'a str| line.trim_start_matches(['#', '!', '%', '/', '*', ' ', '\t']);
        Self(lines.into_iter().flat_map(|line| statements(bare(line))).filter(|said| said.number.is_none()).collect())
    }

    /// The first unit of one of these quantities, and another one that contradicts it.
    pub(crate) fn find(&self, wanted: &[Quantity]) -> Option<(&Statement, Option<&Statement>)> {
        let of = || self.0.iter().filter(|said| said.quantity.is_some_and(|quantity| wanted.contains(&quantity)));
        let first = of().next()?;
        Some((first, of().find(|other| other.unit != first.unit)))
    }

    /// The unit of the vertical axis, of time or depth as its name states, otherwise preferably as the survey's; and
    /// another one that contradicts it.
    pub(crate) fn vertical(
        &self,
        own: Option<Domain>,
        survey: Option<Domain>,
    ) -> Option<(&Statement, Option<&Statement>)> {
        let is_of = |domain: Domain| move |said: &&Statement| Domain::of_unit(said.unit) == domain;
        let all = || {
            let vertical = [Quantity::Depth, Quantity::Time, Quantity::Vertical];
            self.0.iter().filter(move |said| said.quantity.is_some_and(|quantity| vertical.contains(&quantity)))
        };
        let first = match (own, survey) {
            (Some(own), _) => all().find(is_of(own)),
            (None, Some(survey)) => all().find(is_of(survey)).or_else(|| all().next()),
            (None, None) => all().next(),
        }?;
        let domain = Domain::of_unit(first.unit);
        Some((first, all().filter(is_of(domain)).find(|other| other.unit != first.unit)))
    }
}

#[cfg(test)]
mod tests;
