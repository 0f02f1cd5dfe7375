//! How patterns lie on a plane of the block, and how far they are stretched at a place of it.

use crate::resolved_scene::ResolvedScene;
use glam::{DMat3, DVec3, Vec3};
use survey::block::BodyPlane;
use ttf::{FaceFrame, MappingWeights, Stretch, TtfTables};

/// The mappings of a plane of the block, and its metric.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceMap {
    pub frame: FaceFrame,
    /// Two directions in the plane, voxels: perpendicular and a metre long in the displayed (exaggerated) block.
    pub metre_steps: [Vec3; 2],
    /// Metres between voxels along x, y, z.
    voxel_m: Vec3,
}

/// The mean thickness of a layer, m.
fn thickness_m(tables: &TtfTables, layer: u16) -> f32 {
    tables.layers.get(usize::from(layer)).map_or(1.0, |layer| layer.thickness_m)
}

impl FaceMap {
    /// The stretch of each mapping in a layer where flat space changes by this Jacobian, per voxel.
    pub(crate) fn stretches(&self, tables: &TtfTables, layer: u16, jacobian: &[[f32; 3]; 3]) -> [Stretch; 3] {
        let changes = self.metre_steps.map(|step| jacobian.map(|row| Vec3::from_array(row).dot(step)));
        self.frame.stretches(tables.globals.aspect_j, [tables.globals.extent_i_m, thickness_m(tables, layer)], changes)
    }

    /// The weights of the mappings there.
    pub(crate) fn weights(&self, tables: &TtfTables, layer: u16, jacobian: &[[f32; 3]; 3]) -> MappingWeights {
        let k = Vec3::from_array(jacobian[2]);
        let [_, _, on_map] = self.stretches(tables, layer, jacobian);
        let [p, q] = self.metre_steps.map(|step| thickness_m(tables, layer) * k.dot(step));
        self.frame.weights((k / self.voxel_m).to_array(), p.hypot(q), on_map)
    }
}

impl ResolvedScene<'_> {
    /// How patterns lie on a plane of the block.
    pub(crate) fn face_map(&self, plane: &BodyPlane) -> FaceMap {
        let stretch = DMat3::from_diagonal(DVec3::new(1.0, 1.0, self.scene.exaggeration));
        let displayed = stretch * self.metric;
        let steps = match plane.axis {
            Some(axis) => [[1, 2], [0, 2], [0, 1]][axis].map(|n: usize| DVec3::AXES[n]),
            None => plane.normal.as_dvec3().any_orthonormal_pair().into(),
        };
        let [p, q] = steps.map(|step| displayed * step);
        // Gram and Schmidt.
        let along = p.dot(q) / p.length_squared();
        let metre_steps = [steps[0] / p.length(), (steps[1] - along * steps[0]) / (q - along * p).length()];
        FaceMap { frame: self.frame(plane), metre_steps: metre_steps.map(|step| step.as_vec3()), voxel_m: self.voxel_m }
    }
}
