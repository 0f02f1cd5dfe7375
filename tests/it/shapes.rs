//! Horizons of any shape through the binary: an overturned outcrop of scattered points, salt with an overhang, and what
//! cannot be a body.

use crate::runner::{petroglyph, stdout};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn run(arguments: &[&str]) -> String {
    let output = petroglyph().args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    stdout(&output)
}

fn refused(arguments: &[&str]) -> String {
    let output = petroglyph().args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}
