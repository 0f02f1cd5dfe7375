//! PNG files: pixels with their printed size, and animations that keep every colour and its alpha (PNG specification, third
//! edition, 5.2).

use crate::error::PageError;
use crate::format::{AnimationShape, Content, FileFormat, Frames};
use crate::list::DisplayList;
use image::RgbaImage;
use png::{BitDepth, ColorType, Encoder, EncodingError, PixelDimensions, SrgbRenderingIntent, Unit};
use std::io::{self, Write};

pub(crate) const PNG: FileFormat =
    FileFormat { name: "PNG", endings: &["png"], page: Some((Content::Pixels, page)), animation: Some(begin) };

pub(crate) const APNG: FileFormat =
    FileFormat { name: "animated PNG", endings: &["apng"], page: None, animation: Some(begin) };

fn page(list: &DisplayList, dpi: f64, _: &str) -> Result<Vec<u8>, PageError> {
    png(&super::raster(list, dpi)?, dpi)
}

/// Metres in an inch.
const INCH_M: f64 = 0.0254;

/// An image as a PNG file that says its resolution, dots an inch.
///
/// # Errors
/// [`PageError::Png`] where the encoder refuses it.
pub fn png(image: &RgbaImage, dpi: f64) -> Result<Vec<u8>, PageError> {
    still(image, dpi).map_err(PageError::Png)
}

fn still(image: &RgbaImage, dpi: f64) -> Result<Vec<u8>, EncodingError> {
    let mut file = Vec::new();
    let is_opaque = image.pixels().all(|pixel| pixel.0[3] == u8::MAX);
    let mut encoder = encoder(&mut file, [image.width(), image.height()]);
    let per_metre = (dpi / INCH_M).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    if is_opaque {
        encoder.set_color(ColorType::Rgb);
    }
    let mut writer = encoder.write_header()?;
    if is_opaque {
        let pixels: Vec<u8> = image.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]).collect();
        writer.write_image_data(&pixels)?;
    } else {
        writer.write_image_data(image.as_raw())?;
    }
    writer.finish()?;
    Ok(file)
}

fn encoder<W: Write>(out: W, [width, height]: [u32; 2]) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder
}

/// An animation being written.
struct PngFrames<'a>(png::Writer<&'a mut dyn Write>);

fn begin<'a>(out: &'a mut dyn Write, shape: AnimationShape) -> io::Result<Box<dyn Frames + 'a>> {
    let mut encoder = encoder(out, shape.size_px);
    encoder.set_animated(shape.frames, 0).map_err(below)?;
    encoder.set_frame_delay(shape.delay_ms(), 1000).map_err(below)?;
    Ok(Box::new(PngFrames(encoder.write_header().map_err(below)?)))
}

impl Frames for PngFrames<'_> {
    fn add(&mut self, frame: &RgbaImage) -> io::Result<()> {
        self.0.write_image_data(frame.as_raw()).map_err(below)
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.0.finish().map_err(below)
    }
}

/// The error of the file below an error of the encoder.
fn below(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_png_keeps_its_pixels_and_its_printed_size() {
        for alpha in [255, 100] {
            let image = RgbaImage::from_fn(3, 2, |x, y| Rgba([x as u8 * 9, y as u8 * 9, 7, alpha]));
            let file = png(&image, 300.0).unwrap();
            assert_eq!(image::load_from_memory(&file).unwrap().to_rgba8(), image);
            let reader = png::Decoder::new(io::Cursor::new(&file)).read_info().unwrap();
            let dims = reader.info().pixel_dims.unwrap();
            assert_eq!((dims.xppu, dims.yppu, dims.unit), (11811, 11811, Unit::Meter));
        }
    }
}
