//! Pixels as a TIFF file (revision 6.0), which printers and layout programs take.
//!
//! Written by hand since it is short: one image in strips, compressed as PNG compresses (Deflate, compression 8) after
//! each row's differences (predictor 2), with its resolution. Pixels that are not opaque add a fourth channel of
//! straight alpha.

use crate::compress::deflated;
use crate::error::PageError;
use crate::format::{Content, FileFormat};
use crate::list::DisplayList;
use image::RgbaImage;
use rayon::prelude::*;

pub(crate) const TIFF: FileFormat =
    FileFormat { name: "TIFF", endings: &["tif", "tiff"], page: Some((Content::Pixels, page)), animation: None };

fn page(list: &DisplayList, dpi: f64, _: &str) -> Result<Vec<u8>, PageError> {
    tiff(&super::raster(list, dpi)?, dpi)
}

/// Rows of a strip.
const STRIP: usize = 64;

/// An entry of the directory: its tag, and its values as shorts, longs or ratios.
enum Entry {
    Shorts(u16, Vec<u16>),
    Longs(u16, Vec<u32>),
    Ratio(u16, [u32; 2]),
}

/// An image as a TIFF file that says its resolution, dots an inch.
///
/// ```
/// let image = image::RgbaImage::from_pixel(3, 2, image::Rgba([10, 20, 30, 255]));
/// let file = page::tiff(&image, 300.0).unwrap();
/// assert_eq!(file[..4], *b"II*\0");
/// ```
///
/// # Errors
/// [`PageError::TiffSize`] where the file would have more than 4 GiB.
pub fn tiff(image: &RgbaImage, dpi: f64) -> Result<Vec<u8>, PageError> {
    let channels = if image.pixels().all(|pixel| pixel.0[3] == u8::MAX) { 3 } else { 4 };
    let row_bytes = image.width() as usize * 4;
    let strip =
        |rows: &[u8]| deflated(&rows.chunks(row_bytes).flat_map(|row| differences(row, channels)).collect::<Vec<_>>());
    let strips: Vec<Vec<u8>> = image.as_raw().par_chunks(STRIP * row_bytes.max(1)).map(strip).collect();
    // Byte order, the number 42, and where the directory is: behind the strips.
    let mut file = b"II*\0\0\0\0\0".to_vec();
    let mut places = Vec::new();
    for strip in &strips {
        places.push(offset(file.len())?);
        file.extend(strip);
    }
    let ratio = [(dpi * 1000.0).round() as u32, 1000];
    let mut entries = vec![
        Entry::Longs(256, vec![image.width()]),
        Entry::Longs(257, vec![image.height()]),
        Entry::Shorts(258, vec![8; channels]),
        Entry::Shorts(259, vec![8]),
        // Red, green and blue.
        Entry::Shorts(262, vec![2]),
        Entry::Longs(273, places),
        Entry::Shorts(277, vec![channels as u16]),
        Entry::Longs(278, vec![STRIP as u32]),
        Entry::Longs(279, strips.iter().map(|strip| strip.len() as u32).collect()),
        Entry::Ratio(282, ratio),
        Entry::Ratio(283, ratio),
        Entry::Shorts(284, vec![1]),
        // Dots an inch.
        Entry::Shorts(296, vec![2]),
        Entry::Shorts(317, vec![2]),
    ];
    if channels == 4 {
        entries.push(Entry::Shorts(338, vec![2]));
    }
    file.resize(file.len().next_multiple_of(2), 0);
    let directory = offset(file.len())?;
    file[4..8].copy_from_slice(&directory.to_le_bytes());
    write_directory(&mut file, &entries)?;
    Ok(file)
}

/// A row of straight RGBA as what each pixel has more than the one before.
fn differences(row: &[u8], channels: usize) -> Vec<u8> {
    let mut before = [0u8; 4];
    let mut made = Vec::with_capacity(row.len());
    for pixel in row.as_chunks::<4>().0 {
        made.extend((0..channels).map(|n| pixel[n].wrapping_sub(before[n])));
        before = *pixel;
    }
    made
}

/// Adds the directory; values of more than four bytes follow it.
fn write_directory(file: &mut Vec<u8>, entries: &[Entry]) -> Result<(), PageError> {
    let mut behind = Vec::new();
    let end = file.len() + 2 + 12 * entries.len() + 4;
    file.extend((entries.len() as u16).to_le_bytes());
    for entry in entries {
        let (tag, kind, count, mut bytes): (u16, u16, usize, Vec<u8>) = match entry {
            Entry::Shorts(tag, values) => {
                (*tag, 3, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
            Entry::Longs(tag, values) => (*tag, 4, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Entry::Ratio(tag, parts) => (*tag, 5, 1, parts.iter().flat_map(|v| v.to_le_bytes()).collect()),
        };
        file.extend(tag.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend((count as u32).to_le_bytes());
        if bytes.len() > 4 {
            file.extend(offset(end + behind.len())?.to_le_bytes());
            behind.append(&mut bytes);
        } else {
            bytes.resize(4, 0);
            file.extend(bytes);
        }
    }
    // No further image.
    file.extend([0; 4]);
    file.append(&mut behind);
    Ok(())
}

/// A place in the file.
fn offset(place: usize) -> Result<u32, PageError> {
    u32::try_from(place).map_err(|_| PageError::TiffSize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use image::Rgba;
    use std::collections::HashMap;
    use std::io::Read;

    /// The values of each tag.
    fn read(file: &[u8]) -> HashMap<u16, Vec<u32>> {
        let number = |at: usize, size: usize| (0..size).rev().fold(0, |n, k| n << 8 | u32::from(file[at + k]));
        let directory = number(4, 4) as usize;
        let entry = |n: u32| {
            let at = directory + 2 + 12 * n as usize;
            // A ratio is two longs.
            let (size, times) = [(2, 1), (4, 1), (4, 2)][number(at + 2, 2) as usize - 3];
            let count = number(at + 4, 4) as usize * times;
            let values = if count * size > 4 { number(at + 8, 4) as usize } else { at + 8 };
            (number(at, 2) as u16, (0..count).map(|k| number(values + k * size, size)).collect())
        };
        (0..number(directory, 2)).map(entry).collect()
    }

    fn pixels(file: &[u8], tags: &HashMap<u16, Vec<u32>>) -> Vec<u8> {
        let (width, channels) = (tags[&256][0] as usize, tags[&277][0] as usize);
        let mut all = Vec::new();
        for (place, length) in tags[&273].iter().zip(&tags[&279]) {
            let mut strip = Vec::new();
            ZlibDecoder::new(&file[*place as usize..][..*length as usize]).read_to_end(&mut strip).unwrap();
            for row in strip.chunks_mut(width * channels) {
                (channels..row.len()).for_each(|n| row[n] = row[n].wrapping_add(row[n - channels]));
            }
            all.extend(strip);
        }
        all
    }

    #[test]
    fn pixels_transparency_and_resolution_are_kept() {
        let image = RgbaImage::from_fn(37, 150, |x, y| Rgba([x as u8, y as u8, (x * y) as u8, 100 + x as u8]));
        let file = tiff(&image, 300.0).unwrap();
        let tags = read(&file);
        assert_eq!(pixels(&file, &tags), *image.as_raw());
        assert_eq!([tags[&256][0], tags[&257][0], tags[&338][0]], [37, 150, 2]);
        assert_eq!((&tags[&282], tags[&296][0]), (&vec![300_000, 1000], 2));
        assert_eq!(tags[&273].len(), 3);
        let opaque = RgbaImage::from_fn(5, 3, |x, y| Rgba([x as u8, y as u8, 9, 255]));
        let file = tiff(&opaque, 72.5).unwrap();
        let tags = read(&file);
        assert!(!tags.contains_key(&338));
        let colours: Vec<u8> = opaque.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]).collect();
        assert_eq!(pixels(&file, &tags), colours);
        assert_eq!(tags[&283], [72_500, 1000]);
    }
}
