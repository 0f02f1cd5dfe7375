//! Candidates as picking has them: read once, and in parts.

use super::*;
use crate::Project;
use crate::command::{Command, Extract, ImportVolume};
use crate::document::Polarity;
use files::segy::{SegyOptions, WriteOptions};
use interp::ExtractSettings;
use interp::assembly::Fingerprint;
use std::path::{Path, PathBuf};
use survey::{VerticalUnit, Volume};

/// A project with a small volume.
fn imported(folder: &Path) -> PathBuf {
    let geometry = SurveyGeometry::regular([24, 20, 32], 25.0, 4.0, VerticalUnit::Milliseconds);
    let samples = (0..24 * 20 * 32).map(|n| ((n % 32) as f32 * 0.7).sin()).collect();
    let volume = Volume::from_samples([24, 20, 32], samples).unwrap();
    let path = folder.join("north.sgy");
    files::segy::write(&path, &geometry, &volume, &WriteOptions::default(), &Progress::silent()).unwrap();
    let mut new = Project::create(&folder.join("north.petro"), None).unwrap();
    let import = ImportVolume {
        path,
        name: None,
        polarity: Polarity::default(),
        options: SegyOptions::default(),
        memory_bytes: None,
        moved: false,
        origin: None,
    };
    new.project().apply(&Command::Import(import), &Progress::silent()).unwrap();
    new.publish().unwrap().root().to_owned()
}

fn extract(project: &mut Project, settings: &ExtractSettings) {
    let extract = Extract { volume: None, settings: settings.clone(), memory_bytes: None, just_stored: false };
    project.apply(&Command::Extract(extract), &Progress::silent()).unwrap();
}

#[test]
fn what_is_held_is_not_read_again_until_another_extraction_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let quiet = Progress::silent();
    let root = imported(folder.path());
    let mut project = Project::open(&root).unwrap();
    let mut settings = ExtractSettings::default();
    extract(&mut project, &settings);
    let first = Candidates::load(Facts::of(&root, project.document()), &quiet).unwrap();
    assert!(Arc::ptr_eq(&first, &Candidates::load(Facts::of(&root, project.document()), &quiet).unwrap()));
    settings.forest.min_leaf_triangles = 80;
    extract(&mut project, &settings);
    let second = Candidates::load(Facts::of(&root, project.document()), &quiet).unwrap();
    assert_ne!(first.key, second.key);
    assert!(second.forest.leaf_count() > first.forest.leaf_count());
    // Of another project nothing is taken, whatever its key.
    let elsewhere = tempfile::tempdir().unwrap();
    let other = imported(elsewhere.path());
    let mut elsewhere = Project::open(&other).unwrap();
    extract(&mut elsewhere, &settings);
    assert!(!Arc::ptr_eq(&second, &Candidates::load(Facts::of(&other, elsewhere.document()), &quiet).unwrap()));
}

#[test]
fn a_part_of_the_candidates_tells_the_same_of_picks_as_all_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let quiet = Progress::silent();
    let root = imported(folder.path());
    let mut project = Project::open(&root).unwrap();
    let mut settings = ExtractSettings::default();
    settings.forest.min_leaf_triangles = 80;
    // The survey has few samples; most surfaces are to be farther away.
    settings.distance.max_distance = 3.0;
    extract(&mut project, &settings);
    let document = project.document();
    let geometry = document.frame().unwrap();
    let stored = extraction::open(&root, document).unwrap();
    let whole = Candidates::load(Facts::of(&root, document), &quiet).unwrap();
    assert!(whole.forest.surfaces.surfaces.len() > 3);
    for at in [[4.0, 5.0, 9.0], [13.3, 7.6, 61.7], [22.0, 19.0, 120.0], [1.0, 1.0, 0.0]] {
        let part = Candidates::part(&stored, document, &[at], &quiet).unwrap();
        assert!(part.forest.surfaces.vertices.len() < whole.forest.surfaces.vertices.len(), "{at:?}");
        let [a, b] = [&whole, &Arc::new(part)].map(|candidates| {
            let leaf = candidates.leaf_near(geometry, at).map(|hit| (hit.leaf, hit.distance, hit.nearest));
            let leaf = leaf.map_err(|error| error.to_string());
            let number = leaf.as_ref().map_or(1, |hit| hit.0);
            let node = candidates.forest.leaves[number as usize - 1];
            let nodes = if leaf.is_ok() { candidates.forest.climb(node).collect() } else { Vec::new() };
            let prints = nodes.iter().map(|&node| Fingerprint::of(&candidates.forest, node)).collect::<Vec<_>>();
            (leaf, candidates.levels(number), prints)
        });
        assert_eq!(a, b, "{at:?}");
    }
    // Nothing is near a place outside of the survey, either.
    let part = Candidates::part(&stored, document, &[[900.0, 1.0, 1.0]], &quiet).unwrap();
    assert!(matches!(part.leaf_near(geometry, [900.0, 1.0, 1.0]), Err(ProjectError::PickOutside { .. })));
}
