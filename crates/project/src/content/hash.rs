//! Hashes that identify bulk data.
//!
//! A hash covers what a computation depends on, which is values and their places, and nothing else: neither names nor
//! files.

use store::{ParameterizationVolumes, StoreError, StoredVolume};
use survey::{Fault, Horizon, TriangleMesh, Well};

/// BLAKE3 hash of a volume's size, sample type, the checksums of its bricks and its live-trace mask: identifies its
/// samples without reading them.
///
/// # Errors
/// Data are missing or damaged.
pub(crate) fn hash_stored(volume: &StoredVolume) -> Result<String, StoreError> {
    let mut hash = blake3::Hasher::new();
    hash.update(bytemuck::cast_slice(&volume.size(0).map(|count| count as u64)));
    hash.update(volume.type_name().as_bytes());
    hash.update(bytemuck::cast_slice(&volume.checksums()?));
    let live: Vec<u8> = volume.live().iter().map(|live| u8::from(*live)).collect();
    hash.update(&live);
    Ok(hash.finalize().to_hex().to_string())
}

/// BLAKE3 of a horizon's sheets, or of its surface of any shape.
pub(crate) fn hash_horizon(horizon: &Horizon) -> String {
    let mut hash = blake3::Hasher::new();
    for sheet in &horizon.sheets {
        let block = sheet.block.map_or(u64::MAX, u64::from);
        let count = sheet.grid.count.map(|count| count as u64);
        hash.update(bytemuck::cast_slice(&[block, count[0], count[1]]));
        for place in [sheet.grid.origin, sheet.grid.u_step, sheet.grid.v_step] {
            hash.update(bytemuck::cast_slice(&place.to_array()));
        }
        hash.update(bytemuck::cast_slice(&sheet.depth));
        let quality: Vec<u8> = sheet.quality.iter().map(|quality| *quality as u8).collect();
        hash.update(&quality);
    }
    if let Some(mesh) = &horizon.surface {
        add_mesh(&mut hash, mesh);
    }
    hash.finalize().to_hex().to_string()
}

/// BLAKE3 of a fault's triangles.
pub fn hash_fault(fault: &Fault) -> String {
    let mut hash = blake3::Hasher::new();
    add_mesh(&mut hash, &fault.mesh);
    hash.finalize().to_hex().to_string()
}

fn add_mesh(hash: &mut blake3::Hasher, mesh: &TriangleMesh) {
    hash.update(&(mesh.vertices.len() as u64).to_le_bytes());
    for vertex in &mesh.vertices {
        hash.update(bytemuck::cast_slice(&vertex.to_array()));
    }
    hash.update(bytemuck::cast_slice(&mesh.triangles));
}

/// BLAKE3 of i, j, k, layer and block at all samples, and of how many there are along each axis.
pub(crate) fn hash_parameterization(volumes: &ParameterizationVolumes) -> String {
    let mut hash = blake3::Hasher::new();
    hash.update(bytemuck::cast_slice(&volumes.i.size().map(|count| count as u64)));
    for values in [&volumes.i, &volumes.j, &volumes.k] {
        hash.update(bytemuck::cast_slice(values.samples()));
    }
    for ids in [&volumes.layer, &volumes.block] {
        hash.update(bytemuck::cast_slice(ids.samples()));
    }
    hash.finalize().to_hex().to_string()
}

/// BLAKE3 of a well's path, tops, logs and checkshots.
///
/// # Errors
/// A value cannot be written as JSON.
pub(crate) fn hash_well(well: &Well) -> Result<String, serde_json::Error> {
    let nameless = Well { name: String::new(), ..well.clone() };
    Ok(blake3::hash(&serde_json::to_vec(&nameless)?).to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::{NodeGrid, Quality, Sheet, SurveyGeometry, VerticalUnit};
    use survey::{Progress, Volume};

    #[test]
    fn a_hash_sees_values_place_and_mask_but_not_the_name() {
        let folder = tempfile::tempdir().unwrap();
        let hash = |name: &str, volume: &Volume<f32>| {
            let path = folder.path().join(name);
            let geometry = SurveyGeometry::regular(volume.size(), 25.0, 4.0, VerticalUnit::Metres);
            store::write_volume(&path, volume, &store::VolumeInfo::of(geometry), &Progress::silent()).unwrap();
            hash_stored(&StoredVolume::open(&path).unwrap()).unwrap()
        };
        let volume = Volume::filled([2, 3, 4], 1.5f32);
        let mut masked = volume.clone();
        masked.set_live(Some(vec![true, true, true, true, true, false])).unwrap();
        let mut changed = volume.clone();
        changed.trace_mut(1, 2)[3] = 1.500_000_1;
        assert_eq!(hash("a", &volume), hash("b", &Volume::filled([2, 3, 4], 1.5)));
        assert_ne!(hash("a", &volume), hash("c", &masked));
        assert_ne!(hash("a", &volume), hash("d", &Volume::filled([3, 2, 4], 1.5)));
        assert_ne!(hash("a", &volume), hash("e", &changed));

        let grid = NodeGrid::of_survey(&SurveyGeometry::regular([2, 2, 2], 1.0, 1.0, VerticalUnit::Metres));
        let horizon = |name: &str, depth: f32, grid: NodeGrid| {
            Horizon::new(name, vec![Sheet::new(grid, vec![depth; 4], Quality::Picked)])
        };
        assert_eq!(hash_horizon(&horizon("a", 1.0, grid)), hash_horizon(&horizon("b", 1.0, grid)));
        assert_ne!(hash_horizon(&horizon("a", 1.0, grid)), hash_horizon(&horizon("a", 2.0, grid)));
        let moved = NodeGrid { origin: glam::DVec2::X, ..grid };
        assert_ne!(hash_horizon(&horizon("a", 1.0, grid)), hash_horizon(&horizon("a", 1.0, moved)));
    }
}
