//! Whole files, in and out: the formats' own examples, round trips, bad input, and real data.

mod bounds;
mod cases;
mod drawings;
mod faults;
mod features;
mod foreign;
mod geopackages;
mod grids;
mod known;
mod meshes;
mod netcdf;
mod penobscot;
mod polygons;
mod random;
mod rasters;
mod real;
mod refusals;
mod round_trips;
mod tables;
mod units;
mod vectors;

use super::*;
use bounds::{InterpretationFile, survey_from_points};
use std::path::PathBuf;

/// Writes a text to a file in a folder of its own.
fn file(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    bytes(name, text.as_bytes())
}

/// Writes bytes to a file in a folder of its own.
fn bytes(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

/// The one horizon of a text.
fn horizon(text: &str, geometry: &SurveyGeometry, options: &ImportOptions) -> (Horizon, ImportReport) {
    let (_folder, path) = file("A.dat", text);
    let mut found = read_horizons(&path, geometry, options).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(found.len(), 1);
    found.remove(0)
}

#[test]
fn every_format_has_one_codec_and_its_own_name() {
    for format in Format::all() {
        assert_eq!(Format::from_name(format.name()), Some(format));
        assert_eq!(format.codec().format, format);
        assert_eq!(Format::all().filter(|f| *f == format).count(), 1);
    }
}
