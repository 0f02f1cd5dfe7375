//! Scenes that follow one another, for animations: around the block, from illustration to raw data, through the block,
//! from one scene to another.
//!
//! A motion is a function from a share of the way, 0 to 1, to a scene. It depends on nothing else, so frames can be drawn
//! in any order. Voxels, degrees.

use crate::camera::View;
use crate::scene::Scene;
use survey::SurveyGeometry;
use survey::block::VoxelBox;

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
    /// use render::{Motion, Scene};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use crate::scene::Ground;
    use survey::VerticalUnit;
    use survey::block::Corner;

    fn geometry() -> SurveyGeometry {
        SurveyGeometry::regular([61, 31, 21], 25.0, 10.0, VerticalUnit::Metres)
    }

    fn start() -> Scene {
        let block = VoxelBox { min: [5.0, 0.0, 0.0], max: [60.0, 30.0, 20.0] };
        let cut_outs = vec![block.corner_cut(Corner::MinMax, [0.4, 0.4])];
        Scene { roaming_box: Some(block), cut_outs, ground: Some(Ground::default()), ..Scene::default() }
    }

    fn end() -> Scene {
        let mut scene = Scene { blend: 1.0, exaggeration: 4.0, ground: Some(Ground::default()), ..Scene::default() };
        scene.camera.azimuth_deg = Some(-100.0);
        scene.camera.zoom = 2.0;
        scene.camera.elevation_deg = 60.0;
        scene.cut_outs = vec![VoxelBox::of_size([61, 31, 21]).corner_cut(Corner::MaxMin, [0.6, 0.5])];
        scene
    }

    fn motions() -> Vec<Motion> {
        let mut all = vec![Motion::Turntable { turn_deg: 360.0 }, Motion::Turntable { turn_deg: -90.0 }, Motion::Blend];
        all.extend((0..3).map(|axis| Motion::Section { axis }));
        all.push(Motion::To(Box::new(end())));
        all
    }

    #[test]
    fn every_scene_of_every_motion_can_be_drawn() {
        for projection in [Projection::Orthographic, Projection::Perspective { fov_deg: 35.0 }] {
            let mut first = start();
            first.camera.projection = projection;
            for motion in motions() {
                for step in 0..=40 {
                    let scene = motion.scene(&first, &geometry(), f64::from(step) / 40.0);
                    scene.validate(&geometry()).unwrap_or_else(|error| panic!("{motion:?} at {step}: {error}"));
                }
            }
        }
    }

    #[test]
    fn a_turn_keeps_the_scale_and_the_middle_and_closes() {
        let whole = Motion::Turntable { turn_deg: 360.0 };
        assert!(whole.is_closed() && !Motion::Turntable { turn_deg: 90.0 }.is_closed());
        let scenes: Vec<Scene> = (0..=24).map(|n| whole.scene(&start(), &geometry(), f64::from(n) / 24.0)).collect();
        let view = |scene: &Scene| scene.view(&geometry());
        let middle = start().box_in(&geometry()).centre();
        let block = start().box_in(&geometry());
        for scene in &scenes {
            let (seen, first) = (view(scene), view(&scenes[0]));
            assert!((seen.pixels_per_metre() / first.pixels_per_metre() - 1.0).abs() < 1e-9);
            assert!((seen.project(middle) - first.project(middle)).length() < 1e-6);
            for corner in block.corners() {
                let at = seen.project(corner);
                assert!(at.min_element() >= 0.0 && at.x <= 1600.0 && at.y <= 1200.0, "{at}");
            }
        }
        assert!((scenes[0].camera.azimuth_deg.unwrap() - scenes[24].camera.azimuth_deg.unwrap()).abs() < 1e-9);
    }

    #[test]
    fn a_section_moves_from_the_nearer_side_to_the_far_one() {
        for axis in 0..3 {
            let motion = Motion::Section { axis };
            assert!(motion.scene(&start(), &geometry(), 0.0).cut_outs.is_empty());
            let cut = |share| motion.scene(&start(), &geometry(), share).cut_outs[0];
            let block = start().box_in(&geometry());
            let (early, late) = (cut(0.25), cut(1.0));
            assert!(late.extent().as_ref()[axis] > 3.9 * early.extent().as_ref()[axis]);
            assert!(late.extent().as_ref()[axis] < block.extent().as_ref()[axis]);
            // The part that is gone lies towards the viewer.
            let towards = start().view(&geometry()).towards_camera(block.centre());
            let gone = early.centre() - block.centre();
            assert!(gone.as_ref()[axis] * towards.as_ref()[axis] > 0.0, "axis {axis}");
        }
    }

    #[test]
    fn between_two_scenes_the_ends_are_the_scenes_and_the_way_is_the_shorter_one() {
        let motion = Motion::To(Box::new(end()));
        let at = |share| motion.scene(&start(), &geometry(), share);
        let (first, last) = (at(0.0), at(1.0));
        assert_eq!((first.cut_outs, first.blend), (start().cut_outs, 0.0));
        assert_eq!((last.cut_outs, last.blend, last.exaggeration), (end().cut_outs, 1.0, 4.0));
        assert!((last.camera.zoom - 2.0).abs() < 1e-9 && last.camera.elevation_deg == 60.0);
        let turned: Vec<f64> = (0..=10).map(|n| at(f64::from(n) / 10.0).camera.azimuth_deg.unwrap()).collect();
        assert!((turned[10] - turned[0]).abs() <= 180.0);
        assert!(turned.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 40.0), "{turned:?}");
    }
}
