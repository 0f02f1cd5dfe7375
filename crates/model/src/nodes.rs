//! The interpreted nodes of a horizon on the voxel lattice, each with the fault block it belongs to.
//!
//! Sheets on other grids are resampled by the Catmull–Rom bicubic of their own nodes; a cell takes part only
//! when its four corners belong to one block, so that nothing is interpolated across a fault. Nodes too close
//! to a fault, or picked on the wrong side of it, are left out.

use super::lattice::{InterpretedNode, MarginLattice};
use super::network::FaultNetwork;
use super::report::{ModelNote, ModelReport};
use super::settings::ModelSettings;
use super::strays;
use glam::{DMat2, DVec2};
use survey::geometry::SurveyGeometry;
use survey::horizon::{Horizon, Quality, Sheet};

/// When the interpretation does not say which block a node belongs to, the node is doubtful within this many
/// voxels of the interpreted part of a fault.
const DOUBTFUL_VOXELS: f64 = 4.0;

/// All nodes of one horizon, at most one per block and lattice node; by block, then lattice node.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct HorizonNodes {
    pub nodes: Vec<InterpretedNode>,
    /// Interpreted depths that lie outside the lattice or far outside the samples.
    pub outside: usize,
    /// Native nodes without a depth.
    pub holes: usize,
}

/// Gathers the nodes of `horizon`.
pub(super) fn gather(
    geometry: &SurveyGeometry,
    lattice: MarginLattice,
    horizon: &Horizon,
    faults: &FaultNetwork,
    settings: &ModelSettings,
    report: &mut ModelReport,
) -> HorizonNodes {
    let mut out = HorizonNodes::default();
    let mut set_back = 0;
    for sheet in &horizon.sheets {
        let native = Native::new(geometry, sheet, faults, &horizon.name, report);
        out.holes += sheet.depth.iter().filter(|d| !d.is_finite()).count();
        out.outside += native.outside(lattice);
        for n in 0..lattice.len() {
            native.sample(lattice.voxel(n), |z, quality, block| {
                let p = lattice.place(n, z);
                let (bits, mut beyond, mut distance) = (faults.bits_at(p), 0, f64::INFINITY);
                for (f, surface) in faults.surfaces().iter().enumerate() {
                    let at = p.as_dvec3();
                    let real = surface.extent_at(at) >= 0.0;
                    beyond |= u64::from(!real) << f;
                    if sheet.block.is_none() && real && faults.existing(bits) >> f & 1 == 1 {
                        // Horizontal distance, to first order.
                        let steep = surface.side_gradient(at).truncate().length();
                        distance = distance.min(surface.side(at).abs() / steep.max(1e-9));
                    }
                }
                if distance < f64::from(settings.fault_setback) {
                    set_back += 1;
                } else {
                    let doubtful = distance < DOUBTFUL_VOXELS;
                    out.nodes.push(InterpretedNode { at: n as u32, z, quality, block, bits, beyond, doubtful });
                }
            });
        }
    }
    if set_back > 0 {
        report.notes.push(ModelNote::SetBack { horizon: horizon.name.clone(), nodes: set_back });
    }
    // Picked sheets come before sheets that were computed from picks; otherwise the order of the sheets is
    // kept.
    out.nodes.sort_by_key(|n| (n.block, n.at, n.quality));
    let (mut nodes, mut worst) = (0, 0.0f32);
    for pair in out.nodes.windows(2) {
        if (pair[0].block, pair[0].at) == (pair[1].block, pair[1].at) && (pair[0].z - pair[1].z).abs() > 0.5 {
            nodes += 1;
            worst = worst.max((pair[0].z - pair[1].z).abs());
        }
    }
    if nodes > 0 {
        report.notes.push(ModelNote::Overlap { horizon: horizon.name.clone(), nodes, worst });
    }
    out.nodes.dedup_by_key(|n| (n.block, n.at));
    let strays = strays::take_out(lattice, &mut out.nodes, settings.slope_radius);
    if strays > 0 {
        report.notes.push(ModelNote::Strays { horizon: horizon.name.clone(), nodes: strays });
    }
    out
}

/// A sheet in voxel z with the block of each of its nodes.
struct Native<'a> {
    sheet: &'a Sheet,
    z: Vec<f32>,
    block: Vec<u16>,
    node_from_voxel: DMat2,
    node_origin: DVec2,
}

/// A position closer to a node than this, in node spacings, counts as that node.
const SNAP: f64 = 1e-3;

impl<'a> Native<'a> {
    fn new(
        geometry: &SurveyGeometry,
        sheet: &'a Sheet,
        faults: &FaultNetwork,
        name: &str,
        report: &mut ModelReport,
    ) -> Self {
        let grid = &sheet.grid;
        let samples = geometry.vertical.count as f32;
        // A depth farther outside the volume than the volume is high cannot be meant.
        let range = [-samples, 2.0 * samples];
        let z: Vec<f32> = sheet
            .depth
            .iter()
            .map(|&d| geometry.vertical.index_of(f64::from(d)) as f32)
            .map(|z| if z >= range[0] && z <= range[1] { z } else { f32::NAN })
            .collect();
        let mut block = vec![0; z.len()];
        if faults.block_count() > 1 {
            let mut count = vec![0usize; faults.block_count()];
            for (n, block) in block.iter_mut().enumerate() {
                if z[n].is_finite() {
                    let node = DVec2::new((n / grid.count[1]) as f64, (n % grid.count[1]) as f64);
                    let voxel = geometry.voxel_from_world(grid.world_at(node).extend(0.0)).as_vec3();
                    *block = faults.block_at(voxel.truncate().extend(z[n]));
                    // What was continued past a fault does not say in which block a sheet lies.
                    count[usize::from(*block)] += usize::from(sheet.quality[n] != Quality::Extrapolated);
                }
            }
            if let Some(given) = sheet.block {
                // Block numbers follow from the faults. A sheet that was made with other faults carries stale
                // ones.
                let most = (0..count.len()).max_by_key(|&b| (count[b], usize::MAX - b)).unwrap_or(0);
                let agree = count.get(usize::from(given)).copied().unwrap_or(0);
                let used = if 2 * agree >= count[most] { given } else { most as u16 };
                if used != given {
                    report.notes.push(ModelNote::Reassigned { horizon: name.to_owned(), given, used });
                }
                block.fill(used);
            }
        }
        let voxel_map = DMat2::from_cols(geometry.inline_vector, geometry.crossline_vector);
        let node_map = DMat2::from_cols(grid.u_step, grid.v_step).inverse();
        Self {
            sheet,
            z,
            block,
            node_from_voxel: node_map * voxel_map,
            node_origin: node_map * (geometry.origin - grid.origin),
        }
    }

    /// Depths that no lattice node is near, or that lie outside the range.
    fn outside(&self, lattice: MarginLattice) -> usize {
        let voxel_from_node = self.node_from_voxel.inverse();
        let nv = self.sheet.grid.count[1];
        (0..self.z.len())
            .filter(|&n| {
                let node = DVec2::new((n / nv) as f64, (n % nv) as f64);
                let voxel = voxel_from_node * (node - self.node_origin);
                let off = |c: f64, origin: i32, size: usize| {
                    c < f64::from(origin) - 0.5 || c > f64::from(origin) + size as f64 - 0.5
                };
                self.sheet.depth[n].is_finite()
                    && (self.z[n].is_nan()
                        || off(voxel.x, lattice.origin[0], lattice.size[0])
                        || off(voxel.y, lattice.origin[1], lattice.size[1]))
            })
            .count()
    }

    /// Calls `found(z, quality, block)` for each block that has a height at voxel (x, y).
    fn sample(&self, voxel: [i32; 2], mut found: impl FnMut(f32, Quality, u16)) {
        let node = self.node_from_voxel * DVec2::new(f64::from(voxel[0]), f64::from(voxel[1])) + self.node_origin;
        let [nu, nv] = self.sheet.grid.count.map(|n| n as f64);
        if !(node.x >= -SNAP && node.y >= -SNAP && node.x <= nu - 1.0 + SNAP && node.y <= nv - 1.0 + SNAP) {
            return;
        }
        let split = |c: f64| {
            let whole = (c + SNAP).floor();
            let rest = c - whole;
            (whole as i64, if rest.abs() <= SNAP { 0.0 } else { rest as f32 })
        };
        let ((u, fu), (v, fv)) = (split(node.x), split(node.y));
        let mut tried: [Option<u16>; 4] = [None; 4];
        for (k, (du, dv)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
            if (du == 1 && fu == 0.0) || (dv == 1 && fv == 0.0) {
                continue;
            }
            let Some(block) = self.block_of(u + du, v + dv) else { continue };
            if tried.contains(&Some(block)) {
                continue;
            }
            tried[k] = Some(block);
            let along_v = |u: i64| between(fv, |k| self.height(u, v + k, block));
            if let Some(z) = between(fu, |k| along_v(u + k)) {
                let (nearest_u, nearest_v) = (u + i64::from(fu > 0.5), v + i64::from(fv > 0.5));
                found(z, self.sheet.quality[nearest_u as usize * self.sheet.grid.count[1] + nearest_v as usize], block);
            }
        }
    }

    fn index(&self, u: i64, v: i64) -> Option<usize> {
        let [nu, nv] = self.sheet.grid.count;
        let inside = u >= 0 && v >= 0 && (u as usize) < nu && (v as usize) < nv;
        inside.then(|| u as usize * nv + v as usize).filter(|&n| self.z[n].is_finite())
    }

    fn block_of(&self, u: i64, v: i64) -> Option<u16> {
        self.index(u, v).map(|n| self.block[n])
    }

    fn height(&self, u: i64, v: i64, block: u16) -> Option<f32> {
        self.index(u, v).filter(|&n| self.block[n] == block).map(|n| self.z[n])
    }
}

/// Catmull–Rom between `at(0)` and `at(1)`; both must exist, their outer neighbours are continued linearly
/// when missing.
fn between(t: f32, at: impl Fn(i64) -> Option<f32>) -> Option<f32> {
    let p = at(0)?;
    if t == 0.0 {
        return Some(p);
    }
    let q = at(1)?;
    let (before, after) = (at(-1).unwrap_or(2.0 * p - q), at(2).unwrap_or(2.0 * q - p));
    let slope = 0.5 * (q - before);
    let (a, b) = (before - 2.5 * p + 2.0 * q - 0.5 * after, 0.5 * (after - before) + 1.5 * (p - q));
    Some(p + t * (slope + t * (a + t * b)))
}
