//! Real files: one horizon in many formats, an interpretation with a fault, exports of several programs.

use super::*;
use glam::{DVec2, DVec3};
use survey::geometry::{LineAxis, VerticalAxis, VerticalUnit};
use survey::remedy::Setting;

/// The folder of interpretations; without `PETROGLYPH_DATA`, `None` and a message.
fn interpretation() -> Option<PathBuf> {
    Some(testdata::folder()?.join("interpretation"))
}

/// Penobscot: IL 1207–1456, XL 1253–1402, and the time of horizon B per trace, `[inline][crossline]`.
struct Penobscot {
    folder: PathBuf,
    geometry: SurveyGeometry,
    twt: Vec<f64>,
}

impl Penobscot {
    fn open() -> Option<Self> {
        let folder = interpretation()?.join("penobscot_horizon_B");
        let text = std::fs::read_to_string(folder.join("truth_il_xl_x_y_twt.csv")).unwrap();
        let rows: Vec<Vec<f64>> =
            text.lines().skip(1).map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect();
        let at = |il: f64, xl: f64| {
            let row = rows.iter().find(|r| r[0] == il && r[1] == xl).unwrap();
            DVec2::new(row[2], row[3])
        };
        let origin = at(1207.0, 1253.0);
        let geometry = SurveyGeometry {
            inlines: LineAxis { first: 1207, step: 1, count: 250 },
            crosslines: LineAxis { first: 1253, step: 1, count: 150 },
            vertical: VerticalAxis { first: 876.0, interval: 4.0, count: 40, unit: VerticalUnit::Milliseconds },
            origin,
            inline_vector: (at(1456.0, 1253.0) - origin) / 249.0,
            crossline_vector: (at(1207.0, 1402.0) - origin) / 149.0,
            velocity_m_s: 2500.0,
        };
        let mut twt = vec![f64::NAN; 250 * 150];
        for r in &rows {
            twt[(r[0] as usize - 1207) * 150 + r[1] as usize - 1253] = r[4];
        }
        Some(Self { folder, geometry, twt })
    }

    fn read(&self, name: &str, options: &ImportOptions) -> (Horizon, ImportReport) {
        let mut found =
            read_horizons(&self.folder.join(name), &self.geometry, options).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(found.len(), 1);
        let (horizon, report) = found.remove(0);
        eprintln!("{report}");
        (horizon, report)
    }

    /// Sorted |difference| from the truth at all traces at which the horizon's first sheet has a depth.
    fn differences(&self, horizon: &Horizon) -> Vec<f64> {
        let sheet = &horizon.sheets[0];
        let mut found = Vec::new();
        for x in 0..250 {
            for y in 0..150 {
                let world = self.geometry.world_from_voxel(DVec3::new(x as f64, y as f64, 0.0)).truncate();
                let node = sheet.grid.node_at(world);
                // Coordinates with two decimals put a node a little off its trace.
                let node = if (node - node.round()).abs().max_element() < 0.01 { node.round() } else { node };
                let z = f64::from(sheet.depth_at_node(node));
                if z.is_finite() {
                    found.push((z - self.twt[x * 150 + y]).abs());
                }
            }
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// Differences at the sheet's own nodes alone, when they are traces.
    fn at_nodes(&self, horizon: &Horizon) -> Vec<f64> {
        let sheet = &horizon.sheets[0];
        let nv = sheet.grid.count[1];
        let mut found: Vec<f64> = (0..sheet.depth.len())
            .filter(|&n| sheet.depth[n].is_finite())
            .map(|n| {
                let world = sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
                let voxel = self.geometry.voxel_from_world(world.extend(0.0)).round();
                (f64::from(sheet.depth[n]) - self.twt[voxel.x as usize * 150 + voxel.y as usize]).abs()
            })
            .collect();
        found.sort_by(f64::total_cmp);
        found
    }
}

#[test]
fn penobscot_formats_with_every_node_reproduce_the_truth() {
    let Some(penobscot) = Penobscot::open() else { return };
    // The .gri has its origin and step in f32, half a metre off here.
    for (name, nodes, tolerance) in
        [("truth_il_xl_x_y_twt.csv", 37_500, 1e-3), ("irap_classic_rotated.gri", 37_500, 0.2)]
    {
        let (horizon, _) = penobscot.read(name, &ImportOptions::default());
        let differences = penobscot.differences(&horizon);
        assert_eq!(differences.len(), nodes, "{name}");
        assert!(*differences.last().unwrap() < tolerance, "{name}: {:?}", differences.last());
    }
}

#[test]
fn penobscot_formats_with_every_other_node_reproduce_the_truth_there_and_nearly_between() {
    let Some(penobscot) = Penobscot::open() else { return };
    for (name, nodes) in [
        ("irap_classic_rotated.irap", 9375),
        ("opendtect_xy_ilxl.dat", 9375),
        ("opendtect_ilxl_multiline.dat", 9375),
        ("xyz_points.txt", 3125),
        ("charisma.dat", 9375),
        ("earthvision_grid.dat", 9375),
    ] {
        let (horizon, _) = penobscot.read(name, &ImportOptions::default());
        let at_nodes = penobscot.at_nodes(&horizon);
        assert_eq!(at_nodes.len(), nodes, "{name}");
        assert!(*at_nodes.last().unwrap() < 2e-3, "{name}: {:?}", at_nodes.last());
        // Between the nodes the horizon's own roughness decides; the picks jump at faults.
        let between = penobscot.differences(&horizon);
        let median = between[between.len() / 2];
        eprintln!(
            "{name}: {} traces, median {median:.3} ms, 95 % {:.3} ms",
            between.len(),
            between[between.len() * 95 / 100]
        );
        assert!(median < 0.6, "{name}: {median}");
    }
}

#[test]
fn penobscot_tsurf_is_coarse_but_right_at_its_vertices() {
    let Some(penobscot) = Penobscot::open() else { return };
    let (horizon, report) = penobscot.read("gocad_tsurf.ts", &ImportOptions::default());
    assert_eq!(report.gridding, Gridding::Rasterised { triangles: 1152 });
    assert!(
        matches!(report.z_unit.source, Provenance::File(_)) && matches!(report.z_positive.source, Provenance::File(_))
    );
    // Vertices are every sixth crossline and every tenth inline.
    let sheet = &horizon.sheets[0];
    let worst = (0..250)
        .step_by(10)
        .flat_map(|x| (0..150).step_by(6).map(move |y| x * 150 + y))
        .map(|n| (f64::from(sheet.depth[n]) - penobscot.twt[n]).abs())
        .fold(0.0, f64::max);
    assert!(worst < 0.05, "{worst}");
    let between = penobscot.differences(&horizon);
    assert!(between[between.len() / 2] < 1.5, "{}", between[between.len() / 2]);
}

#[test]
fn penobscot_with_the_wrong_unit_sign_or_survey_is_refused() {
    let Some(penobscot) = Penobscot::open() else { return };
    let path = penobscot.folder.join("opendtect_xy_ilxl.dat");
    for options in [
        ImportOptions { z_unit: Some(ZUnit::Seconds), ..ImportOptions::default() },
        ImportOptions { z_positive: Some(ZPositive::Up), ..ImportOptions::default() },
        ImportOptions { z_factor: 0.001, ..ImportOptions::default() },
    ] {
        let error = read_horizons(&path, &penobscot.geometry, &options).unwrap_err();
        assert!(matches!(error, FormatError::OutsideRange { .. }), "{error}");
    }
    let elsewhere = SurveyGeometry {
        origin: DVec2::new(605_000.0, 6_073_000.0),
        inlines: LineAxis { first: 100, step: 1, count: 250 },
        ..penobscot.geometry
    };
    let error = read_horizons(&path, &elsewhere, &ImportOptions::default()).unwrap_err();
    assert!(matches!(error, FormatError::OutsideSurvey { .. }), "{error}");
}

/// F3: 25 m bins; position from the segment's own X, Y.
fn f3() -> SurveyGeometry {
    SurveyGeometry {
        inlines: LineAxis { first: 100, step: 1, count: 651 },
        crosslines: LineAxis { first: 300, step: 1, count: 951 },
        vertical: VerticalAxis { first: 0.0, interval: 4.0, count: 463, unit: VerticalUnit::Milliseconds },
        origin: DVec2::new(605_835.5, 6_073_556.4),
        inline_vector: DVec2::new(-0.6994, 24.9924),
        crossline_vector: DVec2::new(24.99, 0.7),
        velocity_m_s: 2000.0,
    }
}

#[test]
fn opendtect_segment_is_the_same_in_all_four_layouts() {
    let Some(folder) = interpretation() else { return };
    let read = |name: &str| {
        let path = folder.join("opendtect_ascii").join(name);
        let (horizon, report) =
            read_horizons(&path, &f3(), &ImportOptions::default()).unwrap_or_else(|e| panic!("{e}")).remove(0);
        eprintln!("{report}");
        assert_eq!(report.values, 829);
        horizon.sheets[0].clone()
    };
    let reference = read("Segment_ILXL_Single-line-header.dat");
    assert_eq!(reference.node_count(), 829);
    assert!((reference.depth.iter().find(|z| z.is_finite()).unwrap() - 648.6175).abs() < 1e-3);
    for name in
        ["Segment_ILXL_No-header.dat", "Segment_XY-and-ILXL_Multi-line-header.dat", "Segment_XY_Single-line-header.dat"]
    {
        let sheet = read(name);
        assert_eq!(sheet.node_count(), 829, "{name}");
        let mut compared = 0;
        for (n, z) in reference.depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let node = DVec2::new((n / reference.grid.count[1]) as f64, (n % reference.grid.count[1]) as f64);
            let other = sheet.depth_at_node(sheet.grid.node_at(reference.grid.world_at(node)).round());
            assert_eq!(*z, other, "{name} at {node}");
            compared += 1;
        }
        assert_eq!(compared, 829);
    }
}

#[test]
fn opendtect_files_with_several_horizons_give_all_or_the_one_named() {
    let Some(folder) = interpretation() else { return };
    let path = folder.join("opendtect_ascii/F3_Multi-H2-H4_ILXL_Single-line-header.dat");
    let all = read_horizons(&path, &f3(), &ImportOptions::default()).unwrap();
    let names: Vec<_> = all.iter().map(|(h, _)| h.name.as_str()).collect();
    assert_eq!(names, ["F3_Demo_2_FS6", "F3_Demo_4_Truncation"]);
    assert_eq!(all.iter().map(|(h, _)| h.sheets[0].node_count()).sum::<usize>(), 16_517);
    assert!(all.iter().all(|(_, r)| r.range[0] > 630.0 && r.range[1] < 1000.0));
    let options = ImportOptions {
        select: Some("F3_Demo_4_Truncation".into()),
        name: Some("Truncation".into()),
        ..ImportOptions::default()
    };
    let one = read_horizons(&path, &f3(), &options).unwrap();
    assert_eq!((one.len(), one[0].0.name.as_str()), (1, "Truncation"));
    let options = ImportOptions { name: Some("Top chalk".into()), ..ImportOptions::default() };
    let error = read_horizons(&path, &f3(), &options).unwrap_err().to_string();
    assert!(error.contains("F3_Demo_2_FS6"), "{error}");
}

#[test]
fn opendtect_bulk_export_without_a_header() {
    let Some(folder) = interpretation() else { return };
    let path = folder.join("opendtect_ascii/Test_Multi_XY-and-ILXL_Z-only.dat");
    // Two of its points give the survey.
    let geometry = SurveyGeometry {
        inlines: LineAxis { first: 980, step: 1, count: 30 },
        crosslines: LineAxis { first: 1000, step: 1, count: 60 },
        vertical: VerticalAxis { first: 0.0, interval: 2.0, count: 1000, unit: VerticalUnit::Milliseconds },
        crossline_vector: DVec2::new(2.1233, 12.3156),
        inline_vector: DVec2::new(12.3156, -2.1233),
        origin: DVec2::new(1_702_847.5, 5_817_482.17)
            - 15.0 * DVec2::new(2.1233, 12.3156)
            - 10.0 * DVec2::new(12.3156, -2.1233),
        velocity_m_s: 2000.0,
    };
    let found = read_horizons(&path, &geometry, &ImportOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let summary: Vec<_> = found.iter().map(|(h, _)| (h.name.as_str(), h.sheets[0].node_count())).collect();
    assert_eq!(summary, [("green event", 10), ("blue event", 10)]);
}

/// A survey around Claudius in ms of two-way time, as its own points suggest it.
fn claudius(folder: &Path) -> SurveyGeometry {
    let points = ImportOptions { z_factor: -1.0 / 3.0, ..ImportOptions::default() };
    let fault = ImportOptions { z_factor: 1.0 / 3.0, z_unit: Some(ZUnit::Milliseconds), ..ImportOptions::default() };
    let mut files: Vec<_> = ["A", "B", "C", "D"]
        .iter()
        .map(|n| InterpretationFile {
            path: folder.join(format!("{n}Points.csv")),
            kind: SurfaceKind::Horizon,
            options: points.clone(),
        })
        .collect();
    files.push(InterpretationFile { path: folder.join("Fault.ts"), kind: SurfaceKind::Fault, options: fault });
    survey_from_points(&files, VerticalUnit::Milliseconds, [144, 209, 200]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn claudius_horizons_are_gridded_in_order_with_their_gaps() {
    let Some(folder) = interpretation().map(|f| f.join("claudius")) else { return };
    let geometry = claudius(&folder);
    eprintln!("{geometry:?}");
    let mut above = 0.0;
    for name in ["A", "B", "C", "D"] {
        let options = ImportOptions { z_factor: -1.0 / 3.0, name: Some(name.into()), ..ImportOptions::default() };
        let path = folder.join(format!("{name}Points.csv"));
        let (horizon, report) = read_horizons(&path, &geometry, &options).unwrap_or_else(|e| panic!("{e}")).remove(0);
        eprintln!("{report}");
        let sheet = &horizon.sheets[0];
        assert_eq!(horizon.sheets.len(), 1);
        let mean = sheet.depth.iter().filter(|z| z.is_finite()).map(|z| f64::from(*z)).sum::<f64>()
            / sheet.node_count() as f64;
        assert!(mean > above + 50.0, "{name} at {mean} ms below {above} ms");
        above = mean;
        let share = sheet.node_count() as f64 / sheet.depth.len() as f64;
        assert!((0.7..1.0).contains(&share), "{name}: {share}");
        // Each point is met by the surface, to the slope over half a bin.
        let text = std::fs::read_to_string(&path).unwrap();
        let mut apart: Vec<f64> = text
            .lines()
            .skip(1)
            .map(|l| l.split(';').take(3).map(|f| f.parse().unwrap()).collect::<Vec<f64>>())
            .map(|p| {
                let z = sheet.depth_at_node(sheet.grid.node_at(DVec2::new(p[0], p[1])));
                (f64::from(z) + p[2] / 3.0).abs()
            })
            .filter(|d| d.is_finite())
            .collect();
        apart.sort_by(f64::total_cmp);
        eprintln!(
            "{name}: points from surface: median {:.3} ms, 95 % {:.3} ms",
            apart[apart.len() / 2],
            apart[apart.len() * 95 / 100]
        );
        assert!(apart.len() > 4500 && apart[apart.len() / 2] < 1.5 && apart[apart.len() * 95 / 100] < 8.0);
    }
}

#[test]
fn claudius_as_it_is_in_the_file_is_refused() {
    let Some(folder) = interpretation().map(|f| f.join("claudius")) else { return };
    let geometry = claudius(&folder);
    let error = read_horizons(&folder.join("APoints.csv"), &geometry, &ImportOptions::default()).unwrap_err();
    assert!(matches!(error, FormatError::OutsideRange { .. }), "{error}");
    let error = read_fault(&folder.join("Fault.ts"), &geometry, &ImportOptions::default()).unwrap_err();
    assert!(matches!(error, FormatError::UnitMismatch { .. }), "{error}");
    let factor = ImportOptions { z_unit: Some(ZUnit::Milliseconds), z_factor: -1.0 / 3.0, ..ImportOptions::default() };
    let error = read_fault(&folder.join("Fault.ts"), &geometry, &factor).unwrap_err();
    assert_eq!(error.remedy(), Some(Setting::ZPositive.stated_as("down")), "{error}");
}

/// Distance of points from a mesh in metres (TWT at 2000 m/s is 1 m a ms), sorted.
fn distances(points: &[DVec3], mesh: &survey::TriangleMesh) -> Vec<f64> {
    let mut found: Vec<f64> = points
        .iter()
        .map(|p| (0..mesh.triangles.len()).map(|t| distance(*p, mesh.corners(t))).fold(f64::INFINITY, f64::min))
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Distance of a point from a triangle: from its plane where the foot is inside, else from the nearest side.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(s, e)| (*e - *s).cross(p - *s).dot(normal) >= 0.0);
    if inside {
        return ((p - a).dot(normal) / normal.length()).abs();
    }
    let side =
        |s: DVec3, e: DVec3| p.distance(s + (e - s) * ((p - s).dot(e - s) / (e - s).length_squared()).clamp(0.0, 1.0));
    side(a, b).min(side(b, c)).min(side(c, a))
}

#[test]
fn claudius_fault_agrees_between_tsurf_and_sticks() {
    let Some(folder) = interpretation().map(|f| f.join("claudius")) else { return };
    let geometry = claudius(&folder);
    let options = ImportOptions { z_unit: Some(ZUnit::Milliseconds), z_factor: 1.0 / 3.0, ..ImportOptions::default() };
    let (surface, report) =
        read_fault(&folder.join("Fault.ts"), &geometry, &options).unwrap_or_else(|e| panic!("{e}")).remove(0);
    eprintln!("{report}");
    assert_eq!((surface.name.as_str(), surface.mesh.vertices.len()), ("SmallFault", 93));
    for name in ["fault_sticks_opendtect.dat", "fault_sticks_charisma.dat"] {
        let (fault, report) = read_fault(&folder.join(name), &geometry, &ImportOptions::default())
            .unwrap_or_else(|e| panic!("{e}"))
            .remove(0);
        eprintln!("{report}");
        assert_eq!((report.values, &report.gridding), (173, &Gridding::Sticks { sticks: 9 }));
        assert_eq!(fault.name, "Claudius_fault");
        // The nodes were cut from the surface: they lie on it, but for the file's decimals.
        let nodes = distances(&fault.mesh.vertices, &surface.mesh);
        assert!(*nodes.last().unwrap() < 0.01, "{:?}", nodes.last());
        // Between the sticks the two triangulations differ by the fault's own roughness.
        let middles: Vec<DVec3> =
            (0..fault.mesh.triangles.len()).map(|t| fault.mesh.corners(t)).map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let between = distances(&middles, &surface.mesh);
        eprintln!(
            "{name}: between sticks median {:.2} m, 95 % {:.2} m, most {:.2} m",
            between[between.len() / 2],
            between[between.len() * 95 / 100],
            between[between.len() - 1]
        );
        assert!(between[between.len() / 2] < 3.0 && between[between.len() * 95 / 100] < 15.0);
    }
}

#[test]
fn drogon_fault_as_rms_exports_it() {
    let Some(folder) = interpretation() else { return };
    let path = folder.join("xtgeo/surfaces_drogon_3_F5.ts");
    let file = InterpretationFile { path: path.clone(), kind: SurfaceKind::Fault, options: ImportOptions::default() };
    let geometry = survey_from_points(&[file], VerticalUnit::Metres, [40, 40, 100]).unwrap();
    let (fault, report) = read_fault(&path, &geometry, &ImportOptions::default()).unwrap().remove(0);
    let text = std::fs::read_to_string(&path).unwrap();
    let count = |word: &str| text.lines().filter(|l| l.starts_with(word)).count();
    assert_eq!((fault.mesh.vertices.len(), fault.mesh.triangles.len()), (count("VRTX"), count("TRGL")));
    assert_eq!((fault.name.as_str(), report.outside_range), ("F5", 0));
}

#[test]
fn penobscot_petrel_points_need_their_sign() {
    let Some(penobscot) = Penobscot::open() else { return };
    let name = "petrel_points_attributes.txt";
    let error =
        read_horizons(&penobscot.folder.join(name), &penobscot.geometry, &ImportOptions::default()).unwrap_err();
    assert_eq!(error.remedy(), Some(Setting::ZPositive.stated_as("up")), "{error}");
    let up = ImportOptions { z_positive: Some(ZPositive::Up), ..ImportOptions::default() };
    let (horizon, report) = penobscot.read(name, &up);
    assert!(matches!(report.z_unit, Settled { value: ZUnit::Milliseconds, source: Provenance::File(_) }));
    assert!(*penobscot.at_nodes(&horizon).last().unwrap() < 2e-3);
}

#[test]
fn penobscot_unrotated_grids_follow_the_truth() {
    let Some(penobscot) = Penobscot::open() else { return };
    for name in ["zmap_plus_unrotated.zmap", "cps3_unrotated.cps3"] {
        let (horizon, report) = penobscot.read(name, &ImportOptions::default());
        assert!(report.nulls > 0);
        let differences = penobscot.differences(&horizon);
        let [median, most] = [50, 95].map(|p| differences[differences.len() * p / 100]);
        eprintln!("{name}: {} traces, median {median:.3} ms, 95 % {most:.3} ms", differences.len());
        // Resampled once when written and once here; the nodes are a bin and a half apart.
        assert!(differences.len() > 35_000 && median < 0.4 && most < 3.0, "{name}");
    }
}

/// A survey around a file.
fn around(path: &Path, unit: VerticalUnit) -> SurveyGeometry {
    let file = InterpretationFile { path: path.into(), kind: SurfaceKind::Horizon, options: ImportOptions::default() };
    survey_from_points(&[file], unit, [100, 100, 100]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn xtgeo_grids_are_read_whole() {
    let Some(folder) = interpretation().map(|f| f.join("xtgeo")) else { return };
    for (name, count) in [
        ("surfaces_etc_ib_test_horizon2.map", [126, 100]),
        ("surfaces_drogon_1_01_topvolantis.gri", [0, 0]),
        ("surfaces_drogon_1_04_basevolantis.gri", [0, 0]),
        ("surfaces_etc_zmap_example.zmap", [4, 5]),
    ] {
        let path = folder.join(name);
        let geometry = around(&path, VerticalUnit::Metres);
        let (horizon, report) =
            read_horizons(&path, &geometry, &ImportOptions::default()).unwrap_or_else(|e| panic!("{e}")).remove(0);
        eprintln!("{report}");
        let Gridding::NativeGrid { count: found } = report.gridding else { panic!("{report}") };
        assert!(count == [0, 0] || found == count, "{name}: {found:?}");
        assert_eq!(horizon.sheets[0].node_count() + report.nulls, report.values);
    }
}

#[test]
fn ijxyz_is_found_on_its_own_lattice() {
    let Some(folder) = interpretation().map(|f| f.join("xtgeo")) else { return };
    let path = folder.join("surfaces_etc_ijxyz1.dat");
    let geometry = around(&path, VerticalUnit::Metres);
    let by_xy = ImportOptions { place_by: Some(PlaceBy::World), ..ImportOptions::default() };
    let (horizon, report) = read_horizons(&path, &geometry, &by_xy).unwrap_or_else(|e| panic!("{e}")).remove(0);
    eprintln!("{report}");
    assert!(matches!(report.gridding, Gridding::InferredLattice { .. }), "{report}");
    assert_eq!(horizon.sheets[0].node_count(), report.values);
}

#[test]
fn petrel_points_as_exported() {
    let Some(folder) = interpretation() else { return };
    let path = folder.join("petrel/Petrel_points_extract.txt");
    let up = ImportOptions { z_positive: Some(ZPositive::Up), ..ImportOptions::default() };
    let file = InterpretationFile { path: path.clone(), kind: SurfaceKind::Horizon, options: up.clone() };
    let geometry = survey_from_points(&[file], VerticalUnit::Metres, [200, 200, 100]).unwrap();
    let (_, report) = read_horizons(&path, &geometry, &up).unwrap_or_else(|e| panic!("{e}")).remove(0);
    eprintln!("{report}");
    assert_eq!(report.z_unit.source, Provenance::File("'Unit in depth: m'".into()));
}
