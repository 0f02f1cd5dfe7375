//! The stages of a block's geological history: the block after each of its events, or in the middle of one, as an ordinary
//! project in a temporary folder, so that whatever draws a project draws a stage.
//!
//! Layers, their rocks and the colours of faults are those of the project itself, by name; what is gone in the end has the
//! history's own style. The last stage is the project itself. Of an interpretation without a history, restorations are stages.

use crate::command::{AddTexture, Command, Restore, TellHistory};
use crate::error::{ProjectError, StageError};
use crate::{NewProject, Project};
use glam::DVec3;
use history::{History, Place, Stage};
use rayon::prelude::*;
use render::Scene;
use restore::RestoreSettings;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use survey::block::VoxelBox;
use survey::{Progress, SurveyGeometry};

/// Places along each edge of a face at which stages are compared.
const ALONG: usize = 36;
/// Depths at which the ground is looked for.
const DOWN: usize = 64;
/// Steps of the first event in which the first rock is looked for.
const FIRST_STEPS: u32 = 20;
/// How far within a face it is looked at, voxels.
const WITHIN: f64 = 0.01;

/// The history of a project, and its stages.
#[derive(Debug)]
pub struct Stages<'a> {
    finished: &'a Project,
    history: History,
}

/// The block at a stage.
#[derive(Debug)]
pub enum StageProject<'a> {
    /// The last stage.
    Finished(&'a Project),
    /// Another one, in a temporary folder; removed when this is dropped.
    Made(Box<NewProject>),
}

impl StageProject<'_> {
    /// The project.
    pub fn project(&self) -> &Project {
        match self {
            Self::Finished(project) => project,
            Self::Made(new) => new.as_project(),
        }
    }
}

impl<'a> Stages<'a> {
    /// Of a project that was made from a history.
    ///
    /// # Errors
    /// [`StageError::NoHistory`], or what is wrong with its text.
    pub fn of(finished: &'a Project) -> Result<Self, ProjectError> {
        let text = finished.document().geological_history.as_ref().ok_or(StageError::NoHistory)?;
        let history = History::from_toml(text).map_err(|source| ProjectError::History { source })?;
        Ok(Self { finished, history })
    }

    /// How many events there are.
    pub fn events(&self) -> usize {
        self.history.events().len()
    }

    /// What the history is called.
    pub fn title(&self) -> Option<&str> {
        self.history.title()
    }

    /// What has just happened at a stage, or is happening, in words.
    ///
    /// # Errors
    /// [`StageError::Beyond`].
    pub fn caption(&self, stage: f64) -> Result<String, ProjectError> {
        self.check(stage)?;
        let event = self.history.caption(stage.ceil() as usize - 1);
        let share = stage.fract();
        Ok(if share == 0.0 { event } else { format!("{event} ({:.0} % of it)", 100.0 * share) })
    }

    /// Checks that there is a stage.
    fn check(&self, stage: f64) -> Result<(), ProjectError> {
        let is_one = stage > 0.0 && stage <= self.events() as f64;
        if is_one { Ok(()) } else { Err(StageError::Beyond { asked: stage, events: self.events() }.into()) }
    }

    /// The block at a stage: 2 is after the second event, 2.5 after half of the third.
    ///
    /// # Errors
    /// [`StageError`], or the user cancelled.
    pub fn at(&self, stage: f64, progress: &Progress) -> Result<StageProject<'a>, ProjectError> {
        self.check(stage)?;
        if stage == self.events() as f64 {
            return Ok(StageProject::Finished(self.finished));
        }
        if !self.has_rock(stage) {
            return Err(StageError::Bare { stage }.into());
        }
        let failed = |source| match source {
            ProjectError::Cancelled(_) => source,
            other => StageError::Block {
                stage,
                event: self.history.caption(stage.ceil() as usize - 1),
                source: Box::new(other),
            }
            .into(),
        };
        let mut new = Project::create(&folder_for_a_stage(), None)?;
        self.tell(&mut new, stage, progress).map_err(failed)?;
        Ok(StageProject::Made(Box::new(new)))
    }

    fn tell(&self, new: &mut NewProject, stage: f64, progress: &Progress) -> Result<(), ProjectError> {
        let finished = self.finished.document();
        for texture in &finished.textures {
            let path = self.finished.root().join(&texture.file);
            let add = AddTexture { path, width_mm: Some(texture.tile_mm[0]) };
            new.project().apply(&Command::AddTexture(add), progress)?;
        }
        let colours = finished.faults.iter().filter_map(|fault| Some((fault.name.clone(), fault.colour?)));
        let tell = TellHistory {
            text: finished.geological_history.clone().unwrap_or_default(),
            until: Some(stage),
            styles: finished.style.layers.styles.clone(),
            fault_colours: colours.collect(),
        };
        new.project().apply(&Command::TellHistory(tell), progress)?;
        Ok(())
    }

    /// Whether there is rock in the middle of the block or at its corners.
    fn has_rock(&self, stage: f64) -> bool {
        let (made, size) = (self.history.stage(stage), self.history.size());
        let shares = [[0.5, 0.5], [0.01, 0.01], [0.99, 0.01], [0.01, 0.99], [0.99, 0.99]];
        // A hair of rock at the foot is no block to look at.
        let is_rock = |[x, y]: [f64; 2]| matches!(made.place(size * DVec3::new(x, y, 0.97)), Place::Rock(_));
        shares.into_iter().any(is_rock)
    }

    /// The first stage at which there is rock: while the first event is under way, or after it.
    pub fn first(&self) -> f64 {
        let shares = (1..=FIRST_STEPS).map(|step| f64::from(step) / f64::from(FIRST_STEPS));
        shares.into_iter().find(|stage| self.has_rock(*stage)).unwrap_or(1.0)
    }

    /// The stages after those events that change what is seen of a scene: the block's faces, those of its cut-outs, and the
    /// ground.
    ///
    /// # Errors
    /// The user cancelled.
    pub fn seen_to_change(&self, scene: &Scene, progress: &Progress) -> Result<Vec<f64>, ProjectError> {
        let geometry = self.history.last_stage().geometry();
        let places = places(scene, &geometry);
        let mut before = vec![None; places.len()];
        let mut found = Vec::new();
        for event in 1..=self.events() {
            progress.check()?;
            let stage = self.history.stage(event as f64);
            let after: Vec<Option<usize>> = places.par_iter().map(|place| seen(&stage, place)).collect();
            if after != before {
                found.push(event as f64);
            }
            before = after;
        }
        Ok(found)
    }
}

/// The project restored to one of its horizons: a stage of an interpretation without a history.
///
/// # Errors
/// The horizon is unknown, or cannot be restored.
pub fn restored(
    present: &Project,
    to: &str,
    settings: RestoreSettings,
    progress: &Progress,
) -> Result<StageProject<'static>, ProjectError> {
    let mut new = Project::create(&folder_for_a_stage(), None)?;
    let restore = Restore { source: present.root().to_path_buf(), to: to.to_owned(), settings };
    new.project().apply(&Command::Restore(restore), progress)?;
    Ok(StageProject::Made(Box::new(new)))
}

fn folder_for_a_stage() -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name = format!("petroglyph-{}-{}.petro", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    std::env::temp_dir().join(name)
}

/// Where a stage is looked at.
enum Looked {
    /// At a place, m.
    At(DVec3),
    /// Down on the ground from a place, so far.
    Down(DVec3, f64),
}

/// Which unit is seen, or for the ground also how deep; `None` for air and water.
fn seen(stage: &Stage<'_>, looked: &Looked) -> Option<usize> {
    match looked {
        Looked::At(p) => stage.place(*p).seen(),
        Looked::Down(p, far) => (0..DOWN).find_map(|step| {
            let place = stage.place(*p + DVec3::Z * (far * step as f64 / DOWN as f64));
            place.seen().map(|unit| unit * DOWN + step)
        }),
    }
}

/// What of a block is looked at in a scene.
fn places(scene: &Scene, geometry: &SurveyGeometry) -> Vec<Looked> {
    let block = scene.box_in(geometry);
    let share = |n: usize| (n as f64 + 0.5) / ALONG as f64;
    let world = |voxel: DVec3| geometry.world_from_voxel(voxel);
    let mut places = Vec::new();
    let mut add_faces = |of: &VoxelBox| {
        for axis in 0..3 {
            let [s, t] = [(axis + 1) % 3, (axis + 2) % 3];
            for at in [of.min[axis] + WITHIN, of.max[axis] - WITHIN] {
                for n in 0..ALONG * ALONG {
                    let mut voxel = [at; 3];
                    voxel[s] = of.min[s] + share(n / ALONG) * (of.max[s] - of.min[s]);
                    voxel[t] = of.min[t] + share(n % ALONG) * (of.max[t] - of.min[t]);
                    places.push(Looked::At(world(DVec3::from_array(voxel))));
                }
            }
        }
    };
    add_faces(&block);
    scene.cut_outs.iter().for_each(&mut add_faces);
    if scene.ground.is_some() || !scene.cut_shapes.is_empty() {
        let [low, high] = [DVec3::from_array(block.min), DVec3::from_array(block.max)];
        for n in 0..ALONG * ALONG {
            let at = low + (high - low) * DVec3::new(share(n / ALONG), share(n % ALONG), 0.0);
            let far = world(high).z - world(low).z;
            if scene.cut_shapes.is_empty() {
                places.push(Looked::Down(world(at), far));
            } else {
                // A cut of any shape may show whatever is in the block.
                places.extend((0..ALONG).map(|step| Looked::At(world(at) + DVec3::Z * (far * share(step)))));
            }
        }
    }
    places
}
