//! A block as a neutral model, which every writer walks: faces with their pictures, surfaces, wells, scenes, notes.
//!
//! Positions are voxels (x = inline index, y = crossline index, z = sample index downwards), so that a reader of the
//! model finds inline, crossline and depth of any point; [`Model::geometry`] leads to metres.

use glam::DVec3;
use image::RgbImage;
use model::section::SectionPlane;
use render::Scene;
use survey::SurveyGeometry;
use ttf::{Colour, RgbaFunction};

/// Everything that a review shows.
pub struct Model {
    /// Name of the project.
    pub title: String,
    /// The program and the data behind it, in a sentence.
    pub provenance: Vec<String>,
    /// What must be said on the face of a block that nobody interpreted.
    pub warning: Option<String>,
    /// The lattice.
    pub geometry: SurveyGeometry,
    /// Layers, deepest first: the index is the layer's number.
    pub layers: Vec<Layer>,
    /// Horizons, youngest first.
    pub horizons: Vec<Surface>,
    /// Faults.
    pub faults: Vec<Surface>,
    /// Wells.
    pub wells: Vec<WellPath>,
    /// Pictures of faces, shared by scenes.
    pub covers: Vec<Cover>,
    /// Scenes, at least one.
    pub scenes: Vec<SceneModel>,
    /// Stacks of sections: inlines, crosslines, slices.
    pub sections: Vec<Stack>,
    /// Notes on places.
    pub notes: Vec<Note>,
    /// The raw data: name of the volume and colours; absent without a volume.
    pub raw: Option<RawScale>,
}

impl Model {
    /// Whether a face or a horizon shows what was filled or extrapolated, not picked.
    pub(crate) fn has_unpicked(&self) -> bool {
        let is_unpicked = |cover: &Cover| cover.data.pixels().any(|pixel| pixel.0[2] > 0);
        self.horizons.iter().any(|horizon| horizon.is_picked.contains(&false)) || self.covers.iter().any(is_unpicked)
    }
}

/// The scale of 8-bit raw values.
pub struct RawScale {
    /// Name of the volume.
    pub volume: String,
    /// Colours; byte 1 is the low end of the domain, byte 255 its high end.
    pub function: RgbaFunction,
    /// Colour of missing samples (byte 0); absent: they leave the illustration unchanged.
    pub no_data: Option<Colour>,
}

/// A layer of the legend.
pub struct Layer {
    /// Its name.
    pub name: String,
    /// Its patterns, which name rocks.
    pub rock: String,
    /// The unit of the time scale whose colour it has; empty where none has it.
    pub age: String,
    /// Its colour.
    pub colour: Colour,
    /// Colour and pattern as a small picture.
    pub swatch: RgbImage,
    /// Whether a scene shows it.
    pub is_seen: bool,
}

/// The pictures of a rectangle of a plane, s to the right, t down.
pub struct Cover {
    /// Where it lies.
    pub rectangle: SectionPlane,
    /// The illustration; absent without an interpretation.
    pub illustrated: Option<RgbImage>,
    /// Whether the illustration has no drawn lines, as that of the ground.
    pub is_smooth: bool,
    /// Nodes from corner to corner: raw value (0 = none, 1 to 255 over the domain), layer + 1 (0 = none), and 255
    /// where the horizon nearest within the layer was not picked.
    pub data: RgbImage,
}

/// Triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Corners.
    pub points: Vec<DVec3>,
    /// Indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

/// A part of a block that has one picture.
#[derive(Clone)]
pub struct Face {
    /// Index among the covers.
    pub cover: usize,
    /// What it is called: `face 1`, `wall 2`, `ground`.
    pub name: String,
    /// Its triangles.
    pub mesh: Mesh,
}

/// What a line on the block is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineKind {
    /// An edge of the block.
    Edge,
    /// A horizon.
    Horizon {
        /// Whether it was picked there.
        is_picked: bool,
    },
    /// A fault.
    Fault,
}

/// The faces of a block and the lines on them.
#[derive(Clone, Default)]
pub struct Block {
    /// Faces.
    pub faces: Vec<Face>,
    /// Lines, as pieces of two points.
    pub lines: Vec<(LineKind, [DVec3; 2])>,
}

/// A scene.
pub struct SceneModel {
    /// Its name.
    pub name: String,
    /// Camera, exaggeration, blend, box and widths of lines.
    pub scene: Scene,
    /// The block with its cut-outs.
    pub cut: Block,
    /// The names of cut-outs that can be switched one by one.
    pub cuts: Vec<String>,
    /// The block without its ground for each set of those cut-outs: bit n of the index stands for cut-out n. Empty where
    /// nothing is switched.
    pub variants: Vec<Block>,
    /// The parts of the ground with the set of cut-outs in which each lies; empty where nothing is switched.
    pub ground: Vec<(u32, Block)>,
    /// The picture for readers that show no 3D.
    pub picture: RgbImage,
}

/// A horizon or fault.
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Its colour.
    pub colour: Colour,
    /// Its triangles; the first [`Self::below`] of them lie below the ground, where that is shown.
    pub mesh: Mesh,
    /// Triangles below the ground.
    pub below: usize,
    /// For each corner, whether the place was picked (or tracked); not filled or extrapolated.
    pub is_picked: Vec<bool>,
    /// Share of the surface that was picked, 0 to 1.
    pub picked_share: f64,
    /// Largest distance between the triangles and the surface, m.
    pub deviation_m: f64,
    /// The distance within which 99 % of the places are that were compared, m.
    pub usual_deviation_m: f64,
}

impl Surface {
    /// The triangles that a scene with or without a ground shows.
    pub fn shown(&self, has_ground: bool) -> &[[u32; 3]] {
        if has_ground { &self.mesh.triangles[..self.below] } else { &self.mesh.triangles }
    }
}

/// A well.
pub struct WellPath {
    /// Its name.
    pub name: String,
    /// Its path.
    pub path: Vec<DVec3>,
    /// Its tops.
    pub tops: Vec<(String, DVec3)>,
}

/// Sections along one axis.
pub struct Stack {
    /// 0 = inlines, 1 = crosslines, 2 = slices.
    pub axis: usize,
    /// The sections, in order.
    pub places: Vec<SectionPlace>,
}

/// A section of a stack.
pub struct SectionPlace {
    /// Its voxel position along the axis.
    pub at: f64,
    /// Index of its cover.
    pub cover: usize,
    /// Horizons and faults on it, as pieces of two points.
    pub lines: Vec<(LineKind, [DVec3; 2])>,
}

/// A note on a place.
pub struct Note {
    /// Its text.
    pub text: String,
    /// Where it points, voxels.
    pub at: DVec3,
    /// The scene that shows it; absent: all.
    pub scene: Option<String>,
}
