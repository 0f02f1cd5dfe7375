//! The camera: from pixels to rays in voxel space, and back.
//!
//! Display space is X east, Y north, Z up in metres, with depth multiplied by the vertical exaggeration,
//! relative to the middle of the roaming box: `display = diag(1, 1, −e) · metric · (voxel − centre)`. The
//! voxel-to-display map may mirror, as it does for many surveys. Rays are cast through its inverse from a
//! right-handed camera, so the picture is never mirrored. The camera looks along `forward = (sin a cos h, cos
//! a cos h, −sin h)` for azimuth a (a bearing) and elevation h, with `right = (cos a, −sin a, 0)` and `up =
//! right × forward`, so north is up when it looks straight down.
//!
//! Either the origin (orthographic) or the direction (perspective) of a ray is affine in the pixel position,
//! which gives exact pixel differentials for texture filtering.

use crate::error::SceneError;
use glam::{DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;
use survey::block::{Corner, VoxelBox};

/// The position and projection of the camera.
///
/// ```
/// use render::{Camera, VoxelBox};
/// use survey::{SurveyGeometry, VerticalUnit};
/// let geometry = SurveyGeometry::regular([41, 31, 21], 25.0, 10.0, VerticalUnit::Metres);
/// // The longer side runs east, so its normal is north; the camera looks 35 degrees off it.
/// let bearing = Camera::default().azimuth_for(&geometry, &VoxelBox::of_size([41, 31, 21]));
/// assert!((bearing.abs() - 35.0).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Camera {
    /// Bearing of the viewing direction, degrees clockwise from north. Absent: over a corner of the block,
    /// 35° off the normal of its longer visible side, as near to north as that allows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth_deg: Option<f64>,
    /// Elevation of the camera above the horizontal, degrees in [−90, 90]. Default 28: the top is visible,
    /// but the side faces take more of the picture.
    pub elevation_deg: f64,
    /// Orthographic or perspective projection.
    pub projection: Projection,
    /// Voxel position in the middle of the image. Absent: the projected block is centred.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
    /// Magnification relative to the scale at which the block just fits. Default 1.
    pub zoom: f64,
    /// Shift of the picture to the right and down, as fractions of its width and height. Default 0, 0.
    pub pan: [f64; 2],
    /// Free border around the fitted block, as a fraction of the image's smaller side. Default 0.04.
    pub margin: f64,
}

/// Orthographic or perspective projection.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Projection {
    /// Parallel rays: lengths along each axis have one scale, as in textbook block diagrams.
    #[default]
    Orthographic,
    /// Converging rays.
    Perspective {
        /// Angle that the block's bounding sphere subtends, degrees in (0, 120].
        fov_deg: f64,
    },
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            azimuth_deg: None,
            elevation_deg: 28.0,
            projection: Projection::Orthographic,
            target: None,
            zoom: 1.0,
            pan: [0.0; 2],
            margin: 0.04,
        }
    }
}

/// Angle between the automatic viewing direction and the longer visible side's normal, degrees.
const CORNER_VIEW_DEG: f64 = 35.0;

impl Camera {
    /// Checks that the values can be rendered.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self) -> Result<(), SceneError> {
        let number = SceneError::check_range;
        number("the camera's azimuth", self.azimuth_deg.unwrap_or(0.0), -36_000.0, 36_000.0)?;
        number("the camera's elevation", self.elevation_deg, -90.0, 90.0)?;
        number("the camera's zoom", self.zoom, 1e-3, 1e4)?;
        number("the camera's margin", self.margin, 0.0, 0.45)?;
        self.pan.iter().try_for_each(|&p| number("the camera's pan", p, -1e3, 1e3))?;
        self.target.iter().flatten().try_for_each(|&p| number("the camera's target", p, -1e7, 1e7))?;
        if let Projection::Perspective { fov_deg } = self.projection {
            number("the camera's field of view", fov_deg, 0.1, 120.0)?;
        }
        Ok(())
    }

    /// The bearing in use: the one that is set, or else the automatic one for this box.
    pub fn azimuth_for(&self, geometry: &SurveyGeometry, roaming_box: &VoxelBox) -> f64 {
        self.azimuth_deg.unwrap_or_else(|| {
            let extent = roaming_box.extent();
            let x = geometry.inline_vector;
            let y = geometry.crossline_vector;
            // The face of constant x is as wide as the box is long in y, and vice versa.
            let across_x_is_wider = y.length() * extent.y >= x.length() * extent.x;
            let normal = if across_x_is_wider { x } else { y };
            [normal, -normal]
                .into_iter()
                .flat_map(|n| [CORNER_VIEW_DEG, -CORNER_VIEW_DEG].map(|turn| n.x.atan2(n.y).to_degrees() + turn))
                .map(|bearing| (bearing + 540.0).rem_euclid(360.0) - 180.0)
                .min_by(|a, b| a.abs().total_cmp(&b.abs()))
                .expect("four bearings were compared")
        })
    }
}

/// A ray in voxel space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewRay {
    /// A point in front of the block.
    pub origin: DVec3,
    /// Direction, one voxel long.
    pub direction: DVec3,
    /// Change of the origin for a step of one pixel to the right and down.
    pub origin_step: [DVec3; 2],
    /// Change of the direction (not normalised, at the scale of `direction`) for the same steps.
    pub direction_step: [DVec3; 2],
}

/// A camera fitted to a block and an image: maps pixels to rays in voxel space, and voxels to pixels.
///
/// ```
/// use glam::{DVec2, DVec3};
/// use render::{Camera, View, VoxelBox};
/// use survey::{SurveyGeometry, VerticalUnit};
/// let geometry = SurveyGeometry::regular([11; 3], 10.0, 10.0, VerticalUnit::Metres);
/// let view = View::new(&Camera::default(), &geometry, &VoxelBox::of_size([11; 3]), 1.0, [300, 200]);
/// // The middle of the block is in the middle of the image, and its ray leads back to it.
/// assert!((view.project(DVec3::splat(5.0)) - DVec2::new(150.0, 100.0)).length() < 1e-9);
/// let ray = view.ray(DVec2::new(150.0, 100.0));
/// assert!((DVec3::splat(5.0) - ray.origin).cross(ray.direction).length() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct View {
    display_from_voxel: DMat3,
    voxel_from_display: DMat3,
    centre_voxel: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Distance of the eye (perspective) or of the ray origins (orthographic) from the centre of the box, m.
    distance: f64,
    perspective: bool,
    /// Pixels per metre (orthographic) or per unit of tangent (perspective).
    scale: f64,
    /// View coordinates of the point at `centre_px`.
    centre: DVec2,
    centre_px: DVec2,
}

impl View {
    /// Fits the camera to the box. Camera and box must be valid.
    pub fn new(
        camera: &Camera,
        geometry: &SurveyGeometry,
        roaming_box: &VoxelBox,
        exaggeration: f64,
        size_px: [u32; 2],
    ) -> Self {
        let display_from_voxel =
            DMat3::from_diagonal(DVec3::new(1.0, 1.0, -exaggeration)) * geometry.metric_from_voxel();
        let centre_voxel = roaming_box.centre();
        let (sin_a, cos_a) = camera.azimuth_for(geometry, roaming_box).to_radians().sin_cos();
        let (sin_h, cos_h) = camera.elevation_deg.to_radians().sin_cos();
        let forward = DVec3::new(sin_a * cos_h, cos_a * cos_h, -sin_h);
        let right = DVec3::new(cos_a, -sin_a, 0.0);
        let corners = roaming_box.corners().map(|c| display_from_voxel * (c - centre_voxel));
        let radius = corners.iter().map(|c| c.length()).fold(0.0, f64::max);
        let (perspective, distance) = match camera.projection {
            Projection::Orthographic => (false, radius * 1.01),
            Projection::Perspective { fov_deg } => (true, radius / (fov_deg.to_radians() * 0.5).sin() * 1.0001),
        };
        let mut view = Self {
            display_from_voxel,
            voxel_from_display: display_from_voxel.inverse(),
            centre_voxel,
            right,
            up: right.cross(forward),
            forward,
            distance,
            perspective,
            scale: 1.0,
            centre: DVec2::ZERO,
            centre_px: DVec2::ZERO,
        };
        let flat = corners.map(|c| view.flatten(c));
        let low = flat.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = flat.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let size = DVec2::new(f64::from(size_px[0]), f64::from(size_px[1]));
        let free = size - 2.0 * camera.margin * size.min_element();
        view.scale = (free / (high - low).max(DVec2::splat(1e-12))).min_element() * camera.zoom;
        view.centre = match camera.target {
            Some(target) => view.flatten(display_from_voxel * (DVec3::from_array(target) - centre_voxel)),
            None => (low + high) * 0.5,
        };
        view.centre_px = size * (DVec2::splat(0.5) + DVec2::from_array(camera.pan));
        view
    }

    /// View coordinates (right, up) of a display position, in metres or tangents.
    fn flatten(&self, display: DVec3) -> DVec2 {
        let flat = DVec2::new(display.dot(self.right), display.dot(self.up));
        if self.perspective { flat / (display.dot(self.forward) + self.distance).max(1e-9) } else { flat }
    }

    /// Pixel position (x right, y down, pixel centres at halves) of a voxel position.
    pub fn project(&self, voxel: DVec3) -> DVec2 {
        let flat = self.flatten(self.display_from_voxel * (voxel - self.centre_voxel)) - self.centre;
        self.centre_px + DVec2::new(flat.x, -flat.y) * self.scale
    }

    /// The unit direction in display space of a vector that is given as right, up and towards the viewer.
    pub(crate) fn display_direction(&self, eye: DVec3) -> DVec3 {
        (self.right * eye.x + self.up * eye.y - self.forward * eye.z).normalize_or_zero()
    }

    /// The affine map from voxel to eye space: right, up and forward in metres of display space. Forward is
    /// measured from the plane or point where rays start.
    pub fn eye_from_voxel(&self) -> (DMat3, DVec3) {
        let rows = DMat3::from_cols(self.right, self.up, self.forward).transpose();
        let linear = rows * self.display_from_voxel;
        (linear, DVec3::new(0.0, 0.0, self.distance) - linear * self.centre_voxel)
    }

    /// The inverse of [`Self::eye_from_voxel`] for view coordinates (metres right and up, or tangents). At a
    /// depth, the voxel position is `origin + depth · direction`.
    pub(crate) fn depth_ray(&self, flat: DVec2) -> (DVec3, DVec3) {
        let spread = self.voxel_from_display * (self.right * flat.x + self.up * flat.y);
        let forward = self.voxel_from_display * self.forward;
        let back = self.centre_voxel - forward * self.distance;
        if self.perspective { (back, forward + spread) } else { (back + spread, forward) }
    }

    /// The ray through a pixel position.
    pub fn ray(&self, pixel: DVec2) -> ViewRay {
        let offset = (pixel - self.centre_px) / self.scale;
        let flat = self.centre + DVec2::new(offset.x, -offset.y);
        let spread = self.right * flat.x + self.up * flat.y;
        let step = [self.right / self.scale, -self.up / self.scale].map(|s| self.voxel_from_display * s);
        let back = self.centre_voxel - self.voxel_from_display * (self.forward * self.distance);
        if self.perspective {
            let direction = self.voxel_from_display * (self.forward + spread);
            let norm = 1.0 / direction.length();
            ViewRay {
                origin: back,
                direction: direction * norm,
                origin_step: [DVec3::ZERO; 2],
                direction_step: step.map(|s| s * norm),
            }
        } else {
            let direction = self.voxel_from_display * self.forward;
            ViewRay {
                origin: back + self.voxel_from_display * spread,
                direction: direction.normalize(),
                origin_step: step,
                direction_step: [DVec3::ZERO; 2],
            }
        }
    }

    /// Direction from a voxel position to the camera, in voxel space (not normalised).
    pub fn towards_camera(&self, voxel: DVec3) -> DVec3 {
        if self.perspective {
            self.centre_voxel - self.voxel_from_display * (self.forward * self.distance) - voxel
        } else {
            -(self.voxel_from_display * self.forward)
        }
    }

    /// Pixels of the picture to a horizontal metre of rock across the line of sight; in perspective, in the middle of
    /// the box.
    pub fn pixels_per_metre(&self) -> f64 {
        if self.perspective { self.scale / self.distance } else { self.scale }
    }

    /// Whether the projection is a perspective.
    pub fn is_perspective(&self) -> bool {
        self.perspective
    }

    /// The linear part of the map from voxel to display space (X east, Y north, Z up, exaggerated), metres
    /// per voxel.
    pub fn display_from_voxel(&self) -> DMat3 {
        self.display_from_voxel
    }

    /// The corner of the box nearest to the camera, where a cut-out is seen best.
    pub fn nearest_corner(&self, roaming_box: &VoxelBox) -> Corner {
        let towards = self.towards_camera(roaming_box.centre());
        match (towards.x > 0.0, towards.y > 0.0) {
            (false, false) => Corner::MinMin,
            (false, true) => Corner::MinMax,
            (true, false) => Corner::MaxMin,
            (true, true) => Corner::MaxMax,
        }
    }
}

#[cfg(test)]
mod tests;
