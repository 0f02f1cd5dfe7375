//! Why a page cannot be drawn or written.

/// Why a page cannot be drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// A page of no size, or of too many pixels.
    #[error(
        "a page of {:.0} x {:.0} pixels cannot be drawn: each side must have 1 to {most}; change the size or the resolution",
        size_px[0], size_px[1]
    )]
    PageSize {
        /// Its width and height, pixels.
        size_px: [f64; 2],
        /// Most pixels a side.
        most: u32,
    },
    /// A TIFF file that its own numbers cannot address.
    #[error("this picture is too large for a TIFF file, which holds 4 GiB; make it smaller or write a PNG")]
    TiffSize,
    /// A kind of file that holds no page.
    #[error("{format} holds no page")]
    NoPage {
        /// What it is called.
        format: &'static str,
    },
    /// Pixels that the encoder refused.
    #[error("the picture could not be encoded as PNG")]
    Png(#[source] png::EncodingError),
    /// A picture on the page could not be encoded.
    #[error("a picture on the page could not be encoded")]
    Encode(#[source] image::ImageError),
}
