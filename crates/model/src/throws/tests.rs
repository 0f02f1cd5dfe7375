//! Throw, heave, tips and sense of faults in models of closed form.

use super::*;
use crate::closed_form::{FaultForm, ModelForm};
use crate::{ModelSettings, StructuralModel};
use survey::progress::Progress;
use survey::stratigraphy::Contact;

/// A fault that dips towards larger x by one voxel a sample and a half.
const RUN: f64 = 2.0 / 3.0;

fn form(y: [f64; 2], sheet: crate::closed_form::SheetForm) -> ModelForm {
    let fault = FaultForm { at: |_, z| 35.0 + RUN * (z - 30.0), y, z: [-5.0, 65.0], truncated_by: None };
    ModelForm::new([70, 60, 60], vec![fault], vec![Contact::Conformable; 3], sheet)
}

fn level(h: usize) -> f64 {
    14.0 + 11.0 * h as f64
}

#[test]
fn throw_and_heave_of_planes_are_exact() {
    // Beds that dip along strike: both cut-offs of a place along it lie at one place of the beds.
    let down = form([-5.0, 65.0], |h, bits, _, y| level(h) + 0.1 * (y - 30.0) + 6.0 * f64::from(bits)).model();
    let throws = FaultThrows::new(&down, 0);
    let profile = throws.profile(9);
    assert_eq!(profile.len(), 3);
    for HorizonThrows { throws: along, tips_m, .. } in &profile {
        assert!(along.len() >= 9 && tips_m.is_empty(), "{} {tips_m:?}", along.len());
        for throw in along {
            assert!((throw.samples().abs() - 6.0).abs() < 0.02, "{}", throw.samples());
            // Six samples down, four voxels of 25 m aside.
            assert!((throw.heave_m(down.metric()) - 100.0).abs() < 0.5);
            assert!(throw.is_told() && !throw.is_inferred() && throw.least_samples() < 1.01);
        }
    }
    let sense = throws.sense().unwrap();
    assert_eq!((sense.is_normal, sense.is_inferred), (Some(true), false));
    let east_is_positive = throws.positive_side().x > 0.0;
    assert_eq!(sense.is_positive_down, east_is_positive);
}

#[test]
fn beds_that_dip_across_a_fault_have_the_throw_of_their_cut_offs() {
    let dip = 0.2;
    let tilted = form([-5.0, 65.0], |h, bits, x, _| level(h) + 0.2 * (x - 35.0) + 6.0 * f64::from(bits)).model();
    // Down the fault by t the beds dip by dip · RUN · t more.
    let exact = 6.0 / (1.0 - dip * RUN);
    for throw in FaultThrows::new(&tilted, 0).at(0.0) {
        assert!((throw.samples().abs() - exact).abs() < 0.02, "{} {exact}", throw.samples());
    }
}

#[test]
fn a_place_on_a_side_of_the_volume_has_its_throws_where_the_dip_leads_out_of_it() {
    // A fault at 35° to the side y = 0.
    let fault = FaultForm {
        at: |y, z| 25.0 + RUN * (z - 30.0) + 0.7 * (y - 5.0),
        y: [-5.0, 65.0],
        z: [-5.0, 65.0],
        truncated_by: None,
    };
    let sheet = |h: usize, bits: u32, _: f64, _: f64| level(h) + 6.0 * f64::from(bits);
    let model = ModelForm::new([70, 60, 60], vec![fault], vec![Contact::Conformable; 3], sheet).model();
    let throws = FaultThrows::new(&model, 0);
    for h in 0..3 {
        let z = level(h) + 3.0;
        let p = DVec3::new(25.0 + RUN * (z - 30.0) - 3.5, 0.0, z);
        let near = throws.near(p);
        let throw = near.iter().find(|throw| throw.horizon == h).expect("its cut-offs lie beside the volume");
        assert!((throw.samples().abs() - 6.0).abs() < 0.1 && throw.is_told() && !throw.is_inferred(), "{throw:?}");
    }
}

#[test]
fn a_reverse_fault_is_reverse() {
    let up = form([-5.0, 65.0], |h, bits, x, y| level(h) + 0.1 * (x - y) - 5.0 * f64::from(bits)).model();
    let throws = FaultThrows::new(&up, 0);
    assert_eq!(throws.sense().unwrap().is_normal, Some(false));
    assert!(throws.at(0.0).iter().all(|throw| throw.is_told()));
}

#[test]
fn what_noise_can_make_is_not_told() {
    let still = form([-5.0, 65.0], |h, bits, x, y| level(h) + 0.1 * (x - y) + 0.4 * f64::from(bits)).model();
    let throws = FaultThrows::new(&still, 0);
    assert_eq!(throws.sense(), None);
    assert!(throws.at(0.0).iter().all(|throw| !throw.is_told()));
    // Two samples of throw under noise of half a sample on every node.
    let form = form([-5.0, 65.0], |h, bits, x, y| level(h) + 0.1 * (x - y) + 2.0 * f64::from(bits));
    let random = |n: usize| {
        let mixed = (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed >> 11) as f64 / (1u64 << 53) as f64
    };
    let noisy = StructuralModel::build(
        &form.geometry,
        &form.stratigraphy(),
        &form.horizons(|h, n| 1.2 * (random(2 * (n + 5000 * h)) + random(2 * (n + 5000 * h) + 1) - 1.0)),
        &form.fault_inputs(),
        &ModelSettings { crossing_nodes: 100_000, ..ModelSettings::default() },
        &Progress::silent(),
    )
    .unwrap();
    let found = FaultThrows::new(&noisy, 0).at(0.0);
    let misfit = found.iter().flat_map(|throw| throw.cut_offs).map(|cut_off| cut_off.misfit);
    let (count, sum) = misfit.fold((0, 0.0), |(count, sum), misfit| (count + 1, sum + misfit));
    // The sum of two uniform numbers of this width has a deviation of 0.49.
    assert!((0.3..0.7).contains(&(sum / f64::from(count))), "{sum} {count}");
    assert!(found.iter().all(|throw| throw.least_samples() > 1.05));
}

#[test]
fn a_throw_ends_at_the_tip() {
    // The fault ends at y = 40; its throw grows from there.
    let dying = form([-5.0, 40.0], |h, bits, _, y| level(h) + f64::from(bits) * 0.2 * (40.0 - y).max(0.0)).model();
    let throws = FaultThrows::new(&dying, 0);
    let extent = throws.extent_m().unwrap();
    assert!((extent[1] - extent[0] - 40.0 * 25.0).abs() < 40.0, "{extent:?}");
    for found in throws.profile(21) {
        let [tip] = found.tips_m[..] else { panic!("{:?}", found.tips_m) };
        let at = |y: f64| throws.along_m(DVec3::new(35.0, y, 30.0));
        assert!((tip - at(40.0)).abs() < 30.0, "{tip} {}", at(40.0));
        for throw in &found.throws {
            let y = throw.cut_offs[0].place.y;
            assert!((throw.samples().abs() - 0.2 * (40.0 - y)).abs() < 0.3, "{y} {}", throw.samples());
        }
    }
}

#[test]
fn a_fault_that_moved_both_ways_has_no_sense() {
    // Scissors: as far down at one end as up at the other.
    let scissors = form([-5.0, 65.0], |h, bits, _, y| level(h) + f64::from(bits) * 0.2 * (y - 29.5)).model();
    let throws = FaultThrows::new(&scissors, 0);
    assert_eq!(throws.sense(), None);
    assert!(throws.profile(9).iter().flat_map(|found| &found.throws).any(Throw::is_told));
}
