//! A model in closed form: formulas give its sheets and fault blocks.

#![allow(dead_code, reason = "each test binary uses a part of this module")]

use glam::{DMat3, Vec3};
use param::{LayerModel, Region};
use std::f64::consts::TAU;
use survey::HeightField;

/// Voxels by which the sheets continue past the outer boundary.
const MARGIN: i32 = 24;

type BlockRule = Box<dyn Fn(Vec3) -> u16 + Sync>;

/// A model of one sheet per horizon and block; horizons youngest first.
pub(crate) struct ClosedForm {
    size: [usize; 3],
    metric: DMat3,
    sheets: Vec<Vec<HeightField>>,
    block_at: BlockRule,
}

impl ClosedForm {
    /// A model of one block; `depth(h, x, y)` is the voxel z of horizon h.
    pub(crate) fn new(size: [usize; 3], horizons: usize, depth: impl Fn(usize, f64, f64) -> f64) -> Self {
        Self::faulted(size, horizons, 1, |h, _, x, y| depth(h, x, y), |_| 0)
    }

    /// A model of several blocks; `depth(h, block, x, y)` is the voxel z of horizon h in a block.
    pub(crate) fn faulted(
        size: [usize; 3],
        horizons: usize,
        blocks: u16,
        depth: impl Fn(usize, u16, f64, f64) -> f64,
        block_at: impl Fn(Vec3) -> u16 + Sync + 'static,
    ) -> Self {
        let extent = [size[0], size[1]].map(|n| n + 2 * MARGIN as usize);
        let sheet = |h: usize, block: u16| {
            HeightField::from_fn([-MARGIN; 2], extent, |x, y| depth(h, block, f64::from(x), f64::from(y)) as f32)
        };
        let sheets = (0..horizons).map(|h| (0..blocks).map(|block| sheet(h, block)).collect()).collect();
        Self { size, metric: DMat3::IDENTITY, sheets, block_at: Box::new(block_at) }
    }

    /// Three horizons with folds 80 voxels long; the distance of the middle one to the others varies by 30 %.
    pub(crate) fn folded() -> Self {
        Self::new([80, 72, 80], 3, |h, x, y| {
            let fold = 8.0 * (TAU * (x + 0.35 * y) / 76.0).sin();
            let swell = 5.0 * (TAU * (y - 0.4 * x) / 88.0).cos();
            18.0 + 21.0 * h as f64 + fold + swell * [0.0, 1.0, 0.2][h]
        })
    }

    /// The same model with another voxel-to-metre matrix.
    pub(crate) fn with_metric(self, metric: DMat3) -> Self {
        Self { metric, ..self }
    }
}

impl LayerModel for ClosedForm {
    fn size(&self) -> [usize; 3] {
        self.size
    }

    fn metric(&self) -> DMat3 {
        self.metric
    }

    fn layer_count(&self) -> usize {
        self.sheets.len() + 1
    }

    fn block_count(&self) -> usize {
        self.sheets.first().map_or(1, Vec::len)
    }

    fn sheet(&self, horizon: usize, block: u16) -> &HeightField {
        &self.sheets[horizon][usize::from(block)]
    }

    fn region_at(&self, p: Vec3) -> Region {
        let block = (self.block_at)(p);
        let above = |sheets: &Vec<HeightField>| p.z < sheets[usize::from(block)].z_at(p.x, p.y);
        let layer = self.sheets.iter().filter(|sheets| above(sheets)).count();
        Region { layer: layer as u16, block }
    }
}
