//! What is written is read back: horizons on random surveys (rotated, mirrored, stepped) in every format that is written.

use super::*;
use crate::geometry::{LineAxis, VerticalAxis, VerticalUnit};
use crate::horizon::{NodeGrid, Quality, Sheet};
use glam::DVec2;

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

fn random_survey(random: &mut Random) -> SurveyGeometry {
    let along = DVec2::from_angle(6.3 * random.next());
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
    Horizon { name: "Top chalk".into(), sheets: vec![Sheet::new(grid, depth, Quality::Picked)] }
}

#[test]
fn horizons_survive_every_format_on_random_surveys() {
    let mut random = Random(5);
    let folder = tempfile::tempdir().unwrap();
    for round in 0..40 {
        let geometry = random_survey(&mut random);
        let written = random_horizon(&mut random, &geometry);
        for format in Format::all().filter(|f| f.codec().write_horizon.is_some()) {
            let path = folder.path().join("horizon.dat");
            write_horizon(&path, &written, &geometry, format).unwrap_or_else(|e| panic!("{e}"));
            let found = read_horizons(&path, &geometry, &ImportOptions::default());
            let (read, report) = found.unwrap_or_else(|e| panic!("{format}, round {round}: {e}")).remove(0);
            assert_eq!(report.format.value, format, "recognised");
            let (original, sheet) = (&written.sheets[0], &read.sheets[0]);
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
