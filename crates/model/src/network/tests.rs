//! Blocks of random places against the closed form.

use super::*;
use survey::geometry::VerticalUnit;
use survey::mesh::TriangleMesh;

const BIN_M: f64 = 25.0;
const SAMPLE_M: f64 = 10.0;

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([48, 40, 60], BIN_M, SAMPLE_M, VerticalUnit::Metres)
}

/// A mesh over (a, b) in [0, 1]² with `n` cells a side; `at` gives voxel positions.
pub(crate) fn mesh(n: usize, at: impl Fn(f64, f64) -> DVec3) -> TriangleMesh {
    let mut out = TriangleMesh::default();
    for i in 0..=n {
        for j in 0..=n {
            let p = at(i as f64 / n as f64, j as f64 / n as f64);
            out.vertices.push(geometry().world_from_voxel(p));
        }
    }
    let id = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    for i in 0..n {
        for j in 0..n {
            out.triangles.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
            out.triangles.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
        }
    }
    out
}

fn fault(name: &str, mesh: TriangleMesh, truncated_by: Option<&str>) -> Fault {
    Fault { truncated_by: truncated_by.map(Into::into), ..Fault::new(name, mesh) }
}

fn network(faults: &[Fault]) -> FaultNetwork {
    FaultNetwork::build(&geometry(), faults, &Progress::silent()).unwrap()
}

fn places(count: usize) -> Vec<Vec3> {
    let mut state = 9u32;
    let mut next = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1u32 << 24) as f32
    };
    (0..count).map(|_| Vec3::new(47.0 * next(), 39.0 * next(), 59.0 * next())).collect()
}

/// Blocks must be in one-to-one correspondence with `truth` wherever `distance` (voxels to the nearest fault)
/// is more than 0.02.
fn same_partition(n: &FaultNetwork, truth: impl Fn(Vec3) -> (u32, f32)) {
    let mut of_truth = std::collections::BTreeMap::new();
    let mut of_block = std::collections::BTreeMap::new();
    for p in places(20_000) {
        let (t, distance) = truth(p);
        if distance > 0.02 {
            let b = n.block_at(p);
            assert_eq!(*of_truth.entry(t).or_insert(b), b, "at {p}");
            assert_eq!(*of_block.entry(b).or_insert(t), t, "at {p}");
        }
    }
    assert_eq!(of_truth.len(), n.block_count());
}

#[test]
fn a_dipping_plane_cuts_in_two_far_beyond_its_mesh() {
    // x = 20 + 0.4 (z − 30) + 0.1 (y − 20), interpreted in the middle only.
    let x = |y: f64, z: f64| 20.0 + 0.4 * (z - 30.0) + 0.1 * (y - 20.0);
    let at = |a: f64, b: f64| {
        let (y, z) = (12.0 + 16.0 * a, 20.0 + 20.0 * b);
        DVec3::new(x(y, z), y, z)
    };
    let n = network(&[fault("F", mesh(4, at), None)]);
    same_partition(&n, |p| {
        let d = p.x - x(f64::from(p.y), f64::from(p.z)) as f32;
        (u32::from(d > 0.0), d.abs())
    });
    // Real inside the mesh, virtual beyond its tip.
    let on = |y: f64, z: f64| DVec3::new(x(y, z), y, z).as_vec3();
    assert!(n.is_real(0, on(20.0, 30.0)) && n.is_real(0, on(27.9, 30.0)) && n.is_real(0, on(20.0, 39.8)));
    assert!(!n.is_real(0, on(28.1, 30.0)) && !n.is_real(0, on(20.0, 40.2)) && !n.is_real(0, on(5.0, 5.0)));
}

#[test]
fn a_rim_near_the_outer_boundary_reaches_it_and_a_tip_stays_where_it_is() {
    // From 2 samples below the top to 3 above the bottom, and from y = 0 to a tip at y = 25.
    let at = |a: f64, b: f64| DVec3::new(20.0, 25.0 * a, 2.0 + 54.0 * b);
    let n = network(&[fault("F", mesh(8, at), None)]);
    for z in [0.0, 1.0, 30.0, 58.9] {
        assert!(n.is_real(0, Vec3::new(21.0, 0.0, z)) && n.is_real(0, Vec3::new(21.0, 24.9, z)), "{z}");
        assert!(!n.is_real(0, Vec3::new(21.0, 25.1, z)), "{z}");
    }
}

#[test]
fn crossing_faults_make_four_blocks() {
    let a = |y: f64, z: f64| 24.0 + 0.3 * (z - 30.0) + 0.05 * y;
    let b = |y: f64, z: f64| 22.0 - 0.35 * (z - 30.0) + 0.02 * y;
    let over = |x: &dyn Fn(f64, f64) -> f64| {
        mesh(5, |s, t| {
            let (y, z) = (39.0 * s, 59.0 * t);
            DVec3::new(x(y, z), y, z)
        })
    };
    let n = network(&[fault("A", over(&a), None), fault("B", over(&b), None)]);
    same_partition(&n, |p| {
        let (y, z) = (f64::from(p.y), f64::from(p.z));
        let (da, db) = (p.x - a(y, z) as f32, p.x - b(y, z) as f32);
        (u32::from(da > 0.0) + 2 * u32::from(db > 0.0), da.abs().min(db.abs()))
    });
}

#[test]
fn faults_in_an_x_are_told_as_they_were_drawn() {
    // Planes that cross where both were drawn, on different shares of the volume, and one that ends before.
    let over = |lean: f64, [from, to]: [f64; 2]| {
        mesh(10, |s, t| {
            let z = from + (to - from) * t;
            DVec3::new(24.0 + lean * (z - 30.0), 39.0 * s, z)
        })
    };
    let told = |span: [f64; 2], other: [f64; 2]| {
        let (a, b) = (fault("A", over(0.4, span), None), fault("B", over(-0.4, other), None));
        drawn_crossing(&geometry(), &b, &[a]).unwrap().map(|note| note.to_string())
    };
    for (span, other) in [([0.0, 59.0], [0.0, 59.0]), ([4.0, 55.0], [0.0, 59.0]), ([0.0, 59.0], [7.3, 51.1])] {
        let note = told(span, other).unwrap_or_default();
        assert!(note.starts_with("faults \"A\" and \"B\" cross near inline"), "{span:?} and {other:?}: {note}");
    }
    assert_eq!(told([0.0, 59.0], [0.0, 31.0]), None);
}

#[test]
fn a_truncated_fault_ends_at_the_other() {
    let main = |z: f64| 14.0 + 0.4 * z;
    let antithetic = |z: f64| 44.0 - 0.5 * z;
    // They meet at z = 100/3; the antithetic fault is interpreted to 1 sample above that.
    let a = mesh(6, |s, t| DVec3::new(main(59.0 * t), 39.0 * s, 59.0 * t));
    let b = mesh(6, |s, t| DVec3::new(antithetic(32.0 * t), 39.0 * s, 32.0 * t));
    for order in [[0, 1], [1, 0]] {
        let both = [fault("main", a.clone(), None), fault("antithetic", b.clone(), Some("main"))];
        let n = network(&order.map(|i: usize| both[i].clone()));
        same_partition(&n, |p| {
            let (da, db) = (p.x - main(f64::from(p.z)) as f32, p.x - antithetic(f64::from(p.z)) as f32);
            if da < 0.0 { (0, da.abs()) } else { (1 + u32::from(db > 0.0), da.abs().min(db.abs())) }
        });
        let f = order.iter().position(|&i| i == 1).unwrap();
        let on = |z: f64| DVec3::new(antithetic(z), 20.0, z).as_vec3();
        assert!(n.is_real(f, on(10.0)) && n.is_real(f, on(33.0)));
        assert!(!n.is_real(f, on(34.0)) && !n.is_real(f, on(50.0)));
    }
}

#[test]
fn a_listric_fault_is_followed() {
    let x = |z: f64| 10.0 + 0.004 * z * z;
    let n = network(&[fault("L", mesh(30, |s, t| DVec3::new(x(59.0 * t), 39.0 * s, 59.0 * t)), None)]);
    // The mesh's own chords lie 0.004 (59/30)² / 8 off the curve.
    same_partition(&n, |p| {
        let d = p.x - x(f64::from(p.z)) as f32;
        (u32::from(d > 0.0), (d.abs() - 0.02).max(0.0))
    });
}

#[test]
fn blocks_do_not_depend_on_the_fault_order_given_or_the_corner_they_touch() {
    let plane = |x0: f64, slope: f64| mesh(3, move |s, t| DVec3::new(x0 + slope * 59.0 * t, 39.0 * s, 59.0 * t));
    let n = network(&[fault("A", plane(30.0, 0.0), None), fault("B", plane(15.0, 0.0), None)]);
    // Numbered by their first voxel in memory: from low x to high.
    assert_eq!((n.block_at(Vec3::ZERO), n.block_count()), (0, 3));
    assert_eq!((n.block_at(Vec3::new(20.0, 0.0, 0.0)), n.block_at(Vec3::new(40.0, 0.0, 0.0))), (1, 2));
    // The table and the signatures agree.
    for bits in 0..4u64 {
        assert_eq!(n.table().unwrap()[bits as usize], n.nearest_block(bits));
    }
}

/// The RMS distance of a mesh's vertices from the surface of the only fault of a network, m.
fn misfit_m(n: &FaultNetwork, mesh: &TriangleMesh) -> f64 {
    let off = |v: &DVec3| n.surfaces()[0].side(geometry().voxel_from_world(*v)).powi(2);
    (mesh.vertices.iter().map(off).sum::<f64>() / mesh.vertices.len() as f64).sqrt()
}

#[test]
fn a_ribbon_that_wanders_farther_than_it_is_high_is_followed() {
    // 100 m high, nearly 1 km long, and it wanders by 400 m: its best-fit plane is nearly level, over which it folds.
    let x = |y: f64, z: f64| 24.0 + 8.0 * (y / 5.0).sin() + 0.02 * (z - 30.0);
    let ribbon = mesh(40, |s, t| {
        let (y, z) = (39.0 * s, 25.0 + 10.0 * t);
        DVec3::new(x(y, z), y, z)
    });
    let n = network(&[fault("R", ribbon.clone(), None)]);
    assert!(misfit_m(&n, &ribbon) < 2.0, "{}", misfit_m(&n, &ribbon));
    for (y, off) in [(4.0, 0.5), (17.0, -0.5), (33.0, 0.5)] {
        let side = |by: f64| n.side(0, DVec3::new(x(y, 30.0) + by, y, 30.0).as_vec3());
        assert!(side(off) * side(-off) < 0.0, "{y}");
    }
}

#[test]
fn a_fault_that_turns_by_90_degrees_along_strike_and_flattens_is_followed() {
    // A listric fault around a quarter of a circle: steep at its top, lying at its foot.
    let bowl = mesh(40, |s, t| {
        let (angle, flat) = (std::f64::consts::FRAC_PI_2 * s, 1.35 * t);
        let radius = 38.0 - 14.0 * (1.0 - flat.cos());
        DVec3::new(radius * angle.cos() + 5.0, radius * angle.sin(), 5.0 + 35.0 * flat.sin())
    });
    let n = network(&[fault("B", bowl.clone(), None)]);
    assert!(misfit_m(&n, &bowl) < 15.0, "{}", misfit_m(&n, &bowl));
}

#[test]
fn a_small_fold_and_tangled_triangles_are_smoothed() {
    // A plane with a lip of 4 voxels that runs back under itself.
    let lip = mesh(60, |s, t| {
        let z = 59.0 * t;
        let curl = if (0.45..0.55).contains(&t) { (62.83 * (t - 0.45)).sin() } else { 0.0 };
        DVec3::new(20.0 + 0.2 * z + 4.0 * curl, 39.0 * s, z + 7.0 * curl)
    });
    let n = network(&[fault("L", lip.clone(), None)]);
    assert!(misfit_m(&n, &lip) < 60.0, "{}", misfit_m(&n, &lip));
    let fit = fit_of(&geometry(), &fault("L", lip, None)).unwrap();
    assert!(fit.is_some_and(|off_m| off_m > 1.0 && off_m < 100.0), "{fit:?}");
    // Triangles that join the nodes of a dipping plane in no order, each node up to 30 m off it.
    let mut state = 5u32;
    let mut next = |count: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % count
    };
    let mut tangled = mesh(7, |s, t| DVec3::new(14.0 + 0.3 * 59.0 * t, 39.0 * s, 59.0 * t));
    let count = tangled.vertices.len();
    tangled.vertices.iter_mut().for_each(|v| v.x += 60.0 * (next(1000) as f64 / 1000.0 - 0.5));
    tangled.triangles = (0..120).map(|_| [next(count) as u32, next(count) as u32, next(count) as u32]).collect();
    let n = network(&[fault("T", tangled, None)]);
    for z in [10.0, 30.0, 50.0] {
        let off = n.side(0, DVec3::new(14.0 + 0.3 * z, 20.0, z).as_vec3());
        assert!(off.abs() < 30.0, "{off}");
    }
}

#[test]
fn what_no_plane_sees_is_split_into_parts_that_fit() {
    // Three quarters of a cylinder about a vertical axis, and the walls of a graben with its floor.
    let ring = mesh(40, |s, t| {
        let angle = 4.7 * s;
        DVec3::new(24.0 + 14.0 * angle.cos(), 20.0 + 14.0 * angle.sin(), 59.0 * t)
    });
    let trough = mesh(60, |s, t| {
        let along = 130.0 * s;
        let (x, z) = if along < 50.0 {
            (10.0, 5.0 + along)
        } else if along < 80.0 {
            (10.0 + along - 50.0, 55.0)
        } else {
            (40.0, 55.0 - (along - 80.0))
        };
        DVec3::new(x, 39.0 * t, z)
    });
    for (name, folded) in [("ring", ring), ("trough", trough)] {
        let whole = fault(name, folded, None);
        let area = |mesh: &TriangleMesh| mesh.triangles.len();
        assert!(matches!(fit_of(&geometry(), &whole), Err(ModelError::FoldedFault { .. })), "{name}");
        let parts = split(&geometry(), &whole).unwrap();
        assert!((2..=4).contains(&parts.len()), "{name}: {} parts", parts.len());
        assert_eq!(parts.iter().map(|part| area(&part.mesh)).sum::<usize>(), area(&whole.mesh), "{name}");
        let faults: Vec<Fault> = parts
            .iter()
            .enumerate()
            .map(|(k, part)| Fault {
                truncated_by: part.ends_at.map(|at| format!("P{at}")),
                ..Fault::new(format!("P{k}"), part.mesh.clone())
            })
            .collect();
        let n = network(&faults);
        for (f, part) in parts.iter().enumerate() {
            let off = |v: &DVec3| n.surfaces()[f].side(geometry().voxel_from_world(*v)).abs();
            let worst = part.mesh.vertices.iter().map(off).fold(0.0, f64::max);
            assert!(worst < 60.0, "{name} {f}: {worst}");
        }
    }
}

#[test]
fn bad_faults_are_named() {
    let build = |faults: &[Fault]| FaultNetwork::build(&geometry(), faults, &Progress::silent()).unwrap_err();
    let flat = || mesh(2, |s, t| DVec3::new(20.0, 39.0 * s, 59.0 * t));
    let mut nan = flat();
    nan.vertices.iter_mut().for_each(|v| v.x = f64::NAN);
    assert_eq!(build(&[fault("N", nan, None)]), ModelError::EmptyFault { name: "N".into() });
    assert_eq!(build(&[fault("E", TriangleMesh::default(), None)]), ModelError::EmptyFault { name: "E".into() });
    let twice = [fault("A", flat(), None), fault("A", flat(), None)];
    assert_eq!(build(&twice), ModelError::DuplicateName { what: "faults", name: "A".into() });
    let unknown = ModelError::UnknownTruncation { name: "A".into(), by: "Z".into() };
    assert_eq!(build(&[fault("A", flat(), Some("Z"))]), unknown);
    let circle = [fault("A", flat(), Some("B")), fault("B", flat(), Some("A"))];
    assert_eq!(build(&circle), ModelError::CyclicTruncation { names: vec!["A".into(), "B".into(), "A".into()] });
    // A half cylinder about the y axis.
    let rolled = mesh(24, |s, t| {
        let angle = 4.5 * t;
        DVec3::new(24.0 + 10.0 * angle.cos(), 39.0 * s, 30.0 + 25.0 * angle.sin())
    });
    match build(&[fault("R", rolled, None)]) {
        ModelError::FoldedFault { name, offset_m, .. } => assert!(name == "R" && offset_m > 100.0),
        other => panic!("{other}"),
    }
}
