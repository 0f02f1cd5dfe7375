//! Layers whose horizons are no height fields: k, the angles and the lengths on a recumbent fold, rock inside a body.

use glam::{DMat3, DVec2, DVec3, Vec3};
use model::{ModelSettings, StructuralModel};
use param::{KDefinition, ParamSettings, Parameterization, Region};
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

/// The metric gradients of i, j, k by differences over a voxel, as on height fields (`param::accuracy`).
fn gradients(model: &StructuralModel, param: &Parameterization, p: Vec3, region: Region) -> [DVec3; 3] {
    let flat = |p: Vec3| {
        let (flat, _) = param.lookup_in(model, p, region);
        DVec3::new(f64::from(flat.i), f64::from(flat.j), f64::from(flat.k))
    };
    let along = Vec3::AXES.map(|axis| flat(p + 0.5 * axis) - flat(p - 0.5 * axis));
    let voxel = metres().inverse().transpose();
    [0, 1, 2].map(|n: usize| voxel * DVec3::new(along[0][n], along[1][n], along[2][n]))
}

/// What patterns are like in a layer: angles of i to k, of j to both, areas along the layer.
#[derive(Default)]
struct Measured {
    angles: Vec<f64>,
    across: Vec<f64>,
    areas: Vec<f64>,
    turned: usize,
}

fn measure(
    model: &StructuralModel,
    param: &Parameterization,
    layer: u16,
    is_turned: impl Fn(DVec3) -> bool,
) -> Measured {
    let region = Region { layer, block: 0 };
    let mut measured = Measured::default();
    let step = |n: usize, k: f64, low: f64, high: f64| (low + (n as f64 * k).fract() * (high - low)) as f32;
    for n in 0..12_000 {
        let p = Vec3::new(step(n, 0.414_214, 2.0, 58.0), step(n, 0.618_034, 2.0, 38.0), step(n, 0.754_878, 3.0, 77.0));
        let around = Vec3::AXES.into_iter().flat_map(|axis| [p, p + 0.5 * axis, p - 0.5 * axis]);
        if around.into_iter().any(|q| model.region_at(q) != region) {
            continue;
        }
        let [i, j, k] = gradients(model, param, p, region);
        let off = |a: DVec3, b: DVec3| (a.angle_between(b).to_degrees() - 90.0).abs();
        measured.angles.push(off(i, k));
        measured.across.push(off(j, k).max(off(i, j)));
        // 1 where lengths along the layer are kept.
        measured.areas.push((i * 1500.0).cross(j * 1000.0).length());
        measured.turned += usize::from(is_turned(metres() * p.as_dvec3()));
    }
    measured
}

#[test]
fn patterns_go_around_a_recumbent_fold() {
    let fold = RecumbentFold::fitting(&geometry());
    let range = [DVec2::new(-150.0, -300.0), DVec2::new(1150.0, 1100.0)];
    let bed = |name: &str, age: f64| {
        (Horizon::of_surface(name, fold.mesh(&geometry(), age, range, [26, 280])), Contact::Conformable)
    };
    let (model, param) = build(vec![bed("young", -250.0), bed("old", -150.0)]);
    let region = Region { layer: 1, block: 0 };
    let voxel = metres().inverse().transpose();
    let mut k_errors = Vec::new();
    let step = |n: usize, k: f64, low: f64, high: f64| low + (n as f64 * k).fract() * (high - low);
    for n in 0..12_000 {
        let (y, z) = (step(n, 0.618_034, 50.0, 950.0), step(n, 0.754_878, 40.0, 760.0));
        for (age, k) in [(-250.0, 1.0), (-150.0, 0.0)] {
            let x = fold.x_of(age, z);
            if !(30.0..1470.0).contains(&x) {
                continue;
            }
            let p = (metres().inverse() * DVec3::new(x, y, z)).as_vec3();
            let (flat, jacobian) = param.lookup_in(&model, p, region);
            // In voxels of depth, as elsewhere; metres across the bed over the height of a voxel.
            let rate = (voxel * Vec3::from_array(jacobian[2]).as_dvec3()).length();
            k_errors.push(f64::from((flat.k - k).abs()) / rate / 10.0);
        }
    }
    let turned = |p: DVec3| fold.gradient(p).z < 0.0;
    let mut found = measure(&model, &param, 1, turned);
    assert!(found.turned > 150 && found.areas.len() > 600, "{} of {}", found.turned, found.areas.len());
    let k = [0.5, 0.95].map(|share| quantile(&mut k_errors, share));
    let angle = [0.5, 0.95].map(|share| quantile(&mut found.angles, share));
    let area = [0.05, 0.5, 0.95].map(|share| quantile(&mut found.areas, share));
    let cross = [0.5, 0.95].map(|share| quantile(&mut found.across, share));
    println!("k {k:?} voxels, angles {angle:?}°, j across {cross:?}°, areas {area:?}");
    assert!(k[0] < 0.02 && k[1] < 0.1, "{k:?}");
    assert!(angle[0] < 0.2 && angle[1] < 1.0, "{angle:?}");
    assert!(cross[1] < 0.1, "{cross:?}");
    assert!(area[0] > 0.5 && (area[1] - 1.0).abs() < 0.03 && area[2] < 1.5, "{area:?}");
    // Beds of the open layers meet in the core of the fold.
    for layer in [0, 2] {
        let mut found = measure(&model, &param, layer, turned);
        let angle = [0.5, 0.95].map(|share| quantile(&mut found.angles, share));
        println!("open layer {layer}: angles {angle:?}°");
        assert!(found.turned > 150 && angle[0] < 0.2 && angle[1] < 2.0, "{layer}: {angle:?}");
    }
}

/// Scattered points of five beds of the same fold are one smooth function, without creases.
#[test]
fn patterns_go_around_a_fold_of_scattered_points() {
    let fold = RecumbentFold::fitting(&geometry());
    let bed = |(n, age): (usize, f64)| {
        let places = (0..2000).map(|m| {
            let (y, z) =
                ((m as f64 * 0.754_878 + 0.1 * n as f64).fract() * 1000.0, (m as f64 * 0.569_84).fract() * 800.0);
            DVec3::new(fold.x_of(age, z), y, z)
        });
        let origin = geometry().origin.extend(0.0);
        let vertices = places.filter(|p| (0.0..=1500.0).contains(&p.x)).take(90).map(|p| origin + p).collect();
        let points = survey::TriangleMesh { vertices, triangles: Vec::new() };
        (Horizon::of_surface(format!("bed {n}"), points), Contact::Conformable)
    };
    let ages = [-350.0, -250.0, -150.0, -50.0, 50.0];
    let (model, param) = build(ages.into_iter().enumerate().map(bed).collect());
    let mut found = measure(&model, &param, 3, |p| fold.gradient(p).z < 0.0);
    assert!(found.turned > 150 && found.areas.len() > 600, "{} of {}", found.turned, found.areas.len());
    let angle = [0.5, 0.95].map(|share| quantile(&mut found.angles, share));
    let area = [0.05, 0.5, 0.95].map(|share| quantile(&mut found.areas, share));
    let cross = [0.5, 0.95].map(|share| quantile(&mut found.across, share));
    println!("angles {angle:?}°, j across {cross:?}°, areas {area:?}");
    assert!(angle[0] < 0.2 && angle[1] < 1.0, "{angle:?}");
    assert!(area[0] > 0.4 && (area[1] - 1.0).abs() < 0.1 && area[2] < 1.7, "{area:?}");
}

/// Beds parallel to one horizon of a layer between surfaces of any shape: k is the distance from it alone.
#[test]
fn beds_may_be_parallel_to_one_horizon_of_any_shape() {
    let fold = RecumbentFold::fitting(&geometry());
    let range = [DVec2::new(-150.0, -300.0), DVec2::new(1150.0, 1100.0)];
    let bed = |name: &str, age: f64| {
        (Horizon::of_surface(name, fold.mesh(&geometry(), age, range, [26, 280])), Contact::Conformable)
    };
    let (model, _) = build(vec![bed("young", -250.0), bed("old", -100.0)]);
    let region = Region { layer: 1, block: 0 };
    let places: Vec<Vec3> = (0..4000)
        .map(|n| {
            let step = |k: f64, last: f64| (2.0 + (f64::from(n) * k).fract() * (last - 4.0)) as f32;
            Vec3::new(step(0.414_214, 60.0), step(0.618_034, 40.0), step(0.754_878, 80.0))
        })
        .filter(|p| model.region_at(*p) == region)
        .collect();
    for (definition, horizon, end) in [(KDefinition::ParallelToTop, 0, 1.0), (KDefinition::ParallelToBottom, 1, 0.0)] {
        let settings = ParamSettings { definitions: vec![KDefinition::Flow, definition], ..ParamSettings::default() };
        let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
        let thickness = param.grid(region).thickness_m.unwrap() as f32;
        let level = model.level(horizon, 0).unwrap();
        let off = |p: &Vec3| {
            let k = param.lookup_in(&model, *p, region).0.k;
            ((k - end).abs() * thickness - level.offset_m(*p).abs()).abs()
        };
        let worst = places.iter().map(off).fold(0.0, f32::max);
        // Between nodes 25 m apart the distance is cubic here and linear in the level.
        assert!(places.len() > 300 && worst < 4.0, "{definition:?}: {worst} m of {thickness} m");
    }
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

/// Two cylinders, of radii 150 and 450 m, whose flanks are overturned: harmonic k rises with the logarithm of the radius,
/// the ratio of distances with the radius itself.
#[test]
fn harmonic_k_between_cylinders_is_the_logarithm_of_the_radius() {
    let axis = DVec2::new(750.0, 520.0);
    let (inner, outer) = (150.0, 450.0);
    let arch = |radius: f64| {
        let (turns, rows) = (120, 30);
        let place = |n: usize| {
            let (turn, row) = (n / (rows + 1), n % (rows + 1));
            let angle = (f64::from(turn as u32) / f64::from(turns) - 0.5) * 2.6 * std::f64::consts::PI / 1.5;
            let y = -150.0 + 1300.0 * row as f64 / rows as f64;
            let p = axis + radius * DVec2::new(angle.sin(), -angle.cos());
            geometry().world_from_voxel(metres().inverse() * DVec3::new(p.x, y, p.y))
        };
        let at = |turn: usize, row: usize| (turn * (rows + 1) + row) as u32;
        let cell = |n: usize| {
            let (t, r) = (n / rows, n % rows);
            [[at(t, r), at(t + 1, r), at(t + 1, r + 1)], [at(t, r), at(t + 1, r + 1), at(t, r + 1)]]
        };
        survey::TriangleMesh {
            vertices: (0..(turns as usize + 1) * (rows + 1)).map(place).collect(),
            triangles: (0..turns as usize * rows).flat_map(cell).collect(),
        }
    };
    let bed = |name: &str, radius: f64| (Horizon::of_surface(name, arch(radius)), Contact::Conformable);
    let (model, _) = build(vec![bed("young", outer), bed("old", inner)]);
    let region = Region { layer: 1, block: 0 };
    assert!(model.level(0, 0).is_some() && model.level(1, 0).is_some(), "no height fields");
    let with = |definition: KDefinition| {
        let definitions = vec![KDefinition::Flow, definition];
        let settings = ParamSettings { definitions, ..ParamSettings::default() };
        let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
        let (mut harmonic, mut ratio, mut slopes) = (Vec::new(), Vec::new(), Vec::new());
        for n in 0..6000 {
            let part = |k: f64| (f64::from(n) * k).fract();
            let (radius, angle) = (inner + (outer - inner) * part(0.618_034), 3.4 * (part(0.754_878) - 0.5));
            let p = axis + radius * DVec2::new(angle.sin(), -angle.cos());
            let p = (metres().inverse() * DVec3::new(p.x, 100.0 + 800.0 * part(0.569_84), p.y)).as_vec3();
            let (flat, jacobian) = param.lookup_in(&model, p, region);
            let k = f64::from(flat.k);
            harmonic.push((k - (radius / inner).ln() / (outer / inner).ln()).abs());
            ratio.push((k - (radius - inner) / (outer - inner)).abs());
            let rate = (metres().inverse().transpose() * Vec3::from_array(jacobian[2]).as_dvec3()).length();
            slopes.push((rate * radius * (outer / inner).ln() - 1.0).abs());
        }
        [harmonic, ratio, slopes].map(|mut errors| quantile(&mut errors, 0.95))
    };
    let [harmonic, ratio, slope] = with(KDefinition::Harmonic);
    assert!(harmonic < 0.01 && ratio > 0.1 && slope < 0.05, "{harmonic} {ratio} {slope}");
    let [harmonic, ratio, _] = with(KDefinition::DistanceRatio);
    assert!(harmonic > 0.1 && ratio < 0.03, "{harmonic} {ratio}");
}
