//! The colour of a ray: the media along it, and the point that stops it. That point gets its colour from its
//! region, flat coordinates, texture, scalar functions and raw data (P-illus 3.5, 4, 5).
//!
//! The footprint of a pixel on the plane of a face is exact. With ray `o + t·d` and plane normal n, a step of
//! the pixel moves the hit by `∂p = ∂o + t·∂d + ∂t·d`, `∂t = −n·(∂o + t·∂d)/(n·d)`; the Jacobian of (i, j, k)
//! maps it to flat space.

use crate::camera::ViewRay;
use crate::distortion;
use crate::ground::GroundHit;
use crate::inputs::NamedVolume;
use crate::leaves::{FaceData, cover, distance_tone, leaf_colour};
use crate::media::Faces;
use crate::media::bundle::gather_all;
use crate::media::light::LightVolume;
use crate::resolved::{Flat, ResolvedInterpretation, ResolvedScene};
use crate::visible::{FaceHit, Ray, TOUCH};
use crate::wells::WellHit;
use glam::{Vec3, Vec4};
use model::Region;
use ttf::{FlatFootprint, LayerPoint, ShadePoint, linear_from_srgb, srgb_from_linear};

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
    let behind = |segment: &RaySegment| match segment.hit {
        RayHit::Background => Vec4::from_array(resolved.background),
        RayHit::Face(hit) => face_colour(resolved, segment.view_ray, &hit).extend(1.0),
        RayHit::Ground(hit) => {
            ground_colour(resolved, &hit).extend(resolved.relief.as_ref().map_or(1.0, |r| r.opacity))
        }
        RayHit::Well(hit) => hit.colour.extend(1.0),
    };
    let Some(field) = &resolved.field else { return segments.iter().map(behind).collect() };
    let rays: Vec<(Ray, [f32; 2])> =
        segments.iter().map(|segment| (segment.ray, [segment.start, segment.hit.t()])).collect();
    let gathered = gather_all(field, light, &resolved.solid, &rays);
    let colours = segments.iter().zip(gathered).map(|(segment, gathered)| {
        let behind = behind(segment);
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

/// The colour of a point of a face.
pub(crate) fn face_colour(resolved: &ResolvedScene, view_ray: &ViewRay, hit: &FaceHit) -> Vec3 {
    if resolved.scene.face_data == FaceData::Distortion
        && let Some(interpretation) = resolved.interpretation
    {
        return distortion::colour_at(resolved, &interpretation, hit);
    }
    let scalars = scalar_values(resolved, hit.point);
    let face = resolved.frame(&hit.plane);
    let point = match resolved.interpretation.filter(|_| resolved.illustrated) {
        None => ShadePoint {
            flat: LayerPoint { i: f32::NAN, j: f32::NAN, k: f32::NAN, layer: 0 },
            footprint: FlatFootprint::default(),
            face,
            grad_k: [0.0; 3],
        },
        Some(interpretation) => {
            let (flat, jacobian) = interpretation.flat_at(hit.point, None);
            let step = |n: usize| {
                let shift = pixel_shift(view_ray, hit, n) / resolved.scene.samples as f32;
                jacobian.map(|row| Vec3::from_array(row).dot(shift))
            };
            ShadePoint {
                flat: LayerPoint { i: flat.i, j: flat.j, k: flat.k, layer: u32::from(flat.region.layer) },
                footprint: FlatFootprint { dx: step(0), dy: step(1) },
                face,
                grad_k: (Vec3::from_array(jacobian[2]) / resolved.voxel_m).to_array(),
            }
        }
    };
    let rock = Vec4::from_array(ttf::shade(&resolved.tables, &point, &scalars)).truncate();
    with_candidates(resolved, hit.point, rock) * resolved.tone(&hit.plane)
}

/// The colour of a face, with horizon candidates if the scene shows them.
fn with_candidates(resolved: &ResolvedScene, p: Vec3, rock: Vec3) -> Vec3 {
    let Some(candidates) = &resolved.candidates else { return rock };
    let distance = candidates.distance_at(p);
    if resolved.scene.face_data == FaceData::Distance {
        return Vec3::splat(distance_tone(distance));
    }
    match candidates.group(candidates.leaf_at(p)) {
        0 => rock,
        group => rock.lerp(leaf_colour(group), cover(distance)),
    }
}

/// The colour of the ground: the average of the texture just below it, hill-shaded and blended with the raw
/// data (P-illus 5, 5.2).
fn ground_colour(resolved: &ResolvedScene, hit: &GroundHit) -> Vec3 {
    let (Some(relief), Some(interpretation)) = (&resolved.relief, resolved.interpretation) else {
        unreachable!("only a scene with a ground has hits of it")
    };
    let region = hit.region;
    let (layer, k) = if resolved.illustrated {
        let (flat, _) = interpretation.flat_at(hit.point, Some(region));
        (flat.region.layer, flat.k)
    } else {
        (region.layer, 1.0)
    };
    let average = Vec3::from_array(resolved.tables.average_colour(u32::from(layer), k));
    let lit = (average * relief.shade(hit.normal)).min(Vec3::ONE);
    let slot = resolved.tables.globals.raw_volume as usize;
    let value = resolved.volumes.get(slot).copied().flatten().map_or(f32::NAN, |volume| volume.sample(hit.point));
    Vec3::from_array(ttf::blend_raw(&resolved.tables, lit.to_array(), value))
}

/// The change of the hit on its plane for a step of one pixel to the right (n = 0) or down (n = 1), voxels.
pub(crate) fn pixel_shift(ray: &ViewRay, hit: &FaceHit, n: usize) -> Vec3 {
    let drift = ray.origin_step[n] + ray.direction_step[n] * f64::from(hit.t);
    let normal = hit.plane.normal.as_dvec3();
    let slide = -normal.dot(drift) / normal.dot(ray.direction);
    (drift + ray.direction * slide).as_vec3()
}

fn scalar_values(resolved: &ResolvedScene, p: Vec3) -> Vec<f32> {
    let sample = |volume: &Option<NamedVolume>| volume.map_or(f32::NAN, |volume| volume.sample(p));
    resolved.volumes.iter().map(sample).collect()
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
