//! Files that are known but not read: archives, databases, grids of other kinds.

use super::text;

/// What a file is that is known but not read, and what to export instead.
pub(super) fn by_name(bytes: &[u8]) -> Option<&'static str> {
    const KNOWN: [(&[u8], &str); 17] = [
        (b"\x93NUMPY", "it is a NumPy array, which has values but no places: write x, y, z as csv"),
        (b"AutoCAD Binary DXF", "it is a binary DXF drawing: save it as ASCII DXF"),
        (b"#GeoProbe", "it is a GeoProbe surface, which is not read: export it as GOCAD TSurf or as x, y, z"),
        (b"GOCAD ", "of GOCAD's objects TSurf, VSet and PLine are read: export it as one of these"),
        (
            b"SQLite format 3",
            "it is a database such as a GeoPackage: export the layer as GeoJSON or as csv with x, y, z",
        ),
        (
            b"PK\x03\x04",
            "it is a ZIP archive, or an Office file, RESQML or a Petrel export: unpack it, or export tables as csv",
        ),
        (b"\x1f\x8b", "it is a gzip archive: unpack it first"),
        (b"BZh", "it is a bzip2 archive: unpack it first"),
        (b"\xfd7zXZ", "it is an xz archive: unpack it first"),
        (b"7z\xbc\xaf", "it is a 7-Zip archive: unpack it first"),
        (b"\xd0\xcf\x11\xe0", "it is a file of Microsoft Office: save the sheet as csv"),
        (b"\x89HDF", "it is HDF5, as NetCDF-4, RESQML and OMF 2 are: export the surface as csv, Irap or Esri ASCII"),
        (b"CDF\x01", "it is a NetCDF grid: export it as Esri ASCII (gdal_translate -of AAIGrid) or x, y, z (grd2xyz)"),
        (b"CDF\x02", "it is a NetCDF grid: export it as Esri ASCII (gdal_translate -of AAIGrid) or x, y, z (grd2xyz)"),
        (b"II*\0", "it is a TIFF or GeoTIFF: export it as Esri ASCII (gdal_translate -of AAIGrid)"),
        (b"MM\0*", "it is a TIFF or GeoTIFF: export it as Esri ASCII (gdal_translate -of AAIGrid)"),
        (b"\0\0\x27\x0a", "it is a shapefile: export the layer as GeoJSON (ogr2ogr)"),
    ];
    const WORDS: [(&str, &str); 5] = [
        ("SPECGRID", "it is an Eclipse grid (GRDECL): export its horizons as surfaces"),
        ("ZCORN", "it is an Eclipse grid (GRDECL): export its horizons as surfaces"),
        ("<?xml", "it is XML, such as RESQML or LandXML: export the surface as GOCAD TSurf or x, y, z"),
        ("#GTYPE", "it is a GXF grid: export it as Esri ASCII (gdal_translate -of AAIGrid)"),
        ("%PDF", "it is a PDF: digitise what it shows, or ask for its data"),
    ];
    let by_bytes = KNOWN.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, what)| *what);
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(2000)]);
    let begins = |word: &str| text::lines(&start).any(|line| line.text.starts_with(word));
    by_bytes.or_else(|| WORDS.iter().find(|(word, _)| begins(word)).map(|(_, what)| *what))
}
