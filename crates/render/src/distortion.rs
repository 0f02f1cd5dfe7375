//! How much patterns are distorted on the faces of a picture.
//!
//! A face lays its pattern on by a map from the plane of the face, in metres of the displayed (exaggerated) block, to
//! the pattern. How far that is from the pattern's nominal size and shape is its [`Stretch`].
//!
//! Where a face blends several mappings ([`ttf::FaceFrame`]) each counts with its weight.

use crate::cache::Kept;
use crate::camera::ViewRay;
use crate::error::RenderError;
use crate::inputs::Inputs;
use crate::resolved_scene::{ResolvedInterpretation, ResolvedScene};
use crate::scene::Scene;
use crate::shade::{RayHit, Start, pixel_shift, stopping_hit};
use crate::visible::{FaceHit, Ray};
use glam::{DMat3, DVec2, DVec3, Vec3};
use rayon::prelude::*;
use serde::Serialize;
use survey::Progress;
pub use ttf::stretch::{CALM_AREA, CALM_ASPECT, Stretch};

/// The distortion of one layer in a picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct LayerDistortion {
    /// Visible area of its faces, m².
    pub area_m2: f64,
    /// Area with an aspect ratio above [`CALM_ASPECT`], m².
    pub narrow_m2: f64,
    /// Area with an area factor outside [1/[`CALM_AREA`], [`CALM_AREA`]], m².
    pub scaled_m2: f64,
    /// Area with one or the other, m².
    pub distorted_m2: f64,
}

impl LayerDistortion {
    fn add(&mut self, other: &Self) {
        self.area_m2 += other.area_m2;
        self.narrow_m2 += other.narrow_m2;
        self.scaled_m2 += other.scaled_m2;
        self.distorted_m2 += other.distorted_m2;
    }

    /// Share of the area that is distorted, 0 to 1.
    pub fn share(&self) -> f64 {
        if self.area_m2 > 0.0 { self.distorted_m2 / self.area_m2 } else { 0.0 }
    }

    /// The sum over all layers.
    pub fn total(layers: &[Self]) -> Self {
        layers.iter().fold(Self::default(), |mut sum, layer| {
            sum.add(layer);
            sum
        })
    }
}

/// Measures the distortion on the visible faces of a scene, one ray a pixel, for each layer from the bottom. Empty
/// where the scene shows no interpretation.
///
/// # Errors
/// A scene that cannot be drawn, missing inputs, or cancellation.
pub fn measure(scene: &Scene, inputs: &Inputs, progress: &Progress) -> Result<Vec<LayerDistortion>, RenderError> {
    let resolved = ResolvedScene::new(scene, inputs, &mut Kept::default())?;
    let Some(interpretation) = resolved.interpretation else { return Ok(Vec::new()) };
    let layers = interpretation.model.layer_count();
    let [width, height] = scene.size_px;
    progress.begin("measuring distortion", u64::from(height));
    let rows: Vec<Vec<LayerDistortion>> = (0..height)
        .into_par_iter()
        .map(|y| {
            let mut row = vec![LayerDistortion::default(); layers];
            for x in 0..width {
                let view_ray = resolved.view.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
                if let RayHit::Face(hit) = stopping_hit(&resolved, &Ray::from(view_ray), Start::OF_RAY) {
                    let place = FacePlace::new(&resolved, &interpretation, &hit);
                    row[place.layer].add(&place.distortion(pixel_m2(&resolved, &view_ray, &hit)));
                }
            }
            progress.step(1).map(|()| row)
        })
        .collect::<Result<_, _>>()?;
    let mut sums = vec![LayerDistortion::default(); layers];
    rows.iter().for_each(|row| sums.iter_mut().zip(row).for_each(|(sum, layer)| sum.add(layer)));
    Ok(sums)
}

/// The colour that shows a place: white for no distortion, blue where the pattern is too dense, orange where it is too
/// sparse; saturated at the limit of what is calm, and dark far beyond it. sRGB-encoded.
pub(crate) fn colour_at(resolved: &ResolvedScene, interpretation: &ResolvedInterpretation, hit: &FaceHit) -> Vec3 {
    let place = FacePlace::new(resolved, interpretation, hit);
    place.mappings.iter().map(|(weight, stretch)| tone(*stretch) * *weight).sum()
}

/// Colours of the scale at −2, −1, 0, 1 and 2: sparse to dense. Orange and blue are told apart by all kinds of colour
/// vision, and both grow darker with distortion.
const SCALE: [Vec3; 5] = [
    Vec3::new(0.35, 0.16, 0.02),
    Vec3::new(0.90, 0.52, 0.10),
    Vec3::new(0.97, 0.97, 0.96),
    Vec3::new(0.36, 0.58, 0.83),
    Vec3::new(0.06, 0.15, 0.36),
];

/// The colour of a stretch. The scale runs over log₂ of the area factor or of the aspect ratio, whichever is farther from 0;
/// the sign is that of the area factor.
///
/// ```
/// use render::distortion::{Stretch, tone};
/// let plain = tone(Stretch { densest: 1.0, sparsest: 1.0 });
/// assert!(plain.min_element() > 0.95);
/// assert!(tone(Stretch { densest: 2.0, sparsest: 2.0 }).z > tone(Stretch { densest: 0.5, sparsest: 0.5 }).z);
/// ```
pub fn tone(stretch: Stretch) -> Vec3 {
    let area = stretch.area().max(1e-6).log2();
    let amount = area.abs().max(stretch.aspect().min(1e6).log2()).copysign(area);
    let at = (amount + 2.0).clamp(0.0, 4.0);
    let cell = (at as usize).min(3);
    SCALE[cell].lerp(SCALE[cell + 1], at - cell as f32)
}

/// Area of a pixel on a face, m².
fn pixel_m2(resolved: &ResolvedScene, ray: &ViewRay, hit: &FaceHit) -> f64 {
    let displayed = DMat3::from_diagonal(DVec3::new(1.0, 1.0, resolved.scene.exaggeration)) * resolved.metric;
    let [right, down] = [0, 1].map(|n| displayed * pixel_shift(ray, hit, n).as_dvec3());
    right.cross(down).length()
}

/// A place on a face: its layer, and the weight and stretch of each mapping.
struct FacePlace {
    layer: usize,
    mappings: [(f32, Stretch); 3],
}

impl FacePlace {
    fn new(resolved: &ResolvedScene, interpretation: &ResolvedInterpretation, hit: &FaceHit) -> Self {
        let (flat, jacobian) = interpretation.flat_at(hit.point, None);
        let (map, layer) = (resolved.face_map(&hit.plane), flat.region.layer);
        let weights = map.weights(&resolved.tables, layer, &jacobian).to_array();
        let stretches = map.stretches(&resolved.tables, layer, &jacobian);
        let (layer, mappings) = (usize::from(layer), [0, 1, 2].map(|n| (weights[n], stretches[n])));
        Self { layer, mappings }
    }

    fn distortion(&self, area_m2: f64) -> LayerDistortion {
        let mut found = LayerDistortion { area_m2, ..Default::default() };
        for (weight, stretch) in self.mappings {
            let part = f64::from(weight) * area_m2;
            // A pattern without coordinates is not painted.
            let narrow = stretch.aspect() > CALM_ASPECT;
            let scaled = !(1.0 / CALM_AREA..=CALM_AREA).contains(&stretch.area());
            found.narrow_m2 += if narrow { part } else { 0.0 };
            found.scaled_m2 += if scaled { part } else { 0.0 };
            found.distorted_m2 += if narrow || scaled { part } else { 0.0 };
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_told_apart_in_grey_and_ends_at_its_limits() {
        let grey = |stretch: f32| tone(Stretch { densest: stretch, sparsest: stretch }).dot(Vec3::new(0.3, 0.59, 0.11));
        assert!(grey(1.0) > grey(1.2) && grey(1.2) > grey(1.42) && grey(1.42) > grey(2.0));
        assert!(grey(1.0) > grey(0.8) && grey(0.8) > grey(0.7) && grey(0.7) > grey(0.5));
        assert_eq!(tone(Stretch { densest: 9.0, sparsest: 9.0 }), SCALE[4]);
        assert_eq!(tone(Stretch { densest: 0.1, sparsest: 0.1 }), SCALE[0]);
    }
}
