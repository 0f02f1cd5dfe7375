//! Surfaces and lines of other programs' drawings and point sets: DXF, GOCAD VSet and PLine, polygons with ids, points
//! with attributes; and files that are known but not read.

use super::*;
use survey::geometry::VerticalUnit;

/// 21 × 16 traces of 25 m, 0 to 400 m.
fn survey() -> SurveyGeometry {
    SurveyGeometry::regular([21, 16, 101], 25.0, 4.0, VerticalUnit::Metres)
}

fn written(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn horizon(name: &str, text: &str) -> Horizon {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, name, text);
    let mut read =
        read_horizons(&path, &survey(), &ImportOptions::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(read.len(), 1, "{name}");
    read.remove(0).0
}

fn faults(name: &str, text: &str) -> Vec<Fault> {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, name, text);
    let read =
        read_fault(&path, &survey(), &ImportOptions::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    read.into_iter().map(|(fault, _)| fault).collect()
}

/// The depth of the test plane at a place in metres.
fn depth(x: f64, y: f64) -> f64 {
    100.0 + 0.3 * x + 0.1 * y
}

fn assert_on_the_plane(horizon: &Horizon, name: &str) {
    let sheet = &horizon.sheets[0];
    let nodes: Vec<_> =
        (0..=20).flat_map(|x| (0..=15).map(move |y| [25.0 * f64::from(x), 25.0 * f64::from(y)])).collect();
    let mut seen = 0;
    for [x, y] in nodes {
        let z = sheet.depth_at_node(sheet.grid.node_at(glam::DVec2::new(x, y)).round());
        if z.is_finite() {
            seen += 1;
            assert!((f64::from(z) - depth(x, y)).abs() < 0.01, "{name}: {z} at {x}, {y}");
        }
    }
    assert!(seen > 250, "{name}: {seen}");
}

fn pairs(pairs: &[(u32, String)]) -> String {
    pairs.iter().map(|(code, value)| format!("{code:>3}\n{value}\n")).collect()
}

/// A drawing of these entities.
fn dxf(entities: &str) -> String {
    format!("999\nmade by hand\n  0\nSECTION\n  2\nENTITIES\n{entities}  0\nENDSEC\n  0\nEOF\n")
}

#[test]
fn meshes_of_a_drawing_are_a_horizon() {
    let places: Vec<[f64; 2]> = (0..5).flat_map(|x| (0..4).map(move |y| [f64::from(x), f64::from(y)])).collect();
    let vertices = |flags: u32| -> String {
        let vertex = |[x, y]: &[f64; 2]| {
            let (x, y) = (125.0 * x, 125.0 * y);
            let at = [(10, x), (20, y), (30, depth(x, y))].map(|(code, value)| (code, value.to_string()));
            pairs(&[(0, "VERTEX".into())]) + &pairs(&at) + &pairs(&[(70, flags.to_string())])
        };
        places.iter().map(vertex).collect()
    };
    let head = |flags: u32, counts: [u32; 2]| {
        pairs(&[(0, "POLYLINE".into()), (8, "Top Chalk".into()), (66, "1".into()), (70, flags.to_string())])
            + &pairs(&[(71, counts[0].to_string()), (72, counts[1].to_string())])
    };
    let end = pairs(&[(0, "SEQEND".into())]);
    let grid = horizon("grid.dxf", &dxf(&(head(16, [5, 4]) + &vertices(64) + &end)));
    assert_on_the_plane(&grid, "a mesh of rows and columns");
    // Triangles and quadrilaterals; an edge that is not drawn has a negative number.
    let faces: String = (0..4_i32)
        .flat_map(|x| (0..3).map(move |y| 4 * x + y + 1))
        .map(|a| {
            let face = |corners: [i32; 4]| {
                let numbers = (71..).zip(corners).filter(|(_, number)| *number != 0);
                let numbers: Vec<(u32, String)> = numbers.map(|(code, number)| (code, number.to_string())).collect();
                pairs(&[(0, "VERTEX".into()), (10, "0".into()), (20, "0".into()), (30, "0".into()), (70, "128".into())])
                    + &pairs(&numbers)
            };
            if a % 2 == 0 {
                face([a, a + 4, a + 5, a + 1])
            } else {
                face([a, a + 4, -(a + 5), 0]) + &face([-a, a + 5, a + 1, 0])
            }
        })
        .collect();
    let faces = horizon("faces.dxf", &dxf(&(head(64, [20, 12]) + &vertices(192) + &faces + &end)));
    assert_on_the_plane(&faces, "a mesh of faces");
}

#[test]
fn faces_and_lines_of_a_drawing_are_a_horizon() {
    let corner = |n: u32, x: f64, y: f64| {
        pairs(&[(10 + n, x.to_string()), (20 + n, y.to_string()), (30 + n, depth(x, y).to_string())])
    };
    let quad = |x: f64, y: f64| {
        let corners = [(x, y), (x + 125.0, y), (x + 125.0, y + 125.0), (x, y + 125.0)];
        let head = pairs(&[(0, "3DFACE".into()), (8, "Top Chalk".into())]);
        corners.iter().enumerate().fold(head, |text, (n, (x, y))| text + &corner(n as u32, *x, *y))
    };
    let faces: String = (0..4)
        .flat_map(|x| (0..3).map(move |y| [f64::from(x), f64::from(y)]))
        .map(|[x, y]| quad(125.0 * x, 125.0 * y))
        .collect();
    let chalk = horizon("faces.dxf", &dxf(&faces));
    assert_eq!(chalk.name, "Top Chalk");
    assert_on_the_plane(&chalk, "3DFACE");
    let line = |y: f64| {
        let head = pairs(&[(0, "POLYLINE".into()), (8, "Top Chalk".into()), (70, "8".into())]);
        let places = (0..=20).map(|x| pairs(&[(0, "VERTEX".into())]) + &corner(0, 25.0 * f64::from(x), y));
        head + &places.collect::<String>() + &pairs(&[(0, "SEQEND".into())])
    };
    let lines: String = (0..=15).map(|y| line(25.0 * f64::from(y))).collect();
    assert_on_the_plane(&horizon("lines.dxf", &dxf(&lines)), "POLYLINE");
}

#[test]
fn lines_of_a_drawing_and_of_gocad_are_sticks() {
    let places = |stick: usize| (0..5).map(move |n| [100.0 + 30.0 * n as f64, 60.0 * stick as f64, 80.0 * n as f64]);
    let polyline = |stick: usize| {
        let vertex = |[x, y, z]: [f64; 3]| {
            pairs(&[(0, "VERTEX".into()), (10, x.to_string()), (20, y.to_string()), (30, z.to_string())])
        };
        pairs(&[(0, "POLYLINE".into()), (8, "F1".into())])
            + &places(stick).map(vertex).collect::<String>()
            + &pairs(&[(0, "SEQEND".into())])
    };
    let drawing = dxf(&(0..5).map(polyline).collect::<String>());
    let mut pline = "GOCAD PLine 1\nHEADER {\nname: F1\n}\n".to_owned();
    for stick in 0..5 {
        pline += "ILINE\n";
        for (n, [x, y, z]) in places(stick).enumerate() {
            pline += &format!("VRTX {} {x} {y} {z}\n", 1 + 5 * stick + n);
        }
        (1..5).for_each(|n| pline += &format!("SEG {} {}\n", 5 * stick + n, 5 * stick + n + 1));
    }
    for (name, text) in [("sticks.dxf", drawing), ("sticks.pl", pline + "END\n")] {
        let read = faults(name, &text);
        assert_eq!((read.len(), read[0].name.as_str()), (1, "F1"), "{name}");
        // Five sticks of five places, joined by eight triangles from one to the next.
        assert_eq!((read[0].mesh.vertices.len(), read[0].mesh.triangles.len()), (25, 32), "{name}");
    }
}

#[test]
fn vertices_of_gocad_and_points_with_attributes_are_a_horizon() {
    let (mut vset, mut rms) =
        ("GOCAD VSet 1\nHEADER {\nname: Top\n}\n".to_owned(), "Float Confidence\nString Picker\n".to_owned());
    for n in 0..21 * 16 {
        let [x, y] = [25.0 * f64::from(n / 16), 25.0 * f64::from(n % 16)];
        vset += &format!("VRTX {} {x} {y} {}\n", n + 1, depth(x, y));
        rms += &format!("{x} {y} {} 0.{} UNDEF\n", depth(x, y), n % 9);
    }
    let top = horizon("points.vs", &(vset + "END\n"));
    assert_eq!(top.name, "Top");
    assert_on_the_plane(&top, "VSet");
    assert_on_the_plane(&horizon("points.rmsattr", &rms), "RMS points");
}

#[test]
fn each_polygon_of_a_table_is_a_fault_of_its_own() {
    let mut text = "X_UTME,Y_UTMN,Z_TVDSS,POLY_ID\n".to_owned();
    for id in 0..3 {
        let west = 60.0 + 120.0 * f64::from(id);
        let side = |x: f64, z: f64| (0..=8).map(move |n| (x + 0.3 * f64::from(n * n), 40.0 * f64::from(n), z));
        let mut ring: Vec<_> = side(west, 120.0).collect();
        ring.extend(side(west + 20.0, 150.0).collect::<Vec<_>>().into_iter().rev());
        ring.push(ring[0]);
        ring.iter().for_each(|(x, y, z)| text += &format!("{x},{y},{z},{id}\n"));
    }
    let read = faults("polygons.csv", &text);
    let names: Vec<&str> = read.iter().map(|fault| fault.name.as_str()).collect();
    assert_eq!(names, ["0", "1", "2"]);
    for (id, fault) in read.iter().enumerate() {
        let [low, high] =
            [f64::min, f64::max].map(|pick| fault.mesh.vertices.iter().map(|v| v.x).reduce(pick).unwrap());
        assert!(low >= 60.0 + 120.0 * id as f64 - 1.0 && high <= 105.0 + 120.0 * id as f64, "{low} to {high}");
    }
    // Ids may be words.
    let words: String = text.lines().skip(1).map(|row| format!("{row}-east\n")).collect();
    let read = faults("polygons.csv", &format!("X_UTME,Y_UTMN,Z_TVDSS,POLY_ID\n{words}"));
    assert_eq!(read.iter().map(|fault| fault.name.as_str()).collect::<Vec<_>>(), ["0-east", "1-east", "2-east"]);
}

#[test]
fn lines_of_one_name_and_several_ids_are_sticks_of_one_fault() {
    let mut text = "X_UTME,Y_UTMN,Z_TVDSS,POLY_ID,NAME\n".to_owned();
    for (name, west) in [("A", 60.0), ("B", 300.0)] {
        for id in 0..3 {
            let z = 100.0 + 80.0 * f64::from(id);
            (0..6).for_each(|n| text += &format!("{},{},{z},{id},{name}\n", west + 0.2 * z, 60.0 * f64::from(n)));
        }
    }
    let read = faults("lines.csv", &text);
    assert_eq!(read.iter().map(|fault| fault.name.as_str()).collect::<Vec<_>>(), ["A", "B"]);
    for (fault, west) in read.iter().zip([60.0, 300.0]) {
        assert_eq!(fault.mesh.vertices.len(), 18);
        assert!(fault.mesh.vertices.iter().all(|v| (v.x - west - 0.2 * v.z).abs() < 1e-6));
    }
}

#[test]
fn rows_of_iesx_as_opendtect_writes_them_are_a_horizon() {
    let mut text =
        "PROFILE Segment          TYPE 1  4                                               3d_ci7m.ifdf     m  ms\n\
                    SNAPPING PARAMETERS 5     0 1\n"
            .to_owned();
    let e = |value: f64| {
        let exponent = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
        format!("{:>16}", format!("{:.8}E+{exponent:02}", value / 10f64.powi(exponent)))
    };
    for x in 0..21 {
        for y in 0..16 {
            let [east, north] = [25.0 * f64::from(x), 25.0 * f64::from(y)];
            let is_hole = x == 3 && y == 4;
            let z = if is_hole { 3.4028234663852886e38 } else { depth(east, north) };
            let crossline = f64::from(y + 1);
            text += &format!(
                "{}{}{:>3}{:>3}{z:>9.2}{crossline:>10.2}{crossline:>10.2}{:>5}{:>14} I{:>7} XX\n{}\t{}\t{z:.2}\nEOD",
                e(east),
                e(north),
                0,
                14,
                y + 1,
                "3.4028235E+38",
                x + 1,
                x + 1,
                y + 1
            );
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, "segment.dat", &text);
    let geometry = SurveyGeometry::regular([21, 16, 101], 25.0, 4.0, VerticalUnit::Milliseconds);
    let (segment, _) = read_horizons(&path, &geometry, &ImportOptions::default()).unwrap().remove(0);
    assert_eq!((segment.name.as_str(), segment.sheets[0].node_count()), ("Segment", 21 * 16 - 1));
    assert_on_the_plane(&segment, "IESX");
}

#[test]
fn what_is_known_but_not_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, text: &str| {
        let path = written(&folder, name, text);
        read_horizons(&path, &survey(), &ImportOptions::default()).unwrap_err().to_string()
    };
    assert!(refused("a.gps", "#GeoProbe Surface V1.0\n1 2 3\n").contains("GeoProbe surface, which is not read"));
    assert!(refused("b.dxf", "AutoCAD Binary DXF\r\n\u{1a}").contains("binary DXF"));
    assert!(refused("c.vo", "GOCAD Voxet 1\n").contains("TSurf, VSet and PLine"));
    assert!(refused("d.dxf", &dxf("  0\nCIRCLE\n  8\n0\n")).contains("no 3DFACE"));
    let mesh = "  0\nPOLYLINE\n  8\n0\n 70\n16\n 71\n2\n 72\n3\n  0\nSEQEND\n";
    let error = refused("e.dxf", &dxf(mesh));
    assert!(error.contains("line 17: expected as many VERTEXes as the mesh has rows times columns"), "{error}");
    let face = "  0\nPOLYLINE\n  8\n0\n 70\n64\n  0\nVERTEX\n 70\n128\n 71\n1\n 72\n2\n 73\n3\n";
    assert!(refused("f.dxf", &dxf(face)).contains("three or four places of its mesh"));
}
