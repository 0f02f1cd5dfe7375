//! Tiles from files to texels: SVG through resvg, PNG and JPEG through image.
//!
//! Every tile becomes a square [`Texture`] of [`TEXTURE_SIDE_PX`]; its shape lives on in the printed
//! size. Rows are turned over on the way (image files start at the top, textures at v = 0).
//! Images are resampled as tiles, with wrap-around: area average when they shrink, linear when they grow.

use std::path::Path;

use resvg::{tiny_skia, usvg};

use crate::texture::TEXTURE_SIDE_PX;
use crate::{Error, Texture};

/// Largest side of an image accepted as a tile, in pixels.
pub const MAX_IMAGE_SIDE_PX: u32 = 8192;

/// Largest file accepted as a tile, in bytes.
pub const MAX_FILE_BYTES: u64 = 64 << 20;

/// Reads a tile: its texture, its source if it is an SVG, and its height over its width.
///
/// # Errors
/// See [`crate::TextureLibrary::add_user`].
pub(crate) fn read_tile(path: &Path) -> Result<(Texture, Option<String>, f32), Error> {
    let extension = path.extension().map(|text| text.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !["png", "jpg", "jpeg", "svg"].contains(&extension.as_str()) {
        return Err(Error::UnknownFormat { path: path.to_owned() });
    }
    let unreadable = |source| Error::ReadTexture { path: path.to_owned(), source };
    let bytes = std::fs::metadata(path).map_err(unreadable)?.len();
    if bytes > MAX_FILE_BYTES {
        return Err(Error::TooManyBytes { path: path.to_owned(), bytes, limit: MAX_FILE_BYTES });
    }
    let content = std::fs::read(path).map_err(unreadable)?;
    if extension == "svg" {
        let (texture, shape) = rasterize(&path.display().to_string(), &content)?;
        return Ok((texture, Some(String::from_utf8_lossy(&content).into_owned()), shape));
    }
    let (texture, shape) = decode(path, &content)?;
    Ok((texture, None, shape))
}

/// Rasterises an SVG tile, its whole view box stretched to the square; also its height over its width.
///
/// # Errors
/// [`Error::BadSvg`] with the name given.
pub(crate) fn rasterize(name: &str, svg: &[u8]) -> Result<(Texture, f32), Error> {
    let tree = usvg::Tree::from_data(svg, &usvg::Options::default())
        .map_err(|source| Error::BadSvg { name: name.to_owned(), source })?;
    let bad_size = || Error::BadSize {
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

fn decode(path: &Path, content: &[u8]) -> Result<(Texture, f32), Error> {
    let bad_image = |source| Error::BadImage { path: path.to_owned(), source };
    let bad_size =
        |width, height| Error::BadSize { name: path.display().to_string(), width, height, limit: MAX_IMAGE_SIDE_PX };
    let format = image::guess_format(content).map_err(bad_image)?;
    let reader = || image::ImageReader::with_format(std::io::Cursor::new(content), format);
    let (width, height) = reader().into_dimensions().map_err(bad_image)?;
    let usable = 1..=MAX_IMAGE_SIDE_PX;
    if !usable.contains(&width) || !usable.contains(&height) {
        return Err(bad_size(width, height));
    }
    let pixels = reader().decode().map_err(bad_image)?.into_rgba8();
    let premultiplied: Vec<[f32; 4]> = pixels
        .rows()
        .rev()
        .flatten()
        .map(|pixel| {
            let [r, g, b, a] = pixel.0.map(|byte| f32::from(byte) / 255.0);
            [r * a, g * a, b * a, a]
        })
        .collect();
    let side = TEXTURE_SIDE_PX as usize;
    let wide = resample_rows(&premultiplied, width as usize, side);
    let turned = transpose(&wide, side);
    let square = transpose(&resample_rows(&turned, height as usize, side), side);
    Ok((Texture::from_premultiplied(square), height as f32 / width as f32))
}

/// Resamples every row from `from` to `to` texels, wrapping around.
fn resample_rows(texels: &[[f32; 4]], from: usize, to: usize) -> Vec<[f32; 4]> {
    let step = from as f64 / to as f64;
    let weights: Vec<Vec<(usize, f32)>> = (0..to)
        .map(|index| if from > to { area_weights(index as f64 * step, step) } else { linear_weights(index, step) })
        .collect();
    texels
        .chunks_exact(from)
        .flat_map(|row| {
            weights.iter().map(move |taps| {
                taps.iter().fold([0.0; 4], |sum: [f32; 4], &(index, weight)| {
                    std::array::from_fn(|c| sum[c] + weight * row[index % from][c])
                })
            })
        })
        .collect()
}

/// The texels under [start, start + width) with their shares.
fn area_weights(start: f64, width: f64) -> Vec<(usize, f32)> {
    let end = start + width;
    (start.floor() as usize..end.ceil() as usize)
        .map(|index| {
            let covered = (end.min(index as f64 + 1.0) - start.max(index as f64)).max(0.0);
            (index, (covered / width) as f32)
        })
        .collect()
}

/// The two texels around the centre of target texel `index`; indices count from one tile further right.
fn linear_weights(index: usize, step: f64) -> Vec<(usize, f32)> {
    let centre = (index as f64 + 0.5) * step - 0.5;
    let low = centre.floor();
    let fraction = (centre - low) as f32;
    // The centre may lie left of texel 0: the caller wraps, so any whole tile may be added.
    let from = (step * TEXTURE_SIDE_PX as f64).round() as i64;
    let low = (low as i64).rem_euclid(from) as usize;
    vec![(low, 1.0 - fraction), (low + 1, fraction)]
}

fn transpose(texels: &[[f32; 4]], width: usize) -> Vec<[f32; 4]> {
    let height = texels.len() / width;
    (0..texels.len()).map(|index| texels[(index % height) * width + index / height]).collect()
}
