//! Growing on layered, faulted and degenerate volumes, and independence of order, slabs and
//! threads.

use super::*;
use crate::surfaces::Surface;
use synth::{SynthSettings, Synthetic};

/// A volume of reflectors of alternating polarity every `spacing` samples, at depth(x, y) + n·spacing.
fn layered(size: [usize; 3], spacing: f32, depth: impl Fn(usize, usize) -> f32) -> Volume<f32> {
    let mut volume = Volume::filled(size, 0.0f32);
    for x in 0..size[0] {
        for y in 0..size[1] {
            for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
                *value = 1000.0 * (std::f32::consts::PI * (z as f32 - depth(x, y)) / spacing).cos();
            }
        }
    }
    volume
}

fn grown(volume: &Volume<f32>, settings: &GrowSettings) -> Surfaces {
    grow_surfaces(volume, settings, &Progress::silent()).unwrap()
}

/// Properties of every result.
fn check(surfaces: &Surfaces) {
    let mut reached = (0, 0);
    for surface in &surfaces.surfaces {
        assert_eq!((surface.vertices.start, surface.triangles.start), reached);
        reached = (surface.vertices.end, surface.triangles.end);
        let vertices = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
        assert!(vertices.is_sorted_by(|a, b| (a.x, a.y, a.z) < (b.x, b.y, b.z)));
        let mut used = vec![false; vertices.len()];
        for triangle in &surfaces.triangles[surface.triangles.start as usize..surface.triangles.end as usize] {
            let corners = triangle.map(|corner| {
                assert!(surface.vertices.contains(&corner));
                used[(corner - surface.vertices.start) as usize] = true;
                surfaces.vertices[corner as usize]
            });
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                assert!(corners[a].x.abs_diff(corners[b].x) <= 1 && corners[a].y.abs_diff(corners[b].y) <= 1);
                assert!((corners[a].x, corners[a].y) != (corners[b].x, corners[b].y));
            }
        }
        assert!(used.into_iter().all(|used| used));
    }
    assert_eq!(reached, (surfaces.vertices.len() as u32, surfaces.triangles.len() as u32));
}

#[test]
fn dipping_layers_make_surfaces_of_every_trace() {
    let volume = layered([24, 20, 64], 10.0, |x, y| 15.0 + 0.4 * x as f32 - 0.2 * y as f32);
    let surfaces = grown(&volume, &GrowSettings::default());
    check(&surfaces);
    let whole: Vec<_> = surfaces.surfaces.iter().filter(|s| s.vertices.len() == 24 * 20).collect();
    assert!(whole.len() >= 3, "{}", whole.len());
    assert!(whole.iter().all(|s| s.triangles.len() == 2 * 23 * 19));
    for v in &surfaces.vertices {
        let layers = (v.z - (15.0 + 0.4 * f32::from(v.x) - 0.2 * f32::from(v.y))) / 10.0;
        assert!((layers - layers.round()).abs() < 2e-3);
    }
}

#[test]
fn steep_layers_do_not_alias() {
    // 2.5 samples a trace with peaks 16 samples apart: more than a period in seven traces.
    let volume = layered([32, 16, 128], 8.0, |x, _| 20.0 + 2.5 * x as f32);
    let surfaces = grown(&volume, &GrowSettings::default());
    check(&surfaces);
    for surface in &surfaces.surfaces {
        let vertices = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
        let layer = |v: &crate::Vertex| ((v.z - 20.0 - 2.5 * f32::from(v.x)) / 8.0).round();
        assert!(vertices.iter().all(|v| layer(v) == layer(&vertices[0])));
    }
    assert!(surfaces.surfaces.iter().filter(|s| s.vertices.len() > 400).count() >= 8);
}

#[test]
fn a_step_of_half_a_period_parts_surfaces() {
    let volume = layered([32, 32, 64], 8.0, |x, _| if x < 16 { 12.0 } else { 20.0 - 2.0 });
    let surfaces = grown(&volume, &GrowSettings::default());
    check(&surfaces);
    for surface in &surfaces.surfaces {
        let vertices = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
        assert!(vertices.iter().all(|v| (v.x < 16) == (vertices[0].x < 16)));
    }
    assert!(surfaces.surfaces.len() >= 10);
}

#[test]
fn a_reflector_does_not_go_on_along_the_side_lobe_that_a_fault_lays_against_it() {
    // Ricker wavelets of alternating polarity every 11 samples, thrown by 7.9: each reflector faces a lobe of
    // the next one, 3.1 above it.
    let mut volume = Volume::filled([32, 32, 96], 0.0f32);
    for x in 0..32 {
        for y in 0..32 {
            let first = 4.0 + 0.1 * y as f32 - if x < 16 { 0.0 } else { 7.9 };
            for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
                let wavelet = |n: i16| {
                    let square = (std::f32::consts::PI * (z as f32 - first - 11.0 * f32::from(n)) / 8.0).powi(2);
                    let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                    sign * (1.0 - 2.0 * square) * (-square).exp()
                };
                *value = 1000.0 * (-1..10).map(wavelet).sum::<f32>();
            }
        }
    }
    // Without a search for faults only the lobes decide. At the outer boundary a lobe may lack its reflector; the
    // own height of a lobe is a mean over three traces.
    let across = |lobe_share: f32| {
        let settings = GrowSettings { fault_evidence: f32::INFINITY, lobe_share, ..GrowSettings::default() };
        let surfaces = grown(&volume, &settings);
        check(&surfaces);
        let crosses = |s: &&Surface| {
            let vertices = &surfaces.vertices[s.vertices.start as usize..s.vertices.end as usize];
            vertices.iter().all(|v| (16.0..80.0).contains(&v.z))
                && vertices.iter().any(|v| v.x < 15)
                && vertices.iter().any(|v| v.x > 16)
        };
        surfaces.surfaces.iter().filter(crosses).count()
    };
    assert_eq!(across(GrowSettings::default().lobe_share), 0);
    assert!(across(0.0) >= 5);
}

#[test]
fn a_neck_narrower_than_the_front_does_not_connect() {
    // Dead traces leave two halves and a bridge three traces wide.
    let mut volume = layered([24, 24, 40], 10.0, |_, _| 15.0);
    let live = (0..24 * 24).map(|trace| trace / 24 != 12 || (10..13).contains(&(trace % 24))).collect();
    volume.set_live(Some(live)).unwrap();
    let parts = |width| {
        let settings = GrowSettings { min_front_width: width, ..GrowSettings::default() };
        let surfaces = grown(&volume, &settings);
        check(&surfaces);
        surfaces.surfaces.iter().filter(|s| s.vertices.len() > 200).count() / 3
    };
    assert_eq!((parts(4), parts(2)), (2, 2));
}

#[test]
fn threads_and_slabs_do_not_matter() {
    let settings = SynthSettings { size: [40, 36, 64], seed: 5, snr: Some(2.0), ..SynthSettings::default() };
    let volume = Synthetic::generate(&settings, &Progress::silent()).unwrap().seismic;
    let reference = grown(&volume, &GrowSettings::default());
    check(&reference);
    assert!(reference.triangles.len() > 10_000);
    for (threads, slab_inlines) in [(1, 1), (2, 7), (5, 100)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let settings = GrowSettings { slab_inlines, ..GrowSettings::default() };
        assert!(pool.install(|| grown(&volume, &settings)) == reference);
    }
}

#[test]
fn bad_volumes_have_defined_results() {
    let nan = Volume::filled([12, 12, 30], f32::NAN);
    let constant = Volume::filled([12, 12, 30], 3.0f32);
    let trace = layered([1, 1, 64], 8.0, |_, _| 12.0);
    let line = layered([1, 40, 64], 8.0, |_, _| 12.0);
    let thin = layered([3, 40, 64], 8.0, |_, _| 12.0);
    let flat = Volume::filled([12, 12, 1], 1.0f32);
    let empty = Volume::filled([0, 0, 0], 1.0f32);
    let mut dead = layered([12, 12, 30], 8.0, |_, _| 12.0);
    dead.set_live(Some(vec![false; 144])).unwrap();
    let mut spike = Volume::filled([12, 12, 30], 0.0f32);
    spike.trace_mut(6, 6)[15] = 3e38;
    for volume in [nan, constant, trace, line, thin, flat, empty, dead, spike] {
        assert_eq!(grown(&volume, &GrowSettings::default()).surfaces, [], "{:?}", volume.size());
    }
    let nothing = GrowSettings { extrema: vec![], ..GrowSettings::default() };
    let narrow = GrowSettings { min_front_width: 1, ..GrowSettings::default() };
    let volume = Volume::filled([4, 4, 4], 0.0f32);
    assert!(matches!(grow_surfaces(&volume, &nothing, &Progress::silent()), Err(GrowError::NoExtrema)));
    assert!(matches!(grow_surfaces(&volume, &narrow, &Progress::silent()), Err(GrowError::FrontWidth { found: 1 })));
    let published = GrowSettings { method: Method::Paper, ..GrowSettings::default() };
    assert!(matches!(grow_surfaces(&volume, &published, &Progress::silent()), Err(GrowError::Published)));
    let unlike = GrowSettings { join_share: -0.1, ..GrowSettings::default() };
    assert!(matches!(grow_surfaces(&volume, &unlike, &Progress::silent()), Err(GrowError::JoinShare { .. })));
    let cancelled = Progress::silent();
    cancelled.cancel();
    assert!(grow_surfaces(&volume, &GrowSettings::default(), &cancelled).is_err());
}

#[test]
fn dead_traces_and_eight_bits_leave_the_rest() {
    let mut volume = layered([30, 30, 64], 9.0, |x, y| 14.0 + 0.1 * (x + y) as f32);
    let least = volume.samples().iter().copied().fold(f32::MAX, f32::min);
    for value in volume.samples_mut() {
        *value = (*value / least.abs() * 12.0).round();
    }
    let live = (0..900).map(|trace| !(13..16).contains(&(trace / 30)) || !(13..16).contains(&(trace % 30))).collect();
    volume.set_live(Some(live)).unwrap();
    let surfaces = grown(&volume, &GrowSettings::default());
    check(&surfaces);
    let whole = surfaces.surfaces.iter().filter(|s| s.vertices.len() == 900 - 9).count();
    assert!(whole >= 3, "{whole}");
    assert!(surfaces.vertices.iter().all(|v| !(13..16).contains(&v.x) || !(13..16).contains(&v.y)));
}

#[test]
fn zero_crossings_are_followed_too() {
    let volume = layered([16, 16, 48], 8.0, |_, _| 10.0);
    let settings = GrowSettings { extrema: vec![Extremum::Zero], ..GrowSettings::default() };
    let surfaces = grown(&volume, &settings);
    check(&surfaces);
    assert!(surfaces.surfaces.iter().all(|s| s.extremum == Extremum::Zero && s.vertices.len() == 256));
    assert!(surfaces.vertices.iter().all(|v| (v.z - 6.0).rem_euclid(16.0).min((6.0 - v.z).rem_euclid(16.0)) < 0.01));
}

/// Layers that are regular above sample 60 and noise, of the same strength, below.
fn half_chaotic(size: [usize; 3]) -> Volume<f32> {
    let mut volume = layered(size, 8.0, |x, y| 6.0 + 0.1 * x as f32 + 0.05 * y as f32);
    let mut state = 7u32;
    let mut before = 0.0;
    for value in volume.samples_mut().chunks_mut(size[2]).flat_map(|trace| &mut trace[60..]) {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        before = 0.7 * before + (f32::from((state >> 16) as u16) / 32_768.0 - 1.0) * 900.0;
        *value = before;
    }
    volume
}

#[test]
fn surfaces_hardly_lie_over_themselves_where_reflectors_are_chaotic() {
    let surfaces = grown(&half_chaotic([64, 64, 120]), &GrowSettings::default());
    check(&surfaces);
    let mut regular = 0;
    for surface in &surfaces.surfaces {
        let vertices = &surfaces.vertices[surface.vertices.start as usize..surface.vertices.end as usize];
        let mut traces: Vec<_> = vertices.iter().map(|v| (v.x, v.y)).collect();
        traces.dedup();
        assert!(vertices.len() <= traces.len() + traces.len() / 10 + 8, "{} on {}", vertices.len(), traces.len());
        regular += usize::from(traces.len() == 64 * 64);
    }
    // Peaks and troughs every 8 samples, but for what dips into the noise.
    assert!(regular >= 5, "{regular}");
}

#[test]
fn a_strong_reflector_that_varies_is_no_fault() {
    // One reflector of twenty times the strength of the others, whose strength changes by a tenth from trace
    // to trace.
    let mut volume = layered([64, 64, 96], 8.0, |x, y| 10.0 + 0.2 * x as f32 + 0.05 * y as f32);
    let mut state = 3u32;
    for x in 0..64 {
        for y in 0..64 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let strength = 20.0 * (0.9 + 0.2 * f32::from((state >> 16) as u16) / 65_536.0);
            let middle = 10.0 + 0.2 * x as f32 + 0.05 * y as f32 + 32.0;
            for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
                if (z as f32 - middle).abs() <= 4.0 {
                    *value *= strength;
                }
            }
        }
    }
    let surfaces = grown(&volume, &GrowSettings::default());
    check(&surfaces);
    let on_it = |v: &crate::surfaces::Vertex| (v.z - (42.0 + 0.2 * f32::from(v.x) + 0.05 * f32::from(v.y))).abs() < 1.0;
    let most = surfaces
        .surfaces
        .iter()
        .map(|s| {
            surfaces.vertices[s.vertices.start as usize..s.vertices.end as usize].iter().filter(|v| on_it(v)).count()
        })
        .max();
    assert_eq!(most, Some(64 * 64));
}

/// Counts the steps of the stage of growing, and cancels at one of them.
#[derive(Default)]
struct Watcher {
    stage: std::sync::Mutex<(bool, u64, u64)>,
    cancel_at: Option<u64>,
    progress: std::sync::OnceLock<Progress>,
}

impl survey::progress::ProgressSink for Watcher {
    fn begin(&self, stage: &str, total: u64) {
        *self.stage.lock().unwrap() = (stage == "growing surfaces", total, 0);
    }

    fn advance(&self, done: u64) {
        let mut stage = self.stage.lock().unwrap();
        stage.2 = stage.2.max(done);
        if stage.0 && self.cancel_at.is_some_and(|at| done >= at) {
            self.progress.get().unwrap().cancel();
        }
    }

    fn warn(&self, _note: &survey::Note) {}
}

#[test]
fn progress_arrives_at_its_end_and_cancel_is_heard_at_any_step() {
    let settings = SynthSettings { size: [33, 29, 64], snr: Some(3.0), ..SynthSettings::default() };
    let volume = Synthetic::generate(&settings, &Progress::silent()).unwrap().seismic;
    let watched = |settings: &GrowSettings, cancel_at: Option<u64>| {
        let watcher = std::sync::Arc::new(Watcher { cancel_at, ..Watcher::default() });
        let progress = Progress::new(watcher.clone());
        watcher.progress.set(progress.clone()).ok().unwrap();
        let grown = grow_surfaces(&volume, settings, &progress);
        let (_, total, done) = *watcher.stage.lock().unwrap();
        (grown, total, done)
    };
    let ours = GrowSettings::default();
    let plain = GrowSettings { core_width: 4, fault_evidence: f32::INFINITY, join_share: 2.0, ..ours.clone() };
    let troughs = GrowSettings { extrema: vec![Extremum::Trough], ..ours };
    for settings in [&ours, &plain, &troughs] {
        let (grown, total, done) = watched(settings, None);
        assert!(grown.is_ok() && done == total && total > 300, "{done} of {total}");
    }
    let (_, total, _) = watched(&ours, None);
    for part in 0..12 {
        let at = 1 + part * (total - 1) / 12;
        let (grown, _, done) = watched(&ours, Some(at));
        assert!(matches!(grown, Err(GrowError::Cancelled(_))), "cancelled at {at} of {total}");
        // Each thread may be within a step of an inline's worth.
        assert!(done >= at && done < total, "cancelled at {at}, went on to {done}");
    }
}
