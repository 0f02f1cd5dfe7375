//! Fault surfaces measured in a raw volume, before there is any horizon.
//!
//! ```text
//! likelihood ── ridges ── seeds, linked ── grown sheets ── offsets ──► evidence
//! ```
//!
//! A fault is where both sides match again after one shift, while beds just beside it need none. The likelihood
//! ([`attribute::likelihood()`]) tells where to look. What its ridges join to is grown into a surface as far as a shift
//! betters the match of its two sides, and the [`Offsets`] of the whole surface tell faults from noise, channels, folds and
//! unconformities: these have no shift that holds over a surface, or beds beside them match no better than beds across.
//!
//! Space: voxels.

mod cuts;
mod grow;
mod proposal;
mod ridges;
mod seeds;
mod sheet;
mod sides;
mod throws;

#[cfg(test)]
mod tests;

pub use proposal::proposals;
pub use sheet::{Frame, Sheet};
pub use throws::{CellOffset, Offsets};

use attribute::blocks::AttributeBlocks;
use attribute::likelihood::ROW;
use attribute::{AttributeError, DipVolumes, likelihood, slopes};
use ridges::Ridge;
use sides::Sides;
use survey::source::BoxSource;
use survey::{Progress, SurveyGeometry, TriangleMesh, Volume};

/// Greatest throw that is looked for, samples.
const GREATEST_THROW: i32 = 20;
/// Least evidence of a fault, and of what may be one.
const ACCEPTED: f32 = 0.08;
const POSSIBLE: f32 = 0.045;
/// Least throw of a fault, samples, on half of its surface, or on a tenth of it where it dies out: slopes that are off, as
/// between two faults whose walls are dragged, pass for a smaller one.
const LEAST_THROW: [f32; 2] = [2.5, 3.5];
/// Least area, traces times samples.
const AREA: f32 = 400.0;
/// Traces by samples, or by those of a thinner volume, of a surface whose evidence counts as it is: that of a smaller one counts
/// less, since it passes by chance more easily, that of a larger one more, by the square root, up to this share.
const SURE: [f32; 2] = [40.0, 100.0];
const LARGEST: f32 = 4.0;
/// Memory that finding faults takes for each sample beside the volume, bytes: slopes, the likelihood, its ridges.
pub const BYTES_A_VOXEL: usize = 28;

/// A surface that was found, with what its two sides tell.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultSurface {
    /// Where it is.
    pub sheet: Sheet,
    /// Its throws.
    pub offsets: Offsets,
    /// How sure it is that it is a fault, 0 to 1.
    pub evidence: f32,
}

impl FaultSurface {
    fn new(sheet: Sheet, offsets: Offsets, samples: usize) -> Self {
        let sure = SURE[0] * SURE[1].min(samples as f32);
        let evidence = offsets.evidence() * (sheet.area() / sure).min(LARGEST).sqrt();
        Self { sheet, offsets, evidence: evidence.min(1.0) }
    }

    /// Whether it is a fault by all that was measured.
    pub fn is_accepted(&self) -> bool {
        let [half, tenth] = LEAST_THROW;
        let is_offset = self.offsets.median.abs() >= half || self.offsets.upper_decile >= tenth;
        self.evidence >= ACCEPTED && is_offset
    }

    /// Whether it may be one.
    pub fn is_possible(&self) -> bool {
        self.evidence >= POSSIBLE
    }

    /// Whether its hanging wall has moved up.
    pub fn is_reverse(&self) -> bool {
        // The hanging wall is the side towards which the surface leans with depth.
        (self.offsets.median > 0.0) != (self.sheet.lean() > 0.0)
    }
}

/// Finds the surfaces of a volume that may be faults, in the order in which they were grown: those of most seeds first.
///
/// The volume may be a part of the survey that has this geometry. The result does not depend on the number of threads.
/// Memory: [`BYTES_A_VOXEL`].
///
/// # Errors
/// [`AttributeError::Cancelled`].
pub fn find(
    volume: &Volume<f32>,
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<Vec<FaultSurface>, AttributeError> {
    search(volume, geometry, |_, _, _| (), progress).map(|(faults, ())| faults)
}

/// As [`find`], with the *cuts* beside the faults: surfaces on which beds end, while no throw makes both sides match. They may
/// be faults of great throw, or boundaries of rock; their evidence is 0.
///
/// # Errors
/// [`AttributeError::Cancelled`].
pub fn find_with_cuts(
    volume: &Volume<f32>,
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<[Vec<FaultSurface>; 2], AttributeError> {
    let cuts =
        |sides: Sides<'_>, ridges: &[Ridge], faults: &[FaultSurface]| cuts::cuts(sides, ridges, faults, GREATEST_THROW);
    search(volume, geometry, cuts, progress).map(|(faults, cuts)| [faults, cuts])
}

/// Finds faults, and what `more` makes of the ridges beside them.
fn search<T: Default>(
    volume: &Volume<f32>,
    geometry: &SurveyGeometry,
    more: impl Fn(Sides<'_>, &[Ridge], &[FaultSurface]) -> T,
    progress: &Progress,
) -> Result<(Vec<FaultSurface>, T), AttributeError> {
    let [nx, ny, nz] = volume.size();
    if nx.min(ny) < 16 || nz < 16 {
        return Ok((Vec::new(), T::default()));
    }
    let slopes = slopes(volume, progress)?;
    let ridges = ridges::ridges(&likelihood(volume, &slopes, geometry, progress)?);
    let sides = Sides { volume, slopes: &slopes, off: sides::NEAR };
    let seeds = seeds::seeds(sides, &ridges, GREATEST_THROW, progress)?;
    let groups = seeds::linked(&ridges, &seeds);
    let mut is_free = vec![true; ridges.len()];
    let mut all = Vec::new();
    progress.begin("fault surfaces", groups.len() as u64);
    for group in &groups {
        progress.step(1)?;
        let Some((sheet, offsets, members)) = grow::grown(sides, &ridges, &is_free, &seeds, group, GREATEST_THROW)
        else {
            continue;
        };
        if sheet.area() < AREA {
            continue;
        }
        members.iter().for_each(|&n| is_free[n] = false);
        all.push(FaultSurface::new(sheet, offsets, volume.size()[2]));
    }
    all.retain(FaultSurface::is_possible);
    let more = more(sides, &ridges, &all);
    Ok((all, more))
}

/// The throw where a ridge of the fault likelihood has one, samples: positive of normal faults, whose hanging wall lies
/// deeper, negative of reverse ones; NaN elsewhere. Each is measured on its own plane, without a surface.
///
/// # Errors
/// [`AttributeError::Cancelled`].
pub fn throw(
    volume: &Volume<f32>,
    geometry: &SurveyGeometry,
    progress: &Progress,
) -> Result<Volume<f32>, AttributeError> {
    let [nx, ny, nz] = volume.size();
    let slopes = slopes(volume, progress)?;
    let ridges = ridges::ridges(&likelihood(volume, &slopes, geometry, progress)?);
    let seeds = seeds::all(Sides { volume, slopes: &slopes, off: sides::NEAR }, &ridges, GREATEST_THROW, progress)?;
    let mut out = Volume::filled([nx, ny, nz], f32::NAN);
    for seed in seeds {
        let Ridge { at: [x, y, z], plane, .. } = ridges[seed.ridge];
        let (x, y, z) = (x.round() as usize, y.round() as usize, z as usize);
        let throw = if plane.run < 0.0 { -seed.throw } else { seed.throw };
        out.trace_mut(x.min(nx - 1), y.min(ny - 1))[z..(z + ROW).min(nz)].fill(throw);
    }
    // The mask fits: it is that of a volume of this size.
    let _ = out.set_live(volume.live().map(<[bool]>::to_vec));
    Ok(out)
}

/// Lines beyond a box that the throws in it depend on.
pub fn throw_reach(geometry: &SurveyGeometry) -> usize {
    likelihood::reach(geometry) + 2 + seeds::reach(geometry, GREATEST_THROW)
}

/// The throws of a volume of any size, block by block; `geometry` is that of the survey.
pub fn throw_blocks<'a>(source: &'a dyn BoxSource, geometry: &'a SurveyGeometry) -> AttributeBlocks<'a> {
    attribute::blocks::computed(source, throw_reach(geometry), |volume, quiet| throw(volume, geometry, quiet))
}

/// Measures surfaces that come from elsewhere, each a mesh in world coordinates; `None` where one lies outside the volume or
/// is too small to tell.
///
/// # Errors
/// [`AttributeError::Cancelled`].
pub fn measure(
    volume: &Volume<f32>,
    slopes: &DipVolumes,
    geometry: &SurveyGeometry,
    meshes: &[&TriangleMesh],
    progress: &Progress,
) -> Result<Vec<Option<FaultSurface>>, AttributeError> {
    progress.begin("measuring faults", meshes.len() as u64);
    let sides = Sides { volume, slopes, off: sides::NEAR };
    meshes
        .iter()
        .map(|mesh| {
            progress.step(1)?;
            let Some(sheet) = Sheet::of_mesh(mesh, geometry) else { return Ok(None) };
            let mut offsets = throws::offsets(sides, &sheet, GREATEST_THROW);
            offsets.summarize(&sheet);
            Ok((sheet.area() >= AREA).then(|| FaultSurface::new(sheet, offsets, volume.size()[2])))
        })
        .collect()
}
