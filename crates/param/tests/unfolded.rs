//! Layers whose horizons are no height fields: k, the angles and the lengths on a recumbent fold, rock inside a body.

use glam::{DMat3, DVec2, DVec3, Vec3};
use model::{ModelSettings, StructuralModel};
use param::{ParamSettings, Parameterization, Region};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Horizon, Progress, SurveyGeometry, VerticalUnit};
use synth::shapes::{Laccolith, RecumbentFold};

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([61, 41, 81], 25.0, 10.0, VerticalUnit::Metres)
}

fn metres() -> DMat3 {
    DMat3::from_diagonal(DVec3::new(25.0, 25.0, 10.0))
}

fn build(horizons: Vec<(Horizon, Contact)>) -> (StructuralModel, Parameterization) {
    let named = |(h, contact): &(Horizon, Contact)| StratigraphicHorizon { name: h.name.clone(), contact: *contact };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let horizons: Vec<Horizon> = horizons.into_iter().map(|(horizon, _)| horizon).collect();
    let quiet = Progress::silent();
    let model =
        StructuralModel::build(&geometry(), &stratigraphy, &horizons, &[], &ModelSettings::default(), &quiet).unwrap();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &quiet).unwrap();
    (model, param)
}

/// A quantile of errors.
fn quantile(errors: &mut [f64], share: f64) -> f64 {
    errors.sort_by(f64::total_cmp);
    errors[((errors.len() - 1) as f64 * share) as usize]
}

#[test]
fn patterns_go_around_a_recumbent_fold() {
    let fold = RecumbentFold::fitting(&geometry());
    let range = [DVec2::new(-150.0, -300.0), DVec2::new(1150.0, 1100.0)];
    let bed = |name: &str, age: f64| {
        (Horizon::of_surface(name, fold.mesh(&geometry(), age, range, [26, 280])), Contact::Conformable)
    };
    let (model, param) = build(vec![bed("young", -250.0), bed("old", -150.0)]);
    let middle = |p: Vec3| model.region_at(p) == Region { layer: 1, block: 0 };
    let voxel = metres().inverse().transpose();
    let (mut k_errors, mut angles, mut across) = (Vec::new(), Vec::new(), Vec::new());
    let (mut areas, mut turned) = (Vec::new(), 0);
    let step = |n: usize, k: f64, low: f64, high: f64| low + (n as f64 * k).fract() * (high - low);
    for n in 0..12_000 {
        let (y, z) = (step(n, 0.618_034, 50.0, 950.0), step(n, 0.754_878, 40.0, 760.0));
        for (age, k) in [(-250.0, 1.0), (-150.0, 0.0)] {
            let x = fold.x_of(age, z);
            if !(30.0..1470.0).contains(&x) {
                continue;
            }
            let p = (metres().inverse() * DVec3::new(x, y, z)).as_vec3();
            let (flat, jacobian) = param.lookup_in(&model, p, Region { layer: 1, block: 0 });
            // In voxels of depth, as elsewhere; metres across the bed over the height of a voxel.
            let rate = (voxel * Vec3::from_array(jacobian[2]).as_dvec3()).length();
            k_errors.push(f64::from((flat.k - k).abs()) / rate / 10.0);
        }
        let p = Vec3::new(
            step(n, 0.414_214, 2.0, 58.0) as f32,
            step(n, 0.618_034, 2.0, 38.0) as f32,
            step(n, 0.754_878, 3.0, 77.0) as f32,
        );
        if !middle(p) {
            continue;
        }
        let (_, jacobian) = param.lookup_in(&model, p, Region { layer: 1, block: 0 });
        let [i, j, k] = jacobian.map(|row| voxel * Vec3::from_array(row).as_dvec3());
        let off = |a: DVec3, b: DVec3| (a.angle_between(b).to_degrees() - 90.0).abs();
        angles.push(off(i, k));
        across.push(off(j, k).max(off(i, j)));
        // 1 where lengths along the layer are kept.
        areas.push((i * 1500.0).cross(j * 1000.0).length());
        turned += usize::from(fold.gradient(metres() * p.as_dvec3()).z < 0.0);
    }
    assert!(turned > 200 && areas.len() > 800, "{turned} of {}", areas.len());
    let k = [0.5, 0.95].map(|share| quantile(&mut k_errors, share));
    let angle = [0.5, 0.95].map(|share| quantile(&mut angles, share));
    let area = [0.05, 0.5, 0.95].map(|share| quantile(&mut areas, share));
    let cross = [0.5, 0.95].map(|share| quantile(&mut across, share));
    println!("k {k:?} voxels, angles {angle:?}°, j across {cross:?}°, areas {area:?}");
    assert!(k[0] < 0.02 && k[1] < 0.1, "{k:?}");
    assert!(angle[0] < 1.5 && angle[1] < 6.0, "{angle:?}");
    assert!(cross[1] < 0.1, "{cross:?}");
    assert!(area[0] > 0.5 && (area[1] - 1.0).abs() < 0.03 && area[2] < 1.5, "{area:?}");
}

#[test]
fn rock_inside_a_body_is_not_layered() {
    let laccolith = Laccolith { axis: DVec2::new(700.0, 500.0), base_z: 600.0, radius: 400.0, height: 150.0 };
    let fold = RecumbentFold { amplitude_m: 0.0, ..RecumbentFold::fitting(&geometry()) };
    let range = [DVec2::new(-150.0, -100.0), DVec2::new(1150.0, 900.0)];
    let dipping = Horizon::of_surface("dipping", fold.mesh(&geometry(), -200.0, range, [26, 100]));
    let body = Horizon::of_surface("body", laccolith.mesh(&geometry(), 40));
    let (model, param) = build(vec![(dipping, Contact::Conformable), (body, Contact::Intrusive)]);
    let inside = Vec3::new(28.0, 20.0, 55.0);
    assert!(laccolith.holds(metres() * inside.as_dvec3()));
    let flat = param.lookup(&model, inside);
    assert_eq!(flat.region, Region { layer: 0, block: 0 });
    // i, j are the map's, k rises evenly.
    assert!((flat.i - 28.0 / 60.0).abs() < 1e-6 && (flat.j - 0.5).abs() < 1e-6);
    assert!((flat.k - (1.0 - 55.0 / 80.0)).abs() < 1e-6, "{}", flat.k);
    // The layer below the dipping horizon does not end at the body: it has no bottom.
    let below = param.lookup(&model, Vec3::new(10.0, 5.0, 70.0));
    assert_eq!(below.region.layer, 1);
    assert!(below.k > 0.0 && below.k < 1.0, "{}", below.k);
}
