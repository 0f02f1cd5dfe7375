//! Finds nodes that were picked on the wrong side of a fault.
//!
//! A fault and a horizon are seldom interpreted so consistently that every node lies on its own side of the
//! fault. A node that does not would stand out as a spike as high as the throw. A node close to the
//! interpreted part of a fault is a stray when it lies more than 1.5 voxels off the surface continued from
//! the undoubted nodes of its own block, and the surface continued from another block fits it at least four
//! times as well.

use super::extension::LocalFits;
use super::lattice::{InterpretedNode, MarginLattice};

/// Undoubted nodes are looked for within this many nodes.
const REACH: i32 = 8;
/// Smallest misfit of a stray, voxels.
const LEAST: f32 = 1.5;
/// Noise floor of the fits, voxels.
const NOISE: f32 = 0.25;

/// Removes the strays among the nodes of one horizon (sorted by block); returns how many there were.
pub(super) fn take_out(lattice: MarginLattice, nodes: &mut Vec<InterpretedNode>, radius: f32) -> usize {
    let blocks = nodes.last().map_or(0, |n| usize::from(n.block) + 1);
    if blocks < 2 || !nodes.iter().any(|n| n.doubtful) {
        return 0;
    }
    let doubtful: Vec<(usize, InterpretedNode)> =
        nodes.iter().copied().enumerate().filter(|(_, n)| n.doubtful).collect();
    // Misfit of each doubtful node to the surface continued from each block; infinite where that block is not
    // near.
    let mut off = vec![vec![f32::INFINITY; blocks]; doubtful.len()];
    for of_block in nodes.chunk_by(|a, b| a.block == b.block) {
        let mut z = vec![f32::NAN; lattice.len()];
        for node in of_block.iter().filter(|n| !n.doubtful) {
            z[node.at as usize] = node.z;
        }
        let known: Vec<bool> = z.iter().map(|z| z.is_finite()).collect();
        let fits = LocalFits::new(lattice.size, &z, &known, radius, NOISE);
        for ((_, node), off) in doubtful.iter().zip(&mut off) {
            if let Some((m, dx, dy)) = nearest(lattice, &known, node.at as usize) {
                let fit = fits.at(m);
                let expected = fit.curved(dx as f32, dy as f32);
                off[usize::from(of_block[0].block)] = (node.z - expected).abs();
            }
        }
    }
    let mut stray = vec![false; nodes.len()];
    for ((index, node), off) in doubtful.iter().zip(&off) {
        let own = off[usize::from(node.block)];
        let other = off.iter().copied().fold(f32::INFINITY, f32::min);
        stray[*index] = own.is_finite() && own > LEAST && other < 0.25 * own;
    }
    let count = stray.iter().filter(|s| **s).count();
    let mut at = 0;
    nodes.retain(|_| {
        at += 1;
        !stray[at - 1]
    });
    count
}

/// The nearest known node within reach of node `n`, and the offset from it to `n`.
fn nearest(lattice: MarginLattice, known: &[bool], n: usize) -> Option<(usize, i32, i32)> {
    let (x, y) = ((n / lattice.size[1]) as i32, (n % lattice.size[1]) as i32);
    let mut best: Option<(i32, usize, i32, i32)> = None;
    for i in (x - REACH).max(0)..=(x + REACH).min(lattice.size[0] as i32 - 1) {
        for j in (y - REACH).max(0)..=(y + REACH).min(lattice.size[1] as i32 - 1) {
            let m = i as usize * lattice.size[1] + j as usize;
            let distance = (x - i).pow(2) + (y - j).pow(2);
            if known[m] && best.is_none_or(|b| distance < b.0) {
                best = Some((distance, m, x - i, y - j));
            }
        }
    }
    best.map(|(_, m, dx, dy)| (m, dx, dy))
}
