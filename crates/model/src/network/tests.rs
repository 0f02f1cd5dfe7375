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
