//! Weights keep both surfaces, and the slope that comes with k is its derivative.

use super::*;

#[test]
fn a_weight_keeps_both_ends_and_its_slope_is_the_derivative() {
    let ratio = |x: f32| (x, Vec3::X);
    let weight = |x: f32| (0.8 * (2.0 * x).sin(), Vec3::X * (1.6 * (2.0 * x).cos()));
    for (r, k) in [(0.0, 0.0), (1.0, 1.0)] {
        assert_eq!(weighed(ratio(r), weight(r)).0, k);
    }
    for n in 0..=20 {
        let x = 0.05 * n as f32;
        let (k, slope) = weighed(ratio(x), weight(x));
        assert!((0.0..=1.0).contains(&k), "{k}");
        let step = 1e-3;
        if x > step && x < 1.0 - step {
            let rise = weighed(ratio(x + step), weight(x + step)).0 - weighed(ratio(x - step), weight(x - step)).0;
            assert!((rise / (2.0 * step) - slope.x).abs() < 2e-3, "{x}: {rise} {slope}");
        }
    }
    // Beyond the surfaces k goes on with its slope.
    for end in [0.0, 1.0] {
        let at = |r: f32| weighed((r, Vec3::X), (0.7, Vec3::ZERO));
        let inside = (at(end).0 - at(end + 1e-3 * (0.5 - end).signum()).0).abs() / 1e-3;
        let outside = (at(end).0 - at(end - 1e-2 * (0.5 - end).signum()).0).abs() / 1e-2;
        assert!((inside - outside).abs() < 0.01 && (outside - at(end).1.x).abs() < 1e-3, "{inside} {outside}");
    }
    // No weight: the ratio itself.
    let (k, slope) = weighed((0.3, Vec3::Y), (0.0, Vec3::ZERO));
    assert!((k - 0.3).abs() < 1e-6 && slope.distance(Vec3::Y) < 1e-6, "{k} {slope}");
}
