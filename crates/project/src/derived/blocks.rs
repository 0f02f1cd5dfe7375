//! Storage of fault blocks: `blocks-KEY.bin`. Computing them takes longer than everything else that one pick needs.

use super::kept::{Kind, damaged, read_array, read_header, write_header};
use super::{key_of, revision};
use crate::document::Document;
use glam::{DMat3, DVec3};
use model::{BlockSignature, FaultNetwork, FaultSurface, Truncation};
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};
use std::path::Path;
use survey::{HeightField, Progress};

const BLOCKS: Kind = Kind { prefix: "blocks", magic: b"PGBLOCK\x01", what: "the fault blocks" };

/// Numbers in a fault's frame: a matrix, an offset, the spacing of its nodes.
const FRAME: usize = 13;

/// The key of a project's fault blocks: a hash of everything that they depend on.
pub fn blocks_key(document: &Document) -> String {
    #[derive(Serialize)]
    struct Inputs<'a> {
        revision: u32,
        geometry: &'a Option<survey::SurveyGeometry>,
        faults: Vec<(&'a str, String)>,
    }
    key_of(&Inputs {
        revision: revision::MODEL,
        geometry: &document.geometry,
        faults: document.faults.iter().map(|entry| (entry.name.as_str(), entry.shape())).collect(),
    })
}

/// The fault blocks stored under `key`, if there is an intact file.
pub fn load_blocks(root: &Path, key: &str) -> Option<FaultNetwork> {
    BLOCKS.load(root, key, read)
}

/// Stores fault blocks under `key`; warns if that fails.
pub fn keep_blocks(root: &Path, key: &str, blocks: &FaultNetwork, progress: &Progress) {
    BLOCKS.keep(root, key, progress, |out| write(out, blocks));
}

#[derive(Serialize, Deserialize)]
struct Header {
    faults: Vec<FaultHeader>,
    /// The side bits of each block and which of them matter.
    signatures: Vec<(u64, u64)>,
}

#[derive(Serialize, Deserialize)]
struct FaultHeader {
    name: String,
    /// The fault it ends at, and whether it lies on the positive side of that fault.
    truncation: Option<(usize, bool)>,
    origin: [i32; 2],
    size: [usize; 2],
}

fn write(out: &mut dyn Write, blocks: &FaultNetwork) -> io::Result<()> {
    write_parts(out, blocks.surfaces(), blocks.truncation(), blocks.signatures())
}

/// The header, then frame, surface and extent of each fault.
fn write_parts(
    out: &mut dyn Write,
    surfaces: &[FaultSurface],
    truncation: &[Option<Truncation>],
    signatures: &[BlockSignature],
) -> io::Result<()> {
    let faults = surfaces.iter().zip(truncation).map(|(fault, truncation)| FaultHeader {
        name: fault.name.clone(),
        truncation: truncation.map(|truncation| (truncation.by, truncation.positive)),
        origin: fault.surface.origin,
        size: fault.surface.size,
    });
    let signatures = signatures.iter().map(|block| (block.bits, block.care)).collect();
    write_header(out, &Header { faults: faults.collect(), signatures })?;
    for fault in surfaces {
        let mut frame = [fault.spacing_m; FRAME];
        frame[..9].copy_from_slice(&fault.frame_from_voxel.to_cols_array());
        frame[9..12].copy_from_slice(&fault.frame_offset.to_array());
        out.write_all(bytemuck::cast_slice(&frame))?;
        out.write_all(bytemuck::cast_slice(&fault.surface.z))?;
        out.write_all(bytemuck::cast_slice(&fault.extent.z))?;
    }
    Ok(())
}

fn read(input: &mut dyn Read, length: u64) -> io::Result<FaultNetwork> {
    let header: Header = read_header(input, length)?;
    let mut surfaces = Vec::with_capacity(header.faults.len());
    let mut truncation = Vec::with_capacity(header.faults.len());
    for FaultHeader { name, truncation: ends, origin, size } in header.faults {
        let frame: Vec<f64> = read_array(input, FRAME, length)?;
        let nodes = size[0].checked_mul(size[1]).ok_or_else(damaged)?;
        let mut field = || Ok::<_, io::Error>(HeightField { origin, size, z: read_array(input, nodes, length)? });
        surfaces.push(FaultSurface {
            name,
            frame_from_voxel: DMat3::from_cols_slice(&frame[..9]),
            frame_offset: DVec3::from_slice(&frame[9..12]),
            spacing_m: frame[12],
            surface: field()?,
            extent: field()?,
        });
        truncation.push(ends.map(|(by, positive)| Truncation { by, positive }));
    }
    let signatures = header.signatures.into_iter().map(|(bits, care)| BlockSignature { bits, care });
    FaultNetwork::of_parts(surfaces, truncation, signatures.collect()).ok_or_else(damaged)
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::fault_of_sticks;
    use glam::Vec3;
    use survey::height_field::FAR;
    use survey::{Fault, SurveyGeometry, VerticalUnit};

    fn geometry() -> SurveyGeometry {
        SurveyGeometry::regular([40, 30, 50], 25.0, 10.0, VerticalUnit::Metres)
    }

    /// A fault along the crosslines, dipping to higher inlines; a second one across that ends at it.
    fn blocks() -> FaultNetwork {
        let geometry = geometry();
        let fault = |name: &str, sticks: [[[f64; 3]; 2]; 2]| {
            let sticks = sticks.map(|stick| stick.map(|p| geometry.world_from_voxel(DVec3::from_array(p))).to_vec());
            fault_of_sticks(name, &sticks, &geometry).unwrap()
        };
        let first = fault("first", [[[15.0, 2.0, 5.0], [25.0, 2.0, 45.0]], [[15.0, 27.0, 5.0], [25.0, 27.0, 45.0]]]);
        let second =
            fault("second", [[[22.0, 14.0, 5.0], [30.0, 14.0, 45.0]], [[38.0, 16.0, 5.0], [38.0, 16.0, 45.0]]]);
        let second = Fault { truncated_by: Some("first".into()), ..second };
        FaultNetwork::build(&geometry, &[first, second], &Progress::silent()).unwrap()
    }

    #[test]
    fn blocks_come_back_as_they_were_and_damaged_ones_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let (root, wanted) = (folder.path(), blocks());
        assert_eq!(wanted.block_count(), 3);
        keep_blocks(root, "aa", &wanted, &Progress::silent());
        assert_eq!(load_blocks(root, "aa").as_ref(), Some(&wanted));
        assert!(load_blocks(root, "bb").is_none());
        let path = BLOCKS.path(root, "aa");
        let mut damaged = std::fs::read(&path).unwrap();
        let middle = damaged.len() / 2;
        damaged[middle] ^= 1;
        std::fs::write(&path, &damaged).unwrap();
        assert!(load_blocks(root, "aa").is_none());
    }

    /// Loads the blocks with their first surface changed, from a file whose hash is right.
    fn loaded_with(change: impl Fn(&mut FaultSurface)) -> Option<FaultNetwork> {
        let (folder, whole) = (tempfile::tempdir().unwrap(), blocks());
        let mut surfaces = whole.surfaces().to_vec();
        change(&mut surfaces[0]);
        BLOCKS.keep(folder.path(), "aa", &Progress::silent(), |out| {
            write_parts(out, &surfaces, whole.truncation(), whole.signatures())
        });
        load_blocks(folder.path(), "aa")
    }

    #[test]
    fn blocks_with_a_valid_hash_and_a_place_far_outside_overflow_nothing() {
        // Places that differences of 32 bits do not reach are refused.
        for far in [i32::MIN, i32::MIN + 1, -FAR - 1, FAR + 1, i32::MAX] {
            for axis in 0..2 {
                assert!(loaded_with(|fault| fault.surface.origin[axis] = far).is_none(), "axis {axis} at {far}");
            }
        }
        for wrong in [f64::NAN, f64::INFINITY] {
            assert!(loaded_with(|fault| fault.frame_offset.x = wrong).is_none());
            assert!(loaded_with(|fault| fault.frame_from_voxel.x_axis.y = wrong).is_none());
        }
        // What is taken can be asked anywhere.
        let changes: [fn(&mut FaultSurface); 5] = [
            |_| (),
            |fault| fault.surface.origin = [FAR, -FAR],
            |fault| fault.frame_offset = DVec3::splat(1e300),
            |fault| fault.frame_offset = DVec3::splat(-f64::MAX),
            |fault| fault.frame_from_voxel = DMat3::from_diagonal(DVec3::splat(f64::MAX)),
        ];
        for (n, change) in changes.into_iter().enumerate() {
            let blocks = loaded_with(change).unwrap_or_else(|| panic!("{n} was not taken"));
            for at in [0.0, 20.0, -1e9, 1e9, f32::MIN, f32::MAX] {
                for p in [Vec3::splat(at), Vec3::new(at, 0.0, 0.0), Vec3::new(0.0, -at, at)] {
                    assert!(usize::from(blocks.block_at(p)) < blocks.block_count(), "{n} at {p}");
                    let _ = (blocks.side(0, p), blocks.is_real(0, p));
                    let _ = blocks.surfaces()[0].side_gradient(p.as_dvec3());
                }
            }
        }
    }

    #[test]
    fn parts_that_do_not_go_together_are_no_blocks() {
        let whole = blocks();
        let parts = |surfaces: &[FaultSurface], truncation: &[Option<Truncation>], signatures: &[BlockSignature]| {
            FaultNetwork::of_parts(surfaces.to_vec(), truncation.to_vec(), signatures.to_vec())
        };
        let (surfaces, truncation, signatures) = (whole.surfaces(), whole.truncation(), whole.signatures());
        assert_eq!(parts(surfaces, truncation, signatures), Some(whole.clone()));
        assert!(parts(&surfaces[..1], truncation, signatures).is_none());
        assert!(parts(surfaces, truncation, &[]).is_none());
        let circle = [Some(Truncation { by: 1, positive: true }), Some(Truncation { by: 0, positive: true })];
        assert!(parts(surfaces, &circle, signatures).is_none());
        let mut cut = surfaces.to_vec();
        cut[0].surface.z.pop();
        assert!(parts(&cut, truncation, signatures).is_none());
    }

    #[test]
    fn the_key_sees_the_geometry_and_no_layer_names() {
        let geometry = geometry();
        let document = Document::empty(Some(geometry));
        let key = |document: &Document| blocks_key(document);
        let mut faster = document.clone();
        faster.geometry.as_mut().unwrap().velocity_m_s = 3000.0;
        assert_ne!(key(&document), key(&faster));
        let mut named = document.clone();
        named.layer_names = vec!["Rock".into()];
        assert_eq!(key(&document), key(&named));
    }
}
