//! Moments of a set of triangles, from which the flatness of any union follows in constant time.
//!
//! For a triangle with corners v, centroid c and area a, ∫ppᵀ dA = a/12 · (Σ vvᵀ + 9 ccᵀ), so about its own
//! centroid ∫(p − c)(p − c)ᵀ dA = a/12 · Σ (v − c)(v − c)ᵀ. The moments of a union about its centroid follow
//! from those of its parts (parallel axes): M = M₁ + M₂ + a₁a₂/(a₁ + a₂) · ddᵀ with d = c₁ − c₂. Because they
//! are kept central, the small eigenvalue is never lost to the distance from an origin. Space: voxels; f64.

/// Weight of the area, which breaks ties between equally flat unions in favour of the smaller one.
const TIE_BREAK: f64 = 1e-12;

/// Most Newton steps. Two to six are needed, more only where the moment is nearly isotropic.
const MAX_STEPS: usize = 64;

/// Area, centroid and central second moment (xx, yy, zz, xy, xz, yz).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Moments {
    pub(crate) area: f64,
    pub(crate) centroid: [f64; 3],
    pub(crate) second: [f64; 6],
}

impl Moments {
    pub(crate) const EMPTY: Self = Self { area: 0.0, centroid: [0.0; 3], second: [0.0; 6] };

    /// Moments of one triangle.
    #[inline]
    pub(crate) fn of_triangle(corners: [[f64; 3]; 3]) -> Self {
        let [a, b, c] = corners;
        let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let area = 0.5 * normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        let centroid = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
        let mut second = [0.0; 6];
        for corner in corners {
            add_outer(&mut second, minus(corner, centroid), area / 12.0);
        }
        Self { area, centroid, second }
    }

    /// Moments of the union of two sets that share no area.
    #[inline]
    pub(crate) fn union(&self, other: &Self) -> Self {
        let area = self.area + other.area;
        if area == 0.0 {
            return *self;
        }
        let share = other.area / area;
        let mut centroid = self.centroid;
        let mut apart = [0.0; 3];
        for axis in 0..3 {
            apart[axis] = other.centroid[axis] - self.centroid[axis];
            centroid[axis] += share * apart[axis];
        }
        let mut second = self.second;
        for (sum, part) in second.iter_mut().zip(other.second) {
            *sum += part;
        }
        add_outer(&mut second, apart, self.area * share);
        Self { area, centroid, second }
    }

    /// Cost of a set: its squared distance to its best-fit plane, integrated over the area, and the
    /// tie-break.
    #[inline]
    pub(crate) fn cost(&self) -> f64 {
        smallest_eigenvalue(&self.second) + TIE_BREAK * self.area
    }

    /// Bound of the rounding error of the cost of a set.
    #[inline]
    pub(crate) fn doubt(&self) -> f64 {
        1e-14 * (self.second[0] + self.second[1] + self.second[2])
    }
}

/// Adds `weight · ddᵀ`.
#[inline]
fn add_outer(second: &mut [f64; 6], d: [f64; 3], weight: f64) {
    let [x, y, z] = d.map(|component| component * weight);
    let products = [x * d[0], y * d[1], z * d[2], x * d[1], x * d[2], y * d[2]];
    for (sum, product) in second.iter_mut().zip(products) {
        *sum += product;
    }
}

/// Smallest eigenvalue of a symmetric positive semi-definite 3×3 matrix.
///
/// The characteristic polynomial λ³ − c₂λ² + c₁λ − c₀ has only real roots, so Newton's method from 0 climbs
/// to the smallest root without passing it. The error is a few 1e-16 of the largest eigenvalue, as with any
/// method that works on the matrix.
#[inline]
fn smallest_eigenvalue(m: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = *m;
    let (minor_x, minor_y, minor_z) = (yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
    let c2 = xx + yy + zz;
    let c1 = minor_x + minor_y + minor_z;
    let c0 = xx * minor_x - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let mut root = 0.0f64;
    for _ in 0..MAX_STEPS {
        let value = ((root - c2) * root + c1) * root - c0;
        let slope = (3.0 * root - 2.0 * c2) * root + c1;
        // Flat to rounding, or at a multiple root.
        if value >= 0.0 || slope <= 0.0 {
            break;
        }
        let step = value / slope;
        root -= step;
        if -step <= 1e-14 * root {
            break;
        }
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random numbers in [0, 1).
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn a_right_triangle_has_its_textbook_moments() {
        // Area 1/2; about the centroid ∫x² = bh·b²/36 = 1/36, ∫xy = −1/72.
        let moments = Moments::of_triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert!((moments.area - 0.5).abs() < 1e-15);
        for (found, wanted) in moments.second.iter().zip([1.0 / 36.0, 1.0 / 36.0, 0.0, -1.0 / 72.0, 0.0, 0.0]) {
            assert!((found - wanted).abs() < 1e-15);
        }
    }

    #[test]
    fn two_parallel_squares_are_half_their_distance_from_the_plane_between() {
        // Squares of 1 × 1 stacked 0.2 apart: each lies 0.1 off, ∫ d² dA = 2 · 0.01.
        let square = |z: f64| {
            let low = Moments::of_triangle([[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]);
            low.union(&Moments::of_triangle([[1.0, 1.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]))
        };
        let both = square(700.0).union(&square(700.2));
        assert!((both.cost() - 0.02 - 2e-12).abs() < 1e-13, "{}", both.cost());
    }

    #[test]
    fn the_union_of_many_agrees_with_a_sum_over_points_far_from_the_origin() {
        let mut next = noise(3);
        let triangles: Vec<[[f64; 3]; 3]> = (0..200)
            .map(|_| {
                let [x, y] = [next() * 40.0 + 1000.0, next() * 40.0 + 2000.0];
                [(); 3].map(|()| [x + next(), y + next(), 500.0 + 0.1 * x + next()])
            })
            .collect();
        let whole = triangles.iter().fold(Moments::EMPTY, |sum, t| sum.union(&Moments::of_triangle(*t)));
        // The integral of a quadratic over a triangle is exact at the midpoints of its edges, a third of the
        // area each.
        let samples: Vec<(f64, [f64; 3])> = triangles
            .iter()
            .flat_map(|t| {
                let area = Moments::of_triangle(*t).area;
                [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (area / 3.0, [0, 1, 2].map(|a| 0.5 * (t[i][a] + t[j][a]))))
            })
            .collect();
        let area: f64 = samples.iter().map(|s| s.0).sum();
        let mean = [0, 1, 2].map(|a| samples.iter().map(|s| s.0 * s.1[a]).sum::<f64>() / area);
        let central =
            |i: usize, j: usize| samples.iter().map(|s| s.0 * (s.1[i] - mean[i]) * (s.1[j] - mean[j])).sum::<f64>();
        let wanted = [central(0, 0), central(1, 1), central(2, 2), central(0, 1), central(0, 2), central(1, 2)];
        for (found, wanted) in whole.second.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{found} {wanted}");
        }
    }

    #[test]
    fn the_smallest_eigenvalue_is_a_minimum_over_directions() {
        let mut next = noise(9);
        for round in 0..50 {
            let mut m = [0.0; 6];
            for n in 0..3 {
                let d = [next() - 0.5, next() - 0.5, next() - 0.5];
                add_outer(&mut m, d, if n == 0 { 10f64.powi(-(round % 9)) } else { 1.0 });
            }
            let along = |t: f64, p: f64| {
                let d = [t.sin() * p.cos(), t.sin() * p.sin(), t.cos()];
                m[0] * d[0] * d[0]
                    + m[1] * d[1] * d[1]
                    + m[2] * d[2] * d[2]
                    + 2.0 * (m[3] * d[0] * d[1] + m[4] * d[0] * d[2] + m[5] * d[1] * d[2])
            };
            // The best direction, searched ever more finely.
            let (mut best, mut reach) = ([f64::INFINITY, 0.0, 0.0], 2.0);
            for _ in 0..24 {
                let centre = [best[1], best[2]];
                for i in -20..=20 {
                    for j in -20..=20 {
                        let (t, p) = (centre[0] + reach * i as f64 / 10.0, centre[1] + reach * j as f64 / 10.0);
                        if along(t, p) < best[0] {
                            best = [along(t, p), t, p];
                        }
                    }
                }
                reach *= 0.4;
            }
            let found = smallest_eigenvalue(&m);
            assert!((found - best[0]).abs() < 1e-9, "round {round}: {found} {}", best[0]);
        }
    }

    #[test]
    fn an_isotropic_moment_and_none_have_theirs() {
        assert!((smallest_eigenvalue(&[2.0, 2.0, 2.0, 0.0, 0.0, 0.0]) - 2.0).abs() < 1e-4);
        assert_eq!(smallest_eigenvalue(&[0.0; 6]), 0.0);
        assert_eq!(smallest_eigenvalue(&[3.0, 5.0, 0.0, 0.0, 0.0, 0.0]), 0.0);
    }
}
