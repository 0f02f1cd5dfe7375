//! Where samples of a volume lie.

use super::*;

#[test]
fn a_linear_field_is_reproduced_on_another_lattice() {
    // 5 × 3 × 9 samples over a part of the survey, value 2x − y + 3z in survey voxels.
    let covers = VoxelBox { min: [10.0, 20.0, 30.0], max: [18.0, 24.0, 34.0] };
    let mut volume = Volume::filled([5, 3, 9], 0.0f32);
    for x in 0..5 {
        for y in 0..3 {
            for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
                let p = [10.0 + 2.0 * x as f32, 20.0 + 2.0 * y as f32, 30.0 + 0.5 * z as f32];
                *value = 2.0 * p[0] - p[1] + 3.0 * p[2];
            }
        }
    }
    let named = NamedVolume { name: "a", volume: Samples::Whole(&volume), covers };
    for p in [Vec3::new(10.0, 20.0, 30.0), Vec3::new(13.3, 21.9, 33.37), Vec3::new(18.0, 24.0, 34.0)] {
        assert!((named.sample(p) - (2.0 * p.x - p.y + 3.0 * p.z)).abs() < 1e-3, "{p}");
    }
    assert!(named.sample(Vec3::new(9.9, 21.0, 31.0)).is_nan());
    assert!(named.sample(Vec3::new(12.0, 21.0, 34.1)).is_nan());
}

/// Surfaces lie three samples apart and dip by two samples in three traces. The shallowest changes its
/// leaf at trace 12.
#[test]
fn a_border_is_where_a_surface_changes_its_leaf_not_where_another_is_near() {
    let size = [24, 5, 40];
    let depth = |x: f32| 8.0 + x * 2.0 / 3.0;
    let lean = 3.0 / 13.0f32.sqrt();
    let (mut distance, mut leaf) = (Vec::new(), Vec::new());
    for n in 0..size.iter().product::<usize>() {
        let (x, z) = (n / (size[1] * size[2]), (n % size[2]) as f32);
        let below = |k: usize| (z - depth(x as f32) - 3.0 * k as f32).abs() * lean;
        let nearest = (0..4).min_by(|a, b| below(*a).total_cmp(&below(*b))).unwrap();
        distance.push((below(nearest) / 0.04).min(255.0) as u8);
        leaf.push(if nearest == 0 && x >= 12 { 9 } else { nearest as u32 + 1 });
    }
    let candidates = CandidateVolume { size, distance: &distance, leaf: &leaf, voxels_per_step: 0.04, groups: None };
    candidates.validate().unwrap();
    for n in 0..900 {
        // Positions around the shell of one voxel about each surface.
        let x = 2.0 + (n % 100) as f32 * 0.2;
        let surface = n / 100 % 3;
        let off = ((n / 300) as f32 - 1.0) * 0.9 / lean;
        let p = Vec3::new(x, 2.0, depth(x) + 3.0 * surface as f32 + off);
        // If the nearest sample belongs to another surface, so does the point.
        let shallowest = [1, 9].contains(&candidates.leaf_at(p));
        let expected = shallowest && (x - 11.5).abs() < 0.2;
        let clear = !shallowest || (x - 11.5).abs() > 1.3;
        assert!(candidates.is_border(p) == expected || !(clear || expected), "{p} {surface}");
    }
}

#[test]
fn a_dead_trace_is_no_data_but_its_neighbours_are() {
    let mut volume = Volume::filled([3, 3, 2], 1.0f32);
    volume.set_live(Some((0..9).map(|n| n != 4).collect())).unwrap();
    let named = NamedVolume::whole("a", &volume);
    assert_eq!(named.sample(Vec3::new(0.0, 1.0, 0.5)), 1.0);
    assert!(named.sample(Vec3::new(0.5, 1.0, 0.5)).is_nan());
    assert!(named.sample(Vec3::new(1.0, 1.0, 0.0)).is_nan());
}
