//! Fault polygons of another program, in its own format and as ZMAP+ points.

use super::*;
use std::collections::BTreeSet;
use survey::geometry::VerticalUnit;

fn folder() -> Option<PathBuf> {
    Some(testdata::folder()?.join("interpretation/xtgeo"))
}

const NAMES: [&str; 2] =
    ["polygons_reek_1_top_upper_reek_faultpoly.pol", "polygons_reek_1_top_upper_reek_faultpoly.zmap"];

fn around(path: &Path, kind: SurfaceKind) -> SurveyGeometry {
    let file = InterpretationFile { path: path.into(), kind, options: ImportOptions::default() };
    survey_from_points(&[file], VerticalUnit::Metres, [200, 200, 100]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn fault_polygons_are_the_same_faults_in_both_formats() {
    let Some(folder) = folder() else { return };
    let read = |name: &str| {
        let path = folder.join(name);
        let geometry = around(&folder.join(NAMES[0]), SurfaceKind::Fault);
        read_fault(&path, &geometry, &ImportOptions::default()).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let (rms, zmap) = (read(NAMES[0]), read(NAMES[1]));
    assert_eq!((rms.len(), zmap.len()), (7, 7));
    for ((a, report), (b, _)) in rms.iter().zip(&zmap) {
        assert_eq!(a.mesh.vertices.len(), b.mesh.vertices.len(), "{}", a.name);
        let apart = a.mesh.vertices.iter().zip(&b.mesh.vertices).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        // ZMAP+ rounds X and Y to half a metre here.
        assert!(apart < 0.5, "{}: {apart}", a.name);
        assert!(a.mesh.triangles.len() + 2 >= a.mesh.vertices.len() / 2, "{report}");
        assert!(report.range[0] > 1000.0 && report.range[1] < 2500.0, "{report}");
    }
    let one = ImportOptions { select: Some("3".into()), ..ImportOptions::default() };
    let geometry = around(&folder.join(NAMES[0]), SurfaceKind::Fault);
    assert_eq!(read_fault(&folder.join(NAMES[0]), &geometry, &one).unwrap().len(), 1);
}

#[test]
fn the_same_files_are_points_of_a_horizon() {
    let Some(folder) = folder() else { return };
    let nodes: BTreeSet<usize> = NAMES
        .iter()
        .map(|name| {
            let path = folder.join(name);
            let geometry = around(&folder.join(NAMES[0]), SurfaceKind::Horizon);
            let (_, report) =
                read_horizons(&path, &geometry, &ImportOptions::default()).unwrap_or_else(|e| panic!("{e}")).remove(0);
            report.values
        })
        .collect();
    // 761 lines, 7 of them separators.
    assert_eq!(nodes, BTreeSet::from([754]));
}
