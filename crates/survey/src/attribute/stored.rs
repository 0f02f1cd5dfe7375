//! Attributes of stored volumes of any size: read, computed and written block by block, each with as many lines around it as its answer depends
//! on, so that the result is the same as that of the whole volume at once.

use super::dip::{self, DipSettings, DipVolumes};
use super::envelope::envelope;
use super::error::AttributeError;
use super::semblance::{SemblanceSettings, semblance};
use crate::geometry::SurveyGeometry;
use crate::progress::Progress;
use crate::store::{
    Block, LineOrder, SourceError, StoreError, StoredVolume, VolumeInfo, WriteSettings, write_volume_blocks,
};
use crate::volume::Volume;
use glam::DVec3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::path::Path;

/// Float32 volumes of a block's size that are held while it is computed.
const VOLUMES_HELD: u64 = 7;

/// Writes the envelope of a stored volume to `path`.
///
/// # Errors
/// [`AttributeError`]; `path` is then what it was before.
pub fn write_envelope(
    path: &Path,
    source: &StoredVolume,
    info: &VolumeInfo,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<(), AttributeError> {
    write_blocks(path, source, info, memory_bytes, 0, progress, envelope)
}

/// Writes the semblance of a stored volume, along its own dips, to `path`.
///
/// # Errors
/// [`AttributeError`]; `path` is then what it was before.
pub fn write_semblance(
    path: &Path,
    source: &StoredVolume,
    info: &VolumeInfo,
    settings: (&DipSettings, &SemblanceSettings),
    memory_bytes: u64,
    progress: &Progress,
) -> Result<(), AttributeError> {
    let (steering, settings) = settings;
    let reach = steering.reach().max(settings.half_width);
    write_blocks(path, source, info, memory_bytes, reach, progress, |volume, quiet| {
        semblance(volume, &dip::dip(volume, steering, quiet)?, settings, quiet)
    })
}

/// Writes the dips of a stored volume along inlines and along crosslines, samples a line, and their angle from the horizontal in degrees
/// by the lattice of `angle`'s info (its velocity where the volume is in time).
///
/// # Errors
/// [`AttributeError`]; paths that were not finished are then what they were before.
pub fn write_dip(
    [angle, inline, crossline]: [(&Path, &VolumeInfo); 3],
    source: &StoredVolume,
    settings: &DipSettings,
    memory_bytes: u64,
    progress: &Progress,
) -> Result<(), AttributeError> {
    settings.validate()?;
    write_blocks(inline.0, source, inline.1, memory_bytes, settings.reach(), progress, |volume, quiet| {
        Ok(dip::like(volume, dip::along_inlines(volume, settings, quiet)?))
    })?;
    write_blocks(crossline.0, source, crossline.1, memory_bytes, settings.reach(), progress, |volume, quiet| {
        Ok(dip::like(volume, dip::along_crosslines(volume, settings, quiet)?))
    })?;
    let [p, q] = [StoredVolume::open(inline.0)?, StoredVolume::open(crossline.0)?];
    let geometry = &angle.1.geometry;
    let supply = |block: &Block, _| -> Result<Cow<'static, [f32]>, SourceError> {
        progress.check()?;
        let (start, size) = span(block, geometry.size());
        let dips = DipVolumes { inline: p.read_box(0, start, size)?, crossline: q.read_box(0, start, size)? };
        Ok(dip_angle(&dips, geometry).samples().to_vec().into())
    };
    let settings = WriteSettings { memory_bytes: memory_bytes / 3, order: LineOrder::Inlines };
    let written =
        write_volume_blocks(angle.0, geometry.size(), Some(source.live()), angle.1, &settings, supply, progress);
    written.map_err(explain)?;
    Ok(())
}

/// Angle of the reflections from the horizontal in degrees: atan |∇z|, where ∇z in metres a metre solves ∇z·a = p, ∇z·b = q for the metric
/// vectors a, b of a bin. Time becomes depth through the geometry's velocity.
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

/// Computes and writes block by block, with `reach` lines around each.
fn write_blocks(
    path: &Path,
    source: &StoredVolume,
    info: &VolumeInfo,
    memory_bytes: u64,
    reach: usize,
    progress: &Progress,
    compute: impl Fn(&Volume<f32>, &Progress) -> Result<Volume<f32>, AttributeError>,
) -> Result<(), AttributeError> {
    let size = source.size(0);
    let supply = |block: &Block, _| -> Result<Cow<'static, [f32]>, SourceError> {
        let (start, part) = span(block, size);
        let low = [start[0].saturating_sub(reach), start[1].saturating_sub(reach), 0];
        let high = [0, 1, 2].map(|axis| (start[axis] + part[axis] + reach).min(size[axis]));
        let around = source.read_box_f32(0, low, [0, 1, 2].map(|axis| high[axis] - low[axis]))?;
        // The bar counts what is written; cancelling reaches the computation all the same.
        let found = compute(&around, &progress.muted())?;
        let mut out = Vec::with_capacity(part.iter().product());
        for x in start[0] - low[0]..start[0] - low[0] + part[0] {
            for y in start[1] - low[1]..start[1] - low[1] + part[1] {
                out.extend_from_slice(found.trace(x, y));
            }
        }
        Ok(out.into())
    };
    // A quarter of it goes to blocks in the making: half of what the writer is given is its block.
    let settings = WriteSettings { memory_bytes: memory_bytes * 2 / VOLUMES_HELD, order: LineOrder::Inlines };
    write_volume_blocks(path, size, Some(source.live()), info, &settings, supply, progress).map_err(explain)?;
    Ok(())
}

/// What went wrong in the computation comes back through the writer; taken out again.
fn explain(error: StoreError) -> AttributeError {
    let StoreError::Source { path, source } = error else { return error.into() };
    match source.downcast::<AttributeError>() {
        Ok(own) => *own,
        Err(source) => match source.downcast::<StoreError>() {
            Ok(store) => (*store).into(),
            Err(source) => StoreError::Source { path, source }.into(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::VerticalUnit;
    use crate::store::write_volume;

    fn geometry(size: [usize; 3]) -> SurveyGeometry {
        SurveyGeometry::regular(size, 20.0, 4.0, VerticalUnit::Milliseconds)
    }

    #[test]
    fn blocks_give_what_the_whole_volume_gives() {
        let dir = tempfile::tempdir().unwrap();
        let size = [135, 131, 24];
        let count: usize = size.iter().product();
        let samples: Vec<f32> =
            (0..count).map(|n| ((n * 7919 % 1013) as f32 - 500.0) * 0.01 + (n as f32 * 0.3).sin() * 9.0).collect();
        let mut volume = Volume::from_samples(size, samples).unwrap();
        volume.set_live(Some((0..size[0] * size[1]).map(|n| n % 97 != 5).collect())).unwrap();
        let info = VolumeInfo::of(geometry(size));
        let quiet = Progress::silent();
        let at = |name: &str| dir.path().join(name);
        write_volume(&at("source"), &volume, &info, &quiet).unwrap();
        let source = StoredVolume::open(&at("source")).unwrap();
        let (steering, settings) = (DipSettings::default(), SemblanceSettings::default());
        // One byte of memory: blocks of one column of shards, four of them here.
        write_semblance(&at("semblance"), &source, &info, (&steering, &settings), 1, &quiet).unwrap();
        write_envelope(&at("envelope"), &source, &info, 1, &quiet).unwrap();
        let paths = ["angle", "inline", "crossline"].map(at);
        write_dip(paths.each_ref().map(|path| (path.as_path(), &info)), &source, &steering, 1, &quiet).unwrap();

        let stored = source.read_f32(0, &quiet).unwrap();
        let dips = dip::dip(&stored, &steering, &quiet).unwrap();
        let read = |path: &Path| StoredVolume::open(path).unwrap().read_f32(0, &quiet).unwrap();
        assert!(read(&at("semblance")) == semblance(&stored, &dips, &settings, &quiet).unwrap());
        assert!(read(&at("envelope")) == envelope(&stored, &quiet).unwrap());
        assert!(read(&paths[1]) == dips.inline);
        assert!(read(&paths[2]) == dips.crossline);
        assert!(read(&paths[0]) == dip_angle(&dips, &info.geometry));
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

    #[test]
    fn cancelling_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let size = [4, 4, 8];
        let info = VolumeInfo::of(geometry(size));
        let source = dir.path().join("source");
        write_volume(&source, &Volume::filled(size, 1.0f32), &info, &Progress::silent()).unwrap();
        let source = StoredVolume::open(&source).unwrap();
        let progress = Progress::silent();
        progress.cancel();
        let out = dir.path().join("out");
        let error = write_envelope(&out, &source, &info, 1 << 20, &progress).unwrap_err();
        assert!(
            matches!(error, AttributeError::Cancelled(_) | AttributeError::Store(StoreError::Cancelled(_))),
            "{error:?}"
        );
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
