//! Files whose headers number no lines: the lattice that X and Y make, and numbers of other types.

use glam::DVec2;

use super::super::{LineSource, NumberType, SegyInfo, SegyOptions, SegyProblem};
use super::builder::{Built, Trace};

const ORIGIN: DVec2 = DVec2::new(605_000.0, 6_073_000.0);

/// Traces at `ORIGIN + i·a + x·b`, rounded to whole `unit`s, without line numbers; sample 0 is `1000·i + x`.
fn placed(lines: [i32; 2], a: DVec2, b: DVec2, unit: f64) -> Built {
    let [inlines, crosslines] = lines.map(|count| (1..=count).collect::<Vec<_>>());
    Built::grid(&inlines, &crosslines).each(|_, t| {
        let world = ORIGIN + a * f64::from(t.inline) + b * f64::from(t.crossline);
        blank(t);
        t.i16(71, -100);
        t.i32(181, ((world.x / unit).round() * unit * 100.0).round() as i32);
        t.i32(185, ((world.y / unit).round() * unit * 100.0).round() as i32);
    })
}

fn blank(trace: &mut Trace) {
    [189, 193].iter().for_each(|&byte| trace.i32(byte, 0));
}

fn turned(bin: [f64; 2], degrees: f64) -> [DVec2; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [DVec2::new(cos, sin) * bin[0], DVec2::new(-sin, cos) * bin[1]]
}

fn vectors(info: &SegyInfo) -> [DVec2; 2] {
    [info.geometry.inline_vector.into(), info.geometry.crossline_vector.into()]
}

fn counts(info: &SegyInfo) -> [usize; 2] {
    [info.inlines.count, info.crosslines.count]
}

#[test]
fn any_rotation_bin_and_handedness_is_found() {
    for bin in [[25.0, 25.0], [12.5, 25.0], [25.0, 12.5], [12.5, 75.0], [-25.0, 12.5]] {
        for degrees in [0.0, 17.3, 45.0, 62.0, 90.0, 151.0, 240.0, 333.3] {
            let [a, b] = turned(bin, degrees);
            let found = placed([17, 23], a, b, 0.01).read(&SegyOptions::default()).unwrap();
            assert_eq!(counts(&found.info), [17, 23], "{bin:?} {degrees}");
            let [inline, crossline] = vectors(&found.info);
            assert!(
                (inline - a).length() < 0.01 && (crossline - b).length() < 0.01,
                "{bin:?} {degrees} {inline} {crossline}"
            );
            assert_eq!(found.volume.at(4, 6, 0), 5007.0);
            assert_eq!(found.info.byte_positions.inline, None);
            assert!(found.info.geometry.residual_max_bins.unwrap() < 0.002);
        }
    }
}

#[test]
fn coordinates_rounded_to_metres_holes_and_outlines_do_not_matter() {
    let mut state = 5_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 16
    };
    for degrees in [0.0, 12.0, 33.0, 71.0] {
        let [a, b] = turned([12.5, 18.75], degrees);
        let mut file = placed([90, 110], a, b, 1.0);
        // An ellipse, with a hole, and one trace in six missing.
        file.traces.retain(|t| {
            let at = DVec2::new(f64::from(t.inline) / 45.0 - 1.0, f64::from(t.crossline) / 55.0 - 1.0);
            at.length() < 1.0 && (at - DVec2::splat(0.3)).length() > 0.2 && random() % 6 > 0
        });
        let found = file.read(&SegyOptions::default()).unwrap();
        let [inline, crossline] = vectors(&found.info);
        assert!((inline - a).length() < 0.02 && (crossline - b).length() < 0.02, "{degrees}: {inline} {crossline}");
        let first_inline = file.traces.iter().map(|t| t.inline).min().unwrap();
        let first_crossline = file.traces.iter().map(|t| t.crossline).min().unwrap();
        for t in &file.traces {
            let (x, y) = ((t.inline - first_inline) as usize, (t.crossline - first_crossline) as usize);
            assert_eq!(found.volume.at(x, y, 0), (1000 * t.inline + t.crossline) as f32);
        }
        assert_eq!(found.info.duplicate_traces, 0);
        assert!(found.info.geometry.residual_max_bins.unwrap() < 0.08);
        assert!(
            found.info.assumptions.iter().any(|a| a.fact.contains("numbered from 1")),
            "{:?}",
            found.info.assumptions
        );
    }
}

#[test]
fn a_skewed_survey_keeps_the_axes_it_was_stored_by() {
    let a = DVec2::new(25.0, 16.0);
    let b = DVec2::new(0.0, 20.0);
    let found = placed([20, 30], a, b, 0.01).read(&SegyOptions::default()).unwrap();
    let [inline, crossline] = vectors(&found.info);
    assert!((crossline - b).length() < 1e-2, "{crossline}");
    // a − b is shorter than a and leads to the same inlines; either is right, with crosslines counted along.
    assert!((inline - (a - b)).length() < 1e-2, "{inline}");
    assert!(found.info.warnings.iter().any(|w| w.fact.contains("not perpendicular")));
}

#[test]
fn a_survey_that_is_stored_backwards_counts_as_it_is_stored() {
    let [a, b] = turned([25.0, 12.5], 20.0);
    let mut file = placed([12, 15], a, b, 0.01);
    file.traces.reverse();
    let found = file.read(&SegyOptions::default()).unwrap();
    assert!((vectors(&found.info)[0] + a).length() < 0.01);
    assert_eq!(found.volume.at(0, 0, 0), 12_015.0);
}

#[test]
fn the_exchanged_axes_can_be_chosen_and_headers_overruled() {
    let [a, b] = turned([25.0, 12.5], 20.0);
    let file = placed([12, 15], a, b, 0.01);
    let swapped = SegyOptions { line_source: LineSource::CoordinatesSwapped, ..SegyOptions::default() };
    let found = file.read(&swapped).unwrap();
    assert_eq!(counts(&found.info), [15, 12]);
    assert_eq!(found.volume.at(6, 4, 0), 5007.0);
    let numbered = Built::grid(&[101, 102, 103], &[7, 8, 9, 10]);
    let stated = SegyOptions { line_source: LineSource::Coordinates, ..SegyOptions::default() };
    let info = numbered.scan(&stated).unwrap();
    assert_eq!((info.inlines.first, info.crosslines.last), (1, 4));
    assert_eq!(numbered.info().inlines.first, 101);
}

#[test]
fn shuffled_traces_make_the_same_lattice_and_say_that_axes_are_unknown() {
    let [a, b] = turned([25.0, 12.5], 20.0);
    let mut file = placed([12, 15], a, b, 0.01);
    file.traces.sort_by_key(|t| (t.inline * 7919 + t.crossline * 104_729) % 1009);
    let info = file.info();
    let mut sides = counts(&info);
    sides.sort_unstable();
    assert_eq!((sides, info.missing_traces), ([12, 15], 0));
    assert!(info.assumptions.iter().any(|a| a.fact.contains("does not tell which axis")), "{:?}", info.assumptions);
}

#[test]
fn a_few_traces_without_a_place_are_left_out() {
    let [a, b] = turned([25.0, 12.5], 20.0);
    let file = placed([12, 15], a, b, 0.01).each(|index, t| {
        if index % 40 == 3 {
            t.i32(181, 0);
            t.i32(185, 0);
        }
    });
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!((counts(&found.info), found.info.missing_traces), ([12, 15], 5));
    assert!(
        found.info.warnings.iter().any(|w| w.fact.contains("5 traces have no X and Y")),
        "{:?}",
        found.info.warnings
    );
}

#[test]
fn what_is_no_lattice_is_refused_with_the_reason() {
    let mut state = 9_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as i32
    };
    let places: Vec<[i32; 2]> = (0..200).map(|_| [random() % 1_000_000, random() % 1_000_000]).collect();
    let scattered = placed([10, 20], DVec2::X, DVec2::Y, 0.01).each(|index, t| {
        t.i32(181, places[index][0]);
        t.i32(185, places[index][1]);
    });
    let (problem, sentence) = scattered.refusal();
    assert!(matches!(problem, SegyProblem::NoLattice { .. }), "{sentence}");
    assert!(sentence.contains("within a quarter of a bin") && sentence.contains("inline byte"), "{sentence}");

    let straight = placed([1, 60], DVec2::X, DVec2::new(9.0, 12.0), 1.0);
    assert!(straight.refusal().1.contains("along one line"), "{}", straight.refusal().1);
    let mut bent = placed([1, 60], DVec2::X, DVec2::new(25.0, 0.0), 1.0);
    let corner = bent.traces[30].clone();
    bent.traces.extend((1..60).map(|k| {
        let mut t = corner.clone();
        t.i32(185, 607_300_000 + 2500 * k);
        t
    }));
    assert!(bent.refusal().1.contains("bends"), "{}", bent.refusal().1);

    // Two traces at every place.
    let [a, b] = turned([25.0, 12.5], 20.0);
    let mut gathers = placed([12, 15], a, b, 0.01);
    gathers.traces = gathers.traces.iter().flat_map(|t| [t.clone(), t.clone()]).collect();
    let (problem, sentence) = gathers.refusal();
    assert!(matches!(problem, SegyProblem::PreStack { .. }) && sentence.contains("180 places"), "{sentence}");
}

#[test]
fn numbers_of_other_types_are_found_and_can_be_stated() {
    let grid = || Built::grid(&[1207, 1208, 1209, 1210], &[7, 8, 9, 10, 11, 12]).each(|_, t| blank(t));
    let float = grid().each(|_, t| {
        t.i32(189, (t.inline as f32).to_bits().cast_signed());
        t.i32(193, (t.crossline as f32).to_bits().cast_signed());
    });
    // The bits of consecutive floats are far apart, but evenly: as integers they are a lattice too.
    let info = float.info();
    assert_eq!(counts(&info), [4, 6], "{:?}", info.candidates);
    assert_eq!((info.inlines.first, info.crosslines.last), (1207, 12), "{:?}", info.evidence);
    let narrow = grid().each(|_, t| {
        t.i16(189, t.inline as i16);
        t.i16(191, t.crossline as i16);
    });
    let info = narrow.info();
    assert_eq!((info.inlines.first, info.crosslines.first), (1207, 7), "{:?}", info.evidence);
    assert_eq!(info.byte_positions.crossline, Some(191));
    let stated = SegyOptions {
        inline_byte: Some(189),
        crossline_byte: Some(191),
        line_type: Some(NumberType::I16),
        ..SegyOptions::default()
    };
    assert_eq!(narrow.scan(&stated).unwrap().inlines, info.inlines);
    let last = SegyOptions { crossline_byte: Some(239), ..stated };
    assert!(matches!(
        narrow.scan(&last).unwrap_err().problem,
        SegyProblem::StatedBytes { .. } | SegyProblem::TwoDimensional { .. }
    ));
}

#[test]
fn coordinates_of_any_type_and_scalar_elsewhere() {
    let grid = || Built::grid(&(1..=8).collect::<Vec<_>>(), &(1..=9).collect::<Vec<_>>());
    let bins = |info: &SegyInfo| vectors(info).map(DVec2::length);
    let ibm = grid().each(|_, t| {
        let put = |value: f32| super::super::ibm_from_f32(value).cast_signed();
        t.i32(181, put(600_000.0 + 12.5 * t.inline as f32));
        t.i32(185, put(6_000_000.0 + 25.0 * t.crossline as f32));
    });
    let stated = SegyOptions { coordinate_type: Some(NumberType::Ibm32), ..SegyOptions::default() };
    let are_bins = |info: &SegyInfo| bins(info).iter().zip([12.5, 25.0]).all(|(found, bin)| (found - bin).abs() < 1e-6);
    assert!(are_bins(&ibm.scan(&stated).unwrap()), "{:?}", ibm.scan(&stated));
    let double = grid().each(|_, t| {
        for (byte, value) in [(41, 600_000.0 + 12.5 * f64::from(t.inline)), (49, 6e6 + 25.0 * f64::from(t.crossline))] {
            let bits: u64 = f64::to_bits(value);
            t.i32(byte, ((bits >> 32) as u32).cast_signed());
            t.i32(byte + 4, (bits as u32).cast_signed());
        }
    });
    let stated = SegyOptions {
        x_byte: Some(41),
        y_byte: Some(49),
        coordinate_type: Some(NumberType::F64),
        ..SegyOptions::default()
    };
    assert!(are_bins(&double.scan(&stated).unwrap()));
    // A scalar of one half-hundredth elsewhere, or stated.
    let elsewhere = grid().each(|_, t| {
        t.i16(71, 1);
        t.i16(201, -100);
    });
    let stated = SegyOptions { scalar_byte: Some(201), ..SegyOptions::default() };
    assert!((bins(&elsewhere.scan(&stated).unwrap())[0] - 25.0).abs() < 1e-3);
    let stated = SegyOptions { coordinate_scalar: Some(-100), ..SegyOptions::default() };
    assert!((bins(&elsewhere.scan(&stated).unwrap())[0] - 25.0).abs() < 1e-3);
}
