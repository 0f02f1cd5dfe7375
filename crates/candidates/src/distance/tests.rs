//! Distances against closed forms and a brute-force search with another method.

use super::*;
use crate::forest::tests::sheets;
use crate::forest::{Forest, ForestSettings};
use crate::surfaces::{Extremum, Surface, Surfaces, Vertex};
use system::wide::Wide;

fn forest(surfaces: Surfaces, min_leaf_triangles: u32) -> Forest {
    let settings = ForestSettings { min_leaf_triangles, ..ForestSettings::default() };
    Forest::build(surfaces, &settings, &Progress::silent()).unwrap()
}

fn whole(forest: &Forest, settings: &DistanceSettings) -> CandidateColumns {
    let [nx, ny, _] = forest.surfaces.size;
    LeafDistances::new(forest, settings).unwrap().columns(0..nx, 0..ny, &Progress::silent()).unwrap()
}

/// Squared distance of a point to a triangle: the foot on the plane when it is inside by signed areas, else
/// the nearest edge.
fn distance_sq(p: [f64; 3], triangle: [[f64; 3]; 3]) -> f64 {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let [a, b, c] = triangle;
    let normal = cross(minus(b, a), minus(c, a));
    let off = dot(minus(p, a), normal) / dot(normal, normal);
    let foot = [0, 1, 2].map(|n| p[n] - off * normal[n]);
    let edges = [(a, b), (b, c), (c, a)];
    if edges.iter().all(|&(from, to)| dot(cross(minus(to, from), minus(foot, from)), normal) >= 0.0) {
        return off * off * dot(normal, normal);
    }
    let to_edge = |&(from, to): &([f64; 3], [f64; 3])| {
        let along = minus(to, from);
        let t = (dot(minus(p, from), along) / dot(along, along)).clamp(0.0, 1.0);
        let rest = [0, 1, 2].map(|n| p[n] - from[n] - t * along[n]);
        dot(rest, rest)
    };
    edges.iter().map(to_edge).fold(f64::INFINITY, f64::min)
}

/// Distance of a voxel to each leaf.
fn to_leaves(forest: &Forest, p: [f64; 3]) -> Vec<f64> {
    let of_leaf = |&leaf: &u32| {
        let range = &forest.nodes[leaf as usize].triangles;
        let triangles = &forest.surfaces.triangles[range.start as usize..range.end as usize];
        let sq = triangles.iter().map(|triangle| {
            let corners = triangle.map(|v| {
                let v = forest.surfaces.vertices[v as usize];
                [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
            });
            distance_sq(p, corners)
        });
        sq.fold(f64::INFINITY, f64::min).sqrt()
    };
    forest.leaves.iter().map(of_leaf).collect()
}

/// Compares every voxel with the search through all triangles.
fn assert_exact(forest: &Forest, settings: &DistanceSettings) {
    let found = whole(forest, settings);
    let [nx, ny, nz] = forest.surfaces.size;
    let max = f64::from(settings.max_distance);
    for n in 0..nx * ny * nz {
        let p = [n / nz / ny, n / nz % ny, n % nz];
        let leaves = to_leaves(forest, p.map(|n| n as f64));
        let nearest = leaves.iter().copied().fold(f64::INFINITY, f64::min);
        match settings.decode(found.distance[n]) {
            None => assert!(nearest > max - 1e-3 && found.leaf[n] == 0, "{p:?}: {nearest}"),
            Some(distance) => {
                let off = (f64::from(distance) - nearest).abs();
                assert!(off < max / 508.0 + 2e-4, "{p:?}: {distance} for {nearest}");
                let own = leaves[found.leaf[n] as usize - 1];
                assert!(own < nearest + 2e-4, "{p:?}: leaf {} at {own}, not {nearest}", found.leaf[n]);
            }
        }
    }
}

fn hash(x: f32, y: f32) -> f32 {
    ((x * 12.9898 + y * 78.233).sin() * 43758.547).rem_euclid(1.0)
}

#[test]
fn a_dipping_plane_is_as_far_as_its_normal_says() {
    // In the middle, away from the edges: |z − (0.75 x + 12)| · 0.8.
    let forest = forest(sheets([40, 40, 60], &[&|x, _| 0.75 * x + 12.0], |_, _, _| true), 500);
    let settings = DistanceSettings::default();
    let found = whole(&forest, &settings);
    for (x, y) in [(20, 20), (18, 11), (25, 29)] {
        for z in 0..60 {
            let wanted = (z as f32 - (0.75 * x as f32 + 12.0)).abs() * 0.8;
            let code = found.distance[(x * 40 + y) * 60 + z];
            match settings.decode(code) {
                Some(distance) => assert!((distance - wanted).abs() < 0.02, "{x} {y} {z}: {distance} {wanted}"),
                None => assert!(wanted > 9.99),
            }
        }
    }
}

#[test]
fn the_code_is_within_two_hundredths_of_a_voxel() {
    let settings = DistanceSettings::default();
    for n in 0..=1000 {
        let distance = n as f32 * 0.01;
        assert!((settings.decode(settings.encode(distance)).unwrap() - distance).abs() < 0.02);
    }
    assert_eq!((settings.encode(10.001), settings.decode(BEYOND)), (BEYOND, None));
}

#[test]
fn overlapping_folded_steep_and_torn_surfaces_are_exact() {
    let fold = |x: f32, y: f32| 18.0 + 7.0 * (x / 4.0).sin() * (y / 6.0).cos();
    let rough = |x: f32, y: f32| 14.0 + 9.0 * hash(x, y);
    let steep = |x: f32, y: f32| 4.0 * x + 0.5 * y - 20.0;
    let flat = |_: f32, _: f32| 30.0;
    let torn = |n: usize, x: usize, y: usize| match n {
        0 => !(x + 2 * y).is_multiple_of(7),
        1 => hash(x as f32 + 0.5, y as f32) > 0.4,
        2 => y > 6,
        _ => x < 3 || (x > 12 && y < 9),
    };
    let forest = forest(sheets([22, 19, 37], &[&fold, &rough, &steep, &flat], torn), 12);
    assert!(forest.leaf_count() > 30);
    assert_exact(&forest, &DistanceSettings::default());
    assert_exact(&forest, &DistanceSettings { max_distance: 2.5 });
}

#[test]
fn sparse_surfaces_are_exact_far_away_and_past_their_edges() {
    let far = |n: usize, x: usize, y: usize| if n == 0 { x > 20 && y > 20 } else { x < 2 && y < 3 };
    let forest = forest(sheets([26, 25, 40], &[&|x, y| 5.0 + 0.4 * x - 0.1 * y, &|_, y| 33.0 - y], far), 5);
    assert_exact(&forest, &DistanceSettings::default());
    assert_exact(&forest, &DistanceSettings { max_distance: 23.0 });
}

#[test]
fn one_triangle_in_a_thin_volume_and_none_at_all() {
    let vertices = [(0, 0, 0.25), (0, 1, 7.5), (1, 1, 1.0)].map(|(x, y, z)| Vertex { x, y, z }).to_vec();
    let mut surfaces = Surfaces { size: [2, 2, 9], vertices, triangles: vec![[0, 1, 2]], surfaces: Vec::new() };
    surfaces.surfaces.push(Surface { extremum: Extremum::Peak, vertices: 0..3, triangles: 0..1 });
    assert_exact(&forest(surfaces, 500), &DistanceSettings::default());
    for size in [[3, 4, 5], [1, 1, 5], [0, 0, 0], [4, 1, 0]] {
        let none = whole(&forest(Surfaces { size, ..Surfaces::default() }, 500), &DistanceSettings::default());
        assert!(none.distance.iter().all(|&code| code == BEYOND) && none.leaf.iter().all(|&leaf| leaf == 0));
    }
}

#[test]
fn blocks_and_threads_leave_no_trace() {
    let fold = |x: f32, y: f32| 20.0 + 9.0 * (x / 11.0).sin() * (y / 9.0).cos() + hash(x, y);
    let size = [83, 90, 45];
    let surfaces = sheets(size, &[&fold, &|x, y| fold(x, y) + 6.0, &|_, y| 3.0 + 0.3 * y], |n, x, y| n < 2 || x > y);
    let forest = forest(surfaces, 60);
    let settings = DistanceSettings::default();
    let wanted = whole(&forest, &settings);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(wanted, one.install(|| whole(&forest, &settings)));
    let distances = LeafDistances::new(&forest, &settings).unwrap();
    let silent = Progress::silent();
    for (x, y) in [(0..1, 0..90), (7..50, 3..4), (61..83, 64..90), (63..66, 10..77)] {
        let part = distances.columns(x.clone(), y.clone(), &silent).unwrap();
        for (n, line) in x.enumerate() {
            for (m, crossline) in y.clone().enumerate() {
                let (here, there) = ((n * y.len() + m) * size[2], (line * size[1] + crossline) * size[2]);
                assert_eq!(part.distance[here..here + size[2]], wanted.distance[there..there + size[2]]);
                assert_eq!(part.leaf[here..here + size[2]], wanted.leaf[there..there + size[2]]);
            }
        }
    }
    let mut slabs: Vec<u8> = Vec::new();
    let take = |slab: CandidateColumns| {
        slabs.extend(slab.distance);
        Ok::<(), InterpError>(())
    };
    distances.slabs(13, &silent, take).unwrap();
    assert_eq!(slabs, wanted.distance);
}

#[test]
fn four_lanes_and_as_many_as_there_are_make_the_same_bits() {
    let fold = |x: f32, y: f32| 20.0 + 9.0 * (x / 11.0).sin() * (y / 9.0).cos() + hash(x, y);
    let size = [23, 20, 45];
    let forest = forest(sheets(size, &[&fold, &|x, y| fold(x, y) + 2.0 * hash(y, x)], |_, _, _| true), 12);
    let settings = DistanceSettings::default();
    let distances = LeafDistances::new(&forest, &settings).unwrap();
    let wanted = distances.columns(0..size[0], 0..size[1], &Progress::silent()).unwrap();
    let mut index = CellIndex::new(size);
    index.advance(&forest, &distances.lists, 0..size[0]);
    let count = size.iter().product();
    let (mut distance, mut leaf) = (vec![0; count], vec![0; count]);
    let rows = distance.chunks_mut(size[1] * size[2]).zip(leaf.chunks_mut(size[1] * size[2])).collect();
    // Not by `widest`: compiled for any processor.
    ColumnBlock { size, settings: &settings, index: &index, x: 0..size[0], y: 0..size[1], rows }.run();
    assert_eq!((distance, leaf), (wanted.distance, wanted.leaf));
}

#[test]
fn what_cannot_be_is_refused() {
    let mut surfaces = sheets([6, 6, 8], &[&|_, _| 3.0], |_, _, _| true);
    let settings = DistanceSettings::default();
    surfaces.triangles[0] = [0, 7, 14];
    let wide = Forest { surfaces: surfaces.clone(), ..forest(sheets([6, 6, 8], &[&|_, _| 3.0], |_, _, _| true), 500) };
    assert!(matches!(LeafDistances::new(&wide, &settings), Err(InterpError::MalformedSurfaces { .. })));
    let none = Forest::default();
    for max_distance in [0.0, -1.0, f32::NAN, 65.0] {
        assert!(matches!(
            LeafDistances::new(&none, &DistanceSettings { max_distance }),
            Err(InterpError::Setting { .. })
        ));
    }
    let good = forest(sheets([6, 6, 8], &[&|_, _| 3.0], |_, _, _| true), 500);
    let progress = Progress::silent();
    progress.cancel();
    let cancelled = LeafDistances::new(&good, &settings).unwrap().columns(0..6, 0..6, &progress);
    assert!(matches!(cancelled, Err(InterpError::Cancelled(_))));
}
