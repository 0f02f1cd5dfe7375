//! Files that are known but not read are named, with what to export instead.

use super::*;

fn refused(name: &str, content: &[u8]) -> FormatError {
    let (_folder, path) = bytes(name, content);
    let asked = known_but_not_read(&path, content);
    let error = describe(&path, &ImportOptions::default()).unwrap_err();
    assert_eq!(asked.map(|asked| asked.to_string()), Some(error.to_string()), "{name}");
    error
}

fn zip(names: &[&str]) -> Vec<u8> {
    names.iter().flat_map(|name| [b"PK\x03\x04".as_slice(), &[0; 26], name.as_bytes(), b"content"].concat()).collect()
}

#[test]
fn archives_offices_and_grids_of_other_kinds_are_named_whatever_their_length() {
    let long = |start: &[u8]| [start, &[7; 9000]].concat();
    let mut tar = vec![0; 512];
    tar[257..263].copy_from_slice(b"ustar\0");
    for (name, content, words) in [
        ("a.zip", zip(&["horizons/top.dat"]), "ZIP archive"),
        ("a.xlsx", zip(&["[Content_Types].xml", "xl/workbook.xml"]), "workbook of Excel"),
        ("a.docx", zip(&["[Content_Types].xml", "word/document.xml"]), "document of Word"),
        ("a.pptx", zip(&["[Content_Types].xml", "ppt/presentation.xml"]), "presentation"),
        ("a.ods", zip(&["mimetypeapplication/vnd.oasis.opendocument.spreadsheet"]), "LibreOffice"),
        ("a.npz", zip(&["a.npy"]), "npz"),
        ("a.epc", zip(&["[Content_Types].xml"]), "RESQML"),
        ("a.omf", zip(&["index.json.gz"]), "OMF 2"),
        ("b.zip", zip(&["faults.shp"]), "zipped shapefile"),
        ("a.kmz", zip(&["doc.kml"]), "degrees"),
        ("a.omf", long(b"\x84\x83\x82\x81OMF-v0.9.0"), "OMF 1"),
        ("a.gz", long(b"\x1f\x8b\x08"), "gzip"),
        ("a.7z", long(b"7z\xbc\xaf\x27\x1c"), "7-Zip"),
        ("a.rar", long(b"Rar!\x1a\x07\x01\0"), "RAR"),
        ("a.tar", [tar, vec![0; 9000]].concat(), "tar archive"),
        ("a.bz2", long(b"BZh91AY"), "bzip2"),
        ("a.xz", long(b"\xfd7zXZ\0"), "xz archive"),
        ("a.zst", long(b"\x28\xb5\x2f\xfd"), "Zstandard"),
        ("a.xls", long(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"), "Microsoft Office"),
        ("a.nc", long(b"\x89HDF\r\n\x1a\n"), "nccopy -k classic"),
        ("a.mbtiles", long(b"SQLite format 3\0"), "MBTiles"),
        ("a.sqlite", long(b"SQLite format 3\0"), "no GeoPackage"),
        ("a.grdecl", b"-- made by Petrel\nSPECGRID\n10 10 10 1 F /\nCOORD\n1 2 3 4 5 6 /\n".to_vec(), "GRDECL"),
        ("a.inc", b"COORD\n1 2 3 4 5 6 /\n".to_vec(), "GRDECL"),
        ("a.xml", b"<?xml version=\"1.0\"?>\n<a/>\n".to_vec(), "XML"),
        ("a.kml", b"<?xml version=\"1.0\"?>\n<kml>\n</kml>".to_vec(), "KML"),
        ("a.xml", b"<?xml version=\"1.0\"?>\n<LandXML>\n</LandXML>".to_vec(), "LandXML"),
        ("a.ply", b"ply\nformat ascii 1.0\n".to_vec(), "PLY"),
        ("a.vtk", b"# vtk DataFile Version 3.0\n".to_vec(), "VTK"),
        ("a.dwg", long(b"AC1032\0\0"), "DWG"),
        ("a.pdf", long(b"%PDF-1.7"), "PDF"),
        ("a.png", long(b"\x89PNG\r\n\x1a\n"), "picture"),
        ("a.las", long(b"LASF"), "point cloud"),
        ("a.glb", long(b"glTF\x02\0\0\0"), "glTF"),
    ] {
        match refused(name, &content) {
            FormatError::UnknownFormat { found, is_named: true, .. } => {
                assert!(found.contains(words), "{name}: {found}");
            }
            other => panic!("{name}: {other}"),
        }
    }
    for text in ["AC10,1,2\n", "x,y,z\n1,2,3\n", "ply,x,y\n"] {
        assert!(known_but_not_read("a.csv".as_ref(), text.as_bytes()).is_none(), "{text}");
    }
}
