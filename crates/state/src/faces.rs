//! Dragging the faces of the roaming box and of the cut-outs, whatever their shape.
//!
//! A face of a box moves along its axis, a sloping plane and a fence along their normal, a shaft along x or y, by the share of the pointer's travel that runs along the image of the axis: Δ =
//! δ·a/|a|², where a is the vector in pixels that one voxel along the axis covers at the handle. Faces stop at whole
//! samples.

use super::camera;
use glam::{DVec2, DVec3};
use render::visible::Solid;
use render::{CutShape, Scene, VoxelBox};
use survey::SurveyGeometry;

/// The box that a face belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// The roaming box.
    Block,
    /// A cut-out, by its index in the scene.
    CutOut(usize),
    /// A cut-out that is no box, by its index in the scene.
    Shape(usize),
}

/// One of the six faces of a box, or a direction in which a shape moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// Its box.
    pub owner: Owner,
    /// 0 = across inlines (x), 1 = across crosslines (y), 2 = across depth (z). Of a plane and a fence, 0.
    pub axis: usize,
    /// Whether it is the face at the largest coordinate along the axis; otherwise it is the one at the smallest.
    pub at_max: bool,
}

/// A visible face and the handle by which it is dragged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Handle {
    /// The face.
    pub face: Face,
    /// Position of the handle, voxel.
    pub voxel: DVec3,
    /// Position of the handle in the picture.
    pub at: DVec2,
    /// The image of one voxel along the axis.
    pub along: DVec2,
}

/// Smallest length of a box along an axis, samples.
const THINNEST: f64 = 2.0;

fn boxes(scene: &Scene, geometry: &SurveyGeometry) -> Vec<(Owner, VoxelBox)> {
    let cuts = scene.cut_outs.iter().enumerate().map(|(index, cut)| (Owner::CutOut(index), *cut));
    std::iter::once((Owner::Block, scene.box_in(geometry))).chain(cuts).collect()
}

/// The visible faces, each with a handle in its middle or, where the middle is cut away, in the middle of what is left
/// of the face.
pub fn handles(scene: &Scene, geometry: &SurveyGeometry, size: DVec2) -> Vec<Handle> {
    let view = camera::view(scene, geometry, size);
    let block = scene.box_in(geometry);
    let solid = scene.solid(geometry);
    let mut found = Vec::new();
    for (owner, bounds) in boxes(scene, geometry) {
        let Some(bounds) = bounds.intersection(&block) else { continue };
        for axis in 0..3 {
            for at_max in [false, true] {
                let outward = if at_max { 1.0 } else { -1.0 };
                // The inner faces of a cut-out are rock on the far side. Where a cut-out reaches the block's own face
                // it has no inner face.
                let plane = if at_max { bounds.max[axis] } else { bounds.min[axis] };
                let (normal, is_open) = match owner {
                    Owner::Block => (outward, false),
                    Owner::CutOut(_) | Owner::Shape(_) => {
                        (-outward, plane == if at_max { block.max[axis] } else { block.min[axis] })
                    }
                };
                let towards = view.towards_camera(bounds.centre())[axis] * normal;
                if is_open || towards <= 1e-9 {
                    continue;
                }
                let Some(voxel) = place(&bounds, axis, plane, &solid, normal) else { continue };
                let at = view.project(voxel);
                let along = view.project(voxel + DVec3::AXES[axis]) - at;
                found.push(Handle { face: Face { owner, axis, at_max }, voxel, at, along });
            }
        }
    }
    for (index, shape) in scene.cut_shapes.iter().enumerate() {
        for (axis, direction) in directions(shape).into_iter().enumerate() {
            let is_seen = |(voxel, out): &(DVec3, DVec3)| {
                let [front, behind] = [0.05, -0.05].map(|by| solid.contains((*voxel + *out * by).as_vec3()));
                !front && behind && view.towards_camera(*voxel).dot(*out) > 1e-9
            };
            // Where the surface lies most across the direction in which it is moved.
            let across = |(_, out): &(DVec3, DVec3)| out.dot(direction).abs();
            let places = places(shape, &block).into_iter().filter(is_seen);
            let best = places.fold(None, |best: Option<(DVec3, DVec3)>, place| match best {
                Some(best) if across(&best) >= across(&place) - 1e-6 => Some(best),
                _ => Some(place),
            });
            let Some((voxel, _)) = best else { continue };
            let at = view.project(voxel);
            let along = view.project(voxel + direction) - at;
            found.push(Handle { face: Face { owner: Owner::Shape(index), axis, at_max: false }, voxel, at, along });
        }
    }
    found
}

/// The directions in which a shape is moved, voxels of length 1.
fn directions(shape: &CutShape) -> Vec<DVec3> {
    match shape {
        CutShape::Plane { normal, .. } => DVec3::from_array(*normal).try_normalize().into_iter().collect(),
        CutShape::Outline { .. } => vec![DVec3::X, DVec3::Y],
        CutShape::Fence { fence, .. } => {
            let ends = fence.first().zip(fence.last());
            let along = ends.and_then(|(a, b)| (DVec2::from(*b) - DVec2::from(*a)).try_normalize());
            along.map(|along| along.perp().extend(0.0)).into_iter().collect()
        }
    }
}

/// Places on a shape's surface in a block, the middle ones first, each with the direction out of the rock.
fn places(shape: &CutShape, block: &VoxelBox) -> Vec<(DVec3, DVec3)> {
    const SHARES: [f64; 7] = [0.5, 0.35, 0.65, 0.2, 0.8, 0.07, 0.93];
    let at = |axis: usize, share: f64| block.min[axis] + share * (block.max[axis] - block.min[axis]);
    let walls = |line: Vec<DVec2>| {
        // A curve runs through the corners, a straight wall through the middles between them.
        let middles = line.windows(2).map(|ends| (ends[0].midpoint(ends[1]), ends[1] - ends[0]));
        let corners = line.windows(3).map(|ends| (ends[1], ends[2] - ends[0]));
        let sides: Vec<(DVec2, DVec3)> = middles
            .chain(corners)
            .flat_map(|(at, along)| [1.0, -1.0].map(|side| (at, along.perp().normalize_or_zero().extend(0.0) * side)))
            .collect();
        let all = SHARES.into_iter().flat_map(|share| sides.clone().into_iter().map(move |side| (share, side)));
        all.map(|(share, (middle, out))| (middle.extend(at(2, share)), out)).collect::<Vec<_>>()
    };
    match shape {
        CutShape::Plane { through, normal } => {
            let (through, normal) = (DVec3::from_array(*through), DVec3::from_array(*normal).normalize_or_zero());
            let axis = normal.abs().to_array().iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(2, |a| a.0);
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let pairs = SHARES.into_iter().flat_map(|a| SHARES.map(|b| [a, b]));
            let place = |[a, b]: [f64; 2]| {
                let mut p = through;
                (p[u], p[v]) = (at(u, a), at(v, b));
                p[axis] = through[axis];
                p[axis] -= normal.dot(p - through) / normal[axis];
                (p, normal)
            };
            let is_inside = |p: &DVec3| p.cmpge(block.low()).all() && p.cmple(block.high()).all();
            pairs.map(place).filter(|(p, _)| is_inside(p)).collect()
        }
        CutShape::Outline { outline, .. } => {
            let round = outline.iter().chain(outline.iter().take(2));
            walls(round.map(|p| DVec2::from(*p)).collect())
        }
        CutShape::Fence { fence, .. } => walls(fence.iter().map(|p| DVec2::from(*p)).collect()),
    }
}

/// The scene with a shape moved by so many voxels, or as it was where that leaves no picture.
fn move_shape(start: &Scene, geometry: &SurveyGeometry, index: usize, axis: usize, moved: f64) -> Scene {
    let mut scene = start.clone();
    let Some(shape) = scene.cut_shapes.get_mut(index) else { return scene };
    let Some(by) = directions(shape).get(axis).map(|direction| *direction * moved.round()) else { return scene };
    match shape {
        CutShape::Plane { through, .. } => *through = (DVec3::from_array(*through) + by).to_array(),
        CutShape::Outline { outline: line, .. } | CutShape::Fence { fence: line, .. } => {
            line.iter_mut().for_each(|p| *p = (DVec2::from(*p) + by.truncate()).to_array());
        }
    }
    if scene.validate(geometry).is_ok() { scene } else { start.clone() }
}

/// The point of the face nearest its middle that has rock behind it and air in front of it.
fn place(bounds: &VoxelBox, axis: usize, plane: f64, solid: &Solid, normal: f64) -> Option<DVec3> {
    const SHARES: [f64; 5] = [0.5, 0.3, 0.7, 0.15, 0.85];
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    let at = |share_u: f64, share_v: f64| {
        let mut point = [0.0; 3];
        point[axis] = plane;
        for (axis, share) in [(u, share_u), (v, share_v)] {
            point[axis] = bounds.min[axis] + share * (bounds.max[axis] - bounds.min[axis]);
        }
        DVec3::from_array(point)
    };
    let behind = DVec3::AXES[axis] * (-0.01 * normal);
    let candidates = SHARES.into_iter().flat_map(|a| SHARES.map(|b| at(a, b)));
    candidates
        .into_iter()
        .find(|point| solid.contains((*point + behind).as_vec3()) && !solid.contains((*point - behind).as_vec3()))
}

/// The scene after a handle was dragged by `delta` points from its position in `start`; the rest of the picture stays
/// where it is.
pub fn pull(start: &Scene, geometry: &SurveyGeometry, size: DVec2, handle: &Handle, delta: DVec2) -> Scene {
    let length_sq = handle.along.length_squared();
    if length_sq < 1e-9 {
        return start.clone();
    }
    let moved = delta.dot(handle.along) / length_sq;
    move_face(start, geometry, size, handle.face, moved)
}

/// The scene with a face moved by this many samples along its axis, or as far as it can go.
pub fn move_face(start: &Scene, geometry: &SurveyGeometry, size: DVec2, face: Face, moved: f64) -> Scene {
    let mut scene = start.clone();
    let Face { owner, axis, at_max } = face;
    if let Owner::Shape(index) = owner {
        return move_shape(start, geometry, index, axis, moved);
    }
    let block = start.box_in(geometry);
    let (limits, mut bounds) = match owner {
        Owner::Block => (VoxelBox::of_size(geometry.size()), block),
        Owner::CutOut(index) => match start.cut_outs.get(index).and_then(|cut| cut.intersection(&block)) {
            Some(cut) => (block, cut),
            None => return scene,
        },
        Owner::Shape(_) => return scene,
    };
    let thinnest = THINNEST.min(bounds.max[axis] - bounds.min[axis]);
    if at_max {
        bounds.max[axis] = (bounds.max[axis] + moved).round().clamp(bounds.min[axis] + thinnest, limits.max[axis]);
    } else {
        bounds.min[axis] = (bounds.min[axis] + moved).round().clamp(limits.min[axis], bounds.max[axis] - thinnest);
    }
    match owner {
        Owner::Block => {
            let before = camera::view(start, geometry, size);
            scene.roaming_box = Some(bounds);
            scene.cut_outs.retain(|cut| cut.intersection(&bounds).is_some());
            camera::hold(&before, &mut scene, geometry, size, block.centre());
        }
        Owner::CutOut(index) => scene.cut_outs[index] = bounds,
        Owner::Shape(_) => {}
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use render::Side;
    use survey::VerticalUnit;

    const SIZE: DVec2 = DVec2::new(800.0, 600.0);

    fn scene() -> (Scene, SurveyGeometry) {
        let geometry = SurveyGeometry::regular([61, 41, 51], 25.0, 8.0, VerticalUnit::Metres);
        let mut scene = Scene::default();
        let block = scene.box_in(&geometry);
        let corner = scene.view(&geometry).nearest_corner(&block);
        scene.cut_outs = vec![block.corner_cut(corner, [0.5, 0.5])];
        (scene, geometry)
    }

    #[test]
    fn three_faces_of_the_block_and_two_of_a_corner_cut_are_seen() {
        let (scene, geometry) = scene();
        let found = handles(&scene, &geometry, SIZE);
        let of_block = found.iter().filter(|handle| handle.face.owner == Owner::Block).count();
        assert_eq!((of_block, found.len()), (3, 5), "{found:?}");
    }

    #[test]
    fn a_handle_follows_the_pointer_to_the_next_sample() {
        let (scene, geometry) = scene();
        for handle in handles(&scene, &geometry, SIZE) {
            let inwards = if handle.face.at_max { -6.0 } else { 6.0 };
            let pulled = pull(&scene, &geometry, SIZE, &handle, handle.along * inwards);
            let coordinate = |scene: &Scene| {
                let bounds = match handle.face.owner {
                    Owner::Block => scene.box_in(&geometry),
                    Owner::CutOut(index) => scene.cut_outs[index],
                    Owner::Shape(_) => panic!("there is none"),
                };
                if handle.face.at_max { bounds.max[handle.face.axis] } else { bounds.min[handle.face.axis] }
            };
            assert_eq!(coordinate(&pulled) - coordinate(&scene), inwards, "{handle:?}");
            pulled.validate(&geometry).unwrap();
        }
    }

    #[test]
    fn planes_fences_and_shafts_have_handles_that_move_them_across_themselves() {
        let (mut scene, geometry) = scene();
        scene.cut_outs.clear();
        let block = scene.box_in(&geometry);
        let towards = scene.view(&geometry).towards_camera(block.centre());
        let middle = block.centre();
        let before = middle.truncate() + towards.truncate().normalize() * 8.0;
        let fence = vec![[0.0, middle.y], [60.0, middle.y + 3.0]];
        let shapes = [
            (CutShape::dipping(middle, 200.0, 40.0, &geometry), 1),
            (CutShape::round(before, 200.0, None, &geometry), 2),
            (CutShape::Fence { side: Side::facing(&fence, towards.truncate()), fence, smooth: false, depth: None }, 1),
        ];
        for (shape, count) in shapes {
            scene.cut_shapes = vec![shape.clone()];
            let found = handles(&scene, &geometry, SIZE);
            let own: Vec<&Handle> = found.iter().filter(|handle| handle.face.owner == Owner::Shape(0)).collect();
            assert_eq!(own.len(), count, "{shape:?}");
            for handle in own {
                let pulled = pull(&scene, &geometry, SIZE, handle, handle.along * 4.0);
                pulled.validate(&geometry).unwrap();
                let direction = directions(&shape)[handle.face.axis];
                let moved = |a: &CutShape, b: &CutShape| match (a, b) {
                    (CutShape::Plane { through: a, .. }, CutShape::Plane { through: b, .. }) => {
                        DVec3::from_array(*b) - DVec3::from_array(*a)
                    }
                    (CutShape::Outline { outline: a, .. }, CutShape::Outline { outline: b, .. })
                    | (CutShape::Fence { fence: a, .. }, CutShape::Fence { fence: b, .. }) => {
                        (DVec2::from(b[1]) - DVec2::from(a[1])).extend(0.0)
                    }
                    _ => DVec3::ZERO,
                };
                let by = moved(&shape, &pulled.cut_shapes[0]);
                assert!((by - direction * 4.0).length() < 1e-9, "{shape:?}: {by}");
                let far = pull(&scene, &geometry, SIZE, handle, handle.along * 1e5);
                far.validate(&geometry).unwrap();
            }
        }
    }

    #[test]
    fn no_pull_makes_a_scene_without_a_picture() {
        let (scene, geometry) = scene();
        for handle in handles(&scene, &geometry, SIZE) {
            for far in [-1e4, -20.0, 20.0, 1e4] {
                let pulled = pull(&scene, &geometry, SIZE, &handle, handle.along * far);
                pulled.validate(&geometry).unwrap();
            }
        }
    }

    #[test]
    fn the_rest_of_the_block_stays_while_a_face_is_pulled() {
        let (scene, geometry) = scene();
        let handle = handles(&scene, &geometry, SIZE)[0];
        let inwards = if handle.face.at_max { -9.0 } else { 9.0 };
        let pulled = pull(&scene, &geometry, SIZE, &handle, handle.along * inwards);
        let point = DVec3::new(30.0, 20.0, 25.0);
        let before = camera::view(&scene, &geometry, SIZE).project(point);
        let after = camera::view(&pulled, &geometry, SIZE).project(point);
        assert!((before - after).length() < 0.5, "{before} {after}");
    }
}
