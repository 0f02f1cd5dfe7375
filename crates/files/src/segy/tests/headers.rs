//! File headers: byte order, revisions, lengths, the vertical axis.

use super::super::{
    ByteOrder, LengthUnit, LineSource, NumberType, SampleFormat, SegyOptions, SegyProblem, TextEncoding, TraceWeight,
    scan,
};
use super::builder::{Built, SAMPLES, Trace, with_file};
use crate::unit::ZUnit;
use survey::progress::Progress;
use survey::remedy::{Note, Setting};

const LINES: [i32; 3] = [1, 2, 3];

fn built() -> Built {
    Built::grid(&LINES, &[10, 11, 12, 13])
}

fn has(notes: &[Note], words: &str) -> bool {
    notes.iter().any(|note| note.to_string().contains(words))
}

#[test]
fn the_plain_file_needs_no_assumption() {
    let info = built().info();
    assert_eq!(info.assumptions, Vec::<Note>::new());
    assert_eq!(info.warnings, Vec::<Note>::new());
    assert_eq!(info.text_encoding, TextEncoding::Ascii);
    assert_eq!((info.start, info.interval, info.samples), (0.0, 4.0, SAMPLES));
}

#[test]
fn a_seismic_unix_file_is_named() {
    for order in [ByteOrder::Big, ByteOrder::Little] {
        let file = Built::grid_in(order, &LINES, &[10, 11, 12, 13]);
        let bytes = file.bytes();
        let traces = &bytes[bytes.len() - 12 * (240 + 4 * SAMPLES)..];
        let found = with_file(traces, |path| scan(path, &SegyOptions::default(), &Progress::silent())).unwrap_err();
        assert!(matches!(found.problem, SegyProblem::SeismicUnix { traces: 12, samples: 4 }), "{found}");
        assert!(file.scan(&SegyOptions::default()).is_ok());
    }
}

#[test]
fn little_endian_is_found_with_and_without_the_constant() {
    let mut little = Built::grid_in(ByteOrder::Little, &LINES, &[10, 11, 12, 13]);
    assert_eq!(little.info().byte_order, ByteOrder::Little);
    let volume = little.read(&SegyOptions::default()).unwrap().volume;
    assert_eq!(volume, built().read(&SegyOptions::default()).unwrap().volume);
    little.binary_bytes(3297, 0x0102_0304_u32.to_be_bytes());
    assert!(has(&little.info().evidence, "constant at byte 3297"));
}

#[test]
fn a_format_code_that_reads_both_ways_is_settled_by_the_length() {
    // 0x0101 is 257 in both orders, and the stated format makes both possible.
    for order in [ByteOrder::Big, ByteOrder::Little] {
        let mut file = Built::grid_in(order, &LINES, &[10, 11, 12, 13]);
        file.binary(3225, 0x0101);
        let options = SegyOptions { format: Some(SampleFormat::Ieee32), ..SegyOptions::default() };
        assert_eq!(file.scan(&options).unwrap().byte_order, order);
        assert!(matches!(file.refusal().0, SegyProblem::NotSegy { big: 257, little: 257 }));
    }
}

#[test]
fn pairwise_swapped_bytes_are_refused() {
    let mut file = built();
    file.binary_bytes(3297, 0x0201_0403_u32.to_be_bytes());
    assert!(matches!(file.refusal().0, SegyProblem::PairwiseSwapped));
}

#[test]
fn the_fixed_gain_format_is_refused_by_its_code() {
    let mut file = built();
    file.binary(3225, 4);
    assert!(file.refusal().1.contains("code 4"), "{}", file.refusal().1);
}

#[test]
fn extended_text_headers_by_count_and_by_end_stanza() {
    let mut file = built();
    file.extended = vec![b' '; 6400];
    file.binary(3505, 2);
    assert_eq!(file.info().extended_text.len(), 80);
    file.binary(3505, u16::MAX);
    file.extended[3200..3216].copy_from_slice(b"((SEG: EndText))");
    assert_eq!(file.info().extended_text.len(), 80);
    assert_eq!(file.info().traces, 12);
}

#[test]
fn text_headers_that_the_file_does_not_announce_rightly_are_no_traces() {
    let text = |lines: usize| {
        let block = |n: usize| {
            format!("((SEG: Location Data ver 1.0)) part {n}, with words to the end of the line ").repeat(60)
        };
        (0..lines).flat_map(|n| block(n).into_bytes().into_iter().take(3200)).collect::<Vec<u8>>()
    };
    // The stride of a trace divides a text header, so that the length of the file does not tell.
    let whole = |_: usize, t: &mut Trace| {
        t.i16(115, 20);
        t.floats(&[1.5; 20]);
    };
    for announced in [0_i16, 1, 7, 300, i16::MAX, -1, -2] {
        let mut file = built().each(whole);
        file.binary(3221, 20);
        file.extended = text(3);
        file.binary(3505, announced.cast_unsigned());
        let info = file.info();
        assert_eq!((info.traces, info.extended_text.len()), (12, 120), "{announced}: {:?}", info.warnings);
        assert!(has(&info.warnings, "3505"), "{announced}: {:?}", info.warnings);
    }
}

#[test]
fn announced_text_headers_that_are_not_there_are_noticed() {
    let mut file = built();
    file.binary(3505, 1);
    let info = file.info();
    assert_eq!((info.traces, info.extended_text.len()), (12, 0));
    assert!(has(&info.warnings, "announces 1 extended text headers, and 0 are there"), "{:?}", info.warnings);
}

#[test]
fn revision_2_fields_are_followed() {
    let mut file = built();
    file.binary(3501, 0x0200);
    file.binary(3221, 0);
    file.binary(3217, 0);
    file.binary_bytes(3269, 4_u32.to_be_bytes());
    file.binary_bytes(3273, 2500.5_f64.to_be_bytes());
    file.binary_bytes(3521, 4000_u64.to_be_bytes());
    file.extended = vec![0; 400];
    let info = file.info();
    assert_eq!((info.revision.as_str(), info.samples, info.interval), ("2.0", 4, 2.5005));
    file.binary_bytes(3513, 13_u64.to_be_bytes());
    assert!(matches!(file.refusal().0, SegyProblem::TracesMissing { announced: 13, found: 12 }));
}

#[test]
fn revision_2_trace_header_extensions_are_skipped() {
    let mut file = built().each(|_, trace| {
        let samples = trace.samples.clone();
        trace.samples = [vec![0x11; 240], samples].concat();
    });
    file.binary(3501, 0x0200);
    file.binary(3507, 1);
    let expected = built().read(&SegyOptions::default()).unwrap().volume;
    assert_eq!(file.read(&SegyOptions::default()).unwrap().volume, expected);
}

#[test]
fn revision_2_coordinates_in_the_trace_header_extension_are_found() {
    for order in [ByteOrder::Big, ByteOrder::Little] {
        let lines = [[1, 2, 3, 4], [5, 6, 7, 8]];
        let mut file = Built::grid_in(order, &lines[0], &lines[1]).each(|_, trace| {
            let samples = trace.samples.clone();
            let mut extension = vec![0; 240];
            let place = [600_000.125 + 12.5 * f64::from(trace.inline), 6e6 - 25.0 * f64::from(trace.crossline)];
            order.put(&mut extension, 160, place[0].to_be_bytes());
            order.put(&mut extension, 168, place[1].to_be_bytes());
            trace.samples = [extension, samples].concat();
            trace.i32(181, 0);
            trace.i32(185, 0);
        });
        file.binary(3501, 0x0200);
        file.binary(3507, 1);
        let info = file.info();
        assert_eq!((info.byte_positions.x, info.byte_positions.y), (Some(401), Some(409)));
        assert_eq!(info.geometry.origin, [600_012.625, 5_999_875.0]);
        assert_eq!((info.geometry.inline_vector, info.geometry.crossline_vector), ([12.5, 0.0], [0.0, -25.0]));
        // Stated, also without line numbers.
        let stated = SegyOptions {
            x_byte: Some(401),
            y_byte: Some(409),
            coordinate_type: Some(NumberType::F64),
            line_source: LineSource::Coordinates,
            ..SegyOptions::default()
        };
        assert_eq!(file.scan(&stated).unwrap().geometry.inline_vector, [12.5, 0.0]);
        let beyond = SegyOptions { x_byte: Some(474), ..stated };
        assert!(matches!(
            file.scan(&beyond).unwrap_err().problem,
            SegyProblem::BadSetting { setting: Setting::XByte, .. }
        ));
    }
}

#[test]
fn counts_and_intervals_are_unsigned() {
    let many = 40_000;
    let mut file = Built::grid(&[1, 2], &[5, 6]).each(|_, trace| {
        trace.i16(115, many as u16 as i16);
        trace.i16(117, 50_000_u16 as i16);
        trace.floats(&vec![1.0; many]);
    });
    file.binary(3221, many as u16);
    file.binary(3217, 50_000);
    file.say(1, "DEPTH");
    let info = file.info();
    assert_eq!((info.samples, info.interval, info.vertical_unit), (many, 50.0, ZUnit::Metres));
    assert!(has(&info.warnings, "meant to be signed"), "{:?}", info.warnings);
}

#[test]
fn intervals_of_two_headers_are_weighed() {
    let with = |binary: u16, trace: i16| {
        let mut file = built().each(|_, t| t.i16(117, trace));
        file.binary(3217, binary);
        file.scan(&SegyOptions::default())
    };
    assert_eq!(with(0, 2000).unwrap().interval, 2.0);
    assert_eq!(with(2000, 0).unwrap().interval, 2.0);
    let negative = with(-4000_i16 as u16, 4000).unwrap();
    assert_eq!(negative.interval, 4.0);
    assert!(has(&negative.warnings, "61536"));
    let conflict = with(2000, 4000).unwrap();
    assert_eq!(conflict.interval, 2.0);
    assert!(has(&conflict.warnings, "2000 is used"));
    assert!(matches!(with(0, 0).unwrap_err().problem, SegyProblem::NoInterval));
    let stated = SegyOptions { interval: Some(3.0), ..SegyOptions::default() };
    let mut none = built().each(|_, t| t.i16(117, 0));
    none.binary(3217, 0);
    assert_eq!(none.scan(&stated).unwrap().interval, 3.0);
    for wrong in [0.0, -1.0, f64::NAN] {
        let options = SegyOptions { interval: Some(wrong), ..SegyOptions::default() };
        assert!(matches!(none.scan(&options).unwrap_err().problem, SegyProblem::BadSetting { .. }));
    }
}

#[test]
fn the_start_is_the_delay_with_its_scalar_or_lag_a() {
    let delayed = built().each(|_, t| t.i16(109, 876));
    assert_eq!(delayed.info().start, 876.0);
    let scaled = built().each(|_, t| {
        t.i16(109, 8765);
        t.i16(215, -10);
    });
    assert_eq!(scaled.info().start, 876.5);
    let lag = built().each(|_, t| t.i16(105, -300));
    assert_eq!(lag.info().start, 300.0);
    assert!(has(&lag.info().assumptions, "lag time A"));
    let both = built().each(|_, t| {
        t.i16(105, -300);
        t.i16(109, 4);
    });
    assert_eq!(both.info().start, 4.0);
    let stated = SegyOptions { start: Some(12.0), ..SegyOptions::default() };
    assert_eq!(delayed.scan(&stated).unwrap().start, 12.0);
}

#[test]
fn traces_that_start_later_are_padded() {
    let file = built().each(|index, t| t.i16(109, if index == 1 { 108 } else { 100 }));
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!((found.info.start, found.info.samples), (100.0, SAMPLES + 2));
    assert_eq!(found.volume.trace(0, 1), &[0.0, 0.0, 1011.0, 1011.25, 1011.5, 1011.75]);
    assert_eq!(found.volume.trace(0, 0), &[1010.0, 1010.25, 1010.5, 1010.75, 0.0, 0.0]);
    assert!(has(&found.info.warnings, "start at different times"));
    let uneven = built().each(|index, t| t.i16(109, if index == 1 { 102 } else { 100 }));
    assert!(matches!(uneven.refusal().0, SegyProblem::UnevenStart { trace: 2, .. }));
    let far = built().each(|index, t| t.i16(109, if index == 1 { 30_000 } else { 0 }));
    assert!(matches!(far.refusal().0, SegyProblem::UnevenStart { trace: 2, .. }));
}

#[test]
fn the_domain_is_what_the_text_says() {
    let unit = |words: &str, interval: u16, measurement: u16| {
        let mut file = built();
        file.say(1, words);
        file.binary(3217, interval);
        file.binary(3255, measurement);
        file.info()
    };
    assert_eq!(unit("VERTICAL AXIS IS DEPTH", 5000, 1).vertical_unit, ZUnit::Metres);
    assert_eq!(unit("DEPTH MIGRATED (PSDM)", 5000, 2).vertical_unit, ZUnit::Feet);
    assert_eq!(unit("PRESTACK TIME MIGRATION", 4000, 2).vertical_unit, ZUnit::Milliseconds);
    assert_eq!(unit("WATER DEPTH 300 M", 4000, 1).vertical_unit, ZUnit::Milliseconds);
    assert!(has(&unit("WATER DEPTH 300 M", 4000, 1).assumptions, "two-way time"));
    // A stated interval outweighs words.
    assert_eq!(unit("TWT 876-1032 MS, NOW 10 FT SAMPLES", 10_000, 2).vertical_unit, ZUnit::Feet);
    assert_eq!(unit("PSDM STRETCHED TO TIME, SAMPLED AT 4 MS", 4000, 1).vertical_unit, ZUnit::Milliseconds);
    // A template says neither, a name of a file says how somebody called it.
    let named = unit("FILE R2900_PSDM_KIRCH_FULL-T.SGY, TIME MIN 0, TIME MAX 6000", 4000, 1);
    assert_eq!((named.vertical_unit, named.warnings.len()), (ZUnit::Milliseconds, 0), "{:?}", named.warnings);
    let template = unit("C27 TRACE START TIME/DEPTH", 4000, 1);
    assert!(template.assumptions.iter().any(|note| note.to_string().contains("the file does not say")));
    let torn = unit("PSDM IN TWT", 4000, 1);
    assert_eq!(torn.vertical_unit, ZUnit::Milliseconds);
    assert!(has(&torn.warnings, "vertical unit"));
    let whole_metres = unit("DEPTH", 5, 1);
    assert_eq!(whole_metres.interval, 5.0);
    assert!(has(&whole_metres.assumptions, "too little"));
    // A unit of nothing in particular is that of depths, and an interval that is not the file's is told.
    let unowned = unit("PSDM, UNIT: FOOT_US", 10_000, 1);
    assert_eq!(unowned.vertical_unit, ZUnit::SurveyFeet);
    assert!(has(&unowned.warnings, "byte 3255 says m"), "{:?}", unowned.warnings);
    assert!(has(&unit("PSDM", 10_000, 0).assumptions, "neither the text header nor byte 3255 says"));
    for (text, own) in [("SAMPLE RATE 10 FT", 4000), ("DEPTH DOMAIN, INCREMENT 20FT", 10_000)] {
        assert!(has(&unit(text, own, 1).warnings, "text header gives a sample interval"), "{text}");
    }
    for text in [
        "DEPTH INTERVAL 0 TO 5000 M, SHOT STEP 25 M",
        "DEPTH. SAMPLE INTERVAL 10 M AND FIRST SAMPLE 1166 M",
        "DEPTH SAMPLES 0 TO 5000 M",
        "DEPTH, FIRST SAMPLE 20 M, SAMPLING: 10 M, 501 SAMPLES, LAST SAMPLE 5000 M",
    ] {
        let warnings = unit(text, 10_000, 1).warnings;
        assert!(!has(&warnings, "text header gives a sample interval"), "{text}: {warnings:?}");
    }
    let stated = SegyOptions { vertical_unit: Some(ZUnit::Feet), ..SegyOptions::default() };
    assert_eq!(built().scan(&stated).unwrap().vertical_unit, ZUnit::Feet);
}

#[test]
fn feet_become_metres_in_the_geometry_only() {
    let mut file = built();
    file.binary(3255, 2);
    file.say(1, "DEPTH");
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!((found.info.interval, found.info.coordinate_unit), (4.0, LengthUnit::Feet));
    assert!((found.geometry.vertical.interval - 1.2192).abs() < 1e-12);
    assert!((found.geometry.inline_vector.length() - 7.62).abs() < 1e-3);
    assert!(has(&found.info.assumptions, "feet"));
    let metres = SegyOptions { coordinate_unit: Some(LengthUnit::Metres), ..SegyOptions::default() };
    assert!((file.read(&metres).unwrap().geometry.inline_vector.length() - 25.0).abs() < 1e-3);
}

#[test]
fn trace_weights_are_powers_of_two() {
    // The standard: N is 2^-N volts for the least significant bit.
    let file = built().each(|index, t| t.i16(169, [-3, 2, 0, 51][index % 4]));
    let found = file.read(&SegyOptions::default()).unwrap();
    let first = |y: usize| found.volume.at(0, y, 0);
    assert_eq!([first(0), first(1), first(2), first(3)], [8.0 * 1010.0, 1011.0 / 4.0, 1012.0, 1013.0]);
    assert!(has(&found.info.assumptions, "byte 169"));
    let ignore = SegyOptions { trace_weight: TraceWeight::Ignore, ..SegyOptions::default() };
    assert_eq!(file.read(&ignore).unwrap().volume.at(0, 0, 0), 1010.0);
    let inverse = SegyOptions { trace_weight: TraceWeight::Inverse, ..SegyOptions::default() };
    assert_eq!(file.read(&inverse).unwrap().volume.at(0, 0, 0), 1010.0 / 8.0);
}

#[test]
fn what_is_no_number_is_counted_and_no_data() {
    let file = built().each(|index, t| {
        if index == 5 {
            t.floats(&[f32::NAN, 1.0, f32::INFINITY, f32::NEG_INFINITY]);
        }
    });
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!(found.amplitudes.non_finite, 3);
    let trace = found.volume.trace(1, 1);
    assert!(trace[1] == 1.0 && [0, 2, 3].iter().all(|&n| trace[n].is_nan()), "{trace:?}");
    assert!(found.amplitudes.mean.is_finite() && found.amplitudes.samples == 12 * 4 - 3, "{:?}", found.amplitudes);
    assert!(has(&found.info.warnings, "3 samples"));
}

#[test]
fn the_length_of_a_trace_tells_depth_from_time_where_words_do_not() {
    let of = |interval: u16, samples: usize, words: &str| {
        let mut file = built().each(|_, t| {
            t.i16(115, samples as i16);
            t.i16(117, interval.cast_signed());
            t.floats(&vec![1.0; samples]);
        });
        file.binary(3217, interval);
        file.binary(3221, samples as u16);
        file.say(1, words);
        file.info()
    };
    // 25 ms between samples is no survey in time, 25 m is one in depth.
    let silent = of(25_000, 400, "PROJECT NORTH");
    assert_eq!((silent.vertical_unit, silent.interval), (ZUnit::Metres, 25.0));
    assert!(
        has(&silent.assumptions, "400 samples every 25 ms span 9975 ms would be unlikely"),
        "{:?}",
        silent.assumptions
    );
    let whole_metres = of(10, 400, "PROJECT NORTH");
    assert_eq!((whole_metres.vertical_unit, whole_metres.interval), (ZUnit::Metres, 10.0));
    // Both are plausible: time, as is usual, and the evidence says so.
    let both = of(4_000, 1500, "PROJECT NORTH");
    assert_eq!(both.vertical_unit, ZUnit::Milliseconds);
    assert!(has(&both.evidence, "span 5996 ms (plausible), or as a depth"), "{:?}", both.evidence);
    // Words that contradict one another are weighed by it, and the contradiction is reported.
    let torn = of(25_000, 400, "PSDM STACK, TIME DOMAIN");
    assert_eq!(torn.vertical_unit, ZUnit::Metres);
    assert!(has(&torn.warnings, "for which alone the length of a trace is plausible"), "{:?}", torn.warnings);
    // One word alone is followed, and its unlikely length is reported.
    let unlikely = of(25_000, 400, "TWT");
    assert_eq!(unlikely.vertical_unit, ZUnit::Milliseconds);
    assert!(has(&unlikely.warnings, "which is unlikely"), "{:?}", unlikely.warnings);
}
