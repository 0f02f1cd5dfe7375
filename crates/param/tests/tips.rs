//! Beyond the tip of a fault rock is not broken, and neither are patterns.

use glam::Vec3;
use model::{ModelSettings, StructuralModel};
use param::{KDefinition, ParamSettings, Parameterization, Region};
use survey::horizon::{NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Horizon, Progress, SurveyGeometry, VerticalUnit};
use synth::elliptic::EllipticFault;

const SIZE: [usize; 3] = [80, 90, 70];
const FAULT: EllipticFault = EllipticFault::EXAMPLE;
/// Heights of the horizons at the middle of the survey, without the fault.
const LEVELS: [f64; 3] = [20.0, 34.0, 50.0];

/// Dipping horizons with the roughness of picks.
fn model() -> StructuralModel {
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    let grid = NodeGrid::of_survey(&geometry);
    let horizon = |(h, &level): (usize, &f64)| {
        let node = |n: usize| {
            let (x, y) = ((n / SIZE[1]) as f64, (n % SIZE[1]) as f64);
            let dip = 0.15 * (x - 40.0) - 0.1 * (y - 45.0);
            let rough = 0.3 * ((1.7 * x + h as f64).sin() + (1.3 * y).cos());
            (10.0 * (FAULT.height(level, x > FAULT.x_at(level), x, y) + dip + rough)) as f32
        };
        let depth = (0..SIZE[0] * SIZE[1]).map(node).collect();
        Horizon::new(format!("H{h}"), vec![Sheet::new(grid, depth, Quality::Picked)])
    };
    let horizons: Vec<Horizon> = LEVELS.iter().enumerate().map(horizon).collect();
    let named = |h: &Horizon| StratigraphicHorizon { name: h.name.clone(), contact: Contact::Conformable };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let fault = FAULT.drawn(&geometry, &[25.0, 35.0, 45.0, 55.0, 65.0], 9);
    let (settings, quiet) = (ModelSettings::default(), Progress::silent());
    StructuralModel::build(&geometry, &stratigraphy, &horizons, &[fault], &settings, &quiet).unwrap()
}

/// How far the patterns of both blocks are apart at a place on the fault or its continuation: (i, j, k) in voxels along each
/// axis. `None` where another layer begins.
fn apart(model: &StructuralModel, param: &Parameterization, y: f32, z: f32) -> Option<Vec3> {
    let p = Vec3::new(FAULT.x_at(f64::from(z)) as f32, y, z);
    let [a, b] = [-0.05, 0.05].map(|off| model.region_at(p + off * Vec3::X));
    if a.block == b.block || a.layer != b.layer {
        return None;
    }
    let of = |region: Region| param.lookup_in(model, p, region);
    let ((a, rates), (b, _)) = (of(a), of(b));
    let last = SIZE.map(|count| count as f32 - 1.0);
    Some(Vec3::new((a.i - b.i) * last[0], (a.j - b.j) * last[1], (a.k - b.k) / rates[2][2]).abs())
}

#[test]
fn patterns_go_on_beyond_the_tip_and_break_at_the_fault() {
    let model = model();
    use KDefinition::{Flow, Harmonic, ParallelToBottom, ParallelToTop, Proportional};
    for definition in [Flow, Harmonic, Proportional, ParallelToBottom, ParallelToTop] {
        let settings = ParamSettings {
            definitions: vec![definition; model.layer_count()],
            flow_wave_m: 300.0,
            ..ParamSettings::default()
        };
        let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
        let places = (2..SIZE[1] - 2).flat_map(|y| (2..SIZE[2] - 2).map(move |z| (y as f32, z as f32)));
        let radius = |(y, z): (f32, f32)| FAULT.radius(f64::from(y), f64::from(z));
        let worst = |within: std::ops::Range<f64>| {
            let places = places.clone().filter(|&at| within.contains(&radius(at)));
            places.filter_map(|(y, z)| apart(&model, &param, y, z)).fold(Vec3::ZERO, Vec3::max)
        };
        let beyond = worst(1.02..9.0);
        assert!(beyond.max_element() < 0.1, "{definition:?}: {beyond} voxels beyond the tip");
        let inside = worst(0.0..0.5);
        assert!(inside.z > 5.0, "{definition:?}: {inside} voxels at a throw of 8");
        let [to_i, to_j] = off_perpendicular(&model, &param);
        let most = if matches!(definition, ParallelToBottom | ParallelToTop) { 1.4 } else { 0.7 };
        assert!(to_i < most && to_j < most, "{definition:?}: {to_i} and {to_j} degrees beside the tip");
    }
}

/// Within a few columns of where the fault begins or ends: degrees off 90 of ∇k to ∇i and to ∇j, of which 95 % are less.
fn off_perpendicular(model: &StructuralModel, param: &Parameterization) -> [f32; 2] {
    let voxel_m = Vec3::new(25.0, 25.0, 10.0);
    let places = (4..SIZE[0] - 4).flat_map(|x| (4..SIZE[1] - 4).map(move |y| (x as f32, y as f32)));
    let places = places.flat_map(|(x, y)| (4..SIZE[2] - 4).step_by(3).map(move |z| Vec3::new(x, y, z as f32 + 0.3)));
    let is_beside = |p: Vec3| {
        let from_fault = (f64::from(p.x) - FAULT.x_at(f64::from(p.z))).abs();
        from_fault < 10.0 && (0.7..1.4).contains(&FAULT.radius(f64::from(p.y), f64::from(p.z)))
    };
    let angles = places.filter(|&p| is_beside(p)).filter_map(|p| {
        let region = model.region_at(p);
        let around = Vec3::AXES.into_iter().flat_map(|axis| [p + 0.5 * axis, p - 0.5 * axis]);
        if around.into_iter().any(|q| model.region_at(q) != region) {
            return None;
        }
        let flat = |p: Vec3| {
            let (flat, _) = param.lookup_in(model, p, region);
            Vec3::new(flat.i, flat.j, flat.k)
        };
        let along = Vec3::AXES.map(|axis| flat(p + 0.5 * axis) - flat(p - 0.5 * axis));
        let gradient = |n: usize| Vec3::new(along[0][n], along[1][n], along[2][n]) / voxel_m;
        Some([0, 1].map(|n| (gradient(n).angle_between(gradient(2)).to_degrees() - 90.0).abs()))
    });
    let angles: Vec<[f32; 2]> = angles.collect();
    assert!(angles.len() > 5000, "{} places", angles.len());
    [0, 1].map(|n: usize| {
        let mut of: Vec<f32> = angles.iter().map(|both| both[n]).collect();
        of.sort_by(f32::total_cmp);
        of[of.len() * 95 / 100]
    })
}
