//! How much patterns are distorted on the faces of a picture.
//!
//! A face lays its pattern on by a map from the plane of the face, in metres of the displayed (exaggerated) block, to
//! the pattern, in tiles. Each tile has a nominal size: the block's length over the horizontal frequency, and
//! the layer's mean thickness over the vertical one. Counted in nominal metres, an undistorted pattern is a rotation. The
//! two singular values of the map's derivative are how many nominal metres of pattern lie on a metre of rock:
//!
//! ```text
//! aspect ratio = σ₁/σ₂        area factor = σ₁·σ₂        (both 1 where the pattern has its printed size)
//! ```
//!
//! Where a face blends several mappings ([`ttf::FaceFrame`]) each counts with its weight.

use crate::camera::ViewRay;
use crate::error::RenderError;
use crate::inputs::Inputs;
use crate::kept::Kept;
use crate::resolved::{ResolvedInterpretation, ResolvedScene};
use crate::scene::Scene;
use crate::shade::{RayHit, Start, pixel_shift, stopping_hit};
use crate::visible::{FaceHit, Ray};
use glam::{DMat3, DVec2, DVec3, Vec3};
use rayon::prelude::*;
use serde::Serialize;
use survey::Progress;
use survey::block::BodyPlane;

/// The largest aspect ratio that counts as calm.
pub const CALM_ASPECT: f32 = 2.0;
/// The area factor above which, or below whose inverse, a pattern counts as distorted.
pub const CALM_AREA: f32 = 2.0;

/// The singular values of the map from rock to pattern, in nominal metres of pattern for a metre of rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Along the direction in which the pattern is densest.
    pub densest: f32,
    /// Across it.
    pub sparsest: f32,
}

impl Stretch {
    /// From the derivative `[[∂u/∂x, ∂u/∂y], [∂v/∂x, ∂v/∂y]]`, (x, y) Cartesian on the face.
    ///
    /// ```
    /// // Twice as dense along v, sheared by nothing.
    /// let stretch = render::distortion::Stretch::of([[1.0, 0.0], [0.0, 2.0]]);
    /// assert_eq!((stretch.aspect(), stretch.area()), (2.0, 2.0));
    /// ```
    pub fn of([[a, b], [c, d]]: [[f32; 2]; 2]) -> Self {
        let sum = 0.5 * (a + d).hypot(c - b);
        let difference = 0.5 * (a - d).hypot(c + b);
        Self { densest: sum + difference, sparsest: (sum - difference).abs() }
    }

    /// Length of an element of the pattern over its width, at least 1; infinite where it is smeared to a line.
    pub fn aspect(self) -> f32 {
        self.densest / self.sparsest
    }

    /// Elements on an area of rock over those of the nominal size.
    pub fn area(self) -> f32 {
        self.densest * self.sparsest
    }

    /// Whether the aspect ratio is at most 2 and the area factor in [½, 2].
    pub fn is_calm(self) -> bool {
        self.aspect() <= CALM_ASPECT && (1.0 / CALM_AREA..=CALM_AREA).contains(&self.area())
    }
}

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
    let faces = FaceMetric::of(&resolved);
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
                    row[place.layer].add(&place.distortion(faces.pixel_m2(&view_ray, &hit)));
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

/// The metric of displayed space.
struct FaceMetric {
    metres: DMat3,
}

/// Two directions that span a plane, voxels, and the inverse of the matrix whose columns they are, Cartesian on the plane.
struct InFace {
    steps: [Vec3; 2],
    inverse: [[f32; 2]; 2],
}

impl FaceMetric {
    fn of(resolved: &ResolvedScene) -> Self {
        let stretch = DMat3::from_diagonal(DVec3::new(1.0, 1.0, resolved.scene.exaggeration));
        Self { metres: stretch * resolved.metric }
    }

    fn on(&self, plane: &BodyPlane) -> InFace {
        let steps = match plane.axis {
            Some(axis) => [[1, 2], [0, 2], [0, 1]][axis].map(|n: usize| DVec3::AXES[n]),
            None => plane.normal.as_dvec3().any_orthonormal_pair().into(),
        };
        let [p, q] = steps.map(|step| self.metres * step);
        let (length, along) = (p.length(), p.dot(q) / p.length());
        let across = (q.length_squared() - along * along).max(0.0).sqrt();
        // The inverse of [[length, along], [0, across]].
        let inverse = [[1.0 / length, -along / (length * across)], [0.0, 1.0 / across]];
        InFace { steps: steps.map(|step| step.as_vec3()), inverse: inverse.map(|row| row.map(|value| value as f32)) }
    }

    /// Area of a pixel on the face, m².
    fn pixel_m2(&self, ray: &ViewRay, hit: &FaceHit) -> f64 {
        let [right, down] = [0, 1].map(|n| self.metres * pixel_shift(ray, hit, n).as_dvec3());
        right.cross(down).length()
    }
}

/// A place on a face: its layer, and the weight and stretch of each mapping.
struct FacePlace {
    layer: usize,
    mappings: [(f32, Stretch); 3],
}

impl FacePlace {
    fn new(resolved: &ResolvedScene, interpretation: &ResolvedInterpretation, hit: &FaceHit) -> Self {
        let tables = &resolved.tables;
        let (flat, jacobian) = interpretation.flat_at(hit.point, None);
        let layer = usize::from(flat.region.layer);
        let frame = resolved.frame(&hit.plane);
        let weights = frame.weights((Vec3::from_array(jacobian[2]) / resolved.voxel_m).to_array()).to_array();
        let (horizontal_m, vertical_m) = (tables.extent_i_m, tables.thicknesses_m.get(layer).copied().unwrap_or(1.0));
        let InFace { steps, inverse } = FaceMetric::of(resolved).on(&hit.plane);
        let mut number = 0;
        let mappings = frame.mappings(tables.globals.aspect_j).map(|mapping| {
            let is_map = number == 2;
            number += 1;
            // Derivatives of u and v along the two directions in the face, per voxel.
            let along = |step: Vec3| mapping.apply(jacobian.map(|row| Vec3::from_array(row).dot(step)));
            let [along_p, along_q] = steps.map(along);
            let row = |n: usize, nominal_m: f32| {
                let (p, q) = (along_p[n] * nominal_m, along_q[n] * nominal_m);
                [p * inverse[0][0], p * inverse[0][1] + q * inverse[1][1]]
            };
            let stretch = Stretch::of([row(0, horizontal_m), row(1, if is_map { horizontal_m } else { vertical_m })]);
            (weights[number - 1], stretch)
        });
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
    fn singular_values_are_those_of_known_maps() {
        let (sin, cos) = 0.7f32.sin_cos();
        // A rotation after a stretch by 3 and ½.
        let stretch = Stretch::of([[3.0 * cos, -0.5 * sin], [3.0 * sin, 0.5 * cos]]);
        assert!((stretch.densest - 3.0).abs() < 1e-5 && (stretch.sparsest - 0.5).abs() < 1e-5, "{stretch:?}");
        // A shear by γ keeps areas; σ₁ = (γ + √(γ² + 4))/2.
        let stretch = Stretch::of([[1.0, 0.8], [0.0, 1.0]]);
        assert!((stretch.densest - 0.5 * (0.8 + 4.64f32.sqrt())).abs() < 1e-5);
        assert!((stretch.area() - 1.0).abs() < 1e-5);
        // A mirrored map is as calm as its image.
        assert_eq!(Stretch::of([[-1.0, 0.0], [0.0, 1.0]]), Stretch { densest: 1.0, sparsest: 1.0 });
        assert!(!Stretch::of([[1.0, 1.0], [1.0, 1.0]]).is_calm(), "smeared to lines");
    }

    #[test]
    fn the_scale_is_told_apart_in_grey_and_ends_at_its_limits() {
        let grey = |stretch: f32| tone(Stretch { densest: stretch, sparsest: stretch }).dot(Vec3::new(0.3, 0.59, 0.11));
        assert!(grey(1.0) > grey(1.2) && grey(1.2) > grey(1.42) && grey(1.42) > grey(2.0));
        assert!(grey(1.0) > grey(0.8) && grey(0.8) > grey(0.7) && grey(0.7) > grey(0.5));
        assert_eq!(tone(Stretch { densest: 9.0, sparsest: 9.0 }), SCALE[4]);
        assert_eq!(tone(Stretch { densest: 0.1, sparsest: 0.1 }), SCALE[0]);
    }
}
