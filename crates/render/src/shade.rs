//! The colour of a visible point: region, flat coordinates, texture, scalar stack, raw data (P-illus 3.5, 4, 5).
//!
//! The pixel's footprint on the plane of a face is exact: with ray `o + t·d` and plane normal n, a step of the pixel moves the hit by
//! `∂p = ∂o + t·∂d + ∂t·d`, `∂t = −n·(∂o + t·∂d)/(n·d)`; the Jacobian of (i, j, k) takes it to flat space.

use crate::camera::ViewRay;
use crate::frame::{Flat, Frame, Rock};
use crate::ground::GroundHit;
use crate::inputs::NamedVolume;
use crate::visible::{FaceHit, Ray};
use glam::{Vec3, Vec4};
use survey::model::Region;
use ttf::{FaceFrame, FlatFootprint, FlatPoint, ShadePoint};

/// Straight RGBA along one ray.
pub(crate) fn trace(frame: &Frame, view_ray: &ViewRay) -> Vec4 {
    match first_hit(frame, &Ray::from(*view_ray)) {
        Hit::Background => Vec4::from_array(frame.scene.background.rgba()),
        Hit::Face(hit) => face_colour(frame, view_ray, &hit).extend(1.0),
        Hit::Ground(hit) => ground_colour(frame, &hit).extend(1.0),
    }
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hit {
    Background,
    Face(FaceHit),
    Ground(GroundHit),
}

impl Hit {
    /// Distance along the ray, voxels; infinite for the background.
    pub fn t(&self) -> f32 {
        match self {
            Self::Background => f32::INFINITY,
            Self::Face(hit) => hit.t,
            Self::Ground(hit) => hit.t,
        }
    }
}

/// The first face of rock, or the ground behind faces of air.
pub(crate) fn first_hit(frame: &Frame, ray: &Ray) -> Hit {
    let mut from = f32::MIN;
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
    Vec4::from_array(ttf::shade(&frame.tables, &point, &scalars)).truncate() * frame.tones[hit.axis]
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
