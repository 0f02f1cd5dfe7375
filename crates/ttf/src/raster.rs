//! Reads tiles from files: SVG through resvg, PNG and JPEG through image.
//!
//! Every tile becomes a square [`Texture`] of [`TEXTURE_SIDE_PX`]; its aspect ratio is kept in the printed
//! size. Rows are reversed, since image files start at the top and textures at v = 0. Images are resampled
//! with wrap-around: by area average when they shrink, linearly when they grow.
//!
//! Tiles may come from anyone, with a project: only ordinary files are read, SVG opens nothing else and is bounded
//! in cost (see [`crate::svg`]), and PNG and JPEG are decoded within [`MAX_DECODING_BYTES`].

use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use resvg::tiny_skia;

use crate::svg::MAX_SVG_BYTES;
use crate::texture::TEXTURE_SIDE_PX;
use crate::{Texture, TtfError};

/// Largest side of an image accepted as a tile, in pixels.
pub(crate) const MAX_IMAGE_SIDE_PX: u32 = 4096;

/// Largest file accepted as a tile, in bytes.
pub(crate) const MAX_FILE_BYTES: u64 = 64 << 20;

/// Endings of the names of files that tiles are read from, without the dot; the last one holds a drawing.
pub const TILE_ENDINGS: [&str; 4] = ["png", "jpg", "jpeg", "svg"];

/// Most memory that the decoder of an image may take, in bytes: the largest tile with 16 bits for each channel.
pub(crate) const MAX_DECODING_BYTES: u64 = 160 << 20;

/// Reads a tile. Returns its texture, its source if it is an SVG, and its height divided by its width.
///
/// # Errors
/// See [`crate::TextureLibrary::add_user`].
pub(crate) fn read_tile(path: &Path) -> Result<(Texture, Option<String>, f32), TtfError> {
    let extension = path.extension().map(|text| text.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !TILE_ENDINGS.contains(&extension.as_str()) {
        return Err(TtfError::UnknownFormat { path: path.to_owned() });
    }
    let is_svg = extension == TILE_ENDINGS[3];
    let content = read_file(path, if is_svg { MAX_SVG_BYTES } else { MAX_FILE_BYTES })?;
    if is_svg {
        let (texture, shape) = rasterize(&path.display().to_string(), &content)?;
        return Ok((texture, Some(String::from_utf8_lossy(&content).into_owned()), shape));
    }
    let (texture, shape) = decode(path, &content)?;
    Ok((texture, None, shape))
}

/// The content of an ordinary file of at most `limit` bytes. A pipe or device is recognised by its kind, before it is
/// opened, since opening a pipe waits.
fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, TtfError> {
    let unreadable = |source| TtfError::ReadTexture { path: path.to_owned(), source };
    let facts = std::fs::metadata(path).map_err(unreadable)?;
    if !facts.is_file() {
        return Err(TtfError::NotAFile { path: path.to_owned() });
    }
    let too_many = |bytes| TtfError::TooManyBytes { path: path.to_owned(), bytes, limit };
    if facts.len() > limit {
        return Err(too_many(facts.len()));
    }
    let mut content = Vec::new();
    // A file may grow after it was looked at.
    File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut content)).map_err(unreadable)?;
    if content.len() as u64 > limit { Err(too_many(content.len() as u64)) } else { Ok(content) }
}

/// Rasterises an SVG tile that is in memory; `name` is named in errors. What [`crate::TextureLibrary::add_user`] does
/// with a file.
///
/// # Errors
/// [`TtfError::BadSvg`], [`TtfError::RefusedSvg`] and [`TtfError::BadSize`].
pub fn read_svg(name: &str, svg: &[u8]) -> Result<Texture, TtfError> {
    rasterize(name, svg).map(|(texture, _)| texture)
}

/// Rasterises an SVG tile, its whole view box stretched to the square. Also returns its height divided by its
/// width.
///
/// # Errors
/// [`TtfError::BadSvg`], [`TtfError::RefusedSvg`] and [`TtfError::BadSize`] with the name given.
pub(crate) fn rasterize(name: &str, svg: &[u8]) -> Result<(Texture, f32), TtfError> {
    let tree = crate::svg::parse(name, svg)?;
    let bad_size = || TtfError::BadSize {
        name: name.to_owned(),
        width: tree.size().width() as u32,
        height: tree.size().height() as u32,
        limit: MAX_IMAGE_SIDE_PX,
    };
    let side = TEXTURE_SIDE_PX;
    let mut pixels = tiny_skia::Pixmap::new(side, side).ok_or_else(bad_size)?;
    let (width, height) = (tree.size().width(), tree.size().height());
    let scale = tiny_skia::Transform::from_scale(side as f32 / width, side as f32 / height);
    resvg::render(&tree, scale, &mut pixels.as_mut());
    let texels = pixels
        .data()
        .chunks_exact(side as usize * 4)
        .rev()
        .flat_map(|row| row.chunks_exact(4))
        .map(|texel| std::array::from_fn(|channel| f32::from(texel[channel]) / 255.0))
        .collect();
    Ok((Texture::from_premultiplied(texels), height / width))
}

fn decode(path: &Path, content: &[u8]) -> Result<(Texture, f32), TtfError> {
    let bad_image = |source| TtfError::BadImage { path: path.to_owned(), source };
    let bad_size =
        |width, height| TtfError::BadSize { name: path.display().to_string(), width, height, limit: MAX_IMAGE_SIDE_PX };
    let format = image::guess_format(content).map_err(bad_image)?;
    let content = &*if format == image::ImageFormat::Png { without_extras(content) } else { Cow::Borrowed(content) };
    let reader = || {
        let mut reader = image::ImageReader::with_format(std::io::Cursor::new(content), format);
        let mut limits = image::Limits::default();
        limits.max_alloc = Some(MAX_DECODING_BYTES);
        reader.limits(limits);
        reader
    };
    let (width, height) = reader().into_dimensions().map_err(bad_image)?;
    let usable = 1..=MAX_IMAGE_SIDE_PX;
    if !usable.contains(&width) || !usable.contains(&height) {
        return Err(bad_size(width, height));
    }
    let pixels = reader().decode().map_err(bad_image)?.into_rgba8();
    let premultiplied = |pixel: &[u8]| {
        let [r, g, b, a] = std::array::from_fn(|channel| f32::from(pixel[channel]) / 255.0);
        [r * a, g * a, b * a, a]
    };
    let side = TEXTURE_SIDE_PX as usize;
    let rows = pixels.as_raw().chunks_exact(width as usize * 4).rev();
    let rows = rows.map(|row| row.chunks_exact(4).map(premultiplied).collect::<Vec<_>>());
    let wide = resample_rows(rows, width as usize, side);
    drop(pixels);
    let turned = transpose(&wide, side);
    let square = resample_rows(turned.chunks_exact(height as usize), height as usize, side);
    let square = transpose(&square, side);
    Ok((Texture::from_premultiplied(square), height as f32 / width as f32))
}

/// A PNG without what may inflate and is no pixel: colour profiles, texts, and all that its readers may ignore.
fn without_extras(content: &[u8]) -> Cow<'_, [u8]> {
    const SIGNATURE: usize = 8;
    const NEEDED: [&[u8]; 2] = [b"tRNS", b"PLTE"];
    let Some((signature, mut rest)) = content.split_at_checked(SIGNATURE) else { return Cow::Borrowed(content) };
    let mut kept = signature.to_vec();
    while let Some((head, _)) = rest.split_first_chunk::<8>() {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        // Length, name, content, checksum. What is cut off is left to the decoder to refuse.
        let chunk = &rest[..length.saturating_add(12).min(rest.len())];
        let is_ancillary = head[4] & 0x20 != 0;
        if !is_ancillary || NEEDED.contains(&&head[4..8]) {
            kept.extend_from_slice(chunk);
        }
        rest = &rest[chunk.len()..];
    }
    Cow::Owned(kept)
}

/// Resamples every row from `from` to `to` texels, wrapping around. Rows are asked for one after the other.
fn resample_rows<R: AsRef<[[f32; 4]]>>(rows: impl Iterator<Item = R>, from: usize, to: usize) -> Vec<[f32; 4]> {
    let step = from as f64 / to as f64;
    let weights: Vec<Vec<(usize, f32)>> = (0..to)
        .map(|index| if from > to { area_weights(index as f64 * step, step) } else { linear_weights(index, step) })
        .collect();
    let mut resampled = Vec::new();
    for row in rows {
        let row = row.as_ref();
        resampled.extend(weights.iter().map(|taps| {
            taps.iter().fold([0.0; 4], |sum: [f32; 4], &(index, weight)| {
                std::array::from_fn(|c| sum[c] + weight * row[index % from][c])
            })
        }));
    }
    resampled
}

/// The texels that [start, start + width) covers, with their shares.
fn area_weights(start: f64, width: f64) -> Vec<(usize, f32)> {
    let end = start + width;
    (start.floor() as usize..end.ceil() as usize)
        .map(|index| {
            let covered = (end.min(index as f64 + 1.0) - start.max(index as f64)).max(0.0);
            (index, (covered / width) as f32)
        })
        .collect()
}

/// The two texels around the centre of target texel `index`, with their weights. The caller takes indices
/// modulo the row.
fn linear_weights(index: usize, step: f64) -> Vec<(usize, f32)> {
    let centre = (index as f64 + 0.5) * step - 0.5;
    let low = centre.floor();
    let fraction = (centre - low) as f32;
    // The centre may lie left of texel 0. The caller wraps, so any whole tile may be added.
    let from = (step * TEXTURE_SIDE_PX as f64).round() as i64;
    let low = (low as i64).rem_euclid(from) as usize;
    vec![(low, 1.0 - fraction), (low + 1, fraction)]
}

fn transpose(texels: &[[f32; 4]], width: usize) -> Vec<[f32; 4]> {
    let height = texels.len() / width;
    (0..texels.len()).map(|index| texels[(index % height) * width + index / height]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_inflates_in_a_png_and_is_no_pixel_is_not_decoded() {
        let mut png = Vec::new();
        let pixels = image::RgbaImage::from_pixel(4, 4, image::Rgba([255, 0, 0, 128]));
        pixels.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).unwrap();
        // A profile that is no zlib stream at all, with a wrong checksum, behind the header.
        let profile: Vec<u8> = [&1000_u32.to_be_bytes()[..], b"iCCP", &[7; 1000], &[0; 4]].concat();
        let with: Vec<u8> = [&png[..33], &profile, &png[33..]].concat();
        assert_eq!(&*without_extras(&with), &*without_extras(&png));
        let path = Path::new("a.png");
        assert_eq!(decode(path, &with).unwrap().0, decode(path, &png).unwrap().0);
        assert!(decode(path, &with[..60]).is_err());
        let Some(folder) = testdata::folder() else { return };
        let Ok(content) = std::fs::read(folder.join("cases/attack-png-iccp/iccp.png")) else {
            eprintln!("skipped: the case attack-png-iccp is not there");
            return;
        };
        let begun = std::time::Instant::now();
        drop(decode(path, &content));
        assert!(begun.elapsed().as_secs() < 5, "{:?}", begun.elapsed());
    }
    use crate::TextureLibrary;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().unwrap()
    }

    #[test]
    fn the_bottom_row_of_an_image_is_at_v_zero() {
        let folder = folder();
        let path = folder.path().join("half.png");
        let red_above_blue = |_, y| if y < 8 { image::Rgb([255, 0, 0]) } else { image::Rgb([0, 0, 255_u8]) };
        image::RgbImage::from_fn(16, 16, red_above_blue).save(&path).unwrap();
        let (texture, _, shape) = read_tile(&path).unwrap();
        let at = |v: f32| texture.sample([0.5, v], [0.0; 2], [0.0; 2]);
        assert_eq!((at(0.25), at(0.75)), ([0.0, 0.0, 1.0, 1.0], [1.0, 0.0, 0.0, 1.0]));
        assert_eq!(shape, 1.0);
        let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 20"><rect width="10" height="10" fill="#f00"/></svg>"##;
        let (texture, shape) = rasterize("x", svg).unwrap();
        assert_eq!(shape, 2.0);
        assert_eq!(texture.sample([0.5, 0.75], [0.0; 2], [0.0; 2]), [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(texture.sample([0.5, 0.25], [0.0; 2], [0.0; 2]), [0.0; 4]);
    }

    #[test]
    fn resampling_keeps_the_mean_and_wraps() {
        for (width, height) in [(3_u32, 5_u32), (700, 300), (1024, 1), (512, 512)] {
            let texels: Vec<[f32; 4]> = (0..width * height).map(|i| [((i * 7919) % 101) as f32 / 100.0; 4]).collect();
            let side = TEXTURE_SIDE_PX as usize;
            let (width, height) = (width as usize, height as usize);
            let wide = resample_rows(texels.chunks_exact(width), width, side);
            let square = resample_rows(transpose(&wide, side).chunks_exact(height), height, side);
            assert_eq!(square.len(), side * side);
            let mean =
                |texels: &[[f32; 4]]| texels.iter().map(|texel| f64::from(texel[0])).sum::<f64>() / texels.len() as f64;
            assert!((mean(&texels) - mean(&square)).abs() < 2e-3, "{width} x {height}");
        }
        // A black and a white texel side by side, enlarged: half grey at both edges of each.
        let row = resample_rows([[[0.0; 4], [1.0; 4]]].iter(), 2, 512);
        assert!((row[0][0] - 0.5).abs() < 0.01 && (row[511][0] - 0.5).abs() < 0.01 && (row[256][0] - 0.5).abs() < 0.01);
    }

    #[test]
    fn each_kind_of_bad_file_has_its_own_error() {
        let folder = folder();
        let file = |name: &str, content: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            TextureLibrary::builtin().unwrap().add_user(&path).unwrap_err()
        };
        assert!(matches!(file("text.png", b"no image"), TtfError::BadImage { .. }));
        assert!(matches!(file("empty.png", b""), TtfError::BadImage { .. }));
        assert!(matches!(file("notes.txt", b"hello"), TtfError::UnknownFormat { .. }));
        assert!(matches!(file("none", b"hello"), TtfError::UnknownFormat { .. }));
        assert!(matches!(file("bad.svg", b"<svg"), TtfError::BadSvg { .. }));
        let flat = br##"<svg xmlns="http://www.w3.org/2000/svg" width="0" height="10"/>"##;
        assert!(matches!(file("flat.svg", flat), TtfError::BadSvg { .. }));
        let path = folder.path().join("wide.png");
        image::GrayImage::new(MAX_IMAGE_SIDE_PX + 1, 1).save(&path).unwrap();
        let error = TextureLibrary::builtin().unwrap().add_user(&path).unwrap_err();
        assert!(matches!(error, TtfError::BadSize { width, .. } if width == MAX_IMAGE_SIDE_PX + 1), "{error}");
        let missing = TextureLibrary::builtin().unwrap().add_user(&folder.path().join("missing.png"));
        assert!(matches!(missing, Err(TtfError::ReadTexture { .. })));
        let mut truncated = std::fs::read(&path).unwrap();
        truncated.truncate(40);
        assert!(matches!(file("cut.png", &truncated), TtfError::BadImage { .. }));
    }

    #[test]
    fn a_users_name_may_not_hide_a_pattern() {
        let folder = folder();
        let path = folder.path().join("limestone.png");
        image::GrayImage::new(4, 4).save(&path).unwrap();
        let error = TextureLibrary::builtin().unwrap().add_user(&path).unwrap_err();
        assert!(matches!(error, TtfError::DuplicateTexture { .. }));
    }
}
