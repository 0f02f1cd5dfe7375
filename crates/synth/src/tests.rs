//! Closed-form checks of the synthetic survey.

use super::*;

/// Small enough for tests, large enough for everything to be there.
fn small(seed: u64) -> SynthSettings {
    SynthSettings { size: [72, 64, 96], seed, ..SynthSettings::default() }
}

fn noise_free(seed: u64) -> Synthetic {
    let settings = SynthSettings { snr: None, ..small(seed) };
    Synthetic::generate(&settings, &Progress::silent()).unwrap()
}

/// Horizon, block, x, y of all nodes at which a named horizon exists.
fn nodes(truth: &SynthTruth) -> Vec<(usize, u16, f64, f64)> {
    let mut nodes = Vec::new();
    for horizon in 0..truth.horizons.len() {
        for block in 0..truth.block_count() as u16 {
            for n in 0..truth.size[0] * truth.size[1] {
                let (x, y) = ((n / truth.size[1]) as f64, (n % truth.size[1]) as f64);
                if truth.exists(horizon, block, x, y) {
                    nodes.push((horizon, block, x, y));
                }
            }
        }
    }
    nodes
}

/// Depth of the extremum of a parabola through the sample nearest to `z` and its neighbours, and its height.
fn extremum_near(trace: &[f32], z: f64) -> Option<(f64, f64)> {
    let n = z.round() as usize;
    let start = n.checked_sub(1)?;
    let around: Vec<f64> = trace.get(start..start + 3)?.iter().map(|&v| f64::from(v)).collect();
    let curvature = around[0] - 2.0 * around[1] + around[2];
    let offset = 0.5 * (around[0] - around[2]) / curvature;
    Some((n as f64 + offset, around[1]))
}

#[test]
fn isolated_reflectors_are_extrema_at_their_true_depth_with_the_sign_of_their_reflectivity() {
    let survey = noise_free(3);
    let wavelength = survey.truth.wavelength_m / survey.truth.step_m.z;
    let (mut checked, mut worst) = (0, 0.0f64);
    for x in 0..survey.truth.size[0] {
        for y in 0..survey.truth.size[1] {
            let events = survey.truth.reflectors(x as f64, y as f64);
            for (n, &(z, reflectivity)) in events.iter().enumerate() {
                let gap = |other: Option<&(f64, f64)>| other.map_or(f64::INFINITY, |o| (o.0 - z).abs());
                let nearest = gap(n.checked_sub(1).and_then(|n| events.get(n))).min(gap(events.get(n + 1)));
                if nearest < 0.95 * wavelength || z < 2.0 || z > survey.truth.size[2] as f64 - 3.0 {
                    continue;
                }
                let (found, height) = extremum_near(survey.seismic.trace(x, y), z).unwrap();
                assert!(height * reflectivity > 0.0);
                worst = worst.max((found - z).abs());
                checked += 1;
            }
        }
    }
    assert!(checked > 10_000, "only {checked} isolated reflectors");
    // A parabola through samples an eighth of a wavelength apart is itself off by a few hundredths.
    assert!(worst < 0.06, "an extremum is {worst} samples from the truth");
}

#[test]
fn a_nodes_depth_is_where_layers_and_reflectors_are() {
    for seed in [1, 2] {
        let truth = design::design(&small(seed)).unwrap();
        let all = nodes(&truth);
        for &(horizon, block, x, y) in all.iter().step_by(7) {
            let z = truth.sheet_z(horizon, block, x, y);
            assert_eq!(truth.horizon_z(horizon, block, x, y), z);
            let layer = (truth.layer_count() - 1 - horizon) as u16;
            let at = |dz: f64| DVec3::new(x, y, z + dz);
            if truth.block_at(at(-1e-6)) == block && truth.block_at(at(1e-6)) == block {
                assert_eq!(truth.layer_at(at(-1e-6)), layer, "above {horizon}");
                assert!(truth.layer_at(at(1e-6)) < layer, "below {horizon}");
            }
            assert!(truth.reflectors(x, y).iter().any(|event| (event.0 - z).abs() < 1e-9));
        }
    }
}

#[test]
fn restoration_finds_the_stratigraphic_depth_of_every_node() {
    let truth = design::design(&small(5)).unwrap();
    for &(horizon, block, x, y) in nodes(&truth).iter().step_by(11) {
        // The unconformity itself belongs to either side; the others to their own beds.
        let p = DVec3::new(x, y, truth.sheet_z(horizon, block, x, y));
        if horizon != truth.unconformity && truth.block_at(p) == block {
            let (sequence, strat_m) = truth.restored(p);
            assert_eq!(sequence, truth.horizons[horizon].sequence);
            assert!((strat_m - truth.horizons[horizon].strat_m).abs() < 1e-6);
        }
    }
}

#[test]
fn dips_throws_erosion_and_spacing_are_as_promised_at_several_sizes_and_seeds() {
    for (size, seed) in [
        ([72, 64, 96], 1),
        ([48, 40, 48], 2),
        ([64, 64, 200], 3),
        ([160, 90, 64], 4),
        ([72, 64, 96], 5),
        ([72, 64, 96], 6),
    ] {
        let truth = design::design(&SynthSettings { size, seed, ..SynthSettings::default() }).unwrap();
        let all = nodes(&truth);
        let dip = |&(h, b, x, y): &(usize, u16, f64, f64)| truth.slope(h, b, x, y).length().atan().to_degrees();
        let steepest = all.iter().map(dip).fold(0.0, f64::max);
        assert!((35.0..52.0).contains(&steepest), "{size:?}: {steepest}°");

        let depth_m = (size[2] - 1) as f64 * truth.step_m.z;
        for (fault, sign) in [(0, 1.0), (1, 1.0), (2, -1.0)] {
            let throws = (0..size[0] * size[1])
                .map(|n| sign * truth.throw_m(fault, (n / size[1]) as f64, (n % size[1]) as f64) / depth_m);
            let largest = throws.fold(0.0, f64::max);
            assert!((0.05..=0.08).contains(&largest), "{size:?}: fault {fault} throws {largest} of the depth");
        }
        for (h, horizon) in truth.horizons.iter().enumerate() {
            for block in 0..truth.block_count() as u16 {
                assert!(all.iter().any(|n| n.0 == h && n.1 == block), "{size:?}: no {} in {block}", horizon.name);
            }
        }
        let eroded = |h: usize| {
            let lattice = (0..size[0] * size[1]).map(|n| ((n / size[1]) as f64, (n % size[1]) as f64));
            lattice.filter(|&(x, y)| truth.horizon_z(h, 0, x, y) > truth.sheet_z(h, 0, x, y)).count()
        };
        assert!(eroded(3) > 0, "{size:?}: nothing of Charlie is eroded");
        assert_eq!(eroded(1), 0);
        for column in [&truth.young_column, &truth.old_column] {
            let beds = if std::ptr::eq(column, &truth.young_column) { &truth.young_beds } else { &truth.old_beds };
            let bound = beds.thickening.bound();
            for pair in column.reflectors_m.windows(2) {
                let spacing = (pair[1] - pair[0]) / truth.wavelength_m;
                assert!(spacing * (1.0 - bound) >= 1.0 && spacing * (1.0 + bound) <= 2.0, "{spacing} ± {bound}");
            }
        }
    }
}

#[test]
fn faults_do_not_meet_inside_the_volume_and_leave_through_top_and_bottom() {
    for size in [[72, 64, 96], [48, 48, 300], [200, 60, 48]] {
        let truth = design::design(&SynthSettings { size, ..SynthSettings::default() }).unwrap();
        let extent = DVec3::from_array(size.map(|n| n as f64 - 1.0)) * truth.step_m;
        for step in 0..=400 {
            let (v, depth) = (extent.y * f64::from(step % 20) / 19.0, extent.z * f64::from(step / 20) / 20.0);
            let at: Vec<f64> = truth.faults.iter().map(|fault| fault.surface_u(v, depth)).collect();
            assert!(at[0] > 0.0 && at[2] < extent.x, "{size:?}: {at:?} leaves 0 … {}", extent.x);
            assert!(at[1] - at[0] > 0.05 * extent.x && at[2] - at[1] > 0.05 * extent.x, "{size:?}: {at:?}");
        }
    }
}

#[test]
fn the_dying_fault_has_no_throw_and_no_triangles_beyond_its_tip() {
    let survey = noise_free(1);
    let (truth, fault) = (&survey.truth, &survey.truth.faults[1]);
    let tip_y = fault.tip.unwrap().end_m / truth.step_m.y;
    assert!(tip_y > 0.3 * truth.size[1] as f64 && tip_y < 0.9 * truth.size[1] as f64);
    for y in [tip_y, tip_y + 0.5, (truth.size[1] - 1) as f64] {
        for x in 0..truth.size[0] {
            assert_eq!(truth.throw_m(1, x as f64, y), 0.0);
            for horizon in 0..truth.horizons.len() {
                let step = |block| truth.sheet_z(horizon, block, x as f64, y);
                assert_eq!(step(1), step(2), "a horizon is whole beyond the tip");
            }
        }
    }
    let last_y = |f: &Fault| {
        f.mesh.vertices.iter().map(|&v| survey.geometry.voxel_from_world(v).y).fold(f64::NEG_INFINITY, f64::max)
    };
    assert!((last_y(&survey.faults[1]) - tip_y).abs() < 1e-6);
    for f in [0, 2] {
        assert!((last_y(&survey.faults[f]) - (truth.size[1] - 1) as f64).abs() < 1e-6);
    }
}

#[test]
fn fault_meshes_lie_on_the_true_surfaces_inside_the_volume() {
    let survey = noise_free(2);
    let size = DVec3::from_array(survey.truth.size.map(|n| n as f64 - 1.0));
    for (index, fault) in survey.faults.iter().enumerate() {
        for triangle in 0..fault.mesh.triangles.len() {
            let corners = fault.mesh.corners(triangle).map(|c| survey.geometry.voxel_from_world(c));
            let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
            assert!(centre.cmpge(DVec3::splat(-1e-6)).all() && centre.cmple(size + 1e-6).all());
            assert!(corners.iter().all(|&c| survey.truth.fault_side_m(index, c).abs() < 1e-6));
            assert!(survey.truth.fault_side_m(index, centre).abs() < 0.15, "a chord is far from the surface");
        }
    }
}

#[test]
fn the_reverse_fault_has_two_depths_over_one_trace_and_the_normal_fault_a_gap() {
    let survey = noise_free(1);
    let (mut both, mut gaps) = (0, 0);
    for horizon in &survey.horizons[..3] {
        assert_eq!(horizon.sheets.len(), 4);
        for node in 0..horizon.sheets[0].depth.len() {
            let here = |block: usize| horizon.sheets[block].depth[node].is_finite();
            both += usize::from(here(2) && here(3));
            gaps += usize::from((0..4).all(|block| !here(block)));
            assert!(!(here(0) && here(1)), "a normal fault doubles nothing");
        }
    }
    assert!(both > 50, "only {both} traces with two depths");
    assert!(gaps > 20, "only {gaps} traces in the gap of a normal fault");
}

#[test]
fn the_measured_signal_to_noise_ratio_is_the_one_asked_for() {
    let rms = |values: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut count) = (0.0, 0.0);
        for value in values {
            sum += value * value;
            count += 1.0;
        }
        f64::sqrt(sum / count)
    };
    let clean = noise_free(1);
    for snr in [1.0, 3.0] {
        let settings = SynthSettings { snr: Some(snr), ..small(1) };
        let noisy = Synthetic::generate(&settings, &Progress::silent()).unwrap();
        let signal = rms(&mut clean.seismic.samples().iter().map(|&v| f64::from(v)));
        let noise: Vec<f64> =
            noisy.seismic.samples().iter().zip(clean.seismic.samples()).map(|(n, c)| f64::from(n - c)).collect();
        let measured = signal / rms(&mut noise.iter().copied());
        assert!((measured / snr - 1.0).abs() < 0.02, "{measured} instead of {snr}");

        // Neighbouring traces are alike (lateral smoothing), samples half a wavelength apart opposed (band
        // limit).
        let nz = settings.size[2];
        let product = |lag: usize| noise.iter().zip(&noise[lag..]).map(|(a, b)| a * b).sum::<f64>();
        let correlation = |lag: usize| product(lag) / product(0);
        assert!(correlation(nz) > 0.75, "next crossline: {}", correlation(nz));
        assert!(correlation(nz * settings.size[1]) > 0.75, "next inline");
        assert!(correlation(4) < -0.3, "half a wavelength: {}", correlation(4));
        assert!(correlation(24).abs() < 0.1, "three wavelengths: {}", correlation(24));
    }
}

#[test]
fn the_same_bytes_on_one_thread_and_on_many() {
    let make = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Synthetic::generate(&small(9), &Progress::silent()).unwrap())
    };
    let (one, many) = (make(1), make(5));
    let bits = |v: &Volume<f32>| v.samples().iter().map(|s| s.to_bits()).collect::<Vec<_>>();
    assert!(bits(&one.seismic) == bits(&many.seismic));
    assert!(bits(&one.attribute.volume) == bits(&many.attribute.volume));
    assert_eq!(one.truth, many.truth);
    assert!(one.seismic != Synthetic::generate(&small(10), &Progress::silent()).unwrap().seismic);
}

#[test]
fn the_attribute_lies_where_it_says_and_is_the_true_impedance() {
    let survey = noise_free(1);
    let (attribute, truth) = (&survey.attribute, &survey.truth);
    let size = attribute.volume.size();
    assert!((0..3).all(|axis| size[axis] != truth.size[axis]));
    attribute.geometry.validate().unwrap();
    let last = DVec3::from_array(size.map(|n| n as f64 - 1.0));
    let world = attribute.geometry.world_from_voxel(last);
    assert!((survey.geometry.voxel_from_world(world) - (attribute.origin + attribute.extent)).length() < 1e-6);
    assert!((attribute.origin + attribute.extent).cmplt(DVec3::from_array(truth.size.map(|n| n as f64))).all());
    for axis in [&attribute.geometry.inlines, &attribute.geometry.crosslines] {
        assert_eq!(axis.step, 2);
    }
    // In the middle of a thick bed the average over a sample is the bed's impedance.
    let (x, y, step) = (size[0] / 2, size[1] / 2, attribute.extent / last);
    let mut same = 0;
    for z in 0..size[2] {
        let p = attribute.origin + DVec3::new(x as f64, y as f64, z as f64) * step;
        let value = f64::from(attribute.volume.at(x, y, z));
        assert!((4e6..1e7).contains(&value), "{value}");
        same += usize::from((value / truth.impedance_at(p) - 1.0).abs() < 1e-6);
    }
    assert!(same > size[2] / 2);
}

#[test]
fn time_and_depth_surveys_are_alike() {
    let settings = SynthSettings { vertical: VerticalUnit::Milliseconds, snr: None, ..small(1) };
    let time = Synthetic::generate(&settings, &Progress::silent()).unwrap();
    assert_eq!(time.geometry.vertical.unit, VerticalUnit::Milliseconds);
    assert!(time.seismic == noise_free(1).seismic, "10 ms are 10 m at 2000 m/s");
}

#[test]
fn what_cannot_be_made_is_refused() {
    let refused = |settings: SynthSettings| Synthetic::generate(&settings, &Progress::silent()).unwrap_err();
    assert!(matches!(refused(SynthSettings { size: [10, 64, 96], ..small(1) }), SynthError::TooSmall { .. }));
    assert!(matches!(refused(SynthSettings { snr: Some(0.0), ..small(1) }), SynthError::NotPositive { .. }));
    assert!(matches!(refused(SynthSettings { interval: f64::NAN, ..small(1) }), SynthError::NotPositive { .. }));
    let progress = Progress::silent();
    progress.cancel();
    assert_eq!(Synthetic::generate(&small(1), &progress), Err(SynthError::Cancelled(Cancelled)));
}
