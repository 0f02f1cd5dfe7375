//! Where blocks belonged together: the cut-offs of the restored horizon on both sides of each fault.
//!
//! On each line down the dip of a fault the horizon ends once on either side, at a and b. Before the fault moved, both were one
//! place: u_B(b) − u_A(a) = a − b on the map. Beyond the fault's tip a and b are one place still, which ties the blocks
//! together there. Cut-offs count as if nothing younger had cut the horizon off, and half a survey's height above and below it too.

use glam::DVec2;
use model::{FaultThrows, StructuralModel};
use rayon::prelude::*;

/// Lines down the dip of a fault, at most.
const MOST_LINES: usize = 129;
/// Weight of a tie where the horizon was only continued to the fault, beside 1.
const INFERRED: f64 = 0.1;

/// Two places of two blocks that were one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tie {
    /// The fault between them.
    pub fault: usize,
    pub blocks: [u16; 2],
    /// Voxel x, y of both.
    pub at: [DVec2; 2],
    pub weight: f64,
    /// Whether the fault was interpreted there.
    pub is_real: bool,
}

impl Tie {
    /// What is to become nothing, voxels.
    pub(crate) fn apart(&self) -> DVec2 {
        self.at[1] - self.at[0]
    }
}

/// All ties of a horizon.
pub(crate) fn ties(model: &StructuralModel, horizon: usize) -> Vec<Tie> {
    let of_fault = |fault: usize| -> Vec<Tie> {
        let surface = &model.faults().surfaces()[fault];
        let (first, count) = (surface.surface.origin[0], surface.surface.size[0]);
        let lines = count.min(MOST_LINES);
        let step = (count.saturating_sub(1)) as f64 / lines.saturating_sub(1).max(1) as f64;
        let throws = FaultThrows::unclipped(model, fault);
        let of_line = |n: usize| {
            let along_m = (f64::from(first) + step * n as f64) * surface.spacing_m;
            throws.at(along_m).into_iter().filter(|throw| throw.horizon == horizon).collect::<Vec<_>>()
        };
        let tie = |throw: model::Throw| Tie {
            fault,
            blocks: throw.cut_offs.map(|cut_off| cut_off.block),
            at: throw.cut_offs.map(|cut_off| cut_off.place.truncate()),
            weight: if throw.is_inferred() { INFERRED } else { 1.0 },
            is_real: throw.is_real || throw.cut_offs.iter().any(|cut_off| surface.extent_at(cut_off.place) >= 0.0),
        };
        (0..lines).into_par_iter().flat_map_iter(of_line).map(tie).collect()
    };
    (0..model.faults().surfaces().len()).flat_map(of_fault).filter(|tie| tie.blocks[0] != tie.blocks[1]).collect()
}
