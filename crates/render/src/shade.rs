//! The colour of a ray: the media along it, and the point that stops it, whose colour is that of [`crate::points`].
//!
//! The footprint of a pixel on the plane of a face is exact. With ray `o + t·d` and plane normal n, a step of
//! the pixel moves the hit by `∂p = ∂o + t·∂d + ∂t·d`, `∂t = −n·(∂o + t·∂d)/(n·d)`; the Jacobian of (i, j, k)
//! maps it to flat space.

use crate::camera::ViewRay;
use crate::ground::GroundHit;
use crate::media::Faces;
use crate::media::bundle::gather_all;
use crate::media::light::LightVolume;
use crate::points::Points;
use crate::resolved::{Flat, ResolvedInterpretation, ResolvedScene};
use crate::visible::{FaceHit, Ray, TOUCH};
use crate::wells::WellHit;
use glam::{Vec3, Vec4};
use model::Region;
use ttf::{linear_from_srgb, srgb_from_linear};

/// The points that stop rays.
pub(crate) fn stopping_points(resolved: &ResolvedScene, view_rays: &[ViewRay]) -> Points {
    let hits = view_rays.iter().map(|ray| (ray, stopping_hit(resolved, &Ray::from(*ray), f32::MIN)));
    Points::of(resolved, hits)
}

/// Straight RGBA of rays: of what stops each, and of what lies behind a ground that is not opaque. Fastest
/// for rays that are neighbours in the picture.
pub(crate) fn trace(resolved: &ResolvedScene, light: Option<&LightVolume>, view_rays: &[ViewRay]) -> Vec<Vec4> {
    let segments: Vec<RaySegment> = view_rays
        .iter()
        .map(|view_ray| {
            let ray = Ray::from(*view_ray);
            RaySegment { view_ray, ray, hit: stopping_hit(resolved, &ray, f32::MIN), start: f32::MIN }
        })
        .collect();
    let mut colours = seen(resolved, light, &segments);
    let mut through = Vec::new();
    let mut behind = Vec::new();
    for (n, segment) in segments.iter().enumerate() {
        if let RayHit::Ground(ground) = segment.hit
            && colours[n].w < 1.0
        {
            let after = resolved.solid.next_span(&segment.ray, ground.t).map_or(f32::INFINITY, |span| span.end);
            through.push(n);
            behind.push(RaySegment { hit: stopping_hit(resolved, &segment.ray, after), start: ground.t, ..*segment });
        }
    }
    for (n, behind) in through.into_iter().zip(seen(resolved, light, &behind)) {
        let front = colours[n];
        let rest = behind.w * (1.0 - front.w);
        let alpha = front.w + rest;
        let sum = linear(front.truncate()) * front.w + linear(behind.truncate()) * rest;
        colours[n] = encoded(sum / alpha.max(1e-6)).extend(alpha);
    }
    colours
}

/// A ray from `start` to what stops it.
#[derive(Clone, Copy)]
struct RaySegment<'r> {
    view_ray: &'r ViewRay,
    ray: Ray,
    hit: RayHit,
    start: f32,
}

/// Straight RGBA of hits, with the media in front of them.
fn seen(resolved: &ResolvedScene, light: Option<&LightVolume>, segments: &[RaySegment]) -> Vec<Vec4> {
    let hits = segments.iter().map(|segment| (segment.view_ray, segment.hit));
    let behind = Points::of(resolved, hits).colours(resolved);
    let Some(field) = &resolved.field else { return behind };
    let rays: Vec<(Ray, [f32; 2])> =
        segments.iter().map(|segment| (segment.ray, [segment.start, segment.hit.t()])).collect();
    let gathered = gather_all(field, light, &resolved.solid, &rays);
    let colours = segments.iter().zip(behind).zip(gathered).map(|((segment, behind), gathered)| {
        let lit = light.filter(|_| segment.hit.t().is_finite()).map(|light| light.at(segment.ray.at(segment.hit.t())));
        if gathered.transmittance == 1.0 && lit.is_none_or(|lit| lit == Vec3::ONE) {
            return behind;
        }
        let far = linear(behind.truncate()) * lit.unwrap_or(Vec3::ONE);
        // Composited as premultiplied colour, then converted to straight colour.
        let sum = gathered.colour + far * (behind.w * gathered.transmittance);
        let alpha = 1.0 - gathered.transmittance * (1.0 - behind.w);
        encoded(sum / alpha.max(1e-6)).extend(alpha)
    });
    colours.collect()
}

pub(crate) fn linear(encoded: Vec3) -> Vec3 {
    Vec3::from_array(encoded.to_array().map(linear_from_srgb))
}

pub(crate) fn encoded(linear: Vec3) -> Vec3 {
    let coded = |c: f32| srgb_from_linear(c.clamp(0.0, 1.0));
    // Grey values, as of white media, take one power instead of three.
    if linear.x == linear.y && linear.y == linear.z {
        return Vec3::splat(coded(linear.x));
    }
    Vec3::from_array(linear.to_array().map(coded))
}

/// What stops a ray in this scene at or after distance `start`: a well, a face of the block or of a cut-out,
/// the ground, or nothing.
pub(crate) fn stopping_hit(resolved: &ResolvedScene, ray: &Ray, start: f32) -> RayHit {
    let hit = stopping_rock(resolved, ray, start);
    match resolved.tubes.as_ref().and_then(|tubes| tubes.hit(ray, hit.t())) {
        Some(well) if well.t > start => RayHit::Well(well),
        _ => hit,
    }
}

fn stopping_rock(resolved: &ResolvedScene, ray: &Ray, start: f32) -> RayHit {
    match resolved.scene.media.faces {
        Faces::All => first_hit(resolved, ray, start),
        Faces::None => RayHit::Background,
        Faces::CutOuts => {
            let Some([enter, _]) = resolved.solid.box_interval(ray) else { return RayHit::Background };
            let mut from = start;
            for _ in 0..=resolved.solid.cut_outs.len() + 1 {
                let Some(span) = resolved.solid.next_span(ray, from) else { return RayHit::Background };
                let front = span.entry.t <= enter + TOUCH;
                match (&resolved.relief, resolved.interpretation) {
                    (Some(relief), Some(interpretation)) if relief.is_air(interpretation.model, span.entry.point) => {
                        if let Some(hit) = relief.march(interpretation.model, ray, span.entry.t, span.end) {
                            return RayHit::Ground(hit);
                        }
                    }
                    _ if !front => return RayHit::Face(span.entry),
                    _ => {}
                }
                from = span.end;
            }
            RayHit::Background
        }
    }
}

/// What stops a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RayHit {
    Background,
    Face(FaceHit),
    Ground(GroundHit),
    Well(WellHit),
}

impl RayHit {
    /// Distance along the ray, voxels; infinite for the background.
    pub fn t(&self) -> f32 {
        match self {
            Self::Background => f32::INFINITY,
            Self::Face(hit) => hit.t,
            Self::Ground(hit) => hit.t,
            Self::Well(hit) => hit.t,
        }
    }
}

/// The first face of rock at or after distance `start`, or the ground if that face lies in air.
pub(crate) fn first_hit(resolved: &ResolvedScene, ray: &Ray, start: f32) -> RayHit {
    let mut from = start;
    for _ in 0..=resolved.solid.cut_outs.len() + 1 {
        let Some(span) = resolved.solid.next_span(ray, from) else { return RayHit::Background };
        let (Some(relief), Some(ResolvedInterpretation { model, .. })) = (&resolved.relief, resolved.interpretation)
        else {
            return RayHit::Face(span.entry);
        };
        if !relief.is_air(model, span.entry.point) {
            return RayHit::Face(span.entry);
        }
        if let Some(hit) = relief.march(model, ray, span.entry.t, span.end) {
            return RayHit::Ground(hit);
        }
        from = span.end;
    }
    RayHit::Background
}

/// The change of the hit on its plane for a step of one pixel to the right (n = 0) or down (n = 1), voxels.
pub(crate) fn pixel_shift(ray: &ViewRay, hit: &FaceHit, n: usize) -> Vec3 {
    let drift = ray.origin_step[n] + ray.direction_step[n] * f64::from(hit.t);
    let normal = hit.plane.normal.as_dvec3();
    let slide = -normal.dot(drift) / normal.dot(ray.direction);
    (drift + ray.direction * slide).as_vec3()
}

impl ResolvedInterpretation<'_> {
    /// Flat coordinates and their Jacobian per voxel. The exact lookup uses the given region, or looks it up
    /// in the model.
    pub fn flat_at(&self, p: Vec3, region: Option<Region>) -> (param::FlatPoint, [[f32; 3]; 3]) {
        match self.flat {
            Flat::Exact(param) => param.lookup_in(self.model, p, region.unwrap_or_else(|| self.model.region_at(p))),
            Flat::Packed(packed) => packed.lookup_extrapolated_jacobian(p),
        }
    }
}
