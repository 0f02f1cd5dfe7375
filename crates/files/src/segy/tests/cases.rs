//! The small volumes that once failed, and others of their kinds.

use super::super::{LengthUnit, NullAmplitude, SampleFormat, SegyFile, SegyOptions, ibm_from_f32};
use super::builder::Built;
use crate::unit::ZUnit;
use std::path::PathBuf;
use survey::progress::Progress;

/// A file of a case; without `PETROGLYPH_DATA`, `None` and a message.
fn case(path: &str) -> Option<PathBuf> {
    let file = testdata::folder()?.join("cases").join(path);
    if !file.is_file() {
        eprintln!("skipped: {} is not there", file.display());
        return None;
    }
    Some(file)
}

fn opened(path: &str, options: &SegyOptions) -> Option<SegyFile> {
    let path = case(path)?;
    Some(SegyFile::open(&path, options, &Progress::silent()).unwrap_or_else(|e| panic!("{e}")))
}

#[test]
fn a_depth_in_us_survey_feet_is_no_time_in_microseconds() {
    for name in ["41-feet-depth/p1.sgy", "41-feet-depth/a1.sgy"] {
        let Some(file) = opened(name, &SegyOptions::default()) else { return };
        assert_eq!((file.info().vertical_unit, file.info().interval), (ZUnit::SurveyFeet, 10.0));
        let step = file.geometry().unwrap().vertical.interval;
        assert!((step - 12_000.0 / 3937.0).abs() < 1e-12, "{step}");
    }
}

#[test]
fn sentences_about_depth_in_many_words_give_the_unit() {
    let said = |line: &str| {
        let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
        built.binary(3217, 10_000);
        let mut built = built.each(|_, trace| trace.i16(117, 10_000));
        built.say(1, line);
        built.info()
    };
    for (line, unit) in [
        ("DEPTH VOLUME IN FEET", ZUnit::Feet),
        ("TVDSS (FEET)", ZUnit::Feet),
        ("Trace unit: ft", ZUnit::Feet),
        ("Z AXIS: DEPTH, UNITS: USFT", ZUnit::SurveyFeet),
        ("DEPTH DOMAIN, UNIT ftUS", ZUnit::SurveyFeet),
        ("PROFUNDIDAD EN METROS", ZUnit::Metres),
        ("PROFONDEUR (M)", ZUnit::Metres),
        ("US SURVEY, ACQUIRED IN THE US; TWT (MS)", ZUnit::Milliseconds),
        ("TIME IN US", ZUnit::Milliseconds),
    ] {
        assert_eq!(said(line).vertical_unit, unit, "{line}");
    }
    let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
    built.say(1, "DEPTH IN FEET");
    built.say(2, "DEPTHS (METRES)");
    let info = built.info();
    let warning = info.warnings.iter().map(ToString::to_string).find(|w| w.contains("twice")).unwrap();
    assert!(warning.contains("DEPTH IN FEET") && warning.contains("DEPTHS (METRES)"), "{warning}");
}

#[test]
fn the_feet_of_x_and_y_are_those_of_the_text_header() {
    let said = |byte: u16, line: &str| {
        let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
        built.binary(3255, byte);
        built.say(2, line);
        built.info()
    };
    assert_eq!(said(2, "XY UNITS: US SURVEY FEET").coordinate_unit, LengthUnit::SurveyFeet);
    assert_eq!(said(2, "").coordinate_unit, LengthUnit::Feet);
    assert_eq!(said(0, "COORDINATES IN FEET").coordinate_unit, LengthUnit::Feet);
    let info = said(1, "COORDINATES IN FEET");
    assert_eq!(info.coordinate_unit, LengthUnit::Metres);
    assert!(info.warnings.iter().any(|w| w.fact.contains("COORDINATES IN FEET")), "{:?}", info.warnings);
}

/// A volume with one value of a wave per sample, `words(value)` bytes each.
fn volume(code: u16, samples: usize, encode: impl Fn(f32, usize) -> Vec<u8>) -> Built {
    let lines: Vec<i32> = (1..=12).collect();
    let mut built = Built::grid(&lines, &lines);
    built.binary(3221, samples as u16);
    built.binary(3225, code);
    let count = samples as u16;
    built.each(|index, trace| {
        trace.i16(115, count.cast_signed());
        trace.samples = (0..samples).flat_map(|n| encode(wave(index, n), n)).collect();
    })
}

/// Amplitudes of both signs over three powers of ten.
fn wave(trace: usize, n: usize) -> f32 {
    let phase = 0.37 * n as f32 + 0.11 * trace as f32;
    phase.sin() * 10_f32.powf(1.5 + 1.5 * (0.031 * n as f32 + 0.2 * trace as f32).cos())
}

fn bytes_of(file: &Built) -> (SegyFile, Vec<f32>) {
    let path = std::path::Path::new("built.sgy");
    let file = SegyFile::from_bytes(path, file.bytes(), &SegyOptions::default(), &Progress::silent());
    let file = file.unwrap_or_else(|e| panic!("{e}"));
    let mut out = vec![0.0; file.size()[2]];
    file.read_trace(1, 2, &mut out).unwrap();
    (file, out)
}

#[test]
fn floats_of_another_kind_than_the_code_says_are_read_as_what_they_are() {
    let ieee = |v: f32, _: usize| v.to_be_bytes().to_vec();
    let ibm = |v: f32, _: usize| ibm_from_f32(v).to_be_bytes().to_vec();
    let swapped = |v: f32, _: usize| v.to_le_bytes().to_vec();
    let integer = |v: f32, _: usize| (v as i32).to_be_bytes().to_vec();
    let expect = |n: usize| wave(14, n);
    for (name, built, format, exact) in [
        ("IEEE under 1", volume(1, 100, ieee), SampleFormat::Ieee32, 0.0),
        ("IBM under 5", volume(5, 100, ibm), SampleFormat::Ibm32, 1e-6),
        ("IEEE under 2", volume(2, 100, ieee), SampleFormat::Ieee32, 0.0),
        ("IBM under 2", volume(2, 100, ibm), SampleFormat::Ibm32, 1e-6),
        ("IEEE of the other order", volume(5, 100, swapped), SampleFormat::Ieee32, 0.0),
        ("integers under 1", volume(1, 100, integer), SampleFormat::Int32, 1.0),
    ] {
        let (file, out) = bytes_of(&built);
        assert_eq!(file.info().sample_format, format, "{name}: {:?}", file.info().warnings);
        assert!(!file.info().warnings.is_empty(), "{name}");
        for (n, value) in out.iter().enumerate() {
            assert!((value - expect(n)).abs() <= exact * expect(n).abs().max(1.0), "{name}: {value} for {}", expect(n));
        }
    }
    // What is as it says is not doubted; what is stated is believed.
    for built in [volume(1, 100, ibm), volume(5, 100, ieee), volume(2, 100, integer)] {
        let (file, _) = bytes_of(&built);
        assert!(file.info().warnings.is_empty(), "{:?}", file.info().warnings);
    }
    let stated = SegyOptions { format: Some(SampleFormat::Ibm32), ..SegyOptions::default() };
    assert_eq!(volume(1, 100, ieee).scan(&stated).unwrap().sample_format, SampleFormat::Ibm32);
    let Some(file) = opened("32-ieee-called-ibm/rev0.sgy", &SegyOptions::default()) else { return };
    let statistics = file.statistics(&Progress::silent()).unwrap();
    assert!((statistics.min + 3214.0).abs() < 2.0 && (statistics.max - 2937.0).abs() < 2.0, "{statistics:?}");
}

#[test]
fn samples_of_another_width_than_the_code_says_are_seen_by_the_trace_headers() {
    let byte = |v: f32, _: usize| vec![(v / 10.0) as i8 as u8];
    let unsigned = |v: f32, _: usize| vec![(128.0 + v / 10.0) as u8];
    let short = |v: f32, _: usize| (v as i16).to_be_bytes().to_vec();
    let double = |v: f32, _: usize| f64::from(v).to_be_bytes().to_vec();
    let float = |v: f32, _: usize| v.to_be_bytes().to_vec();
    for (name, built, format) in [
        ("bytes under 6", volume(6, 120, byte), SampleFormat::Int8),
        ("bytes under 3", volume(3, 100, byte), SampleFormat::Int8),
        ("unsigned bytes under 1", volume(1, 120, unsigned), SampleFormat::Uint8),
        ("shorts under 5", volume(5, 120, short), SampleFormat::Int16),
        ("doubles under 5", volume(5, 120, double), SampleFormat::Ieee64),
        ("floats under 3", volume(3, 120, float), SampleFormat::Ieee32),
    ] {
        let (file, _) = bytes_of(&built);
        let info = file.info();
        assert_eq!((info.sample_format, info.traces), (format, 144), "{name}: {:?}", info.warnings);
        assert!(info.warnings.iter().any(|w| w.fact.contains("follow one another")), "{name}: {:?}", info.warnings);
    }
    let Some(file) = opened("31-8bit-code-6/merged.sgy", &SegyOptions::default()) else { return };
    assert_eq!((file.info().sample_format, file.info().traces), (SampleFormat::Int8, 720));
}

#[test]
fn counts_of_samples_beyond_two_bytes_are_found() {
    let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
    built.binary(3221, 4464);
    let built = built.each(|index, trace| {
        trace.i16(115, 4464);
        trace.samples = (0..70_000).flat_map(|n| wave(index, n).to_be_bytes()).collect();
    });
    let (file, out) = bytes_of(&built);
    assert_eq!((file.info().traces, out.len()), (9, 70_000));
    assert_eq!(out[69_999], wave(5, 69_999));
    assert!(file.info().warnings.iter().any(|w| w.fact.contains("70000")), "{:?}", file.info().warnings);
}

#[test]
fn coordinates_as_ibm_floats_are_found_by_the_bins_they_make() {
    let built = Built::grid(&[1, 2, 3, 4], &[1, 2, 3, 4]).each(|_, trace| {
        trace.i16(71, 1);
        let (x, y) = (457_000.0 + 25.0 * trace.inline as f32, 6_000_000.0 + 25.0 * trace.crossline as f32);
        trace.i32(181, ibm_from_f32(x).cast_signed());
        trace.i32(185, ibm_from_f32(y).cast_signed());
    });
    let info = built.info();
    assert_eq!(info.geometry.origin, [457_025.0, 6_000_025.0], "{:?}", info.assumptions);
    assert!(info.assumptions.iter().any(|a| a.fact.contains("IBM floats")), "{:?}", info.assumptions);
}

#[test]
fn null_amplitudes_are_found_said_and_left_out() {
    let null = |code: u16, null: f32| {
        volume(code, 100, move |v, n| (if (30..60).contains(&n) { null } else { v }).to_be_bytes().to_vec()).each(
            |index, trace| {
                if index < 20 {
                    trace.samples = null.to_be_bytes().repeat(100);
                }
            },
        )
    };
    for value in [1e30, -999.25, -9999.0, 1.701_41e38, -1e10] {
        let (file, out) = bytes_of(&null(5, value));
        assert!(
            out[30..60].iter().all(|v| v.is_nan()) && out[29] == wave(14, 29) || out.iter().all(|v| *v == 0.0),
            "{value}"
        );
        let statistics = file.statistics(&Progress::silent()).unwrap();
        assert!(statistics.max < 2000.0 && statistics.min > -2000.0, "{value}: {statistics:?}");
        assert!(file.info().assumptions.iter().any(|a| a.fact.contains("stand for no data")), "{value}");
        // Twenty traces of nothing else are not live.
        assert_eq!((file.info().dead_traces, file.is_live(0, 0), file.is_live(5, 5)), (20, false, true), "{value}");
    }
    let kept = SegyOptions { null: Some(NullAmplitude::None), ..SegyOptions::default() };
    assert!(null(5, -999.25).read(&kept).unwrap().volume.samples().contains(&-999.25));
    let stated = SegyOptions { null: Some(NullAmplitude::At(-123.5)), ..SegyOptions::default() };
    assert!(!null(5, -123.5).read(&stated).unwrap().volume.samples().contains(&-123.5));
    // Integers with a null are stored as floats, of which NaN is no data; without one they stay integers.
    let whole =
        |v: f32, n: usize| (if (30..60).contains(&n) { -32_000.0 } else { v / 4.0 } as i16).to_be_bytes().to_vec();
    let integers = volume(3, 100, whole);
    for (null, stored) in [
        (NullAmplitude::At(-32_000.0), survey::sample::SampleType::Float32),
        (NullAmplitude::None, survey::sample::SampleType::Int16),
    ] {
        let options = SegyOptions { null: Some(null), ..SegyOptions::default() };
        let file = integers.read(&options).unwrap();
        let is_nothing = file.volume.trace(5, 5)[40].is_nan();
        assert_eq!(is_nothing, stored == survey::sample::SampleType::Float32);
        assert!(file.amplitudes.rms.is_finite(), "{:?}", file.amplitudes);
        super::builder::with_file(&integers.bytes(), |path| {
            let opened = SegyFile::open(path, &options, &Progress::silent()).unwrap();
            assert_eq!(opened.sample_type(), stored);
        });
    }
    for (name, least) in [("40-null-amplitudes/null-1e30.sgy", 1e30), ("40-null-amplitudes/null-999.sgy", -999.25)] {
        let Some(file) = opened(name, &SegyOptions::default()) else { return };
        let said = file.info().assumptions.iter().any(|a| a.fact.contains(&format!("{least:e}")));
        let statistics = file.statistics(&Progress::silent()).unwrap();
        assert!(said && statistics.max < 1e5 && statistics.min > -1e5, "{name}: {:?}", file.info().assumptions);
    }
}

#[test]
fn extended_text_in_ascii_under_an_ebcdic_header_ends_where_it_says() {
    let mut built = Built::grid(&[1, 2, 3], &[1, 2, 3]);
    built.text = super::super::text::encode_ebcdic(&["TWT IN MS".to_owned()]);
    built.binary(3501, 0x0100);
    built.binary(3505, 0xffff);
    let block = |line: &str| format!("{line:<3200}").into_bytes();
    built.extended = [block("((SEG: Location Data ver 1.0))"), block("((SEG: EndText))")].concat();
    let info = built.info();
    assert_eq!((info.traces, info.extended_text[0].as_str()), (9, "((SEG: Location Data ver 1.0))"));
    // A stanza of a program's own, words behind its name, an end that is spelled otherwise and filled up with anything; of
    // a revision that knows no such headers; in the other encoding; bytes that are no text between.
    let filled = |text: &str, fill: u8| {
        let mut block = text.as_bytes().to_vec();
        block.resize(3200, fill);
        block
    };
    let own = filled("((own: words ()(test1) ))first part", b' ');
    let ebcdic = super::super::text::encode_ebcdic(&["((SEG: EndText))".to_owned()]);
    let binary: Vec<u8> = (0..3200).map(|n| (n * 7 % 256) as u8).collect();
    for (revision, blocks) in [
        (0, vec![own.clone(), filled("second part", b' '), filled("((  seg: endTEXt  ))", b'3')]),
        (0x0100, vec![own.clone(), filled("((SEG:ENDTEXT))", 0)]),
        (0x0100, vec![own.clone(), ebcdic]),
        (0x0200, vec![own, binary, filled("((SEG: EndText))", b' ')]),
    ] {
        built.binary(3501, revision);
        let count = blocks.len();
        built.extended = blocks.concat();
        let info = built.info();
        assert_eq!((info.traces, info.extended_text.len()), (9, 40 * count), "{:?}", info.warnings);
    }
}
