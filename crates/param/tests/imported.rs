//! A parameterization taken from the arrays of another program gives what those arrays say, at samples and between them.

use glam::Vec3;
use model::{ModelSettings, StructuralModel};
use param::{ParamError, ParamSettings, Parameterization, VoxelParameterization};
use survey::{Progress, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;

const SIZE: [usize; 3] = [40, 30, 60];

fn faulted() -> StructuralModel {
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dipping(&geometry, &[18.0, 38.0], 12.0, 30.0).with_fault(60.0, 6.0);
    let (order, settings) = (&closed.stratigraphy, &ModelSettings::default());
    StructuralModel::build(&geometry, order, &closed.horizons, &closed.faults, settings, &Progress::silent()).unwrap()
}

fn places() -> impl Iterator<Item = Vec3> {
    let shares = |n: usize| [0.618_034, 0.754_878, 0.569_84].map(|step: f64| (n as f64 * step).fract());
    (0..4000)
        .map(move |n| Vec3::from_array(std::array::from_fn(|axis| (shares(n)[axis] * (SIZE[axis] - 1) as f64) as f32)))
}

/// Median and 99 % of the largest difference of i·(Nx−1), j·(Ny−1) and 10 k over places in the volume.
fn off(model: &StructuralModel, a: &Parameterization, b: impl Fn(Vec3) -> [f32; 3]) -> [f32; 2] {
    let mut errors: Vec<f32> = places()
        .map(|p| {
            let (flat, other) = (a.lookup(model, p), b(p));
            let [di, dj, dk] = [flat.i - other[0], flat.j - other[1], flat.k - other[2]];
            (di * (SIZE[0] - 1) as f32).abs().max((dj * (SIZE[1] - 1) as f32).abs()).max(10.0 * dk.abs())
        })
        .collect();
    errors.sort_by(f32::total_cmp);
    [errors[errors.len() / 2], errors[errors.len() * 99 / 100]]
}

#[test]
fn our_own_arrays_come_back_as_the_same_map() {
    let (model, quiet) = (faulted(), Progress::silent());
    let own = Parameterization::compute(&model, &ParamSettings::default(), &quiet).unwrap();
    let arrays = own.voxel_volumes(&model, SIZE, &quiet).unwrap();
    let (taken, facts) = Parameterization::of_volumes(&model, &arrays, &ParamSettings::default(), &quiet).unwrap();
    assert!(facts.agreeing > 0.999_9 && facts.covered > 0.5, "{facts:?}");
    let [median, most] = off(&model, &taken, |p| {
        let flat = own.lookup(&model, p);
        [flat.i, flat.j, flat.k]
    });
    assert!(median < 0.02 && most < 0.2, "{median} {most}");
}

/// What a program with another idea of flat space could write: sheared, k squared.
fn sheared(model: &StructuralModel, size: [usize; 3]) -> VoxelParameterization {
    let quiet = Progress::silent();
    let settings = ParamSettings { definitions: vec![param::KDefinition::Proportional; 3], ..ParamSettings::default() };
    let own = Parameterization::compute(model, &settings, &quiet).unwrap();
    let mut arrays = own.voxel_volumes(model, size, &quiet).unwrap();
    let k = arrays.k.samples().to_vec();
    arrays.i.samples_mut().iter_mut().zip(&k).for_each(|(i, k)| *i += 0.2 * k);
    arrays.k.samples_mut().iter_mut().for_each(|k| *k *= *k);
    arrays
}

#[test]
fn another_map_is_taken_as_it_is_also_from_a_coarser_lattice() {
    let (model, quiet) = (faulted(), Progress::silent());
    let settings = ParamSettings { definitions: vec![param::KDefinition::Proportional; 3], ..ParamSettings::default() };
    let own = Parameterization::compute(&model, &settings, &quiet).unwrap();
    let wanted = |p: Vec3| {
        let flat = own.lookup(&model, p);
        [flat.i + 0.2 * flat.k, flat.j, flat.k * flat.k]
    };
    for (size, least) in [(SIZE, 0.25), ([20, 30, 40], 0.6)] {
        let arrays = sheared(&model, size);
        let (taken, _) = Parameterization::of_volumes(&model, &arrays, &ParamSettings::default(), &quiet).unwrap();
        let [median, most] = off(&model, &taken, wanted);
        assert!(median < 0.03 && most < least, "{size:?}: {median} {most}");
    }
}

#[test]
fn what_is_of_other_horizons_or_has_a_gap_is_refused() {
    let (model, quiet) = (faulted(), Progress::silent());
    let arrays = sheared(&model, SIZE);
    let taken = |arrays: &VoxelParameterization| {
        Parameterization::of_volumes(&model, arrays, &ParamSettings::default(), &quiet).map(|_| ()).unwrap_err()
    };
    let mut upside_down = arrays.clone();
    upside_down.layer.samples_mut().iter_mut().for_each(|layer| *layer = 2 - *layer);
    assert!(matches!(taken(&upside_down), ParamError::OtherLayers { share, layers: 3 } if share > 0.3));
    let mut gap = arrays.clone();
    let of_middle: Vec<bool> = gap.layer.samples().iter().map(|layer| *layer == 1).collect();
    gap.k.samples_mut().iter_mut().zip(of_middle).for_each(|(k, middle)| *k = if middle { f32::NAN } else { *k });
    assert_eq!(taken(&gap), ParamError::NoValues { layer: 1 });
}
