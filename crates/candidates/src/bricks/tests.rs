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
pub(super) struct Held(Mutex<HashMap<(String, usize), Vec<u8>>>);

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
        let crate::CandidateColumns { x: xs, y: ys, distance, leaf } = bricks.column(column).unwrap();
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
    for (seed, size, snr, shapes) in [
        (5, [61, 53, 64], 2.0, vec![([200, 200], 1 << 40), ([17, 31], 3000), ([61, 5], 500)]),
        (8, [40, 47, 80], 4.0, vec![([13, 11], 1), ([40, 1], 9000), ([27, 29], 100)]),
    ] {
        let mut volume = survey(size, seed, snr);
        // Some traces are dead.
        let live = (0..size[0] * size[1]).map(|trace| trace % 97 != 5 && !(900..930).contains(&trace)).collect();
        volume.set_live(Some(live)).unwrap();
        let whole = extract(&volume, &settings(), &Progress::silent()).unwrap();
        assert!(whole.report.triangles > 20_000 && whole.report.surfaces > 10);
        shapes.into_iter().for_each(|(edge, together)| in_bricks(&volume, &settings(), &whole, edge, together));
    }
}

/// Layers above sample 50, and noise of the same strength below, which surfaces lie over themselves in.
fn half_chaotic(size: [usize; 3]) -> Volume<f32> {
    let mut volume = Volume::filled(size, 0.0f32);
    let (mut state, mut before) = (7u32, 0.0f32);
    for (n, trace) in volume.samples_mut().chunks_mut(size[2]).enumerate() {
        let depth = 6.0 + 0.1 * (n / size[1]) as f32 + 0.05 * (n % size[1]) as f32;
        for (z, value) in trace.iter_mut().enumerate() {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            before = 0.7 * before + (f32::from((state >> 16) as u16) / 32_768.0 - 1.0) * 900.0;
            *value = if z < 50 { 1000.0 * ((z as f32 - depth) * std::f32::consts::PI / 8.0).cos() } else { before };
        }
    }
    volume
}

#[test]
fn settings_and_chaos_do_not_tell_bricks_from_one_piece() {
    let volume = half_chaotic([46, 44, 96]);
    let plain = |change: fn(&mut ExtractSettings)| {
        let mut settings = settings();
        change(&mut settings);
        settings
    };
    for settings in [
        plain(|_| {}),
        plain(|settings| settings.grow.core_width = 0),
        plain(|settings| settings.grow.join_share = 2.0),
        plain(|settings| settings.grow.fault_evidence = f32::INFINITY),
        plain(|settings| settings.grow.extrema = vec![Extremum::Zero, Extremum::Trough]),
        plain(|settings| {
            settings.grow.extrema = vec![Extremum::Zero, Extremum::Trough, Extremum::Peak];
            settings.forest.start_cells = 0;
            settings.distance.max_distance = 3.5;
        }),
    ] {
        let whole = extract(&volume, &settings, &Progress::silent()).unwrap();
        assert!(whole.report.surfaces > 5);
        in_bricks(&volume, &settings, &whole, [19, 23], 2000);
    }
}

#[test]
fn nothing_is_found_in_bricks_where_nothing_is() {
    let mut dead = half_chaotic([12, 12, 60]);
    dead.set_live(Some(vec![false; 144])).unwrap();
    for volume in
        [Volume::filled([12, 12, 30], 3.0f32), Volume::filled([3, 20, 1], 1.0), dead, half_chaotic([1, 30, 64])]
    {
        let whole = extract(&volume, &settings(), &Progress::silent()).unwrap();
        assert_eq!(whole.report.surfaces, 0);
        in_bricks(&volume, &settings(), &whole, [5, 7], 10);
    }
}

/// Arrays that cannot be written after so many parts, as on a full disk, and a count of what is written.
struct Full<'a>(&'a Held, std::sync::atomic::AtomicUsize);

impl NamedArrays for Full<'_> {
    fn write(&self, array: &str, part: usize, bytes: &[u8]) -> Result<(), SourceError> {
        let one_less = |left: usize| left.checked_sub(1);
        let order = std::sync::atomic::Ordering::Relaxed;
        self.1
            .fetch_update(order, order, one_less)
            .map_err(|_| std::io::Error::from(std::io::ErrorKind::StorageFull))?;
        self.0.write(array, part, bytes)
    }

    fn is_whole(&self, array: &str, part: usize) -> bool {
        self.0.is_whole(array, part)
    }

    fn length(&self, array: &str, part: usize) -> Result<u64, SourceError> {
        self.0.length(array, part)
    }

    fn read(&self, array: &str, part: usize, offset: u64, out: &mut [u8]) -> Result<(), SourceError> {
        self.0.read(array, part, offset, out)
    }

    fn remove(&self, array: &str) {
        self.0.remove(array);
    }
}

#[test]
fn what_was_stopped_anywhere_goes_on_and_tasks_may_be_repeated_in_any_order() {
    let volume = survey([30, 34, 50], 2, 3.0);
    let whole = extract(&volume, &settings(), &Progress::silent()).unwrap();
    let cut = BrickSettings { edge: [16, 15], triangles_together: 2000, workers: 2 };
    let held = Held::default();
    let mut stops = 0;
    loop {
        // A disk that is full a little later each time.
        let full = Full(&held, (70 + 7 * stops).into());
        let bricks = Bricks::new(&volume, &full, &settings(), &cut).unwrap();
        match bricks.run(2, &Progress::silent()) {
            Ok(_) => {
                compare(&bricks, &whole, "stopped");
                break;
            }
            Err(error) => assert!(matches!(error, InterpError::Arrays(_)), "{error}"),
        }
        stops += 1;
        assert!(stops < 200);
    }
    assert!(stops > 3, "{stops}");
    // As a cluster does them: backwards, and the first one twice.
    let held = Held::default();
    let bricks = Bricks::new(&volume, &held, &settings(), &cut).unwrap();
    for stage in bricks.stages() {
        let tasks = bricks.tasks(stage).unwrap();
        for task in (0..tasks).rev().chain((0..tasks).take(1)) {
            // Every task begins in a process of its own.
            let own = Bricks::new(&volume, &held, &settings(), &cut).unwrap();
            own.run_task(stage, task, &Progress::silent()).unwrap();
        }
    }
    compare(&bricks, &whole, "backwards");
}

#[test]
fn bricks_fit_the_stated_memory_or_say_how_much_it_takes() {
    let cut = BrickSettings::within(4 << 30, [2048, 2048, 1024], 2).unwrap();
    assert!(cut.workers == 2 && cut.edge[0] > 150 && cut.edge[0] < 400, "{cut:?}");
    let few = BrickSettings::within(300 << 20, [512, 512, 512], 8).unwrap();
    assert!(few.workers < 8 && few.edge[0] >= 24, "{few:?}");
    let error = BrickSettings::within(1 << 20, [512, 512, 512], 2).unwrap_err();
    let InterpError::TooLittleMemory { least, .. } = error else { panic!("{error}") };
    assert!(BrickSettings::within(least, [512, 512, 512], 2).is_ok());
}
