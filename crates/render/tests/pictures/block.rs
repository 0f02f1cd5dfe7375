//! Small models that tests draw.

use glam::DVec3;
use model::{ModelSettings, StructuralModel};
use param::{KDefinition, PackedVolume, ParamSettings, Parameterization};
use render::{Inputs, NamedVolume, VoxelBox};
use survey::{Fault, Horizon, Progress, Stratigraphy, SurveyGeometry};
use synth::closed_form::ClosedForm;
use ttf::{BlockExtent, LayerExtent, TextureLibrary, TransferFunctions, TtfTables};

/// A model with all data derived from it.
pub(crate) struct Block {
    pub geometry: SurveyGeometry,
    pub model: StructuralModel,
    pub param: Parameterization,
    pub packed: PackedVolume,
    pub tables: TtfTables,
}

impl Block {
    pub(crate) fn new(
        geometry: &SurveyGeometry,
        stratigraphy: &Stratigraphy,
        horizons: &[Horizon],
        faults: &[Fault],
        functions: &TransferFunctions,
        library: &TextureLibrary,
    ) -> Self {
        let quiet = Progress::silent();
        let settings = ModelSettings::default();
        let model = StructuralModel::build(geometry, stratigraphy, horizons, faults, &settings, &quiet).unwrap();
        let (param, packed) = parameterized(geometry, &model, KDefinition::default());
        let extent = geometry.metric_from_voxel() * DVec3::from_array(VoxelBox::of_size(geometry.size()).max);
        let names = stratigraphy.layer_names_bottom_up();
        let thickness_m = extent.z as f32 / names.len() as f32;
        let block = BlockExtent {
            extent_i_m: extent.x.abs() as f32,
            extent_j_m: extent.y.abs() as f32,
            layers: names.into_iter().map(|name| LayerExtent { name, thickness_m }).collect(),
            metres_per_mm: extent.x.abs() as f32 / 100.0,
        };
        let tables = TtfTables::compile(functions, &block, library).unwrap();
        Self { geometry: geometry.clone(), model, param, packed, tables }
    }

    /// The same with another definition of k in all layers.
    pub(crate) fn with_k(self, definition: KDefinition) -> Self {
        let (param, packed) = parameterized(&self.geometry, &self.model, definition);
        Self { param, packed, ..self }
    }

    pub(crate) fn of(closed: &ClosedForm, functions: &TransferFunctions, library: &TextureLibrary) -> Self {
        Self::new(&closed.geometry, &closed.stratigraphy, &closed.horizons, &closed.faults, functions, library)
    }

    pub(crate) fn inputs<'a>(&'a self, volumes: &'a [NamedVolume<'a>]) -> Inputs<'a> {
        Inputs {
            geometry: &self.geometry,
            model: Some(&self.model),
            param: Some(&self.param),
            packed: Some(&self.packed),
            tables: Some(&self.tables),
            volumes,
            candidates: None,
            wells: &[],
            data_key: 1,
        }
    }
}

fn parameterized(
    geometry: &SurveyGeometry,
    model: &StructuralModel,
    definition: KDefinition,
) -> (Parameterization, PackedVolume) {
    let quiet = Progress::silent();
    // Calm sheets, which the device has to hold beside those of the horizons.
    let flow_wave_m = 8.0 * geometry.inline_vector.length();
    let definitions = vec![definition; model.layer_count()];
    let settings = ParamSettings { flow_wave_m, definitions, ..ParamSettings::default() };
    let param = Parameterization::compute(model, &settings, &quiet).unwrap();
    let voxels = param.voxel_volumes(model, model.size(), &quiet).unwrap();
    let packed = PackedVolume::from_voxels(&voxels, model.size(), model.layer_count(), model.block_count());
    (param, packed)
}
