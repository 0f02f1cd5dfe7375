//! The surface of least curvature over the missing nodes of a hole.
//!
//! Energy: Σ (δ²ₓz)² + 2(δₓδ_yz)² + (δ²_yz)² over every stencil of known and unknown nodes that contains an
//! unknown one (I. C. Briggs, "Machine contouring using minimum curvature", Geophysics 39, 1974). Its normal
//! equations are solved by conjugate gradients, preconditioned by their diagonal and started from the plane
//! through the rim. Known nodes are not changed.

use survey::{Cancelled, Progress};

/// Factor by which the residual must fall; a further step changes nothing visible.
const TOLERANCE: f64 = 1e-7;
/// Most iterations; large holes are smooth in their middle long before.
const MOST_ITERATIONS: usize = 4000;
/// Iterations between two checks for cancellation.
const CHECK_EVERY: usize = 64;

/// The equations of one hole.
pub(super) struct Plate {
    /// The terms of the energy.
    rows: Vec<EnergyTerm>,
    /// The plane through the rim at each unknown.
    start: Vec<f64>,
}

/// One term of the energy: (Σ coefficient·z + known)².
struct EnergyTerm {
    count: usize,
    unknown: [u32; 4],
    coefficient: [f64; 4],
    known: f64,
}

impl Plate {
    /// Sets up the equations for the unknown `nodes` (ascending) of a sheet.
    pub(super) fn over(z: &[f32], [nx, ny]: [usize; 2], nodes: &[u32]) -> Self {
        let index = |n: usize| nodes.binary_search(&(n as u32)).ok();
        let mut rows = Vec::new();
        let mut add = |weight: f64, terms: &[(usize, f64)]| {
            let mut row = EnergyTerm { count: 0, unknown: [0; 4], coefficient: [0.0; 4], known: 0.0 };
            for &(n, coefficient) in terms {
                match index(n) {
                    Some(unknown) => {
                        row.unknown[row.count] = unknown as u32;
                        row.coefficient[row.count] = weight * coefficient;
                        row.count += 1;
                    }
                    None if z[n].is_finite() => row.known += weight * coefficient * f64::from(z[n]),
                    // A node that stays missing, and every stencil that contains it, contributes nothing.
                    None => return,
                }
            }
            if row.count > 0 {
                rows.push(row);
            }
        };
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for place in nodes.iter().map(|&n| [n as usize / ny, n as usize % ny]) {
            for axis in 0..2 {
                low[axis] = low[axis].min(place[axis].saturating_sub(1));
                high[axis] = high[axis].max(place[axis] + 1);
            }
        }
        for x in low[0]..=high[0].min(nx - 1) {
            for y in low[1]..=high[1].min(ny - 1) {
                let n = x * ny + y;
                if x > 0 && x + 1 < nx {
                    add(1.0, &[(n - ny, 1.0), (n, -2.0), (n + ny, 1.0)]);
                }
                if y > 0 && y + 1 < ny {
                    add(1.0, &[(n - 1, 1.0), (n, -2.0), (n + 1, 1.0)]);
                }
                if x + 1 < nx && y + 1 < ny {
                    let twist = [(n, 1.0), (n + 1, -1.0), (n + ny, -1.0), (n + ny + 1, 1.0)];
                    add(std::f64::consts::SQRT_2, &twist);
                }
            }
        }
        let plane = rim_plane(z, [nx, ny], low, high);
        let start = nodes.iter().map(|&n| plane([(n as usize / ny) as f64, (n as usize % ny) as f64])).collect();
        Self { rows, start }
    }

    /// Solves for z of the unknown nodes.
    pub(super) fn solve(&self, progress: &Progress) -> Result<Vec<f32>, Cancelled> {
        let count = self.start.len();
        let mut diagonal = vec![0.0f64; count];
        for row in &self.rows {
            for k in 0..row.count {
                diagonal[row.unknown[k] as usize] += row.coefficient[k].powi(2);
            }
        }
        let mut z = self.start.clone();
        let mut residual = vec![0.0; count];
        self.gradient(&z, 1.0, &mut residual);
        residual.iter_mut().for_each(|r| *r = -*r);
        let scaled = |r: &[f64]| -> Vec<f64> { r.iter().zip(&diagonal).map(|(r, d)| r / d.max(1e-12)).collect() };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut preconditioned = scaled(&residual);
        let mut direction = preconditioned.clone();
        let mut energy = dot(&residual, &preconditioned);
        let enough = energy * TOLERANCE * TOLERANCE;
        let mut image = vec![0.0; count];
        for iteration in 0..MOST_ITERATIONS {
            if energy <= enough || energy < 1e-18 {
                break;
            }
            if iteration % CHECK_EVERY == 0 {
                progress.check()?;
            }
            image.fill(0.0);
            self.gradient(&direction, 0.0, &mut image);
            let step = energy / dot(&direction, &image);
            for n in 0..count {
                z[n] += step * direction[n];
                residual[n] -= step * image[n];
            }
            preconditioned = scaled(&residual);
            let next = dot(&residual, &preconditioned);
            let keep = next / energy;
            for n in 0..count {
                direction[n] = preconditioned[n] + keep * direction[n];
            }
            energy = next;
        }
        Ok(z.into_iter().map(|z| z as f32).collect())
    }

    /// Adds Aᵀ(A·z + share·known) to `sum`.
    fn gradient(&self, z: &[f64], share: f64, sum: &mut [f64]) {
        for row in &self.rows {
            let mut value = share * row.known;
            for k in 0..row.count {
                value += row.coefficient[k] * z[row.unknown[k] as usize];
            }
            for k in 0..row.count {
                sum[row.unknown[k] as usize] += row.coefficient[k] * value;
            }
        }
    }
}

/// The least-squares plane through the known nodes of a window.
fn rim_plane(z: &[f32], [nx, ny]: [usize; 2], low: [usize; 2], high: [usize; 2]) -> impl Fn([f64; 2]) -> f64 {
    let (mut count, mut mean) = (0.0f64, [0.0f64; 3]);
    let known = || {
        let rows = low[0]..=high[0].min(nx - 1);
        rows.flat_map(move |x| (low[1]..=high[1].min(ny - 1)).map(move |y| (x, y)))
            .map(|(x, y)| [x as f64, y as f64, f64::from(z[x * ny + y])])
            .filter(|p| p[2].is_finite())
    };
    for p in known() {
        count += 1.0;
        (0..3).for_each(|axis| mean[axis] += p[axis]);
    }
    mean.iter_mut().for_each(|m| *m /= count.max(1.0));
    let mut c = [0.0f64; 5];
    for p in known() {
        let [x, y, z] = [0, 1, 2].map(|axis| p[axis] - mean[axis]);
        for (sum, term) in c.iter_mut().zip([x * x, x * y, y * y, x * z, y * z]) {
            *sum += term;
        }
    }
    let determinant = c[0] * c[2] - c[1] * c[1];
    let slope = if determinant.abs() > 1e-9 * (c[0] * c[2]).max(1e-9) {
        [(c[3] * c[2] - c[4] * c[1]) / determinant, (c[4] * c[0] - c[3] * c[1]) / determinant]
    } else {
        [0.0; 2]
    };
    move |[x, y]| mean[2] + slope[0] * (x - mean[0]) + slope[1] * (y - mean[1])
}
