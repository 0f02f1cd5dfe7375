//! Files of every kind, built by an encoder of their own: any format code, byte order, size, rotation, step,
//! missing trace and revision comes back as the volume and geometry it was made of; cut anywhere, it is a
//! clear error.

use glam::DVec2;

use super::super::{ByteOrder, SampleFormat, SegyOptions, SegyProblem, ibm_from_f32, read, scan};
use super::builder::with_file;
use survey::progress::Progress;

struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }
}

/// A file, and what it was made of.
struct Case {
    bytes: Vec<u8>,
    inlines: Vec<i32>,
    crosslines: Vec<i32>,
    samples: usize,
    interval_us: u16,
    delay: i16,
    vectors: [DVec2; 2],
    origin: DVec2,
    format: SampleFormat,
    /// `[inline][crossline]`; none where there is no trace.
    traces: Vec<Option<Vec<f32>>>,
    stride: usize,
    start: usize,
}

/// A whole number that the format holds.
fn value_in(format: SampleFormat, random: &mut Random) -> i64 {
    let signed = |bits: u32, random: &mut Random| random.below(1 << bits) as i64 - (1 << (bits - 1));
    match format {
        SampleFormat::Int8 => signed(8, random),
        SampleFormat::Int16 => signed(16, random),
        SampleFormat::Uint8 => random.below(1 << 8) as i64,
        SampleFormat::Uint16 => random.below(1 << 16) as i64,
        // IBM floats keep 21 bits at least.
        SampleFormat::Ibm32 => signed(21, random),
        SampleFormat::Uint24 | SampleFormat::Uint32 | SampleFormat::Uint64 => random.below(1 << 24) as i64,
        _ => signed(24, random),
    }
}

fn encode(format: SampleFormat, order: ByteOrder, value: i64) -> Vec<u8> {
    let all = value.to_be_bytes();
    let mut bytes = match format {
        SampleFormat::Ibm32 => ibm_from_f32(value as f32).to_be_bytes().to_vec(),
        SampleFormat::Ieee32 => (value as f32).to_be_bytes().to_vec(),
        SampleFormat::Ieee64 => (value as f64).to_be_bytes().to_vec(),
        _ => all[8 - format.bytes()..].to_vec(),
    };
    if order == ByteOrder::Little {
        bytes.reverse();
    }
    bytes
}

fn case(seed: u64, format: SampleFormat, order: ByteOrder) -> Case {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let axis = |random: &mut Random| {
        let (first, step) = (random.below(5000) as i32 - 500, [1, 2, 3, -1, -4][random.below(5) as usize]);
        (0..3 + random.below(6) as i32).map(|k| first + k * step).collect::<Vec<i32>>()
    };
    let (inlines, crosslines) = (axis(&mut random), axis(&mut random));
    let samples = 1 + random.below(9) as usize;
    let interval_us = [500, 2000, 4000, 10_000][random.below(4) as usize];
    let delay = random.below(4000) as i16 - 1000;
    let angle = random.below(360) as f64;
    let (sin, cos) = angle.to_radians().sin_cos();
    let mirror = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let vectors = [DVec2::new(cos, sin) * 25.0, DVec2::new(-sin, cos) * 12.5 * mirror];
    let origin = DVec2::new(605_000.0, 6_073_000.0);
    let revision = random.below(3);
    let (text_headers, trace_headers) = match revision {
        0 => (0, 1),
        1 => (random.below(3) as usize, 1),
        _ => (random.below(3) as usize, 1 + random.below(3) as usize),
    };
    let mut header = vec![b' '; 3200];
    header[..3].copy_from_slice(b"TWT");
    header.resize(3600 + 3200 * text_headers, 0);
    let put16 = |bytes: &mut [u8], byte: usize, value: u16| order.put(bytes, byte - 1, value.to_be_bytes());
    let put32 = |bytes: &mut [u8], byte: usize, value: i32| order.put(bytes, byte - 1, value.to_be_bytes());
    put16(&mut header, 3217, interval_us);
    put16(&mut header, 3221, samples as u16);
    put16(&mut header, 3225, format.code());
    put16(&mut header, 3255, 1);
    put16(&mut header, 3505, text_headers as u16);
    match revision {
        0 => {}
        1 => put16(&mut header, 3501, 0x0100),
        _ => {
            header[3500] = 2;
            put16(&mut header, 3507, trace_headers as u16 - 1);
            order.put(&mut header, 3296, 0x0102_0304_u32.to_be_bytes());
        }
    }
    let start = header.len();
    let mut bytes = header;
    let keep = [100, 90, 70][random.below(3) as usize];
    let by_crossline = random.below(2) == 0;
    let (rows, columns) = (inlines.len(), crosslines.len());
    let mut traces = vec![None; rows * columns];
    let places: Vec<(usize, usize)> = if by_crossline {
        (0..columns).flat_map(|x| (0..rows).map(move |i| (i, x))).collect()
    } else {
        (0..rows).flat_map(|i| (0..columns).map(move |x| (i, x))).collect()
    };
    for (i, x) in places {
        // The rim stays, so that the extent is known.
        let is_rim = i == 0 || x == 0 || i + 1 == rows || x + 1 == columns;
        if !is_rim && random.below(100) >= keep {
            continue;
        }
        let mut trace = vec![0; 240 * trace_headers];
        let world = origin + vectors[0] * i as f64 + vectors[1] * x as f64;
        for (byte, value) in [
            (181, (world.x * 100.0).round() as i32),
            (185, (world.y * 100.0).round() as i32),
            (189, inlines[i]),
            (193, crosslines[x]),
        ] {
            put32(&mut trace, byte, value);
        }
        for (byte, value) in [
            (29, 1),
            (71, (-100_i16).cast_unsigned()),
            (109, delay.cast_unsigned()),
            (115, samples as u16),
            (117, interval_us),
        ] {
            put16(&mut trace, byte, value);
        }
        let values: Vec<i64> = (0..samples).map(|_| value_in(format, &mut random)).collect();
        trace.extend(values.iter().flat_map(|&value| encode(format, order, value)));
        bytes.extend(trace);
        traces[i * columns + x] = Some(values.iter().map(|&value| value as f32).collect());
    }
    let stride = 240 * trace_headers + samples * format.bytes();
    Case { bytes, inlines, crosslines, samples, interval_us, delay, vectors, origin, format, traces, stride, start }
}

fn cases() -> impl Iterator<Item = Case> {
    (1..=12).flat_map(|seed| {
        SampleFormat::all()
            .flat_map(move |format| [ByteOrder::Big, ByteOrder::Little].map(|order| case(seed, format, order)))
    })
}

#[test]
fn every_file_comes_back_as_what_it_was_made_of() {
    for case in cases() {
        let found = with_file(&case.bytes, |path| read(path, &SegyOptions::default(), &Progress::silent()))
            .unwrap_or_else(|error| panic!("{error}"));
        let geometry = &found.geometry;
        let numbers =
            |axis: survey::LineAxis| (0..axis.count).map(|k| axis.number_at(k as f64) as i32).collect::<Vec<_>>();
        assert_eq!(numbers(geometry.inlines), case.inlines);
        assert_eq!(numbers(geometry.crosslines), case.crosslines);
        assert_eq!(found.info.sample_format, case.format);
        assert_eq!(geometry.vertical.count, case.samples);
        assert_eq!(geometry.vertical.interval, f64::from(case.interval_us) / 1000.0);
        assert_eq!(geometry.vertical.first, f64::from(case.delay));
        assert!((geometry.origin - case.origin).length() < 0.02);
        assert!((geometry.inline_vector - case.vectors[0]).length() < 0.01);
        assert!((geometry.crossline_vector - case.vectors[1]).length() < 0.01);
        for (place, trace) in case.traces.iter().enumerate() {
            let (x, y) = (place / case.crosslines.len(), place % case.crosslines.len());
            assert_eq!(found.volume.is_live(x, y), trace.is_some());
            let expected = trace.clone().unwrap_or_else(|| vec![0.0; case.samples]);
            assert_eq!(found.volume.trace(x, y), expected, "{:?}", case.format);
        }
        assert!(found.info.warnings.is_empty(), "{:?}", found.info.warnings);
    }
}

#[test]
fn cut_anywhere_they_are_refused_by_name() {
    let mut random = Random(77);
    for case in cases().step_by(9) {
        for _ in 0..6 {
            let length = random.below(case.bytes.len() as u64) as usize;
            let outcome =
                with_file(&case.bytes[..length], |path| scan(path, &SegyOptions::default(), &Progress::silent()));
            let is_whole = length > case.start && (length - case.start).is_multiple_of(case.stride);
            if is_whole {
                continue;
            }
            let problem = outcome.expect_err("a part of a file was taken for a file").problem;
            assert!(
                matches!(
                    problem,
                    SegyProblem::TooShort { .. }
                        | SegyProblem::IsText { .. }
                        | SegyProblem::NotSegy { .. }
                        | SegyProblem::NoTraces { .. }
                        | SegyProblem::Truncated { .. }
                ),
                "{length} of {}: {problem}",
                case.bytes.len()
            );
        }
    }
}
