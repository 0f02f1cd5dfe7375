//! Writes SEG-Y revision 1 with the standard's byte positions, without dead and missing traces. Unsigned
//! integers need revision 2, so files with them are of revision 2.
//!
//! The file is written under a temporary name in the folder of its target and renamed when it is complete.
//! When the disk is full or the user cancels, nothing is left behind.

use std::borrow::Cow;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rayon::prelude::*;

use super::error::{SegyError, SegyProblem};
use super::header::{FILE_HEADER_BYTES, ORDER_CONSTANT, TRACE_HEADER_BYTES, at};
use super::sample::{ByteOrder, SampleFormat, ibm_from_f32};
use super::text::encode_ebcdic;
use survey::geometry::{LineAxis, SurveyGeometry, VerticalUnit};
use survey::progress::Progress;
use survey::volume::Volume;
use system::file;

/// A sample format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WriteFormat {
    /// IEEE float, exact (code 5).
    #[default]
    Ieee32,
    /// IBM float, at least 21 bits (code 1).
    Ibm32,
    /// Integer, 4 bytes (code 2).
    Int32,
    /// Integer, 2 bytes (code 3).
    Int16,
    /// Integer, 1 byte (code 8).
    Int8,
    /// Unsigned integer, 2 bytes (code 11, revision 2).
    Uint16,
    /// Unsigned integer, 1 byte (code 16, revision 2).
    Uint8,
}

impl WriteFormat {
    /// The same format as a [`SampleFormat`].
    pub fn sample_format(self) -> SampleFormat {
        match self {
            Self::Ieee32 => SampleFormat::Ieee32,
            Self::Ibm32 => SampleFormat::Ibm32,
            Self::Int32 => SampleFormat::Int32,
            Self::Int16 => SampleFormat::Int16,
            Self::Int8 => SampleFormat::Int8,
            Self::Uint16 => SampleFormat::Uint16,
            Self::Uint8 => SampleFormat::Uint8,
        }
    }

    /// Bytes 3501 and 3502: the revision that has the format.
    fn revision(self) -> [u8; 2] {
        match self {
            Self::Uint16 | Self::Uint8 => [2, 0],
            _ => [1, 0],
        }
    }

    /// Range of an integer format.
    fn limits(self) -> Option<[f64; 2]> {
        match self {
            Self::Ieee32 | Self::Ibm32 => None,
            Self::Int32 => Some([f64::from(i32::MIN), f64::from(i32::MAX)]),
            Self::Int16 => Some([f64::from(i16::MIN), f64::from(i16::MAX)]),
            Self::Int8 => Some([f64::from(i8::MIN), f64::from(i8::MAX)]),
            Self::Uint16 => Some([0.0, f64::from(u16::MAX)]),
            Self::Uint8 => Some([0.0, f64::from(u8::MAX)]),
        }
    }
}

/// Options for writing a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteOptions {
    /// Sample format. Default: IEEE float.
    pub format: WriteFormat,
    /// Byte order. Default: big-endian, the standard's.
    pub byte_order: ByteOrder,
    /// Lines of the textual header, without `C 1`. When empty, the lines describe the volume.
    pub text: Vec<String>,
    /// The origin of the volume, as a further line of the description. Default: none.
    pub origin: Option<String>,
    /// Factor on samples, applied before integers are rounded and clipped. Default: 1.
    pub gain: f32,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self { format: WriteFormat::default(), byte_order: ByteOrder::Big, text: Vec::new(), origin: None, gain: 1.0 }
    }
}

/// What was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteReport {
    /// Traces.
    pub traces: usize,
    /// Length of the file.
    pub bytes: u64,
    /// Count of samples outside the range of an integer or IBM format, written as its limit, and of NaN
    /// samples, written as 0.
    pub clipped: u64,
}

/// Supplies the samples of a range of inlines, `[inline][crossline][sample]`.
pub(crate) type SampleSource<'s> =
    dyn FnMut(Range<usize>) -> Result<Cow<'s, [f32]>, Box<dyn std::error::Error + Send + Sync>> + 's;

/// Writes the live traces of a volume.
///
/// ```
/// use files::segy::{WriteFormat, WriteOptions};
/// use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
///
/// let folder = tempfile::tempdir()?;
/// let geometry = SurveyGeometry::regular([2, 2, 3], 25.0, 4.0, VerticalUnit::Milliseconds);
/// let mut volume = Volume::filled([2, 2, 3], 100.0_f32);
/// volume.trace_mut(0, 0)[1] = 300.0; // An 8-bit integer ends at 127.
/// let options = WriteOptions { format: WriteFormat::Int8, ..WriteOptions::default() };
/// let report = files::segy::write(&folder.path().join("a.sgy"), &geometry, &volume, &options, &Progress::silent())?;
/// assert_eq!((report.traces, report.clipped), (4, 1));
/// assert_eq!(report.bytes, 3600 + 4 * (240 + 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SegyError`] when the volume does not match its geometry, when SEG-Y cannot represent it, when the file
/// cannot be written, or when the user cancels. The target then remains as it was.
pub fn write(
    path: &Path,
    geometry: &SurveyGeometry,
    volume: &Volume<f32>,
    options: &WriteOptions,
    progress: &Progress,
) -> Result<WriteReport, SegyError> {
    if volume.size() != geometry.size() {
        return Err(SegyProblem::SizeMismatch { volume: volume.size(), geometry: geometry.size() }.in_file(path));
    }
    let [_, crosslines, samples] = volume.size();
    let line = crosslines * samples;
    let mut source = |lines: Range<usize>| Ok(Cow::Borrowed(&volume.samples()[lines.start * line..lines.end * line]));
    write_lines(path, geometry, volume.live(), options, geometry.inlines.count, &mut source, progress)
}

/// Writes the live traces of a volume that is larger than memory. `source` is asked for `together` inlines at
/// a time. `live` is the mask of live traces; `None` means that all are live.
///
/// # Errors
/// As [`write()`], and [`SegyProblem::Source`] for an error of the source.
pub fn write_lines(
    path: &Path,
    geometry: &SurveyGeometry,
    live: Option<&[bool]>,
    options: &WriteOptions,
    together: usize,
    source: &mut SampleSource<'_>,
    progress: &Progress,
) -> Result<WriteReport, SegyError> {
    let temporary = temporary_beside(path);
    let written = Plan::new(geometry, live, options).and_then(|plan| {
        let report = plan.write(&temporary, together.max(1), source, progress)?;
        fs::rename(&temporary, path).map_err(io("put the file in its place", "check that you may write there"))?;
        let folder = path.parent().unwrap_or(path);
        file::sync_folder(folder).map_err(io("flush the folder of", "check the disk"))?;
        Ok(report)
    });
    if written.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
    }
    written.map_err(|problem| problem.in_file(path))
}

/// Checks that a file of all traces of a survey fits on the disk of its folder, before samples are made for it.
///
/// # Errors
/// There is less room, or the survey cannot be written as SEG-Y.
pub fn check_room(path: &Path, geometry: &SurveyGeometry, options: &WriteOptions) -> Result<(), SegyError> {
    let checked = Plan::new(geometry, None, options).and_then(|plan| plan.check_room(path));
    checked.map_err(|problem| problem.in_file(path))
}

fn temporary_beside(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

fn io(doing: &'static str, hint: &'static str) -> impl Fn(std::io::Error) -> SegyProblem {
    move |source| SegyProblem::Io { doing, hint, source }
}

/// What a full disk needs.
const SPACE: &str = "make room on the disk, or choose another folder";

/// A volume and the header values that hold it.
struct Plan<'a> {
    geometry: &'a SurveyGeometry,
    live: Option<&'a [bool]>,
    options: &'a WriteOptions,
    interval: u16,
    samples: u16,
    delay: i16,
    time_scalar: i16,
    coordinate_scalar: i16,
}

impl<'a> Plan<'a> {
    fn new(
        geometry: &'a SurveyGeometry,
        live: Option<&'a [bool]>,
        options: &'a WriteOptions,
    ) -> Result<Self, SegyProblem> {
        geometry.validate()?;
        for axis in [geometry.inlines, geometry.crosslines] {
            check_line_numbers(&axis)?;
        }
        let [_, _, count] = geometry.size();
        let samples = u16::try_from(count).map_err(|_| SegyProblem::NotRepresentable {
            what: "a sample count",
            value: count as f64,
            hint: "at most 65535 fit; write fewer samples",
        })?;
        let (delay, time_scalar) = delay(geometry.vertical.first)?;
        Ok(Self {
            geometry,
            live,
            options,
            interval: interval(geometry.vertical.interval)?,
            samples,
            delay,
            time_scalar,
            coordinate_scalar: coordinate_scalar(geometry)?,
        })
    }

    /// Checks that the file fits on the disk.
    fn check_room(&self, path: &Path) -> Result<(), SegyProblem> {
        let [inlines, crosslines, samples] = self.geometry.size().map(|count| count as u64);
        let traces = self.live.map_or(inlines * crosslines, |live| live.iter().filter(|live| **live).count() as u64);
        let trace = TRACE_HEADER_BYTES as u64 + samples * self.options.format.sample_format().bytes() as u64;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        file::check_room(folder, FILE_HEADER_BYTES as u64 + traces * trace).map_err(io("write it", SPACE))
    }

    fn write(
        &self,
        path: &Path,
        together: usize,
        source: &mut SampleSource<'_>,
        progress: &Progress,
    ) -> Result<WriteReport, SegyProblem> {
        self.check_room(path)?;
        let [inlines, crosslines, samples] = self.geometry.size();
        progress.begin("writing traces", (inlines * crosslines) as u64);
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(true)
            .open(path)
            .map_err(io("create a file there", "check that the folder exists and that you may write to it"))?;
        let mut out = BufWriter::with_capacity(1 << 20, file);
        out.write_all(&self.file_header()).map_err(io("write", SPACE))?;
        let mut report = WriteReport { traces: 0, bytes: FILE_HEADER_BYTES as u64, clipped: 0 };
        let is_live = |x: usize, y: usize| self.live.is_none_or(|live| live[x * crosslines + y]);
        let mut values = Cow::Borrowed(&[][..]);
        for x in 0..inlines {
            progress.step(crosslines as u64)?;
            let slab = x - x % together;
            if x == slab {
                // The memory of what was read before is released first.
                drop(std::mem::take(&mut values));
                values =
                    source(slab..(slab + together).min(inlines)).map_err(|source| SegyProblem::Source { source })?;
            }
            let live: Vec<usize> = (0..crosslines).filter(|&y| is_live(x, y)).collect();
            let first = report.traces;
            let trace = |y: usize| {
                let from = ((x - slab) * crosslines + y) * samples;
                values.get(from..from + samples).unwrap_or_default()
            };
            let traces: Vec<(Vec<u8>, u64)> =
                live.par_iter().enumerate().map(|(k, &y)| self.trace([x, y], first + k, trace(y))).collect();
            for (bytes, clipped) in traces {
                out.write_all(&bytes).map_err(io("write", SPACE))?;
                report.traces += 1;
                report.bytes += bytes.len() as u64;
                report.clipped += clipped;
            }
        }
        if report.traces == 0 {
            return Err(SegyProblem::NothingLive);
        }
        let file: File = out.into_inner().map_err(|e| io("write", SPACE)(e.into_error()))?;
        file.sync_all().map_err(io("write", SPACE))?;
        Ok(report)
    }

    fn file_header(&self) -> Vec<u8> {
        let text = if self.options.text.is_empty() { self.describe() } else { self.options.text.clone() };
        let mut header = encode_ebcdic(&text);
        header.resize(FILE_HEADER_BYTES, 0);
        let order = self.options.byte_order;
        let mut put = |byte: usize, value: u16| order.put(&mut header, byte - 1, value.to_be_bytes());
        put(3213, u16::try_from(self.geometry.crosslines.count).unwrap_or(0));
        put(3217, self.interval);
        put(3221, self.samples);
        put(3225, self.options.format.sample_format().code());
        put(3229, 4);
        put(3255, 1);
        put(3503, 1);
        order.put(&mut header, 3200, 1_i32.to_be_bytes());
        order.put(&mut header, 3204, 1_i32.to_be_bytes());
        order.put(&mut header, 3296, ORDER_CONSTANT.to_be_bytes());
        // Revision 1 has one number of two bytes here, revision 2 two of one byte, whatever the order.
        match self.options.format.revision() {
            [2, minor] => header[3500..3502].copy_from_slice(&[2, minor]),
            revision => order.put(&mut header, 3500, revision),
        }
        header
    }

    /// A textual header that says what a reader needs to know.
    fn describe(&self) -> Vec<String> {
        let g = self.geometry;
        let v = &g.vertical;
        let lines = |axis: &LineAxis| format!("{} TO {} STEP {} ({})", axis.first, axis.last(), axis.step, axis.count);
        let axis = match v.unit {
            VerticalUnit::Milliseconds => "TWO-WAY TIME (TWT) IN MS",
            VerticalUnit::Metres => "DEPTH IN M",
        };
        let mut text = vec![
            "WRITTEN BY PETROGLYPH".to_owned(),
            format!("POST-STACK 3D VOLUME, VERTICAL AXIS {axis}, POSITIVE DOWN"),
            format!(
                "FIRST SAMPLE {}, {} SAMPLES, SAMPLE INTERVAL {} {}",
                v.first,
                v.count,
                v.interval,
                v.unit.symbol().to_uppercase()
            ),
            format!("INLINES    {} AT BYTE 189", lines(&g.inlines)),
            format!("CROSSLINES {} AT BYTE 193", lines(&g.crosslines)),
            format!("CDP X AT BYTE 181, CDP Y AT BYTE 185, IN M, SCALAR {} AT BYTE 71", self.coordinate_scalar),
            format!("SAMPLE FORMAT {}", self.options.format.sample_format().name().to_uppercase()),
            "TRACES THAT WERE NOT RECORDED ARE LEFT OUT".to_owned(),
        ];
        text.extend(self.options.origin.as_ref().map(|origin| format!("ORIGIN: {}", origin.to_uppercase())));
        text
    }

    /// A trace, and how many of its samples were clipped.
    fn trace(&self, [x, y]: [usize; 2], number: usize, samples: &[f32]) -> (Vec<u8>, u64) {
        let order = self.options.byte_order;
        let format = self.options.format.sample_format();
        let mut bytes = vec![0; TRACE_HEADER_BYTES + usize::from(self.samples) * format.bytes()];
        let g = self.geometry;
        let world = g.world_from_voxel(DVec3::new(x as f64, y as f64, 0.0));
        let per_metre = match self.coordinate_scalar {
            scalar @ ..0 => -f64::from(scalar),
            scalar => 1.0 / f64::from(scalar),
        };
        let coordinate = |value: f64| (value * per_metre).round() as i32;
        let number = i32::try_from(number + 1).unwrap_or(i32::MAX);
        let crossline = g.crosslines.number_at(y as f64) as i32;
        for (byte, value) in [
            (at::TRACE_IN_LINE, i32::try_from(y + 1).unwrap_or(i32::MAX)),
            (at::TRACE_IN_FILE, number),
            (at::CDP, crossline),
            (at::CDP_X, coordinate(world.x)),
            (at::CDP_Y, coordinate(world.y)),
            (at::INLINE, g.inlines.number_at(x as f64) as i32),
            (at::CROSSLINE, crossline),
        ] {
            order.put(&mut bytes, usize::from(byte) - 1, value.to_be_bytes());
        }
        for (byte, value) in [
            (at::TRACE_ID, 1),
            (at::DATA_USE, 1),
            (at::COORDINATE_SCALAR, self.coordinate_scalar),
            (at::COORDINATE_UNIT, 1),
            (at::DELAY, self.delay),
            (at::SAMPLES, self.samples.cast_signed()),
            (at::INTERVAL, self.interval.cast_signed()),
            (at::TIME_SCALAR, self.time_scalar),
        ] {
            order.put(&mut bytes, usize::from(byte) - 1, value.to_be_bytes());
        }
        let clipped = self.encode(samples, &mut bytes[TRACE_HEADER_BYTES..]);
        (bytes, clipped)
    }

    fn encode(&self, trace: &[f32], bytes: &mut [u8]) -> u64 {
        let order = self.options.byte_order;
        let format = self.options.format;
        let size = format.sample_format().bytes();
        let mut clipped = 0;
        for (value, bytes) in trace.iter().zip(bytes.chunks_exact_mut(size)) {
            let value = value * self.options.gain;
            let Some([low, high]) = format.limits() else {
                let bits = match format {
                    WriteFormat::Ibm32 => ibm_from_f32(value),
                    _ => value.to_bits(),
                };
                clipped += u64::from(format == WriteFormat::Ibm32 && !value.is_finite());
                order.put(bytes, 0, bits.to_be_bytes());
                continue;
            };
            let rounded = f64::from(value).round();
            clipped += u64::from(!(low..=high).contains(&rounded));
            // A float that is not a number becomes 0 by the cast.
            let integer = rounded.clamp(low, high) as i32;
            match size {
                // The low bytes of a number in range are those of the narrow one, signed or not.
                1 => bytes[0] = integer as u8,
                2 => order.put(bytes, 0, (integer as u16).to_be_bytes()),
                _ => order.put(bytes, 0, integer.to_be_bytes()),
            }
        }
        clipped
    }
}

fn check_line_numbers(axis: &LineAxis) -> Result<(), SegyProblem> {
    let last = axis.number_at(axis.count as f64 - 1.0);
    if last.abs() > f64::from(i32::MAX) {
        return Err(SegyProblem::NotRepresentable {
            what: "a line number",
            value: last,
            hint: "number the lines within 32 bits",
        });
    }
    Ok(())
}

/// µs of an interval in ms, or mm of one in m.
fn interval(interval: f64) -> Result<u16, SegyProblem> {
    let thousandths = interval * 1000.0;
    let rounded = thousandths.round();
    if (thousandths - rounded).abs() > 1e-3 || !(1.0..=65535.0).contains(&rounded) {
        return Err(SegyProblem::NotRepresentable {
            what: "a sample interval",
            value: interval,
            hint: "it must be 0.001 to 65.535 in whole thousandths of a ms or m; resample the volume",
        });
    }
    Ok(rounded as u16)
}

/// The start as a 16-bit integer and its scalar.
fn delay(first: f64) -> Result<(i16, i16), SegyProblem> {
    for scalar in [1, -10, -100, -1000, 10, 100] {
        let factor = if scalar < 0 { -f64::from(scalar) } else { 1.0 / f64::from(scalar) };
        let value = first * factor;
        if (value - value.round()).abs() < 1e-6 * factor.max(1.0) && value.abs() <= f64::from(i16::MAX) {
            return Ok((value.round() as i16, scalar));
        }
    }
    Err(SegyProblem::NotRepresentable {
        what: "a first sample",
        value: first,
        hint: "it must fit 16 bits in steps of 0.001, 0.01, 0.1, 1, 10 or 100; shift or resample the volume",
    })
}

/// The finest scalar, centimetres at best, under which every corner fits 32 bits.
fn coordinate_scalar(geometry: &SurveyGeometry) -> Result<i16, SegyProblem> {
    let [nx, ny, _] = geometry.size().map(|n| n as f64 - 1.0);
    let corners = [[0.0, 0.0], [nx, 0.0], [0.0, ny], [nx, ny]];
    let largest = corners
        .map(|[x, y]| geometry.world_from_voxel(DVec3::new(x, y, 0.0)).truncate().abs().max_element())
        .into_iter()
        .fold(0.0, f64::max);
    for scalar in [-100_i16, -10, 1, 10, 100] {
        let factor = if scalar < 0 { -f64::from(scalar) } else { 1.0 / f64::from(scalar) };
        if largest * factor < f64::from(i32::MAX) {
            return Ok(scalar);
        }
    }
    Err(SegyProblem::NotRepresentable {
        what: "a coordinate",
        value: largest,
        hint: "coordinates must be below 200 million km; check their unit",
    })
}
