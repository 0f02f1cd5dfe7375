//! Files of older revisions.

use super::*;
use glam::Vec3;
use interp::ExtractSettings;
use interp::faults::{Evidence, ProposeSettings, propose_faults};
use interp::reassembly::from_horizon;
use model::{FaultNetwork, ModelSettings, StructuralModel};
use param::{ParamSettings, Parameterization};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use synth::closed_form::ClosedForm;

/// Values that differ by less are the same: mathematical libraries differ in the last digits.
const STEP: f64 = 1e-2;

/// A number for many, unlike after any change that a picture could show.
fn fingerprint(values: impl IntoIterator<Item = f64>) -> String {
    let mut hash = blake3::Hasher::new();
    for value in values {
        hash.update(&((value / STEP).round() as i64).to_le_bytes());
    }
    hash.finalize().to_hex()[..12].to_owned()
}

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([24, 20, 40], 25.0, 10.0, VerticalUnit::Metres)
}

fn closed_form() -> ClosedForm {
    ClosedForm::dipping(&geometry(), &[12.0, 26.0], 12.0, 30.0).with_fault(60.0, 4.0)
}

fn structural_model() -> StructuralModel {
    let (closed, quiet) = (closed_form(), Progress::silent());
    let (order, horizons) = (&closed.stratigraphy, &closed.horizons);
    StructuralModel::build(&geometry(), order, horizons, &closed.faults, &ModelSettings::default(), &quiet).unwrap()
}

fn places() -> impl Iterator<Item = Vec3> {
    let steps = (0..6).flat_map(|x| (0..5).flat_map(move |y| (0..10).map(move |z| [x, y, z])));
    steps.map(|[x, y, z]| Vec3::new(x as f32 * 4.4, y as f32 * 4.3, z as f32 * 4.1))
}

fn of_model() -> String {
    let made = structural_model();
    let columns = (0..24).flat_map(|x| (0..20).map(move |y| (x as f32, y as f32)));
    let depths = columns.flat_map(|(x, y)| {
        let blocks = 0..made.block_count() as u16;
        blocks.flat_map(|block| [0, 1].map(|h| f64::from(made.horizon_z(h, block, x, y)))).collect::<Vec<_>>()
    });
    let regions = places().flat_map(|p| {
        let region = made.region_at(p);
        [f64::from(region.layer), f64::from(region.block)]
    });
    fingerprint(depths.chain(regions))
}

fn of_parameterization() -> String {
    let made = structural_model();
    let flat = Parameterization::compute(&made, &ParamSettings::default(), &Progress::silent()).unwrap();
    fingerprint(places().flat_map(|p| {
        let at = flat.lookup(&made, p);
        [at.i, at.j, at.k].map(f64::from)
    }))
}

fn of_extraction() -> String {
    let size = [30, 28, 40];
    let depth = |x: usize, y: usize| 0.002 * ((x * x) as f32 + 2.0 * (y * y) as f32) + if x > 14 { 3.0 } else { 0.0 };
    let mut volume = Volume::filled(size, 0.0f32);
    for x in 0..size[0] {
        for y in 0..size[1] {
            let top = depth(x, y);
            for (z, sample) in volume.trace_mut(x, y).iter_mut().enumerate() {
                // A parabola about every eighth sample, in turns up and down.
                let phase = (z as f32 - top).rem_euclid(16.0) - 8.0;
                *sample = if phase < 0.0 { phase * (phase + 8.0) } else { phase * (8.0 - phase) };
            }
        }
    }
    let found = interp::extract(&volume, &ExtractSettings::default(), &Progress::silent()).unwrap();
    let forest = &found.forest;
    let vertices = forest.surfaces.vertices.iter().flat_map(|v| [f64::from(v.x), f64::from(v.y), f64::from(v.z)]);
    fingerprint(vertices.chain([forest.leaf_count() as f64, forest.surfaces.surfaces.len() as f64]))
}

fn of_proposals() -> String {
    let (geometry, none) =
        (SurveyGeometry::regular([80, 60, 90], 25.0, 10.0, VerticalUnit::Metres), FaultNetwork::none());
    let closed = ClosedForm::dipping(&geometry, &[25.0, 45.0, 65.0], 5.0, 30.0).with_fault(60.0, 8.0);
    let sheets: Vec<_> = closed.horizons.iter().map(|horizon| from_horizon(horizon, &geometry, &none)).collect();
    let named = closed.horizons.iter().zip(&sheets);
    let evidence: Vec<Evidence> = named.map(|(horizon, sheets)| Evidence { name: &horizon.name, sheets }).collect();
    let (settings, quiet) = (ProposeSettings::default(), Progress::silent());
    let found = propose_faults(&evidence, &geometry, &none, None, &settings, &quiet).unwrap();
    assert!(!found.proposals.is_empty(), "a fault of eight samples' throw is found");
    fingerprint(found.proposals.iter().flat_map(|p| [p.strike_deg, p.dip_deg, p.throw[0], p.ends[0][0]].map(f64::from)))
}

fn of_found_faults() -> String {
    let mut volume = Volume::filled([48, 40, 96], 0.0f32);
    for (n, sample) in volume.samples_mut().iter_mut().enumerate() {
        let [x, y, z] = [n / 96 / 40, n / 96 % 40, n % 96].map(|at| at as f32);
        let thrown = if x > 22.0 + 0.3 * (z - 48.0) { 5.0 } else { 0.0 };
        let t = z - 0.2 * y - thrown;
        *sample = (t * 0.71).sin() + 0.8 * (t * 0.43 + 1.0).sin() + 0.5 * (t * 0.93 + 2.0).cos();
    }
    let quiet = Progress::silent();
    let geometry = SurveyGeometry::regular([48, 40, 96], 25.0, 10.0, VerticalUnit::Metres);
    let found = faults::find(&volume, &geometry, &quiet).unwrap();
    let proposals = faults::proposals(&found, &[], &geometry);
    assert_eq!(proposals.len(), 1, "a fault of five samples' throw is found");
    fingerprint(proposals.iter().flat_map(|p| [p.strike_deg, p.dip_deg, p.throw[0], p.ends[0][0]]))
}

#[test]
fn a_changed_result_has_a_changed_revision() {
    let known = [
        ("MODEL", MODEL, of_model(), (4, "f3513521b9d7")),
        ("PARAMETERIZATION", PARAMETERIZATION, of_parameterization(), (9, "29c9a61fc71d")),
        ("EXTRACTION", EXTRACTION, of_extraction(), (2, "7a7715634834")),
        ("PROPOSALS", PROPOSALS, of_proposals(), (2, "1fc6c26217e7")),
        ("FOUND_FAULTS", FOUND_FAULTS, of_found_faults(), (2, "3ddfe0bebd9f")),
    ];
    let changed: Vec<String> = known
        .into_iter()
        .filter(|(_, revision, found, known)| (*revision, found.as_str()) != *known)
        .map(|(name, revision, found, known)| format!("{name}: revision {revision} gives {found}, known is {known:?}"))
        .collect();
    assert!(changed.is_empty(), "raise the revision and note its fingerprint here: {changed:#?}");
}

#[test]
fn a_fingerprint_sees_what_a_picture_could_show() {
    assert_eq!(fingerprint([1.0, 2.0]), fingerprint([1.0, 2.000_001]));
    assert_ne!(fingerprint([1.0, 2.0]), fingerprint([1.0, 2.02]));
    assert_ne!(fingerprint([1.0, 2.0]), fingerprint([2.0, 1.0]));
}
