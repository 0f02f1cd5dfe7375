//! Loads the input of renderers from a project: reads data, builds the model, parameterizes layers and compiles styles.
//! Each step does only what is needed, and earlier results are taken from `derived/`.

use super::PickedShare;
use crate::Project;
use crate::document::{Document, volumes_within};
use crate::error::ProjectError;
use crate::interpretation::solid;
use crate::pictures::shown_candidates::ShownCandidates;
pub use crate::pictures::volumes::{LoadedSamples, LoadedVolume};
use crate::pictures::volumes::{Reading, SMALL_BYTES, read_volumes};
pub use crate::pictures::wells::{LoadedLog, LoadedWell, read_wells};
use crate::{content, derived, memory_budget, styles};
use glam::Vec3;
use model::{ModelSettings, StructuralModel};
use param::{ComputeCost, PackedVolume, Parameterization, VoxelParameterization};
use render::distortion::{self, LayerDistortion};
use render::touched::Places;
use render::{DrawnWell, FaceData, Inputs, Lookup, Media, NamedVolume, RenderError, Scene};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};
use survey::{Progress, SurveyGeometry};
use system::memory;
use ttf::{BlockExtent, LayerExtent, RawColour, TransferFunctions, TtfTables};

/// Memory that the sampled parameterization takes for each voxel: i, j, k, layer and block.
const VOXEL_BYTES: usize = 16;

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
    pub model: StructuralModel,
    /// i, j, k.
    pub parameterization: Parameterization,
    /// Key: identifies what it was computed from.
    pub key: String,
    /// The stages and their durations; empty for results that were stored before.
    pub stages: Vec<Stage>,
    /// Metres that k = 0 … 1 spans in each layer, once they were measured.
    thicknesses_m: OnceLock<Vec<f32>>,
}

impl Rock {
    /// What was computed under a key, in stages.
    pub fn new(model: StructuralModel, parameterization: Parameterization, key: String, stages: Vec<Stage>) -> Self {
        Self { model, parameterization, key, stages, thicknesses_m: OnceLock::new() }
    }
}

/// Builds the model alone, from which sections and maps are cut; `None` for a project without horizons. Warns of what
/// contradicts itself.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, or the user cancelled.
pub fn structural_model(
    project: &Project,
    progress: &Progress,
) -> Result<Option<(StructuralModel, Stage)>, ProjectError> {
    let start = Instant::now();
    let model = solid::structural_model(project.root(), project.document(), progress)?;
    let notes = model.iter().flat_map(|model| &model.report().notes);
    notes.filter(|note| note.is_contradiction()).for_each(|note| progress.warn(note.to_string()));
    Ok(model.map(|model| (model, Stage::new("model", start.elapsed()))))
}

/// Builds the model and its parameterization; `None` for a project without horizons.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, or the user cancelled.
pub fn rock(project: &Project, progress: &Progress) -> Result<Option<Rock>, ProjectError> {
    let document = project.document();
    let Some((model, stage)) = structural_model(project, progress)? else { return Ok(None) };
    let mut stages = vec![stage];
    let param_settings = solid::param_settings(document);
    let key = rock_key(document);
    solid::check_coordinates(model.size(), &param_settings)?;
    let parameterization = match derived::load_grids(project.root(), &key) {
        Some(kept) if is_of(&kept, &model) => kept,
        _ => {
            let start = Instant::now();
            let computed = match &document.parameterization {
                None => Parameterization::compute(&model, &param_settings, progress)?,
                Some(entry) => {
                    let volumes = content::read_parameterization(project.root(), entry, progress)?;
                    let arrays = derived::voxels_of(volumes);
                    Parameterization::of_volumes(&model, &arrays, &param_settings, progress)?.0
                }
            };
            stages.push(Stage::new("parameterization", start.elapsed()));
            derived::keep_grids(project.root(), &key, &computed, progress);
            computed
        }
    };
    Ok(Some(Rock::new(model, parameterization, key, stages)))
}

/// The key of the interpretation of a project's state.
fn rock_key(document: &Document) -> String {
    derived::parameterization_key(document, &ModelSettings::default(), &solid::param_settings(document))
}

/// Whether a parameterization has the size, layers and blocks of a model.
fn is_of(parameterization: &Parameterization, model: &StructuralModel) -> bool {
    let counts = (parameterization.size, parameterization.layers, parameterization.blocks);
    counts == (model.size(), model.layer_count(), model.block_count())
}

impl Rock {
    /// Whether this is the rock of a project's state.
    pub fn is_of(&self, document: &Document) -> bool {
        self.key == rock_key(document)
    }

    /// The parameterization sampled on a lattice: the stored one, otherwise sampled now.
    ///
    /// # Errors
    /// The size has no samples or does not fit into memory, or the user cancelled.
    pub fn voxels(
        &self,
        project: &Project,
        size: [usize; 3],
        progress: &Progress,
    ) -> Result<VoxelParameterization, ProjectError> {
        match derived::load_volumes(project.root(), &self.key, size, progress) {
            Some(kept) => Ok(kept),
            None => {
                memory::check("i, j and k for each voxel", &size, VOXEL_BYTES)?;
                Ok(self.parameterization.voxel_volumes(&self.model, size, progress)?)
            }
        }
    }

    /// The pairs of layers that touch in the block or follow one another in the column, as positions among the layers,
    /// youngest first. Where a scene shows the ground, the first layer is left out as air.
    pub fn neighbours(&self, scene: &Scene) -> Vec<[usize; 2]> {
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
    pub packed: Option<PackedVolume>,
    /// The volume shown as raw data and its colours.
    pub raw: Option<RawColour>,
    /// Wells, in voxels.
    pub wells: Vec<LoadedWell>,
    /// Horizon candidates, if the scene shows them or horizons in volumes.
    pub candidates: Option<ShownCandidates>,
    /// Compiled styles.
    pub tables: Option<TtfTables>,
    /// A number that no other loaded data of this process have: renderers keep what they uploaded while it stays the
    /// same.
    pub version: u64,
    /// The same of all but the styles: it stays when only `tables` and `raw` change.
    pub data_version: u64,
}

/// A number that was not given before.
pub fn new_version() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Reads and computes what `scene` needs.
///
/// # Errors
/// Data are damaged, the interpretation does not make a solid model, styles cannot be drawn, or the user cancelled.
pub fn load(project: &Project, scene: &Scene, progress: &Progress) -> Result<Loaded, ProjectError> {
    load_within(project, scene, memory_budget::half_of_available(), progress)
}

/// The same with at most this many bytes for the samples of each volume; larger volumes are read at a coarser level of
/// their pyramid, and a warning says so.
///
/// # Errors
/// As [`load`].
pub fn load_within(
    project: &Project,
    scene: &Scene,
    volume_bytes: u64,
    progress: &Progress,
) -> Result<Loaded, ProjectError> {
    load_with(project, None, scene, volume_bytes, progress)
}

/// The same where the interpretation may be known already, as while a window shows it; one of another state is not used.
///
/// # Errors
/// As [`load`].
pub fn load_with(
    project: &Project,
    known: Option<Arc<Rock>>,
    scene: &Scene,
    volume_bytes: u64,
    progress: &Progress,
) -> Result<Loaded, ProjectError> {
    load_scene(project, known, scene, (volume_bytes, Extent::Whole), progress)
}

/// What of a volume is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    Whole,
    /// Of volumes larger than this what is on faces.
    Faces {
        small_bytes: u64,
    },
}

impl Extent {
    /// What the processor needs to draw a scene once: of volumes that are larger than some, the samples on faces and ground
    /// alone, so that pictures of a volume of any size have its own resolution; and no layer coordinates where measured
    /// data hide the rock. [`Loaded::has_missed`] tells whether that was enough.
    pub(crate) const FACES: Self = Self::Faces { small_bytes: SMALL_BYTES };
}

pub(crate) fn load_scene(
    project: &Project,
    known: Option<Arc<Rock>>,
    scene: &Scene,
    (volume_bytes, extent): (u64, Extent),
    progress: &Progress,
) -> Result<Loaded, ProjectError> {
    let document = project.document();
    let geometry = document.frame()?.clone();
    let mut functions = styles::transfer_functions(document);
    if let Some(raw) = &scene.raw {
        functions.raw = Some(raw.clone());
    }
    functions = functions.printed(scene.preset);
    let rock = match known.filter(|rock| rock.is_of(document)) {
        Some(rock) => Some(rock),
        // Measured data alone need no interpretation, but outlines and ground do.
        None if extent != Extent::Whole && is_hidden(scene, &functions) => {
            model_alone(project, progress)?.map(Arc::new)
        }
        None => rock(project, progress)?.map(Arc::new),
    };
    let picked = rock.as_ref().map_or_else(Vec::new, |rock| rock.picked());
    if scene.blend < 1.0 {
        super::sparse_sentences(&sparse(&picked)).into_iter().for_each(|sentence| progress.warn(sentence));
    }
    let packed = match (&rock, scene.lookup) {
        (Some(rock), Lookup::Packed) => {
            let voxels = rock.voxels(project, geometry.size(), progress)?;
            let model = &rock.model;
            Some(PackedVolume::from_voxels(&voxels, geometry.size(), model.layer_count(), model.block_count()))
        }
        _ => None,
    };
    let tables = match &rock {
        None => None,
        Some(rock) => {
            let library = styles::pattern_library(project.root(), document)?;
            let block = block_extent(&geometry, rock, document.stratigraphy().layer_names_bottom_up());
            Some(TtfTables::compile(&functions, &block, &library)?)
        }
    };
    let mut wanted: Vec<&str> = functions.scalars.iter().map(|function| function.volume.as_str()).collect();
    if let Some(raw) = &functions.raw
        && (scene.blend > 0.0 || rock.is_none())
    {
        wanted.push(&raw.volume);
    }
    wanted.extend(volumes_within(scene));
    let model = rock.as_ref().map(|rock| &rock.model);
    let rendered: Vec<&str> = volumes_within(scene).collect();
    let (places, small_bytes) = match extent {
        Extent::Whole => (None, 0),
        Extent::Faces { small_bytes } => (Places::of(scene, &geometry, model), small_bytes),
    };
    let reading = Reading { bytes: volume_bytes, places: places.as_ref(), small_bytes, whole: &rendered };
    let volumes = read_volumes(project.root(), document, &geometry, &wanted, &reading, progress)?;
    let candidates = ShownCandidates::load(project, scene, model, progress)?;
    let wells = read_wells(project.root(), document, &geometry)?;
    Ok(Loaded {
        wells,
        candidates,
        geometry,
        rock,
        picked,
        volumes,
        packed,
        raw: functions.raw,
        tables,
        version: new_version(),
        data_version: new_version(),
    })
}

/// Whether measured data hide all rock of a scene, and nothing else needs layer coordinates.
fn is_hidden(scene: &Scene, functions: &TransferFunctions) -> bool {
    let is_opaque = functions.raw.as_ref().is_some_and(|raw| raw.no_data.is_some());
    let is_plain = scene.media == Media::default() && scene.face_data == FaceData::Rock;
    scene.blend >= 1.0 && scene.lookup == Lookup::Exact && is_opaque && is_plain
}

/// The model without layer coordinates; its key is none, so that it stands for nothing else.
fn model_alone(project: &Project, progress: &Progress) -> Result<Option<Rock>, ProjectError> {
    let Some((model, stage)) = structural_model(project, progress)? else { return Ok(None) };
    let empty = Parameterization {
        size: model.size(),
        layers: model.layer_count(),
        blocks: model.block_count(),
        grids: Vec::new(),
        cost: ComputeCost::default(),
    };
    Ok(Some(Rock::new(model, empty, String::new(), vec![stage])))
}

/// What a scene shows beyond what is loaded.
pub struct More {
    volumes: Vec<LoadedVolume>,
    candidates: Option<ShownCandidates>,
}

/// Reads the volumes and horizons that the volume rendering of `scene` needs and that are not loaded yet. The
/// model stays as it is.
///
/// # Errors
/// Data are damaged, or the user cancelled.
pub fn read_more(project: &Project, loaded: &Loaded, scene: &Scene, progress: &Progress) -> Result<More, ProjectError> {
    let document = project.document();
    let missing: Vec<&str> = volumes_within(scene).filter(|name| !loaded.has_volume(name)).collect();
    let limit = memory_budget::half_of_available();
    let reading = Reading::whole(limit);
    let volumes = read_volumes(project.root(), document, &loaded.geometry, &missing, &reading, progress)?;
    let candidates = ShownCandidates::load(project, scene, loaded.rock.as_ref().map(|rock| &rock.model), progress)?;
    Ok(More { volumes, candidates })
}

impl More {
    /// Adds the data to what is loaded.
    pub fn add_to(self, loaded: &mut Loaded) {
        loaded.volumes.extend(self.volumes);
        loaded.candidates = self.candidates;
        (loaded.version, loaded.data_version) = (new_version(), new_version());
    }
}

/// Reads what interpreting needs: the raw volume, the wells, and the part of the extraction that `scene` shows; no
/// model, whatever horizons there are.
///
/// # Errors
/// Data are damaged, or the user cancelled.
pub fn load_bare(
    project: &Project,
    scene: &Scene,
    volume_bytes: u64,
    progress: &Progress,
) -> Result<Loaded, ProjectError> {
    load_sections(project, scene, None, volume_bytes, progress)
}

/// The same, of volumes that are larger than some only the samples at these places, for a picture of sections.
///
/// # Errors
/// As [`load_bare`].
pub fn load_sections(
    project: &Project,
    scene: &Scene,
    places: Option<&Places>,
    volume_bytes: u64,
    progress: &Progress,
) -> Result<Loaded, ProjectError> {
    let rendered: Vec<&str> = volumes_within(scene).collect();
    let reading = Reading { bytes: volume_bytes, places, small_bytes: SMALL_BYTES, whole: &rendered };
    load_read(project, scene, &reading, progress)
}

pub(crate) fn load_read(
    project: &Project,
    scene: &Scene,
    reading: &Reading,
    progress: &Progress,
) -> Result<Loaded, ProjectError> {
    let document = project.document();
    let geometry = document.frame()?.clone();
    let raw = styles::transfer_functions(document).raw;
    let wanted: Vec<&str> = raw.iter().map(|raw| raw.volume.as_str()).chain(volumes_within(scene)).collect();
    Ok(Loaded {
        rock: None,
        picked: Vec::new(),
        volumes: read_volumes(project.root(), document, &geometry, &wanted, reading, progress)?,
        packed: None,
        wells: read_wells(project.root(), document, &geometry)?,
        candidates: ShownCandidates::load(project, scene, None, progress)?,
        tables: None,
        version: new_version(),
        data_version: new_version(),
        raw,
        geometry,
    })
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
    pub fn has_missed(&self) -> bool {
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
            model: self.rock.as_ref().map(|rock| &rock.model),
            param: self.rock.as_ref().map(|rock| &rock.parameterization),
            packed: self.packed.as_ref(),
            tables: self.tables.as_ref(),
            volumes,
            candidates: self.candidates.as_ref().map(ShownCandidates::candidates),
            wells,
            version: self.version,
            data_version: self.data_version,
        }
    }
}
