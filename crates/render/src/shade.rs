//! What a ray shows: the media it passes, and the colour of the point that stops it: region, flat coordinates, texture, scalar stack, raw data (P-illus 3.5, 4, 5).
//!
//! The pixel's footprint on the plane of a face is exact: with ray `o + t·d` and plane normal n, a step of the pixel moves the hit by
//! `∂p = ∂o + t·∂d + ∂t·d`, `∂t = −n·(∂o + t·∂d)/(n·d)`; the Jacobian of (i, j, k) takes it to flat space.

use crate::camera::ViewRay;
use crate::frame::{Flat, Frame, Rock};
use crate::ground::GroundHit;
use crate::inputs::NamedVolume;
use crate::leaves::{FaceData, cover, distance_tone, leaf_colour};
use crate::media::Faces;
use crate::media::bundle::gather_all;
use crate::media::light::LightVolume;
use crate::visible::{FaceHit, Ray, TOUCH};
use crate::wells::WellHit;
use glam::{Vec3, Vec4};
use model::Region;
use ttf::{FaceFrame, FlatFootprint, FlatPoint, ShadePoint, linear_from_srgb, srgb_from_linear};

/// Straight RGBA along rays: what stops each, and what is behind ground that lets light through. Quickest for neighbours in the picture.
pub(crate) fn trace(frame: &Frame, light: Option<&LightVolume>, view_rays: &[ViewRay]) -> Vec<Vec4> {
    let looks: Vec<Look> = view_rays
        .iter()
        .map(|view_ray| {
            let ray = Ray::from(*view_ray);
            Look { view_ray, ray, hit: stopping_hit(frame, &ray, f32::MIN), start: f32::MIN }
        })
        .collect();
    let mut colours = seen(frame, light, &looks);
    let mut through = Vec::new();
    let mut behind = Vec::new();
    for (n, look) in looks.iter().enumerate() {
        if let Hit::Ground(ground) = look.hit
            && colours[n].w < 1.0
        {
            let after = frame.solid.next_span(&look.ray, ground.t).map_or(f32::INFINITY, |span| span.end);
            through.push(n);
            behind.push(Look { hit: stopping_hit(frame, &look.ray, after), start: ground.t, ..*look });
        }
    }
    for (n, behind) in through.into_iter().zip(seen(frame, light, &behind)) {
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
struct Look<'r> {
    view_ray: &'r ViewRay,
    ray: Ray,
    hit: Hit,
    start: f32,
}

/// Straight RGBA of hits with the media in front of them.
fn seen(frame: &Frame, light: Option<&LightVolume>, looks: &[Look]) -> Vec<Vec4> {
    let behind = |look: &Look| match look.hit {
        Hit::Background => Vec4::from_array(frame.background),
        Hit::Face(hit) => face_colour(frame, look.view_ray, &hit).extend(1.0),
        Hit::Ground(hit) => ground_colour(frame, &hit).extend(frame.relief.as_ref().map_or(1.0, |r| r.opacity)),
        Hit::Well(hit) => hit.colour.extend(1.0),
    };
    let Some(field) = &frame.field else { return looks.iter().map(behind).collect() };
    let rays: Vec<(Ray, [f32; 2])> = looks.iter().map(|look| (look.ray, [look.start, look.hit.t()])).collect();
    let gathered = gather_all(field, light, &frame.solid, &rays);
    let colours = looks.iter().zip(gathered).map(|(look, gathered)| {
        let behind = behind(look);
        let lit = light.filter(|_| look.hit.t().is_finite()).map(|light| light.at(look.ray.at(look.hit.t())));
        if gathered.passes == 1.0 && lit.is_none_or(|lit| lit == Vec3::ONE) {
            return behind;
        }
        let far = linear(behind.truncate()) * lit.unwrap_or(Vec3::ONE);
        // Premultiplied by what is covered, then straight again.
        let sum = gathered.colour + far * (behind.w * gathered.passes);
        let alpha = 1.0 - gathered.passes * (1.0 - behind.w);
        encoded(sum / alpha.max(1e-6)).extend(alpha)
    });
    colours.collect()
}

pub(crate) fn linear(encoded: Vec3) -> Vec3 {
    Vec3::from_array(encoded.to_array().map(linear_from_srgb))
}

pub(crate) fn encoded(linear: Vec3) -> Vec3 {
    let coded = |c: f32| srgb_from_linear(c.clamp(0.0, 1.0));
    // Grey, as white media are throughout, takes one power in place of three.
    if linear.x == linear.y && linear.y == linear.z {
        return Vec3::splat(coded(linear.x));
    }
    Vec3::from_array(linear.to_array().map(coded))
}

/// What stops a ray in this scene at or after distance `start`: a well, or the first face or ground, one of the cut-outs' back faces or ground, or nothing.
pub(crate) fn stopping_hit(frame: &Frame, ray: &Ray, start: f32) -> Hit {
    let hit = stopping_rock(frame, ray, start);
    match frame.tubes.as_ref().and_then(|tubes| tubes.hit(ray, hit.t())) {
        Some(well) if well.t > start => Hit::Well(well),
        _ => hit,
    }
}

fn stopping_rock(frame: &Frame, ray: &Ray, start: f32) -> Hit {
    match frame.scene.media.faces {
        Faces::All => first_hit(frame, ray, start),
        Faces::None => Hit::Background,
        Faces::CutOuts => {
            let Some([enter, _]) = frame.solid.box_interval(ray) else { return Hit::Background };
            let mut from = start;
            for _ in 0..=frame.solid.cut_outs.len() + 1 {
                let Some(span) = frame.solid.next_span(ray, from) else { return Hit::Background };
                let front = span.entry.t <= enter + TOUCH;
                match (&frame.relief, frame.rock) {
                    (Some(relief), Some(rock)) if relief.is_air(rock.model, span.entry.point) => {
                        if let Some(hit) = relief.march(rock.model, ray, span.entry.t, span.end) {
                            return Hit::Ground(hit);
                        }
                    }
                    _ if !front => return Hit::Face(span.entry),
                    _ => {}
                }
                from = span.end;
            }
            Hit::Background
        }
    }
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hit {
    Background,
    Face(FaceHit),
    Ground(GroundHit),
    Well(WellHit),
}

impl Hit {
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

/// The first face of rock at or after distance `start`, or the ground behind faces of air.
pub(crate) fn first_hit(frame: &Frame, ray: &Ray, start: f32) -> Hit {
    let mut from = start;
    for _ in 0..=frame.solid.cut_outs.len() + 1 {
        let Some(span) = frame.solid.next_span(ray, from) else { return Hit::Background };
        let (Some(relief), Some(Rock { model, .. })) = (&frame.relief, frame.rock) else {
            return Hit::Face(span.entry);
        };
        if !relief.is_air(model, span.entry.point) {
            return Hit::Face(span.entry);
        }
        if let Some(hit) = relief.march(model, ray, span.entry.t, span.end) {
            return Hit::Ground(hit);
        }
        from = span.end;
    }
    Hit::Background
}

/// The colour of a point of a face of constant x, y or z.
fn face_colour(frame: &Frame, view_ray: &ViewRay, hit: &FaceHit) -> Vec3 {
    let scalars = scalar_values(frame, hit.point);
    let mut normal = [0.0; 3];
    normal[hit.axis] = 1.0;
    let point = match frame.rock.filter(|_| frame.illustrated) {
        None => ShadePoint {
            flat: FlatPoint { i: f32::NAN, j: f32::NAN, k: f32::NAN, layer: 0 },
            footprint: FlatFootprint::default(),
            face: FaceFrame::new(normal),
            grad_k: [0.0; 3],
        },
        Some(rock) => {
            let (flat, jacobian) = rock.flat_at(hit.point, None);
            let step = |n: usize| {
                let shift = pixel_shift(view_ray, hit, n) / frame.scene.samples as f32;
                jacobian.map(|row| Vec3::from_array(row).dot(shift))
            };
            ShadePoint {
                flat: FlatPoint { i: flat.i, j: flat.j, k: flat.k, layer: u32::from(flat.region.layer) },
                footprint: FlatFootprint { dx: step(0), dy: step(1) },
                face: FaceFrame::new(normal),
                grad_k: (Vec3::from_array(jacobian[2]) / frame.voxel_m).to_array(),
            }
        }
    };
    let rock = Vec4::from_array(ttf::shade(&frame.tables, &point, &scalars)).truncate();
    with_candidates(frame, hit.point, rock) * frame.tones[hit.axis]
}

/// The colour of a face with the candidates it is to show.
fn with_candidates(frame: &Frame, p: Vec3, rock: Vec3) -> Vec3 {
    let Some(candidates) = &frame.candidates else { return rock };
    let distance = candidates.distance_at(p);
    if frame.scene.face_data == FaceData::Distance {
        return Vec3::splat(distance_tone(distance));
    }
    match candidates.group(candidates.leaf_at(p)) {
        0 => rock,
        group => rock.lerp(leaf_colour(group), cover(distance)),
    }
}

/// The colour of the ground: the average of the texture just below it, hill-shaded, blended to the raw data (P-illus 5, 5.2).
fn ground_colour(frame: &Frame, hit: &GroundHit) -> Vec3 {
    let (Some(relief), Some(rock)) = (&frame.relief, frame.rock) else { return Vec3::ZERO };
    let region = hit.region;
    let (layer, k) = if frame.illustrated {
        let (flat, _) = rock.flat_at(hit.point, Some(region));
        (flat.region.layer, flat.k)
    } else {
        (region.layer, 1.0)
    };
    let average = Vec3::from_array(frame.tables.average_colour(u32::from(layer), k));
    let lit = (average * relief.shade(hit.normal)).min(Vec3::ONE);
    let slot = frame.tables.globals.raw_volume as usize;
    let value = frame.volumes.get(slot).copied().flatten().map_or(f32::NAN, |volume| volume.sample(hit.point));
    Vec3::from_array(ttf::blend_raw(&frame.tables, lit.to_array(), value))
}

/// The change of the hit on its plane for a step of one pixel to the right (0) or down (1), voxels.
fn pixel_shift(ray: &ViewRay, hit: &FaceHit, n: usize) -> Vec3 {
    let drift = ray.origin_step[n] + ray.direction_step[n] * f64::from(hit.t);
    let slide = -drift[hit.axis] / ray.direction[hit.axis];
    (drift + ray.direction * slide).as_vec3()
}

fn scalar_values(frame: &Frame, p: Vec3) -> Vec<f32> {
    let sample = |volume: &Option<NamedVolume>| volume.map_or(f32::NAN, |volume| volume.sample(p));
    frame.volumes.iter().map(sample).collect()
}

impl Rock<'_> {
    /// Flat coordinates and their Jacobian per voxel. The exact path takes the region that is known, or asks the model.
    pub fn flat_at(&self, p: Vec3, region: Option<Region>) -> (param::FlatPoint, [[f32; 3]; 3]) {
        match self.flat {
            Flat::Exact(param) => param.lookup_in(self.model, p, region.unwrap_or_else(|| self.model.region_at(p))),
            Flat::Packed(packed) => packed.lookup_extrapolated_jacobian(p),
        }
    }
}
