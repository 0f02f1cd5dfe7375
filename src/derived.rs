//! What is computed from a project and kept beside it, so that nothing is computed twice and nothing stale is used.
//!
//! ```text
//! derived/grids-KEY.bin           the parameterization as lookups use it (one grid per layer and fault block)
//! derived/parameterization.zarr   the same sampled on a lattice: i, j, k, layer, block, for other programs; its key inside
//! ```
//!
//! A key is the BLAKE3 hash of everything the result depends on: the version of the program, the frame, contacts, the hashes of
//! horizons and faults, and the settings. Names are not among them. What has another key is not looked at; undoing a change
//! therefore finds the earlier result again, as long as it is among the last few kept. Everything here may be deleted, and a result
//! that cannot be kept (a full disk, a read-only project) is still used.

use crate::error::ProjectError;
use crate::project::Document;
use param::{ComputeCost, ParamSettings, Parameterization, Region, RegionGrid, SheetRef, VoxelParameterization};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use survey::Progress;
use survey::model::ModelSettings;
use survey::store::{self, ParameterizationVolumes, Replacement, StoredParameterization};

/// Begins a grid file; the last byte is its version.
const MAGIC: &[u8; 8] = b"PGGRIDS\x01";
/// Parameterizations kept: the present one, and those that a few undos lead back to.
const KEPT: usize = 4;

/// Identifies a parameterization by what it is computed from.
pub fn parameterization_key(document: &Document, model: &ModelSettings, settings: &ParamSettings) -> String {
    #[derive(Serialize)]
    struct Inputs<'a> {
        program: &'static str,
        geometry: &'a Option<survey::SurveyGeometry>,
        horizons: Vec<(&'a str, survey::Contact)>,
        faults: Vec<(&'a str, Option<usize>)>,
        model: &'a ModelSettings,
        settings: &'a ParamSettings,
    }
    let ends_at = |name: &str| document.faults.iter().position(|fault| fault.name == name);
    let inputs = Inputs {
        program: env!("CARGO_PKG_VERSION"),
        geometry: &document.geometry,
        horizons: document.horizons.iter().map(|entry| (entry.hash.as_str(), entry.contact)).collect(),
        faults: document
            .faults
            .iter()
            .map(|entry| (entry.hash.as_str(), entry.truncated_by.as_deref().and_then(ends_at)))
            .collect(),
        model,
        settings,
    };
    // These types hold numbers and strings only, which always serialise.
    let text = serde_json::to_vec(&inputs).unwrap_or_default();
    blake3::hash(&text).to_hex()[..32].to_owned()
}

fn folder(root: &Path) -> PathBuf {
    root.join("derived")
}

fn grids_path(root: &Path, key: &str) -> PathBuf {
    folder(root).join(format!("grids-{key}.bin"))
}

/// The parameterization kept under `key`, if there is one that is whole.
pub fn load_grids(root: &Path, key: &str) -> Option<Parameterization> {
    read_grids(&grids_path(root, key)).ok()
}

/// Keeps a parameterization under `key`; warns when it cannot.
pub fn keep_grids(root: &Path, key: &str, parameterization: &Parameterization, progress: &Progress) {
    let path = grids_path(root, key);
    let written = Replacement::of(&path).map_err(io::Error::other).and_then(|replacement| {
        write_grids(replacement.path(), parameterization)?;
        replacement.commit().map_err(io::Error::other)
    });
    match written {
        Ok(()) => forget_old(root),
        Err(error) => progress.warn(format!("the parameterization is used but was not kept: {error}")),
    }
}

/// Removes all but the newest few grid files.
fn forget_old(root: &Path) {
    let mut files: Vec<(std::time::SystemTime, PathBuf)> = fs::read_dir(folder(root))
        .into_iter()
        .flatten()
        .filter_map(|entry| {
            let entry = entry.ok()?;
            let name = entry.file_name();
            let ours = name.to_str()?.starts_with("grids-") && name.to_str()?.ends_with(".bin");
            ours.then_some((entry.metadata().ok()?.modified().ok()?, entry.path()))
        })
        .collect();
    files.sort();
    for (_, path) in files.iter().rev().skip(KEPT) {
        // One that cannot be removed is only in the way of disk space.
        let _ = fs::remove_file(path);
    }
}

/// The fixed part of a grid file.
#[derive(Serialize, Deserialize)]
struct Header {
    size: [usize; 3],
    layers: usize,
    blocks: usize,
    grids: Vec<GridHeader>,
}

#[derive(Serialize, Deserialize)]
struct GridHeader {
    layer: u16,
    block: u16,
    origin: [i32; 2],
    size: [usize; 2],
    levels: usize,
    bottom: (Option<usize>, f32),
    top: (Option<usize>, f32),
    thickness_m: Option<f64>,
    nodes: usize,
    words: usize,
}

/// Hashes what passes through.
struct Hashing<T> {
    inner: T,
    hash: blake3::Hasher,
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.inner.write(bytes)?;
        self.hash.update(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<R: Read> Read for Hashing<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(bytes)?;
        self.hash.update(&bytes[..count]);
        Ok(count)
    }
}

/// Magic, length of the header, header (JSON), offsets and creases of each grid, and the hash of all that.
fn write_grids(path: &Path, parameterization: &Parameterization) -> io::Result<()> {
    let grid = |grid: &RegionGrid| GridHeader {
        layer: grid.region.layer,
        block: grid.region.block,
        origin: grid.origin,
        size: grid.size,
        levels: grid.levels,
        bottom: (grid.bottom.horizon, grid.bottom.shift),
        top: (grid.top.horizon, grid.top.shift),
        thickness_m: grid.thickness_m,
        nodes: grid.offsets.len(),
        words: grid.creases.len(),
    };
    let header = Header {
        size: parameterization.size,
        layers: parameterization.layers,
        blocks: parameterization.blocks,
        grids: parameterization.grids.iter().map(grid).collect(),
    };
    let header = serde_json::to_vec(&header)?;
    let mut out = Hashing { inner: BufWriter::new(File::create(path)?), hash: blake3::Hasher::new() };
    out.write_all(MAGIC)?;
    out.write_all(&(header.len() as u64).to_le_bytes())?;
    out.write_all(&header)?;
    for grid in &parameterization.grids {
        out.write_all(bytemuck::cast_slice(&grid.offsets))?;
        out.write_all(bytemuck::cast_slice(&grid.creases))?;
    }
    let hash = out.hash.finalize();
    let mut file = out.inner;
    file.write_all(hash.as_bytes())?;
    file.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

fn read_grids(path: &Path) -> io::Result<Parameterization> {
    let bad = || io::Error::from(io::ErrorKind::InvalidData);
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut input = Hashing { inner: BufReader::new(file), hash: blake3::Hasher::new() };
    let mut magic = [0u8; 8];
    input.read_exact(&mut magic)?;
    let mut count = [0u8; 8];
    input.read_exact(&mut count)?;
    let count = u64::from_le_bytes(count);
    if magic != *MAGIC || count > length {
        return Err(bad());
    }
    let mut text = vec![0u8; count as usize];
    input.read_exact(&mut text)?;
    let header: Header = serde_json::from_slice(&text)?;
    let mut grids = Vec::with_capacity(header.grids.len());
    for head in header.grids {
        // Before memory is taken for what a damaged header claims.
        if head.nodes as u64 > length / 12 || head.words as u64 > length / 8 {
            return Err(bad());
        }
        let mut offsets = vec![[0f32; 3]; head.nodes];
        input.read_exact(bytemuck::cast_slice_mut(&mut offsets))?;
        let mut creases = vec![0u64; head.words];
        input.read_exact(bytemuck::cast_slice_mut(&mut creases))?;
        grids.push(RegionGrid {
            region: Region { layer: head.layer, block: head.block },
            origin: head.origin,
            size: head.size,
            levels: head.levels,
            bottom: SheetRef { horizon: head.bottom.0, shift: head.bottom.1 },
            top: SheetRef { horizon: head.top.0, shift: head.top.1 },
            thickness_m: head.thickness_m,
            offsets,
            creases,
        });
    }
    let expected = input.hash.finalize();
    let mut found = [0u8; 32];
    input.inner.read_exact(&mut found)?;
    if expected != found {
        return Err(bad());
    }
    Ok(Parameterization {
        size: header.size,
        layers: header.layers,
        blocks: header.blocks,
        grids,
        cost: ComputeCost::default(),
    })
}

/// Where the sampled parameterization is.
pub fn volumes_path(root: &Path) -> PathBuf {
    folder(root).join("parameterization.zarr")
}

/// Writes the sampled parameterization for other programs.
///
/// # Errors
/// It could not be written; what was there before is still there.
pub fn write_volumes(
    root: &Path,
    key: &str,
    voxels: VoxelParameterization,
    progress: &Progress,
) -> Result<VoxelParameterization, ProjectError> {
    let VoxelParameterization { size, i, j, k, layer, block } = voxels;
    let volumes = ParameterizationVolumes { i, j, k, layer, block };
    store::write_parameterization(&volumes_path(root), &volumes, key, progress)?;
    let ParameterizationVolumes { i, j, k, layer, block } = volumes;
    Ok(VoxelParameterization { size, i, j, k, layer, block })
}

/// The sampled parameterization, if the one kept was computed from the same input; `size` absent takes any size.
pub fn load_volumes(
    root: &Path,
    key: &str,
    size: Option<[usize; 3]>,
    progress: &Progress,
) -> Option<VoxelParameterization> {
    let stored = StoredParameterization::open(&volumes_path(root)).ok()?;
    if stored.key() != key || size.is_some_and(|size| size != stored.size()) {
        return None;
    }
    let ParameterizationVolumes { i, j, k, layer, block } = stored.read(progress).ok()?;
    Some(VoxelParameterization { size: stored.size(), i, j, k, layer, block })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameterization() -> Parameterization {
        let grid = RegionGrid {
            region: Region { layer: 1, block: 2 },
            origin: [-3, 4],
            size: [2, 2],
            levels: 3,
            bottom: SheetRef { horizon: Some(0), shift: 0.0 },
            top: SheetRef { horizon: None, shift: -12.5 },
            thickness_m: Some(1.0 / 3.0),
            offsets: (0..12).map(|n| [n as f32, -1.5, f32::MIN_POSITIVE]).collect(),
            creases: vec![5],
        };
        Parameterization { size: [4, 5, 6], layers: 2, blocks: 3, grids: vec![grid], cost: ComputeCost::default() }
    }

    #[test]
    fn what_is_kept_comes_back_and_what_is_damaged_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let (root, wanted) = (folder.path(), parameterization());
        keep_grids(root, "aa", &wanted, &Progress::silent());
        let kept = load_grids(root, "aa").unwrap();
        assert_eq!((kept.size, kept.layers, kept.blocks), (wanted.size, wanted.layers, wanted.blocks));
        assert_eq!(kept.grids, wanted.grids);
        assert!(load_grids(root, "bb").is_none());
        let path = grids_path(root, "aa");
        let whole = fs::read(&path).unwrap();
        for at in [0, 9, 40, whole.len() / 2, whole.len() - 1] {
            let mut damaged = whole.clone();
            damaged[at] ^= 1;
            fs::write(&path, &damaged).unwrap();
            assert!(load_grids(root, "aa").is_none(), "byte {at}");
            fs::write(&path, &whole[..at]).unwrap();
            assert!(load_grids(root, "aa").is_none(), "cut at {at}");
        }
    }

    #[test]
    fn only_the_last_few_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        for n in 0..KEPT + 3 {
            keep_grids(folder.path(), &format!("{n}"), &parameterization(), &Progress::silent());
        }
        assert_eq!(fs::read_dir(super::folder(folder.path())).unwrap().count(), KEPT);
    }

    #[test]
    fn the_key_sees_what_matters_and_no_names() {
        let geometry = survey::SurveyGeometry::regular([4, 5, 6], 25.0, 4.0, survey::VerticalUnit::Milliseconds);
        let document = Document::empty(Some(geometry));
        let key =
            |document: &Document| parameterization_key(document, &ModelSettings::default(), &ParamSettings::default());
        let mut faster = document.clone();
        faster.geometry.as_mut().unwrap().velocity_m_s = 3000.0;
        assert_ne!(key(&document), key(&faster));
        let mut named = document.clone();
        named.layer_names = vec!["Rock".into()];
        assert_eq!(key(&document), key(&named));
        let settings = ParamSettings { level_spacing: 7.0, ..ParamSettings::default() };
        assert_ne!(key(&document), parameterization_key(&document, &ModelSettings::default(), &settings));
    }
}
