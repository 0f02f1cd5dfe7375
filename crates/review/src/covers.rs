//! The pictures of faces: the illustration, and what a reader finds under the finger.

use crate::block::Wanted;
use crate::ground::Heights;
use crate::model::Cover;
use glam::{DVec2, DVec3, Vec3};
use image::RgbImage;
use model::StructuralModel;
use model::section::SectionPlane;
use project::error::ProjectError;
use project::pictures::Painter;
use project::pictures::load::Loaded;
use rayon::prelude::*;
use render::cover::cover;
use render::{Background, Camera, NamedVolume, Outlines, Scene, WellStyle};
use survey::block::BodyPlane;
use survey::{Progress, Quality};
use ttf::RawColour;

/// Samples a texel along each axis.
const SAMPLES: u32 = 2;
/// Most texels of bare faults along an axis: the colour of the rock beside them.
const BARE_TEXELS: u32 = 96;
/// Most nodes of the data along an axis.
const MOST_NODES: f64 = 1024.0;
/// Depths below the triangles of the ground at which its layer is looked for, voxels.
const INTO_GROUND: [f32; 6] = [0.05, 0.5, 1.0, 2.0, 4.0, 8.0];
/// Largest side of a picture: what every device of the last years takes.
const MOST_TEXELS: f64 = 4096.0;

/// Makes the pictures of faces.
pub(crate) struct CoverMaker<'a> {
    pub loaded: &'a Loaded,
    pub painter: &'a mut Painter,
    pub progress: &'a Progress,
    /// Texels to a metre of the exaggerated block.
    pub texels_per_m: f64,
    /// Nodes of the data to a voxel.
    pub nodes_per_voxel: f64,
}

impl CoverMaker<'_> {
    /// The pictures of a face.
    pub(crate) fn make(
        &mut self,
        wanted: &Wanted,
        scene: &Scene,
        ground: Option<&Heights>,
    ) -> Result<Cover, ProjectError> {
        let rectangle = wanted.rectangle;
        let size = self.size_px(&rectangle, scene.exaggeration);
        let size = if wanted.shade.is_some() { size.map(|side| side.min(BARE_TEXELS)) } else { size };
        let illustrated = match (&self.loaded.rock, &wanted.plane) {
            (None, _) => None,
            (Some(_), Some(plane)) => Some(self.face(plane, &rectangle, scene, size)?),
            (Some(_), None) => Some(shaded(self.ground(&rectangle, scene, size)?, wanted.shade.unwrap_or(1.0))),
        };
        let data = self.data(&rectangle, ground.filter(|_| wanted.plane.is_none()));
        Ok(Cover { rectangle, illustrated, is_smooth: wanted.plane.is_none(), data })
    }

    /// Texels of a rectangle: square on the exaggerated block.
    fn size_px(&self, rectangle: &SectionPlane, exaggeration: f64) -> [u32; 2] {
        let metric = self.loaded.geometry.metric_from_voxel();
        let display = |axis: DVec3| metric * axis * DVec3::new(1.0, 1.0, exaggeration);
        let side = |axis: DVec3, extent: f64| display(axis).length() * extent * self.texels_per_m;
        [side(rectangle.s_axis, rectangle.extent[0]), side(rectangle.t_axis, rectangle.extent[1])]
            .map(|side| side.ceil().clamp(2.0, MOST_TEXELS) as u32)
    }

    fn face(
        &self,
        plane: &BodyPlane,
        rectangle: &SectionPlane,
        scene: &Scene,
        size: [u32; 2],
    ) -> Result<RgbImage, ProjectError> {
        let scene = self.loaded.complete(&Scene { blend: 0.0, samples: SAMPLES, ..scene.clone() });
        let (volumes, wells) = (self.loaded.named_volumes(), self.loaded.well_paths());
        Ok(cover(&scene, &self.loaded.inputs(&volumes, &wells), (plane, rectangle), size, self.progress)?)
    }

    /// The ground seen from above, in the light of the scene's camera.
    fn ground(&mut self, rectangle: &SectionPlane, scene: &Scene, size: [u32; 2]) -> Result<RgbImage, ProjectError> {
        let geometry = &self.loaded.geometry;
        let block = scene.box_in(geometry);
        let azimuth_deg = Some(scene.camera.azimuth_for(geometry, &block));
        let longest = size[0].max(size[1]).min(2048);
        let ground = scene.ground.map(|ground| render::Ground { opacity: 1.0, ..ground });
        let above = Scene {
            size_px: [longest * 3 / 2; 2],
            samples: SAMPLES,
            blend: 0.0,
            ground,
            camera: Camera { azimuth_deg, elevation_deg: 90.0, margin: 0.01, ..Camera::default() },
            cut_outs: Vec::new(),
            cut_shapes: Vec::new(),
            outlines: Outlines::none(),
            wells: WellStyle { radius: 0.0, ..scene.wells },
            background: Background::Transparent,
            media: Default::default(),
            ..scene.clone()
        };
        let view = above.view(geometry);
        let (drawn, _) = self.painter.draw(&above, self.loaded, self.progress)?;
        let texel = DVec2::from(rectangle.extent) / DVec2::new(f64::from(size[0]), f64::from(size[1]));
        Ok(RgbImage::from_fn(size[0], size[1], |x, y| {
            let st = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) * texel;
            image::Rgb(bilinear(&drawn, view.project(rectangle.voxel(st)) - 0.5))
        }))
    }

    /// Raw value, layer and certainty at nodes from corner to corner.
    fn data(&self, rectangle: &SectionPlane, ground: Option<&Heights>) -> RgbImage {
        let nodes = |extent: f64, axis: DVec3| {
            let voxels = extent * axis.length();
            (voxels * self.nodes_per_voxel).round().clamp(1.0, MOST_NODES) + 1.0
        };
        let size = [nodes(rectangle.extent[0], rectangle.s_axis), nodes(rectangle.extent[1], rectangle.t_axis)];
        let step = DVec2::from(rectangle.extent) / (DVec2::from(size) - 1.0);
        let volumes = self.loaded.named_volumes();
        let raw = self.loaded.raw.as_ref();
        let volume = raw.and_then(|raw| volumes.iter().find(|volume| volume.name == raw.volume));
        let model = self.loaded.rock.as_ref().map(|rock| &*rock.model);
        let [width, height] = size.map(|n| n as u32);
        let ground = ground.zip(model).map(|(heights, model)| heights.on(model));
        let texel = |n: u32| {
            let mut p = rectangle.voxel(DVec2::new(f64::from(n % width), f64::from(n / width)) * step);
            if let Some(ground) = &ground {
                p.z = ground.z_at(p.truncate());
            }
            let p = p.as_vec3();
            let (layer, unsure) = match (model, &ground) {
                (None, _) => (0, 0),
                (Some(model), None) => layer_at(model, p),
                (Some(model), Some(_)) => layer_at(model, beneath(model, p)),
            };
            [raw.zip(volume).map_or(0, |(raw, volume)| byte_of(raw, volume, p)), layer, unsure]
        };
        let texels: Vec<[u8; 3]> = (0..width * height).into_par_iter().map(texel).collect();
        RgbImage::from_raw(width, height, texels.concat()).unwrap_or_default()
    }
}

/// A picture whose colours are multiplied.
fn shaded(mut image: RgbImage, shade: f32) -> RgbImage {
    if shade != 1.0 {
        let darker = |c: &mut u8| *c = (f32::from(*c) * shade).round().clamp(0.0, 255.0) as u8;
        image.pixels_mut().for_each(|pixel| pixel.0.iter_mut().for_each(darker));
    }
    image
}

/// A raw value in 1 to 255 over the domain of its colours; 0 where there is none.
fn byte_of(raw: &RawColour, volume: &NamedVolume, p: Vec3) -> u8 {
    let value = volume.sample(p);
    let [low, high] = raw.function.domain;
    if value.is_nan() { 0 } else { (1.0 + 254.0 * ((value - low) / (high - low)).clamp(0.0, 1.0)).round() as u8 }
}

/// A place just below the ground near a point of its triangles, which may lie in the air.
fn beneath(model: &StructuralModel, p: Vec3) -> Vec3 {
    let air = model.layer_count() - 1;
    let places = INTO_GROUND.map(|depth| p + Vec3::Z * depth);
    let rock = places.into_iter().find(|place| usize::from(model.region_at(*place).layer) != air);
    rock.unwrap_or(p)
}

/// Layer + 1, and 255 where the nearest horizon of the layer was not picked.
fn layer_at(model: &StructuralModel, p: Vec3) -> (u8, u8) {
    let region = model.region_at(p);
    let layer = usize::from(region.layer);
    let strata = model.stratigraphy();
    let near = [strata.top_of(layer), strata.bottom_of(layer)].into_iter().flatten();
    let near = near.filter(|horizon| model.level(*horizon, region.block).is_none());
    let off = |horizon: &usize| (model.horizon_z(*horizon, region.block, p.x, p.y) - p.z).abs();
    let nearest = near.min_by(|a, b| off(a).total_cmp(&off(b)));
    let is_picked = nearest.is_none_or(|horizon| {
        let quality = model.quality_at(horizon, region.block, p.x, p.y);
        matches!(quality, Quality::Picked | Quality::Tracked)
    });
    ((layer + 1).min(255) as u8, if is_picked { 0 } else { 255 })
}

/// A colour between four pixels; empty pixels do not count.
fn bilinear(image: &image::RgbaImage, at: DVec2) -> [u8; 3] {
    let last = DVec2::new(f64::from(image.width() - 1), f64::from(image.height() - 1));
    let at = at.clamp(DVec2::ZERO, last);
    let low = at.floor();
    let part = at - low;
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let corner = (low + DVec2::new(dx, dy)).min(last);
        let [r, g, b, a] = image.get_pixel(corner.x as u32, corner.y as u32).0.map(f64::from);
        let weight = (1.0 - (part.x - dx).abs()) * (1.0 - (part.y - dy).abs()) * a / 255.0;
        sum += DVec3::new(r, g, b) * weight;
        weights += weight;
    }
    (sum / weights.max(1e-9)).to_array().map(|c| c.round().clamp(0.0, 255.0) as u8)
}
