//! Continues gridded data smoothly over a whole grid. Holes, the outer boundary of the volume and faults are
//! handled alike.
//!
//! 1. The least-squares plane is subtracted, so that planes stay exact planes.
//! 2. [`local_fit`]: the data near the rim is replaced by robust local quadratics; their slope is what the
//!    surface is continued with, so that picking noise is not amplified.
//! 3. Over the next two nodes the quadratics continue with their curvature, so that a fault between nodes is
//!    met on the curve.
//! 4. [`plate`]: between and beyond, the surface of least bending, min ∫ h_xx² + 2h_xy² + h_yy², that takes
//!    up value and slope there (clamped) and is free at the grid's border: a hole is filled by a thin plate,
//!    an edge is continued linearly, and both join C¹. Coarse to fine: a direct solution on a coarse grid,
//!    then relaxation in a band around the data on each finer one.
//! 5. What the fits smoothed off the rim (data − fit) fades out over a few nodes, so that the data itself
//!    stays exact.
//!
//! "Extended linearly" is P-illus 3.2; a plate is our choice because it is also right for holes and corners.

mod local_fit;
mod plate;

pub(super) use local_fit::LocalFits;

use plate::PlateGrid;

/// How to continue data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extension {
    /// Radius of the neighbourhood a slope is taken from, nodes.
    pub radius: f32,
    /// What a deviation from the fit must exceed to count as an outlier, units of the data.
    pub noise: f32,
    /// Slope per node assumed in directions along which the data does not tell it.
    pub slope: [f64; 2],
}

/// Where along a chain of nodes data − fit has faded out, and its factor from one node to the next.
const FADE: (usize, f32) = (8, 0.6);

/// Clean data takes its slope from this share of the radius.
const LEAST_RADIUS: f32 = 0.6;

/// The plane z = z0 + a·x + b·y over node indices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NodePlane {
    z0: f64,
    a: f64,
    b: f64,
}

impl NodePlane {
    /// The least-squares plane through the finite nodes of a grid; `None` without any. Directions in which
    /// the data has no width take their slope from `prior`.
    pub(crate) fn through(size: [usize; 2], values: &[f32], prior: [f64; 2]) -> Option<Self> {
        let nodes = || {
            values.iter().enumerate().filter(|(_, z)| z.is_finite()).map(|(n, &z)| {
                let (x, y) = ((n / size[1]) as f64, (n % size[1]) as f64);
                (x, y, f64::from(z) - prior[0] * x - prior[1] * y)
            })
        };
        let count = nodes().count() as f64;
        if count == 0.0 {
            return None;
        }
        let (sx, sy, sz) = nodes().fold((0.0, 0.0, 0.0), |s, (x, y, z)| (s.0 + x, s.1 + y, s.2 + z));
        let (mx, my, mz) = (sx / count, sy / count, sz / count);
        let mut c = [0.0f64; 5];
        for (x, y, z) in nodes() {
            let (x, y, z) = (x - mx, y - my, z - mz);
            for (sum, term) in c.iter_mut().zip([x * x, x * y, y * y, x * z, y * z]) {
                *sum += term;
            }
        }
        // Principal axes of the nodes; along one that is thinner than about two nodes the slope would be
        // noise.
        let (mean, diff) = (0.5 * (c[0] + c[2]), 0.5 * (c[0] - c[2]));
        let root = diff.hypot(c[1]);
        let angle = 0.5 * c[1].atan2(diff);
        let mut slope = prior;
        for (moment, angle) in [(mean + root, angle), (mean - root, angle + std::f64::consts::FRAC_PI_2)] {
            let (dy, dx) = angle.sin_cos();
            if moment > 0.5 * count {
                let along = (c[3] * dx + c[4] * dy) / moment;
                slope[0] += along * dx;
                slope[1] += along * dy;
            }
        }
        let (a, b) = (slope[0], slope[1]);
        let z0 = mz + prior[0] * mx + prior[1] * my - a * mx - b * my;
        Some(Self { z0, a, b })
    }

    /// Slope per node along x and y.
    pub(crate) fn slope(&self) -> [f64; 2] {
        [self.a, self.b]
    }

    fn at(&self, x: usize, y: usize) -> f64 {
        self.z0 + self.a * x as f64 + self.b * y as f64
    }
}

impl Extension {
    /// The share of the radius that the data's noise asks for. A slope fitted over r nodes is off by about 10
    /// σ/r² through noise and by r² times the third derivative through the shape, so clean data is better
    /// served by a smaller neighbourhood. σ is taken from third differences, which see no curvature.
    fn steadiness(&self, size: [usize; 2], flat: &[f32]) -> f32 {
        let mut differences: Vec<f32> = Vec::new();
        for (n, &z) in flat.iter().enumerate() {
            let (x, y) = (n / size[1], n % size[1]);
            for (fits, step) in [(x + 3 < size[0], size[1]), (y + 3 < size[1], 1)] {
                if fits {
                    let third = flat[n + 3 * step] - z + 3.0 * (flat[n + step] - flat[n + 2 * step]);
                    if third.is_finite() {
                        differences.push(third.abs());
                    }
                }
            }
        }
        if differences.is_empty() {
            return 1.0;
        }
        let half = differences.len() / 2;
        // The standard deviation of white noise: a third difference has variance 20 σ², its median modulus is
        // 0.6745 of its deviation.
        let deviation = *differences.select_nth_unstable_by(half, f32::total_cmp).1 / (0.6745 * 20.0f32.sqrt());
        (deviation / (0.5 * self.noise)).sqrt().clamp(LEAST_RADIUS, 1.0)
    }

    /// Replaces the NaN nodes of `values`, `[x][y]` of `size`, and leaves the others as they are; `None` when
    /// all are NaN.
    pub(crate) fn extend(&self, size: [usize; 2], values: &mut [f32]) -> Option<()> {
        let plane = NodePlane::through(size, values, self.slope)?;
        let known: Vec<bool> = values.iter().map(|z| z.is_finite()).collect();
        if known.iter().all(|&k| k) {
            return Some(());
        }
        let flat: Vec<f32> = values
            .iter()
            .enumerate()
            .map(|(n, &z)| (f64::from(z) - plane.at(n / size[1], n % size[1])) as f32)
            .collect();
        let radius = self.radius * self.steadiness(size, &flat);
        let fits = LocalFits::new(size, &flat, &known, radius, self.noise);
        let rest = fade_out(size, &known, &fits, &flat);
        let collar = fits.collar();
        let mut held = known.clone();
        collar.iter().for_each(|&n| held[n] = true);
        let mut smooth = plate::solve(size, &held, &fits);
        collar.iter().for_each(|&n| smooth[n] = fits.at(n).z);
        for n in 0..values.len() {
            if !known[n] {
                let flat = f64::from(smooth[n]) + f64::from(rest[n]);
                values[n] = (flat + plane.at(n / size[1], n % size[1])) as f32;
            }
        }
        Some(())
    }
}

/// Data − fit at the rim, carried into the unknown and fading out.
fn fade_out(size: [usize; 2], known: &[bool], fits: &LocalFits, flat: &[f32]) -> Vec<f32> {
    let mut rest = vec![0.0f32; flat.len()];
    let mut ring = vec![0u8; flat.len()];
    let mut front: Vec<usize> = Vec::new();
    for n in 0..flat.len() {
        if known[n] && PlateGrid::near_unknown(size, known, n, 1) {
            rest[n] = flat[n] - fits.at(n).z;
            ring[n] = 1;
            front.push(n);
        }
    }
    for step in 2..FADE.0 as u8 + 2 {
        let mut next: Vec<usize> = Vec::new();
        for &n in &front {
            PlateGrid::neighbours(size, n, 1, |m| {
                if !known[m] && ring[m] == 0 {
                    ring[m] = step;
                    next.push(m);
                }
            });
        }
        next.sort_unstable();
        for &m in &next {
            let (mut sum, mut count) = (0.0, 0.0);
            PlateGrid::neighbours(size, m, 1, |n| {
                if ring[n] == step - 1 {
                    sum += rest[n];
                    count += 1.0;
                }
            });
            rest[m] = FADE.1 * sum / f32::max(count, 1.0);
        }
        front = next;
    }
    rest
}

#[cfg(test)]
mod tests;
