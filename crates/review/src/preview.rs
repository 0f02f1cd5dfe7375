//! A picture of a model's own triangles, drawn by the processor: what a reader will see, without a browser.
//!
//! Triangles are filled one after the other, the nearest at each pixel stays. Depth is affine on the screen (forward
//! distance without perspective, −1 / distance with it), and so is a voxel position over its weight (1, or 1 / distance).

use crate::model::{Block, Cover, LineKind, Mesh, Model, RawScale, SceneModel};
use crate::page;
use glam::{DMat3, DVec2, DVec3};
use image::{Rgb, RgbImage};
use render::{Camera, Scene, Stroke, View};
use ttf::Colour;

/// How far behind a face a line on it may be and is still drawn, as a share of the camera's distance.
const SLACK: f64 = 0.004;
/// Direction of the light on surfaces: right, up, towards the reader.
const LIGHT: DVec3 = DVec3::new(-0.45, 0.7, 0.55);
/// Smaller side of a picture in which lines are as wide as stated, pixels.
const NOMINAL_PX: f64 = 1000.0;

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// The block with its faces.
    Block,
    /// Horizons and faults without it.
    Surfaces,
}

/// A picture, and which place each of its pixels shows.
pub struct Preview {
    /// The pixels.
    pub image: RgbImage,
    places: Vec<DVec3>,
    view: View,
}

impl Preview {
    /// The voxel position that a pixel shows; `None` beside the block.
    pub fn place(&self, pixel: DVec2) -> Option<DVec3> {
        let (width, height) = (f64::from(self.image.width()), f64::from(self.image.height()));
        if !(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < width && pixel.y < height) {
            return None;
        }
        let place = self.places[pixel.y as usize * self.image.width() as usize + pixel.x as usize];
        place.is_finite().then_some(place)
    }

    /// The pixel position of a voxel position.
    pub fn project(&self, voxel: DVec3) -> DVec2 {
        self.view.project(voxel)
    }
}

/// Draws the block or the surfaces of a scene. `turned` is the camera's bearing and elevation in degrees; absent: the
/// scene's. A scene that is not there is empty.
pub fn draw(model: &Model, scene: usize, turned: Option<[f64; 2]>, size_px: [u32; 2], shown: Shown) -> Preview {
    let Some(SceneModel { scene, cut, .. }) = model.scenes.get(scene) else {
        let view = Scene { size_px, ..Scene::default() }.view(&model.geometry);
        return Preview { image: RgbImage::new(1, 1), places: vec![DVec3::NAN], view };
    };
    let camera = match turned {
        Some([azimuth, elevation_deg]) => Camera { azimuth_deg: Some(azimuth), elevation_deg, ..scene.camera },
        None => scene.camera,
    };
    let view = Scene { size_px, camera, ..scene.clone() }.view(&model.geometry);
    let mut canvas = Canvas::new(view, scene.box_in(&model.geometry).centre(), size_px);
    match shown {
        Shown::Block => canvas.block(model, cut, scene),
        Shown::Surfaces => {
            for surface in model.horizons.iter().chain(&model.faults) {
                canvas.surface(&surface.mesh, surface.shown(scene.ground.is_some()), surface.colour);
            }
        }
    }
    Preview { image: canvas.image, places: canvas.places, view }
}

/// A corner on the screen.
#[derive(Clone, Copy)]
struct Corner {
    at: DVec2,
    /// Affine on the screen; larger is farther.
    depth: f64,
    /// Weight of the voxel position.
    weight: f64,
    voxel: DVec3,
}

struct Canvas {
    view: View,
    linear: DMat3,
    offset: DVec3,
    /// How much deeper than a face a line on it may be.
    slack: f64,
    image: RgbImage,
    depths: Vec<f64>,
    places: Vec<DVec3>,
}

impl Canvas {
    fn new(view: View, centre: DVec3, [width, height]: [u32; 2]) -> Self {
        let (linear, offset) = view.eye_from_voxel();
        let distance = (linear * centre + offset).z.max(1e-9);
        let count = width as usize * height as usize;
        Self {
            view,
            linear,
            offset,
            slack: SLACK * if view.is_perspective() { 1.0 / distance } else { distance },
            image: RgbImage::from_pixel(width, height, Rgb([255; 3])),
            depths: vec![f64::INFINITY; count],
            places: vec![DVec3::NAN; count],
        }
    }

    fn corner(&self, voxel: DVec3) -> Corner {
        let forward = (self.linear * voxel + self.offset).z;
        let (depth, weight) = match self.view.is_perspective() {
            true => (-1.0 / forward.max(1e-9), 1.0 / forward.max(1e-9)),
            false => (forward, 1.0),
        };
        Corner { at: self.view.project(voxel), depth, weight, voxel }
    }

    fn block(&mut self, model: &Model, block: &Block, scene: &Scene) {
        let map = model.raw.as_ref().map(|raw| (raw, page::map(&raw.function)));
        for face in &block.faces {
            let cover = &model.covers[face.cover];
            let colour = |voxel: DVec3| colour_of(cover, map.as_ref(), voxel, scene.blend);
            self.fill((&face.mesh.points, &face.mesh.triangles), |_| (), |voxel, ()| colour(voxel));
        }
        let Scene { outlines, .. } = scene;
        for (kind, ends) in &block.lines {
            let stroke = match kind {
                LineKind::Edge => outlines.edges,
                LineKind::Horizon { .. } => outlines.horizons,
                LineKind::Fault => outlines.faults,
            };
            self.line(*ends, stroke);
        }
    }

    /// A horizon or fault in the light.
    fn surface(&mut self, mesh: &Mesh, triangles: &[[u32; 3]], colour: Colour) {
        let tone = colour.to_unit().map(f64::from);
        let linear = self.linear;
        let lit = |corners: [DVec3; 3]| {
            let [a, b, c] = corners.map(|p| linear * p);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            (normal * DVec3::new(1.0, 1.0, -1.0)).dot(LIGHT.normalize()).abs()
        };
        self.fill((&mesh.points, triangles), lit, |_, light| {
            let part = |c: f64| c * 0.62 + (c + (1.0 - c) * 0.28 - c * 0.62) * light;
            tone.map(|c| (part(c) * 255.0).round() as u8)
        });
    }

    /// Fills triangles; `of` is computed once for each of them, `colour` at each pixel.
    fn fill<T: Copy>(
        &mut self,
        (points, triangles): (&[DVec3], &[[u32; 3]]),
        of: impl Fn([DVec3; 3]) -> T,
        colour: impl Fn(DVec3, T) -> [u8; 3],
    ) {
        let corners: Vec<Corner> = points.iter().map(|p| self.corner(*p)).collect();
        let (width, height) = (self.image.width() as usize, self.image.height() as usize);
        for triangle in triangles {
            let [a, b, c] = triangle.map(|n| corners[n as usize]);
            let area = (b.at - a.at).perp_dot(c.at - a.at);
            if area.abs() < 1e-9 {
                continue;
            }
            let told = of([a.voxel, b.voxel, c.voxel]);
            let low = (a.at.min(b.at).min(c.at) - 0.5).ceil().max(DVec2::ZERO);
            let high = (a.at.max(b.at).max(c.at) - 0.5).floor();
            let (right, bottom) = (high.x.min(width as f64 - 1.0), high.y.min(height as f64 - 1.0));
            for y in low.y as usize..(bottom + 1.0).max(0.0) as usize {
                for x in low.x as usize..(right + 1.0).max(0.0) as usize {
                    let p = DVec2::new(x as f64, y as f64) + 0.5;
                    let share = |q: Corner, r: Corner| (q.at - p).perp_dot(r.at - p) / area;
                    let shares = [share(b, c), share(c, a), share(a, b)];
                    if shares.iter().any(|share| *share < -1e-9) {
                        continue;
                    }
                    let sum = |of: fn(&Corner) -> f64| shares[0] * of(&a) + shares[1] * of(&b) + shares[2] * of(&c);
                    let (n, depth) = (y * width + x, sum(|q| q.depth));
                    if depth < self.depths[n] {
                        let weighted = [a, b, c].into_iter().zip(shares).map(|(q, share)| q.voxel * q.weight * share);
                        let voxel = weighted.sum::<DVec3>() / sum(|q| q.weight);
                        self.depths[n] = depth;
                        self.places[n] = voxel;
                        self.image.put_pixel(x as u32, y as u32, Rgb(colour(voxel, told)));
                    }
                }
            }
        }
    }

    /// A straight piece, where nothing is in front of it.
    fn line(&mut self, ends: [DVec3; 2], stroke: Stroke) {
        let [a, b] = ends.map(|p| self.corner(p));
        let (width, height) = (f64::from(self.image.width()), f64::from(self.image.height()));
        let half = 0.5 * (f64::from(stroke.width_px) * width.min(height) / NOMINAL_PX).max(0.9);
        if stroke.width_px <= 0.0 {
            return;
        }
        let size = DVec2::new(width, height);
        let low = (a.at.min(b.at) - half - 1.0).clamp(DVec2::ZERO, size);
        let high = (a.at.max(b.at) + half + 1.0).clamp(DVec2::ZERO, size);
        let along = b.at - a.at;
        let ink = stroke.colour.to_unit().map(|c| f64::from(c) * 255.0);
        for y in low.y as u32..high.y as u32 {
            for x in low.x as u32..high.x as u32 {
                let p = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
                let share = ((p - a.at).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                let cover = (half + 0.5 - (p - a.at - along * share).length()).clamp(0.0, 1.0);
                let depth = a.depth + (b.depth - a.depth) * share;
                let n = y as usize * self.image.width() as usize + x as usize;
                if cover > 0.0 && depth <= self.depths[n] + self.slack {
                    let Rgb(old) = *self.image.get_pixel(x, y);
                    let mixed = |n: usize| (f64::from(old[n]) + (ink[n] - f64::from(old[n])) * cover).round() as u8;
                    self.image.put_pixel(x, y, Rgb([mixed(0), mixed(1), mixed(2)]));
                }
            }
        }
    }
}

/// The colour of a face at a place, between the illustration and the raw data.
fn colour_of(cover: &Cover, map: Option<&(&RawScale, Vec<u8>)>, voxel: DVec3, blend: f32) -> [u8; 3] {
    let plane = &cover.rectangle;
    let share =
        |axis: DVec3, extent: f64| (axis.dot(voxel - plane.origin) / (axis.length_squared() * extent)).clamp(0.0, 1.0);
    let st = DVec2::new(share(plane.s_axis, plane.extent[0]), share(plane.t_axis, plane.extent[1]));
    let texel = |image: &RgbImage| {
        let at = |part: f64, count: u32| ((part * f64::from(count)) as u32).min(count.saturating_sub(1));
        image.get_pixel(at(st.x, image.width()), at(st.y, image.height())).0
    };
    let raw = map.map(|(raw, map)| match usize::from(texel(&cover.data)[0]) {
        0 => raw.no_data.map(|colour| colour.to_unit().map(|c| (c * 255.0) as u8)),
        value => Some([map[value * 4], map[value * 4 + 1], map[value * 4 + 2]]),
    });
    let mixed = |a: [u8; 3], b: [u8; 3]| {
        let part = |n: usize| f32::from(a[n]) + (f32::from(b[n]) - f32::from(a[n])) * blend;
        [0, 1, 2].map(|n| part(n).round() as u8)
    };
    match (cover.illustrated.as_ref().map(texel), raw.flatten()) {
        (Some(rock), Some(raw)) => mixed(rock, raw),
        (Some(rock), None) => rock,
        (None, raw) => raw.unwrap_or([220, 220, 218]),
    }
}
