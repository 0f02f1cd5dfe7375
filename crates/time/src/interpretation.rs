//! What the user interpreted, which geologic time obeys: faults, picked horizons, unconformities, tops of wells.
//!
//! | what | becomes |
//! |---|---|
//! | a fault | a [`Cut`]: no link across it |
//! | a picked horizon | one hub that outweighs patches; at the end its nodes have exactly one τ |
//! | an unconformity | the same, and beds on its far side are joined to it by next to nothing: τ jumps there |
//! | two tops of one name in two wells | one time, which decides between throws that fit the reflections alike |
//!
//! Space: voxels.

use crate::cuts::{Across, Cut};
use std::ops::Range;

/// A point on a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Inline and crossline index.
    pub trace: [usize; 2],
    /// Fractional sample.
    pub z: f32,
}

/// Where τ jumps at a horizon.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Jump {
    /// Nowhere.
    #[default]
    None,
    /// Just below it: older beds were eroded.
    Below,
    /// Just above it: younger beds end against it.
    Above,
}

/// A horizon that was picked: all its nodes have one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct KnownHorizon {
    /// Its nodes.
    pub nodes: Vec<Place>,
    /// Where τ jumps.
    pub jump: Jump,
}

/// What the user interpreted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Interpretation {
    /// Faults.
    pub cuts: Vec<Cut>,
    /// Horizons.
    pub horizons: Vec<KnownHorizon>,
    /// Pairs of places of one time: tops of one name in two wells.
    pub same: Vec<[Place; 2]>,
}

impl From<Vec<Cut>> for Interpretation {
    fn from(cuts: Vec<Cut>) -> Self {
        Self { cuts, ..Self::default() }
    }
}

impl From<&[Cut]> for Interpretation {
    fn from(cuts: &[Cut]) -> Self {
        cuts.to_vec().into()
    }
}

impl KnownHorizon {
    /// The sample nodes are put on: beside the jump, on the horizon's own side.
    pub(crate) fn sample_of(&self, node: &Place) -> f32 {
        match self.jump {
            Jump::None => node.z,
            Jump::Below => node.z.floor(),
            Jump::Above => node.z.ceil(),
        }
    }

    /// Trace and sample below which τ jumps, for every node.
    pub(crate) fn jumps(&self, ny: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.nodes.iter().filter_map(move |node| {
            let above = match self.jump {
                Jump::None => return None,
                Jump::Below => node.z.floor(),
                Jump::Above => node.z.ceil() - 1.0,
            };
            Some((node.trace[0] * ny + node.trace[1], above))
        })
    }
}

impl Cut {
    /// The part of a fault within a range of inlines, counted from its start.
    pub(crate) fn within(&self, inlines: &Range<usize>) -> Self {
        let nz = self.size[1];
        match self.across {
            Across::Inlines => {
                Self { place: self.place.iter().map(|place| place - inlines.start as f32).collect(), ..self.clone() }
            }
            Across::Crosslines => Self {
                across: self.across,
                size: [inlines.len(), nz],
                place: self.place[inlines.start * nz..inlines.end * nz].to_vec(),
            },
        }
    }
}

impl Interpretation {
    /// The part of it within a range of inlines, counted from its start.
    pub fn within(&self, inlines: &Range<usize>) -> Self {
        let shifted = |place: &Place| {
            let [x, y] = place.trace;
            inlines.contains(&x).then(|| Place { trace: [x - inlines.start, y], z: place.z })
        };
        let horizon = |known: &KnownHorizon| KnownHorizon {
            nodes: known.nodes.iter().filter_map(shifted).collect(),
            jump: known.jump,
        };
        Self {
            cuts: self.cuts.iter().map(|cut| cut.within(inlines)).collect(),
            horizons: self.horizons.iter().map(horizon).filter(|known| !known.nodes.is_empty()).collect(),
            same: self.same.iter().filter_map(|[a, b]| Some([shifted(a)?, shifted(b)?])).collect(),
        }
    }
}
