//! Pictures as files. Patterns are PNG of 256 colours, a third of what PNG of all colours takes; what has no drawn lines
//! is JPEG; numbers that are read back are PNG of all their bits.

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ExtendedColorType, ImageEncoder, RgbImage, imageops};
use page::animation::reduced;
use project::error::ProjectError;
use std::io;
use std::path::Path;
use system::file::FileAction;

/// Quality of JPEG pictures, percent.
const JPEG_QUALITY: u8 = 82;

fn failed(error: image::ImageError) -> ProjectError {
    failed_with(io::Error::other(error))
}

fn failed_with(error: io::Error) -> ProjectError {
    ProjectError::io(FileAction::Written, Path::new("a picture of the review"), error)
}

/// A picture as PNG.
///
/// # Errors
/// The picture has no pixels.
pub(crate) fn png(image: &RgbImage) -> Result<Vec<u8>, ProjectError> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    encoder.write_image(image, image.width(), image.height(), ExtendedColorType::Rgb8).map_err(failed)?;
    Ok(bytes)
}

/// A picture as PNG of at most 256 colours.
///
/// # Errors
/// The picture has no pixels.
pub(crate) fn drawing(image: &RgbImage) -> Result<Vec<u8>, ProjectError> {
    let broken = |error: png::EncodingError| failed_with(io::Error::other(error));
    let paletted = reduced(&DynamicImage::from(image.clone()).to_rgba8());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(paletted.colours.concat());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().map_err(broken)?;
    writer.write_image_data(&paletted.indices).map_err(broken)?;
    writer.finish().map_err(broken)?;
    Ok(bytes)
}

/// A picture as JPEG.
///
/// # Errors
/// The picture has no pixels.
pub(crate) fn jpeg(image: &RgbImage) -> Result<Vec<u8>, ProjectError> {
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY);
    encoder.write_image(image, image.width(), image.height(), ExtendedColorType::Rgb8).map_err(failed)?;
    Ok(bytes)
}

/// A picture with its sides multiplied.
pub(crate) fn shrunk(image: &RgbImage, factor: f64) -> RgbImage {
    let side = |n: u32| ((f64::from(n) * factor).round() as u32).max(2);
    imageops::resize(image, side(image.width()), side(image.height()), imageops::FilterType::CatmullRom)
}
