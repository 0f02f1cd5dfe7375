//! A value at each trace: of the model, or of the sheets as they were picked.
//!
//! Each trace takes the shallowest place where the horizon lies in the block it belongs to; where no block
//! has it, there is no value.

use super::Mapped;
use crate::interpretation::{DrawnInterpretation, SheetHole};
use glam::Vec3;
use model::StructuralModel;
use rayon::prelude::*;
use survey::{Quality, SurveyGeometry};

/// What is known at a trace.
#[derive(Debug, Clone, Copy)]
pub(super) struct MapNode {
    /// In the survey's unit; NaN where there is none.
    pub(super) value: f64,
    /// Fault block.
    pub(super) block: u16,
    /// Whether nothing was picked here: a hole, or what stands in for one.
    pub(super) is_open: bool,
}

/// All traces, `[inline][crossline]`.
pub(super) struct Grid {
    pub(super) size: [usize; 2],
    nodes: Vec<MapNode>,
}

/// The shallowest place of a horizon at a trace, voxel z.
struct ShallowestPlace {
    z: f32,
    block: u16,
    is_open: bool,
}

impl Grid {
    pub(super) fn by(size: [usize; 2], node: impl Fn(usize, usize) -> MapNode + Sync) -> Self {
        Self { size, nodes: (0..size[0] * size[1]).into_par_iter().map(|n| node(n / size[1], n % size[1])).collect() }
    }

    pub(super) fn at(&self, x: usize, y: usize) -> MapNode {
        self.nodes[x * self.size[1] + y]
    }

    pub(super) fn nodes(&self) -> &[MapNode] {
        &self.nodes
    }

    /// Of the model, `fine` nodes from trace to trace; `None` when it has no such horizon.
    pub(super) fn of_model(
        geometry: &SurveyGeometry,
        model: &StructuralModel,
        mapped: Mapped,
        fine: usize,
    ) -> Option<Self> {
        let last = geometry.vertical.count.saturating_sub(1) as f32;
        let place = |horizon: usize, x: usize, y: usize| {
            let [x, y] = [x, y].map(|n| n as f32 / fine as f32);
            let places = (0..model.block_count() as u16).filter_map(|block| {
                let z = model.horizon_z(horizon, block, x, y);
                let p = Vec3::new(x, y, z);
                let is_there = z.is_finite() && (0.0..=last).contains(&z) && model.block_at(p) == block;
                // Inside a body there is no other horizon.
                let is_whole = || model.is_body(horizon) || model.body_at(p, block).is_none();
                (is_there && is_whole()).then_some((z, block))
            });
            let (z, block) = places.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let quality = model.quality_at(horizon, block, x, y);
            Some(ShallowestPlace { z, block, is_open: !quality.is_on_data() })
        };
        let count = model.stratigraphy().horizons.len();
        mapped.is_among(count).then(|| Self::of(geometry, mapped, fine, place))
    }

    /// Of sheets as they were picked; `None` when there is no such horizon.
    pub(super) fn of_sheets(geometry: &SurveyGeometry, shown: &DrawnInterpretation, mapped: Mapped) -> Option<Self> {
        let [_, ny, _] = geometry.size();
        let place = |horizon: usize, x: usize, y: usize| {
            let n = x * ny + y;
            let sheets = shown.horizons[horizon].sheets.iter().map(|sheet| (sheet.z[n], sheet));
            let (z, sheet) = sheets.filter(|(z, _)| z.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(ShallowestPlace { z, block: sheet.block, is_open: sheet.quality[n] == Quality::Filled })
        };
        if !mapped.is_among(shown.horizons.len()) {
            return None;
        }
        let mut grid = Self::of(geometry, mapped, 1, place);
        let holes = |index: usize| shown.horizons[index].holes.clone();
        let holes: Vec<SheetHole> = match mapped {
            Mapped::Structure(horizon) => holes(horizon),
            Mapped::Thickness(top, base) => [holes(top), holes(base)].concat(),
        };
        for trace in holes.iter().flat_map(|hole| hole.traces) {
            let node = &mut grid.nodes[*trace as usize];
            node.is_open |= node.value.is_nan();
        }
        Some(grid)
    }

    fn of(
        geometry: &SurveyGeometry,
        mapped: Mapped,
        fine: usize,
        place: impl Fn(usize, usize, usize) -> Option<ShallowestPlace> + Sync,
    ) -> Self {
        let vertical = &geometry.vertical;
        let nothing = MapNode { value: f64::NAN, block: 0, is_open: false };
        let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) * fine + 1);
        Self::by([nx, ny], |x, y| match mapped {
            Mapped::Structure(horizon) => place(horizon, x, y).map_or(nothing, |at| MapNode {
                value: vertical.value_at(f64::from(at.z)),
                block: at.block,
                is_open: at.is_open,
            }),
            Mapped::Thickness(upper, lower) => match (place(upper, x, y), place(lower, x, y)) {
                (Some(top), Some(base)) => MapNode {
                    value: f64::from((base.z - top.z).max(0.0)) * vertical.interval,
                    block: top.block,
                    is_open: top.is_open || base.is_open,
                },
                _ => nothing,
            },
        })
    }
}
