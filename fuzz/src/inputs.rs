//! What seeds are made of: an interpretation for our writers, and one small file of each format that we do not write.

use glam::{DVec2, DVec3};
use survey::well::{Survey, WellPath};
use survey::{Fault, Horizon, NodeGrid, Quality, Sheet, SurveyGeometry, TriangleMesh};

/// A dipping horizon with a hole, and a fault of four triangles.
pub fn interpretation(geometry: &SurveyGeometry) -> (Horizon, Fault) {
    let grid = NodeGrid::of_survey(geometry);
    let [columns, rows] = grid.count;
    let depth = (0..columns * rows).map(|k| if k == 7 { f32::NAN } else { 40.0 + (k / rows) as f32 * 1.5 }).collect();
    let horizon = Horizon::new("Top A", vec![Sheet::new(grid, depth, Quality::Picked)]);
    let vertices =
        [[50.0, 0.0, 20.0], [70.0, 0.0, 160.0], [50.0, 100.0, 20.0], [70.0, 100.0, 160.0], [50.0, 180.0, 20.0]];
    let mesh = TriangleMesh {
        vertices: vertices.into_iter().map(DVec3::from_array).collect(),
        triangles: vec![[0, 1, 2], [2, 1, 3], [2, 3, 4]],
    };
    (horizon, Fault::new("F1", mesh))
}

/// A well that builds up from the vertical to 60 degrees.
pub fn well_path() -> WellPath {
    let surveys = [(0.0, 0.0), (500.0, 0.0), (1500.0, 60.0), (3000.0, 60.0)].map(|(md_m, inclination_deg)| Survey {
        md_m,
        inclination_deg,
        azimuth_deg: 45.0,
    });
    match WellPath::minimum_curvature(DVec2::new(500.0, 700.0), 25.0, &surveys) {
        Ok(path) => path,
        Err(error) => panic!("{error}"),
    }
}

/// Kind and content of files of wells.
pub const WELL_FILES: &[(&str, &str)] = &[
    ("deviation", "# WELL NAME: A-1\n# KB 25\nMD,INC,AZI\n0,0,0\n500,0,0\n1500,60,45\n"),
    ("deviation", "MD(ft) X Y TVDSS\n0 500 700 -25\n1000 500 700 975\n2000 900 700 1800\n"),
    ("tops", "Well Surface MD\nA-1 \"Top Chalk\" 812.5\nA-1 Base 1204\n"),
    ("tops", "surface,tvdss_m\nTop A,700\nTop B,900.5\n"),
    ("checkshot", "TVDSS TWT\n0 0\n500 480\n1500 1210\n"),
    ("deviation", "# DEPTHS IN ft-UNITS\nhole_id,depth,dip,azimuth\nA,0,-60,90\nA,100,********,90\nA,200,-55,95\n"),
    ("deviation", "P-1H\n500 700 -25 0\n500 700 75 100\n500 790 110 200\n"),
    (
        "rms",
        "1.0\nUNDEFINED\nA 1 500 700 25\n2\nMDepth UNK lin\nZone DISC 0 a 1 b\n500 700 -25 0 0\n500 700 75 100 1\n",
    ),
    ("checkshot", "MD(m),OWT(s)\n25,0\n1000,0.41\n"),
    (
        "tops",
        "~Version\nVERS. 3.0 :\nDLM. COMMA :\n~Well\nSTRT.FT 1 :\n~Tops_Parameter\nTOPDR. Subsea :\n~Tops_Definition\nTOPN. : {S}\
         \nTOPT.M : {F}\n~Tops_Data | Tops_Definition\n\"Top, A\",700\nB,900\n",
    ),
    (
        "las",
        "~Version\nVERS. 2.0 :\nWRAP. NO :\n~Well\nSTRT.M 100 :\nSTOP.M 101 :\nSTEP.M 0.5 :\nNULL. -999.25 :\
         \nWELL. A-1 :\n~Curve\nDEPT.M :\nGR.API : gamma\n~Ascii\n100 45.5\n100.5 -999.25\n101 47\n",
    ),
];

/// Format and content of files that are not text: STL, a NumPy array, a TIFF, NetCDF, a shapefile, a GeoPackage.
pub fn binary_files() -> Vec<(&'static str, Vec<u8>)> {
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let mut stl = vec![b' '; 80];
    stl.extend(1_u32.to_le_bytes());
    stl.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 40.0, 50.0, 0.0, 44.0, 0.0, 50.0, 48.0]));
    stl.extend([0, 0]);

    let head = "{'descr': '<f4', 'fortran_order': False, 'shape': (12, 9), }\n";
    let mut npy = b"\x93NUMPY\x01\0".to_vec();
    npy.extend((head.len() as u16).to_le_bytes());
    npy.extend(head.as_bytes());
    npy.extend(floats(&[44.0; 12 * 9]));

    // 3 by 2 pixels after the header, then the values of three tags, then the directory.
    let mut tiff =
        [b"II*\0".to_vec(), 104_u32.to_le_bytes().to_vec(), floats(&[40.0, 41.0, 42.0, 43.0, 44.0, 45.0])].concat();
    tiff.extend(doubles(&[25.0, 25.0, 0.0, 0.0, 0.0, 0.0]));
    tiff.extend([1_u16, 1, 0, 2, 1024, 0, 1, 1, 1025, 0, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
    let entries: [(u16, u16, u32, u32); 11] = [
        (256, 3, 1, 3),
        (257, 3, 1, 2),
        (258, 3, 1, 32),
        (259, 3, 1, 1),
        (262, 3, 1, 1),
        (273, 4, 1, 8),
        (279, 4, 1, 24),
        (339, 3, 1, 3),
        (33550, 12, 3, 32),
        (33922, 12, 6, 32),
        (34735, 3, 12, 80),
    ];
    tiff.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, count, value) in entries {
        tiff.extend([&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value.to_le_bytes()].concat());
    }
    tiff.extend([0; 4]);

    let big = |values: &[u32]| values.iter().flat_map(|v| v.to_be_bytes()).collect::<Vec<u8>>();
    let variable = |name: u8, axes: &[u32], begin: u32| {
        [big(&[1]), vec![name, 0, 0, 0], big(&[axes.len() as u32]), big(axes), big(&[0, 0, 6, 16, begin])].concat()
    };
    let dimension = |name: u8| [big(&[1]), vec![name, 0, 0, 0], big(&[2])].concat();
    let begin = 180;
    let mut netcdf =
        [b"CDF\x01".to_vec(), big(&[0, 10, 2]), dimension(b'y'), dimension(b'x'), big(&[0, 0, 11, 3])].concat();
    netcdf.extend(variable(b'x', &[1], begin));
    netcdf.extend(variable(b'y', &[0], begin + 16));
    netcdf.extend(variable(b'z', &[0, 1], begin + 32));
    netcdf.resize(begin as usize, 0);
    netcdf.extend([0.0, 25.0, 0.0, 25.0, 40.0, 41.0, 42.0, 43.0_f64].iter().flat_map(|v| v.to_be_bytes()));

    let mut shapefile = big(&[9994]);
    shapefile.resize(100, 0);
    shapefile.extend(big(&[1, 44]));
    shapefile.extend([3_u32.to_le_bytes().to_vec(), vec![0; 32]].concat());
    shapefile.extend([1_u32, 2, 0].iter().flat_map(|v| v.to_le_bytes()));
    shapefile.extend(doubles(&[500.0, 500.0, 600.0, 700.0]));
    shapefile.resize(100 + 8 + 88, 0);
    vec![
        ("stl", stl),
        ("npy", npy),
        ("geotiff", tiff),
        ("netcdf", netcdf),
        ("shapefile", shapefile),
        ("geopackage", geopackage()),
    ]
}

/// A GeoPackage of one trace: four tables of one row each, each in a page of 512 bytes.
fn geopackage() -> Vec<u8> {
    // Kinds of values: 0 is none, 1 a byte, 12 + 2 n bytes, 13 + 2 n a text.
    let text = |text: &str| (13 + 2 * text.len() as u16, text.as_bytes().to_vec());
    let byte = |value: u8| (1_u16, vec![value]);
    let varint = |number: u16| match number {
        0..=127 => vec![number as u8],
        _ => vec![0x80 | (number >> 7) as u8, number as u8 & 0x7f],
    };
    let cell = |number: u16, row: &[(u16, Vec<u8>)]| {
        let kinds: Vec<u8> = row.iter().flat_map(|(kind, _)| varint(*kind)).collect();
        let mut record = vec![kinds.len() as u8 + 1];
        record.extend(kinds);
        row.iter().for_each(|(_, value)| record.extend(value));
        [varint(record.len() as u16), varint(number), record].concat()
    };
    let page = |first: usize, cells: &[Vec<u8>]| {
        let (mut page, mut end) = (vec![0; 512], 512);
        page[first] = 13;
        page[first + 4] = cells.len() as u8;
        for (n, cell) in cells.iter().enumerate() {
            end -= cell.len();
            page[end..end + cell.len()].copy_from_slice(cell);
            page[first + 8 + 2 * n..first + 10 + 2 * n].copy_from_slice(&(end as u16).to_be_bytes());
        }
        page[first + 5..first + 7].copy_from_slice(&(end as u16).to_be_bytes());
        page
    };
    let mut trace = b"GP\0\x01".to_vec();
    trace.extend([[0xff; 4].to_vec(), vec![1, 2, 0, 0, 0, 2, 0, 0, 0]].concat());
    trace.extend([500.0, 500.0, 600.0, 700.0_f64].iter().flat_map(|v| v.to_le_bytes()));
    let contents = "gpkg_contents";
    let columns = "gpkg_geometry_columns";
    let systems = "gpkg_spatial_ref_sys";
    let tables = [
        (contents, "CREATE TABLE gpkg_contents(table_name,data_type)", vec![text("F"), text("features")]),
        (
            columns,
            "CREATE TABLE gpkg_geometry_columns(table_name,column_name,srs_id)",
            vec![text("F"), text("g"), byte(0xff)],
        ),
        (systems, "CREATE TABLE gpkg_spatial_ref_sys(srs_id,definition)", vec![byte(0xff), text("undefined")]),
        ("F", "CREATE TABLE F(g,dip)", vec![(12 + 2 * trace.len() as u16, trace), byte(60)]),
    ];
    let mut schema = Vec::new();
    let mut pages = Vec::new();
    for (n, (name, sql, row)) in tables.iter().enumerate() {
        let own = [text("table"), text(name), text(name), byte(n as u8 + 2), text(sql)];
        schema.push(cell(n as u16 + 1, &own));
        pages.extend(page(0, &[cell(1, row)]));
    }
    let mut all = [page(100, &schema), pages].concat();
    all[..16].copy_from_slice(b"SQLite format 3\0");
    all[16..24].copy_from_slice(&[2, 0, 1, 1, 0, 64, 32, 32]);
    for (at, value) in [(24, 1_u32), (28, 5), (44, 4), (56, 1), (92, 1)] {
        all[at..at + 4].copy_from_slice(&value.to_be_bytes());
    }
    all[68..72].copy_from_slice(b"GPKG");
    all
}

/// Format and content.
pub const HAND_WRITTEN: &[(&str, &str)] = &[
    ("obj", "o A\nv 0 0 40\nv 50 0 44\nv 0 50 48\nv 50 50 50\nf 1//1 2//1 3//1\nf -3 -1 -2\no B\nl 1 2 \\\n 3\n"),
    (
        "stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 40\nvertex 50 0 44\nvertex 0 50 48\nendloop\nendfacet\nendsolid a\n",
    ),
    (
        "gxf",
        "#POINTS\n3\n#ROWS\n2\n#PTSEPARATION\n25\n#RWSEPARATION\n25\n#SENSE\n-2\n#DUMMY\n-1e12\n#GRID\n40 41 42\n43 -1e12 45\n",
    ),
    ("gxf", "#POINTS\n3\n#ROWS\n2\n#ROTATION\n30\n#GTYPE\n2\n#TRANSFORM\n0.1,0\n#GRID\n\"\"%(-.!!*+,,\n"),
    ("esri", "ncols 3\nnrows 2\nxllcorner 0\nyllcenter 0\ncellsize 25\nNODATA_value -9999\n40 41 42\n-9999 44 45\n"),
    ("surfer", "DSAA\n3 2\n0 50\n0 25\n40 45\n40 41 42\n1.70141e+38 44 45\n"),
    (
        "geojson",
        "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{\"name\":\"F\",\"dip\":60,\
         \"strike\":10},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[100,100],[125,175,40]]}}]}",
    ),
    ("csv", "inline,crossline,x,y,twt_ms\n1,1,0,0,40\n1,2,0,25,44\n2,1,25,0,48\n2,2,25,25,52\n"),
    ("irap", "-996 2 25 25\n0 50 0 25\n3 0 0 0\n0 0 0 0 0 0 0\n40 41 42 43 9999900.0 44\n"),
    ("opendtect", "\"F\"\t0\t0\t40\t0\t0\n\"F\"\t5\t0\t80\t0\t1\n\"F\"\t0\t25\t40\t1\t0\n\"F\"\t5\t25\t80\t1\t1\n"),
    (
        "tsurf",
        "GOCAD TSurf 1\nHEADER {\nname: A\n}\nGOCAD_ORIGINAL_COORDINATE_SYSTEM\nAXIS_UNIT m m ms\
         \nZPOSITIVE Elevation\nEND_ORIGINAL_COORDINATE_SYSTEM\nPROPERTIES a\nTFACE\nVRTX 1 0 0 -40\
         \nPVRTX 2 50 0 -44 1.5\nVRTX 3 0 50 -48\nATOM 4 3\nTRGL 1 2 3\nTRGL 2 4 1\nBSTONE 1\nBORDER 5 1 2\nEND\
         \n",
    ),
    (
        "zmap",
        "! made\n@A, GRID, 5\n15, -99999.0, , 4, 1\n2, 3, 0, 50, 0, 25\n0.0, 0.0, 0.0\n@\n40 41\n42 43\n44 -99999.0\n",
    ),
    (
        "cps3",
        "FSASCI 0 1 COMPUTED 0 1E30\nFSATTR 0 0\nFSLIMI 0 50 0 25 40 45\nFSNROW 2 3\nFSXINC 25 25\n->A\n40 41\n42 43\n44 1E30\n",
    ),
    (
        "earthvision",
        "# Type: scattered data\n# Field: 1 x\n# Field: 2 y\n# Field: 3 z milliseconds\n# Grid_size: 2 x 2\
         \n# Null_value: 1.0e30\n# End:\n0 0 40 1 1\n25 0 44 2 1\n0 25 48 1 2\n",
    ),
    (
        "petrel",
        "# Petrel Points with attributes\n# Unit in depth: ms\nVERSION 1\nBEGIN HEADER\nX\nY\nZ\nEND HEADER\n0 0 -40\n25 0 -44\n0 25 -48\n",
    ),
    ("charisma", "INLINE :   1 XLINE :   1   0.0   0.0   40.0\nINLINE :   1 XLINE :   2   0.0   25.0   44.0\n"),
    (
        "ijxyz",
        "@File\n#Horizon_name___-> A\n#End_of_Horizon_ASCII_Header_\n1.0 1 0 0 40\n2.0 1 25 0 44\n1.0 2 0 25 48\n",
    ),
];
