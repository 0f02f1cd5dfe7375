//! Horizons that are no height fields: bodies, recumbent folds, scattered points of an overturned series.

use glam::{DMat3, DVec2, DVec3, Vec3};
use model::section::{LineKind, Section, SectionPlane};
use model::{ModelError, ModelNote, ModelSettings, StructuralModel, SurfaceProblem};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Progress, SurveyGeometry, TriangleMesh, VerticalUnit};
use synth::closed_form::ClosedForm;
use synth::shapes::{Diapir, Laccolith, RecumbentFold, world};

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([61, 51, 81], 25.0, 10.0, VerticalUnit::Metres)
}

/// Metres along the survey's axes of a voxel place.
fn metres(p: Vec3) -> DVec3 {
    DMat3::from_diagonal(DVec3::new(25.0, 25.0, 10.0)) * p.as_dvec3()
}

fn build(horizons: Vec<(Horizon, Contact)>) -> Result<StructuralModel, ModelError> {
    let named = |(h, contact): &(Horizon, Contact)| StratigraphicHorizon { name: h.name.clone(), contact: *contact };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let horizons: Vec<Horizon> = horizons.into_iter().map(|(horizon, _)| horizon).collect();
    StructuralModel::build(&geometry(), &stratigraphy, &horizons, &[], &ModelSettings::default(), &Progress::silent())
}

fn flat(name: &str, depth: f32) -> Horizon {
    let grid = NodeGrid::of_survey(&geometry());
    Horizon::new(name, vec![Sheet::new(grid, vec![depth; grid.count[0] * grid.count[1]], Quality::Picked)])
}

/// Places all over the volume.
fn places() -> impl Iterator<Item = Vec3> {
    let step = |n: usize, k: f32, count: f32| (n as f32 * k).fract() * (count - 1.0);
    (0..20_000).map(move |n| Vec3::new(step(n, 0.618_034, 61.0), step(n, 0.414_214, 51.0), step(n, 0.732_051, 81.0)))
}

#[test]
fn a_diapir_with_an_overhang_is_where_it_is() {
    let diapir = Diapir::fitting(&geometry());
    let salt = Horizon::of_surface("salt", diapir.mesh(&geometry(), 160));
    let model = build(vec![
        (flat("a", 253.0), Contact::Conformable),
        (flat("b", 523.0), Contact::Conformable),
        (salt, Contact::Intrusive),
    ])
    .unwrap();
    assert!(model.is_body(2) && !model.is_body(1));
    let (mut inside, mut wrong, mut under) = (0, 0, 0);
    for p in places() {
        let at = metres(p);
        let rho = at.truncate().distance(diapir.axis);
        let layer = model.region_at(p).layer;
        let holds = diapir.holds(at);
        let expected = if holds { 0 } else { 1 + u16::from(at.z < 523.0) + u16::from(at.z < 253.0) };
        inside += usize::from(holds);
        // Under the overhang lie the sediments.
        under += usize::from(!holds && at.z > diapir.bulb_z && rho < diapir.bulb_radius && layer == expected);
        let near_edge = (rho - diapir.radius(at.z)).abs() < 4.0 || (at.z - diapir.top_z()).abs() < 4.0;
        wrong += usize::from(layer != expected && !near_edge);
    }
    assert!(inside > 600 && under > 200, "{inside} {under}");
    assert_eq!(wrong, 0);
    // The outline on a section through the axis lies within a tenth of a voxel of the closed form.
    let plane = SectionPlane {
        origin: DVec3::new(0.0, diapir.axis.y / 25.0, 0.0),
        s_axis: DVec3::X,
        t_axis: DVec3::Z,
        extent: [60.0, 80.0],
    };
    let section = Section::new(&model, &plane);
    let outline = section.lines.iter().filter(|line| line.kind == LineKind::Horizon { horizon: 2 });
    let (mut points, mut worst) = (0, 0.0f64);
    for st in outline.flat_map(|line| &line.points) {
        let at = DVec2::new(st.x * 25.0, st.y * 10.0);
        // The distance to the outline along ρ and along z; the smaller one bounds it.
        let along_rho = ((at.x - diapir.axis.x).abs() - diapir.radius(at.y)).abs() / 25.0;
        let nearest = diapir.crossings((at.x - diapir.axis.x).abs(), 1.0).map(|(z, _)| (z - at.y).abs());
        let along_z = nearest.fold(f64::INFINITY, f64::min) / 10.0;
        points += 1;
        worst = worst.max(along_rho.min(along_z));
    }
    assert!(points > 100, "{points}");
    assert!(worst < 0.1, "{worst}");
}

#[test]
fn a_recumbent_fold_of_triangles_repeats_its_beds() {
    let fold = RecumbentFold::fitting(&geometry());
    let range = [DVec2::new(-100.0, -300.0), DVec2::new(1350.0, 1100.0)];
    let bed = |name: &str, age: f64| {
        (Horizon::of_surface(name, fold.mesh(&geometry(), age, range, [30, 280])), Contact::Conformable)
    };
    let model = build(vec![bed("young", -250.0), bed("middle", -50.0), bed("old", 150.0)]).unwrap();
    let (mut wrong, mut repeated) = (0, 0);
    for p in places() {
        let at = metres(p);
        let age = fold.age(at);
        let expected = 3 - [-250.0, -50.0, 150.0].iter().filter(|&&bed| age >= bed).count() as u16;
        repeated += usize::from(fold.gradient(at).z < 0.0);
        // Metres from the nearest bed, to first order.
        let rate = fold.gradient(at).length();
        let near = [-250.0, -50.0, 150.0].iter().any(|bed| (age - bed).abs() / rate < 1.5);
        wrong += usize::from(model.region_at(p).layer != expected && !near);
    }
    assert!(repeated > 3000, "{repeated}");
    assert!(wrong <= 10, "{wrong}");
}

#[test]
fn a_laccolith_is_where_it_is() {
    let laccolith = Laccolith { axis: DVec2::new(740.0, 610.0), base_z: 560.0, radius: 520.0, height: 180.0 };
    let body = Horizon::of_surface("sill", laccolith.mesh(&geometry(), 120));
    let model = build(vec![(flat("roof", 300.0), Contact::Conformable), (body, Contact::Intrusive)]).unwrap();
    // Metres from the outline, at most: along ρ its roof is no steeper than 1.54·H/R, which is less than 1.
    let near = |at: DVec3| {
        let rho = at.truncate().distance(laccolith.axis);
        let share = (1.0 - (rho / laccolith.radius).powi(2)).max(0.0);
        let roof = laccolith.base_z - laccolith.height * share * share;
        let beside = (rho - laccolith.radius).abs() < 50.0 && (at.z - laccolith.base_z).abs() < 10.0;
        let level = (at.z - roof).abs().min((at.z - laccolith.base_z).abs()) < 5.0;
        // A place on the flat horizon may fall to either side of it.
        (at.z - 300.0).abs() < 0.1 || beside || rho < laccolith.radius + 5.0 && level
    };
    let (mut inside, mut wrong) = (0, 0);
    for p in places().filter(|p| !near(metres(*p))) {
        let holds = laccolith.holds(metres(p));
        inside += usize::from(holds);
        let expected = if holds { 0 } else { 1 + u16::from(metres(p).z < 300.0) };
        wrong += usize::from(model.region_at(p).layer != expected);
    }
    println!("laccolith: {wrong} wrong, {inside} inside");
    assert!(inside > 300 && wrong == 0, "{wrong} wrong, {inside} inside");
}

#[test]
fn a_thrust_repeats_a_layer() {
    // A reverse fault of 25°; the hanging wall lies on the side of larger x, 11 samples higher.
    let form = ClosedForm::flat(&geometry(), &[34.0, 46.0]).with_fault(25.0, -11.0);
    let quiet = Progress::silent();
    let settings = ModelSettings::default();
    let model =
        StructuralModel::build(&geometry(), &form.stratigraphy, &form.horizons, &form.faults, &settings, &quiet)
            .unwrap();
    let layer = |p: DVec3| model.region_at(p.as_vec3()).layer;
    let (mut wrong, mut repeated) = (0, 0);
    for p in places().map(|p| p.as_dvec3()) {
        let aside = [DVec3::Z, -DVec3::Z, DVec3::X, -DVec3::X].map(|step| form.layer_at(p + 0.3 * step));
        if aside == [form.layer_at(p); 4] {
            wrong += usize::from(layer(p) != form.layer_at(p));
        }
    }
    for x in 0..61 {
        let at = |z: i32| layer(DVec3::new(f64::from(x), 25.0, f64::from(z)));
        let entered = (1..80).filter(|z| at(*z) == 1 && at(z - 1) != 1).count();
        repeated += usize::from(entered == 2);
    }
    println!("thrust: {wrong} wrong, layer 1 is met twice by {repeated} columns of 61");
    assert!(wrong == 0 && repeated >= 8, "{wrong} {repeated}");
}

/// Scattered points of a bed, as an outcrop model has them.
fn scattered(fold: &RecumbentFold, age: f64, count: usize, seed: usize) -> TriangleMesh {
    let geometry = geometry();
    let mut vertices = Vec::new();
    let mut n = seed * 7919;
    while vertices.len() < count {
        n += 1;
        let (y, z) = ((n as f64 * 0.754_877).fract() * 1250.0, (n as f64 * 0.569_840).fract() * 800.0);
        let x = fold.x_of(age, z);
        if (0.0..=1500.0).contains(&x) {
            vertices.push(world(&geometry, DVec3::new(x, y, z)));
        }
    }
    TriangleMesh { vertices, triangles: Vec::new() }
}

#[test]
fn scattered_points_of_an_overturned_series_need_no_normals() {
    let fold = RecumbentFold::fitting(&geometry());
    let ages: Vec<f64> = (0..6).map(|n| -500.0 + 180.0 * f64::from(n)).collect();
    let bed = |(n, &age): (usize, &f64)| {
        (Horizon::of_surface(format!("H{n}"), scattered(&fold, age, 90, n + 1)), Contact::Conformable)
    };
    let model = build(ages.iter().enumerate().map(bed).collect()).unwrap();
    let (mut right, mut all, mut overturned) = (0, 0, [0u32; 2]);
    for p in places() {
        let at = metres(p);
        let age = fold.age(at);
        if age < ages[0] - 60.0 || age > ages[5] + 60.0 {
            continue;
        }
        let expected = 6 - ages.iter().filter(|&&bed| age >= bed).count() as u16;
        let found = model.region_at(p).layer == expected;
        all += 1;
        right += usize::from(found);
        if fold.gradient(at).z < 0.0 {
            overturned[0] += 1;
            overturned[1] += u32::from(found);
        }
    }
    println!("right: {right} of {all}, on the overturned limb {overturned:?}");
    assert!(right as f64 > 0.9 * f64::from(all), "{right} of {all}");
    assert!(f64::from(overturned[1]) > 0.88 * f64::from(overturned[0]), "{overturned:?}");
    // The points themselves lie on the surfaces.
    for (n, &age) in ages.iter().enumerate() {
        let mesh = scattered(&fold, age, 90, n + 1);
        let off = |v: &DVec3| model.offset(n, 0, geometry().voxel_from_world(*v).as_vec3()).abs() / 10.0;
        let worst = mesh.vertices.iter().map(off).fold(0.0, f32::max);
        assert!(worst < 0.6, "H{n}: {worst} voxels");
    }
}

fn surface_problem(found: Result<StructuralModel, ModelError>) -> SurfaceProblem {
    match found {
        Err(ModelError::Surface { problem, .. }) => problem,
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_cannot_be_a_body_is_refused_with_the_place() {
    let geometry = geometry();
    let laccolith = Laccolith { axis: DVec2::new(700.0, 600.0), base_z: 600.0, radius: 400.0, height: 150.0 };
    let whole = laccolith.mesh(&geometry, 24);
    let body = |mesh: TriangleMesh| (Horizon::of_surface("body", mesh), Contact::Intrusive);
    let cover = || (flat("cover", 100.0), Contact::Conformable);
    assert!(build(vec![cover(), body(whole.clone())]).is_ok());
    let mut open = whole.clone();
    open.triangles.truncate(open.triangles.len() / 2);
    assert_eq!(surface_problem(build(vec![cover(), body(open)])), SurfaceProblem::OpenBody);
    let points = TriangleMesh { triangles: Vec::new(), ..whole.clone() };
    assert_eq!(surface_problem(build(vec![cover(), body(points)])), SurfaceProblem::PointBody);
    // Two bodies in one horizon that pass through each other.
    let mut crossed = whole.clone();
    let moved = Laccolith { axis: DVec2::new(900.0, 600.0), base_z: 560.0, ..laccolith }.mesh(&geometry, 24);
    let first = crossed.vertices.len() as u32;
    crossed.vertices.extend(&moved.vertices);
    crossed.triangles.extend(moved.triangles.iter().map(|t| t.map(|v| v + first)));
    assert_eq!(surface_problem(build(vec![cover(), body(crossed)])), SurfaceProblem::Crossing);
    // As two horizons they may: the younger one is drawn.
    let both = build(vec![cover(), body(whole.clone()), (Horizon::of_surface("other", moved), Contact::Intrusive)]);
    let notes = both.unwrap().report().notes.clone();
    assert!(notes.iter().any(|note| matches!(note, ModelNote::BodiesOverlap { .. })), "{notes:?}");
    // Triangles that are turned every which way are the same body.
    let mut turned = whole;
    turned.triangles.iter_mut().step_by(3).for_each(|t| t.swap(0, 1));
    let model = build(vec![cover(), body(turned)]).unwrap();
    assert_eq!(model.region_at(Vec3::new(28.0, 24.0, 56.0)).layer, 0);
    let fold = RecumbentFold::fitting(&geometry);
    let alone = Horizon::of_surface("alone", scattered(&fold, 0.0, 60, 1));
    assert_eq!(surface_problem(build(vec![(alone, Contact::Conformable)])), SurfaceProblem::PointsAlone);
}

#[test]
fn a_sliver_between_two_faults_with_points_and_no_node_of_a_lattice_is_a_block_and_disturbs_none() {
    // The block between the faults is a voxel thick; lattices of a series have nodes one and a half to six apart.
    let faults = [30.45, 31.55].map(|x| {
        let corners = [(-2.0, -2.0), (52.0, -2.0), (52.0, 82.0), (-2.0, 82.0)];
        let vertices = corners.map(|(y, z)| geometry().world_from_voxel(DVec3::new(x, y, z))).to_vec();
        survey::Fault::new(format!("F{x}"), TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] })
    });
    // Two flat horizons, three voxels deeper in the sliver and six beyond it.
    let points = |depth: f64| -> Vec<Vec3> {
        let place = |n: usize| {
            let (a, b) = ((n as f64 * 0.754_877).fract(), (n as f64 * 0.569_84).fract());
            let (x, throw) = match n % 3 {
                0 => (30.0 * a, 0.0),
                1 => (30.6 + 0.8 * a, 3.0),
                _ => (32.0 + 28.0 * a, 6.0),
            };
            DVec3::new(x, 50.0 * b, depth + throw).as_vec3()
        };
        (0..120).map(place).collect()
    };
    let scattered = |name: &str, depth: f64| {
        let vertices = points(depth).iter().map(|p| geometry().world_from_voxel(p.as_dvec3())).collect();
        Horizon::of_surface(name, TriangleMesh { vertices, triangles: Vec::new() })
    };
    let depths = [25.0, 50.0];
    let horizons = [scattered("young", depths[0]), scattered("old", depths[1])];
    let named = |h: &Horizon| StratigraphicHorizon { name: h.name.clone(), contact: Contact::Conformable };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let (settings, quiet) = (ModelSettings::default(), Progress::silent());
    let model = StructuralModel::build(&geometry(), &stratigraphy, &horizons, &faults, &settings, &quiet).unwrap();
    let blocks = [10.0, 31.0, 50.0].map(|x| model.block_at(Vec3::new(x, 25.0, 40.0)));
    assert!(blocks[0] != blocks[1] && blocks[1] != blocks[2], "{blocks:?}");
    for (h, &depth) in depths.iter().enumerate() {
        let worst = |block: u16| {
            let off = |p: Vec3| model.level(h, block).unwrap().offset_m(p).abs();
            points(depth).into_iter().filter(|p| model.block_at(*p) == block).map(off).fold(0.0, f32::max)
        };
        // The blocks beside it are not disturbed.
        assert!(worst(blocks[0]) < 0.1 && worst(blocks[2]) < 0.1, "{} {}", worst(blocks[0]), worst(blocks[2]));
        let in_sliver = points(depth).into_iter().filter(|p| model.block_at(*p) == blocks[1]).count();
        assert!(in_sliver >= 38, "{in_sliver}");
    }
}
