//! Proposed faults beside the surfaces that offset the horizons.

use super::*;
use crate::reassembly::from_horizon;
use survey::attribute::{DipSettings, SemblanceSettings, dip, semblance};
use survey::model::FaultNetwork;
use survey::synth::{SynthSettings, Synthetic};
use survey::{NodeGrid, Quality, Sheet, VerticalUnit};

fn survey_of(seed: u64) -> Synthetic {
    let settings = SynthSettings { size: [128, 112, 128], seed, snr: None, ..SynthSettings::default() };
    Synthetic::generate(&settings, &Progress::silent()).unwrap()
}

/// The true sheets, drawn back by two traces from where they end, with a little noise: what tracking leaves.
fn tracked(survey: &Synthetic) -> Vec<Vec<VoxelSheet>> {
    let [nx, ny, _] = survey.geometry.size();
    let draw = |sheet: &Sheet, n: u32| {
        let keep = |x: usize, y: usize| {
            let near = |i: usize, j: usize| sheet.depth[i * ny + j].is_finite();
            (x.saturating_sub(2)..=(x + 2).min(nx - 1))
                .all(|i| (y.saturating_sub(2)..=(y + 2).min(ny - 1)).all(|j| near(i, j)))
        };
        let depth = (0..nx * ny)
            .map(|k| {
                let noise = (k as u32).wrapping_mul(2_654_435_761).wrapping_add(n).rotate_left(11) % 1000;
                let by = (noise as f32 / 1000.0 - 0.5) * survey.geometry.vertical.interval as f32 * 0.6;
                if keep(k / ny, k % ny) { sheet.depth[k] + by } else { f32::NAN }
            })
            .collect();
        Sheet::new(sheet.grid, depth, Quality::Tracked)
    };
    survey
        .horizons
        .iter()
        .map(|horizon| {
            let sheets = horizon.sheets.iter().enumerate().map(|(n, sheet)| draw(sheet, n as u32)).collect();
            let drawn = survey::Horizon { name: horizon.name.clone(), sheets };
            from_horizon(&drawn, &survey.geometry, &FaultNetwork::none())
        })
        .collect()
}

#[test]
fn the_faults_of_a_synthetic_survey_are_found_where_they_are() {
    for seed in [1, 2] {
        let survey = survey_of(seed);
        let sheets = tracked(&survey);
        let names: Vec<&str> = survey.horizons.iter().map(|horizon| horizon.name.as_str()).collect();
        let evidence: Vec<Evidence> =
            names.iter().zip(&sheets).map(|(name, sheets)| Evidence { name, sheets }).collect();
        let settings = ProposeSettings::default();
        let found = propose_faults(&evidence, &survey.geometry, None, &settings, &Progress::silent()).unwrap();
        assert_eq!(
            found.len(),
            3,
            "{:?}",
            found
                .iter()
                .map(|p| (p.support, p.throw, p.reverse, &p.horizons, p.dip_deg, p.misfit_m, p.ends))
                .collect::<Vec<_>>()
        );
        for (f, truth) in survey.truth.faults.iter().enumerate() {
            // The proposal whose middle is nearest to this fault.
            let distances = |proposal: &Proposal| -> Vec<f64> {
                let inside =
                    |p: &DVec3| p.cmpge(DVec3::ZERO).all() && (0..3).all(|a| p[a] <= survey.truth.size[a] as f64);
                let voxels = proposal.mesh.vertices.iter().map(|v| survey.geometry.voxel_from_world(*v)).filter(inside);
                let mut all: Vec<f64> = voxels.map(|p| survey.truth.fault_side_m(f, p).abs()).collect();
                all.sort_by(f64::total_cmp);
                all
            };
            let median = |proposal: &Proposal| distances(proposal)[distances(proposal).len() / 2];
            let nearest = found.iter().min_by(|a, b| median(a).total_cmp(&median(b))).unwrap();
            let (all, median) = (distances(nearest), median(nearest));
            assert!(median < 25.0, "{}: {median} m off", truth.name);
            assert!(all[all.len() * 95 / 100] < 75.0, "{}: {} m off", truth.name, all[all.len() * 95 / 100]);
            assert_eq!(nearest.reverse, truth.throw_m < 0.0, "{}", truth.name);
            let throw = nearest.throw[1] / truth.throw_m.abs();
            assert!((0.7..1.35).contains(&throw), "{}: {:?} of {}", truth.name, nearest.throw, truth.throw_m);
            assert!(nearest.horizons.len() >= 3, "{:?}", nearest.horizons);
        }
    }
}

/// One horizon knows a fault's place and not its dip: semblance along it does.
#[test]
fn the_dip_of_a_fault_through_one_horizon_comes_from_the_data() {
    let survey = survey_of(1);
    let dips = dip(&survey.seismic, &DipSettings::default(), &Progress::silent()).unwrap();
    let likeness = semblance(&survey.seismic, &dips, &SemblanceSettings::default(), &Progress::silent()).unwrap();
    let sheets = tracked(&survey).swap_remove(1);
    let evidence = [Evidence { name: "Bravo", sheets: &sheets }];
    let settings = ProposeSettings::default();
    let found = propose_faults(&evidence, &survey.geometry, Some(&likeness), &settings, &Progress::silent()).unwrap();
    for truth in survey.truth.faults.iter().filter(|truth| truth.tip.is_none()) {
        // Where it meets the horizon, on the middle crossline; its dip there is that of the middle of the volume within a few degrees.
        let at = |proposal: &Proposal| {
            let middle = proposal.mesh.vertices.iter().copied().sum::<DVec3>() / proposal.mesh.vertices.len() as f64;
            truth.side_m(survey.geometry.metric_from_voxel() * survey.geometry.voxel_from_world(middle)).abs()
        };
        let nearest = found.iter().min_by(|a, b| at(a).total_cmp(&at(b))).unwrap();
        let dip_deg = (1.0 / truth.run.abs()).atan().to_degrees();
        assert!((nearest.dip_deg - dip_deg).abs() < 8.0, "{}: {} of {dip_deg} degrees", truth.name, nearest.dip_deg);
        assert_eq!(nearest.reverse, truth.throw_m < 0.0, "{}", truth.name);
    }
}

/// Holes, erosion and folds are no faults.
#[test]
fn a_horizon_with_holes_has_no_faults() {
    let geometry = SurveyGeometry::regular([80, 70, 60], 25.0, 10.0, VerticalUnit::Metres);
    let grid = NodeGrid::of_survey(&geometry);
    let depth = (0..80 * 70).map(|n| {
        let (x, y) = ((n / 70) as f32, (n % 70) as f32);
        let hole = (x - 30.0).hypot(y - 30.0) < 12.0 || (x - 60.0).abs() < 3.0 && y > 20.0;
        if hole { f32::NAN } else { 300.0 + 80.0 * (x / 15.0).sin() + 30.0 * (y / 20.0).cos() }
    });
    let horizon =
        survey::Horizon { name: "H".into(), sheets: vec![Sheet::new(grid, depth.collect(), Quality::Tracked)] };
    let sheets = from_horizon(&horizon, &geometry, &FaultNetwork::none());
    let evidence = [Evidence { name: "H", sheets: &sheets }];
    let found = propose_faults(&evidence, &geometry, None, &ProposeSettings::default(), &Progress::silent()).unwrap();
    assert!(found.is_empty(), "{:?}", found.iter().map(|p| (p.support, p.throw, p.ends)).collect::<Vec<_>>());
}

/// A dipping plane over 90 x 80 traces with `step(distance from a line, trace)` added, and noise of 0.25 samples.
fn stepped(step: impl Fn(f32) -> f32) -> (SurveyGeometry, Vec<VoxelSheet>) {
    let geometry = SurveyGeometry::regular([90, 80, 60], 25.0, 10.0, VerticalUnit::Metres);
    let height = |n: usize| {
        let (x, y) = ((n / 80) as f32, (n % 80) as f32);
        let noise = (n as u32).wrapping_mul(2_654_435_761).rotate_left(11) % 1000;
        30.0 + 0.1 * x - 0.05 * y + step((x - 45.0 + 0.3 * (y - 40.0)) / 1.044) + (noise as f32 / 1000.0 - 0.5) * 0.5
    };
    let z = (0..90 * 80).map(height).collect();
    (geometry, vec![VoxelSheet { block: 0, z, quality: vec![Quality::Tracked; 90 * 80] }])
}

#[test]
fn a_fault_that_was_tracked_across_is_found_by_its_bend() {
    // Four samples over three traces, and no gap.
    let (geometry, sheets) = stepped(|d| 4.0 * (d / 3.0 + 0.5).clamp(0.0, 1.0));
    let evidence = [Evidence { name: "H", sheets: &sheets }];
    let found = propose_faults(&evidence, &geometry, None, &ProposeSettings::default(), &Progress::silent()).unwrap();
    assert_eq!(found.len(), 1, "{:?}", found.iter().map(|p| (p.support, p.throw, p.ends)).collect::<Vec<_>>());
    let fault = &found[0];
    assert!((fault.throw[0] - 40.0).abs() < 4.0, "throw {:?} m of 40", fault.throw);
    for vertex in &fault.mesh.vertices {
        let p = geometry.voxel_from_world(*vertex);
        let off = (p.x - 45.0 + 0.3 * (p.y - 40.0)) / 1.044;
        assert!(off.abs() < 1.0, "{off} traces off at {p}");
    }
    let mut ends = fault.ends.map(|end| end[1]);
    ends.sort_by(f64::total_cmp);
    assert!(ends[0] < 12.0 && ends[1] > 67.0, "it goes through the survey, not from {:?}", fault.ends);
}

/// The same offset over twenty traces is a fold.
#[test]
fn a_flexure_is_no_fault() {
    let (geometry, sheets) = stepped(|d| 4.0 * (0.5 + 0.5 * (d / 10.0).tanh()));
    let evidence = [Evidence { name: "H", sheets: &sheets }];
    let found = propose_faults(&evidence, &geometry, None, &ProposeSettings::default(), &Progress::silent()).unwrap();
    assert!(found.is_empty(), "{:?}", found.iter().map(|p| (p.support, p.throw, p.ends)).collect::<Vec<_>>());
}
