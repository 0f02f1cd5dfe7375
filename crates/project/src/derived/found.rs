//! The faults that are found in the volume, with those that only may be ones, stored as `found-faults-KEY.bin`: geologic
//! time is cut at them where none is drawn, and picks by it have to know the same ones.

use super::file::{Kind, damaged, read_array, read_header, write_header};
use super::{key_of, revision};
use crate::content;
use crate::document::Document;
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use ::faults::{Frame, Sheet};
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};
use survey::Progress;
use system::memory;

const FOUND: Kind = Kind { prefix: "found-faults", magic: b"PGFOUND\x01", what: "the faults that were found" };

/// Memory that finding faults takes for each sample with the volume, bytes.
pub(crate) const FINDING_BYTES: usize = faults::BYTES_A_VOXEL + size_of::<f32>();

/// The faults that are found in the volume of amplitudes, whatever is drawn.
#[derive(Debug, Clone, Copy)]
pub struct FoundFaults;

impl Query for FoundFaults {
    const WHAT: &'static str = "faults found in the volume";
    type Answer = Vec<Sheet>;

    fn key(&self, Facts { document, .. }: Facts<'_>) -> Result<String, ProjectError> {
        found_key(document)
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<Self::Answer, ProjectError> {
        let Facts { root, document } = facts;
        let (key, geometry) = (found_key(document)?, document.frame()?);
        let entry = document.amplitudes()?;
        // Its hash is compared, by which what is stored was found.
        content::open_recorded(root, entry, geometry)?;
        if let Some(known) = FOUND.load(root, &key, read) {
            return Ok(known);
        }
        memory::check("finding faults", &geometry.size(), FINDING_BYTES)?;
        let seismic = content::read_volume(root, entry, geometry, progress)?;
        let found = faults::find(&seismic, geometry, progress)?;
        let found: Vec<Sheet> = found.into_iter().map(|fault| fault.sheet).collect();
        FOUND.keep(root, &key, progress, |out| write(out, &found));
        Ok(found)
    }

    fn bytes(found: &Self::Answer) -> usize {
        found.iter().map(|sheet| size_of_val(&sheet.height[..]) + sheet.there.len()).sum()
    }
}

fn found_key(document: &Document) -> Result<String, ProjectError> {
    Ok(key_of(&(revision::FOUND_FAULTS, document.frame()?, &document.amplitudes()?.hash)))
}

#[derive(Serialize, Deserialize)]
struct Header {
    origin: [f32; 2],
    along: [f32; 2],
    across: [f32; 2],
    low: [i32; 2],
    cells: [usize; 2],
}

/// The headers, then heights of each and where it is.
fn write(out: &mut dyn Write, found: &[Sheet]) -> io::Result<()> {
    let header = |sheet: &Sheet| {
        let Frame { origin, along, across } = sheet.frame;
        Header { origin, along, across, low: sheet.low, cells: sheet.cells }
    };
    write_header(out, &found.iter().map(header).collect::<Vec<_>>())?;
    for sheet in found {
        out.write_all(bytemuck::cast_slice(&sheet.height))?;
        out.write_all(&sheet.there.iter().map(|there| u8::from(*there)).collect::<Vec<_>>())?;
    }
    Ok(())
}

fn read(input: &mut dyn Read, length: u64) -> io::Result<Vec<Sheet>> {
    let headers: Vec<Header> = read_header(input, length)?;
    let fault = |Header { origin, along, across, low, cells }| {
        let count = cells[0].checked_mul(cells[1]).filter(|count| *count > 0).ok_or_else(damaged)?;
        let height = read_array(input, count, length)?;
        let there: Vec<u8> = read_array(input, count, length)?;
        let there = there.into_iter().map(|there| there != 0).collect();
        Ok(Sheet { frame: Frame { origin, along, across }, low, cells, height, there })
    };
    headers.into_iter().map(fault).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn found_faults_are_read_as_they_were_stored_and_not_when_cut_short() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join(crate::folder::storage::DERIVED)).unwrap();
        let sheet = Sheet {
            frame: Frame { origin: [3.5, 4.5], along: [0.6, 0.8], across: [-0.8, 0.6] },
            low: [-2, 3],
            cells: [2, 3],
            height: vec![0.5, -1.0, 2.0, 0.0, 7.25, 1.0],
            there: vec![true, false, true, true, true, false],
        };
        let found = vec![sheet.clone(), Sheet { low: [0, 0], ..sheet }];
        FOUND.keep(folder.path(), "key", &Progress::silent(), |out| write(out, &found));
        assert_eq!(FOUND.load(folder.path(), "key", read), Some(found));
        let path = FOUND.path(folder.path(), "key");
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 3]).unwrap();
        assert_eq!(FOUND.load(folder.path(), "key", read), None);
        assert_eq!(FOUND.load(folder.path(), "other", read), None);
    }
}
