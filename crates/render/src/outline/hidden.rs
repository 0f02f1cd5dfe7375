//! Hidden-line removal: which parts of a line on the block are visible.
//!
//! A point is visible if the ray through its pixel meets the block there. Faces are analytic, so this needs
//! no depth buffer and is exact at any resolution. The ray is cast a little beside the line, inside the
//! surface to which it belongs, because a ray through an edge itself may pass on either side.

use crate::camera::View;
use crate::media::march::gather;
use crate::resolved_scene::ResolvedScene;
use crate::shade::{Start, first_hit};
use crate::visible::Ray;
use glam::{DVec2, DVec3};

/// How far beside a line its surface is tested, voxels.
pub(super) const ASIDE: f64 = 0.02;
/// Points closer than this along a ray are the same, voxels.
const SAME: f64 = 0.05;
/// How far in front of a line on the ground another part of the ground must be to hide it, voxels; a line
/// touches the surface on which it lies.
pub(super) const IN_FRONT: f64 = 0.6;
/// Distance between two tested points of a line, pixels.
const STEP_PX: f64 = 2.0;
/// A part of a line that is shorter is no part, pixels: a stroke of it would be a dot, such as at a corner of the box that
/// is cut away.
const SHORTEST_PX: f64 = 0.25;
/// Bisections of the last step before a line disappears: 1/64 pixel.
const BISECTIONS: usize = 7;

/// How far in front of a point the first hit of the ray through its pixel lies, voxels. Negative if the ray
/// meets nothing in front of the point.
pub(super) fn covered_by(resolved: &ResolvedScene, p: DVec3) -> f64 {
    let view_ray = resolved.view.ray(resolved.view.project(p));
    let t = (p - view_ray.origin).dot(view_ray.direction);
    t - f64::from(first_hit(resolved, &Ray::from(view_ray), Start::OF_RAY).t())
}

/// Whether media or wells in front of a point hide lines there: the transmittance is below one half.
fn is_veiled(resolved: &ResolvedScene, p: DVec3) -> bool {
    let view_ray = resolved.view.ray(resolved.view.project(p));
    let t = (p - view_ray.origin).dot(view_ray.direction) - SAME;
    let ray = Ray::from(view_ray);
    if resolved.tubes.as_ref().is_some_and(|tubes| tubes.hit(&ray, t as f32).is_some()) {
        return true;
    }
    let Some(field) = &resolved.field else { return false };
    gather(field, None, &resolved.solid, &ray, [f32::MIN, t as f32]).transmittance < 0.5
}

/// Whether the surface of the block is at `p` and nothing is in front of it.
pub(super) fn is_seen(resolved: &ResolvedScene, p: DVec3) -> bool {
    covered_by(resolved, p).abs() < SAME && !is_veiled(resolved, p)
}

/// The parts of a polyline (voxels) for which `seen` holds, in pixels.
pub(super) fn seen_parts(view: &View, points: &[DVec3], seen: impl Fn(DVec3) -> bool) -> Vec<Vec<DVec2>> {
    let mut parts = Vec::new();
    let mut part: Vec<DVec2> = Vec::new();
    let Some(&first) = points.first() else { return parts };
    let mut last = (first, seen(first));
    if last.1 {
        part.push(view.project(first));
    }
    for &end in &points[1..] {
        let start = last.0;
        let steps = ((view.project(end) - view.project(start)).length() / STEP_PX).ceil().clamp(1.0, 1e5) as usize;
        for step in 1..=steps {
            let p = start.lerp(end, step as f64 / steps as f64);
            let here = (p, seen(p));
            if here.1 != last.1 {
                let border = if here.1 { bisect(here.0, last.0, &seen) } else { bisect(last.0, here.0, &seen) };
                part.push(view.project(border));
                if !here.1 {
                    parts.push(std::mem::take(&mut part));
                }
            }
            // A straight part needs its ends only.
            if here.1 && step == steps {
                part.push(view.project(p));
            }
            last = here;
        }
    }
    if part.len() > 1 {
        parts.push(part);
    }
    let length = |part: &[DVec2]| part.windows(2).map(|ends| ends[0].distance(ends[1])).sum::<f64>();
    parts.retain(|part| length(part) >= SHORTEST_PX);
    parts
}

/// The last visible point between a visible and a hidden one.
fn bisect(mut visible: DVec3, mut hidden: DVec3, seen: &impl Fn(DVec3) -> bool) -> DVec3 {
    for _ in 0..BISECTIONS {
        let middle = (visible + hidden) * 0.5;
        if seen(middle) { visible = middle } else { hidden = middle }
    }
    visible
}

#[cfg(test)]
mod tests;
