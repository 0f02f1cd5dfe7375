//! Layers between planes, where k, i and j are known in closed form.

mod closed_form;

use closed_form::ClosedForm;
use glam::Vec3;
use param::{ParamSettings, Parameterization, Region};
use survey::Progress;

fn compute(model: &ClosedForm) -> Parameterization {
    Parameterization::compute(model, &ParamSettings::default(), &Progress::silent()).unwrap()
}

#[test]
fn flat_layers_are_linear() {
    let depths = [10.0, 24.0, 40.0];
    let model = ClosedForm::new([20, 30, 50], 3, |h, _, _| depths[h]);
    let param = compute(&model);
    for (x, y, z) in [(0.0, 0.0, 12.0), (19.0, 29.0, 23.9), (7.3, 11.8, 10.0), (3.0, 4.0, 39.0), (10.5, 0.25, 30.0)] {
        let found = param.lookup(&model, Vec3::new(x, y, z));
        let (layer, bottom, top) = if z < 24.0 { (2, 24.0, 10.0) } else { (1, 40.0, 24.0) };
        assert_eq!(found.region, Region { layer, block: 0 });
        assert!((found.k - (bottom - z) / (bottom - top)).abs() < 1e-5, "k at {x}, {y}, {z}: {}", found.k);
        assert!((found.i - x / 19.0).abs() < 1e-6 && (found.j - y / 29.0).abs() < 1e-6);
    }
    // The open layers: k by the distance over the thickness that reaches the volume's edge.
    let top = param.lookup(&model, Vec3::new(5.0, 5.0, 4.0));
    assert!((top.k - 0.6).abs() < 1e-5, "{}", top.k);
    let bottom = param.lookup(&model, Vec3::new(5.0, 5.0, 49.0));
    assert!(bottom.k.abs() < 1e-5, "{}", bottom.k);
}
