//! GIF files (Graphics Interchange Format, version 89a, CompuServe 1990), written by hand: a header, the extension that
//! makes browsers repeat, and for each frame a delay, a palette and indices packed by LZW.

use super::palette::{Paletted, reduced};
use crate::format::{AnimationShape, FileFormat, Frames};
use image::RgbaImage;
use std::collections::HashMap;
use std::io::{self, Write};

/// Bits of an index.
const INDEX_BITS: u32 = 8;
/// The code that empties the dictionary, and the one that ends the data.
const CLEAR: u16 = 1 << INDEX_BITS;
const END: u16 = CLEAR + 1;
/// Most codes of a dictionary: they have twelve bits.
const MOST: u16 = 4095;

pub(crate) const GIF: FileFormat = FileFormat { name: "GIF", endings: &["gif"], page: None, animation: Some(begin) };

/// Writes frames one after the other.
struct GifWriter<'a> {
    out: &'a mut dyn Write,
    size: [u16; 2],
    delay_cs: u16,
}

fn begin<'a>(out: &'a mut dyn Write, shape: AnimationShape) -> io::Result<Box<dyn Frames + 'a>> {
    Ok(Box::new(GifWriter::new(out, shape.size_px, shape.delay_ms())?))
}

impl<'a> GifWriter<'a> {
    /// Begins a file.
    fn new(out: &'a mut dyn Write, size_px: [u32; 2], delay_ms: u16) -> io::Result<Self> {
        let side = |pixels: u32| {
            u16::try_from(pixels).map_err(|_| {
                io::Error::new(
                    io::ErrorKind::InvalidInput,
                    format!("a GIF has at most 65535 pixels a side, not {pixels}"),
                )
            })
        };
        let size = [side(size_px[0])?, side(size_px[1])?];
        out.write_all(b"GIF89a")?;
        size.iter().try_for_each(|side| out.write_all(&side.to_le_bytes()))?;
        // No palette for all frames; eight bits a channel.
        out.write_all(&[0x70, 0, 0])?;
        // Repeat without end.
        out.write_all(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\0\0\0")?;
        // Browsers show frames of less than two hundredths of a second slowly.
        Ok(Self { out, size, delay_cs: ((delay_ms + 5) / 10).max(2) })
    }
}

impl Frames for GifWriter<'_> {
    fn add(&mut self, frame: &RgbaImage) -> io::Result<()> {
        let Paletted { colours, clear, indices } = reduced(frame);
        // The frame is removed before the next one where that shows through, otherwise it stays below it.
        let disposal: u8 = if clear.is_some() { 2 } else { 1 };
        self.out.write_all(&[0x21, 0xf9, 4, disposal << 2 | u8::from(clear.is_some())])?;
        self.out.write_all(&self.delay_cs.to_le_bytes())?;
        self.out.write_all(&[clear.unwrap_or(0), 0])?;
        self.out.write_all(&[0x2c, 0, 0, 0, 0])?;
        self.size.iter().try_for_each(|side| self.out.write_all(&side.to_le_bytes()))?;
        // A palette of 256 colours of its own.
        self.out.write_all(&[0x87])?;
        let mut table = [0; 768];
        for (entry, colour) in table.chunks_exact_mut(3).zip(&colours) {
            entry.copy_from_slice(colour);
        }
        self.out.write_all(&table)?;
        self.out.write_all(&[INDEX_BITS as u8])?;
        for block in packed(&indices).chunks(255) {
            self.out.write_all(&[block.len() as u8])?;
            self.out.write_all(block)?;
        }
        self.out.write_all(&[0])
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.out.write_all(b";")?;
        self.out.flush()
    }
}

/// Codes of growing width, lowest bits first.
#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    open: u32,
    count: u32,
}

impl Bits {
    fn push(&mut self, code: u16, width: u32) {
        self.open |= u32::from(code) << self.count;
        self.count += width;
        while self.count >= 8 {
            self.bytes.push(self.open as u8);
            self.open >>= 8;
            self.count -= 8;
        }
    }

    fn ended(mut self) -> Vec<u8> {
        if self.count > 0 {
            self.bytes.push(self.open as u8);
        }
        self.bytes
    }
}

/// Indices as LZW codes.
fn packed(indices: &[u8]) -> Vec<u8> {
    let mut bits = Bits::default();
    let mut known: HashMap<(u16, u8), u16> = HashMap::new();
    let (mut next, mut width) = (END + 1, INDEX_BITS + 1);
    bits.push(CLEAR, width);
    let mut prefix: Option<u16> = None;
    for &index in indices {
        let Some(before) = prefix else {
            prefix = Some(u16::from(index));
            continue;
        };
        if let Some(&code) = known.get(&(before, index)) {
            prefix = Some(code);
            continue;
        }
        bits.push(before, width);
        if next <= MOST {
            known.insert((before, index), next);
            // The reader learns a code one step later than we do.
            if next == 1 << width {
                width += 1;
            }
            next += 1;
        } else {
            bits.push(CLEAR, width);
            known.clear();
            (next, width) = (END + 1, INDEX_BITS + 1);
        }
        prefix = Some(u16::from(index));
    }
    if let Some(code) = prefix {
        bits.push(code, width);
        if next == 1 << width && width < 12 {
            width += 1;
        }
    }
    bits.push(END, width);
    bits.ended()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// What a reader finds in a file of ours.
    pub(in super::super) struct Read {
        pub size: [u16; 2],
        /// Pixels of each frame; none where they are clear.
        pub frames: Vec<Vec<Option<[u8; 3]>>>,
        /// Hundredths of a second.
        pub delays: Vec<u16>,
    }

    /// A reader as the specification describes it, for files of one palette a frame.
    pub(in super::super) fn decoded(file: &[u8]) -> Read {
        let word = |at: usize| u16::from_le_bytes([file[at], file[at + 1]]);
        assert_eq!(&file[..6], b"GIF89a");
        let mut read = Read { size: [word(6), word(8)], frames: Vec::new(), delays: Vec::new() };
        let (mut at, mut clear) = (13, None);
        loop {
            match file[at] {
                0x3b => return read,
                0x21 => {
                    if file[at + 1] == 0xf9 {
                        read.delays.push(word(at + 4));
                        clear = (file[at + 3] & 1 == 1).then_some(file[at + 6]);
                    }
                    at += 2;
                    while file[at] != 0 {
                        at += usize::from(file[at]) + 1;
                    }
                    at += 1;
                }
                0x2c => {
                    assert_eq!((file[at + 9], file[at + 778]), (0x87, 8));
                    let table = &file[at + 10..at + 778];
                    at += 779;
                    let mut data = Vec::new();
                    while file[at] != 0 {
                        let length = usize::from(file[at]);
                        data.extend_from_slice(&file[at + 1..=at + length]);
                        at += length + 1;
                    }
                    at += 1;
                    let colour = |index: u8| {
                        let from = usize::from(index) * 3;
                        (clear != Some(index)).then(|| [table[from], table[from + 1], table[from + 2]])
                    };
                    read.frames.push(unpacked(&data).into_iter().map(colour).collect());
                }
                other => panic!("{other:#x} at {at}"),
            }
        }
    }

    fn unpacked(data: &[u8]) -> Vec<u8> {
        let (mut found, mut at): (Vec<u8>, usize) = (Vec::new(), 0);
        let roots = || (0..=END).map(|code| if code < CLEAR { vec![code as u8] } else { Vec::new() }).collect();
        let (mut table, mut width): (Vec<Vec<u8>>, usize) = (roots(), 9);
        let mut last: Option<Vec<u8>> = None;
        loop {
            let code: u16 = (0..width).map(|bit| u16::from(data[(at + bit) / 8] >> ((at + bit) % 8) & 1) << bit).sum();
            at += width;
            match code {
                CLEAR => (table, width, last) = (roots(), 9, None),
                END => return found,
                _ => {
                    let text = match (table.get(usize::from(code)), &last) {
                        (Some(text), _) => text.clone(),
                        (None, Some(last)) => [&last[..], &last[..1]].concat(),
                        (None, None) => panic!("code {code} without a beginning"),
                    };
                    if let Some(last) = last
                        && table.len() < 4096
                    {
                        table.push([&last[..], &text[..1]].concat());
                    }
                    if table.len() == 1 << width && width < 12 {
                        width += 1;
                    }
                    found.extend_from_slice(&text);
                    last = Some(text);
                }
            }
        }
    }

    #[test]
    fn indices_come_back_whatever_they_are() {
        let mut state = 7_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let cases: [Vec<u8>; 6] = [
            Vec::new(),
            vec![9],
            vec![0; 70_000],
            (0..90_000).map(|n| (n / 300 % 7) as u8).collect(),
            (0..40_000).map(|_| noise()).collect(),
            (0..200_000).map(|n| if n % 11 == 0 { noise() } else { (n % 5) as u8 }).collect(),
        ];
        for (case, indices) in cases.iter().enumerate() {
            assert!(unpacked(&packed(indices)) == *indices, "case {case}");
        }
        // Every length around the widenings of the codes.
        for length in (200..600).chain(3800..4200) {
            let indices: Vec<u8> = (0..length).map(|_| noise()).collect();
            assert!(unpacked(&packed(&indices)) == indices, "{length}");
        }
    }

    #[test]
    fn a_side_that_a_gif_cannot_hold_is_refused() {
        assert!(GifWriter::new(&mut Vec::new(), [65_536, 2], 100).is_err());
    }
}
