//! Blocks told as events, as horizons and faults of an ordinary model: where the model says a layer is, the history has its
//! rock.

use glam::{DVec3, Vec3};
use history::{FaultBlocks, History, Place};
use model::{FaultNetwork, ModelSettings, StructuralModel};
use survey::Progress;

/// Shares of places of a block whose rock is that of the model's layer, and of those that have rock.
fn agreement(file: &str) -> Result<(f64, usize), String> {
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
    let rocks: Vec<Option<&str>> = made.rocks.iter().rev().map(Option::as_deref).collect();
    let (mut right, mut all) = (0, 0);
    let size = history.size();
    for n in 0..10_000u32 {
        // A lattice that no plane of the block is parallel to.
        let share = DVec3::new(0.754_877, 0.569_840, 0.327_113) * f64::from(n + 1);
        let p = share.fract() * size;
        let voxel = made.geometry.voxel_from_world(p);
        let layer = model.region_at(Vec3::new(voxel.x as f32, voxel.y as f32, voxel.z as f32)).layer;
        let found = match stage.place(p) {
            Place::Rock(rock) => Some(history.units()[rock.unit].rock.as_str()),
            _ => None,
        };
        all += 1;
        right += usize::from(found == rocks[usize::from(layer)]);
    }
    Ok((right as f64 / all as f64, model.block_count()))
}

#[test]
fn models_of_histories_have_the_rocks_of_the_histories() {
    let files = ["horst", "fault-bend-fold", "unconformities", "intrusions", "strike-slip"];
    for file in files {
        let (share, blocks) = agreement(file).unwrap_or_else(|error| panic!("{file}: {error}"));
        println!("{file}: {share} in {blocks} blocks");
        assert!(share > 0.995, "{file}: {share}");
    }
}
