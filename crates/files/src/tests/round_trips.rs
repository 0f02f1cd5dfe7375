//! What is written is read back: horizons on random surveys (rotated, mirrored, stepped) in every format that
//! is written.

use super::*;
use glam::DVec2;
use survey::geometry::{LineAxis, VerticalAxis, VerticalUnit};
use survey::horizon::{NodeGrid, Quality, Sheet};

/// A small generator of numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1u64 << 31) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }
}

/// A survey turned by `angle` radians.
fn random_survey(random: &mut Random, angle: f64) -> SurveyGeometry {
    let along = DVec2::from_angle(angle);
    let mirror = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let step = |random: &mut Random| [1, 2, -1, -3, 5][random.below(5)];
    SurveyGeometry {
        inlines: LineAxis { first: 1000, step: step(random), count: 5 + random.below(20) },
        crosslines: LineAxis { first: 3000, step: step(random), count: 5 + random.below(20) },
        vertical: VerticalAxis {
            first: 100.0,
            interval: 2.0,
            count: 300,
            unit: [VerticalUnit::Metres, VerticalUnit::Milliseconds][random.below(2)],
        },
        origin: DVec2::new(4e5 + 1e5 * random.next(), 6e6 + 1e5 * random.next()),
        inline_vector: along * (6.25 + 20.0 * random.next()),
        crossline_vector: along.perp() * mirror * (6.25 + 40.0 * random.next()),
        velocity_m_s: 2000.0,
    }
}

/// A dipping horizon on the survey's traces with a few holes.
fn random_horizon(random: &mut Random, geometry: &SurveyGeometry) -> Horizon {
    let grid = NodeGrid::of_survey(geometry);
    let [nu, nv] = grid.count;
    let (a, b) = (4.0 * random.next() - 2.0, 4.0 * random.next() - 2.0);
    let depth =
        (0..nu * nv)
            .map(|n| {
                if random.below(12) == 0 {
                    f32::NAN
                } else {
                    (350.0 + a * (n / nv) as f64 + b * (n % nv) as f64) as f32
                }
            })
            .collect();
    Horizon::new("Top chalk", vec![Sheet::new(grid, depth, Quality::Picked)])
}

#[test]
fn horizons_survive_every_written_format_on_random_surveys() {
    let mut random = Random(5);
    let folder = tempfile::tempdir().unwrap();
    for round in 0..40 {
        // Every other survey runs along X and Y, as ZMAP+ and CPS-3 need it.
        let straight = round % 2 == 0;
        let angle = if straight { std::f64::consts::FRAC_PI_2 * random.below(4) as f64 } else { 6.3 * random.next() };
        let geometry = random_survey(&mut random, angle);
        let written = random_horizon(&mut random, &geometry);
        let holds = |f: &Format| straight || !matches!(f, Format::Zmap | Format::Cps3);
        for format in Format::all().filter(|f| f.codec().write_horizon.is_some()).filter(holds) {
            let path = folder.path().join("horizon.dat");
            write_horizon(&path, &written, &geometry, format).unwrap_or_else(|e| panic!("{e}"));
            let found = read_horizons(&path, &geometry, &ImportOptions::default());
            let (read, report) = found.unwrap_or_else(|e| panic!("{format}, round {round}: {e}")).remove(0);
            assert_eq!(report.format.value, format, "recognised");
            let (original, sheet) = (&written.sheets[0], &read.sheets[0]);
            // On a square grid a plane is smooth in either order of its values: CPS-3 may warn.
            assert!(report.warnings.is_empty() || format == Format::Cps3, "{report}");
            assert_eq!(read.sheets.len(), 1, "{format}, round {round}: {report}");
            let nv = original.grid.count[1];
            for (n, z) in original.depth.iter().enumerate() {
                let node = DVec2::new((n / nv) as f64, (n % nv) as f64);
                let there = sheet.grid.node_at(original.grid.world_at(node));
                assert!((there - there.round()).abs().max_element() < 1e-2, "{format}, round {round}: node {there}");
                let found = sheet.depth_at_node(there.round());
                // A TSurf keeps no node without a triangle and closes no hole but at its rim.
                let lost = format == Format::Tsurf && found.is_nan();
                assert!(
                    (found - z).abs() < 2e-3 || (found.is_nan() && z.is_nan()) || lost,
                    "{format}, round {round}: {found} {z}"
                );
            }
            assert!(sheet.node_count() * 10 >= original.node_count() * 8, "{format}, round {round}");
        }
    }
}

#[test]
fn rotated_surveys_are_resampled_for_formats_without_rotation_or_refused() {
    let mut random = Random(8);
    let folder = tempfile::tempdir().unwrap();
    for format in [Format::Zmap, Format::Cps3] {
        for angle in [0.4, 2.0, 5.5] {
            let geometry = random_survey(&mut random, angle);
            let mut written = random_horizon(&mut random, &geometry);
            // A plane without holes has one answer everywhere.
            let grid = written.sheets[0].grid;
            let plane = |w: DVec2| (350.0 + 0.02 * (w.x - grid.origin.x) - 0.03 * (w.y - grid.origin.y)) as f32;
            let world = |n: usize| grid.world_at(DVec2::new((n / grid.count[1]) as f64, (n % grid.count[1]) as f64));
            let depth = (0..grid.count[0] * grid.count[1]).map(|n| plane(world(n))).collect();
            written.sheets[0] = Sheet::new(grid, depth, Quality::Picked);
            let path = folder.path().join("a.grid");
            let refuse = ExportOptions { when_rotated: WhenRotated::Refuse };
            let error = write_horizon_as(&path, &written, &geometry, format, &refuse).unwrap_err();
            assert!(error.to_string().contains("rotated by") && !path.exists(), "{error}");
            assert_eq!(error.remedy().unwrap().to_string(), "rotated grids resample");
            let report = write_horizon(&path, &written, &geometry, format).unwrap();
            assert!(report.notes[0].contains("resampled"), "{:?}", report.notes);
            let options = ImportOptions { value_order: Some(ValueOrder::Columns), ..ImportOptions::default() };
            let (read, _) = read_horizons(&path, &geometry, &options).unwrap_or_else(|e| panic!("{e}")).remove(0);
            let sheet = &read.sheets[0];
            assert_eq!(sheet.node_count(), report.nodes);
            let nv = sheet.grid.count[1];
            for (n, z) in sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite()) {
                let wanted = plane(sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64)));
                assert!((z - wanted).abs() < 2e-3, "{format}: {z} {wanted}");
            }
            // The box around a turned rectangle is larger than it; its nodes cover the rectangle as densely.
            let area = |g: &NodeGrid| g.u_step.perp_dot(g.v_step).abs();
            let share = report.nodes as f64 * area(&sheet.grid)
                / ((grid.count[0] - 1) as f64 * (grid.count[1] - 1) as f64 * area(&grid));
            assert!((0.7..1.3).contains(&share), "{format}: {share}");
            std::fs::remove_file(&path).unwrap();
        }
    }
}

#[test]
fn the_share_that_was_not_picked_is_written_where_there_is_room() {
    let geometry = SurveyGeometry::regular([6, 5, 40], 25.0, 4.0, VerticalUnit::Milliseconds);
    let grid = NodeGrid {
        origin: geometry.origin,
        u_step: geometry.inline_vector,
        v_step: geometry.crossline_vector,
        count: [6, 5],
    };
    let mut sheet = Sheet::new(grid, vec![60.0; 30], Quality::Picked);
    let mut horizon = Horizon::new("Top", vec![sheet.clone()]);
    let folder = tempfile::tempdir().unwrap();
    let write = |horizon: &Horizon, format: Format| {
        let path = folder.path().join(format.name());
        let report = write_horizon(&path, horizon, &geometry, format).unwrap();
        let read = read_horizons(&path, &geometry, &ImportOptions::default()).is_ok();
        (report.notes.join(" "), std::fs::read_to_string(&path).unwrap(), read)
    };
    assert_eq!(write(&horizon, Format::Csv).0, "");
    sheet.quality[..12].fill(Quality::Filled);
    sheet.quality[12..15].fill(Quality::Extrapolated);
    horizon.sheets = vec![sheet];
    let share = "50 % of the nodes were not picked but filled or extrapolated";
    for format in [Format::Csv, Format::Irap, Format::OpendTect, Format::Zmap, Format::Cps3, Format::Tsurf] {
        let (told, text, _) = write(&horizon, format);
        assert!(told.contains(share), "{format}: {told}");
        assert_eq!(told.contains("the column quality"), format == Format::Csv, "{format}: {told}");
        assert_eq!(text.contains(share), matches!(format, Format::OpendTect | Format::Zmap), "{format}");
    }
    for format in [Format::OpendTect, Format::Zmap] {
        assert!(write(&horizon, format).2, "{format} is read back");
    }
}
