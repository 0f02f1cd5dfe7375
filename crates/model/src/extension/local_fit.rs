//! Value and slope of noisy data near a rim, by weighted least squares.
//!
//! Around a node the data within `radius` is fitted by h = c₀ + c₁ξ + c₂η + c₃ξ²/2 + c₄ξη + c₅η²/2 (ξ, η =
//! offset / radius) with weights (1 − ρ²)², ρ² = ξ² + η². The quadratic terms keep a slope at the rim of a
//! curved surface unbiased; a small ridge (they are pulled to zero) keeps strips and corners from inventing
//! curvature. Nodes far off the first fit are left out of a second one.

use std::cell::RefCell;
use std::collections::HashMap;

/// What a surface is near one node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LocalFit {
    /// Value at the node.
    pub z: f32,
    /// Slope per node along x and y.
    pub gradient: [f32; 2],
    /// Curvature: ∂²/∂x², ∂²/∂x∂y, ∂²/∂y² per node².
    pub hessian: [f32; 3],
}

impl LocalFit {
    /// The quadratic (dx, dy) nodes away.
    pub(crate) fn curved(&self, dx: f32, dy: f32) -> f32 {
        let [xx, xy, yy] = self.hessian;
        self.straight(dx, dy) + 0.5 * (xx * dx * dx + yy * dy * dy) + xy * dx * dy
    }

    /// The tangent plane (dx, dy) nodes away.
    pub(crate) fn straight(&self, dx: f32, dy: f32) -> f32 {
        self.z + self.gradient[0] * dx + self.gradient[1] * dy
    }

    /// Slope of the quadratic (dx, dy) nodes away.
    fn slope(&self, dx: f32, dy: f32) -> [f32; 2] {
        let [xx, xy, yy] = self.hessian;
        [self.gradient[0] + xx * dx + xy * dy, self.gradient[1] + xy * dx + yy * dy]
    }
}

/// Ridges relative to the sum of weights. Larger damps noise in thin strips; smaller lets slope and curvature
/// speak there. At a straight rim the moments they are compared with are 0.1 (slope) and 0.01 (curvature).
const SLOPE_RIDGE: f64 = 1e-5;
const CURVATURE_RIDGE: f64 = 1e-4;
/// Deviation beyond which a node is an outlier, in robust standard deviations.
const OUTLIER: f32 = 6.0;
/// A fit wants at least this many nodes; its neighbourhood grows until it has them.
const FEWEST_NODES: usize = 12;

/// How far beyond the data its curvature is kept, nodes. A fault between two lattice nodes is met on the
/// curve, not on its tangent; farther off, curvature would run away.
pub(super) const COLLAR: f32 = 2.3;

/// Fits at the nodes of a grid, made when asked for.
pub(crate) struct LocalFits<'a> {
    size: [usize; 2],
    values: &'a [f32],
    known: &'a [bool],
    radius: f32,
    noise: f32,
    cache: RefCell<HashMap<usize, LocalFit>>,
}

impl<'a> LocalFits<'a> {
    /// Fits to `values` where they are `known`.
    pub(crate) fn new(size: [usize; 2], values: &'a [f32], known: &'a [bool], radius: f32, noise: f32) -> Self {
        Self { size, values, known, radius: radius.max(2.0), noise, cache: RefCell::default() }
    }

    /// The fit at node `n`.
    pub(crate) fn at(&self, n: usize) -> LocalFit {
        if let Some(fit) = self.cache.borrow().get(&n) {
            return *fit;
        }
        let mut radius = self.radius;
        let mut nodes = self.gather(n, radius);
        while nodes.len() < FEWEST_NODES && radius < 4.0 * self.radius {
            radius *= 2.0;
            nodes = self.gather(n, radius);
        }
        let fit = self.robust(&nodes, radius);
        self.cache.borrow_mut().insert(n, fit);
        fit
    }

    /// Continues the data with its curvature onto the nodes closer than [`COLLAR`] to it, and counts them as
    /// fitted from now on; returns which nodes they are.
    ///
    /// Each takes the quadratics of the known nodes around it with weights 1/d⁴.
    pub(crate) fn collar(&self) -> Vec<usize> {
        let [nx, ny] = self.size;
        let reach = COLLAR.ceil() as i32 + 1;
        let mut made: Vec<(usize, LocalFit)> = Vec::new();
        for n in (0..self.known.len()).filter(|&n| !self.known[n]) {
            let (x, y) = ((n / ny) as i32, (n % ny) as i32);
            let mut near: Vec<(f32, usize, f32, f32)> = Vec::new();
            for i in (x - reach).max(0)..=(x + reach).min(nx as i32 - 1) {
                for j in (y - reach).max(0)..=(y + reach).min(ny as i32 - 1) {
                    let m = i as usize * ny + j as usize;
                    if self.known[m] {
                        let (dx, dy) = ((x - i) as f32, (y - j) as f32);
                        near.push((dx * dx + dy * dy, m, dx, dy));
                    }
                }
            }
            let closest = near.iter().map(|k| k.0).fold(f32::INFINITY, f32::min);
            if closest > COLLAR * COLLAR {
                continue;
            }
            let mut sum = (0.0f32, [0.0f32; 3]);
            // Those a node behind the closest ones have hardly a say; leaving them out saves their fits.
            for &(d, m, dx, dy) in near.iter().filter(|k| k.0.sqrt() < closest.sqrt() + 1.0) {
                let fit = self.at(m);
                let (w, slope) = (1.0 / (d * d), fit.slope(dx, dy));
                sum.0 += w;
                for (total, value) in sum.1.iter_mut().zip([fit.curved(dx, dy), slope[0], slope[1]]) {
                    *total += w * value;
                }
            }
            let [z, a, b] = sum.1.map(|v| v / sum.0);
            made.push((n, LocalFit { z, gradient: [a, b], hessian: [0.0; 3] }));
        }
        self.cache.borrow_mut().extend(made.iter().copied());
        made.into_iter().map(|(n, _)| n).collect()
    }

    /// Offsets (in radii) and values of the data within `radius` of node `n`.
    fn gather(&self, n: usize, radius: f32) -> Vec<[f32; 3]> {
        let (x, y) = ((n / self.size[1]) as i32, (n % self.size[1]) as i32);
        let reach = radius.floor() as i32;
        // Above a radius of 20 every second, third, ... node tells enough.
        let step = ((radius / 20.0).ceil() as i32).max(1);
        let mut nodes = Vec::with_capacity(((4 * reach * reach) / (step * step)) as usize);
        let first = |c: i32| c - (reach.min(c) / step) * step;
        let last = |c: i32, n: usize| (c + reach).min(n as i32 - 1);
        for i in (first(x)..=last(x, self.size[0])).step_by(step as usize) {
            for j in (first(y)..=last(y, self.size[1])).step_by(step as usize) {
                let m = i as usize * self.size[1] + j as usize;
                let (dx, dy) = ((i - x) as f32 / radius, (j - y) as f32 / radius);
                if self.known[m] && dx * dx + dy * dy < 1.0 {
                    nodes.push([dx, dy, self.values[m]]);
                }
            }
        }
        nodes
    }

    fn robust(&self, nodes: &[[f32; 3]], radius: f32) -> LocalFit {
        let c = least_squares(nodes, |_| true);
        let off = |c: &[f64; 6], n: &[f32; 3]| (f64::from(n[2]) - quadratic(c, n[0], n[1])).abs() as f32;
        let mut offsets: Vec<f32> = nodes.iter().map(|n| off(&c, n)).collect();
        let half = offsets.len() / 2;
        let deviation = if offsets.is_empty() { 0.0 } else { *offsets.select_nth_unstable_by(half, f32::total_cmp).1 };
        let limit = OUTLIER * (1.4826 * deviation).max(self.noise);
        let c =
            if nodes.iter().any(|n| off(&c, n) > limit) { least_squares(nodes, |n| off(&c, n) <= limit) } else { c };
        let r = f64::from(radius);
        let hessian = [c[3], c[4], c[5]].map(|c| (c / (r * r)) as f32);
        LocalFit { z: c[0] as f32, gradient: [(c[1] / r) as f32, (c[2] / r) as f32], hessian }
    }
}

fn quadratic(c: &[f64; 6], x: f32, y: f32) -> f64 {
    let (x, y) = (f64::from(x), f64::from(y));
    c[0] + c[1] * x + c[2] * y + 0.5 * c[3] * x * x + c[4] * x * y + 0.5 * c[5] * y * y
}

/// The six coefficients that fit the nodes which `keep` says to keep.
fn least_squares(nodes: &[[f32; 3]], keep: impl Fn(&[f32; 3]) -> bool) -> [f64; 6] {
    let mut a = [[0.0f64; 6]; 6];
    let mut rhs = [0.0f64; 6];
    for node in nodes.iter().filter(|n| keep(n)) {
        let (x, y, z) = (f64::from(node[0]), f64::from(node[1]), f64::from(node[2]));
        let w = (1.0 - x * x - y * y).powi(2);
        let basis = [1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y];
        for (i, row) in a.iter_mut().enumerate() {
            let wb = w * basis[i];
            for (entry, b) in row.iter_mut().zip(&basis).skip(i) {
                *entry += wb * b;
            }
            rhs[i] += wb * z;
        }
    }
    let weight = a[0][0].max(1e-12);
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += weight * [1e-12, SLOPE_RIDGE, SLOPE_RIDGE, CURVATURE_RIDGE, CURVATURE_RIDGE, CURVATURE_RIDGE][i];
    }
    cholesky6(a, rhs)
}

/// Solves a symmetric positive definite 6 × 6 system whose upper triangle is given.
fn cholesky6(mut a: [[f64; 6]; 6], mut b: [f64; 6]) -> [f64; 6] {
    for i in 0..6 {
        for k in 0..i {
            let above = a[k];
            let f = above[i] / above[k];
            for (entry, value) in a[i].iter_mut().zip(above).skip(i) {
                *entry -= f * value;
            }
            b[i] -= f * b[k];
        }
        a[i][i] = a[i][i].max(1e-18);
    }
    for i in (0..6).rev() {
        for j in i + 1..6 {
            b[i] -= a[i][j] * b[j];
        }
        b[i] /= a[i][i];
    }
    b
}
