//! The data that pictures are drawn from: read and computed once, and shared by the threads that draw and by the query
//! for what is under the cursor.
//!
//! They are facts of the project: what the window shows at present is found in memory, so that a change of style alone
//! only compiles the tables again.

use super::latest_value::{Inbox, LatestValueWorker};
use super::running::Running;
use super::{Event, Outbox};
use crate::state::{Notice, Place};
use project::Facts;
use project::document::Document;
use project::error::ProjectError;
use project::pictures::load::{self, Extent, Loaded, Request};
use render::media::{LayerOpacity, MediumColour, white_ramp};
use render::{FaceData, Medium, PickedHorizon, Scene};
use std::path::PathBuf;
use std::sync::Arc;
use survey::Progress;
use ttf::{Colour, Preset};

/// Loaded data.
pub type Rocks = Arc<Loaded>;

/// A request for data.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// The project.
    pub root: PathBuf,
    /// Its state.
    pub document: Document,
    /// How colours are printed.
    pub preset: Preset,
    /// The purpose of the pictures.
    pub purpose: Purpose,
}

/// The purpose of the pictures that are drawn from the data.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Purpose {
    /// Illustration: everything that is computed from the interpretation, and what the volume rendering shows.
    Illustrate(Seen),
    /// Interpreting: the volume alone, whatever horizons there are, so that no pick has to wait for a model.
    Interpret {
        /// The extraction whose candidates are shown; `None` where none are shown, since they take five bytes a voxel.
        extraction: Option<String>,
    },
}

/// The content of the volume rendering: names in sorted order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Seen {
    /// Volumes.
    pub volumes: Vec<String>,
    /// Horizons.
    pub horizons: Vec<String>,
}

impl Seen {
    /// What a scene renders within the block.
    pub fn of(scene: &Scene) -> Self {
        let mut volumes: Vec<String> = scene.media.volumes().map(str::to_owned).collect();
        let mut horizons: Vec<String> =
            scene.media.horizons.iter().filter_map(|horizon| horizon.name.clone()).collect();
        for names in [&mut volumes, &mut horizons] {
            names.sort();
            names.dedup();
        }
        Self { volumes, horizons }
    }

    /// A scene that renders this.
    fn scene(&self, preset: Preset) -> Scene {
        let medium = |volume: &String| Medium {
            volume: volume.clone(),
            function: white_ramp(1.0, 0.0),
            layers: LayerOpacity::Ignored,
            colour: MediumColour::Function,
        };
        let horizon =
            |name: &String| PickedHorizon { name: Some(name.clone()), ..PickedHorizon::of(Vec::new(), Colour::WHITE) };
        // A blend in between needs everything that any blend needs.
        let mut scene = Scene { blend: 0.5, preset, ..Scene::default() };
        scene.media.surroundings = self.volumes.iter().map(medium).collect();
        scene.media.horizons = self.horizons.iter().map(horizon).collect();
        scene
    }
}

#[derive(Default)]
struct Next {
    wanted: Option<Wanted>,
    progress: Option<Progress>,
}

/// A latest-value worker that loads data.
pub(super) struct Loader {
    worker: LatestValueWorker<Next>,
}

impl Loader {
    pub(super) fn start(outbox: Outbox, running: Running) -> Self {
        let told = outbox.clone();
        Self {
            worker: LatestValueWorker::start("the loading of data", &told, move |inbox| {
                work(inbox, &outbox, &running);
            }),
        }
    }

    /// Loads this next; the loading for another state is cancelled.
    pub(super) fn load(&self, wanted: Wanted) {
        self.worker.change(|next| {
            next.wanted = Some(wanted);
            next.progress.iter().for_each(Progress::cancel);
        });
    }

    /// Stops loading.
    pub(super) fn forget(&self) {
        self.worker.change(|next| {
            next.wanted = None;
            next.progress.iter().for_each(Progress::cancel);
        });
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.worker.change(|next| next.progress.iter().for_each(Progress::cancel));
    }
}

fn work(inbox: &Inbox<Next>, outbox: &Outbox, running: &Running) {
    let begin = |next: &mut Next| {
        let wanted = next.wanted.take()?;
        let (guard, progress) = running.begin("Preparing the picture", Place::Block, outbox.wake.clone());
        next.progress = Some(progress.clone());
        Some((wanted, guard, progress))
    };
    while let Some((wanted, guard, progress)) = inbox.next(begin) {
        let loaded = load(&wanted, &progress);
        drop(guard);
        match loaded {
            Ok(rocks) => outbox.send(Event::Ready { root: wanted.root, rocks }),
            // A cancelled request has not failed, wherever in the chain of causes the cancellation stands.
            Err(_) if progress.check().is_err() => {}
            Err(error) => outbox.send(Event::Told(Notice::failure(Place::Block, &error))),
        }
        outbox.wake();
    }
}

fn load(wanted: &Wanted, progress: &Progress) -> Result<Rocks, ProjectError> {
    let (scene, extent) = match &wanted.purpose {
        Purpose::Illustrate(seen) => (seen.scene(wanted.preset), Extent::Whole),
        Purpose::Interpret { extraction } => {
            let face_data = if extraction.is_some() { FaceData::Leaves } else { FaceData::Rock };
            (Scene { face_data, ..Scene::default() }, Extent::Data(None))
        }
    };
    let (facts, request) = (Facts::of(&wanted.root, &wanted.document), Request::new(&scene).of(extent));
    super::compute(|| load::load(facts, &request, progress)).map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use project::Project;
    use project::command::{AddHorizon, AddWell, Age, Command};
    use render::{Isosurface, IsosurfaceSource};
    use survey::{SurveyGeometry, VerticalUnit};
    use ttf::RgbaFunction;

    #[test]
    fn a_well_added_while_a_model_is_loaded_is_drawn_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let geometry = SurveyGeometry::regular([6, 6, 8], 25.0, 4.0, VerticalUnit::Metres);
        let mut new = Project::create(&folder.path().join("a.petro"), Some(geometry)).unwrap();
        let lines = (1..=6).flat_map(|inline| (1..=6).map(move |crossline| format!("{inline},{crossline},12\n")));
        let add = Command::AddHorizon(AddHorizon {
            path: write("top.csv", &lines.fold("inline,crossline,z\n".to_owned(), |text, line| text + &line)),
            name: "Top".to_owned(),
            contact: survey::Contact::Conformable,
            age: Age::ByDepth,
            options: files::ImportOptions::default(),
        });
        new.project().apply(&add, &Progress::silent()).unwrap();
        let mut project = new.publish().unwrap();
        let wanted = |project: &Project| Wanted {
            root: project.root().to_owned(),
            document: project.document().clone(),
            preset: Preset::Colour,
            purpose: Purpose::Illustrate(Seen::default()),
        };
        let before = load(&wanted(&project), &Progress::silent()).unwrap();
        assert!(before.wells.is_empty());
        let deviation = write("w.csv", "md_m,x_m,y_m,tvdss_m\n0,50,50,0\n30,50,50,30\n");
        let las = write(
            "w.las",
            "~V\nVERS. 2.0 :\nWRAP. NO :\n~W\nNULL. -999.25 :\n~C\nDEPT.M :\nGR.API :\n~A\n0 40\n15 -999.25\n30 90\n",
        );
        let files = files::well::WellFiles { deviation, las: vec![las], ..Default::default() };
        let well = AddWell { name: "W".to_owned(), files, options: Default::default() };
        project.apply(&Command::AddWell(well), &Progress::silent()).unwrap();
        let after = load(&wanted(&project), &Progress::silent()).unwrap();
        assert_eq!(after.wells.len(), 1);
        // Its log is shown on sections, from its smallest to its largest value.
        let log = after.wells[0].log.as_ref().unwrap();
        assert_eq!((log.name.as_str(), log.range, log.points.len()), ("GR", [40.0, 90.0], 3));
        let [first, second] = [&before, &after].map(|loaded| loaded.rock.clone().unwrap());
        assert!(Arc::ptr_eq(&first, &second), "the model is not computed again");
        // What was drawn of the data is drawn again, since they have a well more.
        assert_ne!(before.data_key, after.data_key);
    }

    #[test]
    fn volumes_of_isosurfaces_and_painted_horizons_are_listed() {
        let mut scene = Scene::default();
        assert_eq!(Seen::of(&scene), Seen::default());
        let of = IsosurfaceSource::Volume("impedance".into());
        scene.media.isosurfaces.push(Isosurface {
            of,
            value: 1.0,
            colour: Colour::WHITE,
            opacity: 1.0,
            thickness: 1.0,
        });
        let paint = render::media::Paint {
            volume: "dip".into(),
            function: RgbaFunction::over(ttf::ColourMap::Grey, [0.0, 1.0]),
        };
        let horizon = PickedHorizon { name: Some("Top".into()), ..PickedHorizon::of(Vec::new(), Colour::WHITE) };
        scene.media.horizons.push(PickedHorizon { paint: Some(paint), ..horizon });
        let seen = Seen::of(&scene);
        assert_eq!(
            (seen.volumes, seen.horizons),
            (vec!["dip".to_owned(), "impedance".to_owned()], vec!["Top".to_owned()])
        );
    }
}
