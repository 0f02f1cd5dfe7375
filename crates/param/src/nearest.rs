//! Starting points for the search of a closest point: the nearest of a sparse set of the sheet's nodes, by
//! kd-tree.
//!
//! Every [`STRIDE`]th node of a sheet, in metres up to a scale, goes into an immutable `kiddo` tree. The set
//! can be sparse because Newton's method on the surface ([`crate::closest`]) makes the answer exact, and a
//! sparse set keeps the tree fast. Nodes of a height field differ in (x, y), so there are no duplicates.
//!
//! # Cost on flat sheets
//! A flat sheet is never split along z, so the tree visits all nodes within the distance itself. Measured on
//! a busy machine (µs a query, sheet of N × N voxels): 3 and 14 at distances N/4 and N/2 for N = 256, 27 and
//! 67 for N = 512, 86 and 117 for N = 1024; a third of that on a gentle fold. With one query per 1500 voxels
//! ([`crate::lattice`]) the worst of these is 0.1 µs a voxel, a sixth of the total.

use crate::metric::Metric;
use crate::surface::BicubicSheet;
use glam::{DMat3, DVec3};
use kiddo::{ImmutableKdTree, SquaredEuclidean};

/// Distance between the nodes in the tree, voxels.
const STRIDE: usize = 4;

/// Finds a node of a sheet near a point.
pub(crate) struct NodeFinder {
    tree: ImmutableKdTree<f32, 3>,
    columns: Vec<[i32; 2]>,
    map: DMat3,
    centre: DVec3,
}

impl NodeFinder {
    /// Builds the tree over a sheet.
    pub(crate) fn new(surface: &BicubicSheet, metric: &Metric) -> Self {
        let (origin, size) = surface.extent();
        let along = |axis: usize| {
            let last = size[axis] - 1;
            (0..last).step_by(STRIDE).chain([last]).map(move |n| origin[axis] + n as i32)
        };
        let columns: Vec<[i32; 2]> = along(0).flat_map(|x| along(1).map(move |y| [x, y])).collect();
        let [x, y] = columns[columns.len() / 2];
        let centre = DVec3::new(f64::from(x), f64::from(y), f64::from(surface.node(x, y)));
        let map = metric.scaled_from_voxel();
        let place = |p: DVec3| (map * (p - centre)).as_vec3().to_array();
        let points: Vec<[f32; 3]> = columns
            .iter()
            .map(|&[x, y]| place(DVec3::new(f64::from(x), f64::from(y), f64::from(surface.node(x, y)))))
            .collect();
        let tree = ImmutableKdTree::new_from_slice(&points);
        // Construction fails on more points than u32 can number and on many points in one place.
        let tree = tree.expect("a sheet has fewer than 2³² nodes, each in a column of its own");
        Self { tree, columns, map, centre }
    }

    /// The column of the node in the tree that is nearest to voxel `p`.
    pub(crate) fn near(&self, p: DVec3) -> [i32; 2] {
        let query = (self.map * (p - self.centre)).as_vec3().to_array();
        let found = self.tree.query(&query).nearest_one::<SquaredEuclidean<f32>>().execute();
        self.columns[found.item as usize]
    }
}
