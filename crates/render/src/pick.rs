//! Identifies what is under a pixel (P-horiz 5.3): the first point that is not transparent, and what is known
//! about it.
//!
//! The ray is that of the picture: through the media, to the face, ground or well that stops it. A single ray
//! is traced on the CPU.

use crate::cache::Kept;
use crate::error::RenderError;
use crate::inputs::Inputs;
use crate::media::march::first_seen;
use crate::resolved_scene::ResolvedScene;
use crate::scene::Scene;
use crate::shade::{RayHit, Start, stopping_hit};
use crate::visible::Ray;
use glam::{DVec2, Vec3};
use model::Region;

/// The kind of object that was hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PickedObject {
    /// A medium, or a horizon or isosurface in it.
    Medium,
    /// A face of the block.
    Face,
    /// The ground.
    Ground,
    /// A well, by its index.
    Well(usize),
}

/// The point under a pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct PickedPoint {
    /// The kind of object that was hit.
    pub what: PickedObject,
    /// Its voxel position.
    pub voxel: Vec3,
    /// Leaf of the horizon candidates at the nearest sample. Absent without candidates, or if there is no
    /// leaf.
    pub leaf: Option<u32>,
    /// Distance to that candidate, voxels.
    pub leaf_distance: Option<f32>,
    /// Layer and block. Absent without an interpretation.
    pub region: Option<Region>,
    /// Values of all volumes at the point, in the order of the inputs; NaN where a volume has none.
    pub values: Vec<f32>,
}

/// The first visible point under a pixel position (x right, y down, pixel centres at halves); `None` for the
/// background.
///
/// ```
/// use glam::DVec2;
/// use render::{Camera, Inputs, NamedVolume, PickedObject, Scene};
/// use survey::{SurveyGeometry, VerticalUnit, Volume};
/// use ttf::{ColourMap, RawColour, RgbaFunction};
/// let geometry = SurveyGeometry::regular([5; 3], 10.0, 10.0, VerticalUnit::Metres);
/// let volume = Volume::filled([5; 3], 3.0f32);
/// let volumes = [NamedVolume::whole("seismic", &volume)];
/// // Seen from above, the middle of the image is the middle of the top face.
/// let scene = Scene {
///     size_px: [100, 100],
///     camera: Camera { azimuth_deg: Some(0.0), elevation_deg: 90.0, ..Camera::default() },
///     raw: Some(RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, 5.0))),
///     ..Scene::default()
/// };
/// let point = render::pick(&scene, &Inputs::raw(&geometry, &volumes), DVec2::splat(50.0)).unwrap().unwrap();
/// assert_eq!((point.what, point.values[0]), (PickedObject::Face, 3.0));
/// assert!((point.voxel - glam::Vec3::new(2.0, 2.0, 0.0)).length() < 1e-3);
/// ```
///
/// # Errors
/// A scene that cannot be drawn, or missing inputs.
pub fn pick(scene: &Scene, inputs: &Inputs, pixel: DVec2) -> Result<Option<PickedPoint>, RenderError> {
    let resolved = ResolvedScene::new(scene, inputs, &mut Kept::default())?;
    let ray = Ray::from(resolved.view.ray(pixel));
    let hit = stopping_hit(&resolved, &ray, Start::OF_RAY);
    let seen = resolved.field.as_ref().and_then(|field| first_seen(field, &resolved.solid, &ray, hit.t()));
    let (what, t) = match (seen, hit) {
        (Some((t, _)), _) => (PickedObject::Medium, t),
        (None, RayHit::Background) => return Ok(None),
        (None, RayHit::Face(hit)) => (PickedObject::Face, hit.t),
        (None, RayHit::Ground(hit)) => (PickedObject::Ground, hit.t),
        (None, RayHit::Well(hit)) => (PickedObject::Well(hit.well), hit.t),
    };
    let voxel = ray.at(t);
    let leaf = inputs.candidates.map(|c| c.leaf_at(voxel)).filter(|leaf| *leaf != 0);
    Ok(Some(PickedPoint {
        what,
        voxel,
        leaf,
        leaf_distance: inputs.candidates.filter(|_| leaf.is_some()).map(|c| c.distance_at(voxel)),
        region: inputs.model.map(|model| model.region_at(voxel)),
        values: inputs.volumes.iter().map(|volume| volume.sample(voxel)).collect(),
    }))
}
