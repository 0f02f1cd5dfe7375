//! The interpretation that an exact interpreter would deliver: horizons and faults on the survey's lattice,
//! computed from the truth.

use super::truth::SynthTruth;
use rayon::prelude::*;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};

/// Names of the layers, youngest first.
const LAYER_NAMES: [&str; 6] = ["Cover mudstone", "Upper sandstone", "Marl", "Shale", "Limestone", "Lower sandstone"];

/// Voxels between nodes of a fault mesh along strike and down dip.
const FAULT_MESH_STEP: [usize; 2] = [2, 4];

/// The horizons in age order with their contacts.
pub(super) fn stratigraphy(truth: &SynthTruth) -> Stratigraphy {
    let horizons = truth.horizons.iter().enumerate().map(|(index, horizon)| StratigraphicHorizon {
        name: horizon.name.clone(),
        contact: if index == truth.unconformity { Contact::Erosional } else { Contact::Conformable },
    });
    Stratigraphy { horizons: horizons.collect(), layer_names: LAYER_NAMES.map(str::to_owned).into() }
}

/// One horizon as a sheet for each block, in block order. A node has a depth where the horizon exists:
/// outside its block, where it is eroded and beyond the volume it is a hole. The blocks are left for the
/// fault network to number.
pub(super) fn horizon(truth: &SynthTruth, geometry: &SurveyGeometry, horizon: usize) -> Horizon {
    let grid = NodeGrid::of_survey(geometry);
    let [_, ny] = grid.count;
    let sheet = |block: u16| {
        let depth = (0..grid.count[0] * ny).into_par_iter().map(|node| {
            let (x, y) = ((node / ny) as f64, (node % ny) as f64);
            if truth.exists(horizon, block, x, y) {
                geometry.vertical.value_at(truth.sheet_z(horizon, block, x, y)) as f32
            } else {
                f32::NAN
            }
        });
        Sheet::new(grid, depth.collect(), Quality::Picked)
    };
    let sheets = (0..truth.block_count() as u16).map(sheet).filter(|sheet| sheet.node_count() > 0);
    Horizon::new(truth.horizons[horizon].name.clone(), sheets.collect())
}

/// The faults up to their tips.
pub(super) fn faults(truth: &SynthTruth, geometry: &SurveyGeometry) -> Vec<Fault> {
    let [_, ny, nz] = truth.size;
    let cells = [ny.div_ceil(FAULT_MESH_STEP[0]), nz.div_ceil(FAULT_MESH_STEP[1])];
    truth.faults.iter().map(|fault| fault.interpreted(geometry, cells)).collect()
}
