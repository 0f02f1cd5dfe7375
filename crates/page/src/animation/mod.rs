//! Pictures that follow one another, as one file.
//!
//! Frames are written as they come, so that memory holds one of them. An animated PNG keeps every colour and its alpha;
//! a GIF has 256 colours a frame, chosen anew for each (`palette`), pixels that are clear or opaque, and delays in
//! hundredths of a second. Animated WebP and AV1 need encoders that are not
//! here.

mod gif;
mod palette;

pub(crate) use gif::GIF;
pub use palette::{Paletted, reduced};

pub use crate::format::AnimationShape;

use crate::format::{FileFormat, Frames};
use image::RgbaImage;
use std::io::{self, Write};

/// Writes an animation that repeats for ever, frame by frame.
///
/// ```
/// use page::FileFormat;
/// use page::animation::{AnimationShape, AnimationWriter};
/// let format = FileFormat::of_animation("turn.gif".as_ref()).unwrap();
/// let shape = AnimationShape { size_px: [4, 3], frames: 2, rate: 10.0 };
/// let mut file = Vec::new();
/// let mut writer = AnimationWriter::new(&mut file, format, shape)?;
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
    encoder: Box<dyn Frames + 'a>,
}

impl<'a> AnimationWriter<'a> {
    /// Begins a file.
    ///
    /// # Errors
    /// Nothing could be written, the format holds no animation, or none of this size.
    pub fn new(out: &'a mut dyn Write, format: &FileFormat, shape: AnimationShape) -> io::Result<Self> {
        let Some(begin) = format.animation else {
            let told = format!("{} holds no animation", format.name);
            return Err(io::Error::new(io::ErrorKind::InvalidInput, told));
        };
        Ok(Self { shape, frames: 0, encoder: begin(out, shape)? })
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
        self.encoder.add(frame)
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
        self.encoder.finish()
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

    fn written(format: &FileFormat) -> Vec<u8> {
        let mut file = Vec::new();
        let mut writer = AnimationWriter::new(&mut file, format, SHAPE).unwrap();
        (0..3).for_each(|index| writer.add(&frame(index)).unwrap());
        writer.finish().unwrap();
        file
    }

    #[test]
    fn a_png_gives_its_frames_back() {
        let file = written(&crate::raster::PNG);
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
        let file = written(&GIF);
        let mut options = ::gif::DecodeOptions::new();
        options.set_color_output(::gif::ColorOutput::RGBA);
        let mut reader = options.read_info(file.as_slice()).unwrap();
        assert_eq!((reader.width(), reader.height(), reader.repeat()), (37, 23, ::gif::Repeat::Infinite));
        for index in 0..3 {
            let read = reader.read_next_frame().unwrap().unwrap();
            assert_eq!((read.delay, read.dispose), (8, ::gif::DisposalMethod::Background));
            for (found, drawn) in read.buffer.as_chunks::<4>().0.iter().zip(frame(index).pixels()) {
                assert_eq!(found[3] == 0, drawn.0[3] == 0);
                let far = found[3] > 0 && (0..3).any(|c| found[c].abs_diff(drawn.0[c]) > 24);
                assert!(!far, "frame {index}: {found:?} for {drawn:?}");
            }
        }
        assert!(reader.read_next_frame().unwrap().is_none());
    }

    #[test]
    fn too_few_too_many_and_other_frames_are_refused() {
        for format in FileFormat::animations() {
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
