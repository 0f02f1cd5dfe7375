//! Faults proposed from a horizon and from what the data say.

use attribute::{DipSettings, SemblanceSettings, dip, semblance};
use glam::DVec3;
use interp::faults::{Evidence, Proposal, ProposeSettings, propose_faults};
use interp::reassembly::{VoxelSheet, from_horizon};
use model::FaultNetwork;
use survey::{Horizon, Progress, Quality, Sheet};
use synth::{SynthSettings, Synthetic};

/// A horizon's true sheets, drawn back by two traces from where they end, with a little noise: what tracking leaves.
fn tracked(survey: &Synthetic, horizon: &Horizon) -> Vec<VoxelSheet> {
    let [nx, ny, _] = survey.geometry.size();
    let draw = |(n, sheet): (usize, &Sheet)| {
        let keep = |x: usize, y: usize| {
            let near = |i: usize, j: usize| sheet.depth[i * ny + j].is_finite();
            (x.saturating_sub(2)..=(x + 2).min(nx - 1))
                .all(|i| (y.saturating_sub(2)..=(y + 2).min(ny - 1)).all(|j| near(i, j)))
        };
        let depth = (0..nx * ny)
            .map(|k| {
                let noise = (k as u32).wrapping_mul(2_654_435_761).wrapping_add(n as u32).rotate_left(11) % 1000;
                let by = (noise as f32 / 1000.0 - 0.5) * survey.geometry.vertical.interval as f32 * 0.6;
                if keep(k / ny, k % ny) { sheet.depth[k] + by } else { f32::NAN }
            })
            .collect();
        Sheet::new(sheet.grid, depth, Quality::Tracked)
    };
    let sheets = horizon.sheets.iter().enumerate().map(draw).collect();
    from_horizon(&Horizon::new(horizon.name.clone(), sheets), &survey.geometry, &FaultNetwork::none())
}

/// One horizon knows a fault's place and not its dip: semblance along it does.
#[test]
fn the_dip_of_a_fault_through_one_horizon_comes_from_the_data() {
    let settings = SynthSettings { size: [128, 112, 128], seed: 1, snr: None, ..SynthSettings::default() };
    let survey = Synthetic::generate(&settings, &Progress::silent()).unwrap();
    let dips = dip(&survey.seismic, &DipSettings::default(), &Progress::silent()).unwrap();
    let likeness = semblance(&survey.seismic, &dips, &SemblanceSettings::default(), &Progress::silent()).unwrap();
    let sheets = tracked(&survey, &survey.horizons[1]);
    let evidence = [Evidence { name: "Bravo", sheets: &sheets }];
    let (settings, unknown) = (ProposeSettings::default(), FaultNetwork::none());
    let found =
        propose_faults(&evidence, &survey.geometry, &unknown, Some(&likeness), &settings, &Progress::silent()).unwrap();
    for truth in survey.truth.faults.iter().filter(|truth| truth.tip.is_none()) {
        // Where it meets the horizon, on the middle crossline; its dip there is that of the middle of the volume within
        // a few degrees.
        let at = |proposal: &Proposal| {
            let middle = proposal.mesh.vertices.iter().copied().sum::<DVec3>() / proposal.mesh.vertices.len() as f64;
            truth.side_m(survey.geometry.metric_from_voxel() * survey.geometry.voxel_from_world(middle)).abs()
        };
        let nearest = found.proposals.iter().min_by(|a, b| at(a).total_cmp(&at(b))).unwrap();
        let dip_deg = (1.0 / truth.run.abs()).atan().to_degrees();
        assert!((nearest.dip_deg - dip_deg).abs() < 8.0, "{}: {} of {dip_deg} degrees", truth.name, nearest.dip_deg);
        assert_eq!(nearest.reverse, truth.throw_m < 0.0, "{}", truth.name);
    }
}
