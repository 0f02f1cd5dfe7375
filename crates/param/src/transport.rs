//! (u, v) of a layer's middle, carried through the layer: both are constant along the lines that follow ∇k, so that they
//! are perpendicular to k wherever ∇k is continuous, as i, j by traces are on height fields (P-illus 3.2).
//!
//! ```text
//! u(p) = U(c(p)),   c(p) = where the line dx/dk = H∇k / (∇k·H∇k) through p meets k = ½
//! ```
//!
//! H is the inverse metric tensor, U what is carried: the function by arc length ([`crate::unfold`]). A line that leaves
//! the place where U is known, or cannot go on (at a crease of k), ends there: all places of the line share that end, so
//! that it does not matter for the angle.
//!
//! Lines begin at the nodes of a lattice; between these u and v are cubic ([`crate::tricubic`]).

use crate::Region;
use crate::metric::Metric;
use glam::Vec3;
use model::NodeBox;
use rayon::prelude::*;
use survey::LevelField;

/// Nodes around what a layer holds that lines begin at, too: those that the cubic between nodes uses.
const AROUND: usize = 2;
/// Steps of a line, at most.
const MOST_STEPS: usize = 600;
/// A line is at the middle when k is as near to ½.
const AT_MIDDLE: f32 = 1e-4;
/// A line ends where k rises by less than this share of what its slope says: there is a crease.
const LEAST_RISE: f32 = 0.3;

/// The place where the line through `start` along ∇k meets k = ½, or ends, by steps of at most `longest` cube roots of a
/// voxel. `rise` gives k and its derivatives per voxel.
pub(crate) fn middle(
    metric: &Metric,
    longest: f32,
    start: Vec3,
    rise: impl Fn(Vec3) -> (f32, Vec3),
    is_known: impl Fn(Vec3) -> bool,
) -> Vec3 {
    let mut p = start;
    let (mut k, mut slope) = rise(p);
    for _ in 0..MOST_STEPS {
        let left = 0.5 - k;
        let Some(step) = step(metric, longest, slope, left) else { break };
        if left.abs() < AT_MIDDLE {
            break;
        }
        // The midpoint rule.
        let Some(step) = self::step(metric, longest, rise(p + 0.5 * step).1, left) else { break };
        let next = p + step;
        if !is_known(next) {
            break;
        }
        let (at, next_slope) = rise(next);
        let expected = slope.dot(step).abs().min(left.abs());
        if (at - k) * left.signum() < LEAST_RISE * expected {
            break;
        }
        (p, k, slope) = (next, at, next_slope);
    }
    p
}

/// The voxel vector along ∇k over which k would rise by `by`, or the longest step that way; `None` where k has no slope.
fn step(metric: &Metric, longest: f32, slope: Vec3, by: f32) -> Option<Vec3> {
    let along = metric.raise(slope);
    let steepness = slope.dot(along);
    if !(steepness > 1e-12 && steepness.is_finite()) {
        return None;
    }
    let full = along * (by / steepness);
    let length = by.abs() / steepness.sqrt();
    Some(if length > longest { full * (longest / length) } else { full })
}

/// The layers that the nodes of a lattice hold, and their blocks.
pub(crate) struct Held {
    /// The lattice.
    pub nodes: NodeBox,
    block: Vec<u16>,
    /// The deepest and the highest layer that lies at a node or between it and one beside it.
    layers: Vec<[u16; 2]>,
}

impl Held {
    /// Asks for the region at each node.
    pub(crate) fn of(nodes: NodeBox, region_at: impl Fn(Vec3) -> Region + Sync) -> Self {
        let of_node: Vec<Region> =
            (0..nodes.count()).into_par_iter().map(|node| region_at(nodes.place(node))).collect();
        let layers = |node: usize| {
            let own = of_node[node];
            let same = nodes.beside(node).map(|m| of_node[m]).filter(|other| other.block == own.block);
            same.fold([own.layer; 2], |[low, high], other| [low.min(other.layer), high.max(other.layer)])
        };
        let layers = (0..nodes.count()).into_par_iter().map(layers).collect();
        Self { nodes, block: of_node.iter().map(|region| region.block).collect(), layers }
    }

    fn holds(&self, node: usize, region: Region) -> bool {
        let [low, high] = self.layers[node];
        self.block[node] == region.block && (low..=high).contains(&region.layer)
    }

    /// Two functions at the nodes around a region: `near` next to it, `far` in the rest of the box around it. A region
    /// that no node holds has a box of two nodes along each axis.
    pub(crate) fn fields(
        &self,
        region: Region,
        near: impl Fn(Vec3) -> [f32; 2] + Sync,
        far: impl Fn(Vec3) -> [f32; 2] + Sync,
    ) -> [LevelField; 2] {
        let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
        for node in (0..self.nodes.count()).filter(|&node| self.holds(node, region)) {
            let index = self.nodes.index(node);
            low = [0, 1, 2].map(|axis| low[axis].min(index[axis]));
            high = [0, 1, 2].map(|axis| high[axis].max(index[axis]));
        }
        let is_none = low[0] == usize::MAX;
        let low = if is_none { [0; 3] } else { low.map(|n| n.saturating_sub(AROUND)) };
        let high: [usize; 3] = std::array::from_fn(|axis| {
            let last = self.nodes.size[axis] - 1;
            if is_none { 1 } else { (high[axis] + AROUND).min(last).max(low[axis] + 1) }
        });
        let size: [usize; 3] = std::array::from_fn(|axis| high[axis] - low[axis] + 1);
        let whole = |n: usize| {
            let at = [n / (size[1] * size[2]), n / size[2] % size[1], n % size[2]];
            let [x, y, z] = [0, 1, 2].map(|axis: usize| low[axis] + at[axis]);
            (x * self.nodes.size[1] + y) * self.nodes.size[2] + z
        };
        let held = (0..size.iter().product()).map(|n| self.holds(whole(n), region)).collect();
        let is_near = widened(size, held);
        let value = |n: usize| {
            let p = self.nodes.place(whole(n));
            if is_near[n] { near(p) } else { far(p) }
        };
        let values: Vec<[f32; 2]> = (0..is_near.len()).into_par_iter().map(value).collect();
        let origin = self.nodes.place(whole(0));
        [0, 1].map(|which: usize| LevelField {
            origin,
            step: self.nodes.step,
            size,
            values: values.iter().map(|value| value[which]).collect(),
        })
    }
}

/// Whether a node of a box lies within [`AROUND`] nodes of one that is held, along each axis.
fn widened(size: [usize; 3], mut held: Vec<bool>) -> Vec<bool> {
    let strides = [size[1] * size[2], size[2], 1];
    for axis in 0..3 {
        let before = held.clone();
        for n in (0..before.len()).filter(|&n| before[n]) {
            let at = n / strides[axis] % size[axis];
            for m in at.saturating_sub(AROUND)..=(at + AROUND).min(size[axis] - 1) {
                held[n + m * strides[axis] - at * strides[axis]] = true;
            }
        }
    }
    held
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    /// Rings around an axis along y: k rises outwards, and lines are radii.
    #[test]
    fn lines_through_rings_are_radii() {
        let metric = Metric::new(DMat3::IDENTITY, 1.0).unwrap();
        let rise = |p: Vec3| {
            let out = Vec3::new(p.x, 0.0, p.z);
            ((out.length() - 10.0) / 20.0, out.normalize() / 20.0)
        };
        for start in [Vec3::new(11.0, 3.0, 0.0), Vec3::new(8.0, 1.0, -9.0), Vec3::new(-19.0, 0.0, 20.0)] {
            let found = middle(&metric, 1.5, start, rise, |_| true);
            let exact = Vec3::new(start.x, 0.0, start.z).normalize() * 20.0 + Vec3::Y * start.y;
            assert!(found.abs_diff_eq(exact, 0.01), "{start}: {found} {exact}");
        }
        // What is not known ends a line.
        let found = middle(&metric, 1.5, Vec3::new(11.0, 0.0, 0.0), rise, |p| p.x < 14.0);
        assert!(found.x > 12.0 && found.x < 14.0, "{found}");
    }

    #[test]
    fn a_crease_ends_a_line() {
        let metric = Metric::new(DMat3::IDENTITY, 1.0).unwrap();
        // The distance from two planes that meet: largest on x = 0, never ½.
        let rise = |p: Vec3| (0.3 - 0.01 * p.x.abs(), Vec3::X * (-0.01 * p.x.signum()));
        let found = middle(&metric, 1.5, Vec3::new(7.3, 0.0, 0.0), rise, |_| true);
        assert!(found.x.abs() < 3.0, "{found}");
    }

    #[test]
    fn a_thin_layer_between_nodes_is_held_by_both() {
        let nodes = NodeBox { origin: Vec3::ZERO, step: Vec3::splat(4.0), size: [6; 3] };
        // Layer 1 lies between z = 9 and 10, where no node is.
        let region = |p: Vec3| Region { layer: if p.z < 9.0 { 2 } else { u16::from(p.z < 10.0) }, block: 0 };
        let held = Held::of(nodes, region);
        let [field, _] = held.fields(Region { layer: 1, block: 0 }, |_| [1.0; 2], |_| [0.0; 2]);
        assert_eq!((field.origin.z, field.size), (0.0, [6, 6, 6]));
        assert!(field.values.iter().enumerate().all(|(n, &value)| value == f32::from(u8::from(n % 6 < 6))));
        let [none, _] = held.fields(Region { layer: 0, block: 1 }, |_| [1.0; 2], |_| [0.0; 2]);
        assert_eq!(none.size, [2; 3]);
    }
}
