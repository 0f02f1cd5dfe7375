//! Files of programs that are only read, and options that settle what a file does not say, on every format.

use super::*;
use glam::DVec2;
use survey::geometry::VerticalUnit;

/// 21 × 16 traces of 25 m, 0 to 400 ms or m.
fn survey(unit: VerticalUnit) -> SurveyGeometry {
    SurveyGeometry::regular([21, 16, 101], 25.0, 4.0, unit)
}

fn plane(x: usize, y: usize) -> f64 {
    100.0 + 8.0 * x as f64 + 3.0 * y as f64
}

/// The plane at every other node, as `row(x, y, value)` writes it.
fn rows(row: impl Fn(usize, usize, f64) -> String) -> String {
    let mut text = String::new();
    for x in 0..21 {
        for y in 0..16 {
            text += &row(x, y, plane(x, y));
        }
    }
    text
}

fn assert_is_the_plane(horizon: &Horizon, name: &str) {
    let sheet = &horizon.sheets[0];
    assert_eq!(sheet.node_count(), 21 * 16, "{name}");
    for x in 0..21 {
        for y in 0..16 {
            let z = sheet.depth_at_node(sheet.grid.node_at(DVec2::new(25.0 * x as f64, 25.0 * y as f64)).round());
            assert!((f64::from(z) - plane(x, y)).abs() < 1e-3, "{name}: {z} at {x}, {y}");
        }
    }
}

/// A card image of IESX; fields of full width touch.
fn iesx_row(x: usize, y: usize, z: f64) -> String {
    let (easting, northing) = (25.0 * x as f64, 25.0 * y as f64);
    let crossline = y + 1;
    format!(
        "{easting:>16.8E}{northing:>16.8E}{:>3}{:>3}{z:>9.2}{crossline:>10.2}{crossline:>10.2}{crossline:>5}{z:>14.7E} I{:>7} XX\n",
        1,
        14,
        x + 1
    )
}

/// The plane in every format, with the values multiplied by `factor`.
fn in_every_format(factor: f64) -> Vec<(&'static str, &'static str, String)> {
    let world = |x: usize, y: usize| (25.0 * x as f64, 25.0 * y as f64);
    let xyz = rows(|x, y, z| format!("{} {} {}\n", world(x, y).0, world(x, y).1, z * factor));
    let columns: String =
        (0..21).flat_map(|x| (0..16).rev().map(move |y| format!("{}\n", plane(x, y) * factor))).collect();
    let irap: String = (0..16).flat_map(|y| (0..21).map(move |x| format!("{} ", plane(x, y) * factor))).collect();
    let mut mesh = String::from("GOCAD TSurf 1\nHEADER {\nname:A\n}\nTFACE\n");
    mesh += &rows(|x, y, z| format!("VRTX {} {} {} {}\n", 7 + x * 16 + y, world(x, y).0, world(x, y).1, z * factor));
    for x in 0..20 {
        for y in 0..15 {
            let a = 7 + x * 16 + y;
            mesh += &format!("TRGL {a} {} {}\nTRGL {a} {} {}\n", a + 16, a + 17, a + 17, a + 1);
        }
    }
    vec![
        ("csv", "a.csv", format!("x,y,z\n{}", xyz.replace(' ', ","))),
        ("csv", "a.xyz", format!("{}999.0 999.0 999.0\n", xyz)),
        ("irap", "a.irap", format!("-996 16 25 25\n0 500 0 375\n21 0 0 0\n0 0 0 0 0 0 0\n{irap}\n")),
        ("zmap", "a.zmap", format!("@A, GRID, 1\n20, -99999.0, , 7, 1\n16, 21, 0, 500, 0, 375\n0,0,0\n@\n{columns}")),
        ("cps3", "a.cps3", format!("FSASCI 0 1 COMPUTED 0 1E30\nFSLIMI 0 500 0 375 0 1\nFSNROW 16 21\n->A\n{columns}")),
        ("tsurf", "a.ts", format!("{mesh}END\n")),
        (
            "opendtect",
            "a.dat",
            format!(
                "# 1: X\n# 2: Y\n# 3: Z\n# - - -\n{}",
                rows(|x, y, z| { format!("{}\t{}\t{}\n", world(x, y).0, world(x, y).1, z * factor) })
            ),
        ),
        ("earthvision", "a.dat", format!("# Type: scattered data\n# End:\n{xyz}")),
        (
            "petrel",
            "a.txt",
            format!("# Petrel Points with attributes\nVERSION 1\nBEGIN HEADER\nX\nY\nZ\nEND HEADER\n{xyz}"),
        ),
        (
            "charisma",
            "a.dat",
            rows(|x, y, z| {
                format!("INLINE : {} XLINE : {} {} {} {}\n", x + 1, y + 1, world(x, y).0, world(x, y).1, z * factor)
            }),
        ),
        (
            "ijxyz",
            "a.dat",
            format!(
                "#End_of_Horizon_ASCII_Header_\n{}",
                rows(|x, y, z| { format!("{} {} {} {} {}\n", x + 1, y + 1, world(x, y).0, world(x, y).1, z * factor) })
            ),
        ),
        (
            "dug",
            "a.dat",
            format!(
                "# subgrid=il:1-21[1]+cl:1-16[1]\n{}",
                rows(|x, y, z| { format!("{}\t{}\t{}\n", x + 1, y + 1, z * factor) })
            ),
        ),
        (
            "zmappoints",
            "a.zmap",
            format!(
                "!\n@FREE POINT , DATA, 80, 1\nX (EASTING) , 1, 1, 1, 1, 20,, 1.0E+30,,, 4, 0\
                 \nY (NORTHING) , 2, 2, 1, 21, 40,, 1.0E+30,,, 4, 0\
                 \nZ VALUE , 3, 3, 1, 41, 60,, 1.0E+30,,, 4, 0\n@\n{}",
                rows(|x, y, z| format!("{:>20}{:>20}{:>20}\n", world(x, y).0, world(x, y).1, z * factor))
            ),
        ),
    ]
}

#[test]
fn unit_sign_factor_and_null_are_settled_by_options_in_every_format() {
    let (time, depth) = (VerticalUnit::Milliseconds, VerticalUnit::Metres);
    let plain = ImportOptions::default();
    let up = Some(ZPositive::Up);
    for (factor, unit, options) in [
        (1.0, time, plain.clone()),
        (0.001, time, ImportOptions { z_unit: Some(ZUnit::Seconds), ..plain.clone() }),
        (-1.0, time, ImportOptions { z_positive: up, ..plain.clone() }),
        (1.0 / 0.3048, depth, ImportOptions { z_unit: Some(ZUnit::Feet), ..plain.clone() }),
        (-1.0 / 0.3048, depth, ImportOptions { z_unit: Some(ZUnit::Feet), z_positive: up, ..plain.clone() }),
        (-3.0, time, ImportOptions { z_positive: up, z_factor: 1.0 / 3.0, ..plain.clone() }),
    ] {
        for (format, name, text) in in_every_format(factor) {
            let (_folder, path) = file(name, &text);
            let read = read_horizons(&path, &survey(unit), &options);
            let (horizon, report) = read.unwrap_or_else(|e| panic!("{format} × {factor}: {e}")).remove(0);
            assert_eq!(report.format.value.name(), format, "{report}");
            assert_is_the_plane(&horizon, &format!("{format} × {factor}"));
            if factor != 1.0 {
                // Without the statement the same file is refused, with what to state in the answer.
                let error = read_horizons(&path, &survey(unit), &plain).unwrap_err().remedy().unwrap().to_string();
                let named =
                    ["vertical unit", "sign of depths", "factor on depths"].iter().any(|name| error.contains(name));
                assert!(named, "{format} × {factor}: {error}");
            }
        }
    }
}

#[test]
fn a_null_of_ones_own_is_an_option_in_every_format() {
    let hole = plane(7, 5);
    for (format, name, text) in in_every_format(1.0) {
        let (_folder, path) = file(name, &text);
        let options = ImportOptions { null: Some(hole), ..ImportOptions::default() };
        let read = read_horizons(&path, &survey(VerticalUnit::Milliseconds), &options);
        let (horizon, report) = read.unwrap_or_else(|e| panic!("{format}: {e}")).remove(0);
        let sheet = &horizon.sheets[0];
        let z = sheet.depth_at_node(sheet.grid.node_at(DVec2::new(175.0, 125.0)).round());
        assert!(z.is_nan() && report.nulls >= 1, "{format}: {z}, {report}");
    }
}

#[test]
fn iesx_says_its_unit_and_name() {
    let body = rows(iesx_row);
    let head = "PROFILE Top Chalk        TYPE 1  4 chalk3d_ci7m.ifdf     m ms\nSNAPPING PARAMETERS     5     0     1\n";
    for text in [
        format!("{head}{body}EOD\n"),
        format!("{head}{}", body.replace("XX\n", "XX\nEOD ")).trim_end_matches("EOD ").to_string(),
    ] {
        let (horizon, report) = horizon(&text, &survey(VerticalUnit::Milliseconds), &ImportOptions::default());
        assert_eq!((report.format.value, horizon.name.as_str()), (Format::Iesx, "Top Chalk"));
        assert!(matches!(report.z_unit, Settled { value: ZUnit::Milliseconds, source: Provenance::File(_) }));
        for x in 0..21 {
            for y in 0..16 {
                assert!((f64::from(horizon.sheets[0].depth[x * 16 + y]) - plane(x, y)).abs() < 6e-3);
            }
        }
    }
    // Undefined depths overflow their field in some exports; values that are too wide are refused with their
    // line.
    let broken = format!("{head}{}", iesx_row(0, 0, 100.0).replace(" I", " J"));
    let (_folder, path) = file("a.iesx", &broken);
    let error = read_horizons(&path, &survey(VerticalUnit::Milliseconds), &ImportOptions::default()).unwrap_err();
    assert!(error.to_string().contains("line 3"), "{error}");
}

#[test]
fn petromod_turns_about_its_own_pivot() {
    let header = "Content=Map,DataUnitDistance=15,DataUnitZ=10,GridNoX=3,GridNoY=2,GridStepX=10,GridStepY=20,\
                  MapType=GridMap,OriginX=100,OriginY=100,RotationAngle=90,RotationOriginX=100,RotationOriginY=100,\
                  Undefined=99999,Version=1.0";
    let mut file = vec![0x23, 0x03, 0x19, 0x64];
    file.extend(header.as_bytes());
    file.push(0);
    for value in [40.0f32, 41.0, 42.0, 43.0, 99_999.0, 45.0] {
        file.extend(value.to_be_bytes());
    }
    let read = |bytes: &[u8]| {
        let source = SourceFile { path: "a.pmd".into(), bytes: bytes.to_vec() };
        built(
            &source,
            &survey(VerticalUnit::Milliseconds),
            &ImportOptions::default(),
            SurfaceKind::Horizon,
            horizon::build,
        )
    };
    let (horizon, report) = read(&file).unwrap().remove(0);
    assert_eq!((report.format.value, report.nulls), (Format::PetroMod, 1));
    let sheet = &horizon.sheets[0];
    let at = |x: f64, y: f64| sheet.depth_at_node(sheet.grid.node_at(DVec2::new(x, y)).round());
    // X of the grid runs north, Y west.
    assert_eq!([at(100.0, 100.0), at(80.0, 100.0), at(100.0, 110.0), at(80.0, 120.0)], [40.0, 41.0, 42.0, 45.0]);
    file.pop();
    assert!(matches!(read(&file[..file.len() - 3]), Err(FormatError::Length { .. })));
}

#[test]
fn petrel_well_tops_give_a_horizon_for_each_surface() {
    let mut text = String::from(
        "# Petrel well tops\n# Unit in X and Y direction: m\n# Unit in depth: m\nVERSION 2\nBEGIN HEADER\nX\nY\
         \nZ\nTWT picked\nMD\nType\nSurface\nWell\nEND HEADER\n",
    );
    for (n, (x, y)) in [(50.0, 50.0), (400.0, 60.0), (200.0, 300.0), (100.0, 200.0)].into_iter().enumerate() {
        text += &format!("{x} {y} -{} -999 1{n}00 Horizon \"Top A\" \"W {n}\"\n", 100 + n);
        text += &format!("{x} {y} -{} -999 2{n}00 Horizon \"Top B\" \"W {n}\"\n", 200 + n);
    }
    let (_folder, path) = file("tops.txt", &text);
    let options = ImportOptions { z_positive: Some(ZPositive::Up), ..ImportOptions::default() };
    let found = read_horizons(&path, &survey(VerticalUnit::Metres), &options).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<&str> = found.iter().map(|(h, _)| h.name.as_str()).collect();
    assert_eq!(names, ["Top A", "Top B"]);
    assert!(found[1].1.range[0] >= 200.0 && found[1].1.range[1] <= 203.0, "{}", found[1].1);
}

#[test]
fn the_order_of_cps3_values_is_shown_and_can_be_told() {
    // Steep along X, so that columns and rows differ; then level, so that they do not.
    let header = "FSASCI 0 1 COMPUTED 0 1E30\nFSLIMI 0 500 0 375 0 1\nFSNROW 16 21\n->A\n";
    let by_rows: String = (0..16).flat_map(|y| (0..21).map(move |x| format!("{} ", plane(x, y)))).collect();
    let level: String = (0..336).map(|_| "200 ").collect();
    let geometry = survey(VerticalUnit::Milliseconds);
    let read =
        |text: &str, value_order| horizon(text, &geometry, &ImportOptions { value_order, ..ImportOptions::default() });
    let (found, report) = read(&format!("{header}{by_rows}"), None);
    assert_is_the_plane(&found, "rows");
    assert!(report.warnings.is_empty() && report.notes.iter().any(|n| n.contains("rows from the south")), "{report}");
    let (found, report) = read(&format!("{header}{by_rows}"), Some(ValueOrder::Columns));
    assert!((f64::from(found.sheets[0].depth[15]) - plane(0, 0)).abs() < 1e-3, "the first value is in the north-west");
    assert!(report.notes.iter().any(|n| n.contains("as told")), "{report}");
    // White noise is as rough one way as the other.
    let mut state = 9u64;
    let noise: String = (0..336)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            format!("{} ", 100.0 + (state >> 40) as f64 / 1e5)
        })
        .collect();
    let (_, report) = read(&format!("{header}{noise}"), None);
    assert!(report.warnings[0].to_string().contains("order of values"), "{report}");
    read(&format!("{header}{level}"), None);
}

#[test]
fn repeated_points_and_spikes_are_reported() {
    let geometry = survey(VerticalUnit::Metres);
    let mut state = 5u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(u32::MAX / 2)
    };
    let mut text = String::from("x,y,depth_m\n");
    for n in 0..600 {
        let (x, y) = (500.0 * random(), 375.0 * random());
        let z = 150.0 + 0.1 * x + if n == 300 { 90.0 } else { 0.0 };
        text += &format!("{x},{y},{z}\n");
        if n % 100 == 0 {
            text += &format!("{x},{y},{}\n", z + 0.01);
        }
    }
    let (_, report) = horizon(&text, &geometry, &ImportOptions::default());
    assert!(report.notes.iter().any(|n| n.starts_with("6 points share")), "{report}");
    // The spike, and a point of the rim whose neighbours all lie on one side.
    assert!(report.warnings.len() == 1 && report.warnings[0].fact.starts_with("2 points lie more"), "{report}");
    assert!(
        report.warnings[0].to_string().contains("+88") || report.warnings[0].to_string().contains("+89"),
        "{report}"
    );
}

#[test]
fn bays_of_the_outline_stay_open() {
    // A crescent: points in a ring sector; the middle and the mouth have none.
    let geometry = SurveyGeometry::regular([101, 101, 101], 10.0, 4.0, VerticalUnit::Metres);
    let mut state = 3u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(u32::MAX / 2)
    };
    let mut text = String::from("x,y,depth_m\n");
    for _ in 0..3000 {
        let (angle, radius) = (0.6 + 5.0 * random(), 250.0 + 200.0 * random());
        let p = DVec2::splat(500.0) + DVec2::from_angle(angle) * radius;
        text += &format!("{},{},200\n", p.x, p.y);
    }
    let (found, report) = horizon(&text, &geometry, &ImportOptions::default());
    let Gridding::Interpolated { gap_m, .. } = report.gridding else { panic!("{report}") };
    assert!(gap_m < 60.0, "{gap_m}");
    let (mut inside, mut filled) = (0, 0);
    for x in 0..101 {
        for y in 0..101 {
            let d = DVec2::new(10.0 * x as f64 - 500.0, 10.0 * y as f64 - 500.0);
            let known = found.sheets[0].depth[x * 101 + y].is_finite();
            let angle = d.y.atan2(d.x).rem_euclid(std::f64::consts::TAU);
            if d.length() < 250.0 - gap_m
                || d.length() > 450.0 + 10.0
                || (0.1..0.5).contains(&angle) && d.length() > 300.0
            {
                assert!(!known, "filled at {d}");
            }
            if (270.0..430.0).contains(&d.length()) && (0.75..5.45).contains(&angle) {
                inside += 1;
                filled += usize::from(known);
            }
        }
    }
    assert!(filled * 100 >= inside * 98, "{filled} of {inside}");
}
