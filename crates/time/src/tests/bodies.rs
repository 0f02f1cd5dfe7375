//! Isolated bodies of volumes whose flat spots and build-ups are closed forms, and of volumes without any.

use super::{beds, volume};
use crate::{Body, Cut, Reflections};
use interp::{GrowSettings, grow_surfaces};
use survey::{Progress, Volume};

const SIZE: [usize; 3] = [64, 60, 80];

fn bodies_of(volume: &Volume<f32>) -> Vec<Body> {
    let surfaces = grow_surfaces(volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    Reflections::new(&surfaces, &[] as &[Cut]).bodies(volume)
}

/// Height of an anticline over its flanks, samples.
fn dome(x: f32, y: f32) -> f32 {
    24.0 * (-((x - 30.0).powi(2) + (y - 31.0).powi(2)) / 512.0).exp()
}

/// Noise of a seed, from −1 to 1.
fn noise(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*state >> 8) as f32 / (1 << 23) as f32 - 1.0
}

/// Adds a reflection of a height at a depth.
fn reflect(trace: &mut [f32], at: f32, height: f32) {
    for (z, sample) in trace.iter_mut().enumerate() {
        let square = (std::f32::consts::PI * (z as f32 - at) / 9.0).powi(2);
        *sample += height * (1.0 - 2.0 * square) * (-square).exp();
    }
}

/// Changes every trace of a volume.
fn each(volume: &mut Volume<f32>, mut change: impl FnMut(f32, f32, &mut [f32])) {
    for (x, y) in (0..SIZE[0]).flat_map(|x| (0..SIZE[1]).map(move |y| (x, y))) {
        change(x as f32, y as f32, volume.trace_mut(x, y));
    }
}

/// Noise that takes nothing from the beds' order.
fn noisy(volume: &mut Volume<f32>) {
    let mut state = 5;
    each(volume, |_, _, trace| trace.iter_mut().for_each(|sample| *sample += 0.25 * noise(&mut state)));
}

/// The share of the traces of a body that should be there that one has, within two samples of its top and of its base, and
/// how many traces it has beyond by three traces or more.
fn fit(body: &Body, truth: impl Fn(f32, f32) -> [f32; 2]) -> (f64, usize) {
    let thick = |x: f32, y: f32| truth(x, y)[1] - truth(x, y)[0];
    let mut right = 0;
    for column in &body.columns {
        let [x, y] = column.trace.map(|at| at as f32);
        let [top, base] = truth(x, y);
        right += usize::from(base > top && (column.top - top).abs() <= 2.0 && (column.base - base).abs() <= 2.0);
    }
    let all = (0..SIZE[0] * SIZE[1]).filter(|n| thick((n / SIZE[1]) as f32, (n % SIZE[1]) as f32) > 0.0).count();
    let is_beyond = |[x, y]: [f32; 2]| (-3..=3).all(|dx| (-3..=3).all(|dy| thick(x + dx as f32, y + dy as f32) <= 0.0));
    let beyond = body.columns.iter().filter(|column| is_beyond(column.trace.map(|at| at as f32))).count();
    (f64::from(right as u32) / all as f64, beyond)
}

#[test]
fn a_flat_spot_is_a_body_up_to_the_bed_that_it_meets_and_the_same_anticline_without_it_has_none() {
    let strat = |x: f32, y: f32, z: f32| z + dome(x, y);
    let mut beds = volume(SIZE, strat);
    noisy(&mut beds);
    assert_eq!(bodies_of(&beds), []);
    // Gas in the bed with its top at 60, down to a level of 12 samples below its crest.
    let truth = |x: f32, y: f32| [60.0 - dome(x, y), 48.0];
    each(&mut beds, |x, y, trace| {
        let [top, contact] = truth(x, y);
        if top < contact {
            reflect(trace, top, -6.0);
            reflect(trace, contact, 6.0);
        }
    });
    let found = bodies_of(&beds);
    assert_eq!(found.len(), 1);
    let (right, beyond) = fit(&found[0], truth);
    assert!(right > 0.8 && beyond == 0, "{right} {beyond}");
    // Without the body's samples nothing of it is left.
    found[0].blank(&mut beds, 3.0);
    let left = beds.trace(30, 31)[36..49].iter().filter(|sample| sample.is_finite()).count();
    assert_eq!(left, 0);
    assert_eq!(bodies_of(&beds), []);
}

#[test]
fn a_build_up_is_a_body_down_to_its_base() {
    // A mound of 18 samples on a platform that dips; beds lap on to its flanks.
    let base = |x: f32, y: f32| 56.0 + 0.05 * x - 0.03 * y;
    let height = |x: f32, y: f32| 18.0 * (1.0 - ((x - 32.0).powi(2) + (y - 29.0).powi(2)) / 324.0).max(0.0);
    let truth = |x: f32, y: f32| [base(x, y) - height(x, y), base(x, y)];
    let mut all = Volume::filled(SIZE, 0.0f32);
    each(&mut all, |x, y, trace| {
        let [top, base] = truth(x, y);
        // A bed below it that is stronger than its base, and as far from it at the rim as in the midst.
        reflect(trace, base + 13.0, 4.0);
        for (z, sample) in trace.iter_mut().enumerate() {
            let z = z as f32;
            *sample += if z > top && z < base { 0.0 } else { 0.5 * beds(z - base) };
        }
        let is_mound = base - top > 1.0;
        reflect(trace, base, if is_mound { -2.5 } else { 3.0 });
        if is_mound {
            reflect(trace, top, 5.0);
        }
    });
    noisy(&mut all);
    let found = bodies_of(&all);
    assert_eq!(found.len(), 1);
    let (right, beyond) = fit(&found[0], truth);
    assert!(right > 0.7 && beyond == 0, "{right} {beyond}");
}

#[test]
fn a_bright_bed_a_wedge_and_noise_are_no_bodies() {
    let mut state = 11;
    let mut chaos = Volume::filled(SIZE, 0.0f32);
    each(&mut chaos, |_, _, trace| {
        let mut value = 0.0;
        for sample in trace {
            value = 0.6 * value + noise(&mut state);
            *sample = value;
        }
    });
    assert_eq!(bodies_of(&chaos), []);
    // A bright patch of a bed, parallel to its neighbours; and a wedge that thins to one side and ends at a straight edge.
    let mut beds = volume(SIZE, |x, y, z| z + 0.1 * x + 0.5 * dome(x, y));
    noisy(&mut beds);
    each(&mut beds, |x, y, trace| {
        let level = |strat: f32| strat - 0.1 * x - 0.5 * dome(x, y);
        if (x - 40.0).powi(2) + (y - 20.0).powi(2) < 200.0 {
            reflect(trace, level(30.0), 6.0);
        }
        if x > 12.0 && x < 44.0 && y > 10.0 && y < 50.0 {
            reflect(trace, level(60.0), 5.0);
            reflect(trace, level(60.0) + 4.0 + 0.5 * (x - 12.0), -5.0);
        }
    });
    assert_eq!(bodies_of(&beds), []);
}

#[test]
fn a_trough_of_beds_below_an_erosion_surface_is_no_body() {
    // Beds sag by up to 24 samples below a level at 40; one of them is strong and ends there on all sides, as a lens does.
    let strat = |x: f32, y: f32, z: f32| if z < 40.0 { z - 90.0 } else { z - dome(x, y) };
    let mut all = volume(SIZE, strat);
    noisy(&mut all);
    each(&mut all, |x, y, trace| {
        reflect(trace, 40.0, 4.0);
        let bed = 28.0 + dome(x, y);
        if bed > 40.0 {
            reflect(trace, bed, -5.0);
        }
    });
    assert_eq!(bodies_of(&all), []);
}
