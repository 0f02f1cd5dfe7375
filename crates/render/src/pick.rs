//! What is under a pixel (P-horiz 5.3): the first place that is not clear, and everything known about it.
//!
//! The same ray as the picture's: the media it passes first, then the face, ground or well that stops it. On the CPU, since it is one ray.

use crate::error::RenderError;
use crate::frame::Frame;
use crate::inputs::Inputs;
use crate::media::march::first_seen;
use crate::media::prepared::Preparations;
use crate::scene::Scene;
use crate::shade::{Hit, stopping_hit};
use crate::visible::Ray;
use glam::{DVec2, Vec3};
use model::Region;

/// What was hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Picked {
    /// A medium or a horizon in it.
    Medium,
    /// A face of rock.
    Face,
    /// The ground.
    Ground,
    /// A well, by its number.
    Well(usize),
}

/// A place under a pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Pick {
    /// What was hit.
    pub what: Picked,
    /// Where, voxels.
    pub voxel: Vec3,
    /// The nearest sample's leaf among the horizon candidates; absent without candidates or where there is none.
    pub leaf: Option<u32>,
    /// Distance to that candidate, voxels.
    pub leaf_distance: Option<f32>,
    /// Layer and block; absent without an interpretation.
    pub region: Option<Region>,
    /// Values of all volumes there, in their order; NaN where they have none.
    pub values: Vec<f32>,
}

/// The first place that shows under a pixel position (x right, y down, pixel centres at halves); `None` for the background.
///
/// # Errors
/// A scene without a picture, or missing inputs.
pub fn pick(scene: &Scene, inputs: &Inputs, pixel: DVec2) -> Result<Option<Pick>, RenderError> {
    let frame = Frame::new(scene, inputs, &mut Preparations::default())?;
    let ray = Ray::from(frame.view.ray(pixel));
    let hit = stopping_hit(&frame, &ray, f32::MIN);
    let seen = frame.field.as_ref().and_then(|field| first_seen(field, &frame.solid, &ray, hit.t()));
    let (what, t) = match (seen, hit) {
        (Some((t, _)), _) => (Picked::Medium, t),
        (None, Hit::Background) => return Ok(None),
        (None, Hit::Face(hit)) => (Picked::Face, hit.t),
        (None, Hit::Ground(hit)) => (Picked::Ground, hit.t),
        (None, Hit::Well(hit)) => (Picked::Well(hit.well), hit.t),
    };
    let voxel = ray.at(t);
    let leaf = inputs.candidates.map(|c| c.leaf_at(voxel)).filter(|leaf| *leaf != 0);
    Ok(Some(Pick {
        what,
        voxel,
        leaf,
        leaf_distance: inputs.candidates.filter(|_| leaf.is_some()).map(|c| c.distance_at(voxel)),
        region: inputs.model.map(|model| model.region_at(voxel)),
        values: inputs.volumes.iter().map(|volume| volume.sample(voxel)).collect(),
    }))
}
