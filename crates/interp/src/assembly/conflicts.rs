//! Contradictions between horizons: leaves in two of them, sheets that cross, an order other than that of the
//! stratigraphy.

use super::leaf_of;
use super::selection::Selection;
use crate::forest::Forest;
use crate::reassembly::VoxelSheet;
use serde::Serialize;

/// A horizon to compare with others.
#[derive(Debug, Clone)]
pub struct NamedSheets<'a> {
    /// Name of the horizon.
    pub name: &'a str,
    /// Its sheets on the survey's lattice.
    pub sheets: &'a [VoxelSheet],
    /// Its triangles, if it was assembled from the present forest.
    pub selection: Option<&'a Selection>,
}

/// Tolerances of [`conflicts`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConflictSettings {
    /// Depth difference above which one horizon is above the other, samples; default 0.5.
    pub tolerance: f32,
    /// Largest share of the common traces on the rarer side that does not count as a crossing; default 0.01.
    pub forgiven_share: f64,
}

impl Default for ConflictSettings {
    fn default() -> Self {
        Self { tolerance: 0.5, forgiven_share: 0.01 }
    }
}

/// A contradiction between two horizons. A place is the indices of an inline and a crossline, or in a report their numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "conflict", rename_all = "kebab-case")]
pub enum Conflict<Place = [usize; 2]> {
    /// Both contain triangles of the same leaves.
    SharedLeaves {
        /// The two horizons.
        horizons: [String; 2],
        /// Ids of the leaves.
        leaves: Vec<u32>,
        /// Count of triangles in both.
        triangles: usize,
    },
    /// One horizon is above the other at some traces and below it at others.
    Crossing {
        /// The two horizons; the first is above at more traces.
        horizons: [String; 2],
        /// Count of traces at which the first is above.
        above: usize,
        /// Count of traces at which it is below.
        below: usize,
        /// The largest distance by which it is below, samples.
        worst: f32,
        /// The trace with that distance.
        at: Place,
    },
    /// The younger horizon lies below the older one.
    Swapped {
        /// The younger and the older horizon, by the stratigraphy.
        horizons: [String; 2],
        /// Count of traces at which the younger one is below.
        traces: usize,
    },
}

impl<Place> Conflict<Place> {
    /// The two horizons.
    pub fn horizons(&self) -> &[String; 2] {
        match self {
            Self::SharedLeaves { horizons, .. } | Self::Crossing { horizons, .. } | Self::Swapped { horizons, .. } => {
                horizons
            }
        }
    }

    /// The same with its place stated otherwise.
    pub fn placed<Other>(self, place: impl FnOnce(Place) -> Other) -> Conflict<Other> {
        match self {
            Self::SharedLeaves { horizons, leaves, triangles } => {
                Conflict::SharedLeaves { horizons, leaves, triangles }
            }
            Self::Crossing { horizons, above, below, worst, at } => {
                Conflict::Crossing { horizons, above, below, worst, at: place(at) }
            }
            Self::Swapped { horizons, traces } => Conflict::Swapped { horizons, traces },
        }
    }
}

/// Finds the conflicts between all pairs of horizons, which are given youngest first. `size` is `[inlines,
/// crosslines]`. `may_cross(young, old)` returns whether a contact rule lets a pair cut each other; such
/// pairs are only compared for shared leaves, and for those only when `forest` is given.
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
            let order = RelativeDepth::of(size, a.sheets, b.sheets, settings.tolerance);
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

/// How often, per block and trace, the first horizon is above the second and how often below.
#[derive(Default)]
struct RelativeDepth {
    above: usize,
    below: usize,
    /// The largest distance by which it is above, samples, and the trace with it.
    most_above: (f32, [usize; 2]),
    most_below: (f32, [usize; 2]),
}

impl RelativeDepth {
    fn of(size: [usize; 2], a: &[VoxelSheet], b: &[VoxelSheet], tolerance: f32) -> Self {
        let mut order = Self::default();
        for (left, right) in a.iter().flat_map(|left| b.iter().map(move |right| (left, right))) {
            if left.block != right.block {
                continue;
            }
            for (trace, (za, zb)) in left.z.iter().zip(&right.z).enumerate() {
                let by = zb - za;
                let place = [trace / size[1], trace % size[1]];
                // NaN (a hole) is neither above nor below.
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
