//! From flat space to texture space on a face (P-illus 3.5).
//!
//! A point of a face has flat coordinates (i, j, k). One of three *mappings* lays a pattern on it. Each is
//! linear in (i, j, k), with `a` = extent of j / extent of i in metres:
//!
//! | mapping | u (times the horizontal frequency) | v | where |
//! |---|---|---|---|
//! | along | `t.x·i + t.y·a·j` | k (times the vertical frequency) | side faces; the others when the layer strikes along t |
//! | across | `−t.y·i + t.x·a·j` | k (times the vertical frequency) | top and bottom faces on which the layer strikes across t |
//! | map | as along | `−t.y·i + t.x·a·j` (times the horizontal frequency) | any face that is parallel to the layer |
//!
//! t is the horizontal direction that lies in the face: y for a face of constant x, x for a face of constant
//! y, x for a horizontal face, and the true direction for an oblique one, so that a pattern keeps its size on
//! any vertical cut. The paper always uses `along` on top faces, with t = x. Where a layer dips towards x, i
//! and k then change together and nothing changes along y, so the pattern smears into stripes. We take the
//! horizontal coordinate that runs along strike. Where the face is nearly parallel to the layer, k hardly changes, and the
//! way across t takes its place: j on a top face, the way down the layer on a side face that shows a steep limb. A thick
//! layer comes to that at larger angles than a thin one. So what counts is q, the nominal metres of k on a metre of the
//! face. In a layer of its nominal thickness that is |s|, the sine of the angle between face and layer; s = n × g is the
//! strike line on the face, for face normal n and g = ∇k/|∇k|. Where k is dense since beds are thin, q says how many times too
//! dense; where they were sheared, as in the limbs of a similar fold, they cross the face at a large angle and are drawn.
//! From c = 0.6 the map begins to replace k, from 0.5 on, the limit of what is calm, it alone is used, unless it is no
//! calmer ([`crate::Stretch::calmness`]).
//!
//! With S(a, b, x) the cubic smoothstep, c₂ the calmness of the map:
//!
//! ```text
//! r = (s·t)²/((s·t)² + (s·t′)²)         along t, a share of R = S(0.35, 0.65, r); t′ = t turned by 90°
//! c = q where q ≤ 1, else the larger of 1/q and |s|
//! map = (1 − S(0.5², 0.6², c²))·(1 − S(0.8, 1, c²/c₂²)),   along = (1 − map)·R,   across = 1 − map − along
//! ```
//!
//! On a wall that turns, `along` continues from one plane to the next: u is shifted so that it is the same on both sides
//! of their edge wherever (i, j) is the place on the map.
//!
//! Spaces: normals and gradients are in metric space with the axes of voxel space (x, y in metres, z in
//! metres downwards); their signs do not matter. All arithmetic is f32, so that the WGSL twin computes the
//! same.

use crate::stretch::Stretch;

/// Square of the calmness of a pattern over k at and below which the map mapping replaces it.
pub const MAP_ONLY_CALMNESS_SQ: f32 = 0.25;
/// Square of the calmness of a pattern over k above which the map mapping is not used.
pub const NO_MAP_CALMNESS_SQ: f32 = 0.36;
/// The map mapping is used alone only if the square of the other's calmness is at most this share of the square of its own.
pub const MAP_RATHER_SQ: f32 = 0.8;
/// Share of the strike line along t below which the across mapping alone is used.
pub const ACROSS_ONLY_SHARE: f32 = 0.35;
/// Share of the strike line along t above which the along mapping alone is used.
pub const ALONG_ONLY_SHARE: f32 = 0.65;
/// Squared horizontal part of the unit normal below which a face counts as horizontal.
const HORIZONTAL_NORMAL_SQ: f32 = 1e-6;

/// A face as the mappings need it: its normal, and the horizontal direction in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceFrame {
    /// Unit normal (metric axes x, y, z down); the sign has no effect.
    pub normal: [f32; 3],
    /// Unit horizontal direction t (x, y) in the face.
    pub along: [f32; 2],
    /// Added to u of the mapping along t, before its frequency.
    pub shift: f32,
}

/// The weights of the three mappings; they are in [0, 1] and add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MappingWeights {
    /// Weight of u along t, v = k.
    pub along: f32,
    /// Weight of u across t, v = k.
    pub across: f32,
    /// Weight of u along t, v across t.
    pub map: f32,
}

/// One mapping: texture coordinates before the frequencies, as linear forms of (i, j, k).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapping {
    /// Coefficients of u; times the horizontal frequency.
    pub u: [f32; 3],
    /// Coefficients of v; times the vertical frequency, or the horizontal one in the map mapping.
    pub v: [f32; 3],
    /// Added to u of a place, before the frequency.
    pub shift: f32,
}

impl FaceFrame {
    /// The frame of a face with this normal (any length; metric axes x, y, z down).
    ///
    /// The direction t is turned so that its larger component is positive: i and j grow with u.
    ///
    /// ```
    /// use ttf::FaceFrame;
    /// assert_eq!(FaceFrame::new([1.0, 0.0, 0.0]).along, [0.0, 1.0]);
    /// assert_eq!(FaceFrame::new([0.0, -1.0, 0.0]).along, [1.0, 0.0]);
    /// assert_eq!(FaceFrame::new([0.0, 0.0, 1.0]).along, [1.0, 0.0]);
    /// ```
    pub fn new(normal: [f32; 3]) -> Self {
        let normal = unit(normal);
        let horizontal_sq = normal[0] * normal[0] + normal[1] * normal[1];
        if horizontal_sq <= HORIZONTAL_NORMAL_SQ {
            return Self { normal, along: [1.0, 0.0], shift: 0.0 };
        }
        let scale = 1.0 / horizontal_sq.sqrt();
        let [x, y] = [-normal[1] * scale, normal[0] * scale];
        let larger = if x.abs() >= y.abs() { x } else { y };
        let sign = if larger < 0.0 { -1.0 } else { 1.0 };
        // Adding 0 turns -0 into 0.
        Self { normal, along: [sign * x + 0.0, sign * y + 0.0], shift: 0.0 }
    }

    /// The frame of a part of a wall that turns: t and the shift of u are given.
    pub fn on_wall(normal: [f32; 3], along: [f32; 2], shift: f32) -> Self {
        Self { normal: unit(normal), along, shift }
    }

    /// The weights at a point where k rises along `grad_k` (any length), by `k_rate` nominal metres for a metre of the face, and
    /// the map has this stretch ([`Self::stretches`]). A gradient that is zero or NaN gives the along mapping alone.
    ///
    /// ```
    /// use ttf::FaceFrame;
    /// // i, j and k over 1 km by 1 km by 100 m; a flat layer on a top face is seen as a map.
    /// let top = FaceFrame::new([0.0, 0.0, 1.0]);
    /// let on_top = top.stretches(1.0, [1e3, 1e2], [[1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]]);
    /// assert_eq!(top.weights([0.0, 0.0, -1e-2], 0.0, on_top[2]).to_array(), [0.0, 0.0, 1.0]);
    /// // On a side face k runs upwards.
    /// let side = FaceFrame::new([1.0, 0.0, 0.0]);
    /// let on_side = side.stretches(1.0, [1e3, 1e2], [[0.0, 1e-3, 0.0], [0.0, 0.0, -1e-2]]);
    /// assert_eq!(side.weights([0.0, 0.0, -1e-2], 1.0, on_side[2]).to_array(), [1.0, 0.0, 0.0]);
    /// ```
    pub fn weights(&self, grad_k: [f32; 3], k_rate: f32, map: Stretch) -> MappingWeights {
        let g = unit(grad_k);
        let n = self.normal;
        let s = [n[1] * g[2] - n[2] * g[1], n[2] * g[0] - n[0] * g[2], n[0] * g[1] - n[1] * g[0]];
        if g == [0.0; 3] || !s.iter().all(|part| part.is_finite()) {
            return MappingWeights::ALONG;
        }
        let along_t = s[0] * self.along[0] + s[1] * self.along[1];
        let across_t = s[1] * self.along[0] - s[0] * self.along[1];
        let horizontal_sq = along_t * along_t + across_t * across_t;
        let share = if horizontal_sq > 1e-12 { along_t * along_t / horizontal_sq } else { 1.0 };
        let share = smoothstep(ACROSS_ONLY_SHARE, ALONG_ONLY_SHARE, share);
        let sine_sq = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
        let rate_sq = k_rate * k_rate;
        let k_sq = if rate_sq <= 1.0 { rate_sq } else { sine_sq.max(1.0 / rate_sq) };
        let map_sq = map.calmness() * map.calmness();
        let sparse = 1.0 - smoothstep(MAP_ONLY_CALMNESS_SQ, NO_MAP_CALMNESS_SQ, k_sq);
        let better = if map_sq > 0.0 { 1.0 - smoothstep(MAP_RATHER_SQ, 1.0, k_sq / map_sq) } else { 0.0 };
        let map = sparse * better;
        let along = (1.0 - map) * share;
        MappingWeights { along, across: (1.0 - map - along).max(0.0), map }
    }

    /// How far each mapping (along, across, map) is stretched where (i, j, k) changes by `changes` for a metre along two
    /// perpendicular directions of the face. i and k stand for `[extent_i_m, thickness_m]` metres.
    pub fn stretches(
        &self,
        aspect_j: f32,
        [extent_i_m, thickness_m]: [f32; 2],
        changes: [[f32; 3]; 2],
    ) -> [Stretch; 3] {
        let lengths = [[extent_i_m, thickness_m], [extent_i_m, thickness_m], [extent_i_m, extent_i_m]];
        let mappings = self.mappings(aspect_j);
        [0, 1, 2].map(|n: usize| {
            let [p, q] = changes.map(|change| mappings[n].apply(change));
            let [u_m, v_m] = lengths[n];
            Stretch::of([[u_m * p[0], u_m * q[0]], [v_m * p[1], v_m * q[1]]])
        })
    }

    /// The three mappings (along, across, map) for a block whose j axis is `aspect_j` times as long as its i
    /// axis.
    pub fn mappings(&self, aspect_j: f32) -> [Mapping; 3] {
        let [x, y] = self.along;
        let k = [0.0, 0.0, 1.0];
        let (along, across) = ([x, y * aspect_j, 0.0], [-y, x * aspect_j, 0.0]);
        [
            Mapping { u: along, v: k, shift: self.shift },
            Mapping { u: across, v: k, shift: 0.0 },
            Mapping { u: along, v: across, shift: self.shift },
        ]
    }
}

impl MappingWeights {
    /// The along mapping alone.
    pub const ALONG: Self = Self { along: 1.0, across: 0.0, map: 0.0 };

    /// The weights in the order of [`FaceFrame::mappings`].
    pub fn to_array(self) -> [f32; 3] {
        [self.along, self.across, self.map]
    }
}

impl Mapping {
    /// Texture coordinates (u, v) of a flat point, before the frequencies.
    pub fn place(&self, flat: [f32; 3]) -> [f32; 2] {
        let [u, v] = self.apply(flat);
        [u + self.shift, v]
    }

    /// Change of the texture coordinates (u, v) for a flat displacement, before the frequencies.
    pub fn apply(&self, flat: [f32; 3]) -> [f32; 2] {
        let dot = |a: [f32; 3]| a[0] * flat[0] + a[1] * flat[1] + a[2] * flat[2];
        [dot(self.u), dot(self.v)]
    }
}

/// WGSL's cubic `smoothstep`.
pub(crate) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The vector scaled to unit length; zero if it has no direction.
fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length_sq = vector.iter().map(|part| part * part).sum::<f32>();
    if length_sq > 0.0 && length_sq.is_finite() {
        let scale = 1.0 / length_sq.sqrt();
        vector.map(|part| part * scale)
    } else {
        [0.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: [f32; 3] = [0.0, 0.0, -1.0];

    /// The weights in a layer of its nominal thickness whose (i, j) are lengths along it.
    fn weights(normal: [f32; 3], grad_k: [f32; 3]) -> [f32; 3] {
        weights_at(&FaceFrame::new(normal), grad_k, 1.0)
    }

    /// The weights where k rises so many times as fast as in a layer of its nominal thickness.
    fn weights_at(frame: &FaceFrame, grad_k: [f32; 3], rate: f32) -> [f32; 3] {
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let g = unit(grad_k);
        let g = if g[2] > 0.0 { g.map(|part| -part) } else { g };
        // A layer that lay flat, turned about its strike.
        let axis = cross(UP, g);
        let turned = |v: [f32; 3]| {
            let (turn, share) = (cross(axis, v), dot(axis, v) / (1.0 - g[2]));
            [0, 1, 2].map(|n| -g[2] * v[n] + turn[n] + share * axis[n])
        };
        let n = frame.normal;
        let p = unit(cross(n, if n[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { UP }));
        let change =
            |step| [dot(step, turned([1.0, 0.0, 0.0])), dot(step, turned([0.0, 1.0, 0.0])), rate * dot(step, g)];
        let changes = [change(p), change(cross(n, p))];
        let [_, _, map] = frame.stretches(1.0, [1.0; 2], changes);
        frame.weights(grad_k, changes[0][2].hypot(changes[1][2]), map).to_array()
    }

    fn near(found: [f32; 3], expected: [f32; 3]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} {expected:?}");
    }

    #[test]
    fn side_faces_show_k_over_the_axis_that_lies_in_them() {
        for grad_k in [UP, [0.5, 0.2, -1.0], [-0.1, 0.9, -1.0]] {
            near(weights([1.0, 0.0, 0.0], grad_k), [1.0, 0.0, 0.0]);
            near(weights([0.0, 1.0, 0.0], grad_k), [1.0, 0.0, 0.0]);
        }
        let [on_x, ..] = FaceFrame::new([1.0, 0.0, 0.0]).mappings(0.5);
        assert_eq!(on_x.apply([0.3, 0.6, 0.9]), [0.3, 0.9]);
        let [on_y, ..] = FaceFrame::new([0.0, -1.0, 0.0]).mappings(0.5);
        assert_eq!(on_y.apply([0.3, 0.6, 0.9]), [0.3, 0.9]);
    }

    #[test]
    fn a_flat_layer_on_top_is_a_map_and_a_steep_one_shows_k_along_strike() {
        let top = [0.0, 0.0, -1.0];
        near(weights(top, UP), [0.0, 0.0, 1.0]);
        near(weights(top, [0.0, 1.0, -1.0]), [1.0, 0.0, 0.0]);
        near(weights(top, [1.0, 0.0, -1.0]), [0.0, 1.0, 0.0]);
        let [along, across, map] = FaceFrame::new(top).mappings(2.0);
        let point = [0.25, 0.5, 0.75];
        assert_eq!(along.apply(point), [0.25, 0.75]);
        assert_eq!(across.apply(point), [1.0, 0.75]);
        assert_eq!(map.apply(point), [0.25, 1.0]);
    }

    #[test]
    fn the_map_takes_over_where_k_is_no_longer_calm_without_a_jump() {
        let top = FaceFrame::new([0.0, 0.0, 1.0]);
        // In a layer of its nominal thickness between 36.9° and 30°, in a thicker or thinner one where lines of k are as far
        // apart on the face.
        for rate in [0.7, 1.0, 1.5] {
            let at = |sin: f32| {
                let grad_k = [0.0, sin, -(1.0 - sin * sin).sqrt()];
                weights_at(&top, grad_k, rate)
            };
            near(at(0.49 / rate), [0.0, 0.0, 1.0]);
            near(at(0.61 / rate), [1.0, 0.0, 0.0]);
            let mut previous = at(0.0);
            for step in 1..=600 {
                let now = at(step as f32 * 0.001 / rate);
                assert!((now.iter().sum::<f32>() - 1.0).abs() < 1e-5);
                assert!(now[2] <= previous[2] && previous[2] - now[2] < 0.06);
                previous = now;
            }
        }
    }

    #[test]
    fn the_map_is_not_taken_where_it_is_no_calmer() {
        // A layer four times as thick as usual in a section across it: i alone changes with the map.
        let (face, grad_k) = (FaceFrame::new([0.0, 1.0, 0.0]), [0.0, 0.0, -1.0]);
        near(weights_at(&face, grad_k, 0.25), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn sheared_beds_are_drawn_on_a_section_across_them() {
        // The limb of a similar fold: k was displaced by five times the way along x, and a plunge makes j change with z.
        let (face, grad_k) = (FaceFrame::new([0.0, 1.0, 0.0]), [5.0, 0.0, -1.0]);
        let changes = [[1.0, 0.0, 5.0], [0.0, 0.4, -1.0]];
        let [along, _, map] = face.stretches(1.0, [1.0; 2], changes);
        assert!(map.calmness() > 4.0 * along.calmness(), "{map:?} {along:?}");
        near(face.weights(grad_k, 26f32.sqrt(), map).to_array(), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn a_steep_limb_on_a_side_face_lies_along_the_horizontal() {
        for (normal, limb) in [([1.0, 0.0, 0.0], [1.0, 0.0, -0.1]), ([0.0, 1.0, 0.0], [0.0, -1.0, 0.1])] {
            let frame = FaceFrame::new(normal);
            near(weights(normal, limb), [0.0, 0.0, 1.0]);
            let [along, _, map] = frame.mappings(2.0);
            let (strike, dip) =
                if normal[0] == 1.0 { ([0.0, 0.3, 0.0], [0.4, 0.0, 0.0]) } else { ([0.3, 0.0, 0.0], [0.0, 0.4, 0.0]) };
            // Along strike both mappings are the same, so bricks go on where one replaces the other.
            assert_eq!(map.apply(strike)[0], along.apply(strike)[0]);
            assert_eq!(map.apply(strike)[1], 0.0);
            assert_eq!(map.apply(dip)[0], 0.0);
            assert!(map.apply(dip)[1].abs() >= 0.4);
        }
    }

    #[test]
    fn signs_and_lengths_do_not_matter() {
        let (normal, grad_k) = ([0.3, -0.8, 0.4], [0.2, 0.4, -0.9]);
        let expected = weights(normal, grad_k);
        near(weights(normal.map(|part| -7.0 * part), grad_k.map(|part| -0.01 * part)), expected);
        assert_eq!(FaceFrame::new(normal.map(|part| -part)).along, FaceFrame::new(normal).along);
    }

    #[test]
    fn an_oblique_section_measures_its_true_length() {
        // A vertical face along (3, 4)/5 in a block 1000 m by 2000 m: 500 m along it.
        let frame = FaceFrame::new([4.0, -3.0, 0.0]);
        let [mapping, ..] = frame.mappings(2.0);
        let step = [0.6 * 500.0 / 1000.0, 0.8 * 500.0 / 2000.0, 0.0];
        assert!((mapping.apply(step)[0] - 500.0 / 1000.0).abs() < 1e-6);
    }

    #[test]
    fn a_gradient_that_is_no_direction_falls_back_to_the_side_mapping() {
        for grad_k in [[0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
            assert_eq!(weights([0.0, 0.0, 1.0], grad_k), [1.0, 0.0, 0.0]);
        }
    }
}
