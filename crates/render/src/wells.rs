//! Wells as tubes, with their tops as rings, in cut-outs and in media (P-horiz, figure 7k).
//!
//! A tube is a chain of capsules around the path, round in display space. The distance from a ray o + s·d to
//! a segment a + u·b has its minimum where
//!
//! ```text
//! |o − a + s·d − u·b| = r,   0 ≤ u ≤ 1
//! ```
//!
//! is solved for the smaller s, with a ball at each end. The light depends on the angle to the viewer, so
//! that the tube looks round. A top is a band 1.6 times as wide. Display space relative to voxel 0, m.

use crate::camera::View;
use crate::error::SceneError;
use crate::scene::Scene;
use crate::visible::Ray;
use glam::{DVec3, Mat3, Vec3};
use serde::{Deserialize, Serialize};
use ttf::Colour;

/// A well to draw.
#[derive(Debug, Clone, Copy)]
pub struct DrawnWell<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its own colour; otherwise that of the scene's wells.
    pub colour: Option<Colour>,
    /// Its path from the surface down, voxels.
    pub path: &'a [DVec3],
    /// Positions of its tops on the path, voxels.
    pub tops: &'a [DVec3],
}

/// How wells are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WellStyle {
    /// Radius of a tube as a fraction of the block's longest side. Default 0.006; 0: wells are not drawn.
    pub radius: f32,
    /// Colour of the tubes. Default near black.
    pub colour: Colour,
    /// Colour of the tops. Default red.
    pub top_colour: Colour,
}

impl Default for WellStyle {
    fn default() -> Self {
        Self { radius: 0.006, colour: Colour::new(0x26, 0x26, 0x2a), top_colour: Colour::new(0xc8, 0x2a, 0x1e) }
    }
}

impl WellStyle {
    /// Checks that this can be drawn.
    ///
    /// # Errors
    /// [`SceneError::OutOfRange`].
    pub fn validate(&self) -> Result<(), SceneError> {
        SceneError::check_range("the radius of wells", f64::from(self.radius), 0.0, 0.5)
    }
}

/// A piece of a tube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Capsule {
    /// Its ends in display space relative to voxel 0, m.
    pub ends: [Vec3; 2],
    /// Its radius, m.
    pub radius: f32,
    /// Colour, sRGB-encoded.
    pub colour: [f32; 3],
    /// The index of the well.
    pub well: usize,
}

/// Where a ray meets a well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WellHit {
    /// Distance along the ray, voxels.
    pub t: f32,
    /// The index of the well.
    pub well: usize,
    /// Its colour there, sRGB-encoded.
    pub colour: Vec3,
}

/// All wells of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tubes {
    /// The pieces of the tubes.
    pub capsules: Vec<Capsule>,
    /// The linear map from voxel to display space.
    pub display_from_voxel: Mat3,
}

/// Brightness at the rim of a tube, relative to its middle.
pub(crate) const RIM_LIGHT: f32 = 0.35;
/// How far a tube may deviate from its path, voxels. Paths are sampled far more densely than they bend.
const STRAIGHT: f64 = 0.05;
/// Width of the band of a top, relative to the tube.
const TOP_WIDTH: f32 = 1.6;

impl Tubes {
    /// The wells inside a block; `None` if there are none.
    pub(crate) fn new(
        wells: &[DrawnWell],
        scene: &Scene,
        view: &View,
        longest_m: f64,
        roaming_box: [Vec3; 2],
    ) -> Option<Self> {
        let style = &scene.wells;
        if style.radius <= 0.0 {
            return None;
        }
        let to_display = view.display_from_voxel();
        let radius = style.radius * longest_m as f32;
        let mut capsules = Vec::new();
        for (well, path) in wells.iter().enumerate().filter(|(_, well)| !scene.hides_well(well.name)) {
            let kept = simplified(path.path, STRAIGHT);
            let colour = path.colour.map_or(style.colour, |own| scene.preset.line(own)).to_unit();
            for ends in kept.windows(2).filter_map(|ends| clipped([ends[0], ends[1]], roaming_box)) {
                let ends = ends.map(|end| (to_display * end).as_vec3());
                capsules.push(Capsule { ends, radius, colour, well });
            }
            let inside = |p: &&DVec3| {
                let p = p.as_vec3();
                p.cmpge(roaming_box[0]).all() && p.cmple(roaming_box[1]).all()
            };
            for top in path.tops.iter().filter(inside) {
                let middle = (to_display * *top).as_vec3();
                let along = direction_at(path.path, *top, to_display).as_vec3() * radius * 0.6;
                let ends = [middle - along, middle + along];
                capsules.push(Capsule { ends, radius: radius * TOP_WIDTH, colour: style.top_colour.to_unit(), well });
            }
        }
        (!capsules.is_empty()).then_some(Self { capsules, display_from_voxel: to_display.as_mat3() })
    }

    /// The first well on a ray before distance `stop`.
    pub(crate) fn hit(&self, ray: &Ray, stop: f32) -> Option<WellHit> {
        let origin = self.display_from_voxel * ray.origin;
        let along = self.display_from_voxel * ray.direction;
        let metres = along.length();
        let direction = along / metres;
        let mut nearest: Option<WellHit> = None;
        let mut last = stop * metres;
        for capsule in &self.capsules {
            if let Some((s, facing)) = meet(origin, direction, capsule)
                && s < last
            {
                last = s;
                let light = RIM_LIGHT + (1.0 - RIM_LIGHT) * facing;
                let colour = Vec3::from_array(capsule.colour) * light;
                nearest = Some(WellHit { t: s / metres, well: capsule.well, colour });
            }
        }
        nearest
    }
}

/// The points of a path, without those within `tolerance` of the line through the neighbours that are kept
/// (Douglas and Peucker 1973).
fn simplified(path: &[DVec3], tolerance: f64) -> Vec<DVec3> {
    let (Some(&first), Some(&last)) = (path.first(), path.last()) else { return Vec::new() };
    let mut kept = vec![first];
    // Parts still to be simplified; the next one is last.
    let mut stretches = vec![(0, path.len() - 1)];
    while let Some((from, to)) = stretches.pop() {
        let along = path[to] - path[from];
        let off = |p: DVec3| {
            let u = ((p - path[from]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
            (p - path[from] - along * u).length()
        };
        let farthest = (from + 1..to).max_by(|&a, &b| off(path[a]).total_cmp(&off(path[b])));
        match farthest.filter(|&n| off(path[n]) > tolerance) {
            Some(n) => stretches.extend([(n, to), (from, n)]),
            None => kept.push(path[to]),
        }
    }
    if kept.len() == 1 {
        kept.push(last);
    }
    kept
}

/// The part of a segment inside a box.
fn clipped(ends: [DVec3; 2], [low, high]: [Vec3; 2]) -> Option<[DVec3; 2]> {
    let along = ends[1] - ends[0];
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..3 {
        let (low, high) = (f64::from(low[axis]), f64::from(high[axis]));
        if along[axis].abs() < 1e-12 {
            if ends[0][axis] < low || ends[0][axis] > high {
                return None;
            }
            continue;
        }
        let (a, b) = ((low - ends[0][axis]) / along[axis], (high - ends[0][axis]) / along[axis]);
        from = from.max(a.min(b));
        to = to.min(a.max(b));
    }
    (from < to).then(|| [ends[0] + along * from, ends[0] + along * to])
}

/// Unit direction, in display space, of the piece of a path that is nearest to a position.
fn direction_at(path: &[DVec3], place: DVec3, to_display: glam::DMat3) -> DVec3 {
    let nearest = path.windows(2).min_by(|a, b| {
        let off = |ends: &[DVec3]| {
            let along = ends[1] - ends[0];
            let u = ((place - ends[0]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
            (place - ends[0] - along * u).length_squared()
        };
        off(a).total_cmp(&off(b))
    });
    nearest.map_or(DVec3::Z, |ends| (to_display * (ends[1] - ends[0])).normalize_or(DVec3::Z))
}

/// Distance along a ray (unit direction) to a capsule, and the cosine between its normal there and the
/// direction to the viewer, 0 … 1.
fn meet(origin: Vec3, direction: Vec3, capsule: &Capsule) -> Option<(f32, f32)> {
    let [a, b] = capsule.ends;
    let axis = b - a;
    let length_sq = axis.length_squared().max(1e-12);
    let r_sq = capsule.radius * capsule.radius;
    // Computed from the point of the ray nearest to the middle of the segment, so that distant eyes lose no
    // digits.
    let shift = (0.5 * (a + b) - origin).dot(direction);
    let from = origin + direction * shift - a;
    let (da, fa) = (direction.dot(axis) / length_sq, from.dot(axis) / length_sq);
    let across = direction - axis * da;
    let off = from - axis * fa;
    let (qa, qb, qc) = (across.length_squared(), across.dot(off), off.length_squared() - r_sq);
    let mut best: Option<(f32, Vec3)> = None;
    let mut offer = |s: f32, normal: Vec3| {
        if best.is_none_or(|(nearest, _)| s < nearest) {
            best = Some((s, normal));
        }
    };
    let root = qb * qb - qa * qc;
    if qa > 1e-9 && root >= 0.0 {
        let s = (-qb - root.sqrt()) / qa;
        let u = fa + s * da;
        if (0.0..=1.0).contains(&u) {
            offer(s, from + direction * s - axis * u);
        }
    }
    for end in [Vec3::ZERO, axis] {
        let to = from - end;
        let (hb, hc) = (to.dot(direction), to.length_squared() - r_sq);
        let root = hb * hb - hc;
        if root >= 0.0 {
            let s = -hb - root.sqrt();
            offer(s, to + direction * s);
        }
    }
    best.map(|(s, normal)| (s + shift, (-normal.dot(direction) / capsule.radius).clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_a_cylinder_and_its_round_ends() {
        let capsule = Capsule { ends: [Vec3::ZERO, Vec3::new(0.0, 0.0, 10.0)], radius: 1.0, colour: [1.0; 3], well: 0 };
        let hit = |origin: Vec3, direction: Vec3| meet(origin, direction.normalize(), &capsule);
        let (s, facing) = hit(Vec3::new(-1000.0, 0.0, 5.0), Vec3::X).unwrap();
        assert!((s - 999.0).abs() < 1e-3 && (facing - 1.0).abs() < 1e-4);
        let (s, facing) = hit(Vec3::new(-5.0, 0.6, 5.0), Vec3::X).unwrap();
        assert!((s - 4.2).abs() < 1e-4 && (facing - 0.8).abs() < 1e-4);
        let (s, _) = hit(Vec3::new(0.0, 0.0, -20.0), Vec3::Z).unwrap();
        assert!((s - 19.0).abs() < 1e-4);
        assert!(hit(Vec3::new(-5.0, 1.01, 5.0), Vec3::X).is_none());
        assert!(hit(Vec3::new(-5.0, 0.0, 11.5), Vec3::X).is_none());
    }

    #[test]
    fn a_path_keeps_its_bends_only() {
        let path: Vec<DVec3> = (0..=300)
            .map(|n| f64::from(n) * 0.1)
            .map(|s| if s < 20.0 { DVec3::new(3.0, 4.0, s) } else { DVec3::new(3.0 + (s - 20.0), 4.0, s) })
            .collect();
        let kept = simplified(&path, STRAIGHT);
        assert_eq!(kept.len(), 3);
        assert!((kept[1] - DVec3::new(3.0, 4.0, 20.0)).length() < 0.11);
        assert_eq!(simplified(&path[..1], STRAIGHT).len(), 2);
        assert!(simplified(&[], STRAIGHT).is_empty());
    }

    #[test]
    fn a_path_is_cut_at_the_box() {
        let ends = [DVec3::new(5.0, 5.0, -10.0), DVec3::new(5.0, 5.0, 30.0)];
        let inside = clipped(ends, [Vec3::ZERO, Vec3::splat(20.0)]).unwrap();
        assert_eq!((inside[0].z, inside[1].z), (0.0, 20.0));
        assert!(clipped(ends.map(|e| e + DVec3::X * 20.0), [Vec3::ZERO, Vec3::splat(20.0)]).is_none());
    }
}
