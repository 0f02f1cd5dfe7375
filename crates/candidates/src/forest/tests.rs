//! Trees against closed forms, a greedy oracle with a plain priority queue, and the properties every tree
//! has.

use super::cluster::{Clusters, REGIONAL, cluster};
use super::dual::{Patches, patches};
use super::moments::Moments;
use super::*;
use crate::surfaces::{Extremum, Surface};
use std::collections::{BTreeMap, BTreeSet};

/// Height fields over the whole lattice, each a surface; cells where `keep` is false are holes.
pub(crate) fn sheets(
    size: [usize; 3],
    heights: &[&dyn Fn(f32, f32) -> f32],
    keep: impl Fn(usize, usize, usize) -> bool,
) -> Surfaces {
    let mut all = Surfaces { size, ..Surfaces::default() };
    for (n, height) in heights.iter().enumerate() {
        let first = [all.vertices.len() as u32, all.triangles.len() as u32];
        for x in 0..size[0] {
            for y in 0..size[1] {
                all.vertices.push(Vertex { x: x as u16, y: y as u16, z: height(x as f32, y as f32) });
            }
        }
        for x in 0..size[0] - 1 {
            for y in 0..size[1] - 1 {
                let at = |dx: usize, dy: usize| first[0] + ((x + dx) * size[1] + y + dy) as u32;
                if keep(n, x, y) {
                    let flip = (x * 7 + y * 3 + n) % 5 < 2;
                    all.triangles.extend(if flip {
                        [[at(0, 0), at(1, 0), at(0, 1)], [at(1, 0), at(1, 1), at(0, 1)]]
                    } else {
                        [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]
                    });
                }
            }
        }
        all.surfaces.push(Surface {
            extremum: Extremum::Peak,
            vertices: first[0]..all.vertices.len() as u32,
            triangles: first[1]..all.triangles.len() as u32,
        });
    }
    all
}

fn roof(x: f32, _: f32) -> f32 {
    20.0 + 0.6 * (x - 32.0).abs()
}

fn fold(x: f32, y: f32) -> f32 {
    40.0 + 6.0 * (x / 9.0).sin() * (y / 13.0).cos()
}

fn build(surfaces: Surfaces, settings: &ForestSettings) -> Forest {
    Forest::build(surfaces, settings, &Progress::silent()).unwrap()
}

fn moments_of(surfaces: &Surfaces, range: &Range<u32>) -> Moments {
    surfaces.triangles[range.start as usize..range.end as usize].iter().fold(Moments::EMPTY, |sum, triangle| {
        let corners = triangle.map(|v| {
            let v = surfaces.vertices[v as usize];
            [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
        });
        sum.union(&Moments::of_triangle(corners))
    })
}

/// Properties of every forest.
fn assert_sound(forest: &Forest, before: &Surfaces, min_leaf: u32) {
    let sorted = |triangles: &[[u32; 3]]| {
        let mut all = triangles.to_vec();
        all.sort_unstable();
        all
    };
    assert_eq!(forest.roots.len(), before.surfaces.len());
    for (surface, part) in before.surfaces.iter().enumerate() {
        let range = part.triangles.start as usize..part.triangles.end as usize;
        assert_eq!(sorted(&forest.surfaces.triangles[range.clone()]), sorted(&before.triangles[range]));
        let root = &forest.nodes[forest.roots[surface] as usize];
        assert_eq!((root.parent, &root.triangles, root.surface), (None, &part.triangles, surface as u32));
    }
    for (index, node) in forest.nodes.iter().enumerate() {
        let index = index as u32;
        match node.children {
            Some([a, b]) => {
                assert!(a > index && b > a);
                let [a, b] = [a, b].map(|child| &forest.nodes[child as usize]);
                assert_eq!((a.parent, b.parent), (Some(index), Some(index)));
                let joined = (a.triangles.start, a.triangles.end, b.triangles.end);
                assert_eq!(joined, (node.triangles.start, b.triangles.start, node.triangles.end));
            }
            None => {
                let id = forest.leaf_of_triangle(node.triangles.start);
                assert_eq!(forest.node_of_leaf(id).unwrap(), index);
                assert_eq!(forest.leaf_of_triangle(node.triangles.end - 1), id);
                assert_eq!(forest.leaves_under(index), id..id + 1);
                assert!(node.triangles.len() as u32 >= min_leaf || forest.is_undersized(index, min_leaf));
            }
        }
    }
    assert!(forest.leaves.is_sorted());
}

#[test]
fn a_roof_falls_into_its_two_sides_first() {
    for start_cells in [0, 1, 2] {
        let surfaces = sheets([65, 40, 64], &[&roof], |_, _, _| true);
        let settings = ForestSettings { start_cells, ..ForestSettings::default() };
        let forest = build(surfaces.clone(), &settings);
        assert_sound(&forest, &surfaces, 500);
        let children = forest.nodes[0].children.unwrap();
        for child in children {
            let node = &forest.nodes[child as usize];
            assert_eq!(node.triangles.len(), 32 * 39 * 2);
            assert!(moments_of(&forest.surfaces, &node.triangles).cost() < 1e-6);
        }
    }
}

/// The published method: a priority queue over all pairs of neighbours, cheapest first, on plain maps.
fn greedy(patches: &Patches) -> BTreeSet<Vec<u32>> {
    let mut members: BTreeMap<u32, Vec<u32>> = (0..patches.len() as u32).map(|n| (n, vec![n])).collect();
    let mut moments = patches.moments.clone();
    let mut around: BTreeMap<u32, BTreeSet<u32>> =
        members.keys().map(|&n| (n, patches.neighbours_of(n).iter().copied().collect())).collect();
    let mut parts = BTreeSet::new();
    loop {
        let pairs = around.iter().flat_map(|(&a, near)| near.range(a + 1..).map(move |&b| (a, b)));
        let cost = |&(a, b): &(u32, u32)| moments[a as usize].union(&moments[b as usize]).cost();
        let Some((a, b)) = pairs.min_by(|p, q| cost(p).total_cmp(&cost(q)).then(p.cmp(q))) else { break };
        moments[a as usize] = moments[a as usize].union(&moments[b as usize]);
        let mut of_b = members.remove(&b).unwrap();
        members.get_mut(&a).unwrap().append(&mut of_b);
        for near in around.remove(&b).unwrap() {
            around.get_mut(&near).unwrap().remove(&b);
            if near != a {
                around.get_mut(&near).unwrap().insert(a);
                around.get_mut(&a).unwrap().insert(near);
            }
        }
        let mut part = members[&a].clone();
        part.sort_unstable();
        parts.insert(part);
    }
    parts
}

/// All parts that merges make.
fn parts(count: usize, merges: &[[u32; 2]]) -> BTreeSet<Vec<u32>> {
    let mut members: Vec<Vec<u32>> = (0..count as u32).map(|n| vec![n]).collect();
    merges
        .iter()
        .map(|&[a, b]| {
            let mut of_b = std::mem::take(&mut members[b as usize]);
            members[a as usize].append(&mut of_b);
            members[a as usize].sort_unstable();
            members[a as usize].clone()
        })
        .collect()
}

#[test]
fn chains_make_the_tree_of_the_priority_queue() {
    let rough = |x: f32, y: f32| fold(x, y) + ((x * 12.9 + y * 78.2).sin() * 43758.5).fract();
    for (size, start_cells) in [([14, 13, 64], 0), ([40, 37, 64], 2)] {
        let surfaces = sheets(size, &[&rough], |_, x, y| (x * 5 + y * 11) % 17 != 0);
        let patches = patches(&surfaces.vertices, &surfaces.triangles, start_cells);
        let merges = cluster(&patches, &Progress::silent()).unwrap();
        assert_eq!(parts(patches.len(), &merges), greedy(&patches));
    }
}

#[test]
fn regions_make_the_tree_of_the_whole() {
    let rough = |x: f32, y: f32| fold(x, y) + ((x * 12.9 + y * 78.2).sin() * 43758.5).fract();
    let surfaces = sheets([150, 140, 64], &[&rough], |_, x, y| (x * 5 + y * 11) % 97 != 0);
    let patches = patches(&surfaces.vertices, &surfaces.triangles, 1);
    assert!(patches.len() > REGIONAL);
    let silent = Progress::silent();
    let regional = parts(patches.len(), &cluster(&patches, &silent).unwrap());
    let mut merges = Vec::new();
    Clusters::of_all(&patches).merge_chains(&mut merges, &silent).unwrap();
    assert_eq!(regional, parts(patches.len(), &merges));
}

#[test]
fn trees_from_small_tiles_are_as_flat_as_those_from_single_triangles() {
    let noisy = |x: f32, y: f32| fold(x, y) + 0.3 * ((x * 12.9 + y * 78.2).sin() * 43758.5).fract();
    let surfaces = sheets([160, 150, 64], &[&fold, &noisy, &roof], |_, x, y| (x / 9 + y / 7) % 11 != 0);
    let leaf_cost = |start_cells| {
        let forest = build(surfaces.clone(), &ForestSettings { start_cells, ..ForestSettings::default() });
        assert_sound(&forest, &surfaces, 500);
        let cost = forest
            .leaves
            .iter()
            .map(|&leaf| moments_of(&forest.surfaces, &forest.nodes[leaf as usize].triangles).cost());
        (cost.sum::<f64>(), forest.leaf_count())
    };
    let (paper, paper_leaves) = leaf_cost(0);
    let (ours, our_leaves) = leaf_cost(2);
    eprintln!("cost of leaves: {paper:.0} in {paper_leaves} from triangles, {ours:.0} in {our_leaves} from tiles");
    let per_leaf = |cost: f64, leaves: usize| cost * (leaves as f64).powi(2);
    assert!(per_leaf(ours, our_leaves) < 1.1 * per_leaf(paper, paper_leaves));
}

#[test]
fn threads_do_not_matter() {
    let surfaces = sheets([200, 190, 64], &[&fold, &roof, &fold], |n, x, y| n != 1 || (x + y) % 50 > 2);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| build(surfaces.clone(), &ForestSettings::default()))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_shares_no_edge_is_joined_and_small_surfaces_are_flagged_leaves() {
    // Islands of 2 × 2 cells, 8 triangles each.
    let surfaces = sheets([120, 60, 8], &[&|_, _| 3.0], |_, x, y| x % 4 < 2 && y % 4 < 2);
    let forest = build(surfaces.clone(), &ForestSettings::default());
    assert_sound(&forest, &surfaces, 500);
    assert!(forest.leaf_count() > 2);
    let small = sheets([10, 10, 8], &[&|_, _| 3.0, &|_, _| 5.0], |n, x, _| n == 0 || x == 0);
    let forest = build(small.clone(), &ForestSettings::default());
    assert_sound(&forest, &small, 500);
    assert_eq!((forest.leaf_count(), forest.is_undersized(1, 500)), (2, true));
    let none = build(Surfaces::default(), &ForestSettings::default());
    assert_eq!(none.leaf_count(), 0);
    assert!(none.node_of_leaf(0).is_err() && none.node_of_leaf(1).is_err());
}

#[test]
fn a_leaf_can_be_split_further() {
    let surfaces = sheets([65, 40, 64], &[&fold], |_, _, _| true);
    let forest = build(surfaces, &ForestSettings::default());
    let leaf = 2;
    let part = forest.split(leaf, 60).unwrap();
    let whole = &forest.nodes[forest.node_of_leaf(leaf).unwrap() as usize].triangles;
    let mut triangles = part.triangles.clone();
    triangles.sort_unstable();
    assert_eq!(triangles, whole.clone().collect::<Vec<u32>>());
    let ends: Vec<_> = part.nodes.iter().filter(|node| node.children.is_none()).collect();
    assert!(ends.len() > 2 && ends.iter().all(|node| node.triangles.len() >= 60));
    assert_eq!(part, forest.split(leaf, 60).unwrap());
    assert!(matches!(forest.split(9999, 60), Err(InterpError::NoSuchLeaf { leaf: 9999, .. })));
    assert!(forest.split(leaf, 0).is_err());
    assert_eq!(forest.split(leaf, 1_000_000).unwrap().nodes.len(), 1);
}

#[test]
fn contradictory_arrays_and_cancellation_are_answered() {
    let mut surfaces = sheets([6, 6, 8], &[&|_, _| 3.0], |_, _, _| true);
    surfaces.triangles[3][1] = 36;
    let built = Forest::build(surfaces.clone(), &ForestSettings::default(), &Progress::silent());
    assert!(matches!(built, Err(InterpError::MalformedSurfaces { surface: 0, .. })));
    surfaces.triangles[3][1] = 1;
    let progress = Progress::silent();
    progress.cancel();
    assert!(matches!(Forest::build(surfaces, &ForestSettings::default(), &progress), Err(InterpError::Cancelled(_))));
}

#[test]
fn a_forest_survives_its_tables_and_damaged_tables_are_refused() {
    let surfaces = sheets([65, 40, 64], &[&fold, &roof, &|_, _| 3.0], |n, x, _| n < 2 || x < 3);
    let forest = build(surfaces, &ForestSettings::default());
    let size = forest.surfaces.size;
    assert_eq!(Forest::from_tables(forest.tables(), size).unwrap(), forest);
    let mut tables = forest.tables();
    tables.nodes[1][0] = 7;
    assert!(matches!(Forest::from_tables(tables, size), Err(InterpError::DamagedForest { .. })));
    let mut tables = forest.tables();
    tables.nodes.pop();
    assert!(Forest::from_tables(tables, size).is_err());
    let mut tables = forest.tables();
    tables.triangles[5][0] = u32::MAX;
    assert!(matches!(Forest::from_tables(tables, size), Err(InterpError::MalformedSurfaces { .. })));
}
