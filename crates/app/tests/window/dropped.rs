//! Files dropped on the window.

use crate::command::choose;
use crate::driven::{Driven, click, document, driven, open, project, state, survey, wait};
use egui_kittest::kittest::Queryable;
use state::{Dialogue, FileContent};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file that is dropped.
#[derive(Debug)]
struct Held(PathBuf);

impl eframe::egui::DroppedFile for Held {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_on(harness: &mut Driven, path: &Path) {
    harness.input_mut().dropped_files.push(Arc::new(Held(path.to_owned())));
    harness.run_steps(3);
}

#[test]
fn a_project_is_opened_and_a_survey_read() {
    let folder = tempfile::tempdir().unwrap();
    let root = project(folder.path());
    let mut harness = driven(folder.path(), None);
    harness.step();
    drop_on(&mut harness, &folder.path().join("nothing.dat"));
    harness.get_by_label_contains("nothing.dat is neither a project");
    drop_on(&mut harness, &survey(folder.path()));
    harness.get_by_label("Create project");
    // The dialogue may still be finding its place while the file is looked through.
    harness.get_by_label("Cancel").click_accesskit();
    wait(&mut harness, "the dialogue is gone", |harness| state(harness).dialogue.is_none());
    drop_on(&mut harness, &root.join("project.toml"));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    assert_eq!(state(&harness).session.as_ref().unwrap().root, root);
}

#[test]
fn it_is_asked_what_a_file_holds() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let path = folder.path().join("Middle.csv");
    std::fs::write(&path, "inline,crossline,z\n1,1,50\n24,1,50\n1,20,50\n24,20,50\n12,10,50\n").unwrap();
    drop_on(&mut harness, &path);
    harness.get_by_label("What is Middle.csv?");
    click(&mut harness, "A horizon");
    assert!(matches!(state(&harness).dialogue, Some(Dialogue::Interpretation { kind: FileContent::Horizon, .. })));
    assert_eq!(document(&harness).horizons.len(), 2, "nothing is added unasked");
}

#[test]
fn a_horizon_is_put_where_it_is_told_and_in_the_shape_that_is_stated() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    let oldest = document(&harness).horizons[1].name.clone();
    let path = folder.path().join("Middle.csv");
    std::fs::write(&path, "inline,crossline,z\n1,1,50\n24,1,50\n1,20,50\n24,20,50\n12,10,50\n").unwrap();
    drop_on(&mut harness, &path);
    click(&mut harness, "A horizon");
    for (field, choice) in [
        ("Contact", "intrusive, cut by erosion".to_owned()),
        ("Contact", "erosional".to_owned()),
        ("Shape", "any shape".to_owned()),
        ("Shape", "a map".to_owned()),
        ("Place in the column", format!("just below {oldest}")),
    ] {
        choose(&mut harness, field, &choice);
    }
    // The button can be pressed as soon as the file has been read in that way.
    wait(&mut harness, "it is added", |harness| {
        if let Some(add) = harness.query_by_label("Add") {
            add.click_accesskit();
        }
        document(harness).horizons.len() == 3
    });
    let added = &document(&harness).horizons[2];
    assert_eq!((added.name.as_str(), added.contact), ("Middle", survey::Contact::Erosional));
}
