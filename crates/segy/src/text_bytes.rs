//! Where a textual header says that X and Y are stored.
//!
//! Exporters fill in sentences like `X COORDINATE: BYTES 73-76` or `CDP-X 181, CDP-Y 185`. A line counts when it
//! names an axis beside a number that a 4-byte field can start at; X and Y count when they are neighbours.

/// Words for an axis, without signs.
const X_WORDS: [&str; 8] = ["X", "XCOORD", "XCOORDINATE", "CDPX", "EASTING", "EASTINGS", "UTMX", "ENSEMBLEX"];
const Y_WORDS: [&str; 8] = ["Y", "YCOORD", "YCOORDINATE", "CDPY", "NORTHING", "NORTHINGS", "UTMY", "ENSEMBLEY"];
const LINE_WORDS: [&str; 7] = ["INLINE", "ILINE", "IL", "CROSSLINE", "XLINE", "XL", "TRACE"];
/// Coordinates of something else than the trace's place in the volume.
const OF_GEAR: [&str; 5] = ["SOURCE", "SHOT", "RECEIVER", "GROUP", "REC"];
/// Bytes of a field.
const FIELD: u16 = 4;

/// A part of a line.
#[derive(Clone, Copy, PartialEq)]
enum Word {
    X,
    Y,
    /// What else bytes are named for.
    Line,
    Byte(u16),
}

/// The first bytes of X and Y that the lines of a textual header name.
pub(super) fn coordinate_bytes<'a>(lines: impl Iterator<Item = &'a String>) -> Option<[u16; 2]> {
    let [mut x, mut y]: [Vec<u16>; 2] = Default::default();
    for line in lines {
        for (axis, byte) in named(&line.to_ascii_uppercase()) {
            if axis == Word::X { x.push(byte) } else { y.push(byte) }
        }
    }
    x.into_iter().find(|x| y.contains(&(x + FIELD))).map(|x| [x, x + FIELD])
}

/// The axes that a line names, each with its byte.
fn named(line: &str) -> Vec<(Word, u16)> {
    let tokens: Vec<&str> =
        line.split(|c: char| !c.is_ascii_alphanumeric()).filter(|token| !token.is_empty()).collect();
    if tokens.iter().any(|token| OF_GEAR.contains(token)) {
        return Vec::new();
    }
    // The number of the line itself (`C 5`, `C05`) is no byte.
    let numbered = match tokens[..] {
        [first, second, ..] if first == "C" && second.parse::<u16>().is_ok() => 2,
        [first, ..] if first.strip_prefix('C').is_some_and(|number| number.parse::<u16>().is_ok()) => 1,
        _ => 0,
    };
    let mut words: Vec<Word> = Vec::new();
    for (n, token) in tokens.iter().enumerate().skip(numbered) {
        // `CDP X` and `X COORDINATE` are two tokens of one name.
        let word = match token.parse::<u16>() {
            Ok(byte) if (1..=237).contains(&byte) && byte % FIELD == 1 => Some(Word::Byte(byte)),
            _ if X_WORDS.contains(token) => Some(Word::X),
            _ if Y_WORDS.contains(token) => Some(Word::Y),
            _ if LINE_WORDS.contains(token) => Some(Word::Line),
            _ => None,
        };
        // The last byte of a range is no first byte of a field, but that of two fields (`73-80`) may look like one.
        let ends_range = n > 0 && matches!(words.last(), Some(Word::Byte(first)) if tokens[n - 1] == first.to_string());
        words.extend(word.filter(|word| !(ends_range && matches!(word, Word::Byte(_)))));
    }
    let pairs = words.chunks_exact(2).filter_map(|pair| match pair {
        [axis @ (Word::X | Word::Y), Word::Byte(byte)] | [Word::Byte(byte), axis @ (Word::X | Word::Y)] => {
            Some((*axis, *byte))
        }
        _ => None,
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(lines: &[&str]) -> Option<[u16; 2]> {
        let lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        coordinate_bytes(lines.iter())
    }

    #[test]
    fn sentences_of_exporters_are_understood() {
        for (lines, found) in [
            (&["C 5 X COORDINATE: BYTES 73-76, Y COORDINATE: BYTES 77-80"][..], Some([73, 77])),
            (&["C10 X: byte 73", "C11 Y: byte 77"], Some([73, 77])),
            (&["C12 CDP-X (181-184)   CDP-Y (185-188)"], Some([181, 185])),
            (&["C13 BYTES 181-184: EASTING, 185-188: NORTHING"], Some([181, 185])),
            (&["C 5 INLINE 189-192, CROSSLINE 193-196, X 73-76, Y 77-80"], Some([73, 77])),
            (&["C 5 INLINE 189 X 73 Y 77"], Some([73, 77])),
            (&["C 8 CDP_X AT 81 CDP_Y AT 85"], Some([81, 85])),
            // Coordinates of the source are no place of a trace; numbers of lines are no bytes.
            (&["C 6 SOURCE X 73-76 SOURCE Y 77-80"], None),
            (&["C 1 X", "C 5 Y"], None),
            (&["C20 X MIN 600000 X MAX 610000", "C21 Y MIN 6073001"], None),
            (&["C 3 BIN GRID X 25 Y 25"], None),
            (&[""], None),
        ] {
            assert_eq!(bytes(lines), found, "{lines:?}");
        }
    }
}
