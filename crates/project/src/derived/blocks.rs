//! The fault blocks, stored as `blocks-KEY.bin`: computing them takes longer than everything else that one pick needs.

use super::file::{Kind, damaged, read_array, read_header, write_header};
use super::{key_of, revision};
use crate::content;
use crate::document::Document;
use crate::error::{Noun, ProjectError};
use crate::facts::{Facts, Query};
use glam::{DMat3, DVec3};
use model::{BlockSignature, FaultNetwork, FaultSurface, Truncation};
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};
use std::path::Path;
use survey::{HeightField, Progress};

const BLOCKS: Kind = Kind { prefix: "blocks", magic: b"PGBLOCK\x02", what: "the fault blocks" };

/// Numbers in a fault's frame: a matrix, an offset, the spacing of its nodes.
const FRAME: usize = 13;

/// The fault blocks of a project.
#[derive(Debug, Clone, Copy)]
pub struct FaultBlocks;

impl Query for FaultBlocks {
    const WHAT: &'static str = "fault blocks";
    type Answer = FaultNetwork;

    fn key(&self, Facts { document, .. }: Facts<'_>) -> Result<String, ProjectError> {
        Ok(key_of(&(blocks_key(document), document.names(Noun::Fault))))
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<FaultNetwork, ProjectError> {
        let Facts { root, document } = facts;
        if document.faults.is_empty() {
            return Ok(FaultNetwork::none());
        }
        let faults = document.faults.iter().map(|entry| content::read_fault(root, entry));
        let faults = faults.collect::<Result<Vec<_>, _>>()?;
        let key = blocks_key(document);
        if let Some(blocks) = load_blocks(root, &key) {
            return Ok(blocks.named(document.names(Noun::Fault)));
        }
        let blocks = FaultNetwork::build(document.frame()?, &faults, progress)?;
        keep_blocks(root, &key, &blocks, progress);
        Ok(blocks)
    }

    fn bytes(blocks: &FaultNetwork) -> usize {
        blocks.surfaces().iter().map(|fault| size_of_val(&fault.surface.z[..]) + size_of_val(&fault.extent.z[..])).sum()
    }
}

/// A hash of everything that fault blocks depend on but the names that they call their faults by, with which they are not
/// stored.
pub(crate) fn blocks_key(document: &Document) -> String {
    #[derive(Serialize)]
    struct Inputs<'a> {
        revision: u32,
        geometry: &'a Option<survey::SurveyGeometry>,
        faults: Vec<String>,
    }
    key_of(&Inputs { revision: revision::MODEL, geometry: &document.geometry, faults: document.fault_shapes() })
}

/// The fault blocks that are stored under a key in the project at `root`, without names, if that file is intact.
pub fn load_blocks(root: &Path, key: &str) -> Option<FaultNetwork> {
    BLOCKS.load(root, key, read)
}

/// Stores fault blocks under a key in the project at `root`. A failure is told, and costs only time later.
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
    for FaultHeader { truncation: ends, origin, size } in header.faults {
        let frame: Vec<f64> = read_array(input, FRAME, length)?;
        let nodes = size[0].checked_mul(size[1]).ok_or_else(damaged)?;
        let mut field = || Ok::<_, io::Error>(HeightField { origin, size, z: read_array(input, nodes, length)? });
        surfaces.push(FaultSurface {
            name: String::new(),
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
mod tests;
