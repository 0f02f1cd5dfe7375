//! GIF files (Graphics Interchange Format, version 89a, CompuServe 1990): the extension that makes browsers repeat, and for
//! each frame a delay, a palette and its indices.

use super::palette::{Paletted, reduced};
use crate::format::{AnimationShape, FileFormat, Frames};
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use image::RgbaImage;
use std::io::{self, Write};

pub(crate) const GIF: FileFormat = FileFormat { name: "GIF", endings: &["gif"], page: None, animation: Some(begin) };

/// Writes frames one after the other.
struct GifFrames<'a> {
    encoder: Encoder<&'a mut dyn Write>,
    size: [u16; 2],
    delay_cs: u16,
}

fn begin<'a>(out: &'a mut dyn Write, shape: AnimationShape) -> io::Result<Box<dyn Frames + 'a>> {
    let side = |pixels: u32| {
        let told = || format!("a GIF has at most 65535 pixels a side, not {pixels}");
        u16::try_from(pixels).map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, told()))
    };
    let size = [side(shape.size_px[0])?, side(shape.size_px[1])?];
    let mut encoder = Encoder::new(out, size[0], size[1], &[]).map_err(below)?;
    encoder.set_repeat(Repeat::Infinite).map_err(below)?;
    // Browsers show frames of less than two hundredths of a second slowly.
    Ok(Box::new(GifFrames { encoder, size, delay_cs: ((shape.delay_ms() + 5) / 10).max(2) }))
}

impl Frames for GifFrames<'_> {
    fn add(&mut self, frame: &RgbaImage) -> io::Result<()> {
        let Paletted { mut colours, clear, indices } = reduced(frame);
        // The entry of clear pixels follows the colours.
        colours.extend(clear.map(|_| [0; 3]));
        let frame = Frame {
            delay: self.delay_cs,
            // The frame is removed before the next one where that shows through, otherwise it stays below it.
            dispose: if clear.is_some() { DisposalMethod::Background } else { DisposalMethod::Keep },
            transparent: clear,
            width: self.size[0],
            height: self.size[1],
            palette: Some(colours.into_flattened()),
            buffer: indices.into(),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(below)
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.encoder.into_inner().map_err(below)?.flush()
    }
}

/// The error of the file below an error of the encoder.
fn below(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_that_a_gif_cannot_hold_is_refused() {
        assert!(begin(&mut Vec::new(), AnimationShape { size_px: [65_536, 2], frames: 2, rate: 10.0 }).is_err());
    }
}
