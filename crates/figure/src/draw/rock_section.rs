//! The rock on a section: the face of a block that ends there, looked at straight on, as blocks are drawn.
//!
//! The section is a rectangle of (s, t), s to the right and t down on the page. The block behind it is one voxel thick;
//! the camera looks along the section's normal with s to its right. The scale down is the scale across times the
//! exaggeration of the scene, so that pictures and paths have the page's proportions. Beyond what scenes can be
//! exaggerated the picture is stretched.

use glam::{DVec2, DVec3};
use model::section::SectionPlane;
use render::{Background, Camera, Media, Outlines, Projection, Scene, VoxelBox, WellStyle};
use survey::SurveyGeometry;
use survey::block::CutShape;

/// How thick the block behind a section is, voxels, and how thick it is at least where the survey ends.
const THICK: f64 = 1.0;
const THINNEST: f64 = 0.01;
/// Exaggerations that a scene is given.
const EXAGGERATIONS: [f64; 2] = [0.02, 50.0];
/// Components of unit vectors below this are none.
const FLAT: f64 = 1e-9;

/// A part of a section.
#[derive(Debug, Clone, Copy)]
pub struct SectionRange {
    /// Its least and largest s.
    pub s: [f64; 2],
    /// Its least and largest t.
    pub t: [f64; 2],
}

impl SectionRange {
    /// All of a plane.
    pub fn of(plane: &SectionPlane) -> Self {
        Self { s: [0.0, plane.extent[0]], t: [0.0, plane.extent[1]] }
    }

    fn corners(&self) -> [DVec2; 4] {
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]| DVec2::new(self.s[s], self.t[t]))
    }

    fn middle(&self) -> DVec2 {
        DVec2::new(0.5 * (self.s[0] + self.s[1]), 0.5 * (self.t[0] + self.t[1]))
    }

    fn size(&self) -> DVec2 {
        DVec2::new(self.s[1] - self.s[0], self.t[1] - self.t[0])
    }
}

/// The scene whose picture is part of a section: as many pixels as it is asked for across, and down those that its
/// proportions need where a page asks for `size_px`. What it shows else is that of `like`. `None` where the part, or the
/// survey across the section, has no extent.
///
/// An inline of a survey of 41 × 31 × 21 samples, 25 by 25 by 10 m, on a page with equal scales:
/// ```
/// use figure::draw::rock_section::{SectionRange, scene};
/// use glam::{DVec2, DVec3};
/// use model::section::SectionPlane;
/// use render::{Scene, VoxelBox};
/// use survey::{SurveyGeometry, VerticalUnit};
///
/// let geometry = SurveyGeometry::regular([41, 31, 21], 25.0, 10.0, VerticalUnit::Metres);
/// let whole = VoxelBox::of_size(geometry.size());
/// let plane = SectionPlane::inline(12.0, whole.low(), whole.high());
/// let scene = scene(&plane, SectionRange::of(&plane), &geometry, &Scene::default(), [600, 160]).unwrap();
/// let view = scene.view(&geometry);
/// // 30 crosslines to the right and 20 samples down fill the picture.
/// assert!(view.project(DVec3::new(12.0, 0.0, 0.0)).distance(DVec2::ZERO) < 1e-6);
/// assert!(view.project(DVec3::new(12.0, 30.0, 20.0)).distance(DVec2::new(600.0, 160.0)) < 1e-6);
/// ```
pub fn scene(
    plane: &SectionPlane,
    part: SectionRange,
    geometry: &SurveyGeometry,
    like: &Scene,
    size_px: [u32; 2],
) -> Option<Scene> {
    let metric = geometry.metric_from_voxel();
    let (across, down) = (metric * plane.s_axis, metric * plane.t_axis);
    let metres = part.size() * DVec2::new(across.length(), down.length());
    if !(metres.is_finite() && metres.min_element() > 0.0 && size_px.iter().all(|side| *side > 0)) {
        return None;
    }
    let right = across.truncate().normalize_or_zero();
    let azimuth = (-right.y).atan2(right.x);
    let is_upright = down.truncate().length() < FLAT * down.length();
    let elevation_deg = match is_upright {
        true => 0.0,
        // Seen from below where that has t down on the page.
        false if right.perp_dot(down.truncate()) < 0.0 => 90.0,
        false => -90.0,
    };
    let (sin_a, cos_a) = azimuth.sin_cos();
    let forward = match is_upright {
        true => DVec3::new(sin_a, cos_a, 0.0),
        // Depth runs down in metric space.
        false => DVec3::new(0.0, 0.0, if elevation_deg > 0.0 { 1.0 } else { -1.0 }),
    };
    let (block, cut) = behind(plane, &part, geometry, forward)?;
    let asked = DVec2::new(f64::from(size_px[0]), f64::from(size_px[1]));
    let exaggeration = match is_upright {
        true => (asked.y / metres.y / (asked.x / metres.x)).clamp(EXAGGERATIONS[0], EXAGGERATIONS[1]),
        false => 1.0,
    };
    let height = (asked.x / metres.x * metres.y * exaggeration).round().max(1.0);
    let camera = Camera {
        azimuth_deg: Some(azimuth.to_degrees()),
        elevation_deg,
        projection: Projection::Orthographic,
        target: Some(plane.voxel(part.middle()).to_array()),
        zoom: 1.0,
        pan: [0.0; 2],
        margin: 0.0,
    };
    let mut scene = Scene {
        size_px: [size_px[0], height as u32],
        exaggeration,
        background: Background::Transparent,
        face_tone: 0.0,
        roaming_box: Some(block),
        camera,
        ground: None,
        water: None,
        outlines: Outlines::none(),
        cut_outs: Vec::new(),
        cut_shapes: cut.into_iter().collect(),
        wells: WellStyle { radius: 0.0, ..like.wells },
        media: Media::default(),
        labels: Vec::new(),
        ..like.clone()
    };
    // As large as the page has it.
    let view = scene.view(geometry);
    let [from, to] = part.s.map(|s| view.project(plane.voxel(DVec2::new(s, part.middle().y))));
    scene.camera.zoom = asked.x / from.distance(to);
    scene.camera.zoom.is_finite().then_some(scene)
}

/// The block behind part of a section, seen along `forward` (metric space, x and y of the map and z down), and what has
/// to be cut from it for it to end there.
fn behind(
    plane: &SectionPlane,
    part: &SectionRange,
    geometry: &SurveyGeometry,
    forward: DVec3,
) -> Option<(VoxelBox, Option<CutShape>)> {
    let last = VoxelBox::of_size(geometry.size()).high();
    let corners = part.corners().map(|st| plane.voxel(st));
    let mut low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min).max(DVec3::ZERO);
    let mut high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max).min(last);
    let along = [plane.s_axis, plane.t_axis];
    let flat = (0..3).find(|&axis| along.iter().all(|direction| direction[axis].abs() < FLAT));
    let back = (geometry.metric_from_voxel().inverse() * forward).normalize_or_zero();
    if let Some(axis) = flat {
        let at = low[axis];
        if back[axis] > 0.0 {
            high[axis] = (at + THICK).min(last[axis]);
            low[axis] = at.min(high[axis] - THINNEST);
        } else {
            low[axis] = (at - THICK).max(0.0);
            high[axis] = at.max(low[axis] + THINNEST);
        }
        let is_within = low.cmpge(DVec3::ZERO).all() && high.cmple(last).all();
        return is_within.then_some((VoxelBox { min: low.to_array(), max: high.to_array() }, None));
    }
    // A wall across the lattice: the box around it, without what lies before the wall.
    for axis in 0..2 {
        let short = (THICK - (high[axis] - low[axis])).max(0.0);
        low[axis] = (low[axis] - 0.5 * short).max(0.0);
        high[axis] = (high[axis] + 0.5 * short).min(last[axis]);
    }
    let through = plane.voxel(part.middle()) - back * THINNEST;
    let [x, y] = [geometry.inline_vector, geometry.crossline_vector].map(|step| -forward.truncate().dot(step));
    let cut = CutShape::Plane { through: through.to_array(), normal: [x, y, 0.0] };
    Some((VoxelBox { min: low.to_array(), max: high.to_array() }, Some(cut)))
}
