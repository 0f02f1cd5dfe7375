//! What the rays of the last pictures hit, kept for pictures whose styles alone change.

use crate::inputs::Inputs;
use crate::leaves::FaceData;
use crate::outline::Outlines;
use crate::outline::draw::OutlineLines;
use crate::points::{POINT_BYTES, Points};
use crate::resolved_scene::ResolvedScene;
use crate::scene::{Background, PatternSize, Scene};
use std::sync::{Arc, OnceLock};
use ttf::Preset;

/// The points of a whole picture, in blocks of pixels, and its lines. A block is known once it has been drawn.
#[derive(Debug)]
pub(crate) struct PicturePoints {
    of: PointsOf,
    blocks_across: u32,
    side_px: u32,
    blocks: Vec<OnceLock<Points>>,
    lines: OnceLock<OutlineLines>,
}

/// What the points of a picture depend on.
#[derive(Debug, PartialEq)]
struct PointsOf {
    data_key: u64,
    is_illustrated: bool,
    /// The scene in the colours of any other.
    scene: Scene,
}

impl PointsOf {
    fn new(resolved: &ResolvedScene, data_key: u64) -> Self {
        let outlines = resolved.scene.outlines;
        let mut shapes = Outlines::none();
        shapes.edges.width_px = outlines.edges.width_px;
        shapes.unpicked = outlines.unpicked;
        let scene = Scene {
            blend: 0.0,
            global_frequency: 1.0,
            pattern_size: PatternSize::default(),
            preset: Preset::Colour,
            background: Background::Transparent,
            face_tone: 0.0,
            raw: None,
            outlines: shapes,
            labels: Vec::new(),
            ..resolved.scene.clone()
        };
        Self { data_key, is_illustrated: resolved.illustrated, scene }
    }
}

impl PicturePoints {
    /// The points of a block of pixels, which are looked for unless they are known.
    pub(crate) fn block(&self, [left, top]: [u32; 2], find: impl FnOnce() -> Points) -> &Points {
        let index = top / self.side_px * self.blocks_across + left / self.side_px;
        self.blocks[index as usize].get_or_init(|| find().packed())
    }

    /// The lines over the picture.
    pub(crate) fn lines(&self, find: impl FnOnce() -> OutlineLines) -> &OutlineLines {
        self.lines.get_or_init(find)
    }
}

/// Points of the last pictures, while they need no more than so many bytes together.
#[derive(Debug, Default)]
pub(crate) struct KeptPoints {
    max_bytes: usize,
    pictures: Vec<Arc<PicturePoints>>,
}

impl KeptPoints {
    /// None yet.
    pub(crate) fn within(max_bytes: usize) -> Self {
        Self { max_bytes, pictures: Vec::new() }
    }

    /// The points of a picture, in blocks of `side_px` pixels; `None` where they are not kept: in volume rendering, behind
    /// a translucent ground, for data without a version, and where they need too much memory.
    pub(crate) fn of(&mut self, resolved: &ResolvedScene, inputs: &Inputs, side_px: u32) -> Option<Arc<PicturePoints>> {
        let is_clear = resolved.relief.as_ref().is_none_or(|relief| relief.opacity >= 1.0);
        let [width, height] = resolved.scene.size_px;
        let bytes = |[width, height]: [u32; 2], samples: u32| {
            let rays = width as usize * height as usize * (samples * samples) as usize;
            rays * POINT_BYTES
        };
        let needed = bytes([width, height], resolved.scene.samples);
        let is_fixed = resolved.scene.face_data == FaceData::Distortion;
        if resolved.field.is_some() || !is_clear || is_fixed || inputs.data_key == 0 || needed > self.max_bytes {
            return None;
        }
        let of = PointsOf::new(resolved, inputs.data_key);
        if let Some(known) = self.pictures.iter().position(|known| known.of == of) {
            let known = self.pictures.remove(known);
            self.pictures.push(known.clone());
            return Some(known);
        }
        self.pictures.retain(|known| known.of.data_key == of.data_key);
        let held = |pictures: &[Arc<PicturePoints>]| -> usize {
            pictures.iter().map(|known| bytes(known.of.scene.size_px, known.of.scene.samples)).sum()
        };
        while held(&self.pictures) + needed > self.max_bytes {
            self.pictures.remove(0);
        }
        let blocks_across = width.div_ceil(side_px);
        let count = blocks_across * height.div_ceil(side_px);
        let blocks = (0..count).map(|_| OnceLock::new()).collect();
        let picture = Arc::new(PicturePoints { of, blocks_across, side_px, blocks, lines: OnceLock::new() });
        self.pictures.push(picture.clone());
        Some(picture)
    }
}
