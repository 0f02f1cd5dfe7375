//! Attributes of volumes of any size. They are computed block by block, each with as many lines around it as
//! its answer depends on, so that the result is the same as that of the whole volume at once.
//!
//! Nothing is computed before the writer of the volume asks for a block.

use super::dip::{self, DipSettings, DipVolumes};
use super::envelope::envelope;
use super::error::AttributeError;
use super::likelihood::{self, fault_likelihood};
use super::semblance::{SemblanceSettings, semblance};
use glam::DVec3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;
use survey::geometry::SurveyGeometry;
use survey::progress::Progress;
use survey::sample::{SampleType, SamplesMut};
use survey::source::{Block, BlockSource, BoxSource, SourceError};
use survey::volume::Volume;

/// The part of the memory that the writer of an attribute has: two sevenths.
const WRITER_SHARE: [u64; 2] = [2, 7];

/// Bytes that the writer needs beside the block, whatever the block's size: a file of 128³ samples.
const WRITER_BYTES: u64 = 9 << 20;

/// Number of float32 volumes of a piece's size that are held while the piece is computed: what it is computed
/// from, two dips, and the result or the other order of the traces; two more for the sums of the fault likelihood.
const VOLUMES_HELD: u64 = 7;

/// The same for an angle: the two dips and the result.
const ANGLE_VOLUMES_HELD: u64 = 3;

/// Lines of a piece along both axes that are not divided further, whatever the memory: smaller pieces read and
/// compute more lines around them than lines of their own.
const LEAST_LINES: usize = 32;

/// Computes a box that begins at a voxel and is of a size. Returns it, perhaps with lines around it, and the
/// first of its own lines in what is returned.
type Compute<'a> = dyn Fn([usize; 3], [usize; 3], &Progress) -> Result<(Volume<f32>, [usize; 2]), SourceError> + 'a;

/// A volume that is computed from another one, block by block.
///
/// A block is computed in as many pieces as the memory asks for; the result does not depend on them.
pub struct AttributeBlocks<'a> {
    size: [usize; 3],
    live: Option<&'a [bool]>,
    /// Lines around a piece that are read with it.
    reach: usize,
    volumes_held: u64,
    /// For the block and what it is computed from, bytes.
    memory_bytes: u64,
    compute: Box<Compute<'a>>,
}

impl AttributeBlocks<'_> {
    /// Sets how much memory writing and computing may use together, bytes, and returns the writer's share. A
    /// block that the writer asks for, and what a piece of 32 × 32 lines takes, are held in any case.
    pub fn share_memory(&mut self, memory_bytes: u64) -> u64 {
        self.memory_bytes = memory_bytes;
        memory_bytes / WRITER_SHARE[1] * WRITER_SHARE[0]
    }

    /// Cuts a block into pieces of which each can be computed in the memory that is left beside the block.
    fn pieces(&self, block: &Block) -> Vec<Block> {
        let bytes = |lines: [usize; 2]| (lines[0] * lines[1] * self.size[2] * size_of::<f32>()) as u64;
        let whole = [block.inlines.len(), block.crosslines.len()];
        let [share, of] = WRITER_SHARE;
        let writer = (self.memory_bytes / of * share / 2).max(WRITER_BYTES);
        let left = self.memory_bytes.saturating_sub(bytes(whole)).saturating_sub(writer);
        let mut piece = whole;
        while bytes(piece.map(|n| n + 2 * self.reach)).saturating_mul(self.volumes_held) > left {
            let longer = usize::from(piece[1] > piece[0]);
            if piece[longer] <= LEAST_LINES {
                break;
            }
            piece[longer] = piece[longer].div_ceil(2);
        }
        let cut = |range: &Range<usize>, step: usize| {
            let range = range.clone();
            range.clone().step_by(step.max(1)).map(move |first| first..(first + step).min(range.end))
        };
        cut(&block.inlines, piece[0])
            .flat_map(|inlines| {
                cut(&block.crosslines, piece[1]).map(move |crosslines| Block { inlines: inlines.clone(), crosslines })
            })
            .collect()
    }
}

impl BlockSource for AttributeBlocks<'_> {
    fn size(&self) -> [usize; 3] {
        self.size
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        self.live.map(Cow::Borrowed)
    }

    fn sample_type(&self) -> SampleType {
        SampleType::Float32
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, progress: &Progress) -> Result<(), SourceError> {
        let SamplesMut::Float32(out) = out else { return Err("attributes are floats".into()) };
        for piece in self.pieces(block) {
            let (start, part) = span(&piece, self.size);
            let (found, first) = (self.compute)(start, part, progress)?;
            let [x, y] = [start[0] - block.inlines.start, start[1] - block.crosslines.start];
            for (line, out) in out.chunks_exact_mut(block.crosslines.len() * part[2]).skip(x).take(part[0]).enumerate()
            {
                for (trace, out) in out.chunks_exact_mut(part[2]).skip(y).take(part[1]).enumerate() {
                    out.copy_from_slice(found.trace(first[0] + line, first[1] + trace));
                }
            }
        }
        Ok(())
    }
}

/// The envelope of a volume.
pub fn envelope_blocks(source: &dyn BoxSource) -> AttributeBlocks<'_> {
    computed(source, 0, envelope)
}

/// The semblance of a volume along its own dips.
pub fn semblance_blocks<'a>(
    source: &'a dyn BoxSource,
    steering: &'a DipSettings,
    settings: &'a SemblanceSettings,
) -> AttributeBlocks<'a> {
    let reach = steering.reach().max(settings.half_width);
    computed(source, reach, |volume, quiet| semblance(volume, &dip::dip(volume, steering, quiet)?, settings, quiet))
}

/// The fault likelihood of a volume along its own slopes; `geometry` is that of the survey.
pub fn fault_likelihood_blocks<'a>(source: &'a dyn BoxSource, geometry: &'a SurveyGeometry) -> AttributeBlocks<'a> {
    let compute = |volume: &Volume<f32>, quiet: &Progress| fault_likelihood(volume, geometry, quiet);
    computed(source, likelihood::reach(geometry), compute)
}

/// The dips of a volume along inlines and along crosslines, samples a line.
///
/// # Errors
/// [`AttributeError::Setting`].
pub fn dip_blocks<'a>(
    source: &'a dyn BoxSource,
    settings: &'a DipSettings,
) -> Result<[AttributeBlocks<'a>; 2], AttributeError> {
    settings.validate()?;
    let reach = settings.reach();
    let inline =
        computed(source, reach, |volume, quiet| Ok(dip::like(volume, dip::along_inlines(volume, settings, quiet)?)));
    let crossline =
        computed(source, reach, |volume, quiet| Ok(dip::like(volume, dip::along_crosslines(volume, settings, quiet)?)));
    Ok([inline, crossline])
}

/// The angle of the reflections from the horizontal in degrees, from the two volumes of [`dip_blocks`] (see
/// [`dip_angle`]).
pub fn dip_angle_blocks<'a>(
    inline: &'a dyn BoxSource,
    crossline: &'a dyn BoxSource,
    geometry: &'a SurveyGeometry,
) -> AttributeBlocks<'a> {
    let size = geometry.size();
    let compute = move |start: [usize; 3], part: [usize; 3], progress: &Progress| {
        progress.check()?;
        let dips = DipVolumes { inline: inline.read_box(start, part)?, crossline: crossline.read_box(start, part)? };
        Ok((dip_angle(&dips, geometry), [0; 2]))
    };
    AttributeBlocks {
        size,
        live: inline.live(),
        reach: 0,
        volumes_held: ANGLE_VOLUMES_HELD,
        memory_bytes: u64::MAX,
        compute: Box::new(compute),
    }
}

/// Angle of the reflections from the horizontal in degrees: atan |∇z|, where ∇z in metres per metre solves
/// ∇z·a = p, ∇z·b = q for the metric vectors a, b of a bin. Time becomes depth through the geometry's
/// velocity.
///
/// # Examples
/// Reflections that deepen by one sample of 10 m per bin of 10 m have an angle of 45 degrees:
/// ```
/// use attribute::DipVolumes;
/// use attribute::blocks::dip_angle;
/// use survey::geometry::{SurveyGeometry, VerticalUnit};
/// use survey::volume::Volume;
///
/// let geometry = SurveyGeometry::regular([2, 2, 2], 10.0, 10.0, VerticalUnit::Metres);
/// let dips = DipVolumes { inline: Volume::filled([2; 3], 1.0), crossline: Volume::filled([2; 3], 0.0) };
/// assert!((dip_angle(&dips, &geometry).at(0, 0, 0) - 45.0).abs() < 1e-4);
/// ```
pub fn dip_angle(dips: &DipVolumes, geometry: &SurveyGeometry) -> Volume<f32> {
    let metric = geometry.metric_from_voxel();
    let (a, b, sample_m) = (metric.x_axis, metric.y_axis, geometry.sample_m());
    let area = a.x * b.y - a.y * b.x;
    let angle = |p: f32, q: f32| {
        let (p, q) = (f64::from(p) * sample_m, f64::from(q) * sample_m);
        let gradient = DVec3::new((p * b.y - q * a.y) / area, (q * a.x - p * b.x) / area, 0.0);
        gradient.length().atan().to_degrees() as f32
    };
    let angles = dips.inline.samples().par_iter().zip(dips.crossline.samples()).map(|(&p, &q)| angle(p, q)).collect();
    dip::like(&dips.inline, angles)
}

/// First voxel and size of a block of a volume of `size`.
fn span(block: &Block, size: [usize; 3]) -> ([usize; 3], [usize; 3]) {
    let start = [block.inlines.start, block.crosslines.start, 0];
    (start, [block.inlines.len(), block.crosslines.len(), size[2]])
}

/// What `compute` makes of a volume, with `reach` lines around each piece.
pub fn computed<'a>(
    source: &'a dyn BoxSource,
    reach: usize,
    compute: impl Fn(&Volume<f32>, &Progress) -> Result<Volume<f32>, AttributeError> + 'a,
) -> AttributeBlocks<'a> {
    let size = source.size();
    let compute = move |start: [usize; 3], part: [usize; 3], progress: &Progress| {
        let low = [start[0].saturating_sub(reach), start[1].saturating_sub(reach), 0];
        let high = [0, 1, 2].map(|axis| (start[axis] + part[axis] + reach).min(size[axis]));
        let around = source.read_box(low, [0, 1, 2].map(|axis| high[axis] - low[axis]))?;
        // The bar counts what is written; cancelling reaches the computation all the same.
        let found = compute(&around, &progress.muted())?;
        Ok((found, [start[0] - low[0], start[1] - low[1]]))
    };
    AttributeBlocks {
        size,
        live: source.live(),
        reach,
        volumes_held: VOLUMES_HELD,
        memory_bytes: u64::MAX,
        compute: Box::new(compute),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::geometry::VerticalUnit;

    fn geometry(size: [usize; 3]) -> SurveyGeometry {
        SurveyGeometry::regular(size, 20.0, 4.0, VerticalUnit::Milliseconds)
    }

    /// What the blocks add up to, in columns of at most 50 by 60 traces, with the mask of `volume`.
    fn gathered(mut blocks: AttributeBlocks<'_>, volume: &Volume<f32>) -> Volume<f32> {
        let [nx, ny, nz] = blocks.size();
        let mut whole = Volume::filled([nx, ny, nz], f32::NAN);
        for x in (0..nx).step_by(50) {
            for y in (0..ny).step_by(60) {
                let block = Block { inlines: x..(x + 50).min(nx), crosslines: y..(y + 60).min(ny) };
                let mut out = vec![f32::NAN; block.inlines.len() * block.crosslines.len() * nz];
                blocks.read_block(&block, SamplesMut::Float32(&mut out), &Progress::silent()).unwrap();
                let places = block.inlines.flat_map(|x| block.crosslines.clone().map(move |y| (x, y)));
                for ((x, y), trace) in places.zip(out.chunks_exact(nz)) {
                    whole.trace_mut(x, y).copy_from_slice(trace);
                }
            }
        }
        whole.set_live(volume.live().map(<[bool]>::to_vec)).unwrap();
        whole
    }

    #[test]
    fn blocks_give_what_the_whole_volume_gives() {
        let size = [135, 131, 24];
        let count: usize = size.iter().product();
        let samples: Vec<f32> =
            (0..count).map(|n| ((n * 7919 % 1013) as f32 - 500.0) * 0.01 + (n as f32 * 0.3).sin() * 9.0).collect();
        let mut volume = Volume::from_samples(size, samples).unwrap();
        volume.set_live(Some((0..size[0] * size[1]).map(|n| n % 97 != 5).collect())).unwrap();
        let quiet = Progress::silent();
        let (steering, settings) = (DipSettings::default(), SemblanceSettings::default());
        let dips = dip::dip(&volume, &steering, &quiet).unwrap();
        let whole = semblance(&volume, &dips, &settings, &quiet).unwrap();
        assert!(gathered(semblance_blocks(&volume, &steering, &settings), &volume) == whole);
        let mut little = semblance_blocks(&volume, &steering, &settings);
        // Beside the writer's 9 MiB and a block of 288 KB, a piece of 25 by 30 traces has room.
        little.share_memory((9 << 20) + 830_000);
        assert_eq!(little.pieces(&Block { inlines: 0..50, crosslines: 0..60 }).len(), 4);
        assert!(gathered(little, &volume) == whole);
        assert!(gathered(envelope_blocks(&volume), &volume) == envelope(&volume, &quiet).unwrap());
        let [inline, crossline] = dip_blocks(&volume, &steering).unwrap();
        assert!(gathered(inline, &volume) == dips.inline);
        assert!(gathered(crossline, &volume) == dips.crossline);
        let geometry = geometry(size);
        let likely = fault_likelihood(&volume, &geometry, &quiet).unwrap();
        assert!(gathered(fault_likelihood_blocks(&volume, &geometry), &volume) == likely);
        let angle = dip_angle_blocks(&dips.inline, &dips.crossline, &geometry);
        assert!(gathered(angle, &volume) == dip_angle(&dips, &geometry));
    }

    #[test]
    fn a_plane_dips_by_the_angle_of_its_normal() {
        // 4 ms at 2000 m/s are 4 m; 5 samples over 20 m of an inline step: 45 degrees.
        let geometry = geometry([2, 2, 3]);
        let flat = |value: f32| Volume::filled([2, 2, 3], value);
        let angle =
            |p: f32, q: f32| dip_angle(&DipVolumes { inline: flat(p), crossline: flat(q) }, &geometry).at(0, 1, 2);
        assert!((angle(5.0, 0.0) - 45.0).abs() < 1e-4);
        assert!((angle(0.0, -5.0) - 45.0).abs() < 1e-4);
        assert!((angle(3.0, 4.0) - 45.0).abs() < 1e-4);
        assert_eq!(angle(0.0, 0.0), 0.0);
    }
}
