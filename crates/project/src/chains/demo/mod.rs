//! `petroglyph demo`: the whole chain on a synthetic survey, through files and commands as a user would take it.
//!
//! Synthetic survey → SEG-Y and fault files → import → candidates → picks, one on each part of each horizon → layers →
//! parameterization → three pictures: illustrative, raw, and half-way between. Of the truth only one place on each part
//! is used, which anyone who sees the reflector could point at. The styles are in `look.toml`.

pub mod survey_files;

use crate::Project;
use crate::command::{
    AddFault, AddScene, Climb, Command, Effect, Extract, FillHorizon, ImportVolume, PickNode, SetContact, SetLayer,
};
use crate::content;
use crate::derived::FaultBlocks;
use crate::document::Polarity;
use crate::error::{Noun, ProjectError};
use crate::interpretation::candidates::Candidates;
use crate::pictures::load::{self, Request, Stage};
use crate::pictures::{Device, Painter};
use files::ImportOptions;
use files::segy::SegyOptions;
use interp::ExtractSettings;
use interp::assembly::Operation;
use interp::holes::FillSettings;
use reference::evaluation::Parts;
use render::Scene;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use survey::{Contact, Progress};
use survey_files::SynthSurvey;
use synth::SynthSettings;
use system::file::FileAction;

/// The survey, the patterns and the scene of the demonstration.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Look {
    synth: SynthSettings,
    /// Shares of the block along inlines and crosslines that are cut away at the nearest corner.
    cut_share: [f64; 2],
    scene: Scene,
    layers: Vec<SetLayer>,
}

/// Pictures by name and blend.
const PICTURES: [(&str, f32); 3] = [("illustrative", 0.0), ("raw", 1.0), ("half-way", 0.5)];

/// Resolution of the pictures.
const DPI: f64 = 220.0;

/// What the demonstration made.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Demonstration {
    /// The project.
    pub project: PathBuf,
    /// The pictures.
    pub pictures: Vec<PathBuf>,
    /// Seconds by stage.
    pub stages: Vec<Stage>,
    /// A log of what was done.
    pub steps: Vec<String>,
}

impl fmt::Display for Demonstration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.steps.iter().try_for_each(|step| writeln!(f, "{step}"))?;
        for stage in &self.stages {
            writeln!(f, "  {:<18} {:>6.1} s", stage.stage, stage.seconds)?;
        }
        self.pictures.iter().try_for_each(|path| writeln!(f, "{}", path.display()))
    }
}

/// Runs the chain and leaves its files in `out`.
///
/// # Errors
/// A file could not be written, there is no device to draw with, or the user cancelled.
pub fn run(out: &Path, progress: &Progress) -> Result<Demonstration, ProjectError> {
    let look: Look = toml::from_str(include_str!("look.toml")).expect("the look is part of the program");
    fs::create_dir_all(out).map_err(|source| ProjectError::io(FileAction::Written, out, source))?;
    let mut done =
        Demonstration { project: out.join("demo.petro"), pictures: Vec::new(), stages: Vec::new(), steps: Vec::new() };
    let mut stage = Stopwatch::start();

    let folder = out.join("survey");
    let files = survey_files::write(&folder, &look.synth, progress)?;
    let [inlines, crosslines, samples] = look.synth.size;
    done.steps.push(format!(
        "made a synthetic survey of {inlines} x {crosslines} x {samples} samples with {} horizons and {} faults in {}",
        files.horizons.len(),
        files.faults.len(),
        folder.display()
    ));
    done.stages.push(stage.lap("synthetic survey"));

    let mut project = build_project(&done.project, &files, progress)?;
    done.steps.push(format!("imported volumes and faults into {}", done.project.display()));
    done.stages.push(stage.lap("import"));

    let extract =
        Extract { volume: None, settings: ExtractSettings::default(), memory_bytes: None, just_stored: false };
    if let Effect::Extracted(found) = project.apply(&Command::Extract(extract), progress)? {
        done.steps.push(format!("found {} candidates with {} leaves", found.report.surfaces, found.report.leaves));
    }
    done.stages.push(stage.lap("candidates"));
    let picks = assemble(&mut project, &files, progress)?;
    done.steps.push(format!("assembled {} horizons by {picks} picks", files.horizons.len()));
    done.stages.push(stage.lap("picks"));
    style(&mut project, &files, &look, progress)?;
    let frame = project.document().frame()?.clone();
    let mut scene = look.scene.clone();
    let block = scene.box_in(&frame);
    scene.cut_outs = vec![block.corner_cut(scene.view(&frame).nearest_corner(&block), look.cut_share)];
    for (name, blend) in PICTURES {
        let scene = Scene { blend, ..scene.clone() };
        project.apply(&Command::AddScene(AddScene { name: name.to_owned(), scene }), progress)?;
    }
    // The half-way picture needs everything that all three need.
    let loaded = load::load(project.facts(), &Request::new(&Scene { blend: 0.5, ..scene.clone() }), progress)?;
    done.stages.extend(loaded.rock.iter().flat_map(|rock| rock.stages.clone()));
    let mut painter = Painter::new(Device::Auto, progress)?;
    for (name, blend) in PICTURES {
        let (image, drawn) = painter.draw(&Scene { blend, ..scene.clone() }, &loaded, progress)?;
        let path = out.join(format!("{name}.png"));
        crate::pictures::write_png(&path, &image, DPI)?;
        done.stages.push(drawn);
        done.pictures.push(path);
    }
    done.steps.push("cut the block at a corner and drew it illustrative, raw and half-way".to_owned());
    Ok(done)
}

/// Imports volumes and faults through the same commands as the command line.
fn build_project(path: &Path, files: &SynthSurvey, progress: &Progress) -> Result<Project, ProjectError> {
    // A former demonstration is replaced; anything else of that name is not removed.
    if path.join("project.toml").exists() {
        fs::remove_dir_all(path).map_err(|source| ProjectError::io(FileAction::Written, path, source))?;
    }
    let mut new = Project::create(path, None)?;
    let project = new.project();
    let import = |path: &Path, name: &str| {
        Command::Import(ImportVolume {
            path: path.to_owned(),
            name: Some(name.to_owned()),
            polarity: Polarity::Normal,
            options: SegyOptions::default(),
            memory_bytes: None,
            moved: false,
            origin: None,
        })
    };
    project.apply(&import(&files.survey, "seismic"), progress)?;
    project.apply(&import(&files.attribute, "impedance"), progress)?;
    for fault in &files.faults {
        let command = AddFault {
            path: fault.file.clone(),
            name: fault.name.clone(),
            truncated_by: fault.truncated_by.clone(),
            grown_m: 0.0,
            options: ImportOptions::default(),
        };
        project.apply(&Command::AddFault(command), progress)?;
    }
    new.publish()
}

/// Parts of a horizon with fewer traces are not picked.
const FEWEST_TRACES: usize = 200;

/// How many times a horizon is checked for what its picks have left out.
const LOOKS: usize = 2;

/// Samples within which a place of a horizon counts as picked.
const NEAR_SAMPLES: f64 = 2.0;

/// Picks every part of every horizon, then the middle of what these picks left out, climbing to the highest valid node,
/// and fills the holes. Returns the number of picks.
fn assemble(project: &mut Project, files: &SynthSurvey, progress: &Progress) -> Result<usize, ProjectError> {
    let truth = survey_files::read_truth(&files.truth)?;
    let frame = project.document().frame()?.clone();
    // Held for all picks, so that the candidates are read only once.
    let _candidates = Candidates::load(project.facts(), progress)?;
    let _blocks = project.facts().get(&FaultBlocks, progress)?;
    let mut picks = 0;
    for (h, horizon) in files.horizons.iter().enumerate() {
        let parts = Parts::of(&truth, h);
        let mut left = parts.clone();
        for _ in 0..LOOKS {
            for place in left.middles(&truth, h, FEWEST_TRACES) {
                let lines = frame.lines_from_voxel(place.truncate());
                let pick = PickNode {
                    at: [lines.x, lines.y, frame.vertical.value_at(place.z)],
                    horizon: horizon.name.clone(),
                    climb: Climb::HighestValid,
                    operation: Operation::Add,
                    colour: None,
                };
                match project.apply(&Command::Pick(pick), progress) {
                    Ok(Effect::Picked(_)) => picks += 1,
                    // A part that is lost in noise, or that another pick has covered.
                    Err(ProjectError::NoCandidate { .. } | ProjectError::AlreadyPicked { .. }) | Ok(_) => {}
                    Err(error) => return Err(error),
                }
            }
            let document = project.document();
            let Ok(entry) = document.position(Noun::Horizon, &horizon.name) else { continue };
            let picked = content::read_horizon(project.root(), &document.horizons[entry], progress)?;
            let ny = truth.size[1];
            left = parts.without(&truth, h, |x, y, z| {
                let depths = picked.sheets.iter().map(|sheet| f64::from(sheet.depth[x * ny + y]));
                depths.into_iter().any(|depth| (frame.vertical.index_of(depth) - z).abs() <= NEAR_SAMPLES)
            });
        }
        let fill = FillHorizon { name: horizon.name.clone(), settings: FillSettings::default() };
        project.apply(&Command::FillHorizon(fill), progress)?;
        if horizon.contact != Contact::Conformable {
            let contact = SetContact { horizon: horizon.name.clone(), contact: horizon.contact };
            project.apply(&Command::SetContact(contact), progress)?;
        }
    }
    Ok(picks)
}

/// Names and patterns of the layers.
fn style(project: &mut Project, files: &SynthSurvey, look: &Look, progress: &Progress) -> Result<(), ProjectError> {
    let named: Vec<(String, String)> =
        project.document().layers().into_iter().zip(files.layer_names.iter().cloned()).collect();
    let names = named.into_iter().map(|(layer, name)| SetLayer { layer, name: Some(name), ..SetLayer::default() });
    for style in names.chain(look.layers.iter().cloned()) {
        project.apply(&Command::SetLayer(style), progress)?;
    }
    Ok(())
}

/// Times stages one after the other.
struct Stopwatch(Instant);

impl Stopwatch {
    fn start() -> Self {
        Self(Instant::now())
    }

    fn lap(&mut self, stage: &'static str) -> Stage {
        let lap = Stage::new(stage, self.0.elapsed());
        self.0 = Instant::now();
        lap
    }
}
