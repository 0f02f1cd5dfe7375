//! Where the line numbers and coordinates are, and what they make.

use glam::DVec2;

use super::super::{Candidate, KeptDuplicate, LengthUnit, SegyInfo, SegyOptions, SegyProblem, Verdict};
use super::builder::{Built, Trace};
use survey::remedy::{Note, Setting};

pub(super) fn has(notes: &[Note], words: &str) -> bool {
    notes.iter().any(|note| note.to_string().contains(words))
}

fn lines(inline: u16, crossline: u16) -> SegyOptions {
    SegyOptions { inline_byte: Some(inline), crossline_byte: Some(crossline), ..SegyOptions::default() }
}

/// 4 inlines by 6 crosslines.
pub(super) fn grid() -> Built {
    Built::grid(&[101, 102, 103, 104], &[7, 8, 9, 10, 11, 12])
}

/// The same with line numbers at other bytes.
pub(super) fn moved(inline: usize, crossline: usize) -> Built {
    grid().each(|_, t| {
        t.i32(189, 0);
        t.i32(193, 0);
        t.i32(inline, t.inline);
        t.i32(crossline, t.crossline);
    })
}

fn bytes(info: &SegyInfo) -> [u16; 2] {
    [info.byte_positions.inline, info.byte_positions.crossline].map(Option::unwrap)
}

pub(super) fn counts(info: &SegyInfo) -> [usize; 2] {
    [info.inlines.count, info.crosslines.count]
}

#[test]
fn conventions_are_recognised() {
    for (inline, crossline) in [(189, 193), (9, 21), (17, 25), (221, 225)] {
        let info = moved(inline, crossline).info();
        assert_eq!(bytes(&info), [inline as u16, crossline as u16]);
        assert_eq!(counts(&info), [4, 6]);
        assert_eq!(info.candidates[0].verdict, Verdict::Fits);
        assert!(info.candidates[0].residual_bins.unwrap() < 1e-3);
    }
    let petrel = moved(5, 21).each(|_, t| t.place(73, 77)).each(|_, t| {
        t.i32(181, 0);
        t.i32(185, 0);
    });
    assert_eq!(bytes(&petrel.info()), [5, 21]);
    assert_eq!(petrel.info().byte_positions.x, Some(73));
}

#[test]
fn line_numbers_at_any_two_fields_are_found_where_coordinates_confirm_them() {
    let odd = moved(5, 25).each(|index, t| {
        t.i32(181, 0);
        t.i32(185, 0);
        t.place(73, 77);
        // Counters of traces, as any writer leaves them.
        t.i32(1, index as i32 + 1);
        t.i32(13, index as i32 % 6 + 1);
    });
    // Which of the two is the inline cannot be seen: the order of the bytes tells, and the other reading is shown.
    let info = odd.info();
    assert_eq!((bytes(&info), info.byte_positions.x), ([5, 25], Some(73)));
    assert!(info.candidates[0].residual_bins.unwrap() < 1e-3);
    let said = "the lower byte is taken as the inline, as in every convention (if not, state: inline byte 25 and crossline byte 5";
    assert!(has(&info.assumptions, said), "{:?}", info.assumptions);
    let half = SegyOptions { inline_byte: Some(25), ..SegyOptions::default() };
    let info = odd.scan(&half).unwrap();
    assert_eq!((bytes(&info), info.byte_positions.x), ([25, 5], Some(73)));
    assert!(!has(&info.assumptions, "lower byte"));
    // Without coordinates nothing tells a lattice of counters from lines: the user decides.
    let bare = odd.each(|_, t| {
        t.i32(73, 0);
        t.i32(77, 0);
    });
    let (problem, sentence) = bare.refusal();
    let SegyProblem::AmbiguousLines { readings } = problem else { panic!("{sentence}") };
    let found: Vec<[u16; 2]> = readings.iter().map(|r| [r.inline_byte, r.crossline_byte]).collect();
    assert_eq!(found, [[5, 25], [25, 5]], "{sentence}");
}

#[test]
fn line_numbers_of_any_type_at_any_place_are_found() {
    // 2-byte integers between two fields of the standard, and floats where nobody looks.
    let narrow = moved(9, 21).each(|index, t| {
        t.i32(9, 0);
        t.i32(21, 0);
        [93, 149].into_iter().for_each(|byte| t.i16(byte, (index * 7 % 13) as i16));
        t.i16(95, t.inline as i16);
        t.i16(151, t.crossline as i16);
    });
    let info = narrow.info();
    assert_eq!((bytes(&info), counts(&info)), ([95, 151], [4, 6]));
    assert!(has(&info.evidence, "as i16"), "{:?}", info.evidence);
    let floats = moved(49, 57).each(|_, t| {
        t.i32(49, (t.inline as f32).to_bits().cast_signed());
        t.i32(57, (t.crossline as f32).to_bits().cast_signed());
    });
    let info = floats.info();
    assert_eq!((bytes(&info), counts(&info)), ([49, 57], [4, 6]));
    assert!(has(&info.evidence, "as f32"), "{:?}", info.evidence);
    let between = moved(9, 21).each(|_, t| {
        t.i32(9, 0);
        t.i32(21, 0);
        t.i32(31, 1000 * t.inline);
        t.i32(35, 7000 * t.crossline);
        t.i16(29, 1);
    });
    assert_eq!(bytes(&between.info()), [31, 35]);
}

#[test]
fn bytes_of_lines_that_the_text_header_names_are_followed_or_contradicted() {
    // It says which of both is the inline, also against the order of the bytes and of the standard.
    let mut named = moved(57, 49);
    named.say(3, "INLINE NUMBER: BYTES 57-60   CROSSLINE NUMBER: BYTES 49-52");
    let info = named.info();
    assert_eq!((bytes(&info), counts(&info)), ([57, 49], [4, 6]));
    assert!(has(&info.evidence, "named by the text header") && !has(&info.assumptions, "lower byte"));
    let mut swapped = grid();
    swapped.say(3, "INLINE BYTES 193-196, XLINE BYTES 189-192");
    assert_eq!(counts(&swapped.info()), [6, 4]);
    // What is named and holds no lines is reported; what holds them is taken.
    let mut wrong = grid();
    wrong.say(3, "INLINE BYTES 9-12, CROSSLINE BYTES 21-24");
    let info = wrong.info();
    assert_eq!(bytes(&info), [189, 193]);
    assert!(has(&info.warnings, "names bytes that are not taken: bytes 9 and 21: all zero"), "{:?}", info.warnings);
    // The user's word stands above it.
    let mut both = grid().each(|_, t| {
        t.i32(9, 3 * t.inline);
        t.i32(21, 2 * t.crossline);
    });
    both.say(3, "INLINE BYTES 9-12, CROSSLINE BYTES 21-24");
    let info = both.info();
    assert_eq!((bytes(&info), info.inlines.first), ([9, 21], 303));
    assert!(has(&info.evidence, "another reading fits too: bytes 189 and 193"), "{:?}", info.evidence);
    assert_eq!(bytes(&both.scan(&lines(189, 193)).unwrap()), [189, 193]);
}

#[test]
fn coordinates_are_found_at_any_two_neighbouring_fields() {
    let far = grid().each(|index, t| {
        t.i32(181, 0);
        t.i32(185, 0);
        t.place(213, 217);
        t.i32(1, index as i32 + 1);
        t.i32(5, index as i32 % 6 + 1);
    });
    let info = far.info();
    assert_eq!([info.byte_positions.x, info.byte_positions.y], [Some(213), Some(217)]);
    assert!(has(&info.assumptions, "where no convention has them"), "{:?}", info.assumptions);
    assert!((info.geometry.inline_vector[0] - 25.0 * 30_f64.to_radians().cos()).abs() < 1e-2);
    // They win over line numbers at the usual place, as integers, scaled or as floats, and over counters.
    let numbers: [fn(&mut Trace); 4] = [
        |t| (t.i32(181, t.inline), t.i32(185, t.crossline)).0,
        |t| (t.i32(181, 100 * t.crossline), t.i32(185, 100 * t.inline)).0,
        |t| {
            t.i32(181, (t.inline as f32).to_bits().cast_signed());
            t.i32(185, (t.crossline as f32).to_bits().cast_signed());
        },
        |t| (t.i32(181, t.inline - 100), t.i32(185, t.crossline - 6)).0,
    ];
    for (n, number) in numbers.into_iter().enumerate() {
        let info = far.clone().each(|_, t| number(t)).info();
        assert_eq!(info.byte_positions.x, Some(213), "{n}: {:?} {:?}", info.assumptions, info.warnings);
        // Where nothing else is there, what looks like coordinates is doubted, or the place is assumed.
        let alone = grid().each(|_, t| number(t)).info();
        let is_told = has(&alone.warnings, "doubtful")
            || has(&alone.warnings, "which no survey has")
            || has(&alone.assumptions, "the survey lies at 0, 0");
        assert!(is_told, "{n}: {:?} {:?}", alone.assumptions, alone.warnings);
    }
    // One of both that repeats line numbers is doubted too.
    let half = grid().each(|_, t| t.i32(181, t.inline));
    assert!(has(&half.info().warnings, "X is a line number once more"), "{:?}", half.info().warnings);
}

#[test]
fn the_swapped_reading_is_shown_and_can_be_chosen() {
    let info = grid().info();
    assert!(has(&info.evidence, "the swapped reading is bytes 193 and 189 for 6 (7..12) inlines"));
    assert!(has(&info.evidence, "(if not, state: inline byte 193 and crossline byte 189)"));
    let swapped = grid().read(&lines(193, 189)).unwrap();
    assert_eq!(counts(&swapped.info), [6, 4]);
    assert_eq!(swapped.volume.at(5, 1, 0), 102_012.0);
    assert_eq!(swapped.info.sorted_by, "crossline");
}

#[test]
fn two_readings_without_a_convention_that_wins_are_an_error_that_lists_them() {
    // Nothing tells which of two fields of lines is meant.
    let several = moved(197, 205).each(|_, t| t.i32(213, 2 * t.crossline));
    let (problem, sentence) = several.refusal();
    let SegyProblem::AmbiguousLines { readings } = problem else { panic!("{sentence}") };
    let found: Vec<[u16; 2]> = readings.iter().map(|r: &Candidate| [r.inline_byte, r.crossline_byte]).collect();
    assert_eq!(found, [[197, 205], [205, 197], [197, 213], [213, 197]]);
    assert!(sentence.contains("bytes 205 and 197 for 6 (7..12) inlines"), "{sentence}");
    assert!(sentence.contains("or inline byte 205 and crossline byte 197"), "{sentence}");
    assert_eq!(counts(&moved(197, 205).scan(&lines(205, 197)).unwrap()), [6, 4]);
    // One stated byte leaves one reading.
    let half = SegyOptions { inline_byte: Some(205), ..SegyOptions::default() };
    assert_eq!(bytes(&moved(197, 205).scan(&half).unwrap()), [205, 197]);
    let half = SegyOptions { crossline_byte: Some(205), ..SegyOptions::default() };
    assert_eq!(bytes(&moved(197, 205).scan(&half).unwrap()), [197, 205]);
}

#[test]
fn conventions_that_disagree_are_settled_by_coordinates_or_not_at_all() {
    // A second numbering that shears the lattice: still a lattice, but not that of X and Y.
    let both = moved(9, 21).each(|_, t| {
        let sheared = [4, 1, 3, 2][(t.inline - 101) as usize];
        t.i32(17, sheared);
        t.i32(25, t.crossline);
    });
    let info = both.info();
    assert_eq!(bytes(&info), [9, 21]);
    assert!(has(&info.evidence, "X and Y settle"), "{:?}", info.evidence);
    let without = both.each(|_, t| {
        t.i32(181, 0);
        t.i32(185, 0);
    });
    let (problem, sentence) = without.refusal();
    assert!(matches!(problem, SegyProblem::AmbiguousLines { .. }), "{sentence}");
    assert!(sentence.contains("inline byte 17 and crossline byte 25"), "{sentence}");
}

#[test]
fn a_trace_weight_at_189_does_not_pass_for_an_inline() {
    let file = moved(9, 21).each(|_, t| {
        t.i32(189, 3);
        t.i32(193, t.crossline);
    });
    assert_eq!(bytes(&file.info()), [9, 21]);
}

#[test]
fn stated_bytes_that_hold_no_lines_are_refused_with_the_alternatives() {
    let error = moved(9, 21).scan(&lines(189, 193)).unwrap_err();
    let sentence = error.to_string();
    assert!(matches!(error.problem, SegyProblem::StatedBytes { .. }), "{sentence}");
    assert!(
        sentence.contains("bytes 189 and 193: all zero") && sentence.contains("bytes 9 and 21: 4 inlines"),
        "{sentence}"
    );
    for byte in [0, 238, 1000] {
        let error = grid().scan(&lines(byte, 193)).unwrap_err();
        assert!(matches!(error.problem, SegyProblem::BadSetting { setting: Setting::InlineByte, .. }));
    }
}

#[test]
fn lines_may_step_descend_and_be_sorted_by_crossline() {
    let descending = Built::grid(&[40, 30, 20], &[9, 7, 5, 3]).read(&SegyOptions::default()).unwrap();
    let g = &descending.geometry;
    assert_eq!([g.inlines.first, g.inlines.step, g.inlines.last()], [40, -10, 20]);
    assert_eq!([g.crosslines.first, g.crosslines.step, g.crosslines.last()], [9, -2, 3]);
    assert_eq!(descending.volume.at(1, 3, 0), 30_003.0);
    // 10 numbers a line: X and Y know nothing of steps.
    assert!((g.inline_vector.length() - 250.0).abs() < 0.01);

    let mut by_crossline = grid();
    by_crossline.traces.sort_by_key(|t: &Trace| (t.crossline, -t.inline));
    let found = by_crossline.read(&SegyOptions::default()).unwrap();
    assert_eq!(found.info.sorted_by, "crossline");
    assert_eq!((found.geometry.inlines.first, found.geometry.inlines.step), (104, -1));
    assert_eq!(found.volume.at(0, 5, 0), 104_012.0);
}

#[test]
fn gaps_are_not_live_and_do_not_change_the_step() {
    let mut file = grid();
    file.traces.retain(|t| (t.inline + t.crossline) % 5 != 0);
    let missing = 24 - file.traces.len();
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!((counts(&found.info), found.info.missing_traces), ([4, 6], missing));
    let live = found.volume.live().unwrap();
    assert_eq!(live.iter().filter(|&&l| !l).count(), missing);
    assert!(!found.volume.is_live(0, 2) && found.volume.trace(0, 2) == [0.0; 4]);
    // A whole inline is missing.
    let mut file = grid();
    file.traces.retain(|t| t.inline != 103);
    let info = file.info();
    assert_eq!((counts(&info), info.missing_traces, info.inlines.step), ([4, 6], 6, 1));
}

#[test]
fn dead_traces_are_not_live_unless_all_are() {
    let file = grid().each(|index, t| t.i16(29, if index == 3 { 2 } else { 1 }));
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!((found.info.dead_traces, found.info.missing_traces), (1, 0));
    assert!(!found.volume.is_live(0, 3));
    let all = grid().each(|_, t| t.i16(29, 2)).read(&SegyOptions::default()).unwrap();
    assert_eq!(all.volume.live(), None);
    assert!(has(&all.info.warnings, "every trace is flagged dead"));
}

#[test]
fn the_first_of_a_few_duplicates_is_kept() {
    let mut file = grid();
    let mut again = file.traces[2].clone();
    again.floats(&[9.0; 4]);
    file.traces.insert(10, again);
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!(found.info.duplicate_traces, 1);
    assert_eq!(found.volume.at(0, 2, 0), 101_009.0);
    assert!(has(&found.info.warnings, "trace 11"), "{:?}", found.info.warnings);
    let last = SegyOptions { duplicates: Some(KeptDuplicate::Last), ..SegyOptions::default() };
    assert_eq!(file.read(&last).unwrap().volume.at(0, 2, 0), 9.0);
    // A file that is there twice is refused, until it is stated which half to keep.
    let mut twice = grid();
    twice.traces.extend(twice.traces.clone());
    assert!(twice.refusal().1.contains("repeated traces first or last"), "{}", twice.refusal().1);
    assert_eq!(twice.scan(&last).unwrap().duplicate_traces, 24);
}

#[test]
fn traces_without_numbers_are_left_out() {
    let mut file = grid();
    for place in [0, 9, 20] {
        let mut blank = file.traces[0].clone();
        [181, 185, 189, 193].iter().for_each(|&byte| blank.i32(byte, 0));
        file.traces.insert(place, blank);
    }
    let found = file.read(&SegyOptions::default()).unwrap();
    assert_eq!((counts(&found.info), found.info.missing_traces), ([4, 6], 0));
    assert!(has(&found.info.warnings, "3 traces have both line numbers 0"));
}

#[test]
fn the_place_follows_from_x_y_under_every_scalar() {
    let bin = DVec2::new(25.0 * 0.75_f64.sqrt(), 12.5);
    for (scalar, factor, tolerance) in
        [(-100, 100.0, 0.01), (-10, 10.0, 0.1), (0, 1.0, 1.0), (1, 1.0, 1.0), (10, 0.1, 10.0), (-1, 1.0, 1.0)]
    {
        let file = Built::grid(&(1..=30).collect::<Vec<_>>(), &(1..=40).collect::<Vec<_>>()).each(|_, t| {
            let (i, x) = (f64::from(t.inline), f64::from(t.crossline));
            let world = DVec2::new(600_000.0, 6_000_000.0) + bin * i + bin.perp() * x;
            t.i16(71, scalar);
            t.i32(181, (world.x * factor).round() as i32);
            t.i32(185, (world.y * factor).round() as i32);
        });
        let found = file.read(&SegyOptions::default()).unwrap();
        // The fit over all traces is finer than the stored integers.
        assert!((found.geometry.inline_vector - bin).length() < 0.03 * tolerance, "{scalar}");
        assert!((found.geometry.crossline_vector - bin.perp()).length() < 0.03 * tolerance, "{scalar}");
        let first = DVec2::new(600_000.0, 6_000_000.0) + bin + bin.perp();
        assert!((found.geometry.origin - first).length() < tolerance, "{scalar}");
    }
}

#[test]
fn coordinates_elsewhere_or_nowhere() {
    let blank = || grid().each(|_, t| [181, 185].iter().for_each(|&byte| t.i32(byte, 0)));
    let source = blank().each(|_, t| t.place(73, 77)).info();
    assert_eq!((source.byte_positions.x, source.byte_positions.y), (Some(73), Some(77)));
    let odd = blank().each(|_, t| t.place(41, 45));
    let stated = SegyOptions { x_byte: Some(41), y_byte: Some(45), ..SegyOptions::default() };
    assert!(odd.scan(&stated).unwrap().geometry.residual_max_bins.unwrap() < 0.01);
    let none = blank().info();
    assert_eq!((none.byte_positions.x, none.geometry.inline_vector), (None, [25.0, 0.0]));
    assert!(has(&none.assumptions, "25 m"));
    let bin = SegyOptions { bin_m: Some(12.5), ..SegyOptions::default() };
    assert_eq!(grid().scan(&bin).unwrap().geometry.crossline_vector, [0.0, 12.5]);
}

#[test]
fn coordinates_stored_as_floats_are_recognised() {
    let info = grid().each(|_, t| {
        let at = [600_000.0 + 12.5 * t.inline as f32, 6_000_000.0 - 25.0 * t.crossline as f32];
        t.i16(71, 1);
        t.i32(181, at[0].to_bits().cast_signed());
        t.i32(185, at[1].to_bits().cast_signed());
    });
    let info = info.info();
    assert!((DVec2::from(info.geometry.inline_vector) - DVec2::new(12.5, 0.0)).length() < 1e-9, "{:?}", info.geometry);
    assert!((DVec2::from(info.geometry.crossline_vector) - DVec2::new(0.0, -25.0)).length() < 1e-9);
    assert!(has(&info.assumptions, "IEEE floats"));
}

#[test]
fn a_field_that_counts_traces_is_no_line_number() {
    let file = grid().each(|index, t| {
        t.i32(5, index as i32 + 1);
        t.i32(21, t.crossline);
    });
    let info = file.info();
    let counter = info.candidates.iter().find(|c| c.inline_byte == 5).unwrap();
    assert_eq!(counter.verdict, Verdict::Counter);
    assert!(!has(&info.evidence, "another reading"), "{:?}", info.evidence);
}

#[test]
fn coordinates_that_do_not_fit_are_reported() {
    let points: Vec<i32> = (1..=20).collect();
    let stray = Built::grid(&points, &points).each(|index, t| {
        if index == 33 {
            t.i32(181, 0);
        }
    });
    let info = stray.info();
    assert!(
        has(&info.warnings, "X and Y of 1 traces lie more than 0.5 bin off the lattice, trace 34"),
        "{:?}",
        info.warnings
    );
    // The stray trace does not pull the others.
    assert!((DVec2::from(info.geometry.inline_vector).length() - 25.0).abs() < 1e-3);
    // Coordinates that are junk do not make the lines junk.
    let junk = grid().each(|index, t| t.i32(181, (index as i32 * 7919) % 1000 * 100_000)).info();
    assert_eq!(counts(&junk), [4, 6]);
    assert!(has(&junk.warnings, "more than 0.5 bin off"), "{:?}", junk.warnings);
    let skewed = grid().each(|_, t| {
        t.i32(181, 2500 * t.inline + 500 * t.crossline);
        t.i32(185, 2500 * t.crossline);
    });
    assert!(has(&skewed.info().warnings, "not perpendicular"));
}

#[test]
fn angles_are_refused_unless_a_bin_is_stated() {
    let file = in_degrees();
    assert!(file.refusal().1.contains("decimal degrees"), "{}", file.refusal().1);
    let bin = SegyOptions { bin_m: Some(25.0), ..SegyOptions::default() };
    assert!(file.scan(&bin).is_ok());
}

/// X and Y in degrees at the standard's bytes, a thousandth of a degree a bin.
pub(super) fn in_degrees() -> Built {
    grid().each(|_, t| {
        t.i16(71, -1000);
        t.i32(181, 5000 + t.inline);
        t.i32(185, 52_000 + t.crossline);
        t.i16(89, 3);
    })
}

#[test]
fn lengths_that_are_called_angles_are_lengths() {
    assert!(in_degrees().refusal().1.contains("decimal degrees"));
    let called = grid().each(|_, t| t.i16(89, 3)).info();
    assert_eq!((called.byte_positions.x, counts(&called)), (Some(181), [4, 6]));
    assert!(has(&called.warnings, "which no angle does"), "{:?}", called.warnings);
    // What is stated wins.
    let metres = SegyOptions { coordinate_unit: Some(LengthUnit::Metres), ..SegyOptions::default() };
    assert!(in_degrees().scan(&metres).is_ok());
    assert!(in_degrees().refusal().1.contains("unit of X and Y m or ft"), "{}", in_degrees().refusal().1);
    // Bins of five degrees are no survey: metres from a corner of the survey.
    let local = grid().each(|_, t| {
        t.i16(71, 1);
        t.i32(181, 5 * (t.inline - 90));
        t.i32(185, 5 * t.crossline);
        t.i16(89, 3);
    });
    assert!(has(&local.info().warnings, "as angles they would make bins"), "{:?}", local.info().warnings);
    assert!(grid().each(|_, t| t.i16(89, 3)).scan(&metres).unwrap().warnings.is_empty());
}

/// Line numbers at 5 and 21, and once more where X and Y belong.
fn repeated_lines() -> Built {
    moved(5, 21).each(|_, t| {
        t.i32(181, t.inline);
        t.i32(185, t.crossline);
    })
}

#[test]
fn line_numbers_are_no_coordinates() {
    let info = repeated_lines().each(|_, t| t.place(73, 77)).info();
    assert_eq!([info.byte_positions.x, info.byte_positions.y], [Some(73), Some(77)]);
    // Nothing else is there: no bins of 1 m, but assumed ones, and it is said.
    let alone = repeated_lines().info();
    assert_eq!(alone.byte_positions.x, None);
    assert!(has(&alone.assumptions, "do not repeat the line numbers"), "{:?}", alone.assumptions);
    let swapped = repeated_lines().each(|_, t| {
        t.i32(181, t.crossline);
        t.i32(185, t.inline);
    });
    assert_eq!(swapped.info().byte_positions.x, None);
    // What is stated wins.
    let stated = SegyOptions { x_byte: Some(181), y_byte: Some(185), ..SegyOptions::default() };
    assert_eq!(repeated_lines().scan(&stated).unwrap().byte_positions.x, Some(181));
}

#[test]
fn bins_that_no_survey_has_are_not_taken_silently() {
    // Counters at the standard's bytes, coordinates at those of the source.
    let counters = |t: &mut Trace| {
        t.i32(181, 3 * t.inline);
        t.i32(185, 2 * t.crossline);
    };
    let both = grid().each(|_, t| {
        t.place(73, 77);
        counters(t);
    });
    assert_eq!(both.info().byte_positions.x, Some(73));
    let alone = grid().each(|_, t| {
        t.i16(71, -100);
        counters(t);
    });
    let info = alone.info();
    assert_eq!(info.byte_positions.x, Some(181));
    assert!(has(&info.warnings, "make bins of 0.03 by 0.02 m, which no survey has"), "{:?}", info.warnings);
}

#[test]
fn a_text_header_that_names_bytes_is_followed_or_contradicted() {
    // Both places hold a lattice; the text names the second.
    let mut both = grid().each(|_, t| t.place(73, 77));
    assert_eq!(both.info().byte_positions.x, Some(181));
    both.say(5, "C 5 X COORDINATE: BYTES 73-76, Y COORDINATE: BYTES 77-80");
    assert_eq!(both.info().byte_positions.x, Some(73));
    assert!(!has(&both.info().warnings, "names bytes"));
    // It names bytes that hold nothing.
    let mut wrong = grid();
    wrong.say(5, "C 5 X COORDINATE: BYTES 73-76, Y COORDINATE: BYTES 77-80");
    assert_eq!(wrong.info().byte_positions.x, Some(181));
    assert!(has(&wrong.info().warnings, "the text header names bytes 73 and 77"), "{:?}", wrong.info().warnings);
}

#[test]
fn lines_without_a_second_dimension_are_2d() {
    let one = Built::grid(&[500], &(1..40).collect::<Vec<_>>());
    assert!(one.refusal().1.contains("2D line") && one.refusal().1.contains("500 throughout"), "{}", one.refusal().1);
    let one = Built::grid(&(1..40).collect::<Vec<_>>(), &[3]);
    assert!(matches!(one.refusal().0, SegyProblem::TwoDimensional { .. }));
    let cdp = Built::grid(&[0], &(1..40).collect::<Vec<_>>()).each(|_, t| {
        t.i32(193, 0);
        t.i32(21, 1000 + t.crossline);
    });
    assert!(cdp.refusal().1.contains("CDP number (byte 21) counts from 1001 to 1039"), "{}", cdp.refusal().1);
    let mut diagonal = Built::grid(&[0], &[0]);
    diagonal.traces = (1..40).map(|k| diagonal.trace(k, 3 * k)).collect();
    assert!(matches!(diagonal.refusal().0, SegyProblem::TwoDimensional { .. }), "{}", diagonal.refusal().1);
}

#[test]
fn gathers_are_pre_stack() {
    let offsets = |file: Built| {
        let mut file = file;
        file.traces = file
            .traces
            .iter()
            .flat_map(|t| (0..6).map(|k| (k, t.clone())))
            .map(|(k, mut t)| {
                t.i32(37, 100 * (k + 1));
                t
            })
            .collect();
        file
    };
    let (problem, sentence) = offsets(grid()).refusal();
    assert!(matches!(problem, SegyProblem::PreStack { .. }), "{sentence}");
    assert!(sentence.contains("144 traces stand in 24 bins") && sentence.contains("100 to 600"), "{sentence}");
    // One line of a survey is no 2D line where its numbers repeat with other offsets.
    let many: Vec<i32> = (1..40).collect();
    for (one, kind) in [(Built::grid(&[5], &many), "39 crosslines"), (Built::grid(&many, &[7]), "39 inlines")] {
        let (problem, sentence) = offsets(one).refusal();
        assert!(matches!(problem, SegyProblem::PreStack { .. }) && sentence.contains(kind), "{sentence}");
    }
    let line = Built::grid(&[0], &many).each(|_, t| {
        t.i32(193, 0);
        t.i32(21, t.crossline);
    });
    assert!(offsets(line).refusal().1.contains("CDP gathers"));
    // Also where the writer left the inline out, and where there are no offsets either.
    let unnumbered = Built::grid(&[0], &many).each(|_, t| t.i32(21, 0));
    assert!(offsets(unnumbered).refusal().1.contains("39 crosslines"));
    let plain = offsets(Built::grid(&[5], &many)).each(|_, t| t.i32(37, 0));
    let (problem, sentence) = plain.refusal();
    assert!(matches!(problem, SegyProblem::PreStack { may_repeat: true, .. }), "{sentence}");
}

#[test]
fn all_zero_line_headers_list_what_was_tried() {
    let file = grid().each(|_, t| [181, 185, 189, 193].iter().for_each(|&byte| t.i32(byte, 0)));
    let (problem, sentence) = file.refusal();
    assert!(matches!(problem, SegyProblem::NoLineNumbers { .. }), "{sentence}");
    for words in ["bytes 189 and 193: all zero", "bytes 9 and 21: all zero", "inline byte"] {
        assert!(sentence.contains(words), "{sentence}");
    }
}

#[test]
fn numbers_at_random_are_not_lines() {
    let file = grid().each(|index, t| {
        t.i32(189, (index as i32).wrapping_mul(1_103_515_245) ^ 0x3512);
        t.i32(193, (index as i32).wrapping_mul(1_664_525) ^ 0x77);
        [181, 185].iter().for_each(|&byte| t.i32(byte, 0));
    });
    assert!(matches!(file.refusal().0, SegyProblem::NoLineNumbers { .. } | SegyProblem::TwoDimensional { .. }));
    let error = file.scan(&lines(189, 193)).unwrap_err();
    assert!(error.to_string().contains("scattered"), "{error}");
}
