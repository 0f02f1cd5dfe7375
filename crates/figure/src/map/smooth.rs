//! The surface that contours are drawn of: what was picked, lightly smoothed.
//!
//! Picks jitter by parts of a sample from trace to trace, and a contour of gentle ground magnifies that by
//! the ground's slope: it frays. So contours are those of a smoothed surface: passes of (1, 2, 1)/4 along
//! inlines and crosslines in turn, n of which are a Gaussian of variance n/2 traces². A trace is averaged
//! along a line only where both of its neighbours on that line have a value and no fault lies between.
//! Nothing is thereby carried across a fault or a hole, rims stay where they were picked across themselves,
//! and a plane stays that plane up to its rim (plain masked averages would bend it there).
//!
//! No trace is moved by more than [`MOST`] of the contour interval: what is farther off is structure, not
//! jitter, and a step that was tracked without a fault stays one. Colours and the range are those of the
//! picks.

use super::grid::{Grid, MapNode};

/// Most that a trace may be moved by, contour intervals.
const MOST: f64 = 0.5;
/// Standard deviation of the Gaussian: this share of a map's longer side, about two millimetres of a
/// printed page, but no less and no more traces than so many.
const SHARE: f64 = 1.0 / 80.0;
const SIGMA: [f64; 2] = [2.0, 6.0];

/// A grid smoothed for contours at an interval.
pub(super) fn smoothed(grid: &Grid, interval: f64) -> Grid {
    let [nx, ny] = grid.size;
    let sigma = (SHARE * nx.max(ny) as f64).clamp(SIGMA[0], SIGMA[1]);
    let passes = (2.0 * sigma * sigma).round() as usize;
    let picked: Vec<f64> = grid.nodes().iter().map(|node| node.value).collect();
    // Traces that both neighbours along a line belong to, for inlines and crosslines.
    let lines = [(0, nx, ny), (1, ny, 1)].map(|(way, count, step)| {
        let is_inner = |n: usize| (1..count.saturating_sub(1)).contains(&(n / step % count));
        let averaged = |&n: &usize| is_inner(n) && grid.is_joined(n - step, way) && grid.is_joined(n, way);
        ((0..nx * ny).filter(averaged).collect::<Vec<usize>>(), step)
    });
    let mut values = picked.clone();
    let mut before = picked.clone();
    for _ in 0..passes {
        for (averaged, step) in &lines {
            before.copy_from_slice(&values);
            for &n in averaged {
                values[n] = 0.5 * before[n] + 0.25 * (before[n - step] + before[n + step]);
            }
        }
    }
    let most = MOST * interval;
    Grid::by([nx, ny], |x, y| {
        let n = x * ny + y;
        MapNode { value: picked[n] + (values[n] - picked[n]).clamp(-most, most), ..grid.at(x, y) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [40, 30];

    /// In two blocks, with a hole in the first.
    fn holed(value: impl Fn(f64, f64) -> f64 + Sync) -> Grid {
        Grid::by(SIZE, |x, y| MapNode {
            value: if x.abs_diff(10) < 3 && y.abs_diff(12) < 4 { f64::NAN } else { value(x as f64, y as f64) },
            is_torn: [[1, 0], [0, 1]].map(|[dx, dy]| (3 * x > 60 + y) != (3 * (x + dx) > 60 + y + dy)),
            is_open: false,
        })
    }

    fn jitter(x: f64, y: f64) -> f64 {
        let n = (x * 30.0 + y) as u32;
        f64::from(n.wrapping_mul(2_654_435_761).rotate_left(11) % 1000) / 1000.0 - 0.5
    }

    fn apart(a: &Grid, b: &Grid) -> f64 {
        let both = a.nodes().iter().zip(b.nodes());
        both.filter(|(a, _)| a.value.is_finite()).map(|(a, b)| (a.value - b.value).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_plane_stays_a_plane_up_to_holes_and_a_step_at_a_fault_stays_sharp() {
        let plane = holed(|x, y| 100.0 + 3.0 * x - 2.0 * y);
        assert!(apart(&plane, &smoothed(&plane, 1e9)) < 1e-9);
        let faulted = holed(|x, y| 0.5 * x + if 3.0 * x > 60.0 + y { 40.0 } else { 0.0 });
        let smooth = smoothed(&faulted, 1e9);
        assert!(apart(&faulted, &smooth) < 1e-9);
        let holes = |grid: &Grid| grid.nodes().iter().map(|node| node.value.is_nan()).collect::<Vec<_>>();
        assert_eq!(holes(&faulted), holes(&smooth));
    }

    #[test]
    fn jitter_goes_and_folds_stay() {
        // Twenty traces and more long, 30 high.
        let fold = |x: f64, y: f64| 30.0 * (x / 12.0).sin() + y;
        let noisy = Grid::by(SIZE, |x, y| {
            let (x, y) = (x as f64, y as f64);
            MapNode { value: fold(x, y) + jitter(x, y), is_torn: [false; 2], is_open: false }
        });
        let smooth = smoothed(&noisy, 1e9);
        let rms = |grid: &Grid| {
            let inner = (6..34).flat_map(|x| (6..24).map(move |y| (x, y)));
            let off = inner.map(|(x, y)| (grid.at(x, y).value - fold(x as f64, y as f64)).powi(2));
            (off.sum::<f64>() / (28.0 * 18.0)).sqrt()
        };
        // Of a sine, a Gaussian of 2 traces leaves exp(-2²/2/12²), and of white noise 1/(2 sqrt(pi) 2).
        let lost = 30.0 * (1.0 - (-2.0f64 / 144.0).exp()) * 0.8;
        assert!(rms(&noisy) > 0.25 && rms(&smooth) < lost + 0.08, "{} of {}", rms(&smooth), rms(&noisy));
    }

    #[test]
    fn a_step_moves_by_half_an_interval_and_no_more() {
        let value = |x: usize| if x < 20 { 0.0 } else { 40.0 };
        let step = Grid::by(SIZE, |x, _| MapNode { value: value(x), is_torn: [false; 2], is_open: false });
        let moved = apart(&step, &smoothed(&step, 5.0));
        assert!((moved - 2.5).abs() < 1e-9, "{moved}");
    }
}
