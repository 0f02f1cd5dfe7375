//! Geologic time slab by slab against the whole.

use super::*;
use crate::{JoinedSlabs, Slabs, surfaces_within};
use survey::source::BoxSource;

/// τ of a volume in slabs of a width that this memory allows.
fn in_slabs(volume: &Volume<f32>, interpretation: &Interpretation, memory_bytes: u64) -> (Volume<f32>, usize) {
    let [_, ny, nz] = volume.size();
    let surfaces = grow_surfaces(volume, &GrowSettings::default(), &Progress::silent()).unwrap();
    let slabs = Slabs::within(volume.size(), memory_bytes);
    let (mut joined, mut all) = (JoinedSlabs::default(), Vec::new());
    for (n, range) in slabs.ranges().iter().enumerate() {
        let part = volume.read_box([range.start, 0, 0], [range.len(), ny, nz]).unwrap();
        let (own, told) = (surfaces_within(&surfaces, range), interpretation.within(range));
        let found = geologic_time(&part, &own, &told, &TimeSettings::default(), &Progress::silent()).unwrap();
        all.extend(joined.add(&found.tau, n + 1 == slabs.ranges().len()));
    }
    (Volume::from_samples(volume.size(), all).unwrap(), slabs.ranges().len())
}

#[test]
fn slabs_cover_every_inline_overlap_and_fit() {
    for (nx, memory) in [(97, 1u64), (300, 40 << 20), (1000, 90 << 20), (64, 1)] {
        let slabs = Slabs::within([nx, 100, 50], memory);
        let ranges = slabs.ranges();
        assert_eq!((ranges[0].start, ranges[ranges.len() - 1].end), (0, nx));
        assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start + 32 && pair[1].end > pair[0].end));
        let line = 100 * 50 * 52;
        assert!(ranges.iter().all(|range| range.len() <= (memory as usize / line).max(96)), "{ranges:?}");
    }
}

#[test]
fn a_survey_in_slabs_has_the_isochrons_of_the_whole() {
    // Beds that dip along both axes and thin along inlines, with a fault that the joints of slabs cross.
    let fault = |y: f32| 60.0 + 2.0 * y;
    let strat =
        |x: f32, y: f32, z: f32| z * (1.0 + x / 900.0) - 0.1 * x + 0.2 * y + if x > fault(y) { 7.0 } else { 0.0 };
    let volume = volume([224, 36, 80], strat);
    let cut = Cut::new(Across::Inlines, 36, 80, |line, _| fault(line as f32));
    let interpretation = Interpretation::from(vec![cut]);
    let (tau, count) = in_slabs(&volume, &interpretation, 1);
    assert_eq!(count, 3);
    let off = |tau: &Volume<f32>| errors(tau, strat, |_, _| true);
    let whole = off(&time_with(&volume, &interpretation).tau);
    let slabs = off(&tau);
    assert!(slabs.1 > 0.95 * whole.1, "{slabs:?} {whole:?}");
    // Beside the fault, which crossings cannot tell from the other side, both err; what counts is the bulk.
    let share = |tau: &Volume<f32>| {
        let wanted = strat(20.0, 18.0, 40.0);
        let all = isochron(tau, tau.at(20, 18, 40)).crossings;
        let right = all.iter().filter(|at| (strat(at.x.into(), at.y.into(), at.z) - wanted).abs() < 0.5).count();
        right as f32 / (224 * 36) as f32
    };
    let (whole, slabs) = (share(&time_with(&volume, &interpretation).tau), share(&tau));
    assert!(whole > 0.85 && slabs > 0.97 * whole, "{slabs} of {whole}");
}

#[test]
fn one_slab_is_the_whole_to_the_bit() {
    let volume = volume([40, 30, 64], |x, y, z| z - 0.3 * x + 0.1 * y);
    let (tau, count) = in_slabs(&volume, &Interpretation::default(), u64::MAX);
    assert_eq!(count, 1);
    let bits = |tau: &Volume<f32>| tau.samples().iter().map(|t| t.to_bits()).collect::<Vec<_>>();
    assert!(bits(&tau) == bits(&time_of(&volume, &[]).tau));
}
