//! Patterns of one printed size: how many they are over a zoom, and that nothing pops.

use super::*;

#[test]
fn elements_on_paper_hardly_vary_over_a_factor_of_64() {
    let densities = (0..=6000).map(|n| {
        let magnified = 64f64.powf(f64::from(n) / 6000.0);
        let Frequencies { factor, finer_share } = Frequencies::at(magnified);
        // Elements on an area, of each of the two patterns, counted by how much of each is seen.
        let of = |factor: f64| (factor / magnified).powi(2);
        let (coarse, finer) = (of(f64::from(factor)), of(f64::from(factor * ttf::FINER)));
        let alone = of(f64::from(Frequencies::at(magnified).alone().factor));
        [alone, coarse + f64::from(finer_share) * (finer - coarse)]
    });
    let (least, most) = densities.flatten().fold((f64::MAX, 0.0f64), |(least, most), d| (least.min(d), most.max(d)));
    assert!(most / least < 1.5, "{}", most / least);
}

#[test]
fn nothing_pops_and_the_whole_survey_stays_as_it_is() {
    assert_eq!(Frequencies::at(1.0), Frequencies { factor: 1.0, finer_share: 0.0 });
    let mut last = Frequencies::at(1.0);
    for n in 1..=20_000 {
        let next = Frequencies::at(64f64.powf(f64::from(n) / 20_000.0));
        // Either the share changes a little, or all of the finer pattern becomes the coarser of the next step.
        let changed = if next.factor == last.factor {
            next.finer_share - last.finer_share
        } else {
            1.0 - last.finer_share + next.finer_share
        };
        assert!((0.0..0.01).contains(&changed), "{last:?} {next:?}");
        last = next;
    }
}
