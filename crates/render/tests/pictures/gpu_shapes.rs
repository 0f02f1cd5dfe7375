//! The GPU draws horizons of any shape as the CPU reference does: bodies, overturned beds, the ground over them.

use crate::block::Block;
use crate::compare::compare;
use crate::gpu::skipped;
use glam::{DVec2, DVec3};
use param::KDefinition;
use render::vector::{VectorLineKind, vectors};
use render::{Camera, Ground, Inputs, Renderer, Scene, VoxelBox};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Progress, SurveyGeometry, TriangleMesh, VerticalUnit};
use synth::closed_form::ClosedForm;
use synth::shapes::{Diapir, RecumbentFold, world};
use ttf::{TextureLibrary, TransferFunctions};

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([41, 33, 41], 25.0, 20.0, VerticalUnit::Metres)
}

fn block(horizons: Vec<(Horizon, Contact)>, faults: &[survey::Fault]) -> Block {
    let named = |(h, contact): &(Horizon, Contact)| StratigraphicHorizon { name: h.name.clone(), contact: *contact };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let horizons: Vec<Horizon> = horizons.into_iter().map(|(horizon, _)| horizon).collect();
    let library = TextureLibrary::builtin().unwrap();
    Block::new(&geometry(), &stratigraphy, &horizons, faults, &TransferFunctions::default(), &library)
}

/// A dome over a salt dome that stands out of the ground, or was worn down with it.
fn salt(ground: Contact, salt: Contact) -> Block {
    let geometry = geometry();
    let grid = NodeGrid::of_survey(&geometry);
    let domed = |name: &str, depth: f64| {
        let node = |n: usize| {
            let at = DVec2::new((n / grid.count[1]) as f64, (n % grid.count[1]) as f64) * 25.0;
            (depth - 60.0 * (-(at - DVec2::new(500.0, 400.0)).length_squared() / 9e4).exp()) as f32
        };
        let depths = (0..grid.count[0] * grid.count[1]).map(node).collect();
        (Horizon::new(name, vec![Sheet::new(grid, depths, Quality::Picked)]), Contact::Conformable)
    };
    let body = Horizon::of_surface("salt", Diapir::fitting(&geometry).mesh(&geometry, 48));
    let surface = (domed("ground", 330.0).0, ground);
    block(vec![surface, domed("below", 520.0), (body, salt)], &[])
}

/// Beds of a recumbent fold, as scattered points, cut by a fault.
fn fold() -> Block {
    let geometry = geometry();
    let fold = RecumbentFold::fitting(&geometry);
    let bed = |(n, age): (usize, f64)| {
        let mut vertices = Vec::new();
        let mut at = n * 7919;
        while vertices.len() < 90 {
            at += 1;
            let (y, z) = ((at as f64 * 0.754_877).fract() * 800.0, (at as f64 * 0.569_840).fract() * 800.0);
            let x = fold.x_of(age, z);
            if (0.0..=1000.0).contains(&x) {
                vertices.push(world(&geometry, DVec3::new(x, y, z)));
            }
        }
        let points = TriangleMesh { vertices, triangles: Vec::new() };
        (Horizon::of_surface(format!("H{n}"), points), Contact::Conformable)
    };
    let beds = [-350.0, -150.0, 50.0, 250.0].into_iter().enumerate().map(bed).collect();
    block(beds, &ClosedForm::flat(&geometry, &[10.0, 20.0]).with_fault(60.0, 2.0).faults)
}

#[test]
fn gpu_and_cpu_agree_on_horizons_of_any_shape() {
    if skipped() {
        return;
    }
    let quiet = Progress::silent();
    let mut renderer = Renderer::headless().expect("a Vulkan driver, or PETROGLYPH_GPU_TESTS=skip");
    let base = Scene { size_px: [150, 110], samples: 2, ..Scene::default() };
    let whole = VoxelBox::of_size(geometry().size());
    let cut_outs = vec![whole.corner_cut(base.view(&geometry()).nearest_corner(&whole), [0.5, 0.5])];
    let ground = Some(Ground::default());
    let salts = [
        ("salt", salt(Contact::Conformable, Contact::Intrusive)),
        ("eroded salt", salt(Contact::Erosional, Contact::Truncated)),
    ];
    let folds = [("fold", fold()), ("fold with harmonic k", fold().with_k(KDefinition::Harmonic))];
    let mut grounds = Vec::new();
    for (version, (name, block)) in (1..).zip(salts.into_iter().chain(folds)) {
        let inputs = Inputs { data_key: version, ..block.inputs(&[]) };
        let mut earlier = None;
        for scene in [Scene { cut_outs: cut_outs.clone(), ..base.clone() }, Scene { ground, ..base.clone() }] {
            let reference = render::reference::render(&scene, &inputs, &quiet).unwrap();
            let picture = renderer.render(&scene, &inputs, &quiet).unwrap();
            let found = compare(&reference, &picture).unwrap();
            assert!(found.agrees(), "{name}, with ground: {}: {found:?}", scene.ground.is_some());
            if let Some(earlier) = earlier.replace(picture) {
                assert!(!compare(&reference, &earlier).unwrap().agrees(), "{name}: the ground shows");
            }
        }
        grounds.extend(earlier);
    }
    assert!(!compare(&grounds[2], &grounds[3]).unwrap().agrees(), "which k shows");
}

/// The line at which salt that was worn down comes to the surface is where its outline has the depth of the ground; salt
/// that stands out of the ground meets it there, too.
#[test]
fn a_body_is_outlined_where_it_comes_to_the_surface() {
    let geometry = geometry();
    let camera = Camera { elevation_deg: 90.0, azimuth_deg: Some(0.0), ..Camera::default() };
    let scene = Scene { size_px: [400, 400], ground: Some(Ground::default()), camera, ..Scene::default() };
    let body = Diapir::fitting(&geometry);
    let view = scene.view(&geometry);
    for (ground, contact) in [(Contact::Erosional, Contact::Truncated), (Contact::Conformable, Contact::Intrusive)] {
        let block = salt(ground, contact);
        let library = TextureLibrary::builtin().unwrap();
        let traced =
            vectors(&scene, &block.inputs(&[]), &library, 0.05, scene.size_px, &Progress::silent()).unwrap().unwrap();
        let of_salt = traced.lines.iter().filter(|line| line.kind == VectorLineKind::Horizon(Some(2)));
        let parts: Vec<&Vec<DVec2>> = of_salt.flat_map(|line| &line.parts).collect();
        let depth = |at: DVec2| 330.0 - 60.0 * (-(at - DVec2::new(500.0, 400.0)).length_squared() / 9e4).exp();
        // Every place of the circle at which the outline has the depth of the ground, seen from above.
        let mut far = 0;
        for n in 0..64 {
            let direction = DVec2::from_angle(f64::from(n) * std::f64::consts::TAU / 64.0);
            let meets = |rho: f64| rho < body.radius(depth(body.axis + direction * rho));
            let rho = (1..4000).map(|n| f64::from(n) * 0.1).find(|rho| !meets(*rho)).unwrap();
            let at = body.axis + direction * rho;
            let p = view.project(geometry.voxel_from_world(world(&geometry, at.extend(depth(at)))));
            let straight = parts.iter().flat_map(|part| part.windows(2));
            let off = straight.map(|ends| {
                let along = ends[1] - ends[0];
                let t = ((p - ends[0]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                (ends[0] + along * t).distance(p)
            });
            far += usize::from(off.fold(f64::INFINITY, f64::min) > 2.0);
        }
        assert_eq!(far, 0, "{contact:?}: of 64 places so many have no line");
    }
}

/// Where a body stands out of the ground, the line along which it turns away is drawn: rays through it touch the body.
#[test]
fn a_body_that_stands_out_of_the_ground_has_a_silhouette() {
    let geometry = geometry();
    let body = Diapir::fitting(&geometry);
    let block = salt(Contact::Conformable, Contact::Intrusive);
    let library = TextureLibrary::builtin().unwrap();
    for elevation_deg in [30.0, 45.0] {
        let camera = Camera { elevation_deg, azimuth_deg: Some(25.0), ..Camera::default() };
        let scene = Scene { size_px: [400, 400], ground: Some(Ground::default()), camera, ..Scene::default() };
        let view = scene.view(&geometry);
        let traced =
            vectors(&scene, &block.inputs(&[]), &library, 0.05, scene.size_px, &Progress::silent()).unwrap().unwrap();
        let crests = traced.lines.iter().filter(|line| line.kind == VectorLineKind::Horizon(None));
        let parts: Vec<&Vec<DVec2>> = crests.flat_map(|line| &line.parts).collect();
        let length: f64 = parts.iter().flat_map(|part| part.windows(2)).map(|ends| ends[0].distance(ends[1])).sum();
        assert!(length > 60.0, "from {elevation_deg} degrees: {length} px");
        for at in parts.iter().flat_map(|part| part.iter()) {
            let ray = view.ray(*at);
            // How far the ray stays outside, or how deep it runs inside, m.
            let outside = |n: u32| {
                let voxel = ray.origin + ray.direction * (f64::from(n) * 0.05);
                let metres = voxel * DVec3::new(25.0, 25.0, 20.0);
                let is_above = metres.z < body.bulb_z;
                is_above.then(|| metres.truncate().distance(body.axis) - body.radius(metres.z))
            };
            let nearest = (0..4000).filter_map(outside).fold(f64::INFINITY, f64::min);
            assert!(nearest.abs() < 12.5, "from {elevation_deg} degrees, {at}: {nearest} m");
        }
    }
}
