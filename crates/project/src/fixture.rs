//! Projects for the tests of this crate.

use crate::Project;
use crate::command::{Command, Extract, ImportVolume};
use crate::document::Polarity;
use files::segy::{SegyOptions, WriteOptions};
use interp::ExtractSettings;
use std::path::Path;
use survey::{Progress, SurveyGeometry, Volume};

/// A project in a folder, of a volume whose candidates are extracted.
pub(crate) fn extracted(folder: &Path, geometry: &SurveyGeometry, volume: &Volume<f32>) -> Project {
    let (path, quiet) = (folder.join("north.sgy"), Progress::silent());
    files::segy::write(&path, geometry, volume, &WriteOptions::default(), &quiet).unwrap();
    let mut new = Project::create(&folder.join("north.petro"), None).unwrap();
    let (polarity, options) = (Polarity::default(), SegyOptions::default());
    let import = ImportVolume { path, name: None, polarity, options, origin: None, memory_bytes: None, moved: false };
    let settings = ExtractSettings::default();
    let extract = Extract { volume: None, settings, memory_bytes: None, just_stored: false };
    for command in [Command::Import(import), Command::Extract(extract)] {
        new.project().apply(&command, &quiet).unwrap();
    }
    new.publish().unwrap()
}
