//! The whole extraction: in memory and slab by slab, and where there is nothing to find.

use super::*;
use crate::grow::as_set;
use serde_json::Value;
use survey::Volume;
use survey::candidates::{BEYOND, ForestTables};

/// Dipping layers, a cosine of depth.
fn layered(size: [usize; 3]) -> Volume<f32> {
    let [_, ny, nz] = size;
    let sample = |n: usize| {
        let (x, y, z) = ((n / nz / ny) as f32, (n / nz % ny) as f32, (n % nz) as f32);
        (std::f32::consts::TAU * (z - 0.3 * x + 0.1 * y) / 12.0).cos()
    };
    Volume::from_samples(size, (0..size.iter().product()).map(sample).collect()).unwrap()
}

fn extracted(volume: &Volume<f32>) -> Extraction {
    extract(volume, &ExtractSettings::default(), &Progress::silent()).unwrap()
}

#[test]
fn layers_are_as_far_as_their_cosine_says() {
    let size = [40, 36, 60];
    let found = extracted(&layered(size));
    assert!(found.report.surfaces > 5 && found.report.nothing_found().is_none());
    assert_eq!(found.report.leaves, found.forest.leaf_count());
    let settings = DistanceSettings::default();
    let steep = (1.0f32 + 0.09 + 0.01).sqrt();
    for (x, y, z) in [(20, 18, 30), (17, 21, 25), (23, 15, 34), (20, 20, 28)] {
        // Peaks and troughs alternate every six samples.
        let phase = (z as f32 - 0.3 * x as f32 + 0.1 * y as f32).rem_euclid(6.0);
        let wanted = phase.min(6.0 - phase) / steep;
        let n = (x * size[1] + y) * size[2] + z;
        let distance = settings.decode(found.candidates.distance[n]).unwrap();
        assert!((distance - wanted).abs() < 0.06, "{x} {y} {z}: {distance}, not {wanted}");
        assert!(found.candidates.leaf[n] > 0);
    }
}

/// Keeps in memory what it is given, and puts it into `done` at the end.
struct Kept<'a> {
    candidates: CandidateBox,
    done: &'a mut Option<(CandidateBox, CandidateInfo<Value>, ForestTables)>,
}

/// Inlines of a slab of [`Kept`]: two whole slabs and a rest of what is extracted here.
const SLAB: usize = 64;

impl CandidateSink for Kept<'_> {
    fn slab_inlines(&self) -> usize {
        SLAB
    }

    fn write_slab(&mut self, first: usize, distance: &[u8], leaf: &[u32], _: &Progress) -> Result<(), SourceError> {
        let [nx, ny, nz] = self.candidates.size;
        assert_eq!((self.candidates.distance.len(), first % SLAB), (first * ny * nz, 0));
        assert_eq!((distance.len(), leaf.len()), ((nx - first).min(SLAB) * ny * nz, distance.len()));
        self.candidates.distance.extend(distance);
        self.candidates.leaf.extend(leaf);
        Ok(())
    }

    fn finish<R: Serialize>(
        self,
        info: &CandidateInfo<R>,
        forest: &ForestTables,
        _: &Progress,
    ) -> Result<(), SourceError> {
        let info = serde_json::from_value(serde_json::to_value(info)?)?;
        *self.done = Some((self.candidates, info, forest.clone()));
        Ok(())
    }
}

/// A sink that begins when it is asked to.
fn kept<'a>(
    done: &'a mut Option<(CandidateBox, CandidateInfo<Value>, ForestTables)>,
) -> impl FnOnce([usize; 3], usize) -> Result<Kept<'a>, SourceError> {
    |size, _| Ok(Kept { candidates: CandidateBox { size, distance: Vec::new(), leaf: Vec::new() }, done })
}

#[test]
fn slabs_give_what_memory_holds() {
    let size = [150, 20, 40];
    let volume = layered(size);
    let wanted = extracted(&volume);
    let silent = Progress::silent();
    let settings = ExtractSettings::default();
    let mut done = None;
    let report = extract_into(kept(&mut done), "key", &volume, &settings, as_set, &silent).unwrap();
    let (candidates, info, tables) = done.take().unwrap();
    assert_eq!((info.key.as_str(), info.leaves), ("key", report.leaves));
    assert_eq!(candidates, wanted.candidates);
    assert_eq!(Forest::from_tables(tables, size).unwrap(), wanted.forest);
    let told: ExtractReport = serde_json::from_value(info.report).unwrap();
    assert_eq!((told.surfaces, told.within_reach), (wanted.report.surfaces, wanted.report.within_reach));
    let cancelled = Progress::silent();
    cancelled.cancel();
    let again = extract_into(kept(&mut done), "other", &volume, &settings, as_set, &cancelled);
    assert!(matches!(again, Err(InterpError::Cancelled(_))));
    assert_eq!(done, None, "a sink is not ended by a cancel");
}

#[test]
fn a_sink_that_fails_is_said() {
    let full = |_: [usize; 3], _: usize| -> Result<Kept<'static>, SourceError> { Err("the disk is full".into()) };
    let settings = ExtractSettings::default();
    let error = extract_into(full, "", &layered([8, 8, 40]), &settings, as_set, &Progress::silent()).unwrap_err();
    assert!(matches!(error, InterpError::Sink(_)) && error.to_string() == "the disk is full");
}

#[test]
fn nothing_is_found_where_nothing_is() {
    let mut dead = layered([8, 8, 40]);
    dead.set_live(Some(vec![false; 64])).unwrap();
    let nan = Volume::filled([8, 8, 20], f32::NAN);
    for volume in [Volume::filled([8, 8, 20], 3.0), nan, dead, layered([1, 1, 40]), layered([3, 9, 40])] {
        let found = extracted(&volume);
        assert_eq!((found.report.surfaces, found.report.leaves), (0, 0));
        assert!(found.report.nothing_found().unwrap().contains("no surface at least 4 traces wide"));
        assert!(found.candidates.distance.iter().all(|&code| code == BEYOND));
        let mut done = None;
        extract_into(kept(&mut done), "", &volume, &ExtractSettings::default(), as_set, &Progress::silent()).unwrap();
        assert_eq!(done.unwrap().1.leaves, 0);
    }
}

#[test]
fn settings_that_cannot_be_are_refused() {
    let volume = layered([8, 8, 40]);
    let refused = |settings: ExtractSettings| extract(&volume, &settings, &Progress::silent()).unwrap_err();
    let grow = GrowSettings { min_front_width: 0, ..GrowSettings::default() };
    assert!(matches!(refused(ExtractSettings { grow, ..ExtractSettings::default() }), InterpError::Growing(_)));
    let distance = DistanceSettings { max_distance: f32::NAN };
    assert!(matches!(refused(ExtractSettings { distance, ..ExtractSettings::default() }), InterpError::Setting { .. }));
}
