//! Planes exact, domes and holes measured, data untouched.

use super::*;

const SETTINGS: Extension = Extension { radius: 10.0, noise: 0.05, slope: [0.0, 0.0] };

fn grid(size: [usize; 2], f: impl Fn(f32, f32) -> f32, known: impl Fn(f32, f32) -> bool) -> (Vec<f32>, Vec<f32>) {
    let mut truth = Vec::new();
    let mut data = Vec::new();
    for x in 0..size[0] {
        for y in 0..size[1] {
            let (x, y) = (x as f32, y as f32);
            truth.push(f(x, y));
            data.push(if known(x, y) { f(x, y) } else { f32::NAN });
        }
    }
    (truth, data)
}

fn noise(seed: u32, n: usize) -> Vec<f32> {
    let mut state = seed;
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1u32 << 24) as f32 * 2.0 - 1.0
        })
        .collect()
}

/// Largest difference over the nodes that `ask` asks for.
fn worst(size: [usize; 2], a: &[f32], b: &[f32], ask: impl Fn(f32, f32) -> bool) -> f32 {
    (0..a.len())
        .filter(|&n| ask((n / size[1]) as f32, (n % size[1]) as f32))
        .map(|n| (a[n] - b[n]).abs())
        .fold(0.0, f32::max)
}

#[test]
fn a_plane_stays_a_plane_in_a_hole_and_beyond_its_rim() {
    let size = [150, 130];
    let hole = |x: f32, y: f32| (x - 70.0).hypot(y - 60.0) < 15.0;
    let inside = |x: f32, y: f32| x > 30.0 && x < 110.0 && y > 20.0 + 0.3 * x && y < 100.0 && !hole(x, y);
    let (truth, mut data) = grid(size, |x, y| 40.0 + 0.7 * x - 0.31 * y, inside);
    SETTINGS.extend(size, &mut data).unwrap();
    let error = worst(size, &truth, &data, |_, _| true);
    assert!(error < 1e-3, "{error}");
}

#[test]
fn data_is_left_as_it_is_and_no_data_is_said() {
    let size = [40, 40];
    let (_, mut data) = grid(size, |x, y| (x * 12.9 + y * 7.3).sin(), |x, y| (x as i32 + 2 * y as i32) % 5 == 0);
    let before = data.clone();
    SETTINGS.extend(size, &mut data).unwrap();
    assert!(data.iter().all(|z| z.is_finite()));
    assert!(before.iter().zip(&data).all(|(b, d)| b.is_nan() || b == d));
    assert!(SETTINGS.extend([3, 3], &mut [f32::NAN; 9]).is_none());
}

#[test]
fn few_nodes_give_the_flattest_plane_that_fits() {
    let size = [60, 60];
    let (_, mut one) = grid(size, |_, _| 7.0, |x, y| x == 20.0 && y == 30.0);
    SETTINGS.extend(size, &mut one).unwrap();
    assert!(one.iter().all(|z| (z - 7.0).abs() < 1e-3));
    // A line of nodes knows its own slope; across it the given one holds.
    let (truth, mut line) = grid(size, |x, y| 5.0 + 0.5 * x + 0.2 * y, |x, y| y == 30.0 && x > 10.0 && x < 50.0);
    Extension { slope: [0.0, 0.2], ..SETTINGS }.extend(size, &mut line).unwrap();
    assert!(worst(size, &truth, &line, |_, _| true) < 0.02, "{}", worst(size, &truth, &line, |_, _| true));
}

/// A dome of 35° dip at the rim of the data, x = 100.
fn dome(x: f32, y: f32) -> f32 {
    let r_sq = ((x - 60.0).powi(2) + (y - 80.0).powi(2)) / (2.0 * 45.0f32.powi(2));
    100.0 - 52.0 * (-r_sq).exp()
}

#[test]
fn a_noisy_dome_is_continued_with_the_slope_it_has() {
    let size = [160, 160];
    for (level, limits) in [(0.0, [0.6, 1.7]), (0.2, [0.8, 2.1])] {
        let (mut truth, mut data) = grid(size, dome, |x, _| x <= 100.0);
        // Linear from the rim on.
        for x in 101..160 {
            for y in 0..160 {
                let slope = (dome(100.5, y as f32) - dome(99.5, y as f32)) * (x as f32 - 100.0);
                truth[x * 160 + y] = dome(100.0, y as f32) + slope;
            }
        }
        for (z, n) in data.iter_mut().zip(noise(7, 160 * 160)) {
            *z += level * n;
        }
        SETTINGS.extend(size, &mut data).unwrap();
        let at = |dx: f32| worst(size, &truth, &data, |x, y| x == 100.0 + dx && (20.0..140.0).contains(&y));
        println!("noise {level}: error at 1, 5, 10, 20 nodes: {} {} {} {}", at(1.0), at(5.0), at(10.0), at(20.0));
        assert!(at(10.0) < limits[0] && at(20.0) < limits[1]);
        // No kink beyond the noise itself: second differences across the rim.
        if level == 0.0 {
            let kink = (20..140)
                .map(|y| (data[99 * 160 + y] - 2.0 * data[100 * 160 + y] + data[101 * 160 + y]).abs())
                .fold(0.0, f32::max);
            println!("kink {kink}");
            assert!(kink < 0.05, "{kink}");
        }
    }
}

#[test]
fn a_hole_in_a_dome_is_filled_with_its_top() {
    let size = [160, 160];
    let in_hole = |x: f32, y: f32| (x - 60.0).hypot(y - 80.0) < 12.0;
    let (truth, mut data) = grid(size, dome, |x, y| !in_hole(x, y));
    SETTINGS.extend(size, &mut data).unwrap();
    let error = worst(size, &truth, &data, |_, _| true);
    println!("hole {error}");
    assert!(error < 0.25, "{error}");
}

#[test]
fn outliers_at_the_rim_do_not_tilt_the_continuation() {
    let size = [80, 80];
    let (truth, mut data) = grid(size, |x, _| 0.2 * x, |x, _| x < 50.0);
    for y in [20, 41, 60] {
        data[49 * 80 + y] += 15.0;
    }
    SETTINGS.extend(size, &mut data).unwrap();
    let error = worst(size, &truth, &data, |x, _| x > 60.0);
    assert!(error < 0.2, "{error}");
}
