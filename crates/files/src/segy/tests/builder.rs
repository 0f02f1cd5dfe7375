//! SEG-Y files built byte by byte, independent of the writer under test.

use std::io::Write;

use super::super::{ByteOrder, SegyError, SegyInfo, SegyOptions, SegyProblem, SegyVolume, read, scan};
use survey::progress::Progress;

/// Samples of a built trace.
pub(super) const SAMPLES: usize = 4;

/// One trace: header fields are set by their 1-based byte.
#[derive(Clone)]
pub(super) struct Trace {
    pub inline: i32,
    pub crossline: i32,
    header: [u8; 240],
    order: ByteOrder,
    pub samples: Vec<u8>,
}

impl Trace {
    pub(super) fn i32(&mut self, byte: usize, value: i32) {
        self.order.put(&mut self.header, byte - 1, value.to_be_bytes());
    }

    pub(super) fn i16(&mut self, byte: usize, value: i16) {
        self.order.put(&mut self.header, byte - 1, value.to_be_bytes());
    }

    /// IEEE samples.
    pub(super) fn floats(&mut self, values: &[f32]) {
        self.samples.clear();
        for value in values {
            let mut bytes = [0; 4];
            self.order.put(&mut bytes, 0, value.to_be_bytes());
            self.samples.extend(bytes);
        }
    }
}

/// A file that is being built.
#[derive(Clone)]
pub(super) struct Built {
    pub text: Vec<u8>,
    binary: Vec<u8>,
    pub extended: Vec<u8>,
    pub traces: Vec<Trace>,
    order: ByteOrder,
}

impl Built {
    /// Every crossline of every inline, in that order: IEEE, 4 ms, standard bytes, 25 m bins turned by 30° at
    /// X, Y in cm. Sample k is `1000·inline + crossline + k/4`.
    pub(super) fn grid(inlines: &[i32], crosslines: &[i32]) -> Self {
        Self::grid_in(ByteOrder::Big, inlines, crosslines)
    }

    pub(super) fn grid_in(order: ByteOrder, inlines: &[i32], crosslines: &[i32]) -> Self {
        let pairs = inlines.iter().flat_map(|&i| crosslines.iter().map(move |&x| (i, x)));
        let mut built =
            Self { text: vec![b' '; 3200], binary: vec![0; 400], extended: Vec::new(), traces: Vec::new(), order };
        built.say(1, "TWT");
        for (byte, value) in [(3217, 4000), (3221, SAMPLES as u16), (3225, 5), (3255, 1)] {
            built.binary(byte, value);
        }
        built.traces = pairs.map(|(inline, crossline)| built.trace(inline, crossline)).collect();
        built
    }

    pub(super) fn trace(&self, inline: i32, crossline: i32) -> Trace {
        let mut trace = Trace { inline, crossline, header: [0; 240], order: self.order, samples: Vec::new() };
        trace.i32(189, inline);
        trace.i32(193, crossline);
        trace.i16(29, 1);
        trace.i16(115, SAMPLES as i16);
        trace.i16(117, 4000);
        trace.place(181, 185);
        let first = (1000 * inline + crossline) as f32;
        trace.floats(&[first, first + 0.25, first + 0.5, first + 0.75]);
        trace
    }

    pub(super) fn binary(&mut self, byte: usize, value: u16) {
        self.order.put(&mut self.binary, byte - 3201, value.to_be_bytes());
    }

    pub(super) fn binary_bytes<const N: usize>(&mut self, byte: usize, value: [u8; N]) {
        self.order.put(&mut self.binary, byte - 3201, value);
    }

    /// Writes a line (from 1) of an ASCII textual header.
    pub(super) fn say(&mut self, line: usize, words: &str) {
        let start = 80 * (line - 1);
        self.text[start..start + 80].fill(b' ');
        self.text[start..start + words.len()].copy_from_slice(words.as_bytes());
    }

    pub(super) fn each(mut self, change: impl Fn(usize, &mut Trace)) -> Self {
        self.traces.iter_mut().enumerate().for_each(|(index, trace)| change(index, trace));
        self
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut bytes = [self.text.as_slice(), &self.binary, &self.extended].concat();
        for trace in &self.traces {
            bytes.extend(trace.header);
            bytes.extend(&trace.samples);
        }
        bytes
    }

    pub(super) fn scan(&self, options: &SegyOptions) -> Result<SegyInfo, SegyError> {
        with_file(&self.bytes(), |path| scan(path, options, &Progress::silent()))
    }

    pub(super) fn read(&self, options: &SegyOptions) -> Result<SegyVolume, SegyError> {
        with_file(&self.bytes(), |path| read(path, options, &Progress::silent()))
    }

    /// Information that is found without options.
    pub(super) fn info(&self) -> SegyInfo {
        self.scan(&SegyOptions::default()).unwrap_or_else(|e| panic!("{e}"))
    }

    /// Why it is refused without options.
    pub(super) fn refusal(&self) -> (SegyProblem, String) {
        let error = self.scan(&SegyOptions::default()).expect_err("it should have been refused");
        let sentence = format!("{error}; {}", error.remedy().unwrap_or_default());
        (error.problem, sentence)
    }
}

impl Trace {
    /// X and Y in cm at two bytes.
    pub(super) fn place(&mut self, x_byte: usize, y_byte: usize) {
        let (sin, cos) = std::f64::consts::FRAC_PI_6.sin_cos();
        let (i, x) = (f64::from(self.inline), f64::from(self.crossline));
        self.i16(71, -100);
        self.i32(x_byte, ((600_000.0 + 25.0 * (i * cos - x * sin)) * 100.0).round() as i32);
        self.i32(y_byte, ((6_000_000.0 + 25.0 * (i * sin + x * cos)) * 100.0).round() as i32);
    }
}

/// Calls `work` with the path of a file that holds `bytes`.
pub(super) fn with_file<T>(bytes: &[u8], work: impl FnOnce(&std::path::Path) -> T) -> T {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(bytes).unwrap();
    file.flush().unwrap();
    work(file.path())
}
