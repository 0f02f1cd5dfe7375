//! Horizons as the sheets that picks are made of: depths in voxels at every trace, for each fault block.

use crate::content;
use crate::derived::{FaultBlocks, blocks_key, key_of};
use crate::document::HorizonEntry;
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use interp::reassembly::{VoxelSheet, from_horizon};
use survey::Progress;

/// The sheets of a horizon.
#[derive(Debug, Clone, Copy)]
pub struct HorizonSheets<'a>(pub &'a HorizonEntry);

impl Query for HorizonSheets<'_> {
    const WHAT: &'static str = "sheets of a horizon";
    type Answer = Vec<VoxelSheet>;

    fn key(&self, facts: Facts<'_>) -> Result<String, ProjectError> {
        Ok(key_of(&(&self.0.file, &self.0.hash, blocks_key(facts.document))))
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<Vec<VoxelSheet>, ProjectError> {
        let horizon = content::read_horizon(facts.root, self.0, progress)?;
        let blocks = facts.get(&FaultBlocks, progress)?;
        Ok(from_horizon(&horizon, facts.document.frame()?, &blocks))
    }

    fn bytes(sheets: &Vec<VoxelSheet>) -> usize {
        sheets.iter().map(|sheet| size_of_val(&sheet.z[..]) + size_of_val(&sheet.quality[..])).sum()
    }
}
