//! Properties for any model: the same bytes on any number of threads, cancellation, no NaN, errors for bad
//! input.

mod closed_form;

use closed_form::ClosedForm;
use glam::{DMat3, Vec3};
use param::{KDefinition, ParamError, ParamSettings, Parameterization, Region};
use std::sync::Arc;
use survey::Progress;
use survey::progress::ProgressSink;

/// Two blocks of sheets that are rough at the voxel scale and cross each other: worse than any
/// interpretation.
fn rough() -> ClosedForm {
    let noise = |x: f64, y: f64, h: usize| {
        let seed = (x * 12.9898 + y * 78.233 + h as f64 * 37.719).sin() * 43758.5453;
        3.0 * (seed - seed.floor() - 0.5)
    };
    ClosedForm::faulted(
        [40, 36, 48],
        3,
        2,
        move |h, block, x, y| {
            14.0 + 10.0 * h as f64 + 9.0 * (0.2 * x + 0.9 * h as f64).sin() + 4.0 * f64::from(block) + noise(x, y, h)
        },
        |p| u16::from(p.x + 0.5 * p.z > 36.0),
    )
}

#[test]
fn one_thread_and_five_give_the_same_bytes() {
    let model = rough();
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap())
    };
    let (one, many) = (with_threads(1), with_threads(5));
    for (a, b) in one.grids.iter().zip(&many.grids) {
        assert!(a.offsets.iter().flatten().map(|v| v.to_bits()).eq(b.offsets.iter().flatten().map(|v| v.to_bits())));
        assert_eq!(a.creases, b.creases);
    }
}

#[test]
fn nothing_is_undefined_on_rough_crossing_sheets() {
    for definition in [KDefinition::Flow, KDefinition::DistanceRatio] {
        finite_on_rough_crossing_sheets(definition);
    }
}

fn finite_on_rough_crossing_sheets(definition: KDefinition) {
    let model = rough();
    let settings = ParamSettings { definitions: vec![definition; 4], ..Default::default() };
    let param = Parameterization::compute(&model, &settings, &Progress::silent()).unwrap();
    let volumes = param.voxel_volumes(&model, [40, 36, 48], &Progress::silent()).unwrap();
    for volume in [&volumes.i, &volumes.j, &volumes.k] {
        assert!(volume.samples().iter().all(|value| value.is_finite()));
    }
    assert!(volumes.k.samples().iter().all(|k| (-0.2..=1.2).contains(k)));
    let nodes = param.grids.iter().flat_map(|grid| (0..grid.offsets.len()).map(|node| grid.is_crease(node)));
    let creases = nodes.filter(|&crease| crease).count();
    match definition {
        KDefinition::DistanceRatio => assert!(creases > 1000, "creases are reported"),
        _ => assert_eq!(creases, 0, "a flow has none"),
    }
}

#[test]
fn points_outside_the_volume_have_an_answer() {
    let model = rough();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap();
    for p in [Vec3::new(-30.0, 5.0, 20.0), Vec3::new(90.0, 90.0, 90.0), Vec3::new(10.0, 10.0, -50.0)] {
        for layer in 0..4 {
            for block in 0..2 {
                let (found, jacobian) = param.lookup_in(&model, p, Region { layer, block });
                assert!(found.i.is_finite() && found.j.is_finite() && found.k.is_finite(), "{found:?} at {p}");
                assert!(jacobian.as_flattened().iter().all(|value| value.is_finite()));
            }
        }
    }
}

/// Cancels when the stage of this name begins.
struct CancelAt(std::sync::OnceLock<Progress>, &'static str);

impl ProgressSink for CancelAt {
    fn begin(&self, stage: &str, _total: u64) {
        if stage == self.1
            && let Some(progress) = self.0.get()
        {
            progress.cancel();
        }
    }
    fn advance(&self, _done: u64) {}
    fn warn(&self, _note: &survey::Note) {}
}

#[test]
fn every_stage_can_be_cancelled() {
    let model = rough();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &Progress::silent()).unwrap();
    for stage in ["finding the regions", "parameterizing", "sampling i, j, k"] {
        let sink = Arc::new(CancelAt(std::sync::OnceLock::new(), stage));
        let progress = Progress::new(sink.clone());
        sink.0.set(progress.clone()).ok();
        let outcome = if stage == "sampling i, j, k" {
            param.voxel_volumes(&model, param.size, &progress).err()
        } else {
            Parameterization::compute(&model, &ParamSettings::default(), &progress).err()
        };
        assert!(matches!(outcome, Some(ParamError::Cancelled(_))), "{stage}: {outcome:?}");
    }
}

#[test]
fn settings_and_models_out_of_range_are_refused() {
    let model = rough();
    let compute = |model: &ClosedForm, settings: ParamSettings| {
        Parameterization::compute(model, &settings, &Progress::silent()).err()
    };
    let settings = ParamSettings { level_spacing: 0.0, ..Default::default() };
    assert!(matches!(compute(&model, settings), Some(ParamError::Setting { setting: "level_spacing", .. })));
    let settings = ParamSettings { exaggeration: f64::NAN, ..Default::default() };
    assert!(matches!(compute(&model, settings), Some(ParamError::Setting { setting: "exaggeration", .. })));
    let settings = ParamSettings { definitions: vec![KDefinition::DistanceRatio; 5], ..Default::default() };
    assert!(matches!(compute(&model, settings), Some(ParamError::NoSuchLayer { layer: 4, layers: 4 })));
    let degenerate = rough().with_metric(DMat3::ZERO);
    assert!(matches!(compute(&degenerate, ParamSettings::default()), Some(ParamError::DegenerateMetric { .. })));
    let empty = ClosedForm::new([4, 0, 4], 0, |_, _, _| 0.0);
    assert!(matches!(compute(&empty, ParamSettings::default()), Some(ParamError::Empty { .. })));
}
