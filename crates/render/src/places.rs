//! Where a picture of faces takes samples of volumes: on the planes of the block and of its cut-outs, and on its ground.
//! Of a volume that is larger than memory, these places alone are read.

use crate::ground::{CELL, Heights, corners};
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use model::StructuralModel;
use survey::SurveyGeometry;
use survey::block::BodyPlane;

/// How far beyond its planes a picture may take samples, voxels: rounding.
const MARGIN: f32 = 0.01;

/// Components of a unit normal smaller than this count as none.
const PARALLEL: f32 = 1e-6;

/// Places at which samples are taken, voxels.
///
/// ```
/// use glam::{Vec2, Vec3};
/// use render::places::Places;
///
/// let mut places = Places::default();
/// places.add_plane(Vec3::Z, 7.0, [Vec3::ZERO, Vec3::splat(20.0)]);
/// assert_eq!(places.depths([Vec2::ZERO, Vec2::splat(8.0)]).len(), 1);
/// assert!(places.depths([Vec2::splat(30.0), Vec2::splat(38.0)]).is_empty());
/// ```
#[derive(Default)]
pub struct Places<'a> {
    planes: Vec<PlanePart>,
    ground: Option<GroundPart<'a>>,
}

/// The part of a plane in a box.
struct PlanePart {
    normal: Vec3,
    offset: f32,
    within: [Vec3; 2],
}

/// The ground in a box.
struct GroundPart<'a> {
    model: &'a StructuralModel,
    heights: Heights,
    within: [Vec3; 2],
}

impl<'a> Places<'a> {
    /// Where a scene without volume rendering takes samples; `None` where its ground cannot be foreseen.
    pub fn of(scene: &Scene, geometry: &SurveyGeometry, model: Option<&'a StructuralModel>) -> Option<Self> {
        let solid = scene.solid(geometry);
        let within = corners(scene, geometry);
        let mut places = Self::default();
        let bodies = std::iter::once(&solid.block).chain(&solid.cut_outs);
        for BodyPlane { normal, offset, .. } in bodies.flat_map(|body| &body.planes).filter(|plane| !plane.is_seam) {
            places.add_plane(*normal, *offset, within);
        }
        places.ground = match (scene.ground, model) {
            (None, _) => None,
            (Some(_), Some(model)) if !model.has_levels() => {
                Some(GroundPart { model, heights: Heights::of(model, within[0], within[1]), within })
            }
            (Some(_), _) => return None,
        };
        Some(places)
    }

    /// Adds the part of the plane n·p = `offset` between two corners.
    pub fn add_plane(&mut self, normal: Vec3, offset: f32, within: [Vec3; 2]) {
        self.planes.push(PlanePart { normal, offset, within });
    }

    /// Ranges of depths at which samples may be taken between two corners of the map.
    pub fn depths(&self, map: [Vec2; 2]) -> Vec<[f32; 2]> {
        let planes = self.planes.iter().filter_map(|part| part.depths(map));
        planes.chain(self.ground.iter().filter_map(|ground| ground.depths(map))).collect()
    }
}

/// What two boxes of the map have in common.
fn common(map: [Vec2; 2], within: [Vec3; 2]) -> Option<[Vec2; 2]> {
    let low = map[0].max(within[0].truncate() - MARGIN);
    let high = map[1].min(within[1].truncate() + MARGIN);
    low.cmple(high).all().then_some([low, high])
}

impl PlanePart {
    fn depths(&self, map: [Vec2; 2]) -> Option<[f32; 2]> {
        let [low, high] = common(map, self.within)?;
        let across = [low, Vec2::new(low.x, high.y), Vec2::new(high.x, low.y), high]
            .map(|corner| self.offset - self.normal.truncate().dot(corner));
        let (least, most) = across.iter().fold((f32::MAX, f32::MIN), |(a, b), &c| (a.min(c), b.max(c)));
        let [first, last] = [self.within[0].z - MARGIN, self.within[1].z + MARGIN];
        if self.normal.z.abs() < PARALLEL {
            return (least <= MARGIN && most >= -MARGIN).then_some([first, last]);
        }
        let [a, b] = [least / self.normal.z, most / self.normal.z];
        let range = [a.min(b) - MARGIN, a.max(b) + MARGIN];
        (range[0] <= last && range[1] >= first).then_some([range[0].max(first), range[1].min(last)])
    }
}

impl GroundPart<'_> {
    /// Between the highest and the deepest sheet of any block, so that scarps of faults count.
    fn depths(&self, map: [Vec2; 2]) -> Option<[f32; 2]> {
        /// Voxels between places at which sheets are evaluated.
        const STEP: f32 = 2.0;
        /// Voxels around: where the ground is steep, as where a fault is not interpreted, the search along a ray may end
        /// beside it by the length of a step.
        const AROUND: f32 = CELL;
        let [low, high] = common(map, self.within)?;
        let (low, high) = (low - AROUND, high + AROUND);
        let (mut top, mut bottom) = (f32::MAX, f32::MIN);
        let counts = ((high - low) / STEP).ceil().max(Vec2::ONE);
        for n in 0..=counts.x as usize {
            for m in 0..=counts.y as usize {
                let p = low + (high - low) * Vec2::new(n as f32, m as f32) / counts;
                for &horizon in &self.heights.horizons {
                    for block in 0..self.model.block_count() as u16 {
                        let z = self.model.sheet(horizon, block).z_at(p.x, p.y);
                        (top, bottom) = (top.min(z), bottom.max(z));
                    }
                }
            }
        }
        let margin = 1.0 + STEP * self.heights.steepest;
        let [first, last] = [self.within[0].z - MARGIN, self.within[1].z + MARGIN];
        let range = [(top - margin).max(first), (bottom + margin).min(last)];
        (range[0] <= range[1]).then_some(range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_oblique_plane_has_the_depths_between_its_corners_and_a_wall_all_of_them() {
        let within = [Vec3::ZERO, Vec3::new(50.0, 50.0, 30.0)];
        let mut places = Places::default();
        // z = 5 + x / 2.
        let normal = Vec3::new(-0.5, 0.0, 1.0).normalize();
        places.add_plane(normal, 5.0 * normal.z, within);
        let found = places.depths([Vec2::new(8.0, 0.0), Vec2::new(16.0, 8.0)]);
        assert!((found[0][0] - 9.0).abs() < 0.02 && (found[0][1] - 13.0).abs() < 0.02, "{found:?}");
        // Beyond the bottom of the box.
        assert_eq!(places.depths([Vec2::new(51.0, 0.0), Vec2::new(58.0, 8.0)]), [] as [[f32; 2]; 0]);
        let mut wall = Places::default();
        wall.add_plane(Vec3::new(0.6, 0.8, 0.0), 10.0, within);
        assert_eq!(wall.depths([Vec2::ZERO, Vec2::splat(5.0)]).len(), 0);
        let found = wall.depths([Vec2::splat(5.0), Vec2::splat(9.0)]);
        assert!(found[0][0] <= 0.0 && found[0][1] >= 30.0, "{found:?}");
    }
}
