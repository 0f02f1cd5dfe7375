//! CSV, XYZ and Irap ASCII on surveys whose answer is known.

use super::*;
use glam::{DVec2, DVec3};
use std::fmt::Write as _;
use survey::geometry::{LineAxis, VerticalUnit};
use survey::horizon::{NodeGrid, Quality, Sheet};

/// 12 inlines × 9 crosslines of 25 m at (1000, 2000), 0–400 ms.
fn survey() -> SurveyGeometry {
    SurveyGeometry {
        inlines: LineAxis { first: 100, step: 2, count: 12 },
        crosslines: LineAxis { first: 500, step: 1, count: 9 },
        origin: DVec2::new(1000.0, 2000.0),
        ..SurveyGeometry::regular([12, 9, 101], 25.0, 4.0, VerticalUnit::Milliseconds)
    }
}

fn depth(x: usize, y: usize) -> f64 {
    200.0 + 3.0 * x as f64 - 1.5 * y as f64
}

/// Rows over all traces but one, in the order of columns that `row` writes.
fn rows(header: &str, row: impl Fn(usize, usize, f64) -> String) -> String {
    let mut text = header.to_string();
    for x in 0..12 {
        for y in 0..9 {
            if (x, y) != (5, 4) {
                text += &row(x, y, depth(x, y));
                text += "\n";
            }
        }
    }
    text
}

fn assert_is_the_plane(horizon: &Horizon) {
    let [sheet] = horizon.sheets.as_slice() else { panic!("one sheet") };
    assert_eq!(sheet.grid, NodeGrid::of_survey(&survey()));
    for x in 0..12 {
        for y in 0..9 {
            let z = sheet.depth[x * 9 + y];
            if (x, y) == (5, 4) {
                assert!(z.is_nan());
            } else {
                assert!((f64::from(z) - depth(x, y)).abs() < 1e-3, "{x}, {y}: {z}");
            }
        }
    }
}

#[test]
fn tables_with_a_header_in_many_dialects() {
    let il = |x: usize| 100 + 2 * x;
    let xl = |y: usize| 500 + y;
    let wx = |x: usize| 1000.0 + 25.0 * x as f64;
    let wy = |y: usize| 2000.0 + 25.0 * y as f64;
    let texts = [
        rows("inline,crossline,twt_ms\n", |x, y, z| format!("{},{},{z}", il(x), xl(y))),
        rows("# made by hand\nIL XL Z\n", |x, y, z| format!("  {} {}\t{z} ", il(x), xl(y))),
        rows("X;Y;Z\r\n", |x, y, z| format!("{};{};{z}\r", wx(x), wy(y))),
        rows("X;Y;Z\n", |x, y, z| format!("{:.1};{:.1};{z:.2}", wx(x), wy(y)).replace('.', ",")),
        rows("\"Z (ms)\",\"Northing\",\"Easting\"\n", |x, y, z| format!("{z},{},{}", wy(y), wx(x))),
        rows("# x y z\n", |x, y, z| format!("{} {} {z}", wx(x), wy(y))),
        rows("", |x, y, z| format!("{} {} {z}", wx(x), wy(y))),
        rows("", |x, y, z| format!("{} {} {z}", il(x), xl(y))),
        rows("", |x, y, z| format!("{} {} {} {} {z}", il(x), xl(y), wx(x), wy(y))),
        rows("", |x, y, z| format!("{} {} {} {} {z}", wx(x), wy(y), il(x), xl(y))),
        rows("twt_s,il,xl\n", |x, y, z| format!("{},{},{}", z / 1000.0, il(x), xl(y))),
    ];
    for text in texts {
        let (horizon, report) = horizon(&text, &survey(), &ImportOptions::default());
        assert_is_the_plane(&horizon);
        assert_eq!(report.values, 107, "{report}");
    }
}

#[test]
fn nulls_sign_and_factor_as_told() {
    let text = rows("x y elev\n", |x, y, z| {
        let z = if x == 3 { -999.25 } else { -3.0 * z };
        format!("{} {} {z}", 1000 + 25 * x, 2000 + 25 * y)
    });
    let options = ImportOptions {
        columns: Column::parse_list("x,y,z").ok(),
        z_positive: Some(ZPositive::Up),
        z_factor: 1.0 / 3.0,
        null: Some(-999.25),
        ..ImportOptions::default()
    };
    let (horizon, report) = horizon(&text, &survey(), &options);
    assert_eq!((report.nulls, report.z_positive.source), (9, Provenance::Option));
    let sheet = &horizon.sheets[0];
    assert!(sheet.depth[3 * 9].is_nan());
    assert!((f64::from(sheet.depth[4 * 9 + 1]) - depth(4, 1)).abs() < 1e-3);
}

#[test]
fn irap_example_of_the_format() {
    let text = "-996 2 10 10\n0 10 0 10\n2 0 0 0\n0 0 0 0 0 0 0\n1 2 3 4\n";
    let geometry = SurveyGeometry::regular([3, 3, 10], 10.0, 1.0, VerticalUnit::Metres);
    let (horizon, report) = horizon(text, &geometry, &ImportOptions::default());
    let sheet = &horizon.sheets[0];
    for (x, y, z) in [(0.0, 0.0, 1.0), (10.0, 0.0, 2.0), (0.0, 10.0, 3.0), (10.0, 10.0, 4.0), (5.0, 5.0, 2.5)] {
        assert_eq!(sheet.depth_at_node(sheet.grid.node_at(DVec2::new(x, y))), z);
    }
    assert_eq!(report.gridding, Gridding::NativeGrid { count: [2, 2] });
    assert_eq!(report.z_positive.source, Provenance::Assumed);
}

#[test]
fn two_depths_at_a_trace_become_two_sheets_and_survive_a_round_trip() {
    // A reverse fault at crossline index 4: hanging wall for y ≤ 5, footwall 80 ms deeper for y ≥ 3.
    let text = {
        let mut text = "inline,crossline,twt_ms\n".to_string();
        for x in 0..12 {
            for y in 0..9 {
                if y <= 5 {
                    text += &format!("{},{},{}\n", 100 + 2 * x, 500 + y, depth(x, y));
                }
                if y >= 3 {
                    text += &format!("{},{},{}\n", 100 + 2 * x, 500 + y, depth(x, y) + 80.0);
                }
            }
        }
        text
    };
    let (read, report) = horizon(&text, &survey(), &ImportOptions::default());
    assert_eq!((read.sheets.len(), report.multivalued), (2, 36));
    for sheet in &read.sheets {
        let hanging = f64::from(sheet.depth[5 * 9 + 4]) < depth(5, 4) + 40.0;
        for x in 0..12 {
            for y in 0..9 {
                let z = f64::from(sheet.depth[x * 9 + y]);
                if if hanging { y <= 5 } else { y >= 3 } {
                    assert!((z - depth(x, y) - if hanging { 0.0 } else { 80.0 }).abs() < 1e-3);
                } else {
                    assert!(z.is_nan());
                }
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("A.csv");
    write_horizon(&path, &read, &survey(), Format::Csv).unwrap();
    let again = read_horizons(&path, &survey(), &ImportOptions::default()).unwrap().remove(0).0;
    // NaN is not equal to itself, so holes are compared through their bits.
    let bits = |h: &Horizon| {
        h.sheets.iter().map(|s| s.depth.iter().map(|z| z.to_bits()).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    assert_eq!(bits(&again), bits(&read));
    assert!(matches!(write_horizon(&path, &read, &survey(), Format::Irap), Err(FormatError::NotRepresentable { .. })));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing half-written");
}

#[test]
fn irap_round_trip_of_a_rotated_mirrored_grid() {
    let geometry = SurveyGeometry::regular([40, 40, 200], 25.0, 4.0, VerticalUnit::Metres);
    let along = DVec2::from_angle(0.6);
    let grid = NodeGrid {
        origin: DVec2::new(400.0, 400.0),
        u_step: along * 12.5,
        v_step: -along.perp() * 30.0,
        count: [7, 5],
    };
    let values = (0..35).map(|n| if n == 11 { f32::NAN } else { 100.0 + 1.375 * n as f32 }).collect();
    let read = Horizon::new("A", vec![Sheet::new(grid, values, Quality::Picked)]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("A.irap");
    write_horizon(&path, &read, &geometry, Format::Irap).unwrap();
    let again = read_horizons(&path, &geometry, &ImportOptions::default()).unwrap().remove(0).0;
    let (a, b) = (&again.sheets[0], &read.sheets[0]);
    assert!(a.depth.iter().zip(&b.depth).all(|(a, b)| a == b || (a.is_nan() && b.is_nan())));
    for n in [DVec2::ZERO, DVec2::new(6.0, 4.0)] {
        assert!(a.grid.world_at(n).distance(b.grid.world_at(n)) < 1e-5);
    }
}

#[test]
fn scattered_points_of_a_plane_are_a_plane_with_a_hole_in_the_gap() {
    let geometry = SurveyGeometry::regular([60, 60, 200], 25.0, 4.0, VerticalUnit::Metres);
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(u32::MAX / 2) * 1475.0
    };
    let plane = |x: f64, y: f64| 300.0 + 0.1 * x - 0.05 * y;
    let gap = DVec2::new(700.0, 800.0);
    let mut text = "x,y,depth_m\n".to_string();
    for _ in 0..900 {
        let p = DVec2::new(random(), random());
        if p.distance(gap) > 250.0 {
            text += &format!("{},{},{}\n", p.x, p.y, plane(p.x, p.y));
        }
    }
    let (read, report) = horizon(&text, &geometry, &ImportOptions::default());
    let Gridding::Interpolated { gap_m, .. } = report.gridding else { panic!("{report}") };
    assert!((80.0..140.0).contains(&gap_m), "{gap_m}");
    let sheet = &read.sheets[0];
    let mut known = 0;
    for x in 0..60 {
        for y in 0..60 {
            let p = DVec2::new(25.0 * x as f64, 25.0 * y as f64);
            let z = f64::from(sheet.depth[x * 60 + y]);
            if z.is_finite() {
                known += 1;
                assert!(
                    (z - plane(p.x, p.y)).abs() < if sheet.quality[x * 60 + y] == Quality::Picked { 2.0 } else { 1e-3 }
                );
            }
            if p.distance(gap) < 250.0 - gap_m {
                assert!(z.is_nan(), "inside the gap");
            }
        }
    }
    assert!(known > 2900, "{known}");
}

/// A ball in feet of elevation: its normals point up where its depths are small.
#[test]
fn points_with_normals_are_a_body_in_any_unit_and_a_map_stays_a_map() {
    let geometry = SurveyGeometry::regular([41, 33, 41], 25.0, 20.0, VerticalUnit::Metres);
    let foot = 0.3048;
    let mut text = "X,Y,Z,nx,ny,nz\n".to_owned();
    for n in 0..150 {
        let up = 1.0 - 2.0 * (f64::from(n) + 0.5) / 150.0;
        let (turn, around) = (f64::from(n) * 2.399_963, (1.0 - up * up).sqrt());
        let (nx, ny) = (turn.cos() * around, turn.sin() * around);
        let elevation = -(400.0 - 200.0 * up) / foot;
        // In feet the covector's last part is smaller.
        let _ = writeln!(text, "{},{},{elevation},{nx},{ny},{}", 500.0 + 200.0 * nx, 400.0 + 200.0 * ny, up * foot);
    }
    let told = ImportOptions { z_unit: Some(ZUnit::Feet), z_positive: Some(ZPositive::Up), ..ImportOptions::default() };
    let (body, report) = horizon(&text, &geometry, &told);
    let mesh = body.any_shape().expect("a body");
    let off = mesh.vertices.iter().map(|v| (v.distance(DVec3::new(500.0, 400.0, 400.0)) - 200.0).abs());
    assert!(off.fold(0.0, f64::max) < 4.0 && mesh.triangles.len() > 500);
    assert!(report.notes.iter().any(|note| note.contains("closed body")), "{report}");

    let flat: String = text.lines().take(1).map(|line| format!("{line}\n")).collect();
    let rows = (0..120).map(|n| {
        let (x, y) = ((f64::from(n) * 0.754_877).fract() * 1000.0, (f64::from(n) * 0.569_84).fract() * 800.0);
        format!("{x},{y},{},-0.1,0,1\n", 300.0 + 0.1 * x)
    });
    let (map, report) = horizon(&(flat + &rows.collect::<String>()), &geometry, &ImportOptions::default());
    assert!(!map.sheets.is_empty() && report.notes.iter().any(|note| note.contains("it is a map")), "{report}");
}
