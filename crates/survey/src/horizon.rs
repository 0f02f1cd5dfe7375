//! A horizon as a set of sheets, one for each fault block in which it was interpreted, or as a surface of any shape.
//!
//! Depths are vertical values (ms TWT or m, positive down) at the nodes of the sheet's own grid; NaN marks a
//! hole. Two sheets may cover the same trace, as they do at a reverse fault.

use crate::geometry::SurveyGeometry;
use crate::mesh::TriangleMesh;
use glam::{DMat2, DVec2};
use serde::{Deserialize, Serialize};

/// The origin of the depth at a node.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
pub enum Quality {
    /// A hole: no depth.
    #[default]
    Hole = 0,
    /// Picked by an interpreter or imported.
    Picked = 1,
    /// Tracked by a program.
    Tracked = 2,
    /// Filled between picks.
    Filled = 3,
    /// Extrapolated beyond the picks.
    Extrapolated = 4,
    /// Taken from a reflection beside a level of geologic time.
    Snapped = 5,
}

impl Quality {
    /// Whether a node lies on what was picked, or on a reflection.
    pub fn is_on_data(self) -> bool {
        matches!(self, Self::Picked | Self::Tracked | Self::Snapped)
    }
}

/// A regular grid of nodes in world X, Y; `[u][v]`, v fastest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NodeGrid {
    /// World X, Y of node (0, 0), m.
    pub origin: DVec2,
    /// World step from node (u, v) to (u + 1, v), m.
    pub u_step: DVec2,
    /// World step from node (u, v) to (u, v + 1), m.
    pub v_step: DVec2,
    /// Counts along u and v.
    pub count: [usize; 2],
}

impl NodeGrid {
    /// The survey's own traces: u = inline index, v = crossline index.
    pub fn of_survey(geometry: &SurveyGeometry) -> Self {
        Self {
            origin: geometry.origin,
            u_step: geometry.inline_vector,
            v_step: geometry.crossline_vector,
            count: [geometry.inlines.count, geometry.crosslines.count],
        }
    }

    /// World X, Y of a fractional node index.
    pub fn world_at(&self, node: DVec2) -> DVec2 {
        self.origin + self.u_step * node.x + self.v_step * node.y
    }

    /// Fractional node index of world X, Y.
    pub fn node_at(&self, world: DVec2) -> DVec2 {
        DMat2::from_cols(self.u_step, self.v_step).inverse() * (world - self.origin)
    }
}

/// The part of a horizon that lies in one fault block.
///
/// ```
/// # use glam::DVec2;
/// # use survey::{NodeGrid, Quality, Sheet};
/// let (u_step, v_step) = (DVec2::new(25.0, 0.0), DVec2::new(0.0, 25.0));
/// let grid = NodeGrid { origin: DVec2::ZERO, u_step, v_step, count: [2, 2] };
/// let sheet = Sheet::new(grid, vec![100.0, 110.0, 120.0, f32::NAN], Quality::Picked);
/// assert_eq!(sheet.node_count(), 3);
/// assert_eq!(sheet.quality[3], Quality::Hole);
/// assert_eq!(sheet.depth_at_node(DVec2::new(0.0, 0.5)), 105.0);
/// assert!(sheet.depth_at_node(DVec2::new(0.5, 0.5)).is_nan());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The fault block of the sheet. `None` while blocks are not known: each node then belongs to the block
    /// in which it lies.
    pub block: Option<u16>,
    /// Positions of the nodes.
    pub grid: NodeGrid,
    /// Vertical value per node, `[u][v]`; NaN = hole.
    pub depth: Vec<f32>,
    /// Quality per node, `[u][v]`.
    pub quality: Vec<Quality>,
}

impl Sheet {
    /// A sheet whose nodes with a finite depth all have `quality`; the others are holes.
    ///
    /// # Panics
    /// When the count of depths is not the count of nodes.
    pub fn new(grid: NodeGrid, depth: Vec<f32>, quality: Quality) -> Self {
        assert_eq!(depth.len(), grid.count[0] * grid.count[1], "one depth a node");
        let quality = depth.iter().map(|d| if d.is_finite() { quality } else { Quality::Hole }).collect();
        Self { block: None, grid, depth, quality }
    }

    /// Depth by bilinear interpolation at a fractional node index. It is NaN outside the grid, and where a
    /// corner that has a weight is a hole.
    pub fn depth_at_node(&self, node: DVec2) -> f32 {
        let [nu, nv] = self.grid.count;
        let (u, v) = (node.x, node.y);
        let slack = 1e-6;
        if !(u >= -slack && v >= -slack && u <= nu as f64 - 1.0 + slack && v <= nv as f64 - 1.0 + slack) {
            return f32::NAN;
        }
        let (u0, v0) = ((u + slack).floor().max(0.0), (v + slack).floor().max(0.0));
        let (fu, fv) = ((u - u0) as f32, (v - v0) as f32);
        let (u0, v0) = (u0 as usize, v0 as usize);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (du, wu) in [(0, 1.0 - fu), (1, fu)] {
            for (dv, wv) in [(0, 1.0 - fv), (1, fv)] {
                // A position exactly on a node needs no neighbours, so holes beside it do not matter.
                let weight: f32 = wu * wv;
                if weight.abs() > 1e-5 {
                    let (u, v) = ((u0 + du).min(nu - 1), (v0 + dv).min(nv - 1));
                    sum += weight * self.depth[u * nv + v];
                    weights += weight;
                }
            }
        }
        // Dividing by the weights used matters: those left out would change a depth of 1000 by a hundredth.
        sum / weights
    }

    /// Count of nodes with a depth.
    pub fn node_count(&self) -> usize {
        self.depth.iter().filter(|d| d.is_finite()).count()
    }
}

/// An interpreted horizon: one or more sheets, or a surface of any shape.
///
/// ```
/// # use survey::{Horizon, NodeGrid, Quality, Sheet, SurveyGeometry, VerticalUnit};
/// let geometry = SurveyGeometry::regular([3, 4, 50], 25.0, 4.0, VerticalUnit::Milliseconds);
/// let flat = Sheet::new(NodeGrid::of_survey(&geometry), vec![120.0; 12], Quality::Tracked);
/// let horizon = Horizon::new("Top chalk", vec![flat]);
/// assert_eq!(horizon.sheets[0].grid.world_at(glam::DVec2::new(2.0, 3.0)), glam::DVec2::new(50.0, 75.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Horizon {
    /// Unique within a project.
    pub name: String,
    /// Its sheets; none where it is no height field.
    pub sheets: Vec<Sheet>,
    /// A surface that may be overturned or closed: triangles, or scattered points alone. Beside sheets, the points that
    /// they were interpolated between.
    pub surface: Option<TriangleMesh>,
}

impl Horizon {
    /// A horizon of sheets.
    pub fn new(name: impl Into<String>, sheets: Vec<Sheet>) -> Self {
        Self { name: name.into(), sheets, surface: None }
    }

    /// The surface of a horizon that is no height field.
    pub fn any_shape(&self) -> Option<&TriangleMesh> {
        self.surface.as_ref().filter(|_| self.sheets.is_empty())
    }

    /// A horizon of any shape: overturned limbs, a closed body. A mesh without triangles is a set of points.
    pub fn of_surface(name: impl Into<String>, surface: TriangleMesh) -> Self {
        Self { name: name.into(), sheets: Vec::new(), surface: Some(surface) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet() -> Sheet {
        let grid = NodeGrid {
            origin: DVec2::new(100.0, 50.0),
            u_step: DVec2::new(0.0, 10.0),
            v_step: DVec2::new(20.0, 0.0),
            count: [2, 3],
        };
        Sheet::new(grid, vec![0.0, 1.0, 2.0, 10.0, 11.0, f32::NAN], Quality::Picked)
    }

    #[test]
    fn bilinear_between_nodes_and_nan_beside_a_hole() {
        let s = sheet();
        assert_eq!(s.depth_at_node(DVec2::new(0.5, 0.5)), 5.5);
        assert_eq!(s.depth_at_node(DVec2::new(0.0, 2.0)), 2.0);
        assert!(s.depth_at_node(DVec2::new(0.5, 1.5)).is_nan());
        assert!(s.depth_at_node(DVec2::new(-0.5, 0.0)).is_nan());
        assert_eq!((s.node_count(), s.quality[5]), (5, Quality::Hole));
    }

    #[test]
    fn node_and_world_invert() {
        let grid = sheet().grid;
        let node = DVec2::new(0.25, 1.75);
        assert!((grid.node_at(grid.world_at(node)) - node).length() < 1e-12);
    }
}
