//! Geologic time with picked horizons, unconformities and tops of wells.

use super::*;

/// A fault with a throw of one and a half periods of beds that repeat: reflections alone cannot tell by how many periods.
fn repeating() -> (Volume<f32>, Cut, impl Fn(f32, f32, f32) -> f32 + Copy) {
    let strat = |x: f32, y: f32, z: f32| z - 0.1 * y - if x > 21.5 { 15.0 } else { 0.0 };
    let mut volume = Volume::filled([44, 36, 96], 0.0f32);
    for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
        let t = strat((n / 96 / 36) as f32, (n / 96 % 36) as f32, (n % 96) as f32);
        *sample = (t * std::f32::consts::TAU / 10.0).sin();
    }
    (volume, Cut::new(Across::Inlines, 36, 96, |_, _| 21.5), strat)
}

fn beside(x: f32, _: f32) -> bool {
    (x - 21.5).abs() > 2.0
}

/// The nodes of the bed at a stratigraphic depth.
fn bed(at: f32, size: [usize; 3], strat: impl Fn(f32, f32, f32) -> f32) -> Vec<Place> {
    let traces = (0..size[0]).flat_map(|x| (0..size[1]).map(move |y| [x, y]));
    traces.map(|[x, y]| Place { trace: [x, y], z: at - strat(x as f32, y as f32, 0.0) }).collect()
}

#[test]
fn a_picked_horizon_has_one_time_and_tells_the_throw_of_beds_that_repeat() {
    let (volume, cut, strat) = repeating();
    let alone = time_of(&volume, std::slice::from_ref(&cut));
    let (worst, _) = errors(&alone.tau, strat, beside);
    assert!(worst > 4.0, "beds that repeat hide a throw, or this test shows nothing: {worst}");
    let nodes = bed(42.5, volume.size(), strat);
    let horizons = vec![KnownHorizon { nodes: nodes.clone(), jump: Jump::None }];
    let found = time_with(&volume, &Interpretation { horizons, ..vec![cut].into() });
    let (worst, share) = errors(&found.tau, strat, beside);
    assert!(worst < 0.5 && share > 0.7, "{worst} {share}");
    let at = |place: &Place| {
        let trace = found.tau.trace(place.trace[0], place.trace[1]);
        let low = place.z as usize;
        trace[low] + (place.z - low as f32) * (trace[low + 1] - trace[low])
    };
    let times: Vec<f32> = nodes.iter().map(at).filter(|time| time.is_finite()).collect();
    assert!(times.len() > nodes.len() * 9 / 10);
    assert!(times.iter().all(|time| (time - times[0]).abs() < 1e-3), "one time on all its nodes");
    for (x, y) in (0..44).flat_map(|x| (0..36).map(move |y| (x, y))) {
        let known: Vec<f32> = found.tau.trace(x, y).iter().copied().filter(|t| t.is_finite()).collect();
        assert!(known.windows(2).all(|pair| pair[0] <= pair[1]), "trace {x}, {y}");
    }
}

#[test]
fn tops_of_one_name_in_two_wells_tell_the_throw() {
    let (volume, cut, strat) = repeating();
    let top = |x: usize, y: usize| Place { trace: [x, y], z: 42.5 - strat(x as f32, y as f32, 0.0) };
    let same = vec![[top(8, 10), top(35, 20)]];
    let found = time_with(&volume, &Interpretation { same, ..vec![cut].into() });
    let (worst, share) = errors(&found.tau, strat, beside);
    assert!(worst < 1.0 && share > 0.7, "{worst} {share}");
}

#[test]
fn time_jumps_at_an_unconformity_and_is_right_on_both_sides() {
    // Flat beds above sample 36 + x/8, beds that dip by half a sample a trace below.
    let base = |x: f32| 36.0 + x / 8.0;
    let strat = |x: f32, _: f32, z: f32| if z <= base(x) { z - x / 8.0 } else { 140.0 + z - 0.5 * x };
    let volume = volume([48, 32, 96], strat);
    let nodes: Vec<Place> =
        (0..48).flat_map(|x| (0..32).map(move |y| Place { trace: [x, y], z: base(x as f32) })).collect();
    let horizons = vec![KnownHorizon { nodes, jump: Jump::Below }];
    let told = time_with(&volume, &Interpretation { horizons, ..Interpretation::default() });
    let (worst, share) = errors(&told.tau, strat, |x, z| (z - base(x)).abs() > 3.0);
    assert!(worst < 0.6 && share > 0.6, "{worst} {share}");
    // Beds go on up to the unconformity: what is cut off is missing, not squeezed.
    let step = |tau: &Volume<f32>, x: usize| {
        let at = base(x as f32) as usize;
        tau.at(x, 16, at + 2) - tau.at(x, 16, at - 1) - 3.0
    };
    // What is missing grows by three eighths of a sample a trace.
    let steps: Vec<f32> = (4..44).map(|x| step(&told.tau, x)).collect();
    assert!(steps.iter().all(|step| *step > -2.5), "{steps:?}");
    assert!((steps[4] - steps[34] - 0.375 * 30.0).abs() < 4.0, "{steps:?}");
}

#[test]
fn the_part_of_an_interpretation_within_some_inlines_counts_from_their_start() {
    let whole = Interpretation {
        cuts: vec![
            Cut::new(Across::Inlines, 4, 3, |_, z| 10.0 + z as f32),
            Cut::new(Across::Crosslines, 20, 3, |line, _| line as f32),
        ],
        horizons: vec![KnownHorizon { nodes: bed(2.0, [20, 4, 3], |_, _, _| 0.0), jump: Jump::Above }],
        same: vec![[Place { trace: [3, 1], z: 1.0 }, Place { trace: [9, 1], z: 2.0 }]],
    };
    let part = whole.within(&(8..14));
    assert_eq!(part.cuts[0].at(1, 2.0), 4.0);
    assert_eq!((part.cuts[1].size, part.cuts[1].at(0, 1.0)), ([6, 3], 8.0));
    assert_eq!(part.horizons[0].nodes.len(), 6 * 4);
    assert!(part.same.is_empty() && whole.within(&(0..20)) == whole);
}
