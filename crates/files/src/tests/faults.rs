//! Faults from sticks, triangles and points, and back.

use super::*;
use glam::DVec3;
use survey::geometry::VerticalUnit;
use survey::mesh::TriangleMesh;
use survey::remedy::Setting;

/// 50 × 50 bins of 25 m from (X0, 0), 0–800 m; no X is a line number.
fn survey() -> SurveyGeometry {
    SurveyGeometry {
        origin: glam::DVec2::new(X0, 0.0),
        ..SurveyGeometry::regular([50, 50, 201], 25.0, 4.0, VerticalUnit::Metres)
    }
}

const X0: f64 = 7000.0;

/// The plane x = X0 + 300 + 0.5·z.
fn off_plane(p: DVec3) -> f64 {
    (p.x - X0 - 300.0 - 0.5 * p.z).abs()
}

fn fault(text: &str, options: &ImportOptions) -> (Fault, ImportReport) {
    let (_folder, path) = file("F.dat", text);
    let mut found = read_fault(&path, &survey(), options).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(found.len(), 1);
    found.remove(0)
}

fn area(mesh: &TriangleMesh) -> f64 {
    (0..mesh.triangles.len()).map(|t| mesh.corners(t)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

/// Nodes of the plane on five sticks at y = 100 … 900, the stick's number and the node's with them.
fn nodes() -> Vec<(DVec3, usize, usize)> {
    (0..5)
        .flat_map(|s| (0..4 + s).map(move |n| (s, n, 100.0 + 600.0 * n as f64 / (3.0 + s as f64))))
        .map(|(s, n, z)| (DVec3::new(X0 + 300.0 + 0.5 * z, 100.0 + 200.0 * s as f64, z), s, n))
        .collect()
}

fn text(row: impl Fn(DVec3, usize, usize) -> String) -> String {
    nodes().into_iter().map(|(p, s, n)| row(p, s, n) + "\n").collect()
}

const WHOLE: f64 = 800.0 * 600.0 * 1.118_033_988_75;

#[test]
fn sticks_in_every_layout_make_the_same_plane() {
    let lines = |p: DVec3| ((p.x - X0) / 25.0 + 1.0, p.y / 25.0 + 1.0);
    let texts = [
        text(|p, s, n| format!("{}\t{}\t{}\t{s}\t{n}", p.x, p.y, p.z)),
        text(|p, s, n| format!("\"Big fault\"\t{}\t{}\t{}\t{s}\t{n}", p.x, p.y, p.z)),
        // Numbered upwards: nodes are read in the order of their numbers.
        text(|p, s, n| format!("\"Big fault\"\t{}\t{}\t{}\t{s}\t{}", p.x, p.y, p.z, 20 - n)),
        text(|p, s, n| format!("{} {} {} {s} {n}", lines(p).0, lines(p).1, p.z)),
        "x,y,depth_m,stick\n".to_string() + &text(|p, s, _| format!("{},{},{},{s}", p.x, p.y, p.z)),
        text(|p, s, _| format!("INLINE-  0  0  {}  {}  {} Big {s}", p.x, p.y, p.z)),
        // Picked on crosslines, without stick numbers.
        "inline,crossline,z\n".to_string() + &text(|p, _, _| format!("{},{},{}", lines(p).0, lines(p).1, p.z)),
    ];
    for text in texts {
        let (fault, report) = fault(&text, &ImportOptions::default());
        assert_eq!(report.gridding, Gridding::Sticks { sticks: 5 }, "{text}");
        assert!(fault.mesh.vertices.iter().all(|v| off_plane(*v) < 1e-6));
        assert!((area(&fault.mesh) / WHOLE - 1.0).abs() < 1e-6, "{}", area(&fault.mesh));
    }
}

#[test]
fn several_faults_in_one_file_are_told_apart_by_name() {
    let rows = text(|p, s, n| format!("\"East\"\t{}\t{}\t{}\t{s}\t{n}", p.x, p.y, p.z))
        + &text(|p, s, n| format!("\"West\"\t{}\t{}\t{}\t{s}\t{n}", p.x - 200.0, p.y, p.z));
    let (_folder, path) = file("faults.dat", &rows);
    let all = read_fault(&path, &survey(), &ImportOptions::default()).unwrap();
    assert_eq!(all.iter().map(|(f, _)| f.name.as_str()).collect::<Vec<_>>(), ["East", "West"]);
    let west = ImportOptions { name: Some("West".into()), ..ImportOptions::default() };
    assert_eq!(read_fault(&path, &survey(), &west).unwrap().len(), 1);
}

#[test]
fn points_without_sticks_are_fitted() {
    let mut rows = "x;y;z\n".to_string();
    for n in 0..300 {
        let (y, z) = (100.0 + 800.0 * f64::from(n * 37 % 300) / 300.0, 100.0 + 600.0 * f64::from(n) / 300.0);
        rows += &format!("{};{y};{z}\n", X0 + 300.0 + 0.5 * z);
    }
    let (fault, report) = fault(&rows, &ImportOptions::default());
    let Gridding::PlaneFit { rms_m } = report.gridding else { panic!("{report}") };
    assert!(rms_m < 1e-2, "{rms_m}");
    assert!(fault.mesh.vertices.iter().all(|v| off_plane(*v) < 0.05));
    assert!((0.8..1.001).contains(&(area(&fault.mesh) / WHOLE)), "{}", area(&fault.mesh) / WHOLE);
}

#[test]
fn tsurf_with_atoms_parts_properties_and_feet() {
    let text = "GOCAD TSurf 1 \r\nHEADER {\r\n*solid*color: 1 0 0 1\r\nname:  Big fault \r\n}\r\nPROPERTIES a b\r\nTFACE\r\n\
        PVRTX 10 7300 100 0 1.5 2\r\nVRTX 11 7700 100 800 CNXYZ\r\nVRTX 13 7300 900 0\r\nTRGL 10 11 13\r\
        \nTFACE\r\nATOM 20 11\r\nATOM 21 13\r\n\
        VRTX 22 7700 900 800\r\nTRGL 20 22 21\r\nBSTONE 10\r\nBORDER 30 10 11\r\nEND\r\n";
    let (fault, report) = fault(text, &ImportOptions::default());
    assert_eq!((fault.name.as_str(), fault.mesh.triangles.len()), ("Big fault", 2));
    assert_eq!((&report.z_unit.source, &report.z_positive.source), (&Provenance::Assumed, &Provenance::Assumed));
    assert!(fault.mesh.vertices.iter().all(|v| off_plane(*v) < 1e-9));
    let up = text
        .replace(
            "PROPERTIES a b",
            "GOCAD_ORIGINAL_COORDINATE_SYSTEM\nAXIS_UNIT \"m\" \"m\" \"ft\"\
        \nZPOSITIVE Elevation\nEND_ORIGINAL_COORDINATE_SYSTEM",
        )
        .replace(" 800", " -2624.671916");
    let (in_feet, report) = self::fault(&up, &ImportOptions::default());
    assert_eq!(report.z_unit.value, ZUnit::Feet);
    assert!(in_feet.mesh.vertices.iter().all(|v| off_plane(*v) < 1e-6));
}

#[test]
fn faults_survive_tsurf_and_sticks() {
    let rows = text(|p, s, n| format!("{}\t{}\t{}\t{s}\t{n}", p.x, p.y, p.z));
    let (original, _) = fault(&rows, &ImportOptions { name: Some("Big fault".into()), ..ImportOptions::default() });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("F.ts");
    write_fault(&path, &original, &survey(), Format::Tsurf).unwrap();
    let (again, report) = read_fault(&path, &survey(), &ImportOptions::default()).unwrap().remove(0);
    assert_eq!((again.name.as_str(), &again.mesh.triangles), ("Big fault", &original.mesh.triangles));
    assert!(again.mesh.vertices.iter().zip(&original.mesh.vertices).all(|(a, b)| a.distance(*b) < 1e-3));
    assert!(matches!(report.z_positive.source, Provenance::File(_)));
    write_fault(&path, &original, &survey(), Format::OpendTect).unwrap();
    let (again, _) = read_fault(&path, &survey(), &ImportOptions::default()).unwrap().remove(0);
    assert_eq!(again.name, "Big fault");
    assert!(again.mesh.vertices.iter().all(|v| off_plane(*v) < 1e-2));
    assert!(area(&again.mesh) / WHOLE > 0.97, "{}", area(&again.mesh) / WHOLE);
    assert!(matches!(write_fault(&path, &original, &survey(), Format::Irap), Err(FormatError::Unsupported { .. })));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn bad_faults_are_refused_with_a_reason() {
    let read = |text: &str| {
        let (_folder, path) = file("F.dat", text);
        read_fault(&path, &survey(), &ImportOptions::default()).unwrap_err()
    };
    let one =
        text(|p, s, n| format!("{}\t{}\t{}\t{s}\t{n}", p.x, p.y, p.z)).lines().take(4).collect::<Vec<_>>().join("\n");
    assert!(matches!(read(&one), FormatError::NoSurface { .. }));
    let up = text(|p, s, n| format!("{}\t{}\t{}\t{s}\t{n}", p.x, p.y, -p.z));
    assert_eq!(read(&up).remedy(), Some(Setting::ZPositive.stated_as("up")));
    let away = text(|p, s, n| format!("{}\t{}\t{}\t{s}\t{n}", p.x + 9e5, p.y + 6e6, p.z));
    assert!(matches!(read(&away), FormatError::OutsideSurvey { .. }));
    let feet = text(|p, s, n| format!("{}\t{}\t{}\t{s}\t{n}", p.x / 0.3048, p.y / 0.3048 + 5000.0, p.z));
    assert!(matches!(read(&feet), FormatError::OutsideSurvey { .. }));
    let missing = "GOCAD TSurf 1\nTFACE\nVRTX 1 7300 100 0\nVRTX 2 7700 100 800\nTRGL 1 2 3\nEND\n";
    assert!(read(missing).to_string().contains("line 5: expected a vertex with id 3"), "{}", read(missing));
    assert!(matches!(read("GOCAD SGrid 1\nEND\n"), FormatError::UnknownFormat { .. }));
}
