//! The sheet of the restored horizon in each block, also where the block has been faulted away below it.
//!
//! Under a fault lies rock of the foot wall whose part of the restored horizon is elsewhere: the sheet goes on there only because
//! the model continues it. Rock is moved by the depth of the restored horizon above it, so a fold of the foot wall must not get
//! lost there: where the block does not hold the horizon and holds an older one, k, it is put where k says by the thickness
//! between them, z = z_k − t, with t continued from where the block holds both, as smoothly as a membrane.

use crate::fill::fill;
use glam::{DVec2, Vec3};
use model::StructuralModel;
use rayon::prelude::*;
use survey::{HeightField, Quality};

/// Nodes at which two horizons must be known for the thickness between them to be continued.
const FEWEST: usize = 12;

/// The restored horizon in one block.
#[derive(Debug, Clone)]
pub(crate) struct TargetSheet {
    field: HeightField,
    /// Count of nodes over the volume at which it is known in the block.
    pub known: usize,
}

impl TargetSheet {
    /// Its depth at voxel (x, y).
    pub(crate) fn z_at(&self, at: DVec2) -> f64 {
        f64::from(self.field.z_at(at.x as f32, at.y as f32))
    }
}

/// Whether a horizon was interpreted, or filled, at a node and lies in the block there.
pub(crate) fn is_known(model: &StructuralModel, horizon: usize, block: u16, at: DVec2) -> bool {
    let (x, y) = (at.x as f32, at.y as f32);
    let quality = model.quality_at(horizon, block, x, y);
    let is_data = quality.is_on_data() || quality == Quality::Filled;
    is_data && model.faults().holds(block, Vec3::new(x, y, model.sheet(horizon, block).z_at(x, y)))
}

/// The restored horizon in all blocks.
pub(crate) fn target_sheets(model: &StructuralModel, horizon: usize) -> Vec<TargetSheet> {
    (0..model.block_count() as u16).into_par_iter().map(|block| target_sheet(model, horizon, block)).collect()
}

fn target_sheet(model: &StructuralModel, horizon: usize, block: u16) -> TargetSheet {
    let sheet = model.sheet(horizon, block);
    let voxel = |n: usize| {
        let (u, v) = (n / sheet.size[1], n % sheet.size[1]);
        DVec2::new(f64::from(sheet.origin[0]) + u as f64, f64::from(sheet.origin[1]) + v as f64)
    };
    let count = sheet.z.len();
    // Where the model has it, interpreted or continued, that is what is drawn today.
    let is_held = |h: usize, n: usize| {
        let p = voxel(n).extend(f64::from(model.sheet(h, block).z[n]));
        model.faults().holds(block, p.as_vec3())
    };
    let held_of = |h: usize| (0..count).map(|n| is_held(h, n)).collect::<Vec<bool>>();
    let mut known = held_of(horizon);
    let [nx, ny, _] = model.size().map(|count| count as f64 - 1.0);
    let is_inside = |at: DVec2| at.x >= 0.0 && at.y >= 0.0 && at.x <= nx && at.y <= ny;
    let own = (0..count).filter(|&n| is_inside(voxel(n)) && is_known(model, horizon, block, voxel(n))).count();
    let mut offset: Vec<f64> = known.iter().map(|known| if *known { 0.0 } else { f64::NAN }).collect();
    let contacts = model.rules().contacts();
    let mut is_moved = false;
    for (older, contact) in contacts.iter().enumerate().skip(horizon + 1) {
        if contact.is_intrusive() || model.level(older, block).is_some() {
            continue;
        }
        let theirs = held_of(older);
        let both = (0..count).filter(|&n| known[n] && theirs[n]).count();
        let shadow: Vec<usize> = (0..count).filter(|&n| !known[n] && theirs[n]).collect();
        if both < FEWEST || shadow.is_empty() {
            continue;
        }
        let base = &model.sheet(older, block).z;
        let z = |n: usize| f64::from(sheet.z[n]) + if known[n] { offset[n] } else { 0.0 };
        let mut thickness: Vec<f64> =
            (0..count).map(|n| if known[n] && theirs[n] { f64::from(base[n]) - z(n) } else { f64::NAN }).collect();
        fill(sheet.size, &mut thickness);
        for n in shadow {
            offset[n] = f64::from(base[n]) - thickness[n] - f64::from(sheet.z[n]);
            known[n] = true;
        }
        is_moved = true;
    }
    let mut field = sheet.clone();
    if is_moved {
        fill(sheet.size, &mut offset);
        field.z.iter_mut().zip(&offset).for_each(|(z, offset)| *z += *offset as f32);
    }
    TargetSheet { field, known: own }
}
