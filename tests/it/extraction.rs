//! Horizon candidates through the program.

use crate::program::{bytes, project, run_in};
use std::fs;

#[test]
fn candidates_are_extracted_once_and_exported_as_points() {
    let folder = project();
    let at = folder.path();
    run_in(at, "export p.petro c.csv --candidates").failed(&["no horizon candidates yet", "petroglyph extract"]);
    let found = run_in(at, "extract p.petro --json").done().json();
    for field in ["surfaces", "leaves", "triangles"] {
        assert!(found[field].as_u64().unwrap() > 0, "{field}: {found}");
    }
    for stage in ["growing", "trees", "distances", "storing", "total"] {
        assert!(found["seconds"][stage].is_number(), "{stage}: {found}");
    }
    assert_eq!((found["computed"].as_bool(), found["volume"].as_str()), (Some(true), Some("seismic")));
    let before = bytes(&at.join("p.petro/derived/candidates.zarr"));
    let again = run_in(at, "extract p.petro").done();
    assert!(again.stdout.contains("nothing has changed"), "{}", again.stdout);
    assert_eq!(bytes(&at.join("p.petro/derived/candidates.zarr")), before);
    let other = run_in(at, "extract p.petro --extrema peak --min-leaf-triangles 100 --json").done().json();
    assert_eq!(other["computed"], true);
    assert!(other["surfaces"].as_u64() < found["surfaces"].as_u64() && other["key"] != found["key"]);
    let points = run_in(at, "export p.petro c.csv --candidates --json").done().json();
    let text = fs::read_to_string(at.join("c.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("inline,crossline,z,leaf,surface"));
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|n| n.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len() as u64, points["points"].as_u64().unwrap());
    let (leaves, surfaces) = (other["leaves"].as_f64().unwrap(), other["surfaces"].as_f64().unwrap());
    assert!(rows.iter().all(|row| (1.0..=leaves).contains(&row[3]) && (1.0..=surfaces).contains(&row[4])));
}

#[test]
fn what_cannot_be_extracted_is_a_sentence() {
    let folder = project();
    let at = folder.path();
    run_in(at, "extract p.petro --volume impedance").failed(&["impedance", "another lattice"]);
    run_in(at, "extract p.petro --volume nothing").failed(&["nothing"]);
    run_in(at, "extract p.petro --max-distance 1000").failed(&["max_distance", "64"]);
    run_in(at, "extract p.petro --fault-evidence=-1").failed(&["-1", "inf"]);
    run_in(at, "extract p.petro --min-leaf-triangles 0").failed(&["min_leaf_triangles"]);
    assert_eq!(run_in(at, "extract p.petro --extrema ridge").code, 2);
    assert_eq!(run_in(at, "export p.petro c.csv").code, 2);
    let nothing = run_in(at, "extract p.petro --min-front-width 47").done();
    assert!(nothing.stdout.contains("no surface at least 47 traces wide"), "{}", nothing.stdout);
    run_in(at, "create q.petro --bounds 0,100,0,100,0,100 --size 5x5x5").done();
    run_in(at, "extract q.petro").failed(&["no volume on its own lattice"]);
}
