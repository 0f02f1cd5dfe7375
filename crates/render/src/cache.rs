//! What is computed from the data alone, and kept while they stay the same: a camera that turns does not pay for it in
//! every picture.

use crate::ground::Heights;
use crate::media::preparation::Preparations;
use glam::{DVec3, Vec3};
use model::StructuralModel;
use model::section::{Section, SectionPlane};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Most sections that are kept: the faces of a block with many cut-outs.
const SECTIONS: usize = 64;
/// Most grounds of blocks and traces of faults on them that are kept.
const GROUNDS: usize = 256;

/// The volumes of media, the heights of the ground and the sections on the faces of the block.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    /// Volumes prepared for ray marching.
    pub preparations: Preparations,
    version: u64,
    heights: Option<([Vec3; 2], Arc<Heights>)>,
    shapes: Shapes,
}

impl Kept {
    /// Drops what was made of other data. Data without a version are taken for other ones each time.
    pub(crate) fn renew(&mut self, version: u64) {
        if version == 0 || self.version != version {
            (self.version, self.heights, self.shapes) = (version, None, Shapes::default());
        }
    }

    /// The heights of the ground between two corners of a box.
    pub(crate) fn heights(&mut self, model: &StructuralModel, corners: [Vec3; 2]) -> Arc<Heights> {
        match &self.heights {
            Some((of, heights)) if *of == corners => heights.clone(),
            _ => {
                let heights = Arc::new(Heights::of(model, corners[0], corners[1]));
                self.heights = Some((corners, heights.clone()));
                heights
            }
        }
    }

    /// Sections and grounds, for a picture.
    pub(crate) fn shapes(&self) -> Shapes {
        self.shapes.clone()
    }
}

/// Sections of one model by their planes, and what is known of its ground in boxes. Cheap to clone.
#[derive(Debug, Default, Clone)]
pub(crate) struct Shapes(Arc<Parts>);

#[derive(Debug, Default)]
struct Parts {
    sections: Mutex<Vec<(SectionPlane, Arc<Section>)>>,
    heights: Mutex<HashMap<GroundKey, Arc<Vec<f32>>>>,
    traces: Mutex<HashMap<GroundKey, Arc<Vec<[DVec3; 2]>>>>,
}

/// Whose ground: the bits of the box's corners, the block, the fault that cuts it or, after the faults, the horizon.
pub(crate) type GroundKey = ([u64; 6], u16, usize);

impl Shapes {
    /// The section of the model along a plane.
    pub(crate) fn section(&self, model: &StructuralModel, plane: &SectionPlane) -> Arc<Section> {
        let mut known = self.0.sections.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, section)) = known.iter().find(|(of, _)| of == plane) {
            return section.clone();
        }
        let section = Arc::new(Section::new(model, plane));
        if known.len() == SECTIONS {
            known.clear();
        }
        known.push((*plane, section.clone()));
        section
    }

    /// Heights of the ground at nodes.
    pub(crate) fn heights(&self, key: GroundKey, make: impl FnOnce() -> Vec<f32>) -> Arc<Vec<f32>> {
        kept(&self.0.heights, key, make)
    }

    /// Traces of a fault or a horizon on the ground.
    pub(crate) fn traces(&self, key: GroundKey, make: impl FnOnce() -> Vec<[DVec3; 2]>) -> Arc<Vec<[DVec3; 2]>> {
        kept(&self.0.traces, key, make)
    }
}

fn kept<V>(known: &Mutex<HashMap<GroundKey, Arc<V>>>, key: GroundKey, make: impl FnOnce() -> V) -> Arc<V> {
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    // A box that is being dragged would fill it.
    if known.len() >= GROUNDS && !known.contains_key(&key) {
        known.clear();
    }
    known.entry(key).or_insert_with(|| Arc::new(make())).clone()
}
