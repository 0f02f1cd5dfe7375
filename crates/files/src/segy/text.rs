//! Textual headers: 40 lines of 80 characters in EBCDIC (code page 037) or ASCII.
//!
//! Code page 037 maps one to one onto Latin-1, so a table of 256 characters serves both directions.

use serde::Serialize;

/// Bytes of one textual header.
pub(super) const TEXT_BYTES: usize = 3200;

const LINE_CHARACTERS: usize = 80;

/// What closes a variable number of extended textual headers (revision 1).
const END_OF_TEXT: &str = "((SEG:ENDTEXT))";

/// Latin-1 character of each code page 037 byte.
const LATIN_1_FROM_EBCDIC: [u8; 256] = [
    0, 1, 2, 3, 156, 9, 134, 127, 151, 141, 142, 11, 12, 13, 14, 15, 16, 17, 18, 19, 157, 133, 8, 135, 24, 25, 146,
    143, 28, 29, 30, 31, 128, 129, 130, 131, 132, 10, 23, 27, 136, 137, 138, 139, 140, 5, 6, 7, 144, 145, 22, 147, 148,
    149, 150, 4, 152, 153, 154, 155, 20, 21, 158, 26, 32, 160, 226, 228, 224, 225, 227, 229, 231, 241, 162, 46, 60, 40,
    43, 124, 38, 233, 234, 235, 232, 237, 238, 239, 236, 223, 33, 36, 42, 41, 59, 172, 45, 47, 194, 196, 192, 193, 195,
    197, 199, 209, 166, 44, 37, 95, 62, 63, 248, 201, 202, 203, 200, 205, 206, 207, 204, 96, 58, 35, 64, 39, 61, 34,
    216, 97, 98, 99, 100, 101, 102, 103, 104, 105, 171, 187, 240, 253, 254, 177, 176, 106, 107, 108, 109, 110, 111,
    112, 113, 114, 170, 186, 230, 184, 198, 164, 181, 126, 115, 116, 117, 118, 119, 120, 121, 122, 161, 191, 208, 221,
    222, 174, 94, 163, 165, 183, 169, 167, 182, 188, 189, 190, 91, 93, 175, 168, 180, 215, 123, 65, 66, 67, 68, 69, 70,
    71, 72, 73, 173, 244, 246, 242, 243, 245, 125, 74, 75, 76, 77, 78, 79, 80, 81, 82, 185, 251, 252, 249, 250, 255,
    92, 247, 83, 84, 85, 86, 87, 88, 89, 90, 178, 212, 214, 210, 211, 213, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 179,
    219, 220, 217, 218, 159,
];

/// How a textual header is encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum TextEncoding {
    /// Code page 037.
    #[serde(rename = "EBCDIC")]
    Ebcdic,
    /// ASCII, or Latin-1.
    #[serde(rename = "ASCII")]
    Ascii,
}

impl TextEncoding {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ebcdic => "EBCDIC",
            Self::Ascii => "ASCII",
        }
    }

    /// The encoding under which more of `bytes` are letters, digits and blanks; EBCDIC, the standard's, if
    /// equal.
    ///
    /// The first byte alone ('C' is 0xC3 or 0x43) does not settle it: garbled and blank headers occur.
    pub fn of(bytes: &[u8]) -> Self {
        let plain = |c: u8| usize::from(c.is_ascii_alphanumeric() || c == b' ');
        let ascii: usize = bytes.iter().map(|&b| plain(b)).sum();
        let ebcdic: usize = bytes.iter().map(|&b| plain(LATIN_1_FROM_EBCDIC[usize::from(b)])).sum();
        if ascii > ebcdic { Self::Ascii } else { Self::Ebcdic }
    }

    /// The encoding of an extended text header, which may be another one than that of the first.
    pub(super) fn of_block(self, block: &[u8]) -> Self {
        let other = if self == Self::Ebcdic { Self::Ascii } else { Self::Ebcdic };
        if !is_text(block, self) && is_text(block, other) { other } else { self }
    }

    fn decode(self, byte: u8) -> char {
        let latin_1 = match self {
            Self::Ebcdic => LATIN_1_FROM_EBCDIC[usize::from(byte)],
            Self::Ascii => byte,
        };
        let c = char::from(latin_1);
        if c.is_control() { ' ' } else { c }
    }
}

/// Lines of a textual header, blanks at their ends removed, control characters (an embedded NUL) as blanks.
pub(super) fn decode_lines(bytes: &[u8], encoding: TextEncoding) -> Vec<String> {
    bytes
        .chunks(LINE_CHARACTERS)
        .map(|line| line.iter().map(|&b| encoding.decode(b)).collect::<String>().trim_end().to_owned())
        .collect()
}

/// Lines of extended textual headers, each in its own encoding.
pub(super) fn decode_texts(bytes: &[u8], encoding: TextEncoding) -> Vec<String> {
    bytes.chunks(TEXT_BYTES).flat_map(|block| decode_lines(block, encoding.of_block(block))).collect()
}

/// Whether a block is text: nearly all of it are letters, digits, signs and blanks, some of them letters or digits. Trace
/// headers are mostly zeros.
pub(super) fn is_text(block: &[u8], encoding: TextEncoding) -> bool {
    let blank = if encoding == TextEncoding::Ebcdic { 0x40 } else { b' ' };
    let is_sign = |b: &u8| *b == blank || ('!'..='~').contains(&encoding.decode(*b));
    let printable = block.iter().filter(|b| is_sign(b)).count();
    let letters = block.iter().filter(|&&b| encoding.decode(b).is_ascii_alphanumeric()).count();
    printable * 20 >= block.len() * 19 && letters >= 4
}

/// Whether an extended text header holds the end-of-text stanza, in either encoding: it need not be that of the first
/// header, and what follows the stanza need not be text.
pub(super) fn ends_text(block: &[u8]) -> bool {
    // Blanks and capitals are as every program likes them.
    [TextEncoding::Ebcdic, TextEncoding::Ascii].into_iter().any(|encoding| {
        let letters = block.iter().map(|&b| encoding.decode(b).to_ascii_uppercase()).filter(|c| !c.is_whitespace());
        letters.collect::<String>().contains(END_OF_TEXT)
    })
}

/// A textual header of 40 lines, `C 1` to `C40`, in code page 037; longer lines are cut, missing ones blank.
pub(super) fn encode_ebcdic(lines: &[String]) -> Vec<u8> {
    let mut ebcdic_from_latin_1 = [0x6f_u8; 256];
    for (ebcdic, &latin_1) in (0..=255_u8).zip(&LATIN_1_FROM_EBCDIC) {
        ebcdic_from_latin_1[usize::from(latin_1)] = ebcdic;
    }
    let mut bytes = Vec::with_capacity(TEXT_BYTES);
    for number in 1..=TEXT_BYTES / LINE_CHARACTERS {
        let text = lines.get(number - 1).map_or("", String::as_str);
        let line = format!("C{number:>2} {text}");
        let latin_1 = line.chars().map(|c| u8::try_from(u32::from(c)).ok().filter(|b| *b >= 32).unwrap_or(b'?'));
        bytes.extend(
            latin_1.chain(std::iter::repeat(b' ')).take(LINE_CHARACTERS).map(|b| ebcdic_from_latin_1[usize::from(b)]),
        );
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_code_page_is_a_permutation() {
        let mut seen = [false; 256];
        LATIN_1_FROM_EBCDIC.iter().for_each(|&c| seen[usize::from(c)] = true);
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn text_comes_back_from_ebcdic() {
        let bytes = encode_ebcdic(&["SAMPLE CODE: 1, (a+b) = \u{e9}".to_owned(), "x".repeat(100)]);
        assert_eq!(bytes.len(), TEXT_BYTES);
        assert_eq!(bytes[0], 0xc3);
        assert_eq!(TextEncoding::of(&bytes), TextEncoding::Ebcdic);
        let lines = decode_lines(&bytes, TextEncoding::Ebcdic);
        assert_eq!(lines[0], "C 1 SAMPLE CODE: 1, (a+b) = \u{e9}");
        assert_eq!(lines[1].len(), 80);
        assert_eq!(lines[39], "C40");
    }

    #[test]
    fn ascii_is_told_from_ebcdic_and_nul_is_a_blank() {
        let mut bytes = vec![b' '; TEXT_BYTES];
        bytes[..10].copy_from_slice(b"C 1 CLIENT");
        bytes[3] = 0;
        assert_eq!(TextEncoding::of(&bytes), TextEncoding::Ascii);
        assert_eq!(decode_lines(&bytes, TextEncoding::Ascii)[0], "C 1 CLIENT");
    }

    #[test]
    fn the_end_of_text_stanza_is_found() {
        let first = encode_ebcdic(&["((SEG: Location Data ver 1.0))".to_owned()]);
        let second = encode_ebcdic(&["((SEG: EndText))".to_owned()]);
        assert!(ends_text(&second) && !ends_text(&first));
        assert!(ends_text(&encode_ebcdic(&["((  seg: endTEXt  ))".to_owned()])));
        assert!(ends_text(&[b"((SEG: EndText))".as_slice(), &[0; 3184]].concat()));
    }
}
