//! Geologic time of volumes whose layering is a closed form.

use crate::{
    Across, Cut, GeologicTime, Interpretation, Jump, KnownHorizon, Place, Reflections, Seed, Support, TimeError,
    TimeSettings, geologic_time, isochron,
};
use interp::{Extremum, GrowSettings, grow_surfaces};
use survey::{Progress, Volume};

mod bodies;
mod chaos;
mod interpretation;
mod slabs;

/// Reflectivity of made-up beds at a stratigraphic depth: nothing repeats over a few beds.
fn beds(t: f32) -> f32 {
    (t * 0.71).sin() + 0.8 * (t * 0.43 + 1.0).sin() + 0.5 * (t * 0.93 + 2.0).cos()
}

/// A volume whose stratigraphic depth at a voxel is `strat`.
fn volume(size: [usize; 3], strat: impl Fn(f32, f32, f32) -> f32) -> Volume<f32> {
    let mut volume = Volume::filled(size, 0.0f32);
    let [_, ny, nz] = size;
    for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
        *sample = beds(strat((n / nz / ny) as f32, (n / nz % ny) as f32, (n % nz) as f32));
    }
    volume
}

fn time_of(volume: &Volume<f32>, cuts: &[Cut]) -> GeologicTime {
    time_with(volume, &cuts.into())
}

fn time_with(volume: &Volume<f32>, interpretation: &Interpretation) -> GeologicTime {
    let surfaces = grow_surfaces(volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    geologic_time(volume, &surfaces, interpretation, &TimeSettings::default(), &Progress::silent()).unwrap()
}

/// The greatest error of isochrons from the middle trace, in samples, and the share of traces that have one, leaving out
/// places for which `counts` is false.
fn errors(tau: &Volume<f32>, strat: impl Fn(f32, f32, f32) -> f32, counts: impl Fn(f32, f32) -> bool) -> (f32, f32) {
    let [nx, ny, nz] = tau.size();
    let (mut worst, mut found, mut all) = (0.0f32, 0, 0);
    for z in (nz / 3..2 * nz / 3).step_by(5) {
        let wanted = strat((nx / 4) as f32, (ny / 2) as f32, z as f32);
        for at in isochron(tau, tau.at(nx / 4, ny / 2, z)).crossings {
            if counts(f32::from(at.x), at.z) {
                worst = worst.max((strat(f32::from(at.x), f32::from(at.y), at.z) - wanted).abs());
                found += 1;
            }
        }
        all += nx * ny;
    }
    (worst, found as f32 / all as f32)
}

#[test]
fn dipping_planes_are_isochrons() {
    let strat = |x: f32, y: f32, z: f32| z - 0.6 * x + 0.35 * y;
    let found = time_of(&volume([32, 32, 80], strat), &[]);
    let (worst, share) = errors(&found.tau, strat, |_, _| true);
    assert!(worst < 0.1 && share > 0.95, "{worst} {share}");
    assert!(found.known > 0.95);
}

#[test]
fn a_throw_between_reflectors_is_found_and_isochrons_go_on_beyond_the_fault() {
    // The upper side is 11.5 samples deeper, more than the distance of the reflectors.
    let fault = |z: f32| 22.0 + 0.3 * (z - 48.0);
    let strat = |x: f32, y: f32, z: f32| z - 0.2 * y - if x > fault(z) { 11.5 } else { 0.0 };
    let cut = Cut::new(Across::Inlines, 40, 96, |_, z| fault(z as f32));
    let volume = volume([48, 40, 96], strat);
    let found = time_of(&volume, &[cut]);
    let beside = |x: f32, z: f32| (x - fault(z)).abs() > 2.0;
    let (worst, share) = errors(&found.tau, strat, beside);
    assert!(worst < 0.5 && share > 0.8, "{worst} {share}");
    // Without the fault the time of one bed is that of another beyond it.
    let (worst, _) = errors(&time_of(&volume, &[]).tau, strat, beside);
    assert!(worst > 2.0, "{worst}");
}

#[test]
fn time_increases_down_every_trace_without_a_fault() {
    let strat = |x: f32, y: f32, z: f32| z + 4.0 * (0.2 * x).sin() * (0.15 * y).cos();
    let tau = time_of(&volume([32, 32, 80], strat), &[]).tau;
    for (x, y) in (0..32).flat_map(|x| (0..32).map(move |y| (x, y))) {
        let known: Vec<f32> = tau.trace(x, y).iter().copied().filter(|t| t.is_finite()).collect();
        assert!(known.windows(2).all(|pair| pair[0] <= pair[1]), "trace {x}, {y}");
    }
}

#[test]
fn the_same_bits_on_one_thread_and_on_several() {
    let strat = |x: f32, y: f32, z: f32| z - 0.2 * y - if x > 15.0 { 6.0 } else { 0.0 };
    let volume = volume([32, 24, 64], strat);
    let cut = [Cut::new(Across::Inlines, 24, 64, |_, _| 15.3)];
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tau = pool.install(|| time_of(&volume, &cut)).tau;
        tau.samples().iter().map(|t| t.to_bits()).collect::<Vec<_>>()
    };
    assert!(on(1) == on(3));
}

#[test]
fn where_nothing_reflects_time_is_not_known() {
    for size in [[24, 24, 48], [1, 1, 48], [1, 30, 48]] {
        let found = time_of(&Volume::filled(size, 1.0f32), &[]);
        assert_eq!(found.known, 0.0);
        assert!(found.tau.samples().iter().all(|t| t.is_nan()));
    }
    // A fault cuts off a side without any event; dead traces stay unknown.
    let mut one_side = volume([40, 30, 64], |_, _, z| z);
    for x in 20..40 {
        (0..30).for_each(|y| one_side.trace_mut(x, y).fill(0.0));
    }
    let mut live = vec![true; 40 * 30];
    live[5 * 30 + 7] = false;
    one_side.set_live(Some(live)).unwrap();
    let tau = time_of(&one_side, &[Cut::new(Across::Inlines, 30, 64, |_, _| 19.5)]).tau;
    assert!(tau.at(10, 10, 30).is_finite());
    assert!(tau.trace(5, 7).iter().all(|t| t.is_nan()), "a dead trace");
    assert!((22..40).all(|x| tau.trace(x, 10).iter().all(|t| t.is_nan())), "beyond the fault");
}

#[test]
fn where_there_are_no_data_time_is_not_known_and_beside_them_it_is_as_before() {
    let strat = |x: f32, y: f32, z: f32| z - 0.2 * x + 0.1 * y;
    let mut holed = volume([32, 28, 72], strat);
    let is_missing = |x: usize, z: usize| x < 20 && (30..40).contains(&z);
    for (x, y) in (0..32).flat_map(|x| (0..28).map(move |y| (x, y))) {
        let missing = holed.trace_mut(x, y).iter_mut().enumerate().filter(|(z, _)| is_missing(x, *z));
        missing.for_each(|(_, sample)| *sample = f32::NAN);
    }
    let found = time_of(&holed, &[]);
    for (x, y, z) in (0..32).flat_map(|x| (0..28).flat_map(move |y| (0..72).map(move |z| (x, y, z)))) {
        assert!(!is_missing(x, z) || found.tau.at(x, y, z).is_nan(), "{x} {y} {z}");
    }
    let (worst, share) = errors(&found.tau, strat, |_, _| true);
    assert!(worst < 0.5 && share > 0.45, "{worst} {share}");
}

#[test]
fn it_refuses_candidates_of_another_volume_and_stops_when_cancelled() {
    let small = volume([24, 24, 48], |_, _, z| z);
    let surfaces = grow_surfaces(&small, &GrowSettings::default(), &Progress::silent()).unwrap();
    let other = Volume::filled([24, 24, 50], 0.0f32);
    let settings = TimeSettings::default();
    let refused = geologic_time(&other, &surfaces, &Interpretation::default(), &settings, &Progress::silent());
    assert!(matches!(refused, Err(TimeError::Size { .. })));
    let cancelled = Progress::silent();
    cancelled.cancel();
    let stopped = geologic_time(&small, &surfaces, &Interpretation::default(), &settings, &cancelled);
    assert!(matches!(stopped, Err(TimeError::Cancelled(_))));
}

#[test]
fn an_event_goes_through_its_patch_where_time_is_off_and_a_second_seed_corrects_it() {
    let strat = |x: f32, y: f32, z: f32| z - 0.6 * x + 0.35 * y;
    let volume = volume([40, 32, 80], strat);
    let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    let mut tau = time_of(&volume, &[]).tau;
    let reflections = Reflections::new(&surfaces, &[]);
    let seed = reflections.nearest([8, 16], 40.0, None, 6.0).unwrap();
    let wanted = strat(8.0, 16.0, seed.z);
    let worst = |seeds: &[Seed], tau: &Volume<f32>| {
        let event = reflections.event(tau, seeds, &[]).unwrap();
        let inside = event.nodes.iter().filter(|node| node.z > 8.0 && node.z < 72.0);
        let off = inside.map(|node| (strat(f32::from(node.x), f32::from(node.y), node.z) - wanted).abs());
        (off.fold(0.0, f32::max), event)
    };
    let first = Seed { trace: [8, 16], z: seed.z };
    let (exact, event) = worst(&[first], &tau);
    assert!(exact < 0.1, "{exact}");
    assert!(event.nodes.iter().filter(|node| node.support == Support::Tracked).count() > 1200);
    // Where time is four samples off in a corner, the patch says where the event is.
    let spoil = |tau: &mut Volume<f32>, by: f32, from: usize| {
        for (n, tau) in tau.samples_mut().iter_mut().enumerate() {
            *tau += if n / 80 / 32 >= from { by } else { 0.0 };
        }
    };
    spoil(&mut tau, 4.0, 34);
    assert!(worst(&[first], &tau).0 < 0.1);
    // Half a survey on another bed is corrected by a seed there.
    spoil(&mut tau, 15.0, 20);
    assert!(worst(&[first], &tau).0 > 3.0);
    let second = Seed { trace: [30, 16], z: seed.z + 0.6 * 22.0 };
    let (off, event) = worst(&[first, second], &tau);
    let right =
        event.nodes.iter().filter(|n| (strat(f32::from(n.x), f32::from(n.y), n.z) - wanted).abs() < 0.2).count();
    // The second seed holds the rest of the patch.
    assert!(right as f32 > 0.85 * event.nodes.len() as f32, "{right} of {}, {off}", event.nodes.len());
}

#[test]
fn a_further_seed_is_obeyed_where_nothing_that_the_first_follows_reflects_beside_it() {
    let strat = |x: f32, y: f32, z: f32| z - 0.6 * x + 0.35 * y;
    let volume = volume([40, 32, 80], strat);
    let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    let tau = time_of(&volume, &[]).tau;
    let reflections = Reflections::new(&surfaces, &[]);
    let at = |x: usize, kind: Extremum| {
        let z = reflections.nearest([x, 16], 34.0 + 0.6 * (x as f32 - 8.0), Some(kind), 9.0).unwrap().z;
        Seed { trace: [x, 16], z }
    };
    // The first follows a trough; the second points at a peak between two troughs.
    let (first, second) = (at(8, Extremum::Trough), at(30, Extremum::Peak));
    assert!(reflections.nearest([30, 16], second.z, Some(Extremum::Trough), 1.5).is_none());
    let event = reflections.event(&tau, &[first, second], &[]).unwrap();
    for seed in [first, second] {
        let node = event.nodes.iter().find(|node| [node.x, node.y].map(usize::from) == seed.trace).unwrap();
        assert!((node.z - seed.z).abs() < 0.2, "{node:?} for {seed:?}");
    }
}

/// The event of a volume whose upper side lies six samples deeper beyond inline 24, from seeds at the middle crossline.
fn across(bed: impl Fn(f32) -> f32, seeds: &[Seed]) -> (crate::Event, Vec<crate::Doubt>) {
    let mut volume = Volume::filled([48, 32, 96], 0.0f32);
    for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
        let (x, y, z) = ((n / 96 / 32) as f32, (n / 96 % 32) as f32, (n % 96) as f32);
        *sample = bed(z - 0.2 * y - if x > 23.5 { 6.0 } else { 0.0 });
    }
    let cuts = [Cut::new(Across::Inlines, 32, 96, |_, _| 23.5)];
    let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    let tau = time_of(&volume, &cuts).tau;
    let reflections = Reflections::new(&surfaces, &cuts);
    let mut event = reflections.event(&tau, seeds, &cuts).unwrap();
    let doubts = event.examine(&reflections, seeds, &cuts, &volume);
    (event, doubts)
}

#[test]
fn beyond_a_fault_whose_sides_repeat_an_event_is_assumed_until_a_place_there_decides() {
    // Peaks every ten samples, all alike, and beds of which none repeats.
    let alike = |t: f32| (t * std::f32::consts::TAU / 10.0).cos();
    let seed = |x: usize, z: f32| Seed { trace: [x, 16], z };
    let first = seed(8, 43.2);
    let (event, doubts) = across(alike, &[first]);
    assert_eq!(doubts.iter().map(|doubt| doubt.fault).collect::<Vec<_>>(), [Some(0)]);
    assert!(doubts[0].place.trace[0] > 23 && doubts[0].nodes > 600, "{doubts:?}");
    for node in &event.nodes {
        assert_eq!(node.support == Support::Assumed, node.x > 23, "{node:?}");
    }
    // A place there, a peak farther down, is obeyed all over that block, and nothing is asked any more.
    let second = seed(40, 59.2);
    let (event, doubts) = across(alike, &[first, second]);
    assert_eq!(doubts, []);
    let off = |node: &crate::Node| (node.z - 0.2 * f32::from(node.y) - if node.x > 23 { 56.0 } else { 40.0 }).abs();
    let right = event.nodes.iter().filter(|node| off(node) < 0.5).count();
    assert!(right as f32 > 0.95 * event.nodes.len() as f32, "{right} of {}", event.nodes.len());
    // Beds of which none repeats tell it.
    let (event, doubts) = across(beds, &[first]);
    assert!(doubts.is_empty() && event.nodes.iter().all(|node| node.support != Support::Assumed), "{doubts:?}");
}

#[test]
fn a_cycle_that_is_skipped_within_a_block_is_mended_or_asked_about() {
    // Where a reef or a dimmed reflection lets time slip, the event runs ten samples, about a period, too deep.
    let strat = |x: f32, y: f32, z: f32| z - 0.3 * x + 0.2 * y;
    let volume = volume([48, 32, 96], strat);
    let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    let reflections = Reflections::new(&surfaces, &[]);
    let tau = time_of(&volume, &[]).tau;
    let seed = Seed { trace: [8, 16], z: reflections.nearest([8, 16], 40.0, None, 6.0).unwrap().z };
    let wanted = strat(8.0, 16.0, seed.z);
    let off = |node: &crate::Node| (strat(f32::from(node.x), f32::from(node.y), node.z) - wanted).abs();
    let jumps = |event: &crate::Event| {
        let pairs = event.nodes.windows(2).filter(|pair| pair[0].x == pair[1].x);
        pairs.filter(|pair| (pair[0].z - pair[1].z).abs() > 4.0).count()
    };
    let slipped = |slips: &dyn Fn(u16, u16) -> bool| {
        let mut event = reflections.event(&tau, &[seed], &[]).unwrap();
        event.nodes.iter_mut().filter(|node| slips(node.x, node.y)).for_each(|node| node.z += 10.0);
        let before = jumps(&event);
        let doubts = event.examine(&reflections, &[seed], &[], &volume);
        (before, event, doubts)
    };
    // In an island of a few traces.
    let (before, event, doubts) = slipped(&|x, y| (30..34).contains(&x) && (12..16).contains(&y));
    assert!(before == 8 && jumps(&event) == 0 && doubts.is_empty(), "{before} {}", jumps(&event));
    assert!(event.nodes.iter().all(|node| off(node) < 0.5));
    assert!(event.nodes.len() > 48 * 32 - 8, "{}", event.nodes.len());
    // In a third of the survey: that is asked about, and only assumed.
    let (_, event, doubts) = slipped(&|x, _| x >= 32);
    assert!(matches!(doubts[..], [crate::Doubt { fault: None, .. }]), "{doubts:?}");
    assert!(event.nodes.iter().all(|node| (node.support == Support::Assumed) == (node.x >= 32)));
}
