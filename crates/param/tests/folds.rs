//! Folds with dips above 30° and thickness ± 30 %: the accuracy rows of the design.

mod closed_form;

use closed_form::ClosedForm;
use param::{PackedVolume, ParamSettings, Parameterization, accuracy};
use std::f64::consts::TAU;
use survey::Progress;

/// Three horizons of wavelength 80 voxels; the middle one is 30 % nearer or farther than the mean.
fn folded() -> ClosedForm {
    ClosedForm::new([80, 72, 80], 3, |h, x, y| {
        let fold = 8.0 * (TAU * (x + 0.35 * y) / 76.0).sin();
        let swell = 5.0 * (TAU * (y - 0.4 * x) / 88.0).cos();
        18.0 + 21.0 * h as f64 + fold + swell * [0.0, 1.0, 0.2][h]
    })
}

#[test]
fn angles_and_horizons_hold_the_design_s_figures() {
    let model = folded();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap();
    let exact = |p| param.lookup(&model, p);
    let k = accuracy::k_on_horizons(&model, &param, exact, 2000);
    let angle = accuracy::angles(&model, &param, exact, 20_000).unwrap();
    let volumes = param.voxel_volumes(&model, param.size, &Progress::silent()).unwrap();
    let packed = PackedVolume::from_voxels(&volumes, param.size, param.layers, param.blocks);
    let paper = |p| packed.lookup_extrapolated(p);
    let paper_k = accuracy::k_on_horizons(&model, &param, paper, 2000);
    let paper_angle = accuracy::angles(&model, &param, paper, 20_000).unwrap();
    eprintln!("exact  {k:?}\n       {angle:?}\npacked {paper_k:?}\n       {paper_angle:?}");
    assert!(k.count > 4000 && k.median <= 0.02 && k.p95 <= 0.1, "{k:?}");
    assert!(angle.k_to_i.count > 15_000, "{angle:?}");
    for spread in [angle.k_to_i, angle.k_to_j] {
        assert!(spread.median <= 0.2 && spread.p95 <= 1.0, "{angle:?}");
    }
}
