//! Accuracy on folds with dips above 30° and a thickness that varies by 30 %.

mod closed_form;

use closed_form::ClosedForm;
use param::accuracy::{self, Spread};
use param::{PackedVolume, ParamSettings, Parameterization};
use survey::Progress;

#[test]
fn angles_and_k_on_horizons_are_accurate_on_folds() {
    let model = ClosedForm::folded();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap();
    let volumes = param.voxel_volumes(&model, param.size, &Progress::silent()).unwrap();
    let packed = PackedVolume::from_voxels(&volumes, param.size, param.layers, param.blocks);
    let found = accuracy::compare(&model, &param, &packed, 2000).unwrap();
    eprintln!("{found:#?}");
    let k = found.exact.k_on_horizons;
    assert!(k.count > 4000 && k.median <= 1e-4 && k.max <= 1e-3, "{k:?}");
    let angles = found.exact.angles;
    for spread in [angles.k_to_i, angles.k_to_j] {
        assert!(spread.count > 15_000 && spread.median <= 0.1 && spread.p95 <= 0.5, "{angles:?}");
    }
    // The paper's lookup is measured in the same way, and its errors show.
    assert!(found.packed.k_on_horizons.median > 10.0 * k.median);
}

#[test]
fn a_wrong_k_is_seen() {
    let model = ClosedForm::folded();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap();
    let points = accuracy::horizon_points(&model, |h, b, x, y| param::LayerModel::sheet(&model, h, b).z_at(x, y), 300);
    let shifted = |p: glam::Vec3| param.lookup(&model, p + glam::Vec3::new(0.0, 0.0, 0.25));
    let k: Spread = accuracy::k_on_horizons(&model, &param, shifted, &points);
    assert!((k.median - 0.25).abs() < 0.02, "{k:?}");
    let sheared = |p: glam::Vec3| {
        let mut found = param.lookup(&model, p);
        found.i += 0.02 * p.z / 79.0;
        found
    };
    let angles = accuracy::angles(&model, &param, sheared, 4000).unwrap();
    assert!(angles.k_to_i.median > 0.8, "{angles:?}");
}
