//! Files that are known but not read: archives, documents of offices, databases, grids of other kinds.

use super::{geopackage, text};
use std::path::Path;

/// The bytes that a kind of file begins with, and what to export instead.
const STARTS: [(&[u8], &str); 24] = [
    (b"AutoCAD Binary DXF", "it is a binary DXF drawing: save it as ASCII DXF"),
    (b"#GeoProbe", "it is a GeoProbe surface, which is not read: export it as GOCAD TSurf or as x, y, z"),
    (b"GOCAD ", "of GOCAD's objects TSurf, VSet and PLine are read: export it as one of these"),
    (
        b"SQLite format 3",
        "it is a database (SQLite), such as SpatiaLite or MBTiles, and no GeoPackage: export the layer as one (ogr2ogr), \
         or as csv with x, y, z",
    ),
    (b"\x1f\x8b", "it is a gzip archive: unpack it first"),
    (b"BZh", "it is a bzip2 archive: unpack it first"),
    (b"\xfd7zXZ", "it is an xz archive: unpack it first"),
    (b"\x28\xb5\x2f\xfd", "it is a Zstandard archive: unpack it first"),
    (b"7z\xbc\xaf\x27\x1c", "it is a 7-Zip archive: unpack it first"),
    (b"Rar!\x1a\x07", "it is a RAR archive: unpack it first"),
    (b"\xd0\xcf\x11\xe0", "it is a file of Microsoft Office, or an old Petrel project: save the sheet as csv"),
    (b"{\\rtf", "it is a document (RTF): save its table as csv"),
    (
        b"\x89HDF",
        "it is HDF5, as NetCDF-4 and RESQML are: write NetCDF classic (nccopy -k classic), or csv, Irap or Esri ASCII",
    ),
    (b"\x84\x83\x82\x81", "it is OMF 1: export its surfaces as OBJ, DXF or GOCAD TSurf, its points as csv"),
    (b"II\x2a\0\x10\0\0\0CR", "it is a camera's raw picture, which has no heights"),
    (b"\x89PNG", "it is a picture (PNG), which has no heights: export the grid that it shows"),
    (b"\xff\xd8\xff", "it is a picture (JPEG), which has no heights: export the grid that it shows"),
    (b"EHFA_HEADER_TAG", "it is an Erdas Imagine grid: export it as GeoTIFF (gdal_translate)"),
    (b"LASF", "it is a point cloud (LAS of ASPRS): export it as x, y, z (las2txt)"),
    (b"ply\n", "it is a PLY mesh: save it as OBJ or STL, in MeshLab for example"),
    (b"ply\r", "it is a PLY mesh: save it as OBJ or STL, in MeshLab for example"),
    (b"# vtk DataFile", "it is a VTK file: save the surface as OBJ or STL, in ParaView for example"),
    (b"%PDF", "it is a PDF: digitise what it shows, or ask for its data"),
    (b"glTF", "it is a glTF model: save it as OBJ or STL, in Blender for example"),
];

/// The words that a line near the start of a text begins with.
const WORDS: [(&str, &str); 7] = [
    ("SPECGRID", "it is an Eclipse grid (GRDECL): export its horizons as surfaces"),
    ("ZCORN", "it is an Eclipse grid (GRDECL): export its horizons as surfaces"),
    ("COORD\n", "it is an Eclipse grid (GRDECL): export its horizons as surfaces"),
    ("MAPAXES", "it is an Eclipse grid (GRDECL): export its horizons as surfaces"),
    ("<LandXML", "it is LandXML: export the surface as DXF or as x, y, z"),
    ("<kml", "it is KML, whose places are degrees: project them and save them as GeoJSON or a shapefile (ogr2ogr)"),
    ("<?xml", "it is XML, such as RESQML or GML: export the surface as GOCAD TSurf or x, y, z"),
];

/// What a ZIP archive is by the names of the files that it holds, or by its own extension.
const ZIPPED: [(&str, &str); 8] = [
    ("xl/", "it is a workbook of Excel: save the sheet as csv"),
    ("word/", "it is a document of Word: save its table as csv"),
    ("ppt/", "it is a presentation, which has no heights: ask for its data"),
    ("mimetypeapplication/vnd.oasis.opendocument", "it is a document of LibreOffice: save the sheet as csv"),
    ("resqml", "it is RESQML (EPC): export its surfaces as GOCAD TSurf, Irap or x, y, z"),
    (".npy", "it is an archive of NumPy (npz): save each array alone (numpy.save)"),
    (".shp", "it is a zipped shapefile: unpack it, .shp, .dbf and .prj into one folder"),
    (".kml", "it is KMZ, whose places are degrees: project them and save them as GeoJSON or a shapefile (ogr2ogr)"),
];

/// Bytes of an archive in which names are looked for, at its start and at its end.
const NAMES_WITHIN: usize = 1 << 16;

/// What a file is that is known but not read, and what to export instead.
pub(super) fn by_name(path: &Path, bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
        return Some(zipped(path, bytes));
    }
    if bytes.get(257..262) == Some(b"ustar") {
        return Some("it is a tar archive: unpack it first");
    }
    if bytes.starts_with(b"AC10") && bytes.get(6) == Some(&0) {
        return Some("it is a DWG drawing: save it as ASCII DXF");
    }
    if geopackage::is_one(path, bytes) {
        return None;
    }
    if let Some((_, what)) = STARTS.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Some(what);
    }
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(2000)]);
    // A word with an end of line after it stands alone.
    let begins = |word: &str| {
        text::lines(&start).any(|line| match word.strip_suffix('\n') {
            Some(word) => line.text == word,
            None => line.text.starts_with(word),
        })
    };
    let found = WORDS.iter().find(|(word, _)| begins(word)).map(|(_, what)| *what);
    found.or_else(|| ["grdecl", "egrid"].contains(&extension_of(path).as_str()).then_some(WORDS[0].1))
}

fn extension_of(path: &Path) -> String {
    path.extension().map_or_else(String::new, |extension| extension.to_string_lossy().to_ascii_lowercase())
}

fn zipped(path: &Path, bytes: &[u8]) -> &'static str {
    match extension_of(path).as_str() {
        "epc" => return ZIPPED[4].1,
        "omf" => return "it is OMF 2: export its surfaces as OBJ, DXF or GOCAD TSurf, its points as csv",
        _ => {}
    }
    let ends = [&bytes[..bytes.len().min(NAMES_WITHIN)], &bytes[bytes.len().saturating_sub(NAMES_WITHIN)..]];
    let has = |name: &str| ends.iter().any(|part| part.windows(name.len()).any(|window| window == name.as_bytes()));
    let known = ZIPPED.iter().find(|(name, _)| has(name)).map(|(_, what)| *what);
    known.unwrap_or("it is a ZIP archive, as exports of Petrel are, too: unpack it first")
}
