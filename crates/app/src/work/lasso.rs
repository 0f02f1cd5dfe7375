//! What a lasso encloses: the leaves of a horizon that lie mostly inside, combined into nodes where all leaves of a
//! node do.
//!
//! On a section only what lies near it counts, because the user cannot see the rest. On the block everything behind the
//! lasso counts. Spaces: (s, t) of the section; points of the picture; voxels.

use crate::state::picking::place_of;
use crate::state::{Lasso, LassoOn, camera};
use glam::{DVec2, DVec3};
use interp::Forest;
use interp::assembly::{Operation, Selection};
use project::command::{Climb, PickNode};
use survey::SurveyGeometry;

/// Distance from a section within which something lies on it: traces across, samples along the vertical.
const NEAR: f64 = 2.0;
/// Share of a leaf's vertices that must lie inside.
const MOSTLY: f64 = 0.5;

/// The picks that remove from a selection what a lasso encloses, and the number of leaves of the selection that it holds
/// a lesser part of, which stay.
pub(super) fn nodes_inside(
    lasso: &Lasso,
    forest: &Forest,
    chosen: &Selection,
    geometry: &SurveyGeometry,
    horizon: &str,
) -> (Vec<PickNode>, usize) {
    let project: Box<dyn Fn(DVec3) -> Option<DVec2>> = match &lasso.on {
        LassoOn::Section(kind, at) => {
            let (kind, at) = (*kind, *at);
            Box::new(move |p: DVec3| ((p[kind.axis()] - at).abs() <= NEAR).then_some(kind.flat(p)))
        }
        LassoOn::Block(scene, size) => {
            let view = camera::view(scene, geometry, *size);
            Box::new(move |p: DVec3| Some(view.project(p)))
        }
    };
    let surfaces = &forest.surfaces;
    let enclosed = |leaf: u32| {
        let range = &forest.nodes[forest.leaves[leaf as usize - 1] as usize].triangles;
        if !chosen.contains(range.start) {
            return Enclosed::Nothing;
        }
        let (mut seen, mut inside) = (0usize, 0usize);
        for &v in surfaces.triangles[range.start as usize..range.end as usize].iter().flatten() {
            let v = surfaces.vertices[v as usize];
            if let Some(at) = project(DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))) {
                seen += 1;
                inside += usize::from(contains(&lasso.corners, at));
            }
        }
        match inside {
            0 => Enclosed::Nothing,
            _ if inside as f64 > MOSTLY * seen as f64 => Enclosed::Mostly,
            _ => Enclosed::Partly,
        }
    };
    let leaves: Vec<Enclosed> = (1..=forest.leaves.len() as u32).map(enclosed).collect();
    let inside: Vec<bool> = leaves.iter().map(|leaf| *leaf == Enclosed::Mostly).collect();
    let left = leaves.iter().filter(|leaf| **leaf == Enclosed::Partly).count();
    let mut picks = Vec::new();
    for &root in &forest.roots {
        gather(forest, root, &inside, &mut |node| {
            let leaf = forest.leaves_under(node).start;
            let own = forest.leaves[leaf as usize - 1];
            let up = forest.climb(own).position(|above| above == node).unwrap_or(0) as u32;
            picks.push(PickNode {
                at: place_of(geometry, middle(forest, own)),
                horizon: horizon.to_owned(),
                operation: Operation::Remove,
                colour: None,
                climb: Climb::Levels(up),
            });
        });
    }
    (picks, left)
}

/// How much of a leaf lies inside a lasso.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Enclosed {
    Nothing,
    Partly,
    Mostly,
}

/// Names the highest nodes of a tree whose leaves are all inside.
fn gather(forest: &Forest, root: u32, inside: &[bool], found: &mut impl FnMut(u32)) {
    let mut open = vec![root];
    while let Some(node) = open.pop() {
        let leaves = forest.leaves_under(node);
        let mine = &inside[leaves.start as usize - 1..leaves.end as usize - 1];
        if mine.iter().all(|inside| *inside) {
            found(node);
        } else if mine.iter().any(|inside| *inside) {
            open.extend(forest.nodes[node as usize].children.into_iter().flatten());
        }
    }
}

/// The centre of the middle triangle of a node: a place that belongs to it and to no other.
fn middle(forest: &Forest, node: u32) -> DVec3 {
    let range = &forest.nodes[node as usize].triangles;
    let corners = forest.surfaces.triangles[(range.start + (range.end - range.start) / 2) as usize];
    let place = |v: u32| {
        let v = forest.surfaces.vertices[v as usize];
        DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
    };
    corners.into_iter().map(place).sum::<DVec3>() / 3.0
}

/// Whether a closed line encloses a point: a ray to the right crosses the line an odd number of times.
fn contains(corners: &[DVec2], at: DVec2) -> bool {
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let crosses = |(a, b): &(&DVec2, &DVec2)| {
        (a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)
    };
    ends.filter(crosses).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_holds_what_it_runs_around() {
        let horseshoe =
            [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [6.0, 9.0], [6.0, 3.0], [3.0, 3.0], [3.0, 9.0], [0.0, 9.0]]
                .map(DVec2::from_array);
        for (at, is_inside) in [([1.0, 5.0], true), ([4.5, 1.0], true), ([4.5, 5.0], false), ([-1.0, 5.0], false)] {
            assert_eq!(contains(&horseshoe, DVec2::from_array(at)), is_inside, "{at:?}");
        }
    }
}
