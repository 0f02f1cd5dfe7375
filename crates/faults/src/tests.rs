//! Tests on beds of which everything is known: a plane fault, none, folds, noise, stripes.

use super::*;
use survey::VerticalUnit;
use survey::sample::SamplesMut;
use survey::source::{Block, BlockSource};

/// Reflectivity of made-up beds at a stratigraphic depth: nothing repeats over a few beds.
fn beds(t: f32) -> f32 {
    (t * 0.71).sin() + 0.8 * (t * 0.43 + 1.0).sin() + 0.5 * (t * 0.93 + 2.0).cos()
}

/// A number between −1 and 1 for a counter.
fn noise(n: usize) -> f32 {
    let mixed = (n as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(31).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 40) as f32 / (1u64 << 23) as f32 - 1.0
}

fn volume(size: [usize; 3], sample: impl Fn(usize, f32, f32, f32) -> f32) -> Volume<f32> {
    let mut volume = Volume::filled(size, 0.0f32);
    let [_, ny, nz] = size;
    for (n, out) in volume.samples_mut().iter_mut().enumerate() {
        *out = sample(n, (n / nz / ny) as f32, (n / nz % ny) as f32, (n % nz) as f32);
    }
    volume
}

fn geometry(size: [usize; 3]) -> SurveyGeometry {
    SurveyGeometry::regular(size, 25.0, 10.0, VerticalUnit::Metres)
}

/// The line across at which the fault of the tests runs.
fn fault(y: f32, z: f32) -> f32 {
    28.0 + 0.3 * (z - 48.0) + 0.2 * (y - 24.0)
}

fn faulted(throw: f32, level: f32) -> Volume<f32> {
    volume([56, 48, 96], |n, x, y, z| beds(z - 0.2 * y - if x > fault(y, z) { throw } else { 0.0 }) + level * noise(n))
}

fn found(volume: &Volume<f32>) -> Vec<FaultSurface> {
    find(volume, &geometry(volume.size()), &Progress::silent()).unwrap()
}

#[test]
fn a_plane_fault_is_found_with_its_place_throw_dip_and_sense() {
    for (throw, level) in [(5.0, 0.0), (7.0, 0.5), (-6.0, 0.0)] {
        let volume = faulted(throw, level);
        let all = found(&volume);
        assert_eq!(all.len(), 1, "throw {throw}");
        let surface = &all[0];
        assert!(surface.is_accepted(), "{}", surface.evidence);
        let cells: Vec<usize> = (0..surface.sheet.there.len()).filter(|&n| surface.sheet.there[n]).collect();
        let off = |n: usize| {
            let [x, y, z] = surface.sheet.voxel(n);
            (x - fault(y, z)).abs()
        };
        let mean = cells.iter().map(|&n| off(n)).sum::<f32>() / cells.len() as f32;
        assert!(mean < 0.5, "{mean} traces off");
        assert!(surface.sheet.area() > 0.85 * 48.0 * 96.0, "{}", surface.sheet.area());
        let proposal = &proposals(&all, &[], &geometry(volume.size()))[0];
        assert!((proposal.throw[0] - 10.0 * f64::from(throw.abs())).abs() <= 10.0, "{:?}", proposal.throw);
        assert_eq!((proposal.reverse, proposal.is_minor), (throw < 0.0, false));
        let dip = (1.04f64.sqrt() / (0.3 * 25.0 / 10.0)).atan().to_degrees();
        assert!((proposal.dip_deg - dip).abs() < 3.0, "{} for {dip}", proposal.dip_deg);
        assert!(proposal.mesh.triangles.len() > 100);
    }
}

#[test]
fn what_is_no_fault_is_not_taken_for_one() {
    let size = [56, 48, 96];
    let fold = |x: f32, y: f32| 6.0 * (0.11 * x).sin() + 4.0 * (0.09 * y + 0.5 * (0.07 * x).sin()).cos();
    let cases: [(&str, Volume<f32>); 7] = [
        ("a constant", Volume::filled(size, 3.0)),
        ("noise", volume(size, |n, _, _, _| noise(n))),
        ("plane beds", volume(size, |_, x, y, z| beds(z - 0.3 * x + 0.2 * y))),
        ("folds with noise", volume(size, |n, x, y, z| beds(z - fold(x, y)) + noise(n))),
        (
            "stripes along inlines",
            volume(size, |_, x, y, z| {
                beds(z - 0.2 * y) + if (x as usize / 4).is_multiple_of(2) { 0.8 } else { -0.8 } * (0.9 * z + 2.0).sin()
            }),
        ),
        ("an unconformity", volume(size, |_, x, _, z| if z < 40.0 { beds(z) } else { beds(0.8 * z - 0.7 * x) })),
        (
            "a channel",
            volume(size, |_, x, y, z| {
                let depth = 9.0 - 0.25 * (x - 28.0 - 6.0 * (0.1 * y).sin()).powi(2);
                if z > 40.0 && z < 40.0 + depth { beds(2.0 * z + 0.4 * x) } else { beds(z) }
            }),
        ),
    ];
    for (what, volume) in cases {
        let [all, cuts] = find_with_cuts(&volume, &geometry(volume.size()), &Progress::silent()).unwrap();
        // Stripes may look like one.
        assert!(
            cuts.len() <= usize::from(what.starts_with("stripes")),
            "{what}: cuts of {:?}",
            cuts.iter().map(|cut| cut.sheet.area()).collect::<Vec<_>>()
        );
        assert!(all.iter().all(|surface| !surface.is_accepted()), "{what}: {:?}", all.first().map(|s| s.evidence));
    }
    assert!(found(&Volume::filled([1, 60, 90], 1.0)).is_empty(), "one inline");
}

/// A throw of two samples everywhere is little, for slopes may be as far off: whatever its evidence it is listed apart, unless
/// it grows to more than three somewhere.
#[test]
fn a_small_throw_is_only_possible() {
    let mut fault = found(&faulted(5.0, 0.0)).remove(0);
    for (median, upper_decile, is_accepted) in [(-2.0, 3.0, false), (2.0, 4.0, true), (-3.0, 3.0, true)] {
        (fault.offsets.median, fault.offsets.upper_decile) = (median, upper_decile);
        assert_eq!((fault.is_possible(), fault.is_accepted()), (true, is_accepted), "{median}, {upper_decile}");
        let proposed = proposals(std::slice::from_ref(&fault), &[], &geometry([56, 48, 96]));
        assert_eq!(proposed[0].is_minor, !is_accepted);
    }
}

/// Other beds beyond a plane: no throw makes both sides match, so it is a cut, and says so. A fault is none.
#[test]
fn where_other_beds_begin_is_a_cut() {
    // Layers of random strength, of their own on each side.
    let layers = |rock: usize, t: f32| {
        let (n, share) = (t.max(0.0) as usize, t.max(0.0).fract());
        let strength = |n: usize| noise(n * n * (131 + 18 * rock) + rock);
        strength(n) * (1.0 - share) + strength(n + 1) * share
    };
    let volume = volume([56, 48, 96], |_, x, y, z| layers(usize::from(x > fault(y, z)), 0.6 * (z - 0.2 * y) + 20.0));
    let geometry = geometry(volume.size());
    let [faults, cuts] = find_with_cuts(&volume, &geometry, &Progress::silent()).unwrap();
    // A part of it may match by chance; the rest has no throw.
    let area: f32 = faults.iter().chain(&cuts).map(|surface| surface.sheet.area()).sum();
    assert!(!cuts.is_empty() && area > 0.8 * 48.0 * 96.0, "{} cuts, {area}", cuts.len());
    assert!(faults.iter().all(|fault| fault.offsets.constant < 0.6));
    let proposed = proposals(&faults, &cuts, &geometry);
    let proposal = proposed.last().unwrap();
    assert!(proposal.is_cut && proposal.is_minor && proposal.throw == [0.0; 2]);
    assert!(proposal.rests_on().contains("no throw") && proposal.throw_in_words("m") == "cut without a throw");
    let [faults, cuts] = find_with_cuts(&faulted(5.0, 0.2), &geometry, &Progress::silent()).unwrap();
    assert_eq!((faults.len(), cuts.len()), (1, 0));
}

#[test]
fn a_surface_from_elsewhere_is_told_by_its_sides() {
    let volume = faulted(6.0, 0.2);
    let geometry = geometry(volume.size());
    let slopes = slopes(&volume, &Progress::silent()).unwrap();
    let mesh = |place: &dyn Fn(f32, f32) -> f32| {
        let corner = |y: f32, z: f32| {
            geometry.world_from_voxel(glam::DVec3::new(f64::from(place(y, z)), f64::from(y), f64::from(z)))
        };
        let vertices = vec![corner(2.0, 10.0), corner(45.0, 10.0), corner(45.0, 85.0), corner(2.0, 85.0)];
        TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] }
    };
    let (there, beside) = (mesh(&fault), mesh(&|y, z| fault(y, z) - 12.0));
    let told = measure(&volume, &slopes, &geometry, &[&there, &beside], &Progress::silent()).unwrap();
    let evidence = |n: usize| told[n].as_ref().unwrap();
    assert!(evidence(0).is_accepted() && (evidence(0).offsets.median.abs() - 6.0).abs() <= 1.0);
    assert!(!evidence(1).is_possible(), "{}", evidence(1).evidence);
}

#[test]
fn throws_of_ridges_are_those_of_the_fault_for_any_tiling_and_threads() {
    let volume = faulted(6.0, 0.0);
    let geometry = geometry(volume.size());
    let whole = throw(&volume, &geometry, &Progress::silent()).unwrap();
    let known: Vec<f32> = whole.samples().iter().copied().filter(|throw| throw.is_finite()).collect();
    assert!(known.len() > 2000, "{}", known.len());
    let near = known.iter().filter(|throw| (**throw - 6.0).abs() <= 1.0).count();
    assert!(near as f32 > 0.85 * known.len() as f32, "{near} of {}", known.len());
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (again, surfaces) =
            pool.install(|| (throw(&volume, &geometry, &Progress::silent()).unwrap(), found(&volume)));
        let bits = |volume: &Volume<f32>| volume.samples().iter().map(|s| s.to_bits()).collect::<Vec<u32>>();
        assert!(bits(&again) == bits(&whole), "{threads} threads");
        assert_eq!(surfaces.len(), 1);
    }
}

#[test]
fn throws_in_blocks_are_those_of_the_whole() {
    let size = [150, 24, 48];
    let volume = volume(size, |n, x, y, z| {
        let thrown = if (x + 0.2 * y) % 40.0 > 20.0 { 6.0 } else { 0.0 };
        beds(z - thrown) + 0.3 * noise(n)
    });
    let geometry = SurveyGeometry::regular(size, 25.0, 2.5, VerticalUnit::Metres);
    let whole = throw(&volume, &geometry, &Progress::silent()).unwrap();
    assert!(whole.samples().iter().any(|throw| throw.is_finite()));
    let mut blocks = throw_blocks(&volume, &geometry);
    for first in (0..size[0]).step_by(50) {
        let block = Block { inlines: first..first + 50, crosslines: 0..size[1] };
        let mut part = vec![0.0f32; 50 * size[1] * size[2]];
        blocks.read_block(&block, SamplesMut::Float32(&mut part), &Progress::silent()).unwrap();
        let own = &whole.samples()[first * size[1] * size[2]..][..part.len()];
        assert!(part.iter().zip(own).all(|(a, b)| a.to_bits() == b.to_bits()), "from line {first}");
    }
}

#[test]
fn it_stops_when_cancelled() {
    let cancelled = Progress::silent();
    cancelled.cancel();
    let volume = faulted(5.0, 0.0);
    let stopped = find(&volume, &geometry(volume.size()), &cancelled);
    assert!(matches!(stopped, Err(AttributeError::Cancelled(_))));
}
