//! Closed-form forests: surfaces over rectangles of traces, their trees halved along the inlines.

use super::*;
use crate::forest::Node;
use crate::holes::find_holes;
use crate::reassembly::{VoxelSheet, from_horizon, reassemble, to_horizon};
use crate::surfaces::{Extremum, Surface, Surfaces, Vertex};
use glam::Vec3;
use model::FaultNetwork;
use survey::{Progress, Quality, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;

/// One surface: z over traces; a cell has two triangles where its four corners have a vertex.
type Height<'a> = &'a dyn Fn(usize, usize) -> Option<f32>;

/// A forest of surfaces that may hold several vertices a trace: each surface is a list of branches, joined
/// along the traces at which their heights agree.
fn forest_of(size: [usize; 3], surfaces: &[&[Height]], leaf_triangles: u32) -> Forest {
    let mut all = Surfaces { size, ..Surfaces::default() };
    for branches in surfaces {
        add_surface(&mut all, branches);
    }
    let mut forest = Forest { surfaces: all, ..Forest::default() };
    for n in 0..forest.surfaces.surfaces.len() {
        let range = forest.surfaces.surfaces[n].triangles.clone();
        let root = forest.nodes.len() as u32;
        forest.roots.push(root);
        grow(&mut forest, n as u32, None, range, leaf_triangles);
    }
    forest
}

fn add_surface(all: &mut Surfaces, branches: &[Height]) {
    let [nx, ny, _] = all.size;
    let (first, start) = (all.vertices.len() as u32, all.triangles.len() as u32);
    let mut found: Vec<(u16, u16, f32)> = Vec::new();
    for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
        found.extend(branches.iter().filter_map(|height| height(x, y)).map(|z| (x as u16, y as u16, z)));
    }
    found.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    found.dedup();
    let index = |x: usize, y: usize, z: f32| {
        let at = found
            .partition_point(|v| (v.0, v.1) < (x as u16, y as u16) || ((v.0, v.1) == (x as u16, y as u16) && v.2 < z));
        first + at as u32
    };
    for x in 0..nx - 1 {
        for branch in branches {
            for y in 0..ny - 1 {
                let corners =
                    [(x, y), (x, y + 1), (x + 1, y), (x + 1, y + 1)].map(|(x, y)| Some(index(x, y, branch(x, y)?)));
                if let [Some(a), Some(b), Some(c), Some(d)] = corners {
                    all.triangles.extend([[a, c, b], [b, c, d]]);
                }
            }
        }
    }
    all.vertices.extend(found.iter().map(|&(x, y, z)| Vertex { x, y, z }));
    all.surfaces.push(Surface {
        extremum: Extremum::Peak,
        vertices: first..all.vertices.len() as u32,
        triangles: start..all.triangles.len() as u32,
    });
}

fn grow(forest: &mut Forest, surface: u32, parent: Option<u32>, triangles: std::ops::Range<u32>, leaf: u32) -> u32 {
    let node = forest.nodes.len() as u32;
    forest.nodes.push(Node { parent, children: None, surface, triangles: triangles.clone() });
    if triangles.len() as u32 >= 2 * leaf {
        let middle = triangles.start + triangles.len() as u32 / 2;
        let first = grow(forest, surface, Some(node), triangles.start..middle, leaf);
        let second = grow(forest, surface, Some(node), middle..triangles.end, leaf);
        forest.nodes[node as usize].children = Some([first, second]);
    } else {
        forest.leaves.push(node);
    }
    node
}

const SIZE: [usize; 3] = [33, 17, 64];

/// A plane at 20 and one at 40, each of 8 leaves of 128 triangles.
fn two_planes() -> Forest {
    forest_of(SIZE, &[&[&|_, _| Some(20.25)], &[&|x, _| Some(40.0 + 0.25 * x as f32)]], 128)
}

#[test]
fn a_pick_finds_the_closest_leaf_and_says_what_is_nearest_when_none_is_near() {
    let forest = two_planes();
    assert_eq!(forest.leaves.len(), 16);
    let hit = leaf_at(&forest, Vec3::new(2.0, 8.0, 21.0), 10.0).unwrap();
    assert_eq!((hit.leaf, hit.distance), (1, 0.75));
    let hit = leaf_at(&forest, Vec3::new(30.0, 3.0, 47.0), 10.0).unwrap();
    assert_eq!(hit.leaf, 16);
    // The distance to a plane of slope 1/4.
    assert!((hit.distance - 0.5 / (1.0f32 + 0.0625).sqrt()).abs() < 1e-4, "{}", hit.distance);
    let far = leaf_at(&forest, Vec3::new(2.0, 8.0, 0.0), 10.0).unwrap_err();
    assert!(matches!(far, AssemblyError::NothingNear { leaf: 1, distance, .. } if (distance - 20.25).abs() < 1e-5));
    assert!(matches!(leaf_at(&forest, Vec3::new(2.0, 17.0, 0.0), 10.0), Err(AssemblyError::Outside { .. })));
    assert_eq!(leaf_at(&forest_of(SIZE, &[], 1), Vec3::ONE, 10.0), Err(AssemblyError::Empty));
}

#[test]
fn climbing_widens_to_the_root_and_no_further() {
    let forest = two_planes();
    let triangles = |up| forest.nodes[node_above(&forest, 3, up).unwrap() as usize].triangles.len();
    assert_eq!([0, 1, 2, 3].map(triangles), [128, 256, 512, 1024]);
    assert_eq!(node_above(&forest, 3, 4), Err(AssemblyError::BeyondRoot { leaf: 3, levels: 3, up: 4 }));
    for leaf in [0, 17, u32::MAX] {
        assert_eq!(node_above(&forest, leaf, 0), Err(AssemblyError::NoLeaf { leaf, leaves: forest.leaves.len() }));
    }
}

#[test]
fn picks_add_and_take_away_in_order() {
    let forest = two_planes();
    let node = |leaf, up| node_above(&forest, leaf, up).unwrap();
    let selection = assemble(
        &forest,
        [(node(1, 3), Operation::Add), (node(3, 1), Operation::Remove), (node(9, 0), Operation::Add)],
    );
    assert_eq!(selection.ranges(), [0..256, 512..1152]);
    // The same picks in another order: what is added last stays.
    let selection = assemble(&forest, [(node(3, 1), Operation::Remove), (node(1, 3), Operation::Add)]);
    assert_eq!(selection.len(), 1024);
}

/// A surface that folds back under itself: the left half belongs to z = 20, the right half runs back below
/// the left.
#[test]
fn the_highest_valid_node_is_the_last_one_without_overlap() {
    let ramp = |x: usize, _: usize| Some(20.0 + 0.1 * x as f32);
    let back = |x: usize, _: usize| (x >= 16).then(|| 23.2 + 0.5 * (32 - x) as f32);
    let forest = forest_of(SIZE, &[&[&ramp, &back]], 128);
    // Both branches meet at x = 32; ordered by x, the tree's right half holds both of them.
    let none = FaultNetwork::none();
    let settings = ClimbSettings::default();
    let climbed = highest_valid(&forest, 1, &Selection::default(), &none, &settings);
    let stopped = climbed.stopped_by.unwrap();
    assert!(stopped.traces > 50 && stopped.apart > 5.0, "{stopped:?}");
    let node = &forest.nodes[climbed.node as usize];
    assert_eq!(node_above(&forest, 1, climbed.up), Ok(climbed.node));
    assert!(node.parent.is_some() && node.triangles.start == 0);

    // Two sheets that do not overlap climb to the root, unless the horizon has something over the same traces
    // already.
    let forest = two_planes();
    let climbed = highest_valid(&forest, 5, &Selection::default(), &none, &settings);
    assert_eq!((climbed.up, climbed.stopped_by), (3, None));
    let mut selected = Selection::default();
    selected.insert(0..128);
    let climbed = highest_valid(&forest, 16, &selected, &none, &settings);
    assert_eq!(climbed.up, 2, "the half of the lower plane that lies under no part of the upper one");
    assert_eq!(climbed.stopped_by.unwrap().apart, 20.75);
    // What is selected of the same surface does not overlap with it.
    assert_eq!(highest_valid(&forest, 8, &selected, &none, &settings).up, 3);
}

/// Without the fault, the sides of a reverse fault overlap in a strip; a reflector on top of another does
/// everywhere.
#[test]
fn a_climb_tolerates_a_strip_over_what_is_chosen_and_not_more() {
    let left = |x: usize, _: usize| (x <= 16).then_some(20.0);
    let right = |from: usize| move |x: usize, _: usize| (x >= from).then_some(30.0);
    let none = FaultNetwork::none();
    let climbed = |from: usize| {
        let right = right(from);
        let forest = forest_of(SIZE, &[&[&left], &[&right]], 128);
        let mut chosen = Selection::default();
        chosen.insert(forest.surfaces.surfaces[0].triangles.clone());
        let leaf = leaf_at(&forest, Vec3::new(30.0, 8.0, 30.0), 1.0).unwrap().leaf;
        highest_valid(&forest, leaf, &chosen, &none, &ClimbSettings::default())
    };
    // One trace of 17 is 6 %, five of 21 are 24 %.
    assert!(climbed(16).stopped_by.is_none());
    let overlap = climbed(12).stopped_by.unwrap();
    assert!(overlap.beside > 0 && overlap.beside == overlap.traces, "{overlap:?}");
}

fn network() -> (SurveyGeometry, FaultNetwork) {
    let geometry = SurveyGeometry::regular(SIZE, 10.0, 10.0, VerticalUnit::Metres);
    let model = ClosedForm::flat(&geometry, &[20.0]).with_fault(45.0, 6.0);
    let network = FaultNetwork::build(&geometry, &model.faults, &Progress::silent()).unwrap();
    (geometry, network)
}

/// Two sheets that overlap across a reverse fault: one block over the other once the fault is known.
#[test]
fn a_fault_turns_an_overlap_into_two_sheets_of_their_own_blocks() {
    let (geometry, faulted) = network();
    // The fault is x = 16 + (z − 31.5); the hanging wall (x beyond it) at 26 reaches back to x = 11, the
    // footwall at 36 on to x = 20.
    let footwall = |x: usize, _: usize| (x <= 20).then_some(36.0);
    let hanging = |x: usize, _: usize| (x >= 11).then_some(26.0);
    let forest = forest_of(SIZE, &[&[&footwall], &[&hanging]], 128);
    let mut all = Selection::default();
    all.insert(0..forest.surfaces.triangles.len() as u32);

    let open = reassemble(&forest, &all, &[0], &FaultNetwork::none());
    assert_eq!(open.sheets.len(), 2);
    assert_eq!((open.overlap.traces, open.overlap.apart), (10 * 17, 10.0));
    assert_eq!(open.sheets[0].z[0], 36.0, "the seed's side comes first");
    let other = reassemble(&forest, &all, &[forest.surfaces.triangles.len() as u32 - 1], &FaultNetwork::none());
    assert_eq!(other.sheets[0].z[32 * 17], 26.0);

    let closed = reassemble(&forest, &all, &[0], &faulted);
    assert_eq!(closed.overlap.traces, 0);
    assert_eq!(closed.sheets.iter().map(|sheet| sheet.block).collect::<Vec<_>>(), [0, 1]);
    assert_eq!(closed.sheets.iter().map(|sheet| sheet.nodes()).sum::<usize>(), (21 + 22) * 17);
    // A climb that stopped at the overlap no longer does.
    let mut selected = Selection::default();
    selected.insert(forest.surfaces.surfaces[0].triangles.clone());
    let leaf = leaf_at(&forest, Vec3::new(14.0, 8.0, 26.0), 1.0).unwrap().leaf;
    let settings = ClimbSettings::default();
    assert!(highest_valid(&forest, leaf, &selected, &FaultNetwork::none(), &settings).stopped_by.is_some());
    assert!(highest_valid(&forest, leaf, &selected, &faulted, &settings).stopped_by.is_none());

    // To the vertical unit and back.
    let horizon = to_horizon("H", &closed.sheets, &geometry);
    assert!(horizon.sheets.iter().any(|sheet| sheet.depth[0] == 360.0 && sheet.depth[32 * 17].is_nan()));
    let back = from_horizon(&horizon, &geometry, &faulted);
    assert_eq!(back.len(), 2);
    for (back, sheet) in back.iter().zip(&closed.sheets) {
        assert!(back.block == sheet.block && back.quality == sheet.quality);
        assert!(back.z.iter().zip(&sheet.z).all(|(a, b)| a == b || a.is_nan() && b.is_nan()));
    }
}

/// A plane up to inline `left` and a deeper one from inline `right`, all of both, and a vertical fault at
/// inline 16.
fn beside_a_fault(left: usize, right: usize) -> (Forest, Selection, FaultNetwork) {
    let upper: Height = &|x, _| (x <= left).then_some(12.0);
    let lower: Height = &|x, _| (x >= right).then_some(20.0);
    let forest = forest_of(SIZE, &[&[upper], &[lower]], 64);
    let mut all = Selection::default();
    all.insert(0..forest.surfaces.triangles.len() as u32);
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[16.0]).with_fault(89.9, 2.0);
    let faulted = FaultNetwork::build(&geometry, &closed.faults, &Progress::silent());
    (forest, all, faulted.unwrap())
}

/// Both sides were tracked six traces past a vertical fault: once it is drawn, each block keeps its own
/// sheet.
#[test]
fn what_was_tracked_past_a_fault_is_left_out() {
    let (forest, all, faulted) = beside_a_fault(22, 10);
    let open = reassemble(&forest, &all, &[], &FaultNetwork::none());
    assert!(open.overlap.traces > 0 && open.left_out == 0);
    let found = reassemble(&forest, &all, &[], &faulted);
    assert_eq!((found.sheets.len(), found.overlap.traces), (2, 0));
    assert!(found.left_out > 100, "{}", found.left_out);
    for sheet in &found.sheets {
        let heights: std::collections::BTreeSet<u32> =
            sheet.z.iter().filter(|z| z.is_finite()).map(|z| *z as u32).collect();
        assert_eq!(heights.len(), 1, "{heights:?}");
    }
}

/// The left side's own reflection ends ten traces before the fault; what the right side's tracking left along
/// the fault is no sheet of the left.
#[test]
fn a_fringe_along_a_fault_is_left_out() {
    let (forest, all, faulted) = beside_a_fault(6, 12);
    let found = reassemble(&forest, &all, &[], &faulted);
    assert!(found.left_out > 0 && found.sheets.len() == 2, "{} left out", found.left_out);
    let before = |sheet: &VoxelSheet| sheet.z[..12 * SIZE[1]].iter().all(|z| z.is_nan() || *z < 20.0);
    assert!(found.sheets.iter().all(before));
}

/// A fault drawn far below a reflection runs through it only as a continuation: it cuts nothing there, and takes nothing
/// away. Where the fault was drawn, it does.
#[test]
fn a_fault_that_was_drawn_elsewhere_cuts_nothing() {
    // The fronts met over a strip: the sheet that was picked comes first and keeps its traces.
    let upper: Height = &|_, _| Some(8.0);
    let strip: Height = &|x, y| (x > 12 && y < 4).then_some(13.0);
    let forest = forest_of(SIZE, &[&[upper], &[strip]], 64);
    let mut all = Selection::default();
    all.insert(0..forest.surfaces.triangles.len() as u32);
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    let voxel = |x: f64, y: f64, z: f64| geometry.world_from_voxel(glam::DVec3::new(x, y, z));
    let drawn = |depth: [f64; 2]| {
        let [top, base] = depth;
        let vertices =
            vec![voxel(16.0, 0.0, top), voxel(16.0, 16.0, top), voxel(17.0, 0.0, base), voxel(17.0, 16.0, base)];
        let mesh = survey::TriangleMesh { vertices, triangles: vec![[0, 1, 2], [1, 3, 2]] };
        FaultNetwork::build(&geometry, &[survey::Fault::new("F", mesh)], &Progress::silent()).unwrap()
    };
    let (below, through) = (drawn([45.0, 60.0]), drawn([0.0, 20.0]));
    assert_eq!(below.block_count(), 2, "the continuation divides the volume");
    let ends = [Vec3::new(11.0, 8.0, 8.0), Vec3::new(18.0, 8.0, 8.0)];
    assert_ne!(below.block_at(ends[0]), below.block_at(ends[1]));
    let open = reassemble(&forest, &all, &[0], &FaultNetwork::none());
    let found = reassemble(&forest, &all, &[0], &below);
    assert_eq!((found.left_out, found.overlap.traces), (0, open.overlap.traces));
    let picked = |sheets: &[VoxelSheet]| -> usize {
        let firsts = sheets.chunk_by(|a, b| a.block == b.block).map(|of_block| &of_block[0]);
        firsts.map(|sheet| sheet.z.iter().filter(|z| **z == 8.0).count()).sum()
    };
    assert_eq!(picked(&found.sheets), SIZE[0] * SIZE[1], "every trace of the picked sheet comes first in its block");
    let beside = [16.0, 17.0].map(|x| Vec3::new(x, 8.0, 8.0));
    assert!(through.divides(beside[0], beside[1]) && !below.divides(ends[0], ends[1]));
}

/// Two sheets that lie over one another in a strip stay what they are, wherever no fault tells them apart.
#[test]
fn sheets_that_overlap_come_back_whole() {
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    let [nx, ny] = [SIZE[0], SIZE[1]];
    let sheet = |from: usize, to: usize, z: f32| {
        let mut sheet = VoxelSheet::empty(0, nx * ny);
        for trace in from * ny..to * ny {
            (sheet.z[trace], sheet.quality[trace]) = (z, Quality::Tracked);
        }
        sheet
    };
    let sheets = [sheet(0, 18, 12.0), sheet(14, nx, 20.0)];
    let back = from_horizon(&to_horizon("H", &sheets, &geometry), &geometry, &FaultNetwork::none());
    assert_eq!(back.iter().map(VoxelSheet::nodes).collect::<Vec<_>>(), [18 * ny, (nx - 14) * ny]);
}

/// A few nodes over a sheet, as noise leaves them, are left out and counted; picked ones stay, and so do many.
#[test]
fn what_noise_leaves_over_a_sheet_is_left_out() {
    let none = FaultNetwork::none();
    let found = |last: usize, seeds: &dyn Fn(&Forest) -> Vec<u32>| {
        let few = move |x: usize, y: usize| (x < last && y < 3).then_some(26.0);
        let forest = forest_of(SIZE, &[&[&|_, _| Some(20.0)], &[&few]], 64);
        let mut all = Selection::default();
        all.insert(0..forest.surfaces.triangles.len() as u32);
        let seeds = seeds(&forest);
        reassemble(&forest, &all, &seeds, &none)
    };
    let nodes = SIZE[0] * SIZE[1];
    let few = found(3, &|_| vec![0]);
    assert_eq!((few.sheets.len(), few.sheets[0].nodes(), few.overlap.traces), (1, nodes, 0));
    assert_eq!((few.doubled.traces, few.doubled.apart, few.doubled.at_voxel[2]), (9, 6.0, 26.0));
    let picked = found(3, &|forest| forest.surfaces.surfaces.iter().map(|surface| surface.triangles.start).collect());
    assert_eq!((picked.sheets.len(), picked.overlap.traces, picked.doubled.traces), (2, 9, 0));
    let many = found(12, &|_| vec![0]);
    assert_eq!((many.sheets.len(), many.overlap.traces, many.doubled.traces), (2, 36, 0));
}

#[test]
fn every_vertex_lands_on_exactly_one_sheet() {
    let forest = forest_of(SIZE, &[&[&|x, _| Some(20.0 + 0.1 * x as f32), &|x, y| (x + y > 20).then_some(30.0)]], 64);
    let mut all = Selection::default();
    all.insert(0..forest.surfaces.triangles.len() as u32);
    let found = reassemble(&forest, &all, &[], &FaultNetwork::none());
    let used: std::collections::BTreeSet<u32> = forest.surfaces.triangles.iter().flatten().copied().collect();
    assert_eq!(found.sheets.iter().map(|sheet| sheet.nodes()).sum::<usize>(), used.len());
    assert!(find_holes(&found.sheets, [SIZE[0], SIZE[1]]).is_empty());
}

#[test]
fn a_fingerprint_knows_the_same_the_similar_and_the_different() {
    let forest = two_planes();
    let print = |forest: &Forest, leaf, up| Fingerprint::of(forest, node_above(forest, leaf, up).unwrap());
    let plane = print(&forest, 1, 3);
    assert_eq!((plane.triangles, plane.low, plane.high, plane.mean_z), (1024, [0, 0], [32, 16], 20.25));
    assert_eq!(plane.compare(&print(&two_planes(), 2, 3)), NodeFit::Same);
    let shifted = forest_of(SIZE, &[&[&|_, _| Some(20.5)]], 128);
    assert_eq!(plane.compare(&print(&shifted, 1, 3)), NodeFit::Similar);
    assert_eq!(plane.compare(&print(&forest, 1, 2)), NodeFit::Different);
    assert_eq!(plane.compare(&print(&forest, 9, 3)), NodeFit::Different);
}

#[test]
fn contradictions_between_horizons_are_found() {
    let forest = two_planes();
    let none = FaultNetwork::none();
    let size = [SIZE[0], SIZE[1]];
    let selection = |range| {
        let mut selection = Selection::default();
        selection.insert(range);
        selection
    };
    let (upper, lower) = (selection(0..1024), selection(1024..2048));
    let both = selection(512..1536);
    let sheets = |selection: &Selection| reassemble(&forest, selection, &[], &none).sheets;
    let (upper_sheets, lower_sheets) = (sheets(&upper), sheets(&lower));
    let named = |name, selection, sheets| NamedSheets { name, sheets, selection: Some(selection) };
    let find =
        |horizons: &[NamedSheets]| conflicts(Some(&forest), size, horizons, |_, _| false, &ConflictSettings::default());
    assert!(find(&[named("u", &upper, &upper_sheets), named("l", &lower, &lower_sheets)]).is_empty());
    let swapped = find(&[named("l", &lower, &lower_sheets), named("u", &upper, &upper_sheets)]);
    assert_eq!(swapped, [Conflict::Swapped { horizons: ["l".into(), "u".into()], traces: 33 * 17 }]);
    let both_sheets = sheets(&both);
    let shared = find(&[named("u", &upper, &upper_sheets), named("b", &both, &both_sheets)]);
    assert!(
        matches!(&shared[0], Conflict::SharedLeaves { leaves, triangles: 512, .. } if *leaves == [5, 6, 7, 8]),
        "{shared:?}"
    );
    // A plane from 30 down to 62 crosses the one that falls from 40 to 48.
    let steep = forest_of(SIZE, &[&[&|x, _| Some(30.0 + x as f32)]], 128);
    let steep_sheets = reassemble(&steep, &upper, &[], &none).sheets;
    let steep = NamedSheets { name: "s", sheets: &steep_sheets, selection: None };
    let crossing = find(&[steep.clone(), named("l", &lower, &lower_sheets)]);
    let [Conflict::Crossing { horizons, above, below, worst, at }] = &crossing[..] else { panic!("{crossing:?}") };
    assert_eq!((horizons, *worst, at[0]), (&["l".to_owned(), "s".to_owned()], 10.0, 0));
    assert_eq!((*above, *below), (18 * 17, 13 * 17));
    assert!(
        conflicts(None, size, &[steep, named("l", &lower, &lower_sheets)], |_, _| true, &ConflictSettings::default())
            .is_empty()
    );
}
