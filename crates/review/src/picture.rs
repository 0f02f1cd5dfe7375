//! Pictures as files: PNG for faces, JPEG for what is looked at but once.

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage, imageops};
use project::error::ProjectError;
use std::io;
use std::path::Path;

/// Quality of JPEG pictures, percent.
const JPEG_QUALITY: u8 = 86;

fn failed(error: image::ImageError) -> ProjectError {
    ProjectError::io("written", Path::new("a picture of the review"), io::Error::other(error))
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
