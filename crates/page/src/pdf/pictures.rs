//! Pictures: colours and transparency as two images, compressed as PNG compresses them.

use super::Refs;
use crate::error::PageError;
use crate::list::{Picture, Sampling, png};
use image::{DynamicImage, GrayImage, RgbImage};
use pdf_writer::types::Predictor;
use pdf_writer::writers::ImageXObject;
use pdf_writer::{Filter, Finish, Pdf, Ref};

/// Writes a picture; the object that holds it.
///
/// # Errors
/// A picture that cannot be encoded.
pub(super) fn write(picture: &Picture, pdf: &mut Pdf, refs: &mut Refs) -> Result<Ref, PageError> {
    let pixels = &picture.pixels;
    let [width, height] = [pixels.width(), pixels.height()];
    let is_smooth = picture.sampling == Sampling::Smooth;
    let id = refs.next();
    let is_opaque = pixels.pixels().all(|pixel| pixel.0[3] == 255);
    let mask = if is_opaque {
        None
    } else {
        let alpha = GrayImage::from_fn(width, height, |x, y| image::Luma([pixels.get_pixel(x, y).0[3]]));
        let (mask, bytes) = (refs.next(), idat(&alpha.into())?);
        let mut written = pdf.image_xobject(mask, &bytes);
        describe(&mut written, [width, height], 1);
        written.interpolate(is_smooth).color_space().device_gray();
        Some(mask)
    };
    let colours = RgbImage::from_fn(width, height, |x, y| {
        let [r, g, b, _] = pixels.get_pixel(x, y).0;
        image::Rgb([r, g, b])
    });
    let bytes = idat(&colours.into())?;
    let mut written = pdf.image_xobject(id, &bytes);
    describe(&mut written, [width, height], 3);
    written.interpolate(is_smooth).color_space().device_rgb();
    if let Some(mask) = mask {
        written.s_mask(mask);
    }
    written.finish();
    Ok(id)
}

fn describe(image: &mut ImageXObject, [width, height]: [u32; 2], channels: i32) {
    image.width(width as i32).height(height as i32).bits_per_component(8).filter(Filter::FlateDecode);
    let mut how = image.decode_parms();
    how.predictor(Predictor::PngOptimum).colors(channels).bits_per_component(8).columns(width as i32);
}

/// The compressed rows of a PNG file, which PDF knows as Flate with PNG's predictors.
fn idat(image: &DynamicImage) -> Result<Vec<u8>, PageError> {
    let file = png(image)?;
    let mut rows = Vec::new();
    // A signature of eight bytes, then chunks: length, kind, bytes, checksum.
    let mut rest = &file[8..];
    while let Some(([a, b, c, d], kind)) = rest.first_chunk().zip(rest.get(4..8)) {
        let length = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
        if kind == b"IDAT" {
            rows.extend(&rest[8..8 + length]);
        }
        rest = &rest[12 + length..];
    }
    Ok(rows)
}
