//! The data that pictures are drawn from: read and computed once, and shared by the threads that draw and by the query
//! for what is under the cursor.
//!
//! A change of style alone only compiles the tables again; model, parameterization and volumes stay.

use super::latest_value::{Inbox, LatestValueWorker};
use super::running::Running;
use super::{Event, Outbox};
use crate::state::{Notice, Place};
use model::ModelSettings;
use project::Project;
use project::document::{Document, WellEntry};
use project::error::ProjectError;
use project::interpretation::solid;
use project::pictures::load::{self, Loaded};
use project::{derived, styles};
use render::media::{LayerOpacity, MediumColour, white_ramp};
use render::{FaceData, Medium, PickedHorizon, Scene};
use std::path::PathBuf;
use std::sync::{Arc, PoisonError, RwLock};
use survey::Progress;
use ttf::{Colour, Preset, TtfTables};

/// Loaded data. The window's thread must not wait for them; it uses `try_read`.
pub type Rocks = Arc<RwLock<Loaded>>;

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
        let mut volumes: Vec<String> = project::document::volumes_within(scene).map(str::to_owned).collect();
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
    forget: bool,
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

    /// Drops everything that was loaded.
    pub(super) fn forget(&self) {
        self.worker.change(|next| {
            next.wanted = None;
            next.forget = true;
            next.progress.iter().for_each(Progress::cancel);
        });
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.worker.change(|next| next.progress.iter().for_each(Progress::cancel));
    }
}

/// What was loaded last, and for which request.
struct Kept {
    root: PathBuf,
    key: String,
    volumes: Vec<(String, String)>,
    seen: Seen,
    wells: Vec<WellEntry>,
    rocks: Rocks,
}

fn work(inbox: &Inbox<Next>, outbox: &Outbox, running: &Running) {
    let mut kept: Option<Kept> = None;
    loop {
        let next = inbox.next(|next| {
            if std::mem::take(&mut next.forget) {
                return Some(None);
            }
            let wanted = next.wanted.take()?;
            let (guard, progress) = running.begin("Preparing the picture", Place::Block, outbox.wake.clone());
            next.progress = Some(progress.clone());
            Some(Some((wanted, guard, progress)))
        });
        let (wanted, guard, progress) = match next {
            Some(Some(next)) => next,
            Some(None) => {
                kept = None;
                continue;
            }
            None => return,
        };
        let loaded = load(&wanted, &mut kept, &progress);
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

fn load(wanted: &Wanted, kept: &mut Option<Kept>, progress: &Progress) -> Result<Rocks, ProjectError> {
    let document = &wanted.document;
    let Purpose::Illustrate(seen) = &wanted.purpose else {
        return load_bare(wanted, kept, progress);
    };
    let key = derived::parameterization_key(document, &ModelSettings::default(), &solid::param_settings(document));
    let volumes = needed_volumes(document);
    let same = |kept: &&Kept| kept.root == wanted.root && kept.key == key && kept.volumes == volumes;
    if let Some(kept) = kept.as_mut().filter(|kept| same(&&**kept)) {
        if kept.seen != *seen {
            let project = Project::open(&wanted.root)?;
            let scene = seen.scene(wanted.preset);
            let more = {
                let loaded = kept.rocks.read().unwrap_or_else(PoisonError::into_inner);
                super::compute(|| load::read_more(&project, &loaded, &scene, progress))?
            };
            more.add_to(&mut kept.rocks.write().unwrap_or_else(PoisonError::into_inner));
            kept.seen = seen.clone();
        }
        if kept.wells != document.wells {
            let geometry = kept.rocks.read().unwrap_or_else(PoisonError::into_inner).geometry.clone();
            let wells = load::read_wells(&wanted.root, document, &geometry)?;
            let mut loaded = kept.rocks.write().unwrap_or_else(PoisonError::into_inner);
            (loaded.wells, loaded.data_version) = (wells, load::new_version());
            drop(loaded);
            kept.wells.clone_from(&document.wells);
        }
        restyle(&kept.rocks, wanted)?;
        return Ok(kept.rocks.clone());
    }
    // Drop the old data first, so that memory holds one model and its volumes rather than two.
    *kept = None;
    let project = Project::open(&wanted.root)?;
    let scene = seen.scene(wanted.preset);
    let loaded = super::compute(|| load::load(&project, &scene, progress))?;
    let rocks = Arc::new(RwLock::new(loaded));
    let (seen, wells) = (seen.clone(), document.wells.clone());
    *kept = Some(Kept { root: wanted.root.clone(), key, volumes, seen, wells, rocks: rocks.clone() });
    Ok(rocks)
}

/// The data for interpreting: the raw volume, the wells, and the candidates where they are shown.
fn load_bare(wanted: &Wanted, kept: &mut Option<Kept>, progress: &Progress) -> Result<Rocks, ProjectError> {
    let document = &wanted.document;
    let raw = styles::transfer_functions(document).raw;
    let entry = raw.as_ref().and_then(|raw| document.volumes.iter().find(|entry| entry.name == raw.volume));
    let key = format!("bare {:?} {:?}", wanted.purpose, document.wells);
    let volumes: Vec<(String, String)> = entry.iter().map(|entry| (entry.name.clone(), entry.hash.clone())).collect();
    let same = |kept: &&Kept| kept.root == wanted.root && kept.key == key && kept.volumes == volumes;
    if let Some(kept) = kept.as_ref().filter(same) {
        let mut loaded = kept.rocks.write().unwrap_or_else(PoisonError::into_inner);
        (loaded.raw, loaded.version) = (raw, load::new_version());
        drop(loaded);
        return Ok(kept.rocks.clone());
    }
    *kept = None;
    let project = Project::open(&wanted.root)?;
    let face_data = match &wanted.purpose {
        Purpose::Interpret { extraction: Some(_) } => FaceData::Leaves,
        _ => FaceData::Rock,
    };
    let scene = Scene { face_data, ..Scene::default() };
    let loaded =
        super::compute(|| load::load_bare(&project, &scene, project::memory_budget::half_of_available(), progress))?;
    let rocks = Arc::new(RwLock::new(loaded));
    let (seen, wells) = (Seen::default(), document.wells.clone());
    *kept = Some(Kept { root: wanted.root.clone(), key, volumes, seen, wells, rocks: rocks.clone() });
    Ok(rocks)
}

/// Names and hashes of the volumes that pictures of a project show.
fn needed_volumes(document: &Document) -> Vec<(String, String)> {
    let functions = styles::transfer_functions(document);
    let scalars = functions.scalars.iter().map(|function| function.volume.clone());
    let wanted: Vec<String> = scalars.chain(functions.raw.map(|raw| raw.volume)).collect();
    let entries = document.volumes.iter().filter(|entry| wanted.contains(&entry.name));
    entries.map(|entry| (entry.name.clone(), entry.hash.clone())).collect()
}

/// Compiles the styles of a project state into the loaded data.
fn restyle(rocks: &Rocks, wanted: &Wanted) -> Result<(), ProjectError> {
    let document = &wanted.document;
    let functions = styles::transfer_functions(document).printed(wanted.preset);
    let tables = {
        let loaded = rocks.read().unwrap_or_else(PoisonError::into_inner);
        match &loaded.rock {
            None => None,
            Some(rock) => {
                let library = styles::pattern_library(&wanted.root, document)?;
                let names = document.stratigraphy().layer_names_bottom_up();
                let block = load::block_extent(&loaded.geometry, rock, names);
                Some(TtfTables::compile(&functions, &block, &library)?)
            }
        }
    };
    let mut loaded = rocks.write().unwrap_or_else(PoisonError::into_inner);
    loaded.tables = tables;
    loaded.raw = functions.raw;
    loaded.version = load::new_version();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
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
        let mut kept = None;
        let before = load(&wanted(&project), &mut kept, &Progress::silent()).unwrap();
        assert!(before.read().unwrap().wells.is_empty());
        let deviation = write("w.csv", "md_m,x_m,y_m,tvdss_m\n0,50,50,0\n30,50,50,30\n");
        let las = write(
            "w.las",
            "~V\nVERS. 2.0 :\nWRAP. NO :\n~W\nNULL. -999.25 :\n~C\nDEPT.M :\nGR.API :\n~A\n0 40\n15 -999.25\n30 90\n",
        );
        let files = files::well::WellFiles { deviation, las: vec![las], ..Default::default() };
        let well = AddWell { name: "W".to_owned(), files, options: Default::default() };
        project.apply(&Command::AddWell(well), &Progress::silent()).unwrap();
        let after = load(&wanted(&project), &mut kept, &Progress::silent()).unwrap();
        assert_eq!(after.read().unwrap().wells.len(), 1);
        // Its log is shown on sections, from its smallest to its largest value.
        let loaded = after.read().unwrap();
        let log = loaded.wells[0].log.as_ref().unwrap();
        assert_eq!((log.name.as_str(), log.range, log.points.len()), ("GR", [40.0, 90.0], 3));
        drop(loaded);
        assert!(Arc::ptr_eq(&before, &after), "the model is not computed again");
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
