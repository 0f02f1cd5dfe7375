//! Loads the input of renderers from a project: reads data, builds the model, parameterizes layers and compiles styles.
//! Each part is a [`Query`], so that whoever loads again, for another scene or state, computes only what has changed.

use super::PickedShare;
use crate::document::Document;
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use crate::interpretation::solid::{self, SolidModel};
use crate::interpretation::told;
use crate::pictures::shown_candidates::ShownCandidates;
pub use crate::pictures::volumes::{LoadedSamples, LoadedVolume};
use crate::pictures::volumes::{Reading, SMALL_BYTES, read_volumes};
pub use crate::pictures::wells::{LoadedLog, LoadedWell, Wells};
use crate::{content, derived, memory_budget, styles};
use glam::Vec3;
use model::{ModelSettings, StructuralModel};
use param::{ComputeCost, PackedVolume, Parameterization, RegionGrid, VoxelParameterization};
use render::distortion::{self, LayerDistortion};
use render::places::Places;
use render::{DrawnWell, FaceData, Inputs, Lookup, Media, NamedVolume, RenderError, Scene};
use std::path::Path;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};
use survey::{Progress, SurveyGeometry};
use system::memory;
use ttf::{BlockExtent, LayerExtent, RawColour, TransferFunctions, TtfTables};

/// Memory that the sampled parameterization takes for each voxel: i, j, k, layer and block.
const VOXEL_BYTES: usize = 16;

/// Memory that the packed volume takes for each voxel: three floats.
const PACKED_BYTES: usize = 12;

/// Number of samples along each axis at which mean thicknesses are measured.
const THICKNESS_SAMPLES: usize = 48;

/// The duration of a stage.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Stage {
    /// The stage.
    pub stage: &'static str,
    /// Seconds.
    pub seconds: f64,
}

impl Stage {
    /// A stage with its name.
    pub fn new(stage: &'static str, took: Duration) -> Self {
        Self { stage, seconds: took.as_secs_f64() }
    }
}

/// The interpretation as a solid model, with its map to flat space.
pub struct Rock {
    /// Regions of every point.
    pub model: Arc<StructuralModel>,
    /// i, j, k.
    pub parameterization: Parameterization,
    /// Key: identifies what it was computed from.
    pub key: String,
    /// The stages and their durations; empty for results that were stored before.
    pub stages: Vec<Stage>,
    /// Metres that k = 0 … 1 spans in each layer, once they were measured.
    thicknesses_m: OnceLock<Vec<f32>>,
    /// How much of each horizon was picked, youngest first, once it was measured.
    pub(super) picked: OnceLock<Vec<f64>>,
}

impl Rock {
    /// What was computed under a key, in stages.
    pub fn new(
        model: impl Into<Arc<StructuralModel>>,
        parameterization: Parameterization,
        key: String,
        stages: Vec<Stage>,
    ) -> Self {
        let (thicknesses_m, picked) = (OnceLock::new(), OnceLock::new());
        Self { model: model.into(), parameterization, key, stages, thicknesses_m, picked }
    }
}

/// The model alone, from which sections and maps are cut; `None` for a project without horizons. Warns of what
/// contradicts itself.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, or the user cancelled.
pub(crate) fn structural_model(
    facts: Facts<'_>,
    progress: &Progress,
) -> Result<Option<(Arc<StructuralModel>, Stage)>, ProjectError> {
    if facts.document.horizons.is_empty() {
        return Ok(None);
    }
    let start = Instant::now();
    let model = facts.get(&SolidModel, progress)?;
    let notes = model.report().notes.iter();
    notes.filter(|note| note.is_contradiction()).for_each(|note| progress.warn(note.to_string()));
    Ok(Some((model, Stage::new("model", start.elapsed()))))
}

/// The model and its parameterization; `None` for a project without horizons.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, or the user cancelled.
pub fn rock(facts: Facts<'_>, progress: &Progress) -> Result<Option<Arc<Rock>>, ProjectError> {
    if facts.document.horizons.is_empty() { Ok(None) } else { facts.get(&SolidRock, progress).map(Some) }
}

/// The interpretation of a project's state. The parameterization is stored beside the project.
struct SolidRock;

impl Query for SolidRock {
    const WHAT: &'static str = "rock";
    type Answer = Rock;

    fn key(&self, Facts { document, .. }: Facts<'_>) -> Result<String, ProjectError> {
        Ok(derived::parameterization_key(document, &ModelSettings::default(), &solid::param_settings(document)))
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<Rock, ProjectError> {
        let Facts { root, document } = facts;
        let (model, stage) = structural_model(facts, progress)?.ok_or(ProjectError::NoLayers)?;
        let (key, settings) = (self.key(facts)?, solid::param_settings(document));
        solid::check_coordinates(model.size(), &settings)?;
        if let Some(kept) = derived::load_grids(root, &key).filter(|kept| is_of(kept, &model)) {
            return Ok(Rock::new(model, kept, key, vec![stage]));
        }
        let start = Instant::now();
        let computed = match &document.parameterization {
            None => match told::parameterization(document, &model, &settings, progress)? {
                Some(told) => told,
                None => Parameterization::compute(&*model, &settings, progress)?,
            },
            Some(entry) => {
                let arrays = derived::voxels_of(content::read_parameterization(root, entry, progress)?);
                Parameterization::of_volumes(&*model, &arrays, &settings, progress)?.0
            }
        };
        let stages = vec![stage, Stage::new("parameterization", start.elapsed())];
        derived::keep_grids(root, &key, &computed, progress);
        Ok(Rock::new(model, computed, key, stages))
    }

    fn bytes(rock: &Rock) -> usize {
        SolidModel::bytes(&rock.model) + rock.parameterization.grids.iter().map(RegionGrid::bytes).sum::<usize>()
    }
}

/// Whether a parameterization has the size, layers and blocks of a model.
fn is_of(parameterization: &Parameterization, model: &StructuralModel) -> bool {
    let counts = (parameterization.size, parameterization.layers, parameterization.blocks);
    counts == (model.size(), model.layer_count(), model.block_count())
}

/// The paper's packed volume of a rock.
struct Packed(Arc<Rock>);

impl Query for Packed {
    const WHAT: &'static str = "packed volume";
    type Answer = PackedVolume;

    fn key(&self, _: Facts<'_>) -> Result<String, ProjectError> {
        Ok(self.0.key.clone())
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<PackedVolume, ProjectError> {
        let (size, model) = (facts.document.frame()?.size(), &self.0.model);
        let voxels = self.0.voxels(facts.root, size, progress)?;
        Ok(PackedVolume::from_voxels(&voxels, size, model.layer_count(), model.block_count()))
    }

    fn bytes(packed: &PackedVolume) -> usize {
        packed.size.iter().product::<usize>() * PACKED_BYTES
    }
}

impl Rock {
    /// The parameterization sampled on a lattice: the stored one, otherwise sampled now.
    ///
    /// # Errors
    /// The size has no samples or does not fit into memory, or the user cancelled.
    pub fn voxels(
        &self,
        root: &Path,
        size: [usize; 3],
        progress: &Progress,
    ) -> Result<VoxelParameterization, ProjectError> {
        match derived::load_volumes(root, &self.key, size, progress) {
            Some(kept) => Ok(kept),
            None => {
                memory::check("i, j and k for each voxel", &size, VOXEL_BYTES)?;
                Ok(self.parameterization.voxel_volumes(&*self.model, size, progress)?)
            }
        }
    }

    /// The pairs of layers that touch in the block or follow one another in the column, as positions among the layers,
    /// youngest first. Where a scene shows the ground, the first layer is left out as air.
    pub(crate) fn neighbours(&self, scene: &Scene) -> Vec<[usize; 2]> {
        let youngest = self.model.layer_count() - 1;
        let touching = self.model.touching_layers().into_iter();
        let touching = touching.map(|[deep, high]| [high, deep].map(|n| youngest - usize::from(n)));
        let mut pairs: Vec<[usize; 2]> = touching.chain((0..youngest).map(|n| [n, n + 1])).collect();
        pairs.retain(|pair| scene.ground.is_none() || pair[0] > 0);
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Metres that k = 0 … 1 spans in each layer, bottom to top: the mean thickness where the layer exists, or the
    /// reference thickness of an open layer.
    fn thicknesses_m(&self, geometry: &SurveyGeometry) -> &[f32] {
        self.thicknesses_m.get_or_init(|| self.measured_thicknesses_m(geometry))
    }

    fn measured_thicknesses_m(&self, geometry: &SurveyGeometry) -> Vec<f32> {
        let size = self.model.size();
        let counts = size.map(|n| n.min(THICKNESS_SAMPLES));
        let at = |axis: usize, n: usize| param::corner_aligned(n, counts[axis], size[axis]);
        let layers = self.model.layer_count();
        let (mut voxels, mut columns) = (vec![0usize; layers], vec![0usize; layers]);
        for x in 0..counts[0] {
            for y in 0..counts[1] {
                let mut here = vec![0usize; layers];
                for z in 0..counts[2] {
                    let region = self.model.region_at(Vec3::new(at(0, x), at(1, y), at(2, z)));
                    here[usize::from(region.layer)] += 1;
                }
                for layer in 0..layers {
                    voxels[layer] += here[layer];
                    columns[layer] += usize::from(here[layer] > 0);
                }
            }
        }
        let step_m = geometry.sample_m() * (size[2] as f64 / counts[2] as f64);
        let thickness = |layer: usize| {
            let reference = self.parameterization.grids.iter().filter(|grid| usize::from(grid.region.layer) == layer);
            let reference = reference.filter_map(|grid| grid.thickness_m).fold(f64::NAN, f64::max);
            let mean = voxels[layer] as f64 / columns[layer].max(1) as f64 * step_m;
            (if reference.is_finite() { reference } else { mean }).max(step_m) as f32
        };
        (0..layers).map(thickness).collect()
    }
}

/// Everything that a scene of a project is drawn from.
pub struct Loaded {
    /// The survey geometry.
    pub geometry: SurveyGeometry,
    /// The interpretation, if there is one and the scene shows it.
    pub rock: Option<Arc<Rock>>,
    /// How much of each horizon was picked, youngest first.
    pub picked: Vec<PickedShare>,
    /// The volumes that the scene shows.
    pub volumes: Vec<LoadedVolume>,
    /// The packed volume, for the lookup that needs it.
    pub packed: Option<Arc<PackedVolume>>,
    /// The volume shown as raw data and its colours.
    pub raw: Option<RawColour>,
    /// Wells, in voxels.
    pub wells: Arc<Vec<LoadedWell>>,
    /// Horizon candidates, if the scene shows them or horizons in volumes.
    pub candidates: Option<ShownCandidates>,
    /// Compiled styles.
    pub tables: Option<TtfTables>,
    /// A hash of all but the styles: renderers keep what they uploaded while it stays the same.
    pub data_key: u64,
    /// A hash of all of it: while it stays the same, so does every picture.
    pub key: u64,
}

/// What is asked of a project for pictures of a scene.
#[derive(Clone, Copy)]
pub struct Request<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What of the project is needed.
    pub extent: Extent<'a>,
    /// Most memory for the samples of each volume, bytes; larger volumes are read at a coarser level of their pyramid,
    /// and a warning says so.
    pub volume_bytes: u64,
    /// Volumes up to this size are read whole in any case, bytes.
    pub small_bytes: u64,
}

/// What of a project is needed.
#[derive(Clone, Copy)]
pub enum Extent<'a> {
    /// All that any view of the scene needs.
    Whole,
    /// What the processor needs to draw the scene once: of large volumes, the samples on faces and ground alone, so that
    /// pictures of a volume of any size have its own resolution; and no layer coordinates where measured data hide the
    /// rock. `Loaded::has_missed` says whether that was enough.
    Faces,
    /// Measured data alone, whatever horizons there are, so that nobody waits for a model: the raw volume, the wells and
    /// the part of the extraction that the scene shows. With places, of large volumes only the samples there.
    Data(Option<&'a Places<'a>>),
}

impl<'a> Request<'a> {
    /// All that any view of a scene needs, within half of the memory that is available for each volume.
    pub fn new(scene: &'a Scene) -> Self {
        let volume_bytes = memory_budget::half_of_available();
        Self { scene, extent: Extent::Whole, volume_bytes, small_bytes: SMALL_BYTES }
    }

    /// The same of a part.
    #[must_use]
    pub fn of(self, extent: Extent<'a>) -> Self {
        Self { extent, ..self }
    }

    /// The same within so many bytes for each volume.
    #[must_use]
    pub fn within(self, volume_bytes: u64) -> Self {
        Self { volume_bytes, ..self }
    }

    /// The styles that the scene is drawn in.
    fn functions(&self, document: &Document) -> TransferFunctions {
        let mut functions = styles::transfer_functions(document);
        if let Extent::Data(_) = self.extent {
            return functions;
        }
        if let Some(raw) = &self.scene.raw {
            functions.raw = Some(raw.clone());
        }
        functions.printed(self.scene.preset)
    }

    /// The interpretation, as far as it is needed.
    fn rock(
        &self,
        facts: Facts<'_>,
        functions: &TransferFunctions,
        progress: &Progress,
    ) -> Result<Option<Arc<Rock>>, ProjectError> {
        match self.extent {
            Extent::Data(_) => Ok(None),
            // Measured data alone need no interpretation, but outlines and ground do.
            Extent::Faces if is_hidden(self.scene, functions) => match facts.held(&SolidRock)? {
                None => Ok(model_alone(facts, progress)?.map(Arc::new)),
                known => Ok(known),
            },
            Extent::Faces | Extent::Whole => rock(facts, progress),
        }
    }

    /// The names of the volumes that are needed.
    fn volumes<'n>(&'n self, functions: &'n TransferFunctions, has_rock: bool) -> Vec<&'n str> {
        let is_data = matches!(self.extent, Extent::Data(_));
        let scalars = functions.scalars.iter().filter(|_| !is_data).map(|function| function.volume.as_str());
        let raw = functions.raw.iter().filter(|_| is_data || self.scene.blend > 0.0 || !has_rock);
        scalars.chain(raw.map(|raw| raw.volume.as_str())).chain(self.scene.media.volumes()).collect()
    }
}

/// Adds what another scene shows in volumes to a scene that stands for both when they are loaded.
pub fn add_needs(scene: &mut Scene, of: &Scene) {
    let (media, more) = (&mut scene.media, &of.media);
    media.surroundings.extend(more.all().cloned());
    media.isosurfaces.extend(more.isosurfaces.iter().cloned());
    media.horizons.extend(more.horizons.iter().cloned());
    if of.face_data.shows_candidates() {
        scene.face_data = of.face_data;
    }
    if of.face_data.shows_candidates() || !more.horizons.is_empty() {
        scene.tree_level = of.tree_level;
    }
}

/// Reads and computes what is asked for and is not in memory.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, styles cannot be drawn, or the user cancelled.
pub fn load(facts: Facts<'_>, request: &Request<'_>, progress: &Progress) -> Result<Loaded, ProjectError> {
    let (document, scene) = (facts.document, request.scene);
    let geometry = document.frame()?.clone();
    let functions = request.functions(document);
    let rock = request.rock(facts, &functions, progress)?;
    let picked = rock.as_ref().map_or_else(Vec::new, |rock| rock.picked(document));
    if scene.blend < 1.0 {
        super::sparse_sentences(&sparse(&picked)).into_iter().for_each(|sentence| progress.warn(sentence));
    }
    let packed = match (&rock, scene.lookup) {
        (Some(rock), Lookup::Packed) => Some(facts.get(&Packed(rock.clone()), progress)?),
        _ => None,
    };
    let tables = match &rock {
        None => None,
        Some(rock) => {
            let library = styles::pattern_library(facts.root, document)?;
            let block = block_extent(&geometry, rock, document.stratigraphy().layer_names_bottom_up());
            Some(TtfTables::compile(&functions, &block, &library)?)
        }
    };
    let model = rock.as_ref().map(|rock| &*rock.model);
    let on_faces;
    let places = match request.extent {
        Extent::Whole => None,
        Extent::Faces => {
            on_faces = Places::of(scene, &geometry, model);
            on_faces.as_ref()
        }
        Extent::Data(places) => places,
    };
    let rendered: Vec<&str> = scene.media.volumes().collect();
    let reading = Reading { bytes: request.volume_bytes, places, small_bytes: request.small_bytes, whole: &rendered };
    let volumes = read_volumes(facts, &request.volumes(&functions, rock.is_some()), &reading, progress)?;
    let candidates = ShownCandidates::load(facts, scene, rock.as_deref(), progress)?;
    let wells = facts.get(&Wells, progress)?;
    let of_model = rock.as_ref().map(|rock| (&rock.key, derived::model_key(document, &ModelSettings::default())));
    let of_volumes: Vec<_> = volumes.iter().map(|volume| (&volume.name, &volume.key)).collect();
    let of_candidates = candidates.as_ref().map(|candidates| (candidates.data_key(), candidates.level()));
    let parts = (&geometry, of_model, packed.is_some(), of_volumes, of_candidates, Wells.key(facts)?);
    let data_key = derived::number_of(&parts);
    let key = derived::number_of(&(data_key, &functions, &functions.faults, &document.textures, document.layers()));
    Ok(Loaded { geometry, rock, picked, volumes, packed, raw: functions.raw, wells, candidates, tables, data_key, key })
}

/// Draws from what a request reads. Where that asks for samples that were not read, it is drawn from all samples instead:
/// where the rays of a picture end is known before it is drawn, but not what all of its parts look up beside them.
///
/// # Errors
/// Those of [`load`] and `draw`.
pub fn drawn<T, E: From<ProjectError>>(
    facts: Facts<'_>,
    request: &Request<'_>,
    progress: &Progress,
    mut draw: impl FnMut(&Loaded) -> Result<T, E>,
) -> Result<(T, Loaded), E> {
    let loaded = load(facts, request, progress)?;
    let made = draw(&loaded)?;
    if !loaded.has_missed() {
        return Ok((made, loaded));
    }
    // The first try makes room for the second, which finds the rock in memory.
    let _rock = loaded.rock.clone();
    drop((made, loaded));
    let extent = if let Extent::Data(_) = request.extent { Extent::Data(None) } else { Extent::Whole };
    let loaded = load(facts, &request.of(extent), progress)?;
    Ok((draw(&loaded)?, loaded))
}

/// Whether measured data hide all rock of a scene, and nothing else needs layer coordinates.
fn is_hidden(scene: &Scene, functions: &TransferFunctions) -> bool {
    let is_opaque = functions.raw.as_ref().is_some_and(|raw| raw.no_data.is_some());
    let is_plain = scene.media == Media::default() && scene.face_data == FaceData::Rock;
    scene.blend >= 1.0 && scene.lookup == Lookup::Exact && is_opaque && is_plain
}

/// The model without layer coordinates; its key is none, so that it stands for nothing else.
fn model_alone(facts: Facts<'_>, progress: &Progress) -> Result<Option<Rock>, ProjectError> {
    let Some((model, stage)) = structural_model(facts, progress)? else { return Ok(None) };
    let empty = Parameterization {
        size: model.size(),
        layers: model.layer_count(),
        blocks: model.block_count(),
        grids: Vec::new(),
        cost: ComputeCost::default(),
    };
    Ok(Some(Rock::new(model, empty, String::new(), vec![stage])))
}

/// What styles are compiled for: sizes in metres, and the names of the layers, bottom to top.
pub fn block_extent(geometry: &SurveyGeometry, rock: &Rock, names: Vec<String>) -> BlockExtent {
    let extent = solid::extent_m(geometry);
    let layer = |(name, thickness_m): (String, &f32)| LayerExtent { name, thickness_m: *thickness_m };
    BlockExtent {
        extent_i_m: extent[0] as f32,
        extent_j_m: extent[1] as f32,
        layers: names.into_iter().zip(rock.thicknesses_m(geometry)).map(layer).collect(),
        metres_per_mm: solid::metres_per_mm(geometry) as f32,
    }
}

fn sparse(picked: &[PickedShare]) -> Vec<PickedShare> {
    picked.iter().filter(|horizon| horizon.is_sparse()).cloned().collect()
}

impl Loaded {
    /// The horizons that were picked on less than half of the places where they bound a layer.
    pub fn sparse(&self) -> Vec<PickedShare> {
        sparse(&self.picked)
    }

    /// Whether everything that the volume rendering of a scene needs is loaded.
    pub fn holds_media(&self, media: &Media) -> bool {
        let knows = |name: &str| self.candidates.as_ref().is_some_and(|known| !known.leaves_of(name).is_empty());
        media.all().all(|medium| self.has_volume(&medium.volume))
            && media.horizons.iter().filter_map(|horizon| horizon.name.as_deref()).all(knows)
    }

    /// Whether samples were asked for that were not read; what was drawn then lacks them.
    pub(crate) fn has_missed(&self) -> bool {
        self.volumes.iter().any(LoadedVolume::has_missed)
    }

    fn has_volume(&self, name: &str) -> bool {
        self.volumes.iter().any(|volume| volume.name == name)
    }

    /// Completes a scene with what only the project knows: colours of raw data if it states none, and the leaves of the
    /// horizons that it names.
    pub fn complete(&self, scene: &Scene) -> Scene {
        let mut scene = Scene { raw: scene.raw.clone().or_else(|| self.raw.clone()), ..scene.clone() };
        match &self.candidates {
            Some(candidates) => candidates.complete(&mut scene),
            None => scene.media.horizons.retain(|horizon| horizon.name.is_none()),
        }
        scene.printed()
    }

    /// The volumes in the form that renderers take.
    pub fn named_volumes(&self) -> Vec<NamedVolume<'_>> {
        let named = self.volumes.iter();
        named.map(LoadedVolume::named).collect()
    }

    /// The wells in the form that renderers take.
    pub fn well_paths(&self) -> Vec<DrawnWell<'_>> {
        let named = self.wells.iter();
        named
            .map(|well| DrawnWell { name: &well.name, colour: well.colour, path: &well.path, tops: &well.tops })
            .collect()
    }

    /// The distortion of patterns on the faces that a scene shows, for each layer from the bottom.
    ///
    /// # Errors
    /// The scene cannot be drawn, or the user cancelled.
    pub fn distortion(&self, scene: &Scene, progress: &Progress) -> Result<Vec<LayerDistortion>, RenderError> {
        let (volumes, wells) = (self.named_volumes(), self.well_paths());
        distortion::measure(&self.complete(scene), &self.inputs(&volumes, &wells), progress)
    }

    /// Everything in the form that renderers take.
    pub fn inputs<'a>(&'a self, volumes: &'a [NamedVolume<'a>], wells: &'a [DrawnWell<'a>]) -> Inputs<'a> {
        Inputs {
            geometry: &self.geometry,
            model: self.rock.as_ref().map(|rock| &*rock.model),
            param: self.rock.as_ref().map(|rock| &rock.parameterization),
            packed: self.packed.as_deref(),
            tables: self.tables.as_ref(),
            volumes,
            candidates: self.candidates.as_ref().map(ShownCandidates::candidates),
            wells,
            data_key: self.data_key,
        }
    }
}
