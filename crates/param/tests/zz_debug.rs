//! debug
use glam::{DMat3, DVec2, DVec3, Vec3};
use model::{ModelSettings, StructuralModel};
use param::{ParamSettings, Parameterization, Region};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Horizon, Progress, SurveyGeometry, VerticalUnit};
use synth::shapes::RecumbentFold;
fn geometry() -> SurveyGeometry { SurveyGeometry::regular([61, 41, 81], 25.0, 10.0, VerticalUnit::Metres) }
fn metres() -> DMat3 { DMat3::from_diagonal(DVec3::new(25.0, 25.0, 10.0)) }
fn build(horizons: Vec<(Horizon, Contact)>) -> (StructuralModel, Parameterization) {
    let named = |(h, contact): &(Horizon, Contact)| StratigraphicHorizon { name: h.name.clone(), contact: *contact };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let horizons: Vec<Horizon> = horizons.into_iter().map(|(horizon, _)| horizon).collect();
    let quiet = Progress::silent();
    let t = std::time::Instant::now();
    let model = StructuralModel::build(&geometry(), &stratigraphy, &horizons, &[], &ModelSettings::default(), &quiet).unwrap();
    println!("model {:?}", t.elapsed());
    let t = std::time::Instant::now();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &quiet).unwrap();
    println!("param {:?}", t.elapsed());
    (model, param)
}
fn gradients(model: &StructuralModel, param: &Parameterization, p: Vec3, region: Region, h: f32) -> [DVec3; 3] {
    let flat = |p: Vec3| { let (flat, _) = param.lookup_in(model, p, region); DVec3::new(f64::from(flat.i), f64::from(flat.j), f64::from(flat.k)) };
    let along = Vec3::AXES.map(|axis| (flat(p + h * axis) - flat(p - h * axis)) / f64::from(2.0*h));
    let voxel = metres().inverse().transpose();
    [0, 1, 2].map(|n: usize| voxel * DVec3::new(along[0][n], along[1][n], along[2][n]))
}
fn show(model: &StructuralModel, param: &Parameterization, layer: u16) {
    let region = Region { layer, block: 0 };
    let step = |n: usize, k: f64, low: f64, high: f64| (low + (n as f64 * k).fract() * (high - low)) as f32;
    let mut rows = Vec::new();
    for n in 0..12_000 {
        let p = Vec3::new(step(n, 0.414_214, 2.0, 58.0), step(n, 0.618_034, 2.0, 38.0), step(n, 0.754_878, 3.0, 77.0));
        if model.region_at(p) != region { continue; }
        if Vec3::AXES.into_iter().any(|a| model.region_at(p+0.5*a)!=region||model.region_at(p-0.5*a)!=region) { continue; }
        let [i, j, k] = gradients(model, param, p, region, 0.5);
        let off = |a: DVec3, b: DVec3| (a.angle_between(b).to_degrees() - 90.0).abs();
        rows.push((off(i, k), p, off(j,k), off(i,j), i.length()*1500.0, j.length()*1000.0, k.length()*100.0, param.lookup_in(model,p,region).0.k));
    }
    rows.sort_by(|a,b| a.0.total_cmp(&b.0));
    for q in [0.5,0.7,0.8,0.9,0.95,0.99] { println!("q {q}: {:.3}", rows[((rows.len()-1) as f64*q) as usize].0); }
    for r in rows.iter().rev().step_by(rows.len()/40).take(14) { println!("{:.2} at {:?} jk {:.2} ij {:.2} |i| {:.2} |j| {:.2} |k| {:.2} k {:.2}", r.0, r.1, r.2, r.3, r.4, r.5, r.6, r.7); }
}
#[test]
fn points() {
    let fold = RecumbentFold::fitting(&geometry());
    let bed = |(n, age): (usize, f64)| {
        let places = (0..2000).map(|m| {
            let (y, z) = ((m as f64 * 0.754_878 + 0.1 * n as f64).fract() * 1000.0, (m as f64 * 0.569_84).fract() * 800.0);
            DVec3::new(fold.x_of(age, z), y, z)
        });
        let origin = geometry().origin.extend(0.0);
        let vertices = places.filter(|p| (0.0..=1500.0).contains(&p.x)).take(90).map(|p| origin + p).collect();
        (Horizon::of_surface(format!("bed {n}"), survey::TriangleMesh { vertices, triangles: Vec::new() }), Contact::Conformable)
    };
    let ages = [-350.0, -250.0, -150.0, -50.0, 50.0];
    let (model, param) = build(ages.into_iter().enumerate().map(bed).collect());
    show(&model, &param, 3);
    show(&model, &param, 2);
}
#[test]
fn mesh() {
    let fold = RecumbentFold::fitting(&geometry());
    let range = [DVec2::new(-150.0, -300.0), DVec2::new(1150.0, 1100.0)];
    let bed = |name: &str, age: f64| (Horizon::of_surface(name, fold.mesh(&geometry(), age, range, [26, 280])), Contact::Conformable);
    let (model, param) = build(vec![bed("young", -250.0), bed("old", -150.0)]);
    show(&model, &param, 1);
}
