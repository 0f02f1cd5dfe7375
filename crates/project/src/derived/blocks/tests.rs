//! Fault blocks that are kept, and found again.

use super::*;
use files::fault_of_sticks;
use glam::Vec3;
use survey::height_field::FAR;
use survey::{Fault, SurveyGeometry, VerticalUnit};

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([40, 30, 50], 25.0, 10.0, VerticalUnit::Metres)
}

/// A fault along the crosslines, dipping to higher inlines; a second one across that ends at it.
fn blocks() -> FaultNetwork {
    let geometry = geometry();
    let fault = |name: &str, sticks: [[[f64; 3]; 2]; 2]| {
        let sticks = sticks.map(|stick| stick.map(|p| geometry.world_from_voxel(DVec3::from_array(p))).to_vec());
        fault_of_sticks(name, &sticks, &geometry).unwrap()
    };
    let first = fault("first", [[[15.0, 2.0, 5.0], [25.0, 2.0, 45.0]], [[15.0, 27.0, 5.0], [25.0, 27.0, 45.0]]]);
    let second = fault("second", [[[22.0, 14.0, 5.0], [30.0, 14.0, 45.0]], [[38.0, 16.0, 5.0], [38.0, 16.0, 45.0]]]);
    let second = Fault { truncated_by: Some("first".into()), ..second };
    FaultNetwork::build(&geometry, &[first, second], &Progress::silent()).unwrap()
}

#[test]
fn blocks_come_back_as_they_were_and_damaged_ones_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let (root, wanted) = (folder.path(), blocks());
    assert_eq!(wanted.block_count(), 3);
    BLOCKS.keep(root, "aa", &Progress::silent(), |out| write(out, &wanted));
    let names = ["first", "second"].map(str::to_owned);
    let load = |key: &str| BLOCKS.load(root, key, read);
    assert_eq!(load("aa").map(|loaded| loaded.named(names)).as_ref(), Some(&wanted));
    assert!(load("bb").is_none());
    let path = BLOCKS.path(root, "aa");
    let mut damaged = std::fs::read(&path).unwrap();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    std::fs::write(&path, &damaged).unwrap();
    assert!(BLOCKS.load(root, "aa", read).is_none());
}

/// Loads the blocks with their first surface changed, from a file whose hash is right.
fn loaded_with(change: impl Fn(&mut FaultSurface)) -> Option<FaultNetwork> {
    let (folder, whole) = (tempfile::tempdir().unwrap(), blocks());
    let mut surfaces = whole.surfaces().to_vec();
    change(&mut surfaces[0]);
    BLOCKS.keep(folder.path(), "aa", &Progress::silent(), |out| {
        write_parts(out, &surfaces, whole.truncation(), whole.signatures())
    });
    BLOCKS.load(folder.path(), "aa", read)
}

#[test]
fn blocks_with_a_valid_hash_and_a_place_far_outside_overflow_nothing() {
    // Places that differences of 32 bits do not reach are refused.
    for far in [i32::MIN, i32::MIN + 1, -FAR - 1, FAR + 1, i32::MAX] {
        for axis in 0..2 {
            assert!(loaded_with(|fault| fault.surface.origin[axis] = far).is_none(), "axis {axis} at {far}");
        }
    }
    for wrong in [f64::NAN, f64::INFINITY] {
        assert!(loaded_with(|fault| fault.frame_offset.x = wrong).is_none());
        assert!(loaded_with(|fault| fault.frame_from_voxel.x_axis.y = wrong).is_none());
    }
    // What is taken can be asked anywhere.
    let changes: [fn(&mut FaultSurface); 5] = [
        |_| (),
        |fault| fault.surface.origin = [FAR, -FAR],
        |fault| fault.frame_offset = DVec3::splat(1e300),
        |fault| fault.frame_offset = DVec3::splat(-f64::MAX),
        |fault| fault.frame_from_voxel = DMat3::from_diagonal(DVec3::splat(f64::MAX)),
    ];
    for (n, change) in changes.into_iter().enumerate() {
        let blocks = loaded_with(change).unwrap_or_else(|| panic!("{n} was not taken"));
        for at in [0.0, 20.0, -1e9, 1e9, f32::MIN, f32::MAX] {
            for p in [Vec3::splat(at), Vec3::new(at, 0.0, 0.0), Vec3::new(0.0, -at, at)] {
                assert!(usize::from(blocks.block_at(p)) < blocks.block_count(), "{n} at {p}");
                let _ = (blocks.side(0, p), blocks.is_real(0, p));
                let _ = blocks.surfaces()[0].side_gradient(p.as_dvec3());
            }
        }
    }
}

#[test]
fn parts_that_do_not_go_together_are_no_blocks() {
    let whole = blocks();
    let parts = |surfaces: &[FaultSurface], truncation: &[Option<Truncation>], signatures: &[BlockSignature]| {
        FaultNetwork::of_parts(surfaces.to_vec(), truncation.to_vec(), signatures.to_vec())
    };
    let (surfaces, truncation, signatures) = (whole.surfaces(), whole.truncation(), whole.signatures());
    assert_eq!(parts(surfaces, truncation, signatures), Some(whole.clone()));
    assert!(parts(&surfaces[..1], truncation, signatures).is_none());
    assert!(parts(surfaces, truncation, &[]).is_none());
    let circle = [Some(Truncation { by: 1, positive: true }), Some(Truncation { by: 0, positive: true })];
    assert!(parts(surfaces, &circle, signatures).is_none());
    let mut cut = surfaces.to_vec();
    cut[0].surface.z.pop();
    assert!(parts(&cut, truncation, signatures).is_none());
}

#[test]
fn the_key_sees_the_geometry_and_no_layer_names() {
    let geometry = geometry();
    let document = Document::empty(Some(geometry));
    let key = |document: &Document| blocks_key(document);
    let mut faster = document.clone();
    faster.geometry.as_mut().unwrap().velocity_m_s = 3000.0;
    assert_ne!(key(&document), key(&faster));
    let mut named = document.clone();
    named.layer_names = vec!["Rock".into()];
    assert_eq!(key(&document), key(&named));
}
