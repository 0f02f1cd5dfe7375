//! Storage of the parameterization: `grids-KEY.bin` and `parameterization.zarr`.

use super::file::{Kind, damaged, read_array, read_header, write_header};
use super::{Scratch, key_of, revision};
use crate::document::Document;
use crate::error::ProjectError;
use crate::folder::storage;
use model::ModelSettings;
use param::{
    ComputeCost, ParamSettings, Parameterization, Region, RegionGrid, SheetRef, SheetSource, Unfolded, Unfolding,
    VoxelParameterization,
};
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use store::{ParameterizationVolumes, StoredParameterization};
use survey::height_field::FAR;
use survey::{HeightField, LevelField, Progress};

/// Grid files.
const GRIDS: Kind = Kind { prefix: "grids", magic: b"PGGRIDS\x03", what: "the parameterization" };

/// What a model is built of.
#[derive(Serialize)]
struct ModelInputs<'a> {
    revision: u32,
    geometry: &'a Option<survey::SurveyGeometry>,
    horizons: Vec<(&'a str, survey::Contact)>,
    faults: Vec<(&'a str, Option<usize>, f64)>,
    model: &'a ModelSettings,
}

impl<'a> ModelInputs<'a> {
    fn of(document: &'a Document, model: &'a ModelSettings) -> Self {
        let ends_at = |name: &str| document.faults.iter().position(|fault| fault.name == name);
        let faults = document.faults.iter();
        Self {
            revision: revision::MODEL,
            geometry: &document.geometry,
            horizons: document.horizons.iter().map(|entry| (entry.hash.as_str(), entry.contact)).collect(),
            faults: faults
                .map(|entry| (entry.hash.as_str(), entry.truncated_by.as_deref().and_then(ends_at), entry.grown_m))
                .collect(),
            model,
        }
    }
}

/// The key of a model: a hash of everything that it depends on.
pub(crate) fn model_key(document: &Document, model: &ModelSettings) -> String {
    key_of(&ModelInputs::of(document, model))
}

/// The key of a parameterization: a hash of everything that it depends on.
pub(crate) fn parameterization_key(document: &Document, model: &ModelSettings, settings: &ParamSettings) -> String {
    #[derive(Serialize)]
    struct Inputs<'a> {
        revision: [u32; 2],
        geometry: &'a Option<survey::SurveyGeometry>,
        horizons: Vec<(&'a str, survey::Contact)>,
        faults: Vec<(&'a str, Option<usize>, f64)>,
        model: &'a ModelSettings,
        settings: &'a ParamSettings,
        taken: Option<&'a str>,
        #[serde(skip_serializing_if = "Option::is_none")]
        told: Option<(&'a str, Option<f64>)>,
    }
    let ModelInputs { revision: of_model, geometry, horizons, faults, model } = ModelInputs::of(document, model);
    key_of(&Inputs {
        revision: [of_model, revision::PARAMETERIZATION],
        geometry,
        horizons,
        faults,
        model,
        settings,
        taken: document.parameterization.as_ref().map(|entry| entry.hash.as_str()),
        told: document.history_of_coordinates(),
    })
}

/// The parameterization stored under `key`, if there is an intact file.
pub fn load_grids(root: &Path, key: &str) -> Option<Parameterization> {
    GRIDS.load(root, key, read_grids)
}

/// Stores a parameterization under `key`; warns if that fails.
pub fn keep_grids(root: &Path, key: &str, parameterization: &Parameterization, progress: &Progress) {
    GRIDS.keep(root, key, progress, |out| write_grids(out, parameterization));
}

/// The fixed part of a grid file.
#[derive(Serialize, Deserialize)]
struct Header {
    size: [usize; 3],
    layers: usize,
    blocks: usize,
    sheets: Vec<SheetHeader>,
    /// i and j, and ln w where there is one.
    unfoldings: Vec<Vec<FieldHeader>>,
    grids: Vec<GridHeader>,
}

#[derive(Serialize, Deserialize)]
struct GridHeader {
    layer: u16,
    block: u16,
    origin: [i32; 2],
    size: [usize; 2],
    levels: usize,
    bottom: (Source, f32),
    top: (Source, f32),
    thickness_m: Option<f64>,
    nodes: usize,
    words: usize,
    /// Which of the unfoldings it has.
    unfolded: Option<usize>,
}

/// What a sheet shifts: as [`SheetSource`], a calm sheet by its index.
#[derive(Clone, Copy, Serialize, Deserialize)]
enum Source {
    Plane,
    Horizon(usize),
    Calm(usize),
}

impl Source {
    fn of(source: &SheetSource, calm: &[Arc<HeightField>]) -> Self {
        match source {
            SheetSource::Plane => Self::Plane,
            SheetSource::Horizon(horizon) => Self::Horizon(*horizon),
            SheetSource::Calm(sheet) => {
                let position = calm.iter().position(|known| Arc::ptr_eq(known, sheet));
                Self::Calm(position.unwrap_or(usize::MAX))
            }
        }
    }

    /// The sheet, if it is one of a model of so many layers or one of the file.
    fn source(self, layers: usize, calm: &[Arc<HeightField>]) -> Option<SheetSource> {
        match self {
            Self::Plane => Some(SheetSource::Plane),
            Self::Horizon(horizon) => (horizon.checked_add(1)? < layers).then_some(SheetSource::Horizon(horizon)),
            Self::Calm(index) => Some(SheetSource::Calm(Arc::clone(calm.get(index)?))),
        }
    }
}

/// The lattice of a calm sheet.
#[derive(Serialize, Deserialize)]
struct SheetHeader {
    origin: [i32; 2],
    size: [usize; 2],
}

impl SheetHeader {
    /// The count of nodes, if surfaces can be evaluated on them.
    fn nodes(&self) -> Option<usize> {
        let is_sound = self.size.iter().all(|&count| count >= 2)
            && self.origin.iter().all(|&first| first.checked_abs().is_some_and(|first| first < FAR));
        let nodes = self.size[0].checked_mul(self.size[1])?;
        (is_sound && nodes < FAR as usize).then_some(nodes)
    }
}

/// The nodes of a field of an unfolding.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct FieldHeader {
    origin: [f32; 3],
    step: [f32; 3],
    size: [usize; 3],
}

impl FieldHeader {
    fn of(field: &LevelField) -> Self {
        Self { origin: field.origin.to_array(), step: field.step.to_array(), size: field.size }
    }

    /// The field, if it can be evaluated.
    fn read(self, input: &mut dyn Read, length: u64) -> io::Result<LevelField> {
        let is_place = self.origin.iter().chain(&self.step).all(|c| c.is_finite() && c.abs() < FAR as f32);
        let is_sound =
            is_place && self.step.iter().all(|&step| step > 0.0) && self.size.iter().all(|&count| count >= 2);
        let nodes = self.size[0].checked_mul(self.size[1]).and_then(|nodes| nodes.checked_mul(self.size[2]));
        let values: Vec<f32> = read_array(input, nodes.filter(|_| is_sound).ok_or_else(damaged)?, length)?;
        if !values.iter().all(|value| value.is_finite()) {
            return Err(damaged());
        }
        Ok(LevelField { origin: self.origin.into(), step: self.step.into(), size: self.size, values })
    }
}

impl GridHeader {
    /// Whether this is the grid at an index of so many layers for each block, with as many nodes as its counts say:
    /// everything that looks nodes up relies on it.
    fn is_sound(&self, index: usize, layers: usize) -> bool {
        let is_place = [index % layers, index / layers] == [usize::from(self.layer), usize::from(self.block)];
        let columns = self.size[0].checked_mul(self.size[1]);
        let nodes = columns.and_then(|columns| columns.checked_mul(self.levels));
        let is_counted = nodes == Some(self.nodes) && self.words == self.nodes.div_ceil(64);
        let has_cells = self.nodes == 0 || (self.size.iter().all(|&count| count >= 2) && self.levels >= 3);
        is_place && is_counted && has_cells
    }
}

/// The header, then the calm sheets, the unfoldings, then offsets and creases of each grid.
fn write_grids(out: &mut dyn Write, parameterization: &Parameterization) -> io::Result<()> {
    let (calm, unfoldings) = (parameterization.calm_sheets(), parameterization.unfoldings());
    let grid = |grid: &RegionGrid| GridHeader {
        layer: grid.region.layer,
        block: grid.region.block,
        origin: grid.origin,
        size: grid.size,
        levels: grid.levels,
        bottom: (Source::of(&grid.bottom.of, &calm), grid.bottom.shift),
        top: (Source::of(&grid.top.of, &calm), grid.top.shift),
        thickness_m: grid.thickness_m,
        nodes: grid.offsets.len(),
        words: grid.creases.len(),
        unfolded: grid.unfolded.as_ref().map(|own| {
            let position = unfoldings.iter().position(|known| Arc::ptr_eq(known, own));
            position.unwrap_or(usize::MAX)
        }),
    };
    let header = Header {
        size: parameterization.size,
        layers: parameterization.layers,
        blocks: parameterization.blocks,
        sheets: calm.iter().map(|sheet| SheetHeader { origin: sheet.origin, size: sheet.size }).collect(),
        unfoldings: unfoldings.iter().map(|own| own.fields().map(FieldHeader::of).collect()).collect(),
        grids: parameterization.grids.iter().map(grid).collect(),
    };
    write_header(out, &header)?;
    for sheet in &calm {
        out.write_all(bytemuck::cast_slice(&sheet.z))?;
    }
    for field in unfoldings.iter().flat_map(|own| own.fields()) {
        out.write_all(bytemuck::cast_slice(&field.values))?;
    }
    for grid in &parameterization.grids {
        out.write_all(bytemuck::cast_slice(&grid.offsets))?;
        out.write_all(bytemuck::cast_slice(&grid.creases))?;
    }
    Ok(())
}

fn read_grids(input: &mut dyn Read, length: u64) -> io::Result<Parameterization> {
    let header: Header = read_header(input, length)?;
    if header.layers.checked_mul(header.blocks) != Some(header.grids.len()) {
        return Err(damaged());
    }
    let mut calm = Vec::new();
    for sheet in header.sheets {
        let nodes = sheet.nodes().ok_or_else(damaged)?;
        let z: Vec<f32> = read_array(input, nodes, length)?;
        if !z.iter().all(|z| z.is_finite()) {
            return Err(damaged());
        }
        calm.push(Arc::new(HeightField { origin: sheet.origin, size: sheet.size, z }));
    }
    let mut unfoldings: Vec<Unfolding> = Vec::new();
    for heads in header.unfoldings {
        if !(2..=3).contains(&heads.len()) {
            return Err(damaged());
        }
        let mut fields = heads.into_iter().map(|head| head.read(input, length)).collect::<io::Result<Vec<_>>>()?;
        let log_weight = (fields.len() == 3).then(|| fields.pop()).flatten();
        let places = fields.try_into().map_err(|_| damaged())?;
        unfoldings.push(Arc::new(Unfolded { places, log_weight }));
    }
    let sheet = |(source, shift): (Source, f32)| {
        let of = source.source(header.layers, &calm).ok_or_else(damaged)?;
        Ok::<_, io::Error>(SheetRef { of, shift })
    };
    let mut grids = Vec::with_capacity(header.grids.len());
    for (index, head) in header.grids.into_iter().enumerate() {
        if !head.is_sound(index, header.layers) {
            return Err(damaged());
        }
        grids.push(RegionGrid {
            region: Region { layer: head.layer, block: head.block },
            origin: head.origin,
            size: head.size,
            levels: head.levels,
            bottom: sheet(head.bottom)?,
            top: sheet(head.top)?,
            thickness_m: head.thickness_m,
            offsets: read_array(input, head.nodes, length)?,
            creases: read_array(input, head.words, length)?,
            unfolded: match head.unfolded {
                Some(n) => Some(unfoldings.get(n).cloned().ok_or_else(damaged)?),
                None => None,
            },
        });
    }
    Ok(Parameterization {
        size: header.size,
        layers: header.layers,
        blocks: header.blocks,
        grids,
        cost: ComputeCost::default(),
    })
}

/// The sampled parameterization, in `derived/`.
const VOLUMES: &str = "parameterization.zarr";

/// Its path.
pub fn volumes_path(root: &Path) -> PathBuf {
    root.join(storage::DERIVED).join(VOLUMES)
}

/// Keeps the sampled parameterization that `write` writes into the folder it is given, for other programs.
///
/// # Errors
/// It could not be written; an earlier one is then still there.
pub(crate) fn keep_volumes(
    root: &Path,
    write: impl FnOnce(&Path) -> Result<(), ProjectError>,
) -> Result<(), ProjectError> {
    let scratch = Scratch::begin(root)?;
    write(&scratch.path(VOLUMES))?;
    scratch.publish(VOLUMES)
}

/// Whether the sampled parameterization of this size and input is there, intact.
pub fn holds_volumes(root: &Path, key: &str, size: [usize; 3], progress: &Progress) -> bool {
    StoredParameterization::open(&volumes_path(root))
        .is_ok_and(|stored| stored.key() == key && stored.size() == size && stored.verify(progress).is_ok())
}

/// Arrays that were read, as the sampled parameterization.
pub(crate) fn voxels_of(volumes: ParameterizationVolumes) -> VoxelParameterization {
    let ParameterizationVolumes { i, j, k, layer, block } = volumes;
    VoxelParameterization { size: i.size(), i, j, k, layer, block }
}

/// The sampled parameterization of this size, if the stored one was computed from the same input.
pub(crate) fn load_volumes(
    root: &Path,
    key: &str,
    size: [usize; 3],
    progress: &Progress,
) -> Option<VoxelParameterization> {
    let stored = StoredParameterization::open(&volumes_path(root)).ok()?;
    if stored.key() != key || size != stored.size() {
        return None;
    }
    Some(voxels_of(stored.read(progress).ok()?))
}

#[cfg(test)]
mod tests;
