//! Compression that several of a page's formats share.

use flate2::{Compression, write::ZlibEncoder};
use std::io::Write;

/// Bytes compressed as zlib does (RFC 1950); the same bytes give the same file.
pub(crate) fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("a list of bytes takes every byte")
}
