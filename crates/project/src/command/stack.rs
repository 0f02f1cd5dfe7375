//! A stack of horizons between two: isochrons, or surfaces at equal shares of the thickness.

use super::horizon::{Age, insert_among, load_all};
use super::pick_by_time::level_sheets;
use super::{Effect, Noun, ProjectError};
use crate::derived::FaultBlocks;
use crate::document::{Chooser, Origin};
use crate::folder::Draft;
use crate::interpretation::HorizonSheets;
use crate::interpretation::times::Times;
use interp::reassembly::{VoxelSheet, to_horizon};
use serde::{Deserialize, Serialize};
use survey::{Horizon, Progress, Quality, Volume};

/// How the horizons of a stack are spaced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// At equal steps of geologic time: each is an isochron.
    #[default]
    Isochrons,
    /// At equal shares of the thickness between two horizons, on every trace.
    Proportional,
}

/// Adds a stack of horizons.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StackHorizons {
    /// Number of horizons.
    pub count: usize,
    /// The horizons above and below; `None`: isochrons over all of the survey's rock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<[String; 2]>,
    /// How they are spaced.
    #[serde(default)]
    pub spacing: Spacing,
    /// What their names begin with; a number follows.
    pub name: String,
}

/// The report of a stack.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stacked {
    /// Name of each horizon, from the top, and the share of the survey's traces that it covers.
    pub horizons: Vec<(String, f64)>,
}

impl std::fmt::Display for Stacked {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} horizons:", self.horizons.len())?;
        self.horizons.iter().try_for_each(|(name, share)| write!(f, "\n  {name}: {:.1} % of the traces", 100.0 * share))
    }
}

/// Thickness between two horizons below which there is none between them, samples.
const PINCHED: f32 = 0.2;

impl StackHorizons {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let room = model::MOST_HORIZONS.saturating_sub(draft.document.horizons.len());
        if self.count == 0 || self.count > room {
            return Err(ProjectError::StackCount { count: self.count, most: room });
        }
        if let Some(names) = &self.between {
            for name in names {
                draft.document.position(Noun::Horizon, name)?;
            }
        }
        let made = match (self.spacing, &self.between) {
            (Spacing::Isochrons, _) => self.isochrons(draft, progress)?,
            (Spacing::Proportional, Some(between)) => self.proportional(draft, between, progress)?,
            (Spacing::Proportional, None) => return Err(ProjectError::StackBetween),
        };
        let traces: usize = draft.document.frame()?.size()[..2].iter().product();
        let mut horizons = Vec::new();
        let mut others = load_all(draft, progress)?;
        for (horizon, origin) in made {
            draft.document.check_new_name(Noun::Horizon, &horizon.name)?;
            let mut covered = vec![false; traces];
            for sheet in &horizon.sheets {
                let known = sheet.depth.iter().map(|depth| depth.is_finite());
                covered.iter_mut().zip(known).for_each(|(covered, known)| *covered |= known);
            }
            insert_among(draft, &mut others, &horizon, &Age::ByDepth, origin, progress)?;
            let share = covered.iter().filter(|covered| **covered).count() as f64 / traces.max(1) as f64;
            horizons.push((horizon.name, share));
        }
        Ok(Effect::Stacked(Stacked { horizons }))
    }

    fn name(&self, n: usize) -> String {
        format!("{} {}", self.name, n + 1)
    }

    fn isochrons(&self, draft: &Draft, progress: &Progress) -> Result<Vec<(Horizon, Origin)>, ProjectError> {
        let geometry = draft.document.frame()?.clone();
        let times = Times::load(draft.facts(), progress)?;
        let blocks = draft.facts().get(&FaultBlocks, progress)?;
        let [top, base] = match &self.between {
            None => range(&times.tau),
            Some(names) => {
                let mut found = [None; 2];
                for (name, found) in names.iter().zip(&mut found) {
                    let entry = &draft.document.horizons[draft.document.position(Noun::Horizon, name)?];
                    *found = median(&draft.facts().get(&HorizonSheets(entry), progress)?, &times.tau);
                }
                found
            }
        }
        .map(|time| time.unwrap_or(f32::NAN));
        // Unknown times are refused, too.
        if top.partial_cmp(&base) != Some(std::cmp::Ordering::Less) {
            return Err(ProjectError::StackOrder { between: self.between.clone() });
        }
        let level = |n: usize| {
            let time = top + (base - top) * (n + 1) as f32 / (self.count + 1) as f32;
            let origin = Origin::Level { time, chosen_by: Chooser::Program };
            (Horizon::new(self.name(n), level_sheets(&times, time, &geometry, &blocks)), origin)
        };
        Ok((0..self.count).map(level).filter(|(horizon, _)| !horizon.sheets.is_empty()).collect())
    }

    fn proportional(
        &self,
        draft: &Draft,
        between: &[String; 2],
        progress: &Progress,
    ) -> Result<Vec<(Horizon, Origin)>, ProjectError> {
        let geometry = draft.document.frame()?.clone();
        let mut sheets = Vec::new();
        for name in between {
            let entry = &draft.document.horizons[draft.document.position(Noun::Horizon, name)?];
            sheets.push(draft.facts().get(&HorizonSheets(entry), progress)?);
        }
        let mut made = Vec::new();
        for n in 0..self.count {
            let share = (n + 1) as f32 / (self.count + 1) as f32;
            let parts = shares(&sheets[0], &sheets[1], share);
            if parts.iter().all(|sheet| sheet.nodes() == 0) {
                return Err(ProjectError::StackOrder { between: Some(between.clone()) });
            }
            let origin = Origin::Share { share, between: between.clone() };
            made.push((to_horizon(&self.name(n), &parts, &geometry), origin));
        }
        Ok(made)
    }
}

/// Times between which lie all but the first and the last hundredth of what is known.
fn range(tau: &Volume<f32>) -> [Option<f32>; 2] {
    let every = (tau.samples().len() >> 20).max(1);
    let mut known: Vec<f32> = tau.samples().iter().step_by(every).copied().filter(|time| time.is_finite()).collect();
    known.sort_by(f32::total_cmp);
    [known.len() / 100, known.len().saturating_sub(1 + known.len() / 100)].map(|n| known.get(n).copied())
}

/// The median of τ along a horizon.
fn median(sheets: &[VoxelSheet], tau: &Volume<f32>) -> Option<f32> {
    let [_, ny, nz] = tau.size();
    let nodes = sheets.iter().flat_map(|sheet| sheet.z.iter().enumerate());
    let inside = nodes.filter(|(_, z)| **z >= 0.0 && **z <= (nz - 1) as f32);
    let at = |(trace, z): (usize, &f32)| {
        let (own, low) = (tau.trace(trace / ny, trace % ny), *z as usize);
        own[low] + (z - low as f32) * (own[(low + 1).min(nz - 1)] - own[low])
    };
    let mut times: Vec<f32> = inside.map(at).filter(|time| time.is_finite()).collect();
    times.sort_by(f32::total_cmp);
    times.get(times.len() / 2).copied()
}

/// The sheets at a share of the thickness between those of two horizons, block by block.
fn shares(top: &[VoxelSheet], base: &[VoxelSheet], share: f32) -> Vec<VoxelSheet> {
    let mut made: Vec<VoxelSheet> = Vec::new();
    for upper in top {
        for lower in base.iter().filter(|lower| lower.block == upper.block) {
            let mut sheet = VoxelSheet::empty(upper.block, upper.z.len());
            for trace in 0..upper.z.len() {
                let (a, b) = (upper.z[trace], lower.z[trace]);
                // Not known compares as false.
                if b - a > PINCHED {
                    sheet.z[trace] = a + share * (b - a);
                    sheet.quality[trace] = Quality::Filled;
                }
            }
            if sheet.nodes() > 0 {
                made.push(sheet);
            }
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_the_thickness_lies_between_in_every_block_and_nowhere_else() {
        let sheet = |block: u16, z: [f32; 4]| VoxelSheet { block, z: z.to_vec(), quality: vec![Quality::Picked; 4] };
        let top = [sheet(0, [10.0, 12.0, f32::NAN, 20.0]), sheet(1, [f32::NAN, f32::NAN, 30.0, f32::NAN])];
        let base = [sheet(0, [18.0, f32::NAN, 40.0, 20.1])];
        let made = shares(&top, &base, 0.25);
        assert_eq!(made.len(), 1);
        assert_eq!((made[0].block, made[0].nodes(), made[0].z[0]), (0, 1, 12.0));
        assert_eq!(made[0].quality[0], Quality::Filled);
    }
}
