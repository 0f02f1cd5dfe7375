//! Scenes that follow one another, for animations: around the block, from illustration to raw data, through the block,
//! from one scene to another.
//!
//! A motion is a function from a share of the way, 0 to 1, to a scene. It depends on nothing else, so frames can be drawn
//! in any order. Voxels, degrees.

use render::{Scene, View, VoxelBox};
use survey::SurveyGeometry;

/// How much of the block a sweep leaves at its end.
const LEFT_OVER: f64 = 0.06;
/// Steps around the block at which its picture is measured.
const AROUND: usize = 72;

/// A motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// The camera goes around the block, by so many degrees clockwise as seen from above.
    Turntable {
        /// The whole turn.
        turn_deg: f64,
    },
    /// From illustration to raw data.
    Blend,
    /// The block is cut away from its nearer side (from above along the vertical axis), so that a section moves through
    /// it.
    Section {
        /// 0 = across inlines, 1 = across crosslines, 2 = downwards.
        axis: usize,
    },
    /// To another scene: camera, box, blend, exaggeration and the ground's opacity change smoothly, cut-outs too where
    /// both scenes have as many; all else changes halfway.
    To(Box<Scene>),
}

impl Motion {
    /// Whether the end leads into the beginning: a whole number of turns.
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Turntable { turn_deg } if turn_deg % 360.0 == 0.0)
    }

    /// The scene at a share of the way from `start`, both valid.
    ///
    /// ```
    /// use project::pictures::Motion;
    /// use render::Scene;
    /// use survey::{SurveyGeometry, VerticalUnit};
    /// let geometry = SurveyGeometry::regular([41, 31, 21], 25.0, 10.0, VerticalUnit::Metres);
    /// let half = Motion::Blend.scene(&Scene::default(), &geometry, 0.5);
    /// assert_eq!(half.blend, 0.5);
    /// ```
    #[must_use]
    pub fn scene(&self, start: &Scene, geometry: &SurveyGeometry, share: f64) -> Scene {
        match self {
            Self::Turntable { turn_deg } => turned(start, geometry, turn_deg * share),
            Self::Blend => Scene { blend: share as f32, ..start.clone() },
            Self::Section { axis } => swept(start, geometry, *axis, share),
            Self::To(end) => between(start, end, geometry, share),
        }
    }
}

/// The camera turned by an angle, at one scale all around and around the middle of the box.
fn turned(start: &Scene, geometry: &SurveyGeometry, turn_deg: f64) -> Scene {
    let block = start.box_in(geometry);
    let azimuth = start.camera.azimuth_for(geometry, &block);
    let at = |turn_deg: f64| {
        let mut scene = start.clone();
        scene.camera.azimuth_deg = Some((azimuth + turn_deg).rem_euclid(360.0));
        scene.camera.target = start.camera.target.or(Some(block.centre().to_array()));
        scene
    };
    let scale = |scene: &Scene| View::pixels_per_metre(&scene.view(geometry));
    let smallest = (0..AROUND).map(|n| scale(&at(360.0 * n as f64 / AROUND as f64))).fold(f64::MAX, f64::min);
    let mut scene = at(turn_deg);
    scene.camera.zoom *= smallest / scale(&scene);
    scene
}

/// The block without the part that a section has passed.
fn swept(start: &Scene, geometry: &SurveyGeometry, axis: usize, share: f64) -> Scene {
    let block = start.box_in(geometry);
    let mut cut = block;
    let passed = share * (1.0 - LEFT_OVER) * (block.max[axis] - block.min[axis]);
    let from_high = start.view(geometry).nearest_corner(&block).at_max();
    if from_high.get(axis) == Some(&true) {
        cut.min[axis] = block.max[axis] - passed;
    } else {
        cut.max[axis] = block.min[axis] + passed;
    }
    Scene { cut_outs: if passed > 0.0 { vec![cut] } else { Vec::new() }, ..start.clone() }
}

fn mixed(from: f64, to: f64, share: f64) -> f64 {
    from + (to - from) * share
}

fn mixed_box(from: &VoxelBox, to: &VoxelBox, share: f64) -> VoxelBox {
    let corner = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|axis| mixed(a[axis], b[axis], share));
    VoxelBox { min: corner(from.min, to.min), max: corner(from.max, to.max) }
}

/// A scene between two, which begins and ends slowly.
fn between(start: &Scene, end: &Scene, geometry: &SurveyGeometry, share: f64) -> Scene {
    let eased = share * share * (3.0 - 2.0 * share);
    let mix = |from: f64, to: f64| mixed(from, to, eased);
    let mut scene = if share < 0.5 { start.clone() } else { end.clone() };
    scene.in_motion = true;
    scene.size_px = start.size_px;
    scene.samples = start.samples;
    let boxes = [start.box_in(geometry), end.box_in(geometry)];
    scene.roaming_box = start.roaming_box.or(end.roaming_box).map(|_| mixed_box(&boxes[0], &boxes[1], eased));
    let azimuths = [start.camera.azimuth_for(geometry, &boxes[0]), end.camera.azimuth_for(geometry, &boxes[1])];
    // The shorter way around.
    let turn = (azimuths[1] - azimuths[0] + 540.0).rem_euclid(360.0) - 180.0;
    let camera = &mut scene.camera;
    camera.azimuth_deg = Some(azimuths[0] + turn * eased);
    camera.elevation_deg = mix(start.camera.elevation_deg, end.camera.elevation_deg);
    // Equal steps of magnification look equal.
    camera.zoom = mix(start.camera.zoom.ln(), end.camera.zoom.ln()).exp();
    camera.margin = mix(start.camera.margin, end.camera.margin);
    camera.pan = std::array::from_fn(|axis| mix(start.camera.pan[axis], end.camera.pan[axis]));
    if start.camera.target.is_some() || end.camera.target.is_some() {
        let target = |scene: &Scene, block: &VoxelBox| scene.camera.target.unwrap_or(block.centre().to_array());
        let (from, to) = (target(start, &boxes[0]), target(end, &boxes[1]));
        camera.target = Some(std::array::from_fn(|axis| mix(from[axis], to[axis])));
    }
    scene.blend = mix(f64::from(start.blend), f64::from(end.blend)) as f32;
    scene.exaggeration = mix(start.exaggeration.ln(), end.exaggeration.ln()).exp();
    scene.global_frequency =
        mix(f64::from(start.global_frequency).ln(), f64::from(end.global_frequency).ln()).exp() as f32;
    scene.face_tone = mix(f64::from(start.face_tone), f64::from(end.face_tone)) as f32;
    if let (Some(from), Some(to), Some(ground)) = (start.ground, end.ground, &mut scene.ground) {
        ground.opacity = mix(f64::from(from.opacity), f64::from(to.opacity)) as f32;
        ground.hill_shade = mix(f64::from(from.hill_shade), f64::from(to.hill_shade)) as f32;
    }
    if start.cut_outs.len() == end.cut_outs.len() {
        let pairs = start.cut_outs.iter().zip(&end.cut_outs);
        scene.cut_outs = pairs.map(|(from, to)| mixed_box(from, to, eased)).collect();
    }
    // What a box has moved away from is no cut-out of it.
    let block = scene.box_in(geometry);
    scene.cut_outs.retain(|cut| cut.intersection(&block).is_some());
    scene
}
