//! From selected triangles back to horizons (P-horiz 5.3): sheets on the survey's lattice, one or more for
//! each fault block.
//!
//! A vertex is an extremum of one trace, so a node of a sheet takes its z and nothing is interpolated. Each
//! vertex belongs to the fault block in which it lies. Edges that a fault crosses are cut where the fault was
//! interpreted; where it is merely continued, it only says to which block a vertex belongs. The mesh is
//! traversed breadth first from the picked triangles; in each block, the first vertex to reach a trace takes it. A
//! vertex whose trace is taken is left for a traversal of its own and becomes part of a further sheet of that
//! block. So overlaps stay visible, and without interpreted faults the second side of a reverse fault is
//! preserved. Patches that tracking left beyond a fault, over or under the sheet that belongs there, are
//! dropped, and so are the few that noise left over a sheet, which a climb tolerates. Space: voxels.

use crate::assembly::{Overlap, Selection};
use crate::forest::Forest;
pub use crate::sheet::VoxelSheet;
use crate::surfaces::Vertex;
use glam::Vec3;
use model::FaultNetwork;
use std::collections::{HashSet, VecDeque};
use survey::{Horizon, NodeGrid, Quality, Sheet, SurveyGeometry};

/// The result of [`reassemble`].
#[derive(Debug, Clone, PartialEq)]
pub struct Reassembled {
    /// Sheets, ordered by block. Of several in one block the first is the one that was picked; the others lie
    /// over it.
    pub sheets: Vec<VoxelSheet>,
    /// Where sheets of one block lie over one another.
    pub overlap: Overlap,
    /// Count of vertices dropped because they lie beyond a fault that their surface was tracked across.
    pub left_out: usize,
    /// Vertices dropped because they lie over or under a sheet, no more than noise leaves.
    pub doubled: Overlap,
}

/// No vertex, or none yet.
const NONE: u32 = u32::MAX;

/// Makes sheets of the selected triangles. `seeds` are the triangles from which to start, in order of
/// importance.
///
/// Cost: time and memory proportional to the triangles, and 5 bytes a trace for each sheet.
///
/// ```
/// use interp::assembly::Selection;
/// use interp::reassembly::reassemble;
/// use interp::{Extremum, Forest, ForestSettings, Surface, Surfaces, Vertex};
/// use survey::Progress;
/// use model::FaultNetwork;
///
/// // One cell of four traces with two triangles; only the first is selected.
/// let corner = |x, y, z| Vertex { x, y, z };
/// let surfaces = Surfaces {
///     size: [2, 2, 8],
///     vertices: vec![corner(0, 0, 2.0), corner(0, 1, 2.5), corner(1, 0, 3.0), corner(1, 1, 3.5)],
///     triangles: vec![[0, 2, 1], [1, 2, 3]],
///     surfaces: vec![Surface { extremum: Extremum::Peak, vertices: 0..4, triangles: 0..2 }],
/// };
/// let forest = Forest::build(surfaces, &ForestSettings::default(), &Progress::silent())?;
/// let mut selection = Selection::default();
/// selection.insert(0..1);
/// let found = reassemble(&forest, &selection, &[0], &FaultNetwork::none());
/// assert_eq!(found.sheets.len(), 1);
/// assert_eq!(found.sheets[0].z[..3], [2.0, 2.5, 3.0]);
/// assert!(found.sheets[0].z[3].is_nan());
/// # Ok::<(), interp::InterpError>(())
/// ```
pub fn reassemble(forest: &Forest, selection: &Selection, seeds: &[u32], blocks: &FaultNetwork) -> Reassembled {
    let surfaces = &forest.surfaces;
    let [nx, ny, _] = surfaces.size;
    let mesh = SelectedMesh::of(forest, selection);
    let of = |v: u32| surfaces.vertices[mesh.vertices[v as usize] as usize];
    let place = |vertex: Vertex| Vec3::new(f32::from(vertex.x), f32::from(vertex.y), vertex.z);
    let block: Vec<u16> = (0..mesh.vertices.len() as u32).map(|v| blocks.block_at(place(of(v)))).collect();
    let picked = seeds.iter().filter(|&&t| selection.contains(t)).flat_map(|&t| surfaces.triangles[t as usize]);
    let starts = picked.filter_map(|v| mesh.local(v)).chain(0..mesh.vertices.len() as u32);
    let is_cut = |a: u32, b: u32| block[a as usize] != block[b as usize] && blocks.divides(place(of(a)), place(of(b)));

    let trace_of = |v: u32| usize::from(of(v).x) * ny + usize::from(of(v).y);
    let mut patches = patches(&mesh, &block, starts, is_cut, trace_of, nx * ny);
    let overshoot = overshoots(&patches, &mesh, is_cut, trace_of, nx * ny);
    let mut left_out = 0;
    for (patch, _) in patches.iter_mut().zip(overshoot).filter(|(_, overshoot)| *overshoot) {
        left_out += patch.vertices.len();
        patch.vertices.clear();
    }
    let is_picked =
        |v: &u32| seeds.iter().any(|&t| surfaces.triangles[t as usize].contains(&mesh.vertices[*v as usize]));
    let doubled = doubles(&patches, is_picked, trace_of, nx * ny);
    let mut sheets: Vec<VoxelSheet> = Vec::new();
    let kept = patches.iter().zip(&doubled).filter(|(_, doubled)| !**doubled).map(|(patch, _)| patch);
    for patch in kept.filter(|patch| !patch.vertices.is_empty()) {
        let free = |sheet: &VoxelSheet| {
            sheet.block == patch.block && patch.vertices.iter().all(|&v| sheet.z[trace_of(v)].is_nan())
        };
        let sheet = sheets.iter().position(free).unwrap_or_else(|| {
            sheets.push(VoxelSheet::empty(patch.block, nx * ny));
            sheets.len() - 1
        });
        for &v in &patch.vertices {
            sheets[sheet].z[trace_of(v)] = of(v).z;
            sheets[sheet].quality[trace_of(v)] = Quality::Tracked;
        }
    }
    // A stable sort: of the sheets of one block, the one that was begun first stays first.
    sheets.sort_by_key(|sheet| sheet.block);
    let overlap = overlap_of(&sheets, ny);
    let mut over = Overlap::default();
    for (patch, _) in patches.iter().zip(&doubled).filter(|(_, doubled)| **doubled) {
        for &v in &patch.vertices {
            let others = sheets.iter().filter(|sheet| sheet.block == patch.block);
            let apart = others.map(|sheet| (sheet.z[trace_of(v)] - of(v).z).abs()).fold(f32::NAN, f32::max);
            over.add(apart, [f32::from(of(v).x), f32::from(of(v).y), of(v).z]);
        }
    }
    Reassembled { sheets, overlap, left_out, doubled: over }
}

/// Vertices of one block that are connected, if need be through other blocks; at most one a trace.
struct SheetPatch {
    block: u16,
    vertices: Vec<u32>,
}

/// Traverses the mesh from each start that has not been reached yet, through every edge that is not cut; a traversal
/// makes a patch in each block that it reaches.
fn patches(
    mesh: &SelectedMesh,
    block: &[u16],
    starts: impl Iterator<Item = u32>,
    is_cut: impl Fn(u32, u32) -> bool,
    trace_of: impl Fn(u32) -> usize,
    traces: usize,
) -> Vec<SheetPatch> {
    let mut patches: Vec<SheetPatch> = Vec::new();
    let mut placed = vec![false; block.len()];
    // The traversal that took each trace last, and the block in which it did.
    let mut taken = vec![(NONE, 0); traces];
    let mut queue = VecDeque::new();
    let mut walk = 0;
    for start in starts {
        if placed[start as usize] {
            continue;
        }
        placed[start as usize] = true;
        taken[trace_of(start)] = (walk, block[start as usize]);
        queue.push_back(start);
        let first = patches.len();
        while let Some(v) = queue.pop_front() {
            let own = block[v as usize];
            match patches[first..].iter_mut().find(|patch| patch.block == own) {
                Some(patch) => patch.vertices.push(v),
                None => patches.push(SheetPatch { block: own, vertices: vec![v] }),
            }
            for &next in mesh.neighbours(v) {
                let (trace, here) = (trace_of(next), (walk, block[next as usize]));
                if !placed[next as usize] && taken[trace] != here && !is_cut(v, next) {
                    placed[next as usize] = true;
                    taken[trace] = here;
                    queue.push_back(next);
                }
            }
        }
        walk += 1;
    }
    patches
}

/// Share of a patch that lies over or under a larger one of its block, from which on the patch can be the
/// overshoot of another block.
const OVERSHOT: f64 = 0.3;

/// A patch that reaches no farther than this from the fault (traces), in a block with a larger patch, can
/// also be the overshoot of another block.
const FRINGE: u32 = 12;

/// Which patches are overshoots, i.e. were left by tracking beyond a fault. Such a patch continues a larger
/// patch of another block, across a fault, and its own block has a larger patch: either the two lie over one
/// another, or the overshoot is a mere fringe along the fault.
fn overshoots(
    patches: &[SheetPatch],
    mesh: &SelectedMesh,
    is_cut: impl Fn(u32, u32) -> bool,
    trace_of: impl Fn(u32) -> usize,
    traces: usize,
) -> Vec<bool> {
    let mut patch_of = vec![NONE; mesh.vertices.len()];
    for (p, patch) in patches.iter().enumerate() {
        patch.vertices.iter().for_each(|&v| patch_of[v as usize] = p as u32);
    }
    left_out(patches, trace_of, traces, |p, under, is_largest| {
        let patch = &patches[p];
        // Vertices at the fault: next to a larger patch beyond it.
        let at_fault = |v: &u32| {
            mesh.neighbours(*v).iter().any(|&m| {
                let across = &patches[patch_of[m as usize] as usize];
                across.vertices.len() > patch.vertices.len() && is_cut(*v, m)
            })
        };
        let fault: Vec<u32> = patch.vertices.iter().copied().filter(at_fault).collect();
        let over = under as f64 >= OVERSHOT * patch.vertices.len() as f64;
        !fault.is_empty() && !is_largest && (over || is_fringe(mesh, &patch_of, p as u32, fault))
    })
}

/// Decides on the patches of each block, the largest first: `is_left_out` gets the patch, how many of its vertices lie
/// over or under those that were kept, and whether it is the largest.
fn left_out(
    patches: &[SheetPatch],
    trace_of: impl Fn(u32) -> usize,
    traces: usize,
    is_left_out: impl Fn(usize, usize, bool) -> bool,
) -> Vec<bool> {
    // Traces of what was kept in the block; blocks are done one after the other.
    let mut covered = vec![false; traces];
    let mut order: Vec<usize> = (0..patches.len()).collect();
    order.sort_by_key(|&p| (patches[p].block, std::cmp::Reverse(patches[p].vertices.len()), p));
    let mut found = vec![false; patches.len()];
    for of_block in order.chunk_by(|&a, &b| patches[a].block == patches[b].block) {
        covered.fill(false);
        for &p in of_block {
            let vertices = &patches[p].vertices;
            let under = vertices.iter().filter(|&&v| covered[trace_of(v)]).count();
            found[p] = is_left_out(p, under, p == of_block[0]);
            if !found[p] {
                vertices.iter().for_each(|&v| covered[trace_of(v)] = true);
            }
        }
    }
    found
}

/// Whether a patch reaches at most [`FRINGE`] edges away from its vertices at a fault.
fn is_fringe(mesh: &SelectedMesh, patch_of: &[u32], patch: u32, fault: Vec<u32>) -> bool {
    let mut seen: HashSet<u32> = fault.iter().copied().collect();
    let mut rim = fault;
    for _ in 0..=FRINGE {
        let beside = rim.iter().flat_map(|&v| mesh.neighbours(v)).copied();
        rim = beside.filter(|&m| patch_of[m as usize] == patch && seen.insert(m)).collect();
        if rim.is_empty() {
            return true;
        }
    }
    false
}

/// Share of the vertices that noise leaves over others at most: as much as a climb tolerates.
const DOUBLED: f64 = 0.02;

/// Share of a patch that lies over or under a larger one of its block, from which on it is no part of the horizon.
const OVER: f64 = 0.5;

/// Which patches are left where a front passed above or below an error and met itself again: they have no pick and lie
/// mostly over or under a larger patch of their block. None, if they are more than noise leaves: then another reflection
/// or the other side of a fault is among them.
fn doubles(
    patches: &[SheetPatch],
    is_picked: impl Fn(&u32) -> bool,
    trace_of: impl Fn(u32) -> usize,
    traces: usize,
) -> Vec<bool> {
    let found = left_out(patches, trace_of, traces, |p, under, _| {
        let vertices = &patches[p].vertices;
        under > 0 && under as f64 >= OVER * vertices.len() as f64 && !vertices.iter().any(&is_picked)
    });
    let all: usize = patches.iter().map(|patch| patch.vertices.len()).sum();
    let doubled: usize = patches.iter().zip(&found).filter(|(_, found)| **found).map(|(p, _)| p.vertices.len()).sum();
    if doubled as f64 > DOUBLED * all as f64 { vec![false; patches.len()] } else { found }
}

/// Where further sheets of a block lie over its first sheets.
fn overlap_of(sheets: &[VoxelSheet], ny: usize) -> Overlap {
    let mut overlap = Overlap::default();
    for of_block in sheets.chunk_by(|a, b| a.block == b.block) {
        for (n, sheet) in of_block.iter().enumerate().skip(1) {
            for (trace, &z) in sheet.z.iter().enumerate().filter(|(_, z)| z.is_finite()) {
                let others = of_block[..n].iter().map(|other| (other.z[trace] - z).abs());
                let apart = others.filter(|apart| apart.is_finite()).fold(f32::NAN, f32::max);
                if apart.is_finite() {
                    overlap.add(apart, [(trace / ny) as f32, (trace % ny) as f32, z]);
                }
            }
        }
    }
    overlap
}

/// Selected vertices and their neighbours, numbered from 0.
struct SelectedMesh {
    /// Vertices of the forest, ascending.
    vertices: Vec<u32>,
    starts: Vec<u32>,
    next: Vec<u32>,
}

impl SelectedMesh {
    fn of(forest: &Forest, selection: &Selection) -> Self {
        let triangles = || selection.iter().map(|t| forest.surfaces.triangles[t as usize]);
        let mut vertices: Vec<u32> = triangles().flatten().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut mesh = Self { vertices, starts: Vec::new(), next: Vec::new() };
        let local = |v: u32| mesh.local(v).expect("the mesh has all corners of its triangles");
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(6 * selection.len());
        for [a, b, c] in triangles().map(|corners| corners.map(local)) {
            edges.extend([[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]]);
        }
        edges.sort_unstable();
        edges.dedup();
        mesh.starts = vec![0; mesh.vertices.len() + 1];
        for &[from, to] in &edges {
            mesh.starts[from as usize + 1] += 1;
            mesh.next.push(to);
        }
        for n in 1..mesh.starts.len() {
            mesh.starts[n] += mesh.starts[n - 1];
        }
        mesh
    }

    fn local(&self, vertex: u32) -> Option<u32> {
        self.vertices.binary_search(&vertex).ok().map(|n| n as u32)
    }

    fn neighbours(&self, v: u32) -> &[u32] {
        &self.next[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }
}

/// Converts sheets to a horizon in the survey's vertical unit.
///
/// The sheets of the horizon name no block. A tracked sheet reaches up to a fault from both sides and a
/// little beyond, and the structural model sorts out nodes next to a fault only in sheets without a block.
pub fn to_horizon(name: &str, sheets: &[VoxelSheet], geometry: &SurveyGeometry) -> Horizon {
    let grid = NodeGrid::of_survey(geometry);
    let sheet = |sheet: &VoxelSheet| Sheet {
        block: None,
        grid,
        depth: sheet
            .z
            .iter()
            .map(|&z| if z.is_nan() { z } else { geometry.vertical.value_at(f64::from(z)) as f32 })
            .collect(),
        quality: sheet.quality.clone(),
    };
    Horizon::new(name, sheets.iter().map(sheet).collect())
}

/// The nodes of a horizon on the survey's lattice, in samples, sorted into fault blocks; the inverse of
/// [`to_horizon`]. Sheets on other grids are sampled at the traces. The nodes of one sheet in one block stay
/// together: they join another sheet only where that has no node at all.
pub fn from_horizon(horizon: &Horizon, geometry: &SurveyGeometry, blocks: &FaultNetwork) -> Vec<VoxelSheet> {
    let [nx, ny, _] = geometry.size();
    let mut sheets: Vec<VoxelSheet> = Vec::new();
    for sheet in &horizon.sheets {
        for part in parts_of(sheet, geometry, blocks) {
            let free = |other: &&mut VoxelSheet| {
                other.block == part.block && other.z.iter().zip(&part.z).all(|(a, b)| a.is_nan() || b.is_nan())
            };
            let Some(other) = sheets.iter_mut().find(free) else {
                sheets.push(part);
                continue;
            };
            for trace in (0..nx * ny).filter(|&trace| part.z[trace].is_finite()) {
                other.z[trace] = part.z[trace];
                other.quality[trace] = part.quality[trace];
            }
        }
    }
    sheets.sort_by_key(|sheet| sheet.block);
    sheets
}

/// The parts of a sheet on the survey's lattice, one for each fault block that it reaches.
fn parts_of(sheet: &Sheet, geometry: &SurveyGeometry, blocks: &FaultNetwork) -> Vec<VoxelSheet> {
    let [nx, ny, _] = geometry.size();
    let survey = NodeGrid::of_survey(geometry);
    let mut parts: Vec<VoxelSheet> = Vec::new();
    for trace in 0..nx * ny {
        let voxel = glam::DVec2::new((trace / ny) as f64, (trace % ny) as f64);
        let node = sheet.grid.node_at(survey.world_at(voxel));
        let depth = sheet.depth_at_node(node);
        if !depth.is_finite() {
            continue;
        }
        let z = geometry.vertical.index_of(f64::from(depth)) as f32;
        let [u, v] = [node.x.round() as usize, node.y.round() as usize];
        let nearest = u.min(sheet.grid.count[0] - 1) * sheet.grid.count[1] + v.min(sheet.grid.count[1] - 1);
        let block = blocks.block_at(voxel.as_vec2().extend(z));
        let at = parts.iter().position(|part| part.block == block).unwrap_or_else(|| {
            parts.push(VoxelSheet::empty(block, nx * ny));
            parts.len() - 1
        });
        parts[at].z[trace] = z;
        parts[at].quality[trace] = sheet.quality[nearest];
    }
    parts
}
