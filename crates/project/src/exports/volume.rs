//! Writes a volume of a project to object storage, or as a SEG-Y file, which is streamed by as many inlines at a time as a
//! shard holds, so that a volume of any size can be written.

use crate::error::{Noun, ProjectError};
use crate::{Project, content, folder};
use files::segy::{WriteFormat, WriteOptions};
use serde::Serialize;
use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use store::StoredVolume;
use survey::{Progress, SurveyGeometry};

/// Largest memory for the samples being copied, bytes.
const SLAB_BYTES: usize = 512 << 20;

/// The report of the export.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VolumeWritten {
    /// The file.
    pub file: PathBuf,
    /// The volume.
    pub volume: String,
    /// Number of traces; those that were not recorded are left out.
    pub traces: usize,
    /// Length of the file.
    pub bytes: u64,
    /// Code of the sample format.
    pub format_code: u16,
    /// Number of samples beyond the range of an integer format, written as its limit; and of samples that are not a
    /// number, written as 0.
    pub clipped: u64,
}

impl std::fmt::Display for VolumeWritten {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}: volume '{}', {} traces, {} bytes, SEG-Y format code {}",
            self.file.display(),
            self.volume,
            self.traces,
            self.bytes,
            self.format_code
        )?;
        if self.clipped > 0 {
            write!(f, "\n  {} samples do not fit the format and were clipped", self.clipped)?;
        }
        Ok(())
    }
}

/// The report of a volume that was written to object storage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VolumeUploaded {
    /// Its address.
    pub url: String,
    /// The volume.
    pub volume: String,
    /// Bytes of its objects.
    pub bytes: u64,
}

impl std::fmt::Display for VolumeUploaded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: volume '{}', {} bytes, Zarr v3", self.url, self.volume, self.bytes)
    }
}

/// Writes the volume `name` of a project to object storage, as the Zarr v3 group that it is stored as.
///
/// # Errors
/// There is no such volume, it is damaged, there is something under the address, or the storage does not take it; nothing
/// that opens as a volume is then there.
pub fn upload(project: &Project, url: &str, name: &str, progress: &Progress) -> Result<VolumeUploaded, ProjectError> {
    let document = project.document();
    let entry = &document.volumes[document.position(Noun::Volume, name)?];
    let bytes = content::open_recorded(project.root(), entry, document.frame()?)?.upload(url, progress)?;
    Ok(VolumeUploaded { url: url.to_owned(), volume: name.to_owned(), bytes })
}

/// Writes the volume `name` of a project; `format` is by default the one in which its samples are stored.
///
/// # Errors
/// There is no such volume, data are damaged, SEG-Y cannot hold the volume, the disk is full, or the user cancelled;
/// `out` is then what it was before.
pub fn write(
    project: &Project,
    out: &Path,
    name: &str,
    format: Option<WriteFormat>,
    progress: &Progress,
) -> Result<VolumeWritten, ProjectError> {
    let document = project.document();
    let entry = &document.volumes[document.position(Noun::Volume, name)?];
    folder::refuse_inside_project(out)?;
    let stored = content::open_recorded(project.root(), entry, document.frame()?)?;
    let geometry = stored.info().geometry.clone();
    let format = format.unwrap_or(match stored.type_name().as_str() {
        "int8" => WriteFormat::Int8,
        "int16" => WriteFormat::Int16,
        "uint8" => WriteFormat::Uint8,
        "uint16" => WriteFormat::Uint16,
        _ => WriteFormat::Ieee32,
    });
    let from = entry
        .origin
        .file()
        .map_or_else(|| entry.origin.to_string().to_uppercase(), |file| format!("FROM {}", file_name(file)));
    let origin = format!("VOLUME {} OF {}, {from}", entry.name, file_name(project.root()));
    let options = WriteOptions { format, origin: Some(origin), ..WriteOptions::default() };
    let report = stream(&stored, &geometry, out, &options, progress)?;
    Ok(VolumeWritten {
        file: out.to_owned(),
        volume: entry.name.clone(),
        traces: report.traces,
        bytes: report.bytes,
        format_code: format.sample_format().code(),
        clipped: report.clipped,
    })
}

fn stream(
    stored: &StoredVolume,
    geometry: &SurveyGeometry,
    out: &Path,
    options: &WriteOptions,
    progress: &Progress,
) -> Result<files::segy::WriteReport, ProjectError> {
    let [_, crosslines, samples] = stored.size(0);
    let together = (SLAB_BYTES / (crosslines * samples * size_of::<f32>()).max(1)).clamp(1, store::BRICK);
    let mut source = |lines: Range<usize>| {
        let slab = stored.read_box_f32(0, [lines.start, 0, 0], [lines.len(), crosslines, samples])?;
        Ok(Cow::Owned(slab.into_samples()))
    };
    Ok(files::segy::write_lines(out, geometry, Some(stored.live()), options, together, &mut source, progress)?)
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
