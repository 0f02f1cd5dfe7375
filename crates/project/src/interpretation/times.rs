//! Geologic time as picks need it, and what of a project it obeys.
//!
//! A caller that picks by time several times holds the result of [`Times::load`], so that the next pick reads nothing.

use crate::content;
use crate::derived::{FaultBlocks, FoundFaults, blocks_key, key_of, revision};
use crate::document::{Document, HorizonEntry, Origin, VolumeEntry};
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use crate::interpretation::candidates::Candidates;
use ::time::{Cut, Interpretation, Jump, KnownHorizon, Place, Reflections};
use interp::reassembly::from_horizon;
use model::FaultNetwork;
use std::path::Path;
use std::sync::Arc;
use survey::{Contact, Progress, Quality, SurveyGeometry, Volume, Well, well::is_same_surface};
use system::memory;

/// The newest geologic time of a project, with the amplitudes, reflections and faults that picks by it need. Memory: 8
/// bytes a voxel and 20 a vertex of the candidates.
pub struct Times {
    /// τ in samples, NaN where it is not known.
    pub tau: Volume<f32>,
    /// The amplitudes that it is of.
    pub amplitudes: Volume<f32>,
    /// The vertices of all candidates.
    pub reflections: Reflections,
    /// The faults: those that are drawn, or found in the volume where none is.
    pub cuts: Vec<Cut>,
}

impl std::fmt::Debug for Times {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Times").field("size", &self.tau.size()).finish_non_exhaustive()
    }
}

/// Memory that times and reflections take for each sample while they are read.
const HELD_BYTES: usize = 20;

/// The geologic time that an entry is of.
struct TimesOf<'a>(&'a VolumeEntry);

impl Query for TimesOf<'_> {
    const WHAT: &'static str = "geologic time";
    type Answer = Times;

    fn key(&self, facts: Facts<'_>) -> Result<String, ProjectError> {
        let extraction = facts.document.extraction.as_ref().map(|entry| &entry.key);
        Ok(key_of(&(
            &self.0.file,
            &self.0.hash,
            &facts.document.amplitudes()?.hash,
            extraction,
            blocks_key(facts.document),
            revision::FOUND_FAULTS,
        )))
    }

    fn compute(&self, facts: Facts<'_>, progress: &Progress) -> Result<Times, ProjectError> {
        let frame = facts.document.frame()?;
        memory::check("geologic time and all reflections", &frame.size(), HELD_BYTES)?;
        let candidates = Candidates::load(facts, progress)?;
        let tau = content::read_volume(facts.root, self.0, frame, progress)?;
        let amplitudes = content::read_volume(facts.root, facts.document.amplitudes()?, frame, progress)?;
        let mut cuts = Cut::of_network(&*facts.get(&FaultBlocks, progress)?, tau.size());
        if cuts.is_empty() {
            cuts = match found_cuts(facts, progress) {
                Err(ProjectError::Memory(error)) => {
                    progress.warn(format!("picks by time do not know the faults that time was cut at: {error}"));
                    Vec::new()
                }
                found => found?,
            };
        }
        let reflections = Reflections::new(&candidates.forest.surfaces, &cuts);
        Ok(Times { tau, amplitudes, reflections, cuts })
    }

    fn bytes(times: &Times) -> usize {
        times.tau.samples().len() * HELD_BYTES
    }
}

/// The faults that are found in the volume, as cuts: what geologic time obeys where no fault is drawn. Those that only may
/// be faults count, too: a cut that is none is joined again by what matches across it, and by what goes round its tips.
///
/// # Errors
/// There is no volume, data are damaged, they do not fit into memory, or the user cancelled.
pub(crate) fn found_cuts(facts: Facts<'_>, progress: &Progress) -> Result<Vec<Cut>, ProjectError> {
    let size = facts.document.frame()?.size();
    let found = facts.get(&FoundFaults, progress)?;
    Ok(found.iter().map(|sheet| Cut::of_sheet(sheet, size)).collect())
}

impl Times {
    /// Geologic time of a project.
    ///
    /// # Errors
    /// [`ProjectError::NoTime`], there are no candidates, data are damaged, or the user cancelled.
    pub fn load(facts: Facts<'_>, progress: &Progress) -> Result<Arc<Self>, ProjectError> {
        facts.get(&TimesOf(time_volume(facts.document)?), progress)
    }
}

/// A top of a well inside the survey.
struct WellTop {
    name: String,
    well: usize,
    place: Place,
}

/// What of a project geologic time obeys: its faults, its picked horizons and their contacts, its wells' tops.
pub(crate) struct Obeyed {
    /// As the computation takes it.
    pub interpretation: Interpretation,
    tops: Vec<WellTop>,
}

impl Obeyed {
    /// Reads it.
    ///
    /// # Errors
    /// Data are damaged, or the user cancelled.
    pub(crate) fn load(
        root: &Path,
        document: &Document,
        network: &FaultNetwork,
        progress: &Progress,
    ) -> Result<Self, ProjectError> {
        let geometry = document.frame()?;
        let mut horizons = Vec::new();
        for entry in document.horizons.iter().filter(|entry| is_evidence(entry)) {
            let horizon = content::read_horizon(root, entry, progress)?;
            if horizon.any_shape().is_some() {
                continue;
            }
            let jump = match entry.contact {
                Contact::Erosional => Jump::Below,
                Contact::Onlap => Jump::Above,
                _ => Jump::None,
            };
            let [_, ny, nz] = geometry.size();
            let mut nodes = Vec::new();
            for sheet in from_horizon(&horizon, geometry, network) {
                let told = sheet.z.iter().zip(&sheet.quality).enumerate().filter(|(_, (z, quality))| {
                    matches!(quality, Quality::Picked | Quality::Tracked) && **z >= 0.0 && **z <= (nz - 1) as f32
                });
                nodes.extend(told.map(|(trace, (z, _))| Place { trace: [trace / ny, trace % ny], z: *z }));
            }
            horizons.push(KnownHorizon { nodes, jump });
        }
        let mut tops = Vec::new();
        for (n, entry) in document.wells.iter().enumerate() {
            tops.extend(tops_of(&content::read_well(root, entry)?, n, geometry));
        }
        let same = same_names(&tops);
        let cuts = Cut::of_network(network, geometry.size());
        Ok(Self { interpretation: Interpretation { cuts, horizons, same }, tops })
    }

    /// Pairs of tops in different wells whose order in τ is not that of a well that has both: [wrong, all].
    pub(crate) fn order(&self, tau: &Volume<f32>) -> [usize; 2] {
        let time = |top: &WellTop| {
            let [x, y] = top.place.trace;
            tau.trace(x, y)[top.place.z.round() as usize]
        };
        let younger = |a: &WellTop, b: &WellTop| {
            let above = |well: usize| {
                let find = |of: &WellTop| {
                    self.tops.iter().position(|top| top.well == well && is_same_surface(&top.name, &of.name))
                };
                Some(find(a)? < find(b)?)
            };
            above(a.well) == Some(true) || above(b.well) == Some(true)
        };
        let mut counts = [0, 0];
        for a in &self.tops {
            for b in self.tops.iter().filter(|b| b.well != a.well && !is_same_surface(&a.name, &b.name)) {
                if younger(a, b) && time(a).is_finite() && time(b).is_finite() {
                    counts[0] += usize::from(time(a) > time(b));
                    counts[1] += 1;
                }
            }
        }
        counts
    }
}

/// Whether a horizon tells more than geologic time itself did: not a level of it, and no boundary of an intrusion.
fn is_evidence(entry: &HorizonEntry) -> bool {
    !matches!(entry.origin, Origin::Level { .. }) && !entry.contact.is_intrusive()
}

/// The tops of a well inside the survey, from the top down.
fn tops_of(well: &Well, number: usize, geometry: &SurveyGeometry) -> Vec<WellTop> {
    let [nx, ny, nz] = geometry.size();
    let mut tops: Vec<_> = well.tops.iter().collect();
    tops.sort_by(|a, b| a.md_m.total_cmp(&b.md_m));
    let place = |md_m: f64| {
        let voxel = well.voxel_at_md(md_m, geometry)?;
        let inside = |at: f64, count: usize| at >= -0.5 && at.round() <= (count - 1) as f64;
        (inside(voxel.x, nx) && inside(voxel.y, ny) && voxel.z >= 0.0 && voxel.z <= (nz - 1) as f64).then(|| Place {
            trace: [voxel.x.round().max(0.0) as usize, voxel.y.round().max(0.0) as usize],
            z: voxel.z as f32,
        })
    };
    let found = tops.into_iter().filter_map(|top| Some((top.name.clone(), place(top.md_m)?)));
    found.map(|(name, place)| WellTop { name, well: number, place }).collect()
}

/// Pairs of tops of one name in a well and in the next that has it.
fn same_names(tops: &[WellTop]) -> Vec<[Place; 2]> {
    let next = |n: usize, top: &WellTop| {
        let later = tops[n + 1..].iter();
        later.filter(|other| other.well != top.well).find(|other| is_same_surface(&top.name, &other.name))
    };
    tops.iter().enumerate().filter_map(|(n, top)| Some([top.place, next(n, top)?.place])).collect()
}

/// The newest volume of geologic time.
pub(crate) fn time_volume(document: &Document) -> Result<&VolumeEntry, ProjectError> {
    document.geologic_time().ok_or(ProjectError::NoTime)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{Command, ComputeTime};
    use crate::fixture::extracted;
    use ::time::TimeSettings;
    use survey::VerticalUnit;

    #[test]
    fn picks_know_the_faults_that_time_was_cut_at_where_none_is_drawn() {
        let folder = tempfile::tempdir().unwrap();
        let quiet = Progress::silent();
        let size = [48, 40, 96];
        let geometry = SurveyGeometry::regular(size, 25.0, 10.0, VerticalUnit::Metres);
        let mut volume = Volume::filled(size, 0.0f32);
        for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
            let [x, y, z] = [n / 96 / 40, n / 96 % 40, n % 96].map(|at| at as f32);
            let t = z - 0.2 * y - if x > 22.0 + 0.3 * (z - 48.0) { 5.0 } else { 0.0 };
            *sample = (t * 0.71).sin() + 0.8 * (t * 0.43 + 1.0).sin() + 0.5 * (t * 0.93 + 2.0).cos();
        }
        let mut project = extracted(folder.path(), &geometry, &volume);
        let time = ComputeTime { name: "time".to_owned(), settings: TimeSettings::default(), memory_bytes: None };
        project.apply(&Command::Time(time), &quiet).unwrap();
        let times = Times::load(project.facts(), &quiet).unwrap();
        assert_eq!(times.cuts.len(), 1);
        assert!((times.cuts[0].at(20, 48.0) - 22.0).abs() < 2.0, "{}", times.cuts[0].at(20, 48.0));
    }

    #[test]
    fn tops_of_one_name_pair_up_and_their_order_is_checked() {
        let top = |name: &str, well: usize, x: usize, z: f32| WellTop {
            name: name.to_owned(),
            well,
            place: Place { trace: [x, 0], z },
        };
        let tops = vec![
            top("Top Chalk", 0, 0, 3.0),
            top("Base Chalk", 0, 0, 6.0),
            top("TOP_CHALK", 1, 4, 5.0),
            top("Base Chalk", 1, 4, 8.0),
            top("Salt", 1, 4, 9.0),
        ];
        let pairs = same_names(&tops);
        assert_eq!(pairs.len(), 2);
        assert_eq!(pairs[0].map(|place| place.trace[0]), [0, 4]);
        let obeyed = Obeyed { interpretation: Interpretation::default(), tops };
        let tau = |throw: f32| {
            let samples = (0..50).map(|n| (n % 10) as f32 - if n / 10 >= 3 { throw } else { 0.0 }).collect();
            Volume::from_samples([5, 1, 10], samples).unwrap()
        };
        // The second well lies two samples deeper; there are six pairs that a well orders.
        assert_eq!(obeyed.order(&tau(2.0)), [0, 4]);
        // With six samples too much its base of the chalk is younger than the first well's top.
        assert!(obeyed.order(&tau(8.0))[0] > 0);
    }
}
