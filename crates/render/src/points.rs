//! The points that stop rays, as far as they do not depend on colours and patterns, and their colours.
//!
//! A point is found once: where the ray hits, its layer, its flat coordinates (i, j, k) and how these change over a
//! pixel. After a change of style alone, points that were kept ([`crate::kept_points`]) are coloured again, by the same
//! function that colours them first, so the picture is the same bit by bit.
//!
//! A point of a face gets its colour from its region, flat coordinates, texture, scalar functions and raw data (P-illus
//! 3.5, 4, 5).

use crate::camera::ViewRay;
use crate::distortion;
use crate::face_map::FaceMap;
use crate::ground::GroundHit;
use crate::inputs::NamedVolume;
use crate::leaves::{FaceData, cover, distance_tone, leaf_colour};
use crate::resolved_scene::ResolvedScene;
use crate::shade::{RayHit, pixel_shift};
use crate::visible::FaceHit;
use glam::{Vec3, Vec4};
use survey::block::BodyPlane;
use ttf::{FaceFrame, FlatFootprint, LayerPoint, MappingWeights, ShadePoint};

/// Points of rays that are neighbours in the picture.
#[derive(Debug, Default)]
pub(crate) struct Points {
    /// The planes on which they lie.
    planes: Vec<(BodyPlane, FaceMap)>,
    points: Vec<SurfacePoint>,
}

#[derive(Debug, Clone, Copy)]
enum SurfacePoint {
    Background,
    Face(FacePoint),
    Ground(GroundPoint),
    /// A colour that no style changes.
    Fixed(Vec3),
}

/// A point of a face.
#[derive(Debug, Clone, Copy)]
struct FacePoint {
    point: Vec3,
    plane: u16,
    layer: u16,
    /// (i, j, k); NaN where no illustration is visible.
    flat: [f32; 3],
    footprint: FlatFootprint,
    /// Of the mappings of the face.
    weights: MappingWeights,
}

/// A point of the ground.
#[derive(Debug, Clone, Copy)]
struct GroundPoint {
    point: Vec3,
    layer: u16,
    k: f32,
    /// Factor of the hill shading.
    shade: f32,
}

/// Memory that a point takes, bytes.
pub(crate) const POINT_BYTES: usize = size_of::<SurfacePoint>();

impl Points {
    /// The points of hits.
    pub(crate) fn of<'r>(resolved: &ResolvedScene, hits: impl Iterator<Item = (&'r ViewRay, RayHit)>) -> Self {
        let mut planes = Vec::new();
        let points = hits
            .map(|(ray, hit)| match hit {
                RayHit::Background => SurfacePoint::Background,
                RayHit::Face(hit) => face_point(resolved, ray, &hit, &mut planes),
                RayHit::Ground(hit) => ground_point(resolved, &hit),
                RayHit::Well(hit) => SurfacePoint::Fixed(hit.colour),
            })
            .collect();
        Self { planes, points }
    }

    /// Straight RGBA of the points.
    pub(crate) fn colours(&self, resolved: &ResolvedScene) -> Vec<Vec4> {
        let planes: Vec<(FaceFrame, f32)> =
            self.planes.iter().map(|(plane, _)| (resolved.frame(plane), resolved.tone(plane))).collect();
        let opacity = resolved.relief.as_ref().map_or(1.0, |relief| relief.opacity);
        let mut scalars = vec![f32::NAN; resolved.volumes.len()];
        let colour = |point: &SurfacePoint| match point {
            SurfacePoint::Background => Vec4::from_array(resolved.background),
            SurfacePoint::Fixed(colour) => colour.extend(1.0),
            SurfacePoint::Ground(point) => ground_colour(resolved, point).extend(opacity),
            SurfacePoint::Face(point) => {
                let (frame, tone) = planes[usize::from(point.plane)];
                face_colour(resolved, point, frame, &mut scalars).extend(1.0) * Vec4::new(tone, tone, tone, 1.0)
            }
        };
        self.points.iter().map(colour).collect()
    }

    /// The same without the points, where all of them are background.
    pub(crate) fn packed(mut self) -> Self {
        if self.points.iter().all(|point| matches!(point, SurfacePoint::Background)) {
            self.points = Vec::new();
        }
        self.points.shrink_to_fit();
        self
    }
}

fn face_point(
    resolved: &ResolvedScene,
    ray: &ViewRay,
    hit: &FaceHit,
    planes: &mut Vec<(BodyPlane, FaceMap)>,
) -> SurfacePoint {
    if resolved.scene.face_data == FaceData::Distortion
        && let Some(interpretation) = resolved.interpretation
    {
        return SurfacePoint::Fixed(distortion::colour_at(resolved, &interpretation, hit));
    }
    let plane = planes.iter().position(|(known, _)| *known == hit.plane).unwrap_or_else(|| {
        planes.push((hit.plane, resolved.face_map(&hit.plane)));
        planes.len() - 1
    });
    let map = planes[plane].1;
    let plane = plane as u16;
    let Some(interpretation) = resolved.interpretation.filter(|_| resolved.illustrated) else {
        let footprint = FlatFootprint::default();
        let (flat, weights) = ([f32::NAN; 3], MappingWeights::ALONG);
        return SurfacePoint::Face(FacePoint { point: hit.point, plane, layer: 0, flat, footprint, weights });
    };
    let (flat, jacobian) = interpretation.flat_at(hit.point, None);
    let step = |n: usize| {
        let shift = pixel_shift(ray, hit, n) / resolved.scene.samples as f32;
        jacobian.map(|row| Vec3::from_array(row).dot(shift))
    };
    SurfacePoint::Face(FacePoint {
        point: hit.point,
        plane,
        layer: flat.region.layer,
        flat: [flat.i, flat.j, flat.k],
        footprint: FlatFootprint { dx: step(0), dy: step(1) },
        weights: map.weights(&resolved.tables, flat.region.layer, &jacobian),
    })
}

/// The colour of a point of a face, without the tone of the face; `scalars` has room for a value of each volume.
fn face_colour(resolved: &ResolvedScene, point: &FacePoint, face: FaceFrame, scalars: &mut [f32]) -> Vec3 {
    for (value, volume) in scalars.iter_mut().zip(&resolved.volumes) {
        *value = sampled(volume.as_ref(), point.point);
    }
    let [i, j, k] = point.flat;
    let flat = LayerPoint { i, j, k, layer: u32::from(point.layer) };
    let shaded = ShadePoint { flat, footprint: point.footprint, face, weights: point.weights };
    let rock = Vec4::from_array(ttf::shade(&resolved.tables, &shaded, scalars)).truncate();
    with_candidates(resolved, point.point, rock)
}

fn sampled(volume: Option<&NamedVolume>, p: Vec3) -> f32 {
    volume.map_or(f32::NAN, |volume| volume.sample(p))
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

fn ground_point(resolved: &ResolvedScene, hit: &GroundHit) -> SurfacePoint {
    let (Some(relief), Some(interpretation)) = (&resolved.relief, resolved.interpretation) else {
        unreachable!("only a scene with a ground has hits of it")
    };
    let (layer, k) = if resolved.illustrated {
        let (flat, _) = interpretation.flat_at(hit.point, Some(hit.region));
        (flat.region.layer, flat.k)
    } else {
        (hit.region.layer, 1.0)
    };
    SurfacePoint::Ground(GroundPoint { point: hit.point, layer, k, shade: relief.shade(hit.normal) })
}

/// The colour of the ground: the average of the texture just below it, hill-shaded and blended with the raw
/// data (P-illus 5, 5.2).
fn ground_colour(resolved: &ResolvedScene, ground: &GroundPoint) -> Vec3 {
    let average = Vec3::from_array(resolved.tables.average_colour(u32::from(ground.layer), ground.k));
    let lit = (average * ground.shade).min(Vec3::ONE);
    let slot = resolved.tables.globals.raw_volume as usize;
    let value = sampled(resolved.volumes.get(slot).and_then(Option::as_ref), ground.point);
    Vec3::from_array(ttf::blend_raw(&resolved.tables, lit.to_array(), value))
}
