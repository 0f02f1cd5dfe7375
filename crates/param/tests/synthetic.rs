//! Accuracy on the synthetic survey with its faults and its unconformity: k on the true horizons, and angles.

use model::{ModelSettings, StructuralModel};
use param::{PackedVolume, ParamSettings, Parameterization, accuracy};
use survey::Progress;
use synth::{SynthSettings, Synthetic};

#[test]
fn angles_and_k_on_horizons_are_accurate_on_the_synthetic_survey() {
    let silent = Progress::silent();
    let settings = SynthSettings { size: [96, 96, 96], snr: None, ..Default::default() };
    let survey = Synthetic::generate(&settings, &silent).unwrap();
    let model = StructuralModel::build(
        &survey.geometry,
        &survey.stratigraphy,
        &survey.horizons,
        &survey.faults,
        &ModelSettings::default(),
        &silent,
    )
    .unwrap();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &silent).unwrap();
    let volumes = param.voxel_volumes(&model, param.size, &silent).unwrap();
    assert!(volumes.k.samples().iter().all(|k| k.is_finite()));
    let packed = PackedVolume::from_voxels(&volumes, param.size, param.layers, param.blocks);
    let found = accuracy::compare(&model, &param, &packed, 2000).unwrap();
    eprintln!("{} blocks, {} layers; {found:#?}", param.blocks, param.layers);
    assert!(param.blocks > 1);
    let k = found.exact.k_on_horizons;
    assert!(k.count > 3000 && k.median <= 0.02 && k.p95 <= 0.1, "{k:?}");
    // The same at the true depths, where the errors of the model's sheets count too.
    let truth =
        |h: usize, block: u16, x: f32, y: f32| survey.truth.sheet_z(h, block, f64::from(x), f64::from(y)) as f32;
    let points = accuracy::horizon_points(&model, truth, 2000);
    let k = accuracy::k_on_horizons(&model, &param, |p| param.lookup(&model, p), &points);
    eprintln!("at the true depths: {k:?}");
    assert!(k.count > 3000 && k.median <= 0.02 && k.p95 <= 0.1, "{k:?}");
    let angles = found.exact.angles;
    for spread in [angles.k_to_i, angles.k_to_j] {
        assert!(spread.count > 10_000 && spread.median <= 0.2 && spread.p95 <= 1.0, "{angles:?}");
    }
}
