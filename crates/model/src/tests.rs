//! Regions of closed-form models, faults' tips, missing data, bad input.

use super::closed_form::{self, ModelForm, Random};
use super::*;
use glam::{DVec2, DVec3, Vec3};
use std::collections::BTreeMap;
use survey::geometry::{LineAxis, SurveyGeometry, VerticalUnit};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::progress::Progress;
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use synth::{SynthSettings, Synthetic};

/// Checks regions at random places more than `clear` voxels from any boundary; blocks may be numbered in any
/// way.
fn check_regions(name: &str, form: &ModelForm, model: &StructuralModel, at: impl Fn(DVec3) -> DVec3, clear: f64) {
    let mut random = Random(3);
    let mut block_of: BTreeMap<u32, u16> = BTreeMap::new();
    let mut tested = 0;
    for _ in 0..6000 {
        let p = random.place(form.geometry.size());
        if form.is_clear(p, clear) {
            let (layer, bits) = form.region(p);
            let found = model.region_at(at(p).as_vec3());
            assert_eq!(found.layer, layer, "{name}: layer at {p}");
            assert_eq!(*block_of.entry(bits).or_insert(found.block), found.block, "{name}: block at {p}");
            tested += 1;
        }
    }
    assert!(tested > 4000, "{name}: {tested}");
    let mut blocks: Vec<u16> = block_of.values().copied().collect();
    blocks.sort_unstable();
    blocks.dedup();
    assert_eq!(blocks.len(), model.block_count(), "{name}");
}

#[test]
fn regions_of_closed_form_models() {
    for (name, form) in closed_form::all() {
        let model = form.model();
        for note in &model.report().notes {
            println!("{name}: {note}");
        }
        check_regions(name, &form, &model, |p| p, if name.starts_with("domed") { 0.06 } else { 0.02 });
    }
}

#[test]
fn a_mirrored_and_turned_survey_over_the_same_ground_has_the_same_regions() {
    for form in [closed_form::dipping_normal(), closed_form::truncated_y()] {
        let g = &form.geometry;
        let [nx, ny, _] = g.size();
        // Inlines run along the old crosslines, and crosslines backwards.
        let turned = SurveyGeometry {
            inlines: LineAxis { first: 500, step: -2, count: ny },
            crosslines: LineAxis { first: 10, step: 3, count: nx },
            origin: g.world_from_voxel(DVec3::new(nx as f64 - 1.0, 0.0, 0.0)).truncate(),
            inline_vector: g.crossline_vector,
            crossline_vector: -g.inline_vector,
            ..g.clone()
        };
        let at = |p: DVec3| turned.voxel_from_world(g.world_from_voxel(p));
        check_regions("turned", &form, &form.in_geometry(&turned), at, 0.03);
    }
}

#[test]
fn both_sheets_agree_beyond_the_tip_of_a_dying_out_fault() {
    let form = closed_form::dying_out();
    let model = form.model();
    assert_eq!(model.block_count(), 2);
    let mut worst: (f32, f32) = (0.0, 0.0);
    for h in 0..3 {
        for i in 0..640 {
            for j in 0..20 {
                let (x, y) = (i as f32 * 0.1, 28.0 + j as f32);
                let (a, b) = (model.sheet(h, 0).z_at(x, y), model.sheet(h, 1).z_at(x, y));
                worst.0 = worst.0.max((a - b).abs());
                let truth = (form.sheet)(h, u32::from(x > 31.4), f64::from(x), f64::from(y)) as f32;
                worst.1 = worst.1.max((a - truth).abs());
            }
        }
    }
    println!("difference of both sides {}, to the truth {}", worst.0, worst.1);
    assert!(worst.0 < 0.02 && worst.1 < 0.05);
    // Beside the real part each side has its own height.
    let throw = model.sheet(1, 1).z_at(31.4, 2.0) - model.sheet(1, 0).z_at(31.4, 2.0);
    assert!((throw - 0.012 * 24.0f32.powi(2)).abs() < 0.1, "{throw}");
    assert!(model.faults().is_real(0, Vec3::new(31.0, 20.0, 40.0)));
    assert!(!model.faults().is_real(0, Vec3::new(31.0, 26.2, 40.0)));
}

#[test]
fn a_block_without_picks_is_placed_by_thickness() {
    // H2 of the block between the faults of a Y lies below the place where they meet; H0 and H1 tell where it
    // would be.
    let form = closed_form::truncated_y();
    let model = form.model();
    let block = model.block_at(Vec3::new(35.0, 24.0, 5.0));
    assert_eq!(model.own_nodes(2, block), 0);
    let placed =
        |n: &ModelNote| matches!(n, ModelNote::Placed { horizon, block: b, .. } if horizon == "H2" && *b == block);
    assert!(model.report().notes.iter().any(placed));
    let z = model.sheet(2, block).z_at(35.0, 24.0);
    let truth = (form.sheet)(2, 1, 35.0, 24.0) as f32;
    assert!((z - truth).abs() < 0.05, "{z} {truth}");
}

/// Horizons from closed forms over the survey's own traces; a NaN is a hole.
fn horizons(g: &SurveyGeometry, forms: &[&dyn Fn(f64, f64) -> f64]) -> Vec<Horizon> {
    let [nx, ny, _] = g.size();
    forms
        .iter()
        .enumerate()
        .map(|(h, f)| {
            let depth = (0..nx * ny).map(|n| g.vertical.value_at(f((n / ny) as f64, (n % ny) as f64)) as f32).collect();
            let sheet = Sheet::new(NodeGrid::of_survey(g), depth, Quality::Picked);
            Horizon::new(format!("H{h}"), vec![sheet])
        })
        .collect()
}

fn stratigraphy(contacts: &[Contact]) -> Stratigraphy {
    let named = |(h, &contact): (usize, &Contact)| StratigraphicHorizon { name: format!("H{h}"), contact };
    Stratigraphy { horizons: contacts.iter().enumerate().map(named).collect(), layer_names: Vec::new() }
}

fn build(g: &SurveyGeometry, s: &Stratigraphy, h: &[Horizon]) -> Result<StructuralModel, ModelError> {
    StructuralModel::build(g, s, h, &[], &ModelSettings::default(), &Progress::silent())
}

fn survey() -> SurveyGeometry {
    SurveyGeometry::regular([40, 50, 60], 12.5, 4.0, VerticalUnit::Milliseconds)
}

#[test]
fn no_horizons_make_one_layer() {
    let model = build(&survey(), &Stratigraphy::default(), &[]).unwrap();
    assert_eq!((model.layer_count(), model.block_count()), (1, 1));
    assert_eq!(model.region_at(Vec3::new(3.0, 4.0, 5.0)), Region { layer: 0, block: 0 });
}

#[test]
fn a_coarse_rotated_grid_is_resampled() {
    let g = survey();
    let truth = |x: f64, y: f64| 30.0 + 6.0 * (x / 15.0).sin() * (y / 18.0).cos();
    let (sin, cos) = 0.4f64.sin_cos();
    let step = 2.5 * 12.5;
    let grid = NodeGrid {
        origin: DVec2::new(100.0, -250.0),
        u_step: step * DVec2::new(cos, sin),
        v_step: step * DVec2::new(-sin, cos),
        count: [40, 40],
    };
    let depth = (0..1600)
        .map(|n| {
            let world = grid.world_at(DVec2::new((n / 40) as f64, (n % 40) as f64));
            let voxel = g.voxel_from_world(world.extend(0.0));
            g.vertical.value_at(truth(voxel.x, voxel.y)) as f32
        })
        .collect();
    let horizon = Horizon::new("H0", vec![Sheet::new(grid, depth, Quality::Picked)]);
    let model = build(&g, &stratigraphy(&[Contact::Conformable]), &[horizon]).unwrap();
    let mut worst = 0.0f64;
    for x in 12..36 {
        for y in 8..45 {
            let (x, y) = (f64::from(x) + 0.3, f64::from(y) + 0.6);
            worst = worst.max((f64::from(model.sheet(0, 0).z_at(x as f32, y as f32)) - truth(x, y)).abs());
        }
    }
    assert!(worst < 0.03, "{worst}");
}

#[test]
fn unconformity_and_lap_cut_but_do_not_bend() {
    let g = survey();
    let young = |x: f64, _: f64| 5.0 + 0.4 * x;
    let unconformity = |_: f64, _: f64| 15.0;
    let old = |x: f64, _: f64| 30.0 - 0.6 * x;
    let h = horizons(&g, &[&young, &unconformity, &old]);
    let s = stratigraphy(&[Contact::Conformable, Contact::Erosional, Contact::Conformable]);
    let model = build(&g, &s, &h).unwrap();
    assert!((model.sheet(2, 0).z_at(35.0, 9.0) - 9.0).abs() < 1e-3);
    assert!((model.horizon_z(2, 0, 35.0, 9.0) - 15.0).abs() < 1e-3);
    assert!((model.horizon_z(0, 0, 35.0, 9.0) - 15.0).abs() < 1e-3);
    let layer = |x: f32, z: f32| model.region_at(Vec3::new(x, 9.0, z)).layer;
    // Above the unconformity the eroded horizon is nothing; below it the lapping one is not.
    assert_eq!([layer(35.0, 12.0), layer(35.0, 18.0), layer(5.0, 10.0), layer(5.0, 20.0)], [3, 0, 2, 1]);
}

#[test]
fn picks_in_the_wrong_order_are_an_error_and_continued_ones_are_pulled_back() {
    let g = survey();
    let s = stratigraphy(&[Contact::Conformable; 2]);
    let crossing = horizons(&g, &[&|x, _| 10.0 + 0.8 * x, &|_, _| 30.0]);
    match build(&g, &s, &crossing).unwrap_err() {
        ModelError::CrossingHorizons { younger, older, nodes, worst, lines, .. } => {
            assert_eq!((younger.as_str(), older.as_str()), ("H0", "H1"));
            assert!(nodes > 500 && (worst - 11.2).abs() < 0.1 && (lines[0] - 40.0).abs() < 0.1);
        }
        other => panic!("{other}"),
    }
    // The same slope, but not picked where it would cross.
    let apart = horizons(&g, &[&|x, _| if x < 20.0 { 10.0 + 0.8 * x } else { f64::NAN }, &|_, _| 30.0]);
    let model = build(&g, &s, &apart).unwrap();
    assert!(model.report().notes.iter().any(|n| matches!(n, ModelNote::Clamped { worst, .. } if *worst > 5.0)));
    assert!((model.sheet(0, 0).z_at(38.0, 20.0) - 30.0).abs() < 0.01);
    assert_eq!(model.quality_at(0, 0, 38.0, 20.0), Quality::Extrapolated);
    assert_eq!(model.quality_at(0, 0, 10.0, 20.0), Quality::Picked);
}

#[test]
fn bad_input_is_named() {
    let g = survey();
    let flat = |z: f64| move |_: f64, _: f64| z;
    let one = stratigraphy(&[Contact::Conformable]);
    let empty = build(&g, &one, &horizons(&g, &[&flat(f64::NAN)])).unwrap_err();
    assert_eq!(empty, ModelError::EmptyHorizon { name: "H0".into(), outside: 0, holes: 2000 });
    // The wrong sign: far above the first sample.
    let above = build(&g, &one, &horizons(&g, &[&flat(-300.0)])).unwrap_err();
    assert_eq!(above, ModelError::EmptyHorizon { name: "H0".into(), outside: 2000, holes: 0 });
    let missing = build(&g, &one, &[]).unwrap_err();
    assert_eq!(missing, ModelError::MissingHorizon { name: "H0".into() });
    let twice: Vec<Horizon> = [20.0, 30.0].iter().map(|&z| horizons(&g, &[&flat(z)]).remove(0)).collect();
    let duplicate = ModelError::DuplicateName { what: "horizons", name: "H0".into() };
    assert_eq!(build(&g, &one, &twice).unwrap_err(), duplicate);
    let mut parallel = g.clone();
    parallel.crossline_vector = parallel.inline_vector;
    assert!(matches!(build(&parallel, &one, &[]), Err(ModelError::Geometry(_))));
    let progress = Progress::silent();
    progress.cancel();
    let h = horizons(&g, &[&flat(20.0)]);
    let cancelled = StructuralModel::build(&g, &one, &h, &[], &ModelSettings::default(), &progress);
    assert!(matches!(cancelled, Err(ModelError::Cancelled(_))));
}

#[test]
fn a_node_on_the_wrong_side_of_a_fault_is_left_out() {
    let form = closed_form::dipping_normal();
    let mut horizons = form.horizons(|_, _| 0.0);
    // Move both sheets two voxels along x, the fault stays: two nodes a line end up on the wrong side of it.
    for sheet in horizons.iter_mut().flat_map(|h| &mut h.sheets) {
        sheet.grid.origin.x += 50.0;
    }
    let model = StructuralModel::build(
        &form.geometry,
        &form.stratigraphy(),
        &horizons,
        &form.fault_inputs(),
        &ModelSettings::default(),
        &Progress::silent(),
    )
    .unwrap();
    assert!(model.report().notes.iter().any(|n| matches!(n, ModelNote::Strays { nodes, .. } if *nodes > 50)));
    let mut worst = 0.0f32;
    for h in 0..3 {
        for bits in 0..2 {
            for n in 0..64 * 48 {
                let (x, y) = ((n / 48) as f64, (n % 48) as f64);
                let z = (form.sheet)(h, bits, x - 2.0, y);
                let p = DVec3::new(x, y, z);
                if (0.0..71.0).contains(&z) && form.bits(p) == bits {
                    let block = model.block_at(p.as_vec3());
                    worst = worst.max((model.sheet(h, block).z_at(x as f32, y as f32) - z as f32).abs());
                }
            }
        }
    }
    assert!(worst < 0.02, "{worst}");
}

#[test]
fn the_synthetic_survey_is_rebuilt_from_its_interpretation() {
    let settings = SynthSettings { size: [96, 88, 96], snr: None, ..SynthSettings::default() };
    let synthetic = Synthetic::generate(&settings, &Progress::silent()).unwrap();
    let (geometry, truth) = (&synthetic.geometry, &synthetic.truth);
    let model = StructuralModel::build(
        geometry,
        &synthetic.stratigraphy,
        &synthetic.horizons,
        &synthetic.faults,
        &ModelSettings::default(),
        &Progress::silent(),
    )
    .unwrap();
    for note in &model.report().notes {
        println!("{note}");
    }
    assert_eq!(model.block_count(), truth.block_count());
    let mut random = Random(17);
    let mut block_of: BTreeMap<u16, u16> = BTreeMap::new();
    let (mut on_sheets, mut on_faults) = (Vec::new(), Vec::new());
    let mut wrong = 0;
    for _ in 0..40_000 {
        let p = random.place(geometry.size());
        let block = truth.block_at(p);
        let near_fault = (0..truth.faults.len())
            .map(|f| (truth.fault_side_m(f, p) / truth.step_m.min_element()).abs())
            .fold(f64::INFINITY, f64::min);
        // Beyond a tip the blocks' boundary is nobody's truth; layers are.
        if near_fault > 0.2 && (0..truth.faults.len()).all(|f| truth.fault_is_real(f, p)) {
            let found = model.block_at(p.as_vec3());
            assert_eq!(*block_of.entry(block).or_insert(found), found, "block at {p}");
        }
        // Boundary errors, vertical for horizons and perpendicular for faults.
        let mut near_horizon = f64::INFINITY;
        for h in 0..truth.horizons.len() {
            let z = truth.horizon_z(h, block, p.x, p.y);
            near_horizon = near_horizon.min((z - p.z).abs());
            let on = DVec3::new(p.x, p.y, z);
            if z > 0.0 && z < 95.0 && truth.block_at(on) == block && truth.exists(h, block, p.x, p.y) {
                let found = block_of.get(&block).map(|&b| model.horizon_z(h, b, p.x as f32, p.y as f32));
                on_sheets.extend(found.map(|found| (f64::from(found) - z).abs()));
            }
        }
        for f in 0..truth.faults.len() {
            let x = truth.faults[f].surface_u(p.y * truth.step_m.y, p.z * truth.step_m.z) / truth.step_m.x;
            let on = DVec3::new(x, p.y, p.z);
            if (0.0..95.0).contains(&x) {
                let side = model.faults().surfaces()[f].side(on);
                let gradient = model.faults().surfaces()[f].side_gradient(on).length();
                on_faults.push(((side / gradient).abs(), truth.fault_is_real(f, on)));
            }
        }
        if near_fault > 0.2 && near_horizon > 0.2 {
            wrong += usize::from(model.region_at(p.as_vec3()).layer != truth.layer_at(p));
        }
    }
    let percentile = |values: &mut Vec<f64>, share: f64| {
        values.sort_by(f64::total_cmp);
        values[((values.len() - 1) as f64 * share) as usize]
    };
    let mut real: Vec<f64> = on_faults.iter().filter(|f| f.1).map(|f| f.0).collect();
    let mut tip: Vec<f64> = on_faults.iter().filter(|f| !f.1).map(|f| f.0).collect();
    for (name, values) in [("horizons", &mut on_sheets), ("faults", &mut real), ("faults beyond the tip", &mut tip)] {
        let [median, most, max] = [0.5, 0.99, 1.0].map(|s| percentile(values, s));
        println!("{name}: {} places, error median {median:.4}, 99 % {most:.4}, max {max:.4} voxels", values.len());
    }
    println!("wrong layers away from boundaries: {wrong} of 40000");
    assert!(percentile(&mut on_sheets, 0.99) < 0.05 && percentile(&mut real, 1.0) < 0.05);
    assert!(wrong < 40, "{wrong}");
}

#[test]
fn thread_count_does_not_matter() {
    let form = closed_form::truncated_y();
    let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| form.model());
    assert!(with(1) == with(3));
}

#[test]
fn a_trace_has_the_regions_of_its_points() {
    let form = closed_form::truncated_y();
    let model = form.model();
    let mut random = Random(11);
    let depths: Vec<f32> = (0..60).map(|n| 0.7 * n as f32).collect();
    for _ in 0..200 {
        let at = random.place(form.geometry.size()).as_vec3();
        let mut regions = Vec::new();
        model.regions_down(at.x, at.y, &depths, |n, region| {
            assert_eq!(n, regions.len());
            regions.push(region);
        });
        let expected: Vec<Region> = depths.iter().map(|&z| model.region_at(Vec3::new(at.x, at.y, z))).collect();
        assert_eq!(regions, expected, "at {at}");
    }
}

/// A thousand horizons, a twentieth of a sample apart, each lower by a sample on the far side: the layer of a place and the
/// areas of a section are counted, and one horizon more than there may be is refused.
#[test]
fn a_thousand_horizons_are_told_apart() {
    let geometry = SurveyGeometry::regular([6, 6, 61], 10.0, 10.0, VerticalUnit::Metres);
    let grid = NodeGrid::of_survey(&geometry);
    let built = |count: usize| {
        let horizon = |n: usize| StratigraphicHorizon { name: format!("H{n}"), contact: Contact::Conformable };
        let stratigraphy = Stratigraphy { horizons: (0..count).map(horizon).collect(), layer_names: Vec::new() };
        let depth = |n: usize, x: usize| 10.0 * (5.0 + 0.05 * n as f32 + 0.2 * x as f32);
        let sheet = |n: usize| Sheet::new(grid, (0..36).map(|node| depth(n, node / 6)).collect(), Quality::Picked);
        let horizons: Vec<Horizon> =
            (0..count).map(|n| Horizon::new(format!("H{n}").as_str(), vec![sheet(n)])).collect();
        let settings = ModelSettings::default();
        StructuralModel::build(&geometry, &stratigraphy, &horizons, &[], &settings, &Progress::silent())
    };
    let model = built(1000).unwrap();
    for (x, z) in [(0.0, 2.0), (0.0, 5.01), (2.5, 20.0), (4.0, 33.33), (5.0, 56.1), (3.0, 58.0)] {
        let passed = (0..1000).filter(|n| f64::from(z) >= 5.0 + 0.05 * f64::from(*n) + 0.2 * f64::from(x)).count();
        assert_eq!(usize::from(model.region_at(Vec3::new(x, 2.0, z)).layer), 1000 - passed, "{x}, {z}");
    }
    let plane = section::SectionPlane::crossline(2.5, DVec3::ZERO, DVec3::new(5.0, 5.0, 60.0));
    let section = section::Section::new(&model, &plane);
    assert_eq!(section.layers.len(), 1001);
    let area = |rings: &[Vec<DVec2>]| {
        let ring = &rings[0];
        let twice: f64 = (0..ring.len()).map(|n| ring[n].perp_dot(ring[(n + 1) % ring.len()])).sum();
        0.5 * twice.abs()
    };
    let between = section.layers.iter().filter(|layer| (1..1000).contains(&layer.layer));
    assert!(
        between.clone().count() == 999 && between.into_iter().all(|layer| (area(&layer.rings) - 0.25).abs() < 1e-3)
    );
    assert!(matches!(built(1025), Err(ModelError::TooMany { found: 1025, limit: 1024, .. })));
}
