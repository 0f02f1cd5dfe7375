//! Pictures that follow one another, as an animated PNG or GIF.
//!
//! Frames are written as they come, so that memory holds one of them. An animated PNG keeps every colour and its alpha
//! (PNG specification, third edition, 5.2); a GIF has 256 colours a frame, chosen anew for each (`palette`), pixels
//! that are clear or opaque, and delays in hundredths of a second. Animated WebP and AV1 need encoders that are not
//! here.

mod gif;
mod palette;

pub use palette::{Paletted, reduced};

use gif::GifWriter;
use image::RgbaImage;
use std::io::{self, Write};

/// The file format of an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnimationFormat {
    /// Animated PNG.
    Png,
    /// GIF.
    Gif,
}

/// Of what an animation consists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnimationShape {
    /// Width and height of every frame, pixels.
    pub size_px: [u32; 2],
    /// Number of frames.
    pub frames: u32,
    /// Frames a second.
    pub rate: f64,
}

impl AnimationShape {
    /// How long a frame is shown, in thousandths of a second.
    fn delay_ms(&self) -> u16 {
        (1000.0 / self.rate).round().clamp(1.0, f64::from(u16::MAX)) as u16
    }
}

/// Writes an animation that repeats for ever, frame by frame.
///
/// ```
/// use page::animation::{AnimationFormat, AnimationShape, AnimationWriter};
/// let shape = AnimationShape { size_px: [4, 3], frames: 2, rate: 10.0 };
/// let mut file = Vec::new();
/// let mut writer = AnimationWriter::new(&mut file, AnimationFormat::Gif, shape)?;
/// for grey in [0, 255] {
///     writer.add(&image::RgbaImage::from_pixel(4, 3, image::Rgba([grey, grey, grey, 255])))?;
/// }
/// writer.finish()?;
/// assert_eq!(file[..6], *b"GIF89a");
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct AnimationWriter<'a> {
    shape: AnimationShape,
    frames: u32,
    encoder: Encoder<'a>,
}

enum Encoder<'a> {
    Png(Box<png::Writer<&'a mut dyn Write>>),
    Gif(GifWriter<'a>),
}

/// The error of the file below an error of the PNG encoder.
fn below(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

impl<'a> AnimationWriter<'a> {
    /// Begins a file.
    ///
    /// # Errors
    /// Nothing could be written, or a GIF is asked for with more than 65 535 pixels a side.
    pub fn new(out: &'a mut dyn Write, format: AnimationFormat, shape: AnimationShape) -> io::Result<Self> {
        let [width, height] = shape.size_px;
        let encoder = match format {
            AnimationFormat::Png => {
                let mut encoder = png::Encoder::new(out, width, height);
                encoder.set_color(png::ColorType::Rgba);
                encoder.set_depth(png::BitDepth::Eight);
                encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
                encoder.set_animated(shape.frames, 0).map_err(below)?;
                encoder.set_frame_delay(shape.delay_ms(), 1000).map_err(below)?;
                Encoder::Png(Box::new(encoder.write_header().map_err(below)?))
            }
            AnimationFormat::Gif => Encoder::Gif(GifWriter::new(out, shape.size_px, shape.delay_ms())?),
        };
        Ok(Self { shape, frames: 0, encoder })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// It could not be written, has another size, or is one too many.
    pub fn add(&mut self, frame: &RgbaImage) -> io::Result<()> {
        let size = [frame.width(), frame.height()];
        if size != self.shape.size_px || self.frames == self.shape.frames {
            let told = format!("a frame of {size:?} pixels after {} of {:?}", self.frames, self.shape);
            return Err(io::Error::new(io::ErrorKind::InvalidInput, told));
        }
        self.frames += 1;
        match &mut self.encoder {
            Encoder::Png(writer) => writer.write_image_data(frame.as_raw()).map_err(below),
            Encoder::Gif(writer) => writer.add(frame),
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// It could not be written, or frames are missing.
    pub fn finish(self) -> io::Result<()> {
        if self.frames < self.shape.frames {
            let told = format!("{} of {} frames", self.frames, self.shape.frames);
            return Err(io::Error::new(io::ErrorKind::InvalidInput, told));
        }
        match self.encoder {
            Encoder::Png(writer) => writer.finish().map_err(below),
            Encoder::Gif(writer) => writer.finish(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    const SHAPE: AnimationShape = AnimationShape { size_px: [37, 23], frames: 3, rate: 12.5 };

    /// A frame with many colours and a clear corner.
    fn frame(index: u32) -> RgbaImage {
        RgbaImage::from_fn(37, 23, |x, y| match (x + index < 5, y < 4) {
            (true, true) => Rgba([0; 4]),
            _ => Rgba([(x * 6) as u8, (y * 10) as u8, (index * 80) as u8, 255]),
        })
    }

    fn written(format: AnimationFormat) -> Vec<u8> {
        let mut file = Vec::new();
        let mut writer = AnimationWriter::new(&mut file, format, SHAPE).unwrap();
        (0..3).for_each(|index| writer.add(&frame(index)).unwrap());
        writer.finish().unwrap();
        file
    }

    #[test]
    fn a_png_gives_its_frames_back() {
        let file = written(AnimationFormat::Png);
        let mut reader = png::Decoder::new(io::Cursor::new(&file)).read_info().unwrap();
        let control = reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        for index in 0..3 {
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            assert_eq!(&pixels, frame(index).as_raw(), "frame {index}");
            let told = reader.info().frame_control().unwrap();
            assert_eq!((told.delay_num, told.delay_den), (80, 1000));
        }
    }

    #[test]
    fn a_gif_gives_its_frames_back_but_for_small_differences_of_colour() {
        let file = written(AnimationFormat::Gif);
        let read = gif::tests::decoded(&file);
        assert_eq!((read.size, read.frames.len(), read.delays.as_slice()), ([37, 23], 3, &[8, 8, 8][..]));
        for (index, pixels) in read.frames.iter().enumerate() {
            for (found, drawn) in pixels.iter().zip(frame(index as u32).pixels()) {
                assert_eq!(found.is_none(), drawn.0[3] == 0);
                let far = |found: &[u8; 3]| (0..3).any(|c| found[c].abs_diff(drawn.0[c]) > 24);
                assert!(!found.as_ref().is_some_and(far), "frame {index}: {found:?} for {drawn:?}");
            }
        }
    }

    #[test]
    fn too_few_too_many_and_other_frames_are_refused() {
        for format in [AnimationFormat::Png, AnimationFormat::Gif] {
            let mut file = Vec::new();
            let mut writer = AnimationWriter::new(&mut file, format, SHAPE).unwrap();
            assert!(writer.add(&RgbaImage::new(3, 3)).is_err());
            writer.add(&frame(0)).unwrap();
            assert!(writer.finish().is_err());
            let mut file = Vec::new();
            let mut writer = AnimationWriter::new(&mut file, format, SHAPE).unwrap();
            (0..3).for_each(|index| writer.add(&frame(index)).unwrap());
            assert!(writer.add(&frame(3)).is_err());
        }
    }
}
