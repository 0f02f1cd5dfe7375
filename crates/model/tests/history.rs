//! Blocks told as events, as horizons and faults of an ordinary model: where the model says a layer is, the history has its
//! rock.

use glam::DVec3;
use history::{FaultBlocks, History, Place, Stage};
use model::{FaultNetwork, ModelSettings, StructuralModel};
use survey::Progress;

/// The name of the rock at a place; none where there is none.
fn told(stage: &Stage<'_>, p: DVec3) -> Option<String> {
    match stage.place(p) {
        Place::Rock(rock) => Some(stage.history().units()[rock.altered.unwrap_or(rock.unit)].name.clone()),
        _ => None,
    }
}

/// The share of the places of a block whose layer in the model is the history's, and of those a voxel or more from all
/// boundaries.
fn agreement(file: &str) -> Result<[f64; 2], String> {
    let path = format!("{}/../../examples/histories/{file}.toml", env!("CARGO_MANIFEST_DIR"));
    let history = History::from_toml(&std::fs::read_to_string(path).unwrap()).map_err(|error| error.to_string())?;
    let stage = history.last_stage();
    let (geometry, faults) = (stage.geometry(), stage.faults());
    let network = FaultNetwork::build(&geometry, &faults, &Progress::silent()).map_err(|error| error.to_string())?;
    let at = |p: DVec3| network.block_at(geometry.voxel_from_world(p).as_vec3());
    let made = stage.interpretation(&FaultBlocks { count: network.block_count(), at: &at });
    let model = StructuralModel::build(
        &made.geometry,
        &made.stratigraphy,
        &made.horizons,
        &faults,
        &ModelSettings::default(),
        &Progress::silent(),
    )
    .map_err(|error| error.to_string())?;
    // A layer of no thickness above a bed has the bed's rock.
    let layers: Vec<Option<&str>> = made
        .stratigraphy
        .layer_names
        .iter()
        .rev()
        .zip(made.rocks.iter().rev())
        .map(|(name, rock)| rock.as_ref().map(|_| name.strip_prefix("Above ").unwrap_or(name)))
        .collect();
    let size = history.size();
    let cell = DVec3::new(geometry.inline_vector.x, geometry.crossline_vector.y, geometry.vertical.interval);
    let (mut right, mut far, mut right_far) = (0, 0, 0);
    const PLACES: u32 = 10_000;
    for n in 0..PLACES {
        // A lattice that no plane of the block is parallel to.
        let share = DVec3::new(0.754_877, 0.569_840, 0.327_113) * f64::from(n + 1);
        let p = share.fract() * size;
        let found = told(&stage, p);
        let layer = model.region_at(geometry.voxel_from_world(p).as_vec3()).layer;
        let is_right = found.as_deref() == layers[usize::from(layer)];
        right += usize::from(is_right);
        let around = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        if around.iter().all(|step| told(&stage, (p + *step * cell).clamp(DVec3::ZERO, size)) == found) {
            far += 1;
            right_far += usize::from(is_right);
        }
    }
    Ok([f64::from(right as u32) / f64::from(PLACES), f64::from(right_far as u32) / f64::from(far)])
}

#[test]
fn models_of_histories_have_the_rocks_of_the_histories() {
    let files =
        ["cuesta", "dome-and-basin", "fault-bend-fold", "growth-fault", "horst", "intrusions", "plunging-folds"];
    let more = ["pluton", "relay-ramp", "salt-diapir", "strike-slip", "unconformities"];
    for file in files.into_iter().chain(more) {
        let [all, far] = agreement(file).unwrap_or_else(|error| panic!("{file}: {error}"));
        println!("{file}: {all} of all places, {far} of those a voxel from boundaries");
        assert!(all >= 0.998 && far >= 0.9999, "{file}: {all} {far}");
    }
}
