//! What the fuzz targets share: a file for parsers that read from disk, a small survey, and a limit on allocations.
//!
//! A target fails by a panic, by a sample that takes more than ten seconds, and by one allocation of more than
//! [`LARGEST_ALLOCATION`] bytes: inputs are a few kilobytes, and no header may make a parser reserve what the file
//! cannot fill.

pub mod inputs;
#[cfg(feature = "documents")]
pub mod scenes;
pub mod seeds;

pub use inputs::{HAND_WRITTEN, WELL_FILES, interpretation, well_path};

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::{Path, PathBuf};

use files::ZUnit;
use files::segy::{
    ByteOrder, KeptDuplicate, LengthUnit, LineSource, NullAmplitude, NumberType, SampleFormat, SegyFile, SegyOptions,
    TraceWeight,
};
use survey::{Progress, SurveyGeometry, VerticalUnit};

/// One allocation may take so many bytes.
pub const LARGEST_ALLOCATION: usize = 256 << 20;

/// The system's allocator, but for requests that no input of a fuzzer can justify.
struct Limited;

#[expect(unsafe_code, reason = "an allocator can be written in no other way; this one passes every request on")]
// SAFETY: every request that is answered is answered by the system's allocator with the same layout.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        limit(layout.size());
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        limit(layout.size());
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        limit(size);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(memory, layout, size) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static LIMITED: Limited = Limited;

fn limit(bytes: usize) {
    if bytes > LARGEST_ALLOCATION {
        eprintln!("an allocation of {bytes} bytes was asked for");
        std::process::abort();
    }
}

/// The survey that horizons, faults and wells are read onto: 12 inlines, 9 crosslines.
pub fn survey() -> SurveyGeometry {
    SurveyGeometry::regular([12, 9, 51], 25.0, 4.0, VerticalUnit::Milliseconds)
}

/// Calls `work` with a file that holds `bytes`, in memory where the system has a folder for that.
pub fn with_file<T>(bytes: &[u8], work: impl FnOnce(&Path) -> T) -> T {
    with_file_of("in", bytes, work)
}

/// The same, with a file of that extension.
pub fn with_file_of<T>(extension: &str, bytes: &[u8], work: impl FnOnce(&Path) -> T) -> T {
    let path = folder().join(format!("petroglyph-fuzz-{}.{extension}", std::process::id()));
    if let Err(error) = std::fs::write(&path, bytes) {
        // Without the file nothing would be tested; libFuzzer takes this for a failure, which it is.
        panic!("{} could not be written: {error}", path.display());
    }
    let result = work(&path);
    let _ = std::fs::remove_file(&path);
    result
}

/// A folder for files of one input: in memory, where the system has such a folder.
pub fn folder() -> PathBuf {
    let memory = PathBuf::from("/dev/shm");
    if memory.is_dir() { memory } else { std::env::temp_dir() }
}

/// Opens a SEG-Y file, describes it and reads it.
pub fn read_segy(bytes: Vec<u8>, options: &SegyOptions) {
    let progress = Progress::silent();
    let Ok(file) = SegyFile::from_bytes(Path::new("input.sgy"), bytes, options, &progress) else { return };
    if let Ok(statistics) = file.statistics(&progress) {
        assert!(!file.page(&statistics).is_empty());
    }
    if let Ok(read) = file.read(&progress) {
        assert_eq!(read.volume.size(), read.geometry.size());
        let samples = read.volume.samples();
        assert!(samples.iter().all(|sample| !sample.is_infinite()));
        // Without a null amplitude, what is missing is what is no number in the file.
        if options.null == Some(NullAmplitude::None) {
            let missing = samples.iter().filter(|sample| sample.is_nan()).count() as u64;
            assert_eq!(missing, read.amplitudes.non_finite);
        }
    }
}

/// Options of every kind, from a few bytes; a zero byte leaves an option out.
pub fn segy_options(bytes: &[u8; 12]) -> SegyOptions {
    let [inline, crossline, x, y, order, format, interval, start, vertical, length, bin, weight] = *bytes;
    let given = |byte: u8| (byte > 0).then_some(u16::from(byte));
    let number = |byte: u8| (byte > 0).then(|| f64::from(byte) - 128.0);
    SegyOptions {
        inline_byte: given(inline),
        crossline_byte: given(crossline),
        x_byte: given(x),
        y_byte: given(y),
        byte_order: [None, Some(ByteOrder::Big), Some(ByteOrder::Little)][usize::from(order % 3)],
        format: (format > 0).then(|| SampleFormat::from_code(u16::from(format % 17)).ok().flatten()).flatten(),
        null: [None, Some(NullAmplitude::None), Some(NullAmplitude::At(-999.25))][usize::from(start % 3)],
        interval: number(interval),
        start: number(start),
        vertical_unit: [None, Some(ZUnit::Milliseconds), Some(ZUnit::Metres), Some(ZUnit::SurveyFeet)]
            [usize::from(vertical % 4)],
        coordinate_unit: [None, Some(LengthUnit::Metres), Some(LengthUnit::Feet)][usize::from(length % 3)],
        bin_m: if bin < 200 { number(bin) } else { None },
        trace_weight: [TraceWeight::Apply, TraceWeight::Ignore, TraceWeight::Inverse][usize::from(weight % 3)],
        line_type: (order >= 16).then(|| NumberType::ALL[usize::from(order / 3 % 6)]),
        coordinate_type: (length >= 16).then(|| NumberType::ALL[usize::from(length / 3 % 6)]),
        line_source: [LineSource::Headers, LineSource::Coordinates, LineSource::CoordinatesSwapped]
            [usize::from(vertical / 4 % 3)],
        duplicates: [None, Some(KeptDuplicate::First), Some(KeptDuplicate::Last)][usize::from(weight / 3 % 3)],
        scalar_byte: (format >= 32).then(|| u16::from(format)),
        coordinate_scalar: (bin >= 200).then(|| i16::from(bin) - 228),
    }
}
