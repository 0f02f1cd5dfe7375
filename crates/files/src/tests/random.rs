//! No input makes a reader panic: valid files of every format, mutated, cut and joined at random.

use super::*;
use survey::geometry::VerticalUnit;

/// A small valid file of each format.
const FILES: &[(&str, &str)] = &[
    (
        "csv",
        "inline,crossline,x,y,twt_ms,sheet,quality\n1,1,0,0,40,0,picked\n1,2,0,25,44,0,picked\n2,1,25,0,48,1,filled\n2,2,25,25,52,1,hole\n",
    ),
    ("irap", "-996 2 10 10\n0 10 0 10\n2 0 0 0\n0 0 0 0 0 0 0\n40 41 42 9999900.0\n"),
    (
        "opendtect",
        "# \"X\"\t\"Y\"\t\"Inline\"\t\"Crossline\"\t\"Z\"\n# - - - -\n\"A\"\t0.00\t0.00\t1\t1\t40.5\
         \n\"A\"\t0.00\t25.00\t1\t2\t1e30\n\"B\"\t25.00\t0.00\t2\t1\t44\n",
    ),
    ("opendtect", "\"F\"\t0\t0\t40\t0\t0\n\"F\"\t5\t0\t80\t0\t1\n\"F\"\t0\t25\t40\t1\t0\n\"F\"\t5\t25\t80\t1\t1\n"),
    (
        "tsurf",
        "GOCAD TSurf 1\nHEADER {\nname: A\n}\nGOCAD_ORIGINAL_COORDINATE_SYSTEM\nAXIS_UNIT m m ms\
         \nZPOSITIVE Depth\nEND_ORIGINAL_COORDINATE_SYSTEM\nTFACE\nVRTX 1 0 0 40\nPVRTX 2 50 0 44 1.5\
         \nVRTX 3 0 50 48\nATOM 4 3\nTRGL 1 2 3\nTRGL 2 4 1\nEND\n",
    ),
    (
        "zmap",
        "! made\n@A, GRID, 5\n15, -99999.0, , 4, 1\n2, 3, 0, 20, 0, 10\n0.0, 0.0, 0.0\n@\n40 41\n42 43\n44 -99999.0\n",
    ),
    (
        "cps3",
        "FSASCI 0 1 COMPUTED 0 1E30\nFSATTR 0 0\nFSLIMI 0 20 0 10 40 45\nFSNROW 2 3\nFSXINC 10 10\n->A\n40 41\n42 43\n44 1E30\n",
    ),
    (
        "earthvision",
        "# Type: scattered data\n# Field: 1 x\n# Field: 2 y\n# Field: 3 z milliseconds\n# Null_value: 1.0e30\
         \n# End:\n0 0 40\n25 0 44\n0 25 48\n",
    ),
    (
        "petrel",
        "# Petrel Points with attributes\n# Unit in depth: ms\nVERSION 1\nBEGIN HEADER\nX\nY\nZ\nEND HEADER\n0 0 40\n25 0 44\n0 25 48\n",
    ),
    ("charisma", "INLINE :   1 XLINE :   1   0.0   0.0   40.0\nINLINE :   1 XLINE :   2   0.0   25.0   44.0\n"),
    (
        "charisma",
        "INLINE-  0  0  0.0  0.0  40.0 F 1\nINLINE-  0  0  5.0  0.0  80.0 F 1\
         \nINLINE-  0  0  0.0  25.0  40.0 F 2\nINLINE-  0  0  5.0  25.0  80.0 F 2\n",
    ),
    (
        "zmappoints",
        "!\n@FREE POINT , DATA, 80, 1\nX (E) , 1, 1, 1, 1, 8,, 1.0E+30,,, 4, 0\
         \nY (N) , 2, 2, 1, 9, 16,, 1.0E+30,,, 4, 0\nZ , 3, 3, 1, 17, 24,, 1.0E+30,,, 4, 0\
         \nSEG I.D. , 4, 35, 1, 25, 30,, 1.0E+30,,, 0, 0\n@\n     0.0     0.0    40.0     1\
         \n    50.0     0.0    44.0     1\n    50.0    50.0    48.0     1\n     0.0     0.0    40.0     1\n",
    ),
    (
        "iesx",
        "PROFILE A TYPE 1  4 a3d_ci7m.ifdf     m ms\nSNAPPING PARAMETERS     5     0     1\
         \n  0.00000000E+00  0.00000000E+00  1 14    40.00      1.00      1.00    1 4.0000000E+01 I      1 XX\
         \n  2.50000000E+01  0.00000000E+00  1 14    44.00      1.00      1.00    1 4.4000000E+01 I      2 XX\
         \nEOD\n",
    ),
    ("dug", "# subgrid=il:1-2[1]+cl:1-2[1]\n# vertical_dimension=time\n1\t1\t40\n1\t2\t44\n2\t1\t48\n"),
    ("obj", "o A\nv 0 0 40\nv 50 0 44\nv 0 50 48\nv 50 50 50\nf 1//1 2//1 3//1\nf -3 -1 -2\no B\nl 1 2 \\\n 3\n"),
    (
        "stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 40\nvertex 50 0 44\nvertex 0 50 48\nendloop\nendfacet\nendsolid a\n",
    ),
    (
        "gxf",
        "#POINTS\n3\n#ROWS\n2\n#PTSEPARATION\n25\n#RWSEPARATION\n25\n#SENSE\n-2\n#DUMMY\n-1e12\n#GRID\n40 41 42\n43 -1e12 45\n",
    ),
    (
        "gxf",
        "#POINTS\n3\n#ROWS\n2\n#PTSEPARATION\n25\n#RWSEPARATION\n25\n#ROTATION\n3\n#GTYPE\n2\n#TRANSFORM\n0.1,0\n#GRID\n\"\"%(*+!!))))\n",
    ),
    (
        "ijxyz",
        "@File\n#Horizon_name___-> A\n#End_of_Horizon_ASCII_Header_\n1.0 1 0 0 40\n2.0 1 25 0 44\n1.0 2 0 25 48\n",
    ),
];

/// Small valid files that are not text.
fn binary_files() -> Vec<(&'static str, Vec<u8>)> {
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let mut stl = vec![b' '; 80];
    stl.extend(1_u32.to_le_bytes());
    stl.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 40.0, 50.0, 0.0, 44.0, 0.0, 50.0, 48.0]));
    stl.extend([0, 0]);
    let head = "{'descr': '<f4', 'fortran_order': False, 'shape': (6, 6), }\n";
    let start = [b"\x93NUMPY\x01\0", &(head.len() as u16).to_le_bytes()[..], head.as_bytes()].concat();
    let npy = [start, floats(&[44.0; 36])].concat();
    vec![
        ("stl", stl),
        ("npy", npy),
        ("geotiff", rasters::small_geotiff()),
        ("netcdf", netcdf::small_grid()),
        ("shapefile", features::small_shapefile()),
        ("geopackage", geopackages::small_geopackage()),
    ]
}

fn irap_binary() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut record = |payload: &[u8]| {
        bytes.extend((payload.len() as u32).to_be_bytes());
        bytes.extend(payload);
        bytes.extend((payload.len() as u32).to_be_bytes());
    };
    let ints = |values: &[i32]| values.iter().flat_map(|v| v.to_be_bytes()).collect::<Vec<_>>();
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_be_bytes()).collect::<Vec<_>>();
    record(&[ints(&[-996, 2]), floats(&[0.0, 20.0, 0.0, 10.0, 10.0, 10.0])].concat());
    record(&[ints(&[3]), floats(&[0.0, 0.0, 0.0])].concat());
    record(&[0; 28]);
    record(&floats(&[40.0, 41.0, 42.0]));
    record(&floats(&[43.0, 44.0, 1e30]));
    bytes
}

fn survey() -> SurveyGeometry {
    SurveyGeometry::regular([6, 6, 51], 25.0, 4.0, VerticalUnit::Milliseconds)
}

/// All the ways a file is read; the results do not matter, only that there are some.
fn read_all(path: &Path, format: Format) {
    for format in [None, Some(format)] {
        let options = ImportOptions { format, ..ImportOptions::default() };
        let _ = read_horizons(path, &survey(), &options);
        let _ = read_fault(path, &survey(), &options);
        let _ = SourceFile::open(path).and_then(|source| read_source(&source, None, &options, SurfaceKind::Horizon));
    }
}

#[test]
fn valid_files_are_read_and_recognised() {
    for (name, text) in FILES {
        let (_folder, path) = file("A.dat", text);
        let as_horizon = read_horizons(&path, &survey(), &ImportOptions::default());
        let as_fault = read_fault(&path, &survey(), &ImportOptions::default());
        let found: Vec<_> = as_horizon
            .iter()
            .flatten()
            .map(|(_, r)| r.format.value)
            .chain(as_fault.iter().flatten().map(|(_, r)| r.format.value))
            .collect();
        assert!(!found.is_empty(), "{name}: {as_horizon:?} {as_fault:?}");
        assert!(found.iter().all(|f| f.name() == *name), "{name}: {found:?}");
    }
    for (name, content) in binary_files() {
        let (_folder, path) = bytes("A.dat", &content);
        let as_horizon =
            read_horizons(&path, &survey(), &ImportOptions::default()).map(|found| found[0].1.format.value);
        let as_fault = read_fault(&path, &survey(), &ImportOptions::default()).map(|found| found[0].1.format.value);
        let found = [as_horizon.as_ref().ok(), as_fault.as_ref().ok()];
        assert!(found.contains(&Format::from_name(name).as_ref()), "{name}: {as_horizon:?} {as_fault:?}");
    }
    let (_folder, path) = bytes("A.gri", &irap_binary());
    let (horizon, report) = read_horizons(&path, &survey(), &ImportOptions::default()).unwrap().remove(0);
    assert_eq!(report.format.value, Format::IrapBinary);
    assert_eq!(horizon.sheets[0].depth[..5], [40.0, 43.0, 41.0, 44.0, 42.0]);
}

#[test]
fn mutated_files_are_read_or_refused_but_never_panic() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below.max(1) as u64) as usize
    };
    let words: [&[u8]; 16] = [
        b"1e308",
        b"-1e308",
        b"nan",
        b"inf",
        b"-996",
        b"999999999999999999999",
        b"0",
        b"-1",
        b"\t",
        b"\"",
        b"\r\n",
        b"\xff\xfe",
        b"TRGL 1 2 99",
        b"END",
        b";",
        b",",
    ];
    let mut sources: Vec<(Format, Vec<u8>)> =
        FILES.iter().map(|(name, text)| (Format::from_name(name).unwrap(), text.as_bytes().to_vec())).collect();
    sources.push((Format::IrapBinary, irap_binary()));
    sources.extend(binary_files().into_iter().map(|(name, content)| (Format::from_name(name).unwrap(), content)));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mutant.dat");
    for round in 0..2000 {
        let (format, valid) = &sources[round % sources.len()];
        let mut mutant = valid.clone();
        for _ in 0..=random(4) {
            let at = random(mutant.len());
            match random(5) {
                0 => mutant.truncate(at),
                1 => mutant[at..].iter_mut().take(1).for_each(|b| *b = random(256) as u8),
                2 => {
                    let end = (at + random(12)).min(mutant.len());
                    mutant.splice(at..end, words[random(words.len())].iter().copied());
                }
                3 => {
                    let end = (at + random(30)).min(mutant.len());
                    let piece = mutant[at..end].to_vec();
                    let to = random(mutant.len());
                    mutant.splice(to..to, piece);
                }
                _ => {
                    let (_, other) = &sources[random(sources.len())];
                    mutant.truncate(at);
                    mutant.extend(&other[random(other.len())..]);
                }
            }
            if mutant.is_empty() {
                break;
            }
        }
        std::fs::write(&path, &mutant).unwrap();
        read_all(&path, *format);
    }
    for length in 0..200 {
        let noise: Vec<u8> = (0..length).map(|_| random(256) as u8).collect();
        std::fs::write(&path, noise).unwrap();
        read_all(&path, sources[length % sources.len()].0);
    }
}
