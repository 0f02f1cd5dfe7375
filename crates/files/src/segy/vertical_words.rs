//! What a textual header says about the vertical axis, and how much each sentence weighs.
//!
//! A sentence about the axis itself (`TIME MIN 0`, `DOMAIN: DEPTH`, `OUTPUT IN TIME`) weighs more than the name of a
//! method (`PSDM`, `TIME MIGRATION`), and that more than a mention (`DEPTH`, `500 MS`). Depths of the acquisition
//! (`CABLE DEPTH 7 M`, `COMMON DEPTH POINT`), names of files and templates that offer both weigh nothing.

use crate::unit::ZUnit;
use crate::unit::words::{self, Quantity};

/// How much a sentence weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Weight {
    /// A word somewhere.
    Mention = 1,
    /// A method whose result usually is in that domain.
    Method,
    /// A statement about the axis.
    Axis,
}

/// A sentence, and its weight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Said {
    pub weight: Weight,
    pub quote: String,
}

/// The weightiest sentences of a textual header.
#[derive(Debug, Default)]
pub(super) struct Words {
    /// The unit that is said to be that of the axis (`Z UNITS: FEET`), or stands beside the number that is the sample
    /// interval.
    pub unit: Option<(ZUnit, String)>,
    /// Two sentences that say different units.
    pub contradiction: Option<[(ZUnit, String); 2]>,
    /// A length that is said to be a unit, and not of what.
    pub unowned: Option<(ZUnit, String)>,
    /// A length that is said to be the sample interval, and is not the file's.
    pub other_interval: Option<(f64, ZUnit, String)>,
    pub time: Option<Said>,
    pub depth: Option<Said>,
}

/// Words beside TIME or DEPTH that make it the vertical axis.
const AXIS: [&str; 12] =
    ["DOMAIN", "AXIS", "RANGE", "MIN", "MAX", "MINIMUM", "MAXIMUM", "SECTION", "STEP", "UNIT", "UNITS", "STRETCHED"];
/// Words before TIME or DEPTH that make it the domain of the result.
const INTO: [&str; 3] = ["IN", "TO", "INTO"];
/// What is measured in depth by those who acquire data.
const GEAR: [&str; 24] = [
    "WATER",
    "SOURCE",
    "SOURCES",
    "GUN",
    "GUNS",
    "AIRGUN",
    "CABLE",
    "STREAMER",
    "STREAMERS",
    "RECEIVER",
    "RECEIVERS",
    "HYDROPHONE",
    "TOW",
    "TOWING",
    "TOWED",
    "SHOT",
    "CHARGE",
    "HOLE",
    "UPHOLE",
    "SEABED",
    "TARGET",
    "WELL",
    "PENETRATION",
    "LAYBACK",
];

/// What has a length of its own, which may by chance be that between two samples.
const SPREAD: [&str; 11] =
    ["BIN", "BINS", "SPACING", "GROUP", "OFFSET", "GRID", "CDP", "CMP", "INLINE", "CROSSLINE", "SHOT"];

/// What a sample interval is called, and behind how many words after it its number stands at most.
const SAMPLING: [&str; 6] = ["SAMPLE INTERVAL", "SAMPLE RATE", "SAMPLING", "INCREMENT", "STEP", "RATE"];
const BEHIND: usize = 5;

impl Words {
    /// Reads the lines of a header; `interval` is the sample interval as the file holds it, in thousandths.
    pub(super) fn find<'a>(lines: impl Iterator<Item = &'a String>, interval: f64) -> Self {
        let mut found = Self::default();
        for line in lines {
            let upper = line.to_ascii_uppercase();
            let said: Vec<&str> = upper.split_whitespace().filter(|piece| !is_file_name(piece)).collect();
            let said = said.join(" ");
            // A template that offers both and was filled in says what is behind it.
            let filled = said.split_once([':', '=']).filter(|(template, _)| offers_both(&as_strs(&words(template))));
            let (said, is_answer) = filled.map_or((said.as_str(), false), |(_, answer)| (answer, true));
            let words = words(said);
            let words = as_strs(&words);
            let is_of_gear = words.iter().any(|word| GEAR.contains(word) || SPREAD.contains(word));
            for unit in units_of_axis(said, interval, is_of_gear) {
                let first = found.unit.get_or_insert_with(|| (unit, line.clone()));
                if first.0 != unit && found.contradiction.is_none() {
                    found.contradiction = Some([first.clone(), (unit, line.clone())]);
                }
            }
            if !is_of_gear {
                found.note_lengths(said, interval, line);
            }
            let is_only = |word: &str| is_answer && words.first() == Some(&word);
            let answer = |word: &str| is_only(word).then_some(Weight::Axis);
            note(&mut found.time, answer("TIME").or_else(|| time(&words)), line);
            note(&mut found.depth, answer("DEPTH").or_else(|| depth(&words)), line);
        }
        if found.contradiction.is_some() {
            found.unit = None;
        }
        found
    }

    /// Notes the lengths of a line that are no unit of the axis, but may be meant so.
    fn note_lengths(&mut self, said: &str, interval: f64, line: &str) {
        let lengths = |said: &str| words::statements(said).into_iter().filter(|said| !said.unit.is_time());
        if let Some(said) = lengths(said).find(|said| said.number.is_none() && said.quantity.is_none()) {
            self.unowned.get_or_insert_with(|| (axis_unit(said.unit), line.to_owned()));
        }
        let Some(said) = of_sampling(said).and_then(|said| lengths(&said).next()) else { return };
        let Some(number) = said.number else { return };
        if (number * to_thousandths(said.unit) - interval).abs() > 1e-6 * interval {
            self.other_interval.get_or_insert_with(|| (number, said.unit, line.to_owned()));
        }
    }
}

/// The few words that say how long the sample interval is; a range is none.
fn of_sampling(said: &str) -> Option<String> {
    let tail = SAMPLING.iter().find_map(|name| Some(&said[said.find(name)?..]))?;
    let tail = tail.split([',', ';']).next()?;
    let few: Vec<&str> = tail.split_whitespace().take_while(|word| *word != "AND").take(BEHIND).collect();
    (!few.contains(&"TO")).then(|| few.join(" "))
}

/// A line that gives the sample interval or the first sample, both as the file holds them in thousandths, without a unit:
/// in seconds.
pub(super) fn in_seconds<'a>(lines: impl Iterator<Item = &'a String>, interval: f64, start: f64) -> Option<Said> {
    let is = |number: f64, of_file: f64| of_file > 0.0 && (number * 1000.0 - of_file).abs() < 1e-6 * of_file;
    let tells = |line: &&String| {
        let upper = line.to_ascii_uppercase();
        let numbers = |from: &str| {
            let rest = upper.split_once(from)?.1.trim_start_matches(|c: char| !c.is_ascii_digit() && c != '.');
            let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(rest.len());
            crate::number::plain(&rest[..end])
        };
        numbers("FIRST SAMPLE").is_some_and(|number| is(number, start))
            || ["SAMPLE INTERVAL", "SAMPLE RATE", "Z STEP"]
                .iter()
                .any(|words| numbers(words).is_some_and(|number| is(number, interval)))
    };
    let mut lines = lines;
    lines.find(tells).map(|line| Said { weight: Weight::Method, quote: line.clone() })
}

/// The units that a line gives the axis: of the vertical axis by name, or beside the number that is the sample interval.
fn units_of_axis(line: &str, interval: f64, is_of_gear: bool) -> Vec<ZUnit> {
    let is_interval = |said: &words::Statement| {
        let number = said.number.map(|number| number * to_thousandths(said.unit));
        (said.unit.is_time() || !is_of_gear) && number.is_some_and(|number| (number - interval).abs() < 1e-6 * interval)
    };
    let is_of_axis = |said: &words::Statement| {
        let vertical = [Quantity::Depth, Quantity::Time, Quantity::Vertical];
        said.number.is_none() && !is_of_gear && said.quantity.is_some_and(|quantity| vertical.contains(&quantity))
    };
    let said = words::statements(line).into_iter().filter(|said| is_interval(said) || is_of_axis(said));
    said.map(|said| axis_unit(said.unit)).collect()
}

/// What a sample interval in a unit is multiplied by to be what the file holds, in ms, m or feet.
fn to_thousandths(unit: ZUnit) -> f64 {
    if matches!(unit, ZUnit::Feet | ZUnit::SurveyFeet | ZUnit::Inches) { 1.0 } else { unit.in_survey() }
}

/// The unit of an axis that text gives in a unit: SEG-Y holds thousandths of ms, m and feet.
fn axis_unit(unit: ZUnit) -> ZUnit {
    match unit {
        unit if unit.is_time() => ZUnit::Milliseconds,
        ZUnit::Feet | ZUnit::SurveyFeet => unit,
        ZUnit::Inches => ZUnit::Feet,
        ZUnit::Metres | ZUnit::Kilometres | ZUnit::Centimetres => ZUnit::Metres,
        _ => unit,
    }
}

fn note(best: &mut Option<Said>, weight: Option<Weight>, line: &str) {
    if let Some(weight) = weight
        && best.as_ref().is_none_or(|said| said.weight < weight)
    {
        *best = Some(Said { weight, quote: line.to_owned() });
    }
}

fn as_strs(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}

/// The words of a line; a number and its unit are two, also where nothing is between them (`4MS`).
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let pieces = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '.').map(|word| word.trim_matches('.'));
    for piece in pieces.filter(|piece| !piece.is_empty()) {
        let digits = piece.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(piece.len());
        let (number, unit) = piece.split_at(digits);
        if !number.is_empty() && unit_word(unit).is_some() {
            words.extend([number.to_owned(), unit.to_owned()]);
        } else {
            // Samples may be called depths or times.
            let plural = matches!(piece, "DEPTHS" | "TIMES");
            words.push(piece[..piece.len() - usize::from(plural)].to_owned());
        }
    }
    words
}

/// The word at a place, counted from another one.
fn beside<'a>(words: &[&'a str], index: usize, by: isize) -> &'a str {
    index.checked_add_signed(by).and_then(|index| words.get(index)).copied().unwrap_or("")
}

/// Whether a line offers both to whoever fills it in (`Trace start time/depth`).
fn offers_both(words: &[&str]) -> bool {
    let is_beside = |by: isize| {
        move |(index, word): (usize, &&str)| {
            word.starts_with("TIME") && (beside(words, index, by) == "DEPTH" || beside(words, index, 2 * by) == "DEPTH")
        }
    };
    words.iter().enumerate().any(is_beside(1)) || words.iter().enumerate().any(is_beside(-1))
}

/// Whether the word at a place is named as the axis by the words around it.
fn is_axis(words: &[&str], index: usize) -> bool {
    let [before, after] = [-1, 1].map(|by| beside(words, index, by));
    let is_in_unit = after == "IN" && unit_word(beside(words, index, 2)).is_some();
    AXIS.contains(&before)
        || AXIS.contains(&after)
        || INTO.contains(&before)
        || is_in_unit && !words.iter().any(|word| GEAR.contains(word))
        || matches!(before, "IS" | "ARE") && words.iter().any(|word| matches!(*word, "AXIS" | "SAMPLES"))
}

/// What a line says for time.
fn time(words: &[&str]) -> Option<Weight> {
    let template = offers_both(words);
    let weight = |(index, word): (usize, &&str)| {
        let [before, after] = [-1, 1].map(|by| beside(words, index, by));
        match *word {
            "TIME" | "TWT" | "TWTT" if !template && is_axis(words, index) => Some(Weight::Axis),
            "TWT" | "TWTT" | "PSTM" => Some(Weight::Method),
            "TIME" if !template && (after.starts_with("MIGRAT") || before == "WAY") => Some(Weight::Method),
            // A template that was not filled in has units without numbers.
            word if unit_word(word).is_some_and(ZUnit::is_time) && before.parse::<f64>().is_ok() => {
                Some(Weight::Mention)
            }
            _ => None,
        }
    };
    words.iter().enumerate().filter_map(weight).max()
}

/// What a line says for depth.
fn depth(words: &[&str]) -> Option<Weight> {
    let is_of_gear = words.iter().any(|word| GEAR.contains(word));
    let template = offers_both(words);
    let weight = |(index, word): (usize, &&str)| {
        let after = beside(words, index, 1);
        match *word {
            "TVD" | "TVDSS" | "PSDM" => Some(Weight::Method),
            "DEPTH" if template || after.starts_with("POINT") => None,
            "DEPTH" if is_axis(words, index) => Some(Weight::Axis),
            "DEPTH" if after.starts_with("MIGRAT") || after.starts_with("CONVER") || after == "STACK" => {
                Some(Weight::Method)
            }
            "DEPTH" if !is_of_gear => Some(Weight::Mention),
            _ => None,
        }
    };
    words.iter().enumerate().filter_map(weight).max()
}

/// Whether a piece of a line is the name of a file: it has an ending, or is of many parts.
fn is_file_name(piece: &str) -> bool {
    let piece = piece.trim_matches(|c: char| !c.is_ascii_alphanumeric());
    [".SGY", ".SEGY", ".SEG", ".VT", ".ZGY"].iter().any(|ending| piece.ends_with(ending))
        || piece.matches('_').count() >= 2
        || piece.contains(['/', '\\']) && piece.contains('.')
}

/// The unit that a word names.
fn unit_word(word: &str) -> Option<ZUnit> {
    ZUnit::parse(word).filter(|unit| *unit != ZUnit::Inches)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights(line: &str) -> [Option<Weight>; 2] {
        let words = Words::find([line.to_owned()].iter(), 4.0);
        [words.time, words.depth].map(|said| said.map(|said| said.weight))
    }

    #[test]
    fn sentences_weigh_by_what_they_are_about() {
        use Weight::{Axis, Mention, Method};
        for (line, expected) in [
            ("TIME MIN: 0 MAX: 4000", [Some(Axis), None]),
            ("VERTICAL DOMAIN: TIME (MS)", [Some(Axis), None]),
            ("Z-DOMAIN: DEPTH (M)", [None, Some(Axis)]),
            ("VERTICAL AXIS IS DEPTH", [None, Some(Axis)]),
            ("SAMPLES ARE DEPTHS BELOW SEA LEVEL", [None, Some(Axis)]),
            ("DEPTHS IN FEET", [None, Some(Axis)]),
            ("WATER DEPTHS IN FEET", [None, None]),
            ("TIMES IN MS", [Some(Axis), None]),
            ("STACKED 8 TIMES", [None, None]),
            ("KIRCHHOFF PSDM, STRETCHED BACK TO TWT", [Some(Axis), Some(Method)]),
            ("PRESTACK DEPTH MIGRATION", [None, Some(Method)]),
            ("OUTPUT IN TIME", [Some(Axis), None]),
            ("PRESTACK TIME MIGRATION", [Some(Method), None]),
            ("AGC 500 MS", [Some(Mention), None]),
            ("RECORD LENGTH 6 SECONDS", [Some(Mention), None]),
            ("FINAL VOLUME, DEPTH", [None, Some(Mention)]),
            // Of the acquisition, and of nothing at all.
            ("CABLE: LENGTH 6000 M, DEPTH 7 M", [None, None]),
            ("COMMON DEPTH POINT STACK", [None, None]),
            ("TARGET DEPTH 2500 M", [None, None]),
            ("TRACE START TIME/DEPTH", [None, None]),
            ("SAMPLE INTERVAL (TIME OR DEPTH)", [None, None]),
            ("TRACE START TIME/DEPTH: 0", [None, None]),
            // A template that was filled in.
            ("TIME/DEPTH : DEPTH", [None, Some(Axis)]),
            ("DOMAIN (TIME OR DEPTH) = TIME", [Some(Axis), None]),
            ("DATE 2011-01-01 TIME 12:00:00", [None, None]),
            ("/DATA/R2900_PSDM_FULL-T.SGY", [None, None]),
        ] {
            assert_eq!(weights(line), expected, "{line}");
        }
    }

    #[test]
    fn a_first_sample_or_an_interval_in_seconds_is_time() {
        let said = |line: &str| in_seconds([line.to_owned()].iter(), 4.0, 400.0).is_some();
        for line in [
            "First sample at: 0.4",
            "SAMPLE INTERVAL: 0.004",
            "Z step 0.004; first sample at 0.4",
            "Sample rate = .004",
        ] {
            assert!(said(line), "{line}");
        }
        for line in
            ["First sample at: 400", "SAMPLE INTERVAL: 4", "First trace 0.4", "Sample interval", "FIRST SAMPLE AT: 0.5"]
        {
            assert!(!said(line), "{line}");
        }
    }

    #[test]
    fn the_unit_beside_the_interval_is_found_however_it_is_written() {
        for (line, unit) in [
            ("SAMPLE INTERVAL 4 MS", ZUnit::Milliseconds),
            ("SAMPLE INTERVAL: 4MS", ZUnit::Milliseconds),
            ("SAMPLE RATE 4000 MICROSECONDS", ZUnit::Milliseconds),
            ("SAMPLE RATE: 0.004 S", ZUnit::Milliseconds),
            ("DEPTH STEP: 4.0m", ZUnit::Metres),
            ("STEP 4 FEET", ZUnit::Feet),
            ("Z UNITS: FEET", ZUnit::Feet),
            ("VERTICAL UNIT = METER", ZUnit::Metres),
            ("SAMPLING UNITS (MS)", ZUnit::Milliseconds),
            ("SAMPLES ARE DEPTHS IN FEET BELOW SEA LEVEL", ZUnit::Feet),
            ("DEPTH IN US SURVEY FEET", ZUnit::SurveyFeet),
            ("DEPTH UNITS: US SURVEY FEET, DATUM MSL", ZUnit::SurveyFeet),
            ("DEPTH VOLUME IN FEET", ZUnit::Feet),
            ("TVDSS (FEET)", ZUnit::Feet),
            ("Trace unit: ft", ZUnit::Feet),
            ("PROFONDEUR EN PIEDS", ZUnit::Feet),
            ("TIEFE IN METERN", ZUnit::Metres),
            ("INTERVALO 0,004 SEGUNDOS", ZUnit::Milliseconds),
        ] {
            let words = Words::find([line.to_owned()].iter(), 4.0);
            assert_eq!(words.unit.map(|(unit, _)| unit), Some(unit), "{line}");
        }
        for line in [
            "SURVEY ACQUIRED IN THE US",
            "VELOCITIES IN FEET PER SECOND",
            "SOURCE DEPTH 4 M",
            "BIN SIZE 4 M",
            "XY UNITS: M",
            "UNITS M",
            "WATER DEPTH UNIT: M",
            "WATER DEPTH IN M",
        ] {
            assert!(Words::find([line.to_owned()].iter(), 4.0).unit.is_none(), "{line}");
        }
        let both = Words::find(["4 MS".to_owned(), "4 M".to_owned()].iter(), 4.0);
        assert!(both.unit.is_none() && both.contradiction.is_some());
    }
}
