//! Scattered points onto the survey's traces: linear interpolation in the Delaunay triangles of the points.
//!
//! A trace further than `gap` from all three corners of its triangle is a hole, as is everything outside the points' convex
//! hull: nothing is extrapolated here. A trace with a point within half a bin is `Picked`, others are `Filled`.
//! The default gap is twice the median length of a triangle's side, which bridges random thinning and keeps real gaps.

use super::placement::world_xy;
use super::raster;
use super::sheets::{self, NodeValues};
use crate::geometry::SurveyGeometry;
use crate::horizon::{NodeGrid, Quality, Sheet};
use delaunator::{Point, triangulate};
use glam::DVec2;
use std::collections::HashMap;

/// Points gridded onto the survey's traces.
pub(super) struct Gridded {
    pub sheets: Vec<Sheet>,
    pub gap_m: f64,
    /// Points that share their place with another of clearly different depth.
    pub multivalued: usize,
}

/// Points with the same place, to a hundredth of a bin, as one node.
struct Places {
    voxels: Vec<DVec2>,
    node: Vec<usize>,
}

impl Places {
    fn of(voxels: &[DVec2]) -> Self {
        let mut places = Self { voxels: Vec::new(), node: Vec::with_capacity(voxels.len()) };
        let mut known = HashMap::new();
        for v in voxels {
            let key = ((v.x * 100.0).round() as i64, (v.y * 100.0).round() as i64);
            let node = *known.entry(key).or_insert_with(|| {
                places.voxels.push(*v);
                places.voxels.len() - 1
            });
            places.node.push(node);
        }
        places
    }
}

/// Delaunay triangles of places, in metres relative to the first.
pub(super) fn delaunay(places: &[DVec2]) -> Vec<[usize; 3]> {
    let origin = places.first().copied().unwrap_or_default();
    let points: Vec<_> = places.iter().map(|p| Point { x: p.x - origin.x, y: p.y - origin.y }).collect();
    triangulate(&points).triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
}

/// The median length of the triangles' sides; 0 without triangles.
pub(super) fn median_side(places: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
    let mut sides: Vec<f64> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| places[a].distance(places[b]))
        .collect();
    sides.sort_by(f64::total_cmp);
    sides.get(sides.len() / 2).copied().unwrap_or(0.0)
}

/// Grids points (voxel x, y; depth) onto the survey's traces.
///
/// Depths at one place closer than `tolerance` are averaged; others are split into sheets by continuity.
pub(super) fn grid(points: &[(DVec2, f32)], geometry: &SurveyGeometry, gap_m: Option<f64>, tolerance: f32) -> Gridded {
    let voxels: Vec<DVec2> = points.iter().map(|p| p.0).collect();
    let places = Places::of(&voxels);
    let world: Vec<DVec2> = places.voxels.iter().map(|v| world_xy(geometry, *v)).collect();
    let triangles = delaunay(&world);
    let gap_m = gap_m.unwrap_or_else(|| 2.0 * median_side(&world, &triangles));

    let pairs: Vec<(usize, f32)> = places.node.iter().zip(points).map(|(&n, p)| (n, p.1)).collect();
    let (values, _) = NodeValues::group(places.voxels.len(), &pairs, tolerance);
    let mut neighbours = vec![Vec::new(); places.voxels.len()];
    for t in &triangles {
        for n in 0..3 {
            neighbours[t[n]].push(t[(n + 1) % 3]);
            neighbours[t[n]].push(t[(n + 2) % 3]);
        }
    }
    let sheet = sheets::split(&values, &|n| neighbours[n].clone());
    let count = sheet.iter().max().map_or(1, |&s| usize::from(s) + 1);
    let sheets = (0..count)
        .map(|s| {
            let own: Vec<(DVec2, f32)> = (0..places.voxels.len())
                .flat_map(|n| (values.offsets[n]..values.offsets[n + 1]).map(move |e| (n, e as usize)))
                .filter(|&(_, e)| usize::from(sheet[e]) == s)
                .map(|(n, e)| (places.voxels[n], values.z[e]))
                .collect();
            interpolate(&own, geometry, gap_m)
        })
        .collect();
    Gridded { sheets, gap_m, multivalued: values.multivalued() }
}

/// One single-valued set of points onto the survey's traces.
fn interpolate(points: &[(DVec2, f32)], geometry: &SurveyGeometry, gap_m: f64) -> Sheet {
    let grid = NodeGrid::of_survey(geometry);
    let [nu, nv] = grid.count;
    let mut depth = vec![f32::NAN; nu * nv];
    let mut quality = vec![Quality::Hole; nu * nv];
    let world: Vec<DVec2> = points.iter().map(|p| world_xy(geometry, p.0)).collect();
    for t in delaunay(&world) {
        let corners = t.map(|n| points[n].0.extend(f64::from(points[n].1)));
        raster::triangle(corners, grid.count, &mut |u, v, z| {
            let here = grid.world_at(DVec2::new(u as f64, v as f64));
            if t.iter().any(|&n| world[n].distance(here) <= gap_m) {
                depth[u * nv + v] = z as f32;
                quality[u * nv + v] = Quality::Filled;
            }
        });
    }
    for (voxel, z) in points {
        let near = voxel.round();
        if near.x >= 0.0 && near.y >= 0.0 && near.x < nu as f64 && near.y < nv as f64 {
            let node = near.x as usize * nv + near.y as usize;
            // A point without a triangle (few points, or the rim) still marks its trace.
            if depth[node].is_nan() {
                depth[node] = *z;
            }
            quality[node] = Quality::Picked;
        }
    }
    Sheet { block: None, grid, depth, quality }
}
