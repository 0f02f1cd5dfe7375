//! A record of a node in a few numbers that outlive its extraction, by which a replay finds out whether a
//! pick still means the same.

use crate::forest::Forest;
use serde::{Deserialize, Serialize};

/// The record of a picked node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// Count of its triangles.
    pub triangles: u32,
    /// Smallest inline and crossline index.
    pub low: [u16; 2],
    /// Largest inline and crossline index.
    pub high: [u16; 2],
    /// Mean sample index of its triangles' corners.
    pub mean_z: f32,
    /// FNV-1a hash of the corners of its triangles in the order of the forest.
    pub digest: u32,
}

/// How a node compares with a recorded one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum NodeFit {
    /// The same triangles.
    Same,
    /// The same place and extent for practical purposes: count within 5 %, bounds within 3 traces, mean
    /// within half a sample.
    Similar,
    /// Another node.
    Different,
}

impl Fingerprint {
    /// The fingerprint of a node.
    pub fn of(forest: &Forest, node: u32) -> Self {
        let range = forest.nodes[node as usize].triangles.clone();
        let (mut low, mut high) = ([u16::MAX; 2], [0; 2]);
        let (mut sum, mut digest) = (0.0f64, 0x811c_9dc5u32);
        for &v in forest.surfaces.triangles[range.start as usize..range.end as usize].iter().flatten() {
            let vertex = forest.surfaces.vertices[v as usize];
            for (axis, c) in [vertex.x, vertex.y].into_iter().enumerate() {
                low[axis] = low[axis].min(c);
                high[axis] = high[axis].max(c);
            }
            sum += f64::from(vertex.z);
            for word in [u32::from(vertex.x) << 16 | u32::from(vertex.y), vertex.z.to_bits()] {
                digest = (digest ^ word).wrapping_mul(0x0100_0193);
            }
        }
        let corners = f64::from(range.len() as u32 * 3).max(1.0);
        Self { triangles: range.len() as u32, low, high, mean_z: (sum / corners) as f32, digest }
    }

    /// Compares `now` with this record.
    pub fn compare(&self, now: &Self) -> NodeFit {
        if self == now {
            return NodeFit::Same;
        }
        let count = f64::from(self.triangles.abs_diff(now.triangles)) <= 0.05 * f64::from(self.triangles);
        let bounds = (0..2)
            .all(|axis| self.low[axis].abs_diff(now.low[axis]) <= 3 && self.high[axis].abs_diff(now.high[axis]) <= 3);
        if count && bounds && (self.mean_z - now.mean_z).abs() <= 0.5 { NodeFit::Similar } else { NodeFit::Different }
    }
}
