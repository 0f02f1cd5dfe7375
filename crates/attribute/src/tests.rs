//! Attributes of volumes whose answer is known.

use super::*;
use std::f32::consts::TAU;
use survey::progress::Progress;
use survey::volume::Volume;
use survey::{SurveyGeometry, VerticalUnit};

fn volume_of(size: [usize; 3], value: impl Fn(f32, f32, f32) -> f32) -> Volume<f32> {
    let [nx, ny, nz] = size;
    let mut samples = Vec::with_capacity(nx * ny * nz);
    for x in 0..nx {
        for y in 0..ny {
            samples.extend((0..nz).map(|z| value(x as f32, y as f32, z as f32)));
        }
    }
    Volume::from_samples(size, samples).unwrap()
}

fn dips_of(volume: &Volume<f32>) -> DipVolumes {
    dip(volume, &DipSettings::default(), &Progress::silent()).unwrap()
}

fn semblance_of(volume: &Volume<f32>) -> Volume<f32> {
    semblance(volume, &dips_of(volume), &SemblanceSettings::default(), &Progress::silent()).unwrap()
}

/// Largest |value − expected| away from the outer boundary by `x`, `y` and `z`.
fn worst(volume: &Volume<f32>, expected: f32, margin: [usize; 3]) -> f32 {
    let [nx, ny, nz] = volume.size();
    let mut worst = 0.0f32;
    for x in margin[0]..nx - margin[0] {
        for y in margin[1]..ny - margin[1] {
            for value in &volume.trace(x, y)[margin[2]..nz - margin[2]] {
                let error = (value - expected).abs();
                worst = if error.is_nan() { f32::INFINITY } else { worst.max(error) };
            }
        }
    }
    worst
}

fn ricker(t: f32, period: f32) -> f32 {
    let a = (std::f32::consts::PI * t / period).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

#[test]
fn the_dip_of_plane_waves_is_found_below_the_sample() {
    for wavelength in [9.0f32, 12.0, 20.0, 33.0] {
        for (p, q) in [(0.0f32, 0.0f32), (0.5, -0.25), (1.3, 2.7), (-3.1, 0.4), (3.9, -3.9), (4.0, 4.0)] {
            let wave = volume_of([7, 7, 96], |x, y, z| (TAU * (z - p * x - q * y) / wavelength + 0.4).cos());
            let dips = dips_of(&wave);
            for (found, expected) in [(&dips.inline, p), (&dips.crossline, q)] {
                let error = worst(found, expected, [1, 1, 12]);
                assert!(error < 0.02, "wavelength {wavelength}, dip {p} {q}: {error} off {expected}");
                let error = worst(found, expected, [0, 0, 12]);
                assert!(
                    error < 0.25,
                    "at the outer boundary: wavelength {wavelength}, dip {p} {q}: {error} off {expected}"
                );
            }
        }
    }
}

#[test]
fn the_dip_of_a_train_of_wavelets_is_found_though_it_is_no_sinusoid() {
    for (p, q) in [(0.3f32, 1.6f32), (-2.4, 3.3)] {
        let wave = volume_of([5, 5, 128], |x, y, z| {
            let t = z - p * (x - 2.0) - q * (y - 2.0);
            [(21.0f32, 1.0f32), (40.0, -0.6), (63.0, 0.8), (80.0, 1.0), (101.0, -0.9)]
                .iter()
                .map(|(at, strength)| strength * ricker(t - at, 12.0))
                .sum()
        });
        let dips = dips_of(&wave);
        assert!(worst(&dips.inline, p, [1, 1, 24]) < 0.05, "{}", worst(&dips.inline, p, [1, 1, 24]));
        assert!(worst(&dips.crossline, q, [1, 1, 24]) < 0.05, "{}", worst(&dips.crossline, q, [1, 1, 24]));
    }
}

#[test]
fn semblance_is_one_on_plane_waves_and_low_on_a_fault() {
    let wave = volume_of([9, 9, 80], |x, y, z| (TAU * (z - 1.7 * x + 0.6 * y) / 14.0).sin());
    let flat = semblance_of(&wave);
    assert!(worst(&flat, 1.0, [1, 1, 10]) < 2e-3, "{}", worst(&flat, 1.0, [1, 1, 10]));

    let throw = |x: f32| if x < 5.0 { 0.0 } else { 7.0 };
    let faulted = volume_of([12, 9, 120], |x, _, z| {
        let t = z - throw(x);
        (0..12).map(|n| ((n * 29 % 7) as f32 - 3.0) * ricker(t - 10.0 * n as f32, 9.0)).sum()
    });
    let found = semblance_of(&faulted);
    let mean = |x: usize| found.trace(x, 4)[20..100].iter().sum::<f32>() / 80.0;
    assert!(mean(1) > 0.99 && mean(10) > 0.99, "{} {}", mean(1), mean(10));
    assert!(mean(4) < 0.85 && mean(5) < 0.85, "{} {}", mean(4), mean(5));
}

#[test]
fn noise_without_neighbours_in_common_has_low_semblance() {
    let noise = volume_of([8, 8, 100], |x, y, z| {
        let n = (x * 7919.0 + y * 104_729.0 + z * 1_299.7).sin() * 43_758.547;
        n - n.floor() - 0.5
    });
    let found = semblance_of(&noise);
    let mean = found.samples().iter().sum::<f32>() / found.samples().len() as f32;
    assert!(mean < 0.6, "{mean}");
}

#[test]
fn the_envelope_of_a_modulated_sinusoid_is_its_modulation() {
    let strength = |z: f32| 2.0 + (TAU * z / 160.0).sin();
    let wave = volume_of([1, 2, 401], |_, y, z| strength(z) * (TAU * z / 10.0 + y).cos());
    let found = envelope(&wave, &Progress::silent()).unwrap();
    for y in 0..2 {
        for z in 30..371 {
            let error = (found.at(0, y, z) / strength(z as f32) - 1.0).abs();
            assert!(error < 0.02, "{error} at {z}");
        }
    }
}

#[test]
fn a_constant_has_no_dip_full_semblance_and_its_own_size_as_envelope() {
    for value in [0.0f32, -3.0] {
        let flat = Volume::filled([4, 5, 30], value);
        let dips = dips_of(&flat);
        assert_eq!(worst(&dips.inline, 0.0, [0; 3]), 0.0);
        assert_eq!(worst(&dips.crossline, 0.0, [0; 3]), 0.0);
        assert!(worst(&semblance_of(&flat), 1.0, [0; 3]) < 1e-6);
        let found = envelope(&flat, &Progress::silent()).unwrap();
        assert!(worst(&found, value.abs(), [0; 3]) < 1e-5);
    }
}

#[test]
fn one_trace_and_traces_thinner_than_the_window_have_answers() {
    for size in [[1, 1, 50], [1, 6, 50], [6, 1, 3], [3, 3, 1], [2, 2, 2]] {
        let wave = volume_of(size, |x, _, z| (z * 0.7 - x).sin());
        let dips = dips_of(&wave);
        assert!(dips.inline.samples().iter().chain(dips.crossline.samples()).all(|dip| dip.abs() <= 5.0));
        let found = semblance_of(&wave);
        assert!(found.samples().iter().all(|s| (0.0..=1.0).contains(s)), "{size:?}");
        if size[..2] == [1, 1] {
            assert!(worst(&found, 1.0, [0; 3]) < 1e-6);
        }
        assert!(envelope(&wave, &Progress::silent()).unwrap().samples().iter().all(|e| e.is_finite()));
    }
    let empty = Volume::from_samples([0, 3, 4], Vec::new()).unwrap();
    assert!(dips_of(&empty).inline.samples().is_empty());
}

#[test]
fn dead_traces_contribute_nothing_and_nan_stays_where_it_is() {
    let size = [7, 7, 60];
    let mut wave = volume_of(size, |x, y, z| (TAU * (z - 0.8 * x + 1.2 * y) / 13.0).cos());
    let mut live = vec![true; 49];
    live[3 * 7 + 3] = false;
    wave.trace_mut(3, 3).fill(1e6);
    wave.set_live(Some(live)).unwrap();
    wave.trace_mut(1, 5)[30] = f32::NAN;
    let dips = dips_of(&wave);
    let found = semblance_of(&wave);
    assert_eq!(found.live(), wave.live());
    for x in 0..7 {
        for y in 0..7 {
            for z in 14..46 {
                let here = [dips.inline.at(x, y, z), dips.crossline.at(x, y, z), found.at(x, y, z)];
                match (x, y, z) {
                    (3, 3, _) => assert_eq!(here, [0.0; 3]),
                    (1, 5, 30) => assert!(here.iter().all(|value| value.is_nan())),
                    _ => {
                        assert!((here[0] - 0.8).abs() < 0.2 && (here[1] + 1.2).abs() < 0.2, "{x} {y} {z}: {here:?}");
                        assert!(here[2] > 0.97, "{x} {y} {z}: {here:?}");
                    }
                }
            }
        }
    }
}

/// A block without data is like the end of the traces: what is beside it does not see a reflection of zeros.
#[test]
fn beside_no_data_attributes_are_what_they_are_beside_an_end() {
    let size = [12, 12, 160];
    let whole =
        volume_of(size, |x, y, z| (TAU * (z - 0.8 * x + 0.5 * y) / 13.0).cos() * (1.0 + 0.3 * (z / 20.0).sin()));
    let mut holed = whole.clone();
    for (x, y) in (0..12).flat_map(|x| (0..12).map(move |y| (x, y))) {
        holed.trace_mut(x, y)[60..100].fill(f32::NAN);
    }
    let silent = Progress::silent();
    let (strong, tilted) = (envelope(&holed, &silent).unwrap(), slopes(&holed, &silent).unwrap());
    let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Metres);
    let faults = fault_likelihood(&holed, &geometry, &silent).unwrap();
    // The same without what is below.
    let above = volume_of([12, 12, 60], |x, y, z| whole.at(x as usize, y as usize, z as usize));
    let alone = envelope(&above, &silent).unwrap();
    for (x, y, z) in [(3, 3), (6, 5), (8, 8)].into_iter().flat_map(|(x, y)| (0..160).map(move |z| (x, y, z))) {
        let is_missing = (60..100).contains(&z);
        assert_eq!(strong.at(x, y, z).is_nan(), is_missing);
        assert_eq!(faults.at(x, y, z).is_nan(), is_missing);
        if is_missing {
            continue;
        }
        if z < 60 {
            let error = (strong.at(x, y, z) - alone.at(x, y, z)).abs();
            assert!(error < 0.05, "envelope off by {error} at {z}");
        }
        let error = [tilted.inline.at(x, y, z) - 0.8, tilted.crossline.at(x, y, z) + 0.5].map(f32::abs);
        assert!(error.iter().all(|error| *error < 0.1), "slopes off by {error:?} at {z}");
        assert!(faults.at(x, y, z) < 0.2, "a fault at {z}: {}", faults.at(x, y, z));
    }
}

#[test]
fn settings_out_of_range_and_dips_of_another_volume_are_refused() {
    let flat = Volume::filled([3, 3, 8], 1.0f32);
    let settings = DipSettings { max_dip: 0, ..DipSettings::default() };
    assert!(matches!(dip(&flat, &settings, &Progress::silent()), Err(AttributeError::Setting { found: 0, .. })));
    let other = dips_of(&Volume::filled([3, 3, 9], 1.0f32));
    let refused = semblance(&flat, &other, &SemblanceSettings::default(), &Progress::silent());
    assert!(matches!(refused, Err(AttributeError::Lattice { .. })));
}

#[test]
fn cancelling_stops_every_attribute() {
    let flat = Volume::filled([3, 3, 8], 1.0f32);
    let dips = dips_of(&flat);
    let progress = Progress::silent();
    progress.cancel();
    let semblance = semblance(&flat, &dips, &SemblanceSettings::default(), &progress);
    assert!(matches!(semblance, Err(AttributeError::Cancelled(_))));
    assert!(matches!(dip(&flat, &DipSettings::default(), &progress), Err(AttributeError::Cancelled(_))));
    assert!(matches!(envelope(&flat, &progress), Err(AttributeError::Cancelled(_))));
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let noise = volume_of([9, 8, 40], |x, y, z| (x * 12.9 + y * 78.2 + z * 3.7).sin() + (z * 0.6 - x).cos());
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (dips_of(&noise), semblance_of(&noise), envelope(&noise, &Progress::silent()).unwrap()))
    };
    assert_eq!(on(1), on(3));
}
