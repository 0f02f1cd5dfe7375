//! Geologic time as a volume of the project.

use super::time_slabs::{SlabTimes, TimeSlabs, explain};
use super::{Effect, Noun, ProjectError};
use crate::content::volume_facts::{self, Facts};
use crate::document::{Origin, Polarity};
use crate::folder::Draft;
use crate::memory_budget;
use ::time::{Jump, Slabs, TimeSettings};
use serde::{Deserialize, Serialize};
use survey::Progress;

/// Computes geologic time from the present extraction, its volume and the interpretation (faults, picked horizons,
/// unconformities, tops of wells), and adds it to the project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComputeTime {
    /// Name of the new volume.
    pub name: String,
    /// The settings.
    #[serde(default)]
    pub settings: TimeSettings,
    /// Memory to use beside the candidates of a slab, bytes; `None`: half of what is available. A survey that needs more is solved in
    /// slabs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_bytes: Option<u64>,
}

/// The report of computed geologic time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeComputed {
    /// The new volume.
    pub volume: String,
    /// The volume of amplitudes.
    pub of: String,
    /// Number of drawn faults that cut it.
    pub faults: usize,
    /// Number of faults that were found, where none is drawn, and cut it.
    pub found: usize,
    /// Number of picked horizons that have one time each.
    pub horizons: usize,
    /// Number of those at which time jumps: unconformities.
    pub unconformities: usize,
    /// Number of pairs of tops of one name in two wells that were taken to have one time.
    pub tops: usize,
    /// Pairs of tops in two wells whose order in time is not that of a well that has both, and all such pairs.
    pub tops_out_of_order: [usize; 2],
    /// Number of slabs of inlines in which it was solved.
    pub slabs: usize,
    /// Share of the voxels at which time is known, 0 to 1.
    pub known: f64,
}

impl std::fmt::Display for TimeComputed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { volume, of, faults, found, horizons, unconformities, tops, tops_out_of_order, slabs, known } = self;
        let (faults, what) = if *faults > 0 { (faults, "drawn") } else { (found, "found") };
        write!(
            f,
            "volume '{volume}': geologic time of '{of}' across {faults} faults that were {what}, known at {:.1} % of the voxels",
            100.0 * known
        )?;
        if *known == 0.0 {
            write!(f, "; there are no candidates to find it from")?;
        }
        if *horizons > 0 {
            write!(f, "; one time on each of {horizons} picked horizons")?;
        }
        if *unconformities > 0 {
            write!(f, ", at {unconformities} of which it jumps")?;
        }
        if *tops > 0 {
            write!(f, "; {tops} pairs of tops in wells have one time")?;
        }
        let [wrong, all] = tops_out_of_order;
        if *wrong > 0 {
            write!(f, "; {wrong} of {all} pairs of tops lie in the wrong order")?;
        }
        if *slabs > 1 {
            write!(f, "; in {slabs} slabs")?;
        }
        Ok(())
    }
}

impl ComputeTime {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        draft.document.check_new_name(Noun::Volume, &self.name)?;
        let memory = self.memory_bytes.unwrap_or_else(memory_budget::half_of_available);
        let least = Slabs::least_bytes(draft.document.frame()?.size());
        if self.memory_bytes.is_some_and(|stated| stated < least) {
            progress.warn(format!(
                "geologic time takes some {} MB: the narrowest slab that can be solved is more than the memory that was stated",
                least >> 20
            ));
        }
        let slabs = TimeSlabs::open(draft.root(), &draft.document, &self.settings, memory, progress)?;
        let (file, path) = draft.generation("volumes", &self.name, "zarr")?;
        let (info, from) = (slabs.info(), &slabs.from);
        let (found, known, tops_out_of_order);
        if slabs.ranges().len() == 1 {
            let tau;
            (tau, found) = slabs.solve(0, progress)?;
            known = tau.samples().iter().filter(|time| time.is_finite()).count();
            tops_out_of_order = slabs.obeyed.order(&tau);
            store::write_volume(&path, &tau, &info, progress)?;
        } else {
            let mut times = SlabTimes::new(&slabs);
            store::write_blocks(&path, &mut times, &info, memory / 8, progress).map_err(explain)?;
            (found, known, tops_out_of_order) = (times.found, times.known, [0, 0]);
        }
        let facts = Facts {
            name: self.name.clone(),
            file,
            polarity: Polarity::default(),
            origin: Origin::GeologicTime { of: from.name.clone() },
            geometry: None,
        };
        draft.document.volumes.push(volume_facts::entry(&path, facts, progress)?);
        let told = &slabs.obeyed.interpretation;
        Ok(Effect::TimeComputed(TimeComputed {
            volume: self.name.clone(),
            of: from.name.clone(),
            faults: told.cuts.len(),
            found,
            horizons: told.horizons.len(),
            unconformities: told.horizons.iter().filter(|known| known.jump != Jump::None).count(),
            tops: told.same.len(),
            tops_out_of_order,
            slabs: slabs.ranges().len(),
            known: known as f64 / info.geometry.size().iter().product::<usize>() as f64,
        }))
    }
}
