//! Bricks of every odd shape give the bytes of one piece.

use super::*;
use crate::extraction::{Extraction, extract};
use std::collections::HashMap;
use std::sync::Mutex;
use survey::candidates::{ForestRows, ForestTables};
use survey::source::SourceError;
use survey::{Progress, Volume};
use synth::{SynthSettings, Synthetic};

/// Arrays in memory.
#[derive(Default)]
struct Held(Mutex<HashMap<(String, usize), Vec<u8>>>);

impl NamedArrays for Held {
    fn write(&self, array: &str, part: usize, bytes: &[u8]) -> Result<(), SourceError> {
        self.0.lock().unwrap().insert((array.to_owned(), part), bytes.to_vec());
        Ok(())
    }

    fn is_whole(&self, array: &str, part: usize) -> bool {
        self.0.lock().unwrap().contains_key(&(array.to_owned(), part))
    }

    fn length(&self, array: &str, part: usize) -> Result<u64, SourceError> {
        let held = self.0.lock().unwrap();
        Ok(held.get(&(array.to_owned(), part)).ok_or(format!("no {array} {part}"))?.len() as u64)
    }

    fn read(&self, array: &str, part: usize, offset: u64, out: &mut [u8]) -> Result<(), SourceError> {
        let held = self.0.lock().unwrap();
        let bytes = held.get(&(array.to_owned(), part)).ok_or(format!("no {array} {part}"))?;
        out.copy_from_slice(bytes.get(offset as usize..offset as usize + out.len()).ok_or("too short")?);
        Ok(())
    }

    fn remove(&self, array: &str) {
        self.0.lock().unwrap().retain(|(name, _), _| name != array);
    }
}

fn tables(rows: &dyn ForestRows) -> ForestTables {
    let counts = rows.counts();
    ForestTables {
        trace: rows.trace(0..counts.vertices).unwrap(),
        z: rows.z(0..counts.vertices).unwrap(),
        triangles: rows.triangles(0..counts.triangles).unwrap(),
        surfaces: rows.surfaces(0..counts.surfaces).unwrap(),
        nodes: rows.nodes(0..counts.nodes).unwrap(),
    }
}

/// Compares what bricks left behind with the whole.
fn compare(bricks: &Bricks, whole: &Extraction, what: &str) {
    let forest = bricks.forest().unwrap();
    let (found, wanted) = (tables(&forest), whole.forest.tables());
    assert!(
        found.surfaces == wanted.surfaces,
        "{what}: surfaces {:?} {:?}",
        found.surfaces.len(),
        wanted.surfaces.len()
    );
    assert!(found == wanted, "{what}: tables");
    let [_, ny, nz] = bricks.size;
    for column in 0..bricks.column_count() {
        let ([xs, ys], distance, leaf) = bricks.column(column).unwrap();
        for (n, (x, y)) in xs.clone().flat_map(|x| ys.clone().map(move |y| (x, y))).enumerate() {
            let (own, all) = (n * nz..(n + 1) * nz, (x * ny + y) * nz..(x * ny + y + 1) * nz);
            assert!(distance[own.clone()] == whole.candidates.distance[all.clone()], "{what}: distances {x} {y}");
            assert!(leaf[own] == whole.candidates.leaf[all], "{what}: leaves {x} {y}");
        }
    }
    let wanted = crate::ExtractReport { seconds: None, ..whole.report.clone() };
    assert_eq!(bricks.report().unwrap(), wanted, "{what}");
}

fn settings() -> ExtractSettings {
    let mut settings = ExtractSettings::default();
    settings.forest.min_leaf_triangles = 60;
    settings
}

fn survey(size: [usize; 3], seed: u64, snr: f64) -> Volume<f32> {
    let settings = SynthSettings { size, seed, snr: Some(snr), ..SynthSettings::default() };
    Synthetic::generate(&settings, &Progress::silent()).unwrap().seismic
}

fn in_bricks(volume: &Volume<f32>, settings: &ExtractSettings, whole: &Extraction, edge: [usize; 2], together: u64) {
    let held = Held::default();
    let cut = BrickSettings { edge, triangles_together: together, workers: 2 };
    let bricks = Bricks::new(volume, &held, settings, &cut).unwrap();
    bricks.run(cut.workers, &Progress::silent()).unwrap();
    compare(&bricks, whole, &format!("{edge:?}"));
}

#[test]
fn bricks_of_every_odd_shape_give_the_bytes_of_one_piece() {
    for (seed, size, snr) in [(5, [61, 53, 64], 2.0), (8, [40, 70, 80], 4.0)] {
        let mut volume = survey(size, seed, snr);
        // Some traces are dead.
        let live = (0..size[0] * size[1]).map(|trace| trace % 97 != 5 && !(900..930).contains(&trace)).collect();
        volume.set_live(Some(live)).unwrap();
        let whole = extract(&volume, &settings(), &Progress::silent()).unwrap();
        assert!(whole.report.triangles > 20_000 && whole.report.surfaces > 10);
        for (edge, together) in [([200, 200], 1 << 40), ([17, 31], 3000), ([7, 11], 1), ([61, 5], 500), ([1, 29], 9000)]
        {
            in_bricks(&volume, &settings(), &whole, edge, together);
        }
    }
}
