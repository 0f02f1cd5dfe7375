//! Holes filled beside closed forms, and never across a fault.

use super::*;
use survey::{SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;

const SIZE: [usize; 2] = [60, 50];

fn sheet(height: impl Fn(f32, f32) -> f32, missing: impl Fn(usize, usize) -> bool) -> VoxelSheet {
    let mut sheet = VoxelSheet::empty(0, SIZE[0] * SIZE[1]);
    for n in 0..sheet.z.len() {
        let (x, y) = (n / SIZE[1], n % SIZE[1]);
        if !missing(x, y) {
            sheet.z[n] = height(x as f32, y as f32);
            sheet.quality[n] = Quality::Tracked;
        }
    }
    sheet
}

fn disc(x: usize, y: usize, [cx, cy]: [usize; 2], radius: usize) -> bool {
    x.abs_diff(cx).pow(2) + y.abs_diff(cy).pow(2) <= radius * radius
}

fn filled(sheet: &VoxelSheet, settings: &FillSettings) -> (Filled, VoxelSheet) {
    let mut sheets = [sheet.clone()];
    let done = fill_holes(&mut sheets, SIZE, &FaultNetwork::none(), settings, &Progress::silent()).unwrap();
    let [sheet] = sheets;
    (done, sheet)
}

#[test]
fn holes_are_what_is_enclosed() {
    let broken = sheet(
        |_, _| 5.0,
        |x, y| disc(x, y, [20, 20], 3) || disc(x, y, [40, 30], 1) || disc(x, y, [0, 10], 4) || x > 56,
    );
    let holes = find_holes(&[broken], SIZE);
    assert_eq!(holes.iter().map(|hole| (hole.traces, hole.at)).collect::<Vec<_>>(), [(29, [20, 20]), (5, [40, 30])]);
    let small: Vec<u32> =
        [(39, 30), (40, 29), (40, 30), (40, 31), (41, 30)].map(|(x, y)| x * SIZE[1] as u32 + y).into();
    assert_eq!(holes[1].nodes(), small);
}

#[test]
fn a_plane_is_filled_with_itself() {
    let plane = |x: f32, y: f32| 12.0 + 0.5 * x - 0.25 * y;
    let (done, whole) = filled(&sheet(plane, |x, y| disc(x, y, [30, 25], 15)), &FillSettings::default());
    assert_eq!((done.holes, done.across_faults, done.left), (1, 0, 0));
    for (n, z) in whole.z.iter().enumerate() {
        let wanted = plane((n / SIZE[1]) as f32, (n % SIZE[1]) as f32);
        assert!((z - wanted).abs() < 1e-3, "{n}: {z}, expected {wanted}");
    }
    let made = whole.quality.iter().filter(|quality| **quality == Quality::Filled).count();
    assert_eq!(made, done.nodes);
}

/// x²·y is no minimum of the energy in general, but a harmonic or biharmonic polynomial is: x³ − 3xy² of
/// both.
#[test]
fn a_biharmonic_surface_is_filled_with_itself() {
    let saddle = |x: f32, y: f32| {
        let (x, y) = ((x - 30.0) / 12.0, (y - 25.0) / 12.0);
        20.0 + x * x * x - 3.0 * x * y * y + x * x
    };
    let (_, whole) = filled(&sheet(saddle, |x, y| disc(x, y, [30, 25], 9)), &FillSettings::default());
    for (n, z) in whole.z.iter().enumerate() {
        let wanted = saddle((n / SIZE[1]) as f32, (n % SIZE[1]) as f32);
        assert!((z - wanted).abs() < 5e-3, "{n}: {z}, expected {wanted}");
    }
}

/// Any other filling has more curvature.
#[test]
fn the_filling_bends_least() {
    let rough = |x: f32, y: f32| 20.0 + (0.3 * x).sin() + (0.2 * x + 0.4 * y).cos();
    let (_, whole) = filled(&sheet(rough, |x, y| disc(x, y, [30, 25], 8)), &FillSettings::default());
    let bending = |z: &[f32]| -> f64 {
        let at = |x: usize, y: usize| f64::from(z[x * SIZE[1] + y]);
        let mut sum = 0.0;
        for x in 1..SIZE[0] - 1 {
            for y in 1..SIZE[1] - 1 {
                sum += (at(x - 1, y) - 2.0 * at(x, y) + at(x + 1, y)).powi(2);
                sum += (at(x, y - 1) - 2.0 * at(x, y) + at(x, y + 1)).powi(2);
                sum += 2.0 * (at(x, y) - at(x, y + 1) - at(x + 1, y) + at(x + 1, y + 1)).powi(2);
            }
        }
        sum
    };
    let least = bending(&whole.z);
    for (n, _) in whole.quality.iter().enumerate().filter(|(_, quality)| **quality == Quality::Filled) {
        for by in [0.05, -0.05] {
            let mut other = whole.z.clone();
            other[n] += by;
            assert!(bending(&other) > least);
        }
    }
}

#[test]
fn large_holes_stay_when_only_small_ones_are_asked_for() {
    let broken = sheet(|_, _| 5.0, |x, y| disc(x, y, [20, 20], 8) || disc(x, y, [40, 30], 2));
    let (done, rest) = filled(&broken, &FillSettings { max_traces: Some(50), ..FillSettings::default() });
    assert_eq!((done.holes, done.left, done.nodes), (1, 1, 13));
    assert_eq!(find_holes(&[rest], SIZE).len(), 1);
}

/// A hole that reaches over a fault is filled up to it only.
#[test]
fn no_filling_crosses_a_fault() {
    let geometry = SurveyGeometry::regular([SIZE[0], SIZE[1], 64], 10.0, 10.0, VerticalUnit::Metres);
    let model = ClosedForm::flat(&geometry, &[31.5]).with_fault(60.0, 0.0);
    let faults = FaultNetwork::build(&geometry, &model.faults, &Progress::silent()).unwrap();
    let side = |n: usize| faults.block_at(Vec3::new((n / SIZE[1]) as f32, (n % SIZE[1]) as f32, 31.5));
    // A sheet all around, wrongly beyond the fault too; the hole lies across it.
    let mut sheets = [sheet(|_, _| 31.5, |x, y| disc(x, y, [30, 25], 6))];
    let own = side(10 * SIZE[1]);
    sheets[0].block = own;
    let done = fill_holes(&mut sheets, SIZE, &faults, &FillSettings::default(), &Progress::silent()).unwrap();
    assert!(done.nodes > 40 && done.across_faults > 40, "{done:?}");
    for (n, quality) in sheets[0].quality.iter().enumerate() {
        assert!(*quality != Quality::Filled || side(n) == own);
    }
}

#[test]
fn a_cancelled_filling_stops() {
    let mut sheets = [sheet(|_, _| 5.0, |x, y| disc(x, y, [20, 20], 3))];
    let progress = Progress::silent();
    progress.cancel();
    assert!(fill_holes(&mut sheets, SIZE, &FaultNetwork::none(), &FillSettings::default(), &progress).is_err());
}
