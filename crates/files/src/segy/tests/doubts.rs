//! Coordinates of another unit or scalar, and fields that are exchanged with others.

use super::super::SegyOptions;
use super::detection::{counts, grid, has, in_degrees, moved};

#[test]
fn what_would_make_bins_plausible_is_said() {
    // Centimetres without a scalar.
    let unscaled = grid().each(|_, t| t.i16(71, 0)).info();
    let expected = "with a coordinate scalar of -100 in place of 0 they would be 25.00 by 25.00 m";
    assert!(has(&unscaled.warnings, expected), "{:?}", unscaled.warnings);
    // What states it is offered first.
    assert!(has(&unscaled.warnings, "(if not, state: coordinate scalar -100, or X byte"), "{:?}", unscaled.warnings);
    let stated = SegyOptions { coordinate_scalar: Some(-100), ..SegyOptions::default() };
    let info = grid().each(|_, t| t.i16(71, 0)).scan(&stated).unwrap();
    assert_eq!((info.coordinate_scalar, info.warnings.len()), ([-100; 2], 0));
    // Degrees that byte 89 does not name.
    let degrees = in_degrees().each(|_, t| t.i16(89, 0)).info();
    assert!(has(&degrees.warnings, "bins of 0.001 by 0.001 m"), "{:?}", degrees.warnings);
    assert!(has(&degrees.warnings, "may be degrees"), "{:?}", degrees.warnings);
    // Bytes that are stated are taken, and their bins said all the same.
    let stated = SegyOptions { x_byte: Some(181), y_byte: Some(185), ..SegyOptions::default() };
    let info = grid().each(|_, t| t.i16(71, 0)).scan(&stated).unwrap();
    assert!(has(&info.warnings, "make bins of 2500"), "{:?}", info.warnings);
}

#[test]
fn lines_and_coordinates_that_are_exchanged_are_found() {
    let file = grid().each(|_, t| {
        t.place(189, 193);
        t.i32(181, t.inline);
        t.i32(185, t.crossline);
    });
    let info = file.info();
    let bytes = info.byte_positions;
    assert_eq!((bytes.inline, bytes.crossline, bytes.x, bytes.y), (Some(181), Some(185), Some(189), Some(193)));
    assert_eq!((counts(&info), info.geometry.residual_max_bins.is_some()), ([4, 6], true));
    assert!(has(&info.assumptions, "bytes 181 and 185 hold the line numbers"), "{:?}", info.assumptions);
}

#[test]
fn field_records_whose_lattice_coordinates_confirm_are_lines() {
    let records = |has_coordinates: bool| {
        moved(9, 13).each(move |_, t| {
            [181, 185].iter().for_each(|&byte| t.i32(byte, 0));
            if has_coordinates {
                t.place(197, 201);
            }
        })
    };
    let info = records(true).info();
    assert_eq!((info.byte_positions.inline, info.byte_positions.x, counts(&info)), (Some(9), Some(197), [4, 6]));
    assert!(records(false).refusal().1.contains("shot gathers"), "{}", records(false).refusal().1);
}
