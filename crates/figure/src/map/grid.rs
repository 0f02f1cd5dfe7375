//! A value at each trace: of the model, or of the sheets as they were picked.
//!
//! Each trace takes the shallowest place where the horizon lies in the block it belongs to; where no block
//! has it, there is no value. Neighbours are torn apart where a fault was interpreted between them; beyond its tip they
//! belong to two blocks and to one surface.

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
    /// Whether a fault lies between it and the next inline, and the next crossline.
    pub(super) is_torn: [bool; 2],
    /// Whether nothing was picked here: a hole, or what stands in for one.
    pub(super) is_open: bool,
}

/// All traces, `[inline][crossline]`.
pub(super) struct Grid {
    pub(super) size: [usize; 2],
    nodes: Vec<MapNode>,
}

/// The shallowest place of a horizon at a trace, voxels.
#[derive(Clone, Copy)]
struct ShallowestPlace {
    at: Vec3,
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

    /// Whether the values at a trace and at the next inline (0) or crossline (1) belong to one surface.
    pub(super) fn is_joined(&self, n: usize, way: usize) -> bool {
        let next = n + [self.size[1], 1][way];
        self.nodes[n].value.is_finite() && self.nodes[next].value.is_finite() && !self.nodes[n].is_torn[way]
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
                (is_there && is_whole()).then_some((p, block))
            });
            let (at, block) = places.min_by(|a, b| a.0.z.total_cmp(&b.0.z))?;
            let quality = model.quality_at(horizon, block, x, y);
            Some(ShallowestPlace { at, block, is_open: !quality.is_on_data() })
        };
        let torn = |a: ShallowestPlace, b: ShallowestPlace| a.block != b.block && is_faulted(model, a.at, b.at);
        let count = model.stratigraphy().horizons.len();
        mapped.is_among(count).then(|| Self::of(geometry, mapped, fine, place, torn))
    }

    /// Of sheets as they were picked; `None` when there is no such horizon.
    pub(super) fn of_sheets(geometry: &SurveyGeometry, shown: &DrawnInterpretation, mapped: Mapped) -> Option<Self> {
        let [_, ny, _] = geometry.size();
        let place = |horizon: usize, x: usize, y: usize| {
            let n = x * ny + y;
            let sheets = shown.horizons[horizon].sheets.iter().map(|sheet| (sheet.z[n], sheet));
            let (z, sheet) = sheets.filter(|(z, _)| z.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0))?;
            let at = Vec3::new(x as f32, y as f32, z);
            Some(ShallowestPlace { at, block: sheet.block, is_open: sheet.quality[n] == Quality::Filled })
        };
        if !mapped.is_among(shown.horizons.len()) {
            return None;
        }
        let mut grid = Self::of(geometry, mapped, 1, place, |a, b| a.block != b.block);
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
        torn: impl Fn(ShallowestPlace, ShallowestPlace) -> bool + Sync,
    ) -> Self {
        let vertical = &geometry.vertical;
        let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) * fine + 1);
        let sheet = |horizon: usize| -> Vec<Option<ShallowestPlace>> {
            (0..nx * ny).into_par_iter().map(|n| place(horizon, n / ny, n % ny)).collect()
        };
        let (upper, lower) = match mapped {
            Mapped::Structure(horizon) => (sheet(horizon), None),
            Mapped::Thickness(upper, lower) => (sheet(upper), Some(sheet(lower))),
        };
        let sheets = || std::iter::once(&upper).chain(&lower);
        let is_torn = |n: usize, next: usize| {
            sheets().any(|sheet| sheet[n].zip(sheet[next]).is_some_and(|(here, there)| torn(here, there)))
        };
        let value = |n: usize| {
            let top = upper[n]?.at.z;
            Some(match &lower {
                None => vertical.value_at(f64::from(top)),
                Some(lower) => f64::from((lower[n]?.at.z - top).max(0.0)) * vertical.interval,
            })
        };
        Self::by([nx, ny], |x, y| {
            let n = x * ny + y;
            MapNode {
                value: value(n).unwrap_or(f64::NAN),
                is_torn: [x + 1 < nx && is_torn(n, n + ny), y + 1 < ny && is_torn(n, n + 1)],
                is_open: value(n).is_some() && sheets().any(|sheet| sheet[n].is_some_and(|place| place.is_open)),
            }
        })
    }
}

/// Whether an interpreted part of a fault passes between two places, voxels.
fn is_faulted(model: &StructuralModel, a: Vec3, b: Vec3) -> bool {
    let faults = model.faults();
    (0..faults.surfaces().len()).any(|fault| {
        let sides = [a, b].map(|p| faults.side(fault, p));
        let crossed = || a.lerp(b, sides[0] / (sides[0] - sides[1]));
        (sides[0] >= 0.0) != (sides[1] >= 0.0) && faults.is_real(fault, crossed())
    })
}
