//! Where a textual header says that line numbers, X and Y are stored.
//!
//! Exporters fill in sentences like `X COORDINATE: BYTES 73-76`, `CDP-X 181, CDP-Y 185` or `INLINE: BYTES 9-12`. A line
//! counts when it names an axis beside a number that a 4-byte field can start at; X and Y count when they are
//! neighbours, line numbers where the line speaks of bytes or gives both ends of a field (`INLINE 101-225` is a range of
//! lines).

/// Words for an axis, without signs.
const X_WORDS: [&str; 8] = ["X", "XCOORD", "XCOORDINATE", "CDPX", "EASTING", "EASTINGS", "UTMX", "ENSEMBLEX"];
const Y_WORDS: [&str; 8] = ["Y", "YCOORD", "YCOORDINATE", "CDPY", "NORTHING", "NORTHINGS", "UTMY", "ENSEMBLEY"];
const INLINE_WORDS: [&str; 4] = ["INLINE", "ILINE", "IL", "INLINENUMBER"];
const CROSSLINE_WORDS: [&str; 5] = ["CROSSLINE", "XLINE", "XL", "CROSSLINENUMBER", "XLINENUMBER"];
/// Coordinates of something else than the trace's place in the volume.
const OF_GEAR: [&str; 5] = ["SOURCE", "SHOT", "RECEIVER", "GROUP", "REC"];
/// Bytes of a field.
const FIELD: u16 = 4;

/// A part of a line.
#[derive(Clone, Copy, PartialEq)]
enum Word {
    X,
    Y,
    Inline,
    Crossline,
    /// What else bytes are named for.
    Other,
    /// The first byte of a field, and whether its last one follows.
    Byte(u16, bool),
}

/// The bytes that a textual header names.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct NamedBytes {
    /// First bytes of X and Y.
    pub coordinates: Option<[u16; 2]>,
    /// First bytes of inline and crossline numbers.
    pub lines: Option<[u16; 2]>,
}

impl NamedBytes {
    /// Reads the lines of a textual header.
    pub(super) fn find<'a>(lines: impl Iterator<Item = &'a String>) -> Self {
        let [mut x, mut y]: [Vec<u16>; 2] = Default::default();
        let [mut inline, mut crossline] = [None, None];
        for line in lines {
            let line = line.to_ascii_uppercase();
            let speaks_of_bytes = line.contains("BYTE");
            for (axis, byte, is_range) in named(&line) {
                let is_field = speaks_of_bytes || is_range;
                match axis {
                    Word::X => x.push(byte),
                    Word::Y => y.push(byte),
                    Word::Inline if is_field => inline = inline.or(Some(byte)),
                    Word::Crossline if is_field => crossline = crossline.or(Some(byte)),
                    _ => {}
                }
            }
        }
        Self {
            coordinates: x.into_iter().find(|x| y.contains(&(x + FIELD))).map(|x| [x, x + FIELD]),
            lines: inline.zip(crossline).filter(|(inline, crossline)| inline != crossline).map(|(i, x)| [i, x]),
        }
    }
}

/// The axes that a line names, each with its byte and whether that is the first of a range of four.
fn named(line: &str) -> Vec<(Word, u16, bool)> {
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
    for n in numbered..tokens.len() {
        let next = tokens.get(n + 1).copied().unwrap_or("");
        let is_line = next == "LINE";
        // `CDP X` and `X COORDINATE` are two tokens of one name.
        let word = match tokens[n].parse::<u16>() {
            Ok(byte) if (1..=237).contains(&byte) && byte % FIELD == 1 => {
                Some(Word::Byte(byte, next.parse() == Ok(byte + FIELD - 1)))
            }
            _ if INLINE_WORDS.contains(&tokens[n]) || tokens[n] == "IN" && is_line => Some(Word::Inline),
            _ if CROSSLINE_WORDS.contains(&tokens[n]) => Some(Word::Crossline),
            _ if ["X", "CROSS"].contains(&tokens[n]) && is_line => Some(Word::Crossline),
            _ if X_WORDS.contains(&tokens[n]) => Some(Word::X),
            _ if Y_WORDS.contains(&tokens[n]) => Some(Word::Y),
            _ if tokens[n] == "TRACE" && next != "HEADER" => Some(Word::Other),
            _ => None,
        };
        // The last byte of a range is no first byte of a field, but that of two fields (`73-80`) may look like one.
        let ends_range =
            n > 0 && matches!(words.last(), Some(Word::Byte(first, _)) if tokens[n - 1] == first.to_string());
        words.extend(word.filter(|word| !(ends_range && matches!(word, Word::Byte(..)))));
    }
    let pairs = words.chunks_exact(2).filter_map(|pair| match pair {
        [Word::Byte(..), Word::Byte(..)] => None,
        [axis, Word::Byte(byte, is_range)] | [Word::Byte(byte, is_range), axis] => Some((*axis, *byte, *is_range)),
        _ => None,
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(lines: &[&str]) -> Option<[u16; 2]> {
        let lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        NamedBytes::find(lines.iter()).coordinates
    }

    fn line_bytes(line: &str) -> Option<[u16; 2]> {
        NamedBytes::find([line.to_owned()].iter()).lines
    }

    #[test]
    fn bytes_of_line_numbers_are_understood_and_ranges_of_lines_are_not() {
        for (line, found) in [
            ("C 5 INLINE: BYTES 9-12, CROSSLINE: BYTES 21-24", Some([9, 21])),
            ("C 5 INLINE NUMBER BYTE 49   CROSSLINE NUMBER BYTE 57", Some([49, 57])),
            ("C 5 IN-LINE 189-192  X-LINE 193-196", Some([189, 193])),
            ("C 5 BYTES 193-196: IL, 189-192: XL", Some([193, 189])),
            ("C 5 INLINE: TRACE HEADER BYTE 5, XLINE: TRACE HEADER BYTE 25", Some([5, 25])),
            ("C 5 INLINE 101-225 CROSSLINE 201-305", None),
            ("C 5 INLINE 1, CROSSLINE 5", None),
            ("C 5 BYTES 189-192: INLINE", None),
        ] {
            assert_eq!(line_bytes(line), found, "{line}");
        }
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
