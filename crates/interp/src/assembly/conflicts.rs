//! Where horizons contradict one another: one leaf in two of them, sheets that cross, an order other than the stratigraphy's.

use super::leaf_of;
use super::selection::Selection;
use crate::forest::Forest;
use crate::reassembly::VoxelSheet;
use serde::Serialize;

/// A horizon to compare with others.
#[derive(Debug, Clone)]
pub struct NamedSheets<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its sheets on the survey's lattice.
    pub sheets: &'a [VoxelSheet],
    /// Its triangles, if it was assembled from the forest at hand.
    pub selection: Option<&'a Selection>,
}

/// What counts as a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConflictSettings {
    /// Depth difference from which on one horizon is above the other, samples; default 0.5.
    pub tolerance: f32,
    /// Share of the common traces on the lesser side that is forgiven; default 0.01.
    pub forgiven_share: f64,
}

impl Default for ConflictSettings {
    fn default() -> Self {
        Self { tolerance: 0.5, forgiven_share: 0.01 }
    }
}

/// A contradiction between two horizons.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "conflict", rename_all = "kebab-case")]
pub enum Conflict {
    /// Both hold triangles of the same leaves.
    SharedLeaves {
        /// The two horizons.
        horizons: [String; 2],
        /// Ids of the leaves.
        leaves: Vec<u32>,
        /// Triangles in both.
        triangles: usize,
    },
    /// One is above the other here and below it there.
    Crossing {
        /// The two horizons; the first is above at more traces.
        horizons: [String; 2],
        /// Traces at which the first is above.
        above: usize,
        /// Traces at which it is below.
        below: usize,
        /// The largest distance by which it is below, samples.
        worst: f32,
        /// Inline and crossline index of that.
        at: [usize; 2],
    },
    /// The younger one lies below the older one.
    Swapped {
        /// The younger and the older one, by the stratigraphy.
        horizons: [String; 2],
        /// Traces at which the younger one is below.
        traces: usize,
    },
}

impl Conflict {
    /// The two horizons.
    pub fn horizons(&self) -> &[String; 2] {
        match self {
            Self::SharedLeaves { horizons, .. } | Self::Crossing { horizons, .. } | Self::Swapped { horizons, .. } => {
                horizons
            }
        }
    }
}

/// Compares every two horizons, given youngest first. `may_cross(young, old)` says which pairs a contact rule lets cut each other.
pub fn conflicts(
    forest: Option<&Forest>,
    size: [usize; 2],
    horizons: &[NamedSheets],
    may_cross: impl Fn(usize, usize) -> bool,
    settings: &ConflictSettings,
) -> Vec<Conflict> {
    let mut found = Vec::new();
    for (old, b) in horizons.iter().enumerate() {
        for (young, a) in horizons[..old].iter().enumerate() {
            let names = || [a.name.to_owned(), b.name.to_owned()];
            if let (Some(forest), Some(left), Some(right)) = (forest, a.selection, b.selection) {
                let shared = left.intersection(right);
                if !shared.is_empty() {
                    let mut leaves: Vec<u32> = shared.iter().map(|triangle| leaf_of(forest, triangle)).collect();
                    leaves.dedup();
                    found.push(Conflict::SharedLeaves { horizons: names(), leaves, triangles: shared.len() });
                }
            }
            if may_cross(young, old) {
                continue;
            }
            let order = Order::of(size, a.sheets, b.sheets, settings.tolerance);
            let forgiven = settings.forgiven_share * (order.above + order.below) as f64;
            if order.above.min(order.below) as f64 > forgiven {
                found.push(order.crossing(names()));
            } else if order.below > order.above {
                found.push(Conflict::Swapped { horizons: names(), traces: order.below });
            }
        }
    }
    found
}

/// How often the first horizon is above and below the second, in one block on one trace.
#[derive(Default)]
struct Order {
    above: usize,
    below: usize,
    most_above: (f32, [usize; 2]),
    most_below: (f32, [usize; 2]),
}

impl Order {
    fn of(size: [usize; 2], a: &[VoxelSheet], b: &[VoxelSheet], tolerance: f32) -> Self {
        let mut order = Self::default();
        for (left, right) in a.iter().flat_map(|left| b.iter().map(move |right| (left, right))) {
            if left.block != right.block {
                continue;
            }
            for (trace, (za, zb)) in left.z.iter().zip(&right.z).enumerate() {
                let by = zb - za;
                let place = [trace / size[1], trace % size[1]];
                // A hole in either compares as neither.
                if by > tolerance {
                    order.above += 1;
                    if by > order.most_above.0 {
                        order.most_above = (by, place);
                    }
                } else if -by > tolerance {
                    order.below += 1;
                    if -by > order.most_below.0 {
                        order.most_below = (-by, place);
                    }
                }
            }
        }
        order
    }

    fn crossing(&self, [a, b]: [String; 2]) -> Conflict {
        if self.above >= self.below {
            let (worst, at) = self.most_below;
            Conflict::Crossing { horizons: [a, b], above: self.above, below: self.below, worst, at }
        } else {
            let (worst, at) = self.most_above;
            Conflict::Crossing { horizons: [b, a], above: self.below, below: self.above, worst, at }
        }
    }
}
