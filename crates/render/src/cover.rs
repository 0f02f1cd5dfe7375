//! The faces of a block as flat pictures, of which a model that leaves the program is made: each face with its pieces of
//! rock, and its colour on a lattice of texels, shaded as in a picture and seen straight on.
//!
//! Space: voxels.

use crate::cache::Kept;
use crate::camera::ViewRay;
use crate::error::RenderError;
use crate::inputs::Inputs;
use crate::outline::solid::faces;
use crate::points::Points;
use crate::resolved_scene::ResolvedScene;
use crate::scene::Scene;
use crate::shade::RayHit;
use crate::vector::rock_cells;
use crate::visible::FaceHit;
use glam::{DVec2, DVec3, Vec3, Vec4};
use image::RgbImage;
use model::section::SectionPlane;
use rayon::prelude::*;
use survey::block::BodyPlane;
use survey::{Progress, SurveyGeometry};

/// A face of the block or of a cut-out, on whichever side the camera is.
#[derive(Debug, Clone, PartialEq)]
pub struct RockFace {
    /// Its plane.
    pub plane: BodyPlane,
    /// Unit direction across it into the rock.
    pub rock: DVec3,
    /// The rectangle around it.
    pub rectangle: SectionPlane,
    /// Its convex pieces.
    pub cells: Vec<Vec<DVec3>>,
}

/// All faces of a scene's block; those that lie in the air above a ground among them.
pub fn rock_faces(scene: &Scene, geometry: &SurveyGeometry) -> Vec<RockFace> {
    let solid = scene.solid(geometry);
    let found = faces(&solid, &scene.view(geometry)).into_iter().map(|face| RockFace {
        plane: face.plane,
        rock: face.rock,
        rectangle: face.section_plane(),
        cells: rock_cells(&solid, &face),
    });
    found.filter(|face| !face.cells.is_empty()).collect()
}

/// The colours of a rectangle on a plane of the block, at the blend of the scene: s to the right, t down, a texel's
/// colour averaged over its area. Media, ground and wells of the scene do not matter.
///
/// # Errors
/// A scene that cannot be drawn, missing inputs, or cancellation.
pub fn cover(
    scene: &Scene,
    inputs: &Inputs,
    (plane, rectangle): (&BodyPlane, &SectionPlane),
    [width, height]: [u32; 2],
    progress: &Progress,
) -> Result<RgbImage, RenderError> {
    let bare = Scene { ground: None, media: Default::default(), ..scene.clone() };
    let mut kept = Kept::default();
    let resolved = ResolvedScene::new(&bare, inputs, &mut kept)?;
    let texel = DVec2::from(rectangle.extent) / DVec2::new(f64::from(width), f64::from(height));
    let samples = bare.samples.max(1);
    let normal = plane.normal.as_dvec3();
    let hit_at = |at: DVec2| {
        let origin = rectangle.voxel(at * texel);
        let origin_step = [rectangle.s_axis * texel.x, rectangle.t_axis * texel.y];
        let ray = ViewRay { origin, direction: -normal, origin_step, direction_step: [DVec3::ZERO; 2] };
        (ray, FaceHit { t: 0.0, point: plane.settle(origin.as_vec3()), plane: *plane })
    };
    progress.begin("faces", u64::from(height));
    let per_texel = samples * samples;
    let row = |y: u32| {
        progress.step(1)?;
        let sub = |n: u32| (DVec2::new(f64::from(n % samples), f64::from(n / samples)) + 0.5) / f64::from(samples);
        let places = (0..width).flat_map(|x| (0..per_texel).map(move |n| (x, n)));
        let hits: Vec<(ViewRay, FaceHit)> =
            places.map(|(x, n)| hit_at(DVec2::new(f64::from(x), f64::from(y)) + sub(n))).collect();
        let points = Points::of(&resolved, hits.iter().map(|(ray, hit)| (ray, RayHit::Face(*hit))));
        let average = |colours: &[Vec4]| {
            let mean = colours.iter().map(|colour| colour.truncate()).sum::<Vec3>() / per_texel as f32;
            mean.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
        };
        Ok(points.colours(&resolved).chunks(per_texel as usize).flat_map(average).collect::<Vec<u8>>())
    };
    let rows: Vec<Vec<u8>> = (0..height).into_par_iter().map(row).collect::<Result<_, RenderError>>()?;
    Ok(RgbImage::from_raw(width, height, rows.concat()).unwrap_or_default())
}
