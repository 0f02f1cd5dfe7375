//! A picture as paths: what a vector figure is made of.
//!
//! Faces of the block and its cut-outs become areas, one for each connected piece of a layer, from the exact section of
//! the model on that face. A pattern is the tile's own drawing ([`ttf::TileDrawing`]), carried point by point through
//! the inverse of the map from rock to pattern, so that it bends with the layers and has no resolution (`pattern`).
//! Lines are those that the picture's outlines are stroked from, hidden ones gone.
//!
//! What is no path stays pixels: the relief of the ground and wells ([`VectorBlock::over`]), and areas whose pattern
//! is an image for a tile ([`AreaFill::Picture`]). Scenes of raw data, volume rendering and textures
//! by value are pictures altogether: [`vectors`] then gives lines alone.
//!
//! Where a face is seen from both sides of the limit between two mappings ([`ttf::coordinates`]), pictures blend the
//! two; here a piece of the pattern is drawn in the mapping with the larger weight.
//!
//! Space: pixels of the scene, x right and y down.

mod face;
mod join;
mod outline;
mod over;
mod pattern;
mod sections;
mod typical;
mod visible;

pub use sections::{SeenSection, sections_of, seen_sections};
pub(crate) use visible::rock_cells;

use crate::cache::Kept;
use crate::error::RenderError;
use crate::inputs::Inputs;
use crate::leaves::FaceData;
use crate::media::Faces;
use crate::outline::draw::OutlineLines;
use crate::resolved_scene::ResolvedScene;
use crate::scene::Scene;
use face::face_areas;
use glam::DVec2;
use image::RgbaImage;
use join::joined;
use over::over;
use std::sync::Arc;
use survey::Progress;
use ttf::{Colour, TextureLibrary};

/// The paths of a picture, pixels.
#[derive(Debug, Clone, Default)]
pub struct VectorBlock {
    /// Whether `areas` are all faces of rock; otherwise the picture has to be painted below the lines.
    pub has_areas: bool,
    /// Areas of rock. What is seen of those of two faces does not overlap; of one face later ones lie above.
    pub areas: Vec<VectorArea>,
    /// For each face, by its number in the areas, what the rock of each of several nearer faces hides of it: rings by the
    /// non-zero rule. It comes on top of [`VectorArea::seen`], in which only faces that are all rock hide others.
    pub hidden: Vec<Vec<Vec<Vec<DVec2>>>>,
    /// Lines over them, in the order of drawing.
    pub lines: Vec<VectorLine>,
    /// The ground and wells over the areas, straight alpha, as large as the picture that was asked for; `None`: nowhere.
    pub over: Option<Arc<RgbaImage>>,
}

/// A connected piece of a layer on a face: its colour, or the pattern of the part of it in one fault block.
#[derive(Debug, Clone)]
pub struct VectorArea {
    /// Layer, 0 = deepest.
    pub layer: u16,
    /// The number of its face.
    pub face: usize,
    /// Its outer ring and holes, by the even-odd rule.
    pub rings: Vec<Vec<DVec2>>,
    /// The part of its face that is seen, in convex pieces that only share edges; `None`: all of it.
    pub seen: Option<Vec<Vec<DVec2>>>,
    /// The part of it that is filled, by the non-zero rule; `None`: all of it.
    pub band: Option<Vec<Vec<DVec2>>>,
    /// What it is filled with.
    pub fill: AreaFill,
}

/// What an area is filled with.
#[derive(Debug, Clone)]
pub enum AreaFill {
    /// A colour.
    Colour(Colour),
    /// Parts of a pattern, back to front, which end at the area's rings but for their width; the colour lies below.
    Pattern(Vec<PatternPart>),
    /// The painted picture, to be clipped at the area's rings.
    Picture,
}

/// A part of a pattern: pieces that look alike.
#[derive(Debug, Clone)]
pub struct PatternPart {
    /// How it is drawn.
    pub paint: PatternPaint,
    /// Colour.
    pub colour: Colour,
    /// 0 = clear … 1 = opaque.
    pub opacity: f32,
    /// Where.
    pub lines: Vec<Polyline>,
}

/// How a part of a pattern is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum PatternPaint {
    /// Filled.
    Area {
        /// Whether by the even-odd rule; else by the non-zero one.
        even_odd: bool,
    },
    /// Stroked.
    Line {
        /// Width, pixels.
        width_px: f64,
        /// Dashes and gaps in turn, pixels.
        dashes_px: Vec<f64>,
        /// Whether ends are round.
        round: bool,
    },
}

/// Straight lines from point to point.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    /// Points; the first one is not repeated.
    pub points: Vec<DVec2>,
    /// Whether the last point is joined with the first.
    pub closed: bool,
}

/// A line over the areas.
#[derive(Debug, Clone)]
pub struct VectorLine {
    /// What it is.
    pub kind: VectorLineKind,
    /// Width, pixels.
    pub width_px: f64,
    /// Colour.
    pub colour: Colour,
    /// Its visible parts.
    pub parts: Vec<Vec<DVec2>>,
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum VectorLineKind {
    /// A horizon, 0 = youngest; `None`: where layers meet at the unseen part of a fault, and crests of the ground.
    Horizon(Option<usize>),
    /// A fault.
    Fault(usize),
    /// Edges of the block and of the ground.
    Edge,
}

/// The paths of a scene, or `None` where lines lie behind what is seen through. Curves are straight to `tolerance_px`; the
/// ground and wells, which are no paths, are drawn with `picture_px` pixels.
///
/// # Errors
/// A scene that cannot be drawn, missing inputs, or cancellation.
pub fn vectors(
    scene: &Scene,
    inputs: &Inputs,
    library: &TextureLibrary,
    tolerance_px: f64,
    picture_px: [u32; 2],
    progress: &Progress,
) -> Result<Option<VectorBlock>, RenderError> {
    if scene.has_back_edges() {
        return Ok(None);
    }
    let mut kept = Kept::default();
    let resolved = ResolvedScene::new(scene, inputs, &mut kept)?;
    let mut block = VectorBlock { lines: lines(&resolved), ..VectorBlock::default() };
    if !is_drawn(&resolved) {
        return Ok(Some(block));
    }
    block.has_areas = true;
    (block.areas, block.hidden) = face_areas(&resolved, library, tolerance_px, progress)?;
    let picture = Scene { size_px: picture_px, ..scene.clone() };
    block.over = over(&ResolvedScene::new(&picture, inputs, &mut kept)?, progress)?.map(Arc::new);
    Ok(Some(block))
}

/// Whether all of the rock that is seen is colour and pattern.
fn is_drawn(resolved: &ResolvedScene) -> bool {
    resolved.illustrated
        && resolved.interpretation.is_some()
        && resolved.field.is_none()
        && resolved.scene.media.faces == Faces::All
        && resolved.scene.face_data == FaceData::Rock
        && resolved.tables.globals.blend == 0.0
        && resolved.tables.scalars.is_empty()
        && resolved.relief.as_ref().is_none_or(|relief| relief.opacity >= 1.0)
}

/// The lines of a picture, in the order in which they are stroked.
fn lines(resolved: &ResolvedScene) -> Vec<VectorLine> {
    let [width, height] = resolved.scene.size_px;
    let scale = f64::from(width.min(height)) / f64::from(crate::outline::NOMINAL_SIDE_PX);
    let outlines = resolved.scene.outlines;
    let drawn = OutlineLines::of(resolved);
    let mut lines: Vec<VectorLine> = Vec::new();
    let mut add = |kind: VectorLineKind, stroke: crate::Stroke, points: Vec<DVec2>| {
        if stroke.width_px <= 0.0 || points.len() < 2 {
            return;
        }
        match lines.iter_mut().find(|line| line.kind == kind) {
            Some(line) => line.parts.push(points),
            None => {
                let width_px = f64::from(stroke.width_px) * scale;
                lines.push(VectorLine { kind, width_px, colour: stroke.colour, parts: vec![points] });
            }
        }
    };
    for line in drawn.horizons {
        add(VectorLineKind::Horizon(line.of), outlines.of_horizon(resolved.is_unconformity(line.of)), line.points);
    }
    for line in drawn.faults {
        let stroke = outlines.of_fault(resolved.tables.fault_colour(line.of));
        add(line.of.map_or(VectorLineKind::Horizon(None), VectorLineKind::Fault), stroke, line.points);
    }
    for points in drawn.edges {
        add(VectorLineKind::Edge, outlines.edges, points);
    }
    lines.sort_by_key(|line| line.kind);
    for line in &mut lines {
        line.parts = joined(&line.parts);
    }
    lines
}
