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
use crate::resolved_scene::{Flat, ResolvedInterpretation, ResolvedScene};
use crate::visible::{FaceHit, Ray, SolidSpan, TOUCH};
use crate::wells::WellHit;
use glam::{Vec3, Vec4};
use model::Region;
use std::iter::repeat_n;
use ttf::{linear_from_srgb, srgb_from_linear};

/// The points that stop rays.
pub(crate) fn stopping_points(resolved: &ResolvedScene, view_rays: &[ViewRay]) -> Points {
    let rays: Vec<Ray> = view_rays.iter().map(|ray| Ray::from(*ray)).collect();
    let hits = rays.iter().zip(starts(resolved, &rays)).map(|(ray, start)| stopping_hit(resolved, ray, start));
    Points::of(resolved, view_rays.iter().zip(hits))
}

/// The colours of what lies over the faces of the block, the ground or a well, on rays that are stopped by it.
pub(crate) fn over_rock(resolved: &ResolvedScene, view_rays: &[ViewRay]) -> Vec<Option<Vec3>> {
    let rays: Vec<Ray> = view_rays.iter().map(|ray| Ray::from(*ray)).collect();
    let hits = rays.iter().zip(starts(resolved, &rays)).map(|(ray, start)| stopping_hit(resolved, ray, start));
    let over: Vec<(&ViewRay, RayHit)> = view_rays.iter().zip(hits).collect();
    let is_over = |hit: &RayHit| matches!(hit, RayHit::Ground(_) | RayHit::Well(_));
    let stopped = over.iter().copied().filter(|(_, hit)| is_over(hit));
    let mut colours = Points::of(resolved, stopped).colours(resolved).into_iter().map(Vec4::truncate);
    over.iter().map(|(_, hit)| if is_over(hit) { colours.next() } else { None }).collect()
}

/// Straight RGBA of rays: of what stops each, and of what lies behind a ground that is not opaque. Fastest
/// for rays that are neighbours in the picture.
pub(crate) fn trace(resolved: &ResolvedScene, light: Option<&LightVolume>, view_rays: &[ViewRay]) -> Vec<Vec4> {
    let rays: Vec<Ray> = view_rays.iter().map(|ray| Ray::from(*ray)).collect();
    let segments: Vec<RaySegment> = view_rays
        .iter()
        .zip(rays.iter().zip(starts(resolved, &rays)))
        .map(|(view_ray, (ray, start))| RaySegment {
            view_ray,
            ray: *ray,
            hit: stopping_hit(resolved, ray, start),
            start: start.at,
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
            let hit = stopping_hit(resolved, &segment.ray, Start { at: after, ..Start::OF_RAY });
            behind.push(RaySegment { hit, start: ground.t, ..*segment });
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

/// Where a ray begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start {
    /// Distance before which nothing stops it, voxels.
    pub at: f32,
    /// Distance before which it is known to meet no rock, voxels.
    pub clear: f32,
}

impl Start {
    /// At the beginning of the ray, about which nothing is known.
    pub(crate) const OF_RAY: Self = Self { at: f32::MIN, clear: f32::MIN };
}

/// Where rays begin that are neighbours in the picture, pixel by pixel: all of them pass the air together, then those of
/// each pixel.
fn starts(resolved: &ResolvedScene, rays: &[Ray]) -> Vec<Start> {
    let (Some(relief), Some(interpretation)) = (&resolved.relief, resolved.interpretation) else {
        return vec![Start::OF_RAY; rays.len()];
    };
    let in_block = |ray: &Ray| resolved.solid.box_interval(ray).unwrap_or([f32::MAX, f32::MIN]);
    let wider = |[a, b]: [f32; 2], [c, d]: [f32; 2]| [a.min(c), b.max(d)];
    let [enter, exit] = rays.iter().map(in_block).fold([f32::MAX, f32::MIN], wider);
    let clear = |rays: &[Ray], from: f32| relief.clear_until(interpretation.model, rays, [from, exit]);
    let of_all = clear(rays, enter);
    let per_pixel = (resolved.scene.samples * resolved.scene.samples) as usize;
    let of_pixel = |rays: &[Ray]| if rays.len() > 1 { clear(rays, of_all) } else { of_all };
    let start = |rays: &[Ray]| repeat_n(Start { clear: of_pixel(rays), ..Start::OF_RAY }, rays.len());
    rays.chunks(per_pixel).flat_map(start).collect()
}

/// What stops a ray in this scene: a well, a face of the block or of a cut-out,
/// the ground, or nothing.
pub(crate) fn stopping_hit(resolved: &ResolvedScene, ray: &Ray, start: Start) -> RayHit {
    let hit = stopping_rock(resolved, ray, start);
    match resolved.tubes.as_ref().and_then(|tubes| tubes.hit(ray, hit.t())) {
        Some(well) if well.t > start.at => RayHit::Well(well),
        _ => hit,
    }
}

fn stopping_rock(resolved: &ResolvedScene, ray: &Ray, start: Start) -> RayHit {
    match resolved.scene.media.faces {
        Faces::All => first_hit(resolved, ray, start),
        Faces::None => RayHit::Background,
        Faces::CutOuts => {
            let Some([enter, _]) = resolved.solid.box_interval(ray) else { return RayHit::Background };
            let mut from = start.at;
            for _ in 0..=resolved.solid.cut_outs.len() + 1 {
                let Some(span) = resolved.solid.next_span(ray, from) else { return RayHit::Background };
                let front = span.entry.t <= enter + TOUCH;
                match through_air(resolved, ray, &span, start.clear) {
                    Some(Some(ground)) => return RayHit::Ground(ground),
                    None if !front => return RayHit::Face(span.entry),
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
    pub(crate) fn t(&self) -> f32 {
        match self {
            Self::Background => f32::INFINITY,
            Self::Face(hit) => hit.t,
            Self::Ground(hit) => hit.t,
            Self::Well(hit) => hit.t,
        }
    }
}

/// The first face of rock, or the ground if that face lies in air.
pub(crate) fn first_hit(resolved: &ResolvedScene, ray: &Ray, start: Start) -> RayHit {
    let mut from = start.at;
    for _ in 0..=resolved.solid.cut_outs.len() + 1 {
        let Some(span) = resolved.solid.next_span(ray, from) else { return RayHit::Background };
        match through_air(resolved, ray, &span, start.clear) {
            None => return RayHit::Face(span.entry),
            Some(Some(ground)) => return RayHit::Ground(ground),
            Some(None) => from = span.end,
        }
    }
    RayHit::Background
}

/// The ground that a ray meets in a stretch of the block that begins in air, if any; `None` if it begins in rock. Before
/// the distance `clear` there is air.
fn through_air(resolved: &ResolvedScene, ray: &Ray, span: &SolidSpan, clear: f32) -> Option<Option<GroundHit>> {
    let (relief, model) = (resolved.relief.as_ref()?, resolved.interpretation?.model);
    if span.entry.t >= clear && !relief.is_air(model, span.entry.point) {
        return None;
    }
    let from = span.entry.t.max(clear);
    Some((from < span.end).then(|| relief.march(model, ray, from, span.end)).flatten())
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
    pub(crate) fn flat_at(&self, p: Vec3, region: Option<Region>) -> (param::FlatPoint, [[f32; 3]; 3]) {
        match self.flat {
            Flat::Exact(param) => param.lookup_in(self.model, p, region.unwrap_or_else(|| self.model.region_at(p))),
            Flat::Packed(packed) => packed.lookup_extrapolated_jacobian(p),
        }
    }
}
