//! Roots of functions of one variable that change their sign once.

/// The place in `[low, high]` where `f` changes its sign, to `tolerance`. Bisection that takes the place of the secant
/// where this is nearer (Illinois); where the ends have one sign, the end at which `f` is nearer to zero.
pub(crate) fn root(low: f64, high: f64, tolerance: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut a, mut b) = (low, high);
    let (mut fa, mut fb) = (f(a), f(b));
    if fa == 0.0 || fb == 0.0 || (fa > 0.0) == (fb > 0.0) {
        return if fa.abs() <= fb.abs() { a } else { b };
    }
    for step in 0..200 {
        if (b - a).abs() <= tolerance {
            break;
        }
        // Every third step halves the interval, so that a flat function cannot hold it up.
        let secant = (a * fb - b * fa) / (fb - fa);
        let middle = if step % 3 == 2 || !secant.is_finite() { 0.5 * (a + b) } else { secant };
        let value = f(middle);
        if value == 0.0 {
            return middle;
        }
        if (value > 0.0) == (fb > 0.0) {
            (b, fb) = (middle, value);
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
            (b, fb) = (middle, value);
        }
    }
    if fa.abs() < fb.abs() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_in_steep_and_in_flat_functions() {
        let tolerance = 1e-12;
        assert!((root(0.0, 2.0, tolerance, |x| x * x - 2.0) - 2f64.sqrt()).abs() < 1e-10);
        assert!((root(-1.0, 3.0, tolerance, |x| (x - 0.25).powi(7)) - 0.25).abs() < 1e-6);
        assert!((root(-1e4, 1e4, tolerance, |x| x.signum() * x.abs().powf(0.1) + 1.0) + 1.0).abs() < 1e-8);
        // No change of sign: the nearer end.
        assert_eq!(root(1.0, 2.0, tolerance, |x| x), 1.0);
    }
}
