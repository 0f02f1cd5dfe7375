//! Refined extrema on closed forms, in slabs, beside dead traces and on plateaus.

use super::*;
use std::f64::consts::TAU;
use survey::Volume;

fn found(trace: &[f32], kind: Extremum) -> Vec<(f32, f32)> {
    let mut all = Vec::new();
    extrema_of_trace(trace, kind, &mut |z, amplitude| all.push((z, amplitude)));
    all
}

fn sampled(count: usize, f: impl Fn(f64) -> f64) -> Vec<f32> {
    (0..count).map(|z| f(z as f64) as f32).collect()
}

/// Largest error over phases of the extrema of a sinusoid.
fn sinusoid_error(period: f64, kind: Extremum, place: f64) -> f64 {
    let mut worst = 0.0f64;
    for phase in 0..64 {
        let shift = period * f64::from(phase) / 64.0;
        let trace = sampled(64, |z| (TAU * (z - shift) / period).cos());
        for (z, _) in found(&trace, kind).into_iter().filter(|(z, _)| (4.0..58.0).contains(z)) {
            let cycles = (f64::from(z) - shift) / period - place;
            worst = worst.max((cycles - cycles.round()).abs() * period);
        }
    }
    worst
}

#[test]
fn a_sinusoid_is_refined_to_the_stated_error() {
    for (kind, place) in [(Extremum::Peak, 0.0), (Extremum::Trough, 0.5)] {
        assert!(sinusoid_error(8.0, kind, place) < 0.0016, "{}", sinusoid_error(8.0, kind, place));
        assert!(sinusoid_error(5.0, kind, place) < 0.0095, "{}", sinusoid_error(5.0, kind, place));
        assert!(sinusoid_error(16.0, kind, place) < 2e-4);
    }
    assert!(sinusoid_error(8.0, Extremum::Zero, 0.75) < 0.004, "{}", sinusoid_error(8.0, Extremum::Zero, 0.75));
}

#[test]
fn a_ricker_wavelet_is_found_where_it_is() {
    for step in 0..20 {
        let centre = 30.0 + f64::from(step) / 20.0;
        let trace = sampled(64, |z| {
            let square = (std::f64::consts::PI * (z - centre) / 8.0).powi(2);
            700.0 * (1.0 - 2.0 * square) * (-square).exp()
        });
        let peaks = found(&trace, Extremum::Peak);
        let (z, amplitude) = peaks.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((f64::from(z) - centre).abs() < 0.0105, "{z} for {centre}");
        assert!((amplitude - 700.0).abs() < 8.0, "{amplitude}");
    }
}

#[test]
fn a_plateau_counts_once_in_its_middle() {
    assert_eq!(found(&[0.0, 1.0, 3.0, 3.0, 3.0, 1.0, 0.0], Extremum::Peak), [(3.0, 3.0)]);
    assert_eq!(found(&[1.0, 3.0, 3.0, 3.0, 2.0], Extremum::Peak), [(2.0, 3.0)]);
    let two = found(&[0.0, 3.0, 3.0, 1.0], Extremum::Peak)[0];
    assert!(two.0 == 1.5 && two.1 > 3.0 && two.1 < 3.5);
    assert_eq!(found(&[0.0, 3.0, 3.0, 4.0, 1.0], Extremum::Peak).len(), 1);
    assert!(found(&[0.0, 3.0, 3.0], Extremum::Peak).is_empty());
    assert_eq!(found(&[1.0, -2.0, -2.0, 0.0], Extremum::Trough)[0].0, 1.5);
    assert_eq!(found(&[-1.0, 0.0, 0.0, 2.0], Extremum::Zero)[0].0, 1.5);
}

#[test]
fn a_clipped_maximum_lies_between_its_flanks() {
    for tenths in 0..10 {
        let centre = 12.0 + 0.1 * tenths as f32;
        let trace: Vec<f32> = (0..25)
            .map(|z| (900.0 * (std::f32::consts::TAU * (z as f32 - centre) / 12.0).cos()).clamp(-450.0, 450.0))
            .collect();
        let &(z, amplitude) = found(&trace, Extremum::Peak)
            .iter()
            .min_by(|a, b| (a.0 - centre).abs().total_cmp(&(b.0 - centre).abs()))
            .unwrap();
        assert!((z - centre).abs() < 0.06 && amplitude == 450.0, "{z} for {centre}");
    }
}

#[test]
fn signs_matter() {
    assert!(found(&[-3.0, -1.0, -3.0], Extremum::Peak).is_empty());
    assert!(found(&[3.0, 1.0, 3.0], Extremum::Trough).is_empty());
    assert!(found(&[3.0, 1.0, -1.0, -3.0], Extremum::Zero).is_empty());
}

#[test]
fn what_is_not_finite_has_no_extrema() {
    let nan = f32::NAN;
    assert!(found(&[nan; 9], Extremum::Peak).is_empty());
    assert!(found(&[0.0, nan, 2.0, 1.0], Extremum::Peak).is_empty());
    assert!(found(&[0.0, f32::INFINITY, 0.0], Extremum::Peak).is_empty());
    assert!(found(&[-1.0, nan, 1.0], Extremum::Zero).is_empty());
    let (z, height) = found(&[nan, 1.0, 2.0, 1.0, nan], Extremum::Peak)[0];
    assert_eq!((z, height), (2.0, 2.0));
    for kind in [Extremum::Peak, Extremum::Trough, Extremum::Zero] {
        for length in 0..3 {
            assert!(found(&vec![0.0; length], kind).is_empty());
        }
    }
}

#[test]
fn huge_amplitudes_do_not_overflow() {
    let (z, height) = found(&[-3e38, 3e38, 2e38, -3e38, 0.0], Extremum::Peak)[0];
    assert!((0.25..1.75).contains(&z) && height.is_finite());
}

#[test]
fn slabs_and_dead_traces() {
    let size = [7, 5, 40];
    let samples = (0..7 * 5 * 40).map(|i| ((i * i % 97) as f32 - 48.0) * 0.1).collect();
    let mut volume = Volume::from_samples(size, samples).unwrap();
    let kinds = [Extremum::Peak, Extremum::Trough];
    let whole = find_extrema(&volume, &kinds, 7, &Progress::silent()).unwrap();
    for slab in [0, 1, 2, 3, 100] {
        assert_eq!(find_extrema(&volume, &kinds, slab, &Progress::silent()).unwrap(), whole);
    }
    assert!(whole[0].len() > 100);
    let mut live = vec![true; 35];
    live[2 * 5 + 3] = false;
    volume.set_live(Some(live)).unwrap();
    let masked = find_extrema(&volume, &kinds, 2, &Progress::silent()).unwrap();
    assert!(masked[0].on_trace(2, 3).is_empty());
    assert_eq!(masked[0].on_trace(2, 4).len(), whole[0].on_trace(2, 4).len());
}
