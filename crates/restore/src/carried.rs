//! Horizons, faults and bodies where restored rock carries them.
//!
//! A horizon has a sheet in each block of the restored faults, as far as the model's own sheets go, also past the faults: so it is
//! as straight at a fault as it was. A fault is the model's surface within its rim, moved with the foot wall: the block below it,
//! or that on its negative side where it is upright. It is cut off a little above the horizon.

use crate::restoration::{FaultMove, Moves, RestoreNote};
use crate::target::is_known;
use glam::{DVec2, DVec3};
use model::{FaultNetwork, FaultSurface};
use rayon::prelude::*;
use survey::{Fault, Horizon, NodeGrid, Quality, Sheet, Stratigraphy, SurveyGeometry, TriangleMesh};

/// How far beside a fault its walls are looked up, voxels.
const BESIDE: f64 = 0.75;
/// How far above the horizon a fault goes on, as a share of the survey's height, so that its line on the ground is whole.
const ABOVE: f64 = 0.004;
/// How far past the fault that it ends at a fault goes on, cells of its surface.
const PAST: f64 = 1.5;
/// Cells along and down a fault's surface, at most.
const MOST_CELLS: usize = 160;
/// Every so many nodes, and places down, the blocks before and after are compared.
const COMPARED: [usize; 2] = [3, 24];

/// What became of the horizons.
pub(crate) struct CarriedHorizons {
    pub stratigraphy: Stratigraphy,
    pub horizons: Vec<Horizon>,
    /// Which horizons of the model they are.
    pub kept: Vec<usize>,
}

/// A fault as the model sees it, up to its rim and to what it ends at, voxels.
fn drawn(moves: &Moves<'_>, fault: usize) -> TriangleMesh {
    let faults = moves.model.faults();
    let surface = &faults.surfaces()[fault];
    let (origin, size) = (surface.surface.origin, surface.surface.size);
    let voxel_from_frame = surface.frame_from_voxel.inverse();
    let step = size.map(|count| (count - 1).div_ceil(MOST_CELLS).max(1));
    let counts = [0, 1].map(|axis| (size[axis] - 1) / step[axis] + 1);
    let mut mesh = TriangleMesh::default();
    let mut rim = Vec::with_capacity(counts[0] * counts[1]);
    for n in 0..counts[0] * counts[1] {
        let u = f64::from(origin[0]) + (n / counts[1] * step[0]) as f64;
        let v = f64::from(origin[1]) + (n % counts[1] * step[1]) as f64;
        let w = f64::from(surface.surface.z_at(u as f32, v as f32));
        mesh.vertices.push(voxel_from_frame * (DVec3::new(u, v, w) - surface.frame_offset));
        rim.push(-f64::from(surface.extent.z_at(u as f32, v as f32)));
    }
    for i in 0..counts[0] - 1 {
        for j in 0..counts[1] - 1 {
            let n = (i * counts[1] + j) as u32;
            let (right, down) = (n + counts[1] as u32, n + 1);
            mesh.triangles.push([n, right, down]);
            mesh.triangles.push([right, right + 1, down]);
        }
    }
    let [within, _] = mesh.parted(&rim);
    // Past the volume and its sheets nothing is known.
    let sheet = moves.model.sheet(moves.target, 0);
    let nz = moves.model.size()[2] as f64;
    let beyond = |p: &DVec3| {
        let low = DVec3::new(f64::from(sheet.origin[0]), f64::from(sheet.origin[1]), -0.5 * nz);
        let high = DVec3::new(low.x + sheet.size[0] as f64, low.y + sheet.size[1] as f64, 1.5 * nz);
        (low - *p).max(*p - high).max_element()
    };
    let mut within = part_below_zero(&within, beyond);
    let mut of = fault;
    while let Some(end) = faults.truncation()[of] {
        let other = &faults.surfaces()[end.by];
        let sign = if end.positive { -1.0 } else { 1.0 };
        within = part_below_zero(&within, |p| sign * other.side(*p) - PAST * surface.spacing_m);
        of = end.by;
        if of == fault {
            break;
        }
    }
    within
}

/// The part of a mesh in which a function of the place is negative.
fn part_below_zero(mesh: &TriangleMesh, off: impl Fn(&DVec3) -> f64) -> TriangleMesh {
    let off: Vec<f64> = mesh.vertices.iter().map(off).collect();
    let [part, _] = mesh.parted(&off);
    part
}

/// The blocks beside a place on a fault: the foot wall and the hanging wall.
fn walls(faults: &FaultNetwork, surface: &FaultSurface, p: DVec3) -> [u16; 2] {
    let aside = surface.side_gradient(p).normalize_or_zero() * BESIDE;
    let down = if aside.z > 1e-9 { aside } else { -aside };
    [p + down, p - down].map(|q| faults.block_at(q.as_vec3()))
}

/// The faults that are left, in world space.
pub(crate) fn faults(moves: &Moves<'_>, geometry: &SurveyGeometry, notes: &mut Vec<RestoreNote>) -> Vec<Fault> {
    let network = moves.model.faults();
    let above = ABOVE * moves.model.size()[2] as f64;
    let one = |f: usize| {
        let surface = &network.surfaces()[f];
        let mut mesh = drawn(moves, f);
        for vertex in &mut mesh.vertices {
            let [foot, _] = walls(network, surface, *vertex);
            *vertex = moves.moved(foot, *vertex);
        }
        let mut mesh = part_below_zero(&mesh, |p| moves.plane.z_at(p.truncate()) - above - p.z);
        // Of what is above the horizon alone, a rim is left at most.
        let is_below = mesh.vertices.iter().any(|p| p.z > moves.plane.z_at(p.truncate()) + above);
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = geometry.world_from_voxel(*vertex));
        (is_below && !mesh.triangles.is_empty()).then_some(mesh)
    };
    let meshes: Vec<Option<TriangleMesh>> = (0..network.surfaces().len()).into_par_iter().map(one).collect();
    let mut left = Vec::new();
    for (f, mesh) in meshes.iter().enumerate() {
        let name = &network.surfaces()[f].name;
        let Some(mesh) = mesh else {
            notes.push(RestoreNote::FaultTakenAway { fault: name.clone() });
            continue;
        };
        // What it ended at may be gone, and then what that ended at counts.
        let mut end = network.truncation()[f].map(|end| end.by);
        while let Some(by) = end.filter(|by| meshes[*by].is_none()) {
            end = network.truncation()[by].map(|end| end.by);
        }
        let truncated_by = end.map(|by| network.surfaces()[by].name.clone());
        left.push(Fault { truncated_by, ..Fault::new(name.clone(), mesh.clone()) });
    }
    left
}

/// From which blocks each block of the restored faults comes, the one that gives most first.
fn sources(moves: &Moves<'_>, network: &FaultNetwork) -> Vec<Vec<u16>> {
    let before = moves.model.faults();
    let [nx, ny, nz] = moves.model.size();
    let [step, down] = COMPARED;
    let columns: Vec<[usize; 2]> =
        (0..nx).step_by(step).flat_map(|x| (0..ny).step_by(step).map(move |y| [x, y])).collect();
    let mut votes = vec![vec![0usize; before.block_count()]; network.block_count()];
    let found: Vec<(u16, u16)> = columns
        .into_par_iter()
        .flat_map_iter(|[x, y]| {
            let depths = (0..down).map(move |n| nz as f64 * (n as f64 + 0.5) / down as f64);
            let place = move |z: f64| DVec3::new(x as f64, y as f64, z);
            depths.map(place).filter_map(|p| {
                let block = before.block_at(p.as_vec3());
                let is_below = p.z > moves.sheets[usize::from(block)].z_at(p.truncate());
                is_below.then(|| (network.block_at(moves.moved(block, p).as_vec3()), block))
            })
        })
        .collect();
    for (after, block) in found {
        votes[usize::from(after)][usize::from(block)] += 1;
    }
    let most = (0..before.block_count()).max_by_key(|&b| votes.iter().map(|of| of[b]).sum::<usize>()).unwrap_or(0);
    let of_block = |votes: &Vec<usize>| {
        let mut order: Vec<u16> = (0..votes.len()).filter(|&b| votes[b] > 0).map(|b| b as u16).collect();
        order.sort_by_key(|&b| std::cmp::Reverse(votes[usize::from(b)]));
        if order.is_empty() { vec![most as u16] } else { order }
    };
    votes.iter().map(of_block).collect()
}

/// The horizons from the restored one down.
pub(crate) fn horizons(
    moves: &Moves<'_>,
    geometry: &SurveyGeometry,
    given: &[Horizon],
    network: &FaultNetwork,
    notes: &mut Vec<RestoreNote>,
) -> CarriedHorizons {
    let model = moves.model;
    let sources = sources(moves, network);
    let (mut kept, mut horizons) = (Vec::new(), Vec::new());
    for h in moves.target..given.len() {
        let name = given[h].name.clone();
        match given[h].any_shape() {
            Some(surface) if is_younger(moves, geometry, h, surface) => {
                let horizon = given[moves.target].name.clone();
                notes.push(RestoreNote::BodyTakenAway { body: name, horizon });
                continue;
            }
            Some(surface) => {
                notes.push(RestoreNote::Carried { horizon: name.clone() });
                let vertex = |world: &DVec3| {
                    let p = geometry.voxel_from_world(*world);
                    geometry.world_from_voxel(moves.moved(model.block_at(p.as_vec3()), p))
                };
                let vertices = surface.vertices.iter().map(vertex).collect();
                horizons.push(Horizon::of_surface(name, TriangleMesh { vertices, ..surface.clone() }));
            }
            None => {
                let sheet = |block: usize| sheet(moves, geometry, h, &sources[block]);
                let mut sheets: Vec<Sheet> = (0..sources.len()).into_par_iter().map(sheet).collect();
                if sheets.len() > 1 {
                    sheets.iter_mut().enumerate().for_each(|(block, sheet)| sheet.block = Some(block as u16));
                }
                horizons.push(Horizon::new(name, sheets));
            }
        }
        kept.push(h);
    }
    let all = model.stratigraphy();
    let order = kept.iter().map(|&h| all.horizons[h].clone()).collect();
    CarriedHorizons { stratigraphy: Stratigraphy { horizons: order, layer_names: Vec::new() }, horizons, kept }
}

/// Whether a body reaches above the restored horizon, so that it came later.
fn is_younger(moves: &Moves<'_>, geometry: &SurveyGeometry, horizon: usize, surface: &TriangleMesh) -> bool {
    let model = moves.model;
    let is_above = |world: &DVec3| {
        let p = geometry.voxel_from_world(*world);
        let block = model.block_at(p.as_vec3());
        p.z < moves.sheets[usize::from(block)].z_at(p.truncate()) - 1.0
    };
    model.rules().contacts()[horizon].is_intrusive() && surface.vertices.iter().any(is_above)
}

/// The sheet of a horizon in a block that comes from `sources`.
fn sheet(moves: &Moves<'_>, geometry: &SurveyGeometry, horizon: usize, sources: &[u16]) -> Sheet {
    let model = moves.model;
    let lattice = model.sheet(horizon, 0);
    let grid = NodeGrid {
        origin: geometry
            .world_from_voxel(DVec3::new(f64::from(lattice.origin[0]), f64::from(lattice.origin[1]), 0.0))
            .truncate(),
        count: lattice.size,
        ..NodeGrid::of_survey(geometry)
    };
    let [nx, ny, _] = model.size();
    let far = DVec2::new(nx as f64 - 1.0, ny as f64 - 1.0);
    let is_inside = |at: DVec2| at.cmpge(DVec2::ZERO).all() && at.cmple(far).all();
    let node = |n: usize| {
        let to = DVec2::new(
            f64::from(lattice.origin[0]) + (n / lattice.size[1]) as f64,
            f64::from(lattice.origin[1]) + (n % lattice.size[1]) as f64,
        );
        let from = |block: u16| {
            let (z, at) = moves.restored_z(horizon, block, to);
            let now = f64::from(model.sheet(horizon, block).z_at(at.x as f32, at.y as f32));
            (block, z, at, model.faults().holds(block, at.extend(now).as_vec3()))
        };
        let own = sources.iter().map(|&block| from(block)).find(|(.., is_own)| *is_own);
        let (block, z, at, is_own) = own.unwrap_or_else(|| from(sources[0]));
        let quality = match model.quality_at(horizon, block, at.x as f32, at.y as f32) {
            quality if is_own && is_inside(at) && is_inside(to) && is_known(model, horizon, block, at) => quality,
            _ => Quality::Extrapolated,
        };
        (geometry.vertical.value_at(z) as f32, quality)
    };
    let (depth, quality) = (0..lattice.z.len()).map(node).unzip();
    Sheet { block: None, grid, depth, quality }
}

/// What became of each fault that is left.
pub(crate) fn fault_moves(moves: &Moves<'_>, after: &FaultNetwork) -> Vec<FaultMove> {
    let before = moves.model.faults();
    let metric = moves.model.metric();
    let flat = |v: DVec2| (metric * v.extend(0.0)).length();
    let one = |surface: &FaultSurface| {
        let f = before.surfaces().iter().position(|old| old.name == surface.name)?;
        let own: Vec<_> = moves.ties.iter().filter(|tie| tie.fault == f && tie.is_real).collect();
        let count = own.len().max(1) as f64;
        // Towards the positive side where beds part.
        let positive = before.surfaces()[f].frame_from_voxel.inverse().z_axis.truncate();
        let heave = own.iter().map(|tie| flat(tie.apart()) * tie.apart().dot(positive).signum()).sum::<f64>() / count;
        let left = |tie: &&&crate::ties::Tie| {
            let to = [0, 1].map(|side| tie.at[side] + moves.shift.at(tie.blocks[side], tie.at[side]));
            flat(to[1] - to[0]).powi(2)
        };
        let left_m = (own.iter().map(|tie| left(&tie)).sum::<f64>() / count).sqrt();
        let size = moves.model.size().map(|count| count as f64 - 1.0);
        let mut worst = [0.0f64; 2];
        let mut counted = 0.0;
        for p in drawn(moves, f).vertices {
            let [foot, hanging] = walls(before, &before.surfaces()[f], p);
            let is_inside = (0..3).all(|axis| p[axis] >= 0.0 && p[axis] <= size[axis]);
            let q = moves.moved(hanging, p);
            if foot == hanging || !is_inside || q.z < moves.plane.z_at(q.truncate()) {
                continue;
            }
            let off = surface.side(q).abs();
            worst = [worst[0] + off, worst[1].max(off)];
            counted += 1.0;
        }
        Some(FaultMove {
            fault: surface.name.clone(),
            heave_m: heave,
            left_m,
            misfit_m: [worst[0] / f64::max(counted, 1.0), worst[1]],
        })
    };
    after.surfaces().iter().filter_map(one).collect()
}
