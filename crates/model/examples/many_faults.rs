//! Times a network of long faults and a model of five horizons that they cut, with so many faults and voxels a side:
//! `cargo run --release -p model --example many_faults -- 20 128`. Half of the faults dip one way, half the
//! other, and their strikes differ, so that they cross.

use glam::DVec3;
use model::{FaultNetwork, ModelSettings, StructuralModel};
use std::time::Instant;
use survey::horizon::{NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Fault, Horizon, Progress, SurveyGeometry, TriangleMesh, VerticalUnit};

const HORIZONS: usize = 5;
/// Cells along each side of a fault's mesh.
const CELLS: usize = 24;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut stated = std::env::args().skip(1).map(|argument| argument.parse::<usize>());
    let count = stated.next().transpose()?.unwrap_or(20);
    let side = stated.next().transpose()?.unwrap_or(128);
    let geometry = SurveyGeometry::regular([side; 3], 25.0, 10.0, VerticalUnit::Metres);
    let last = side as f64 - 1.0;
    let faults: Vec<Fault> = (0..count)
        .map(|n| {
            let x = last * (n as f64 + 0.5) / count as f64;
            let (strike, dip) = (0.1 * ((n * 7 % 5) as f64 - 2.0), if n % 2 == 0 { 0.25 } else { -0.25 });
            let place = |u: f64, v: f64| {
                let (along, down) = (last * (1.1 * u - 0.05), last * (1.1 * v - 0.05));
                let x = x + strike * (along - 0.5 * last) + dip * (down - 0.5 * last);
                geometry.world_from_voxel(DVec3::new(x, along, down))
            };
            Fault::new(format!("F{n}"), sheet(place))
        })
        .collect();
    let quiet = Progress::silent();
    let start = Instant::now();
    let network = FaultNetwork::build(&geometry, &faults, &quiet)?;
    println!("{count} faults, {} blocks: {:.2} s", network.block_count(), start.elapsed().as_secs_f64());
    let start = Instant::now();
    let crossings = network.crossings(geometry.size()).len();
    println!("{crossings} pairs that cross: {:.2} s", start.elapsed().as_secs_f64());
    let horizons: Vec<Horizon> = (0..HORIZONS)
        .map(|h| {
            let depth = (0..side * side).map(|n| {
                let (x, y) = ((n / side) as f64 / last, (n % side) as f64 / last);
                let level = (h as f64 + 1.0) / (HORIZONS as f64 + 1.0) + 0.05 * (5.0 * x).sin() * (4.0 * y).cos();
                (10.0 * last * level) as f32
            });
            let sheet = Sheet::new(NodeGrid::of_survey(&geometry), depth.collect(), Quality::Picked);
            Horizon::new(format!("H{h}"), vec![sheet])
        })
        .collect();
    let named = |h: usize| StratigraphicHorizon { name: format!("H{h}"), contact: Contact::Conformable };
    let stratigraphy = Stratigraphy { horizons: (0..HORIZONS).map(named).collect(), layer_names: Vec::new() };
    let start = Instant::now();
    StructuralModel::build(&geometry, &stratigraphy, &horizons, &faults, &ModelSettings::default(), &quiet)?;
    println!("the model of {HORIZONS} horizons: {:.2} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The triangles of a grid of places.
fn sheet(place: impl Fn(f64, f64) -> DVec3) -> TriangleMesh {
    let share = |n: usize| n as f64 / CELLS as f64;
    let nodes = (0..=CELLS).flat_map(|u| (0..=CELLS).map(move |v| (u, v)));
    let vertices = nodes.map(|(u, v)| place(share(u), share(v))).collect();
    let at = |u: usize, v: usize| (u * (CELLS + 1) + v) as u32;
    let cells = (0..CELLS).flat_map(|u| (0..CELLS).map(move |v| (u, v)));
    let cell = |(u, v)| [[at(u, v), at(u + 1, v), at(u + 1, v + 1)], [at(u, v), at(u + 1, v + 1), at(u, v + 1)]];
    TriangleMesh { vertices, triangles: cells.flat_map(cell).collect() }
}
