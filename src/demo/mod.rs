//! `petroglyph demo`: the whole chain on a synthetic survey, through files and commands as a user would go.
//!
//! Synthetic survey → SEG-Y and interpretation files → import → layers → parameterization → three pictures: illustrative, raw, and half-way between.
//! The look is in `look.toml`.

use crate::command::{AddFault, AddHorizon, AddScene, Age, Command, ImportVolume, SetLayer};
use crate::picture::{self, Device, Painter};
use crate::pipeline::{self, Stage};
use crate::project::{Polarity, Project};
use crate::synth::{self, SynthSurvey};
use anyhow::Context;
use render::Scene;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use survey::Progress;
use survey::formats::ImportOptions;
use survey::segy::SegyOptions;
use survey::synth::SynthSettings;

/// Survey, patterns and view.
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

/// What the demonstration left behind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Demonstration {
    /// The project.
    pub project: PathBuf,
    /// The pictures.
    pub pictures: Vec<PathBuf>,
    /// Seconds by stage.
    pub stages: Vec<Stage>,
    /// What was done, in order.
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
/// Files that could not be written, no device to draw with, or cancelled.
pub fn run(out: &Path, progress: &Progress) -> anyhow::Result<Demonstration> {
    let look: Look = toml::from_str(include_str!("look.toml")).context("the demonstration's look cannot be read")?;
    fs::create_dir_all(out).with_context(|| format!("{} could not be made", out.display()))?;
    let mut done =
        Demonstration { project: out.join("demo.petro"), pictures: Vec::new(), stages: Vec::new(), steps: Vec::new() };
    let mut stage = Stopwatch::start();

    let folder = out.join("survey");
    let files = synth::write(&folder, &look.synth, progress)?;
    let [inlines, crosslines, samples] = look.synth.size;
    done.steps.push(format!(
        "made a synthetic survey of {inlines} x {crosslines} x {samples} samples with {} horizons and {} faults in {}",
        files.horizons.len(),
        files.faults.len(),
        folder.display()
    ));
    done.stages.push(stage.lap("synthetic survey"));

    let mut project = build_project(&done.project, &files, &look, progress)?;
    let frame = project.document().frame()?.clone();
    let mut scene = look.scene.clone();
    let block = scene.box_in(&frame);
    scene.cut_outs = vec![block.corner_cut(scene.view(&frame).nearest_corner(&block), look.cut_share)];
    for (name, blend) in PICTURES {
        let scene = Scene { blend, ..scene.clone() };
        project.apply(&Command::AddScene(AddScene { name: name.to_owned(), scene }), progress)?;
    }
    done.steps.push(format!("imported them into {}", done.project.display()));
    done.stages.push(stage.lap("import"));

    // What the half-way picture needs is what all of them need.
    let loaded = pipeline::load(&project, &Scene { blend: 0.5, ..scene.clone() }, progress)?;
    done.stages.extend(loaded.rock.iter().flat_map(|rock| rock.stages.clone()));
    let mut painter = Painter::new(Device::Auto, progress)?;
    for (name, blend) in PICTURES {
        let (image, drawn) = painter.draw(&Scene { blend, ..scene.clone() }, &loaded, progress)?;
        let path = out.join(format!("{name}.png"));
        picture::write_png(&path, &image, DPI)?;
        done.stages.push(drawn);
        done.pictures.push(path);
    }
    done.steps.push("cut the block at a corner and drew it illustrative, raw and half-way".to_owned());
    Ok(done)
}

/// Imports everything through the same commands as the command line.
fn build_project(path: &Path, files: &SynthSurvey, look: &Look, progress: &Progress) -> anyhow::Result<Project> {
    // A former demonstration is replaced; anything else of that name is not ours to remove.
    if path.join("project.toml").exists() {
        fs::remove_dir_all(path).with_context(|| format!("{} could not be replaced", path.display()))?;
    }
    let mut new = Project::create(path, None)?;
    let project = new.project();
    let import = |path: &Path, name: &str| {
        Command::Import(ImportVolume {
            path: path.to_owned(),
            name: Some(name.to_owned()),
            polarity: Polarity::Normal,
            options: SegyOptions::default(),
        })
    };
    project.apply(&import(&files.survey, "seismic"), progress)?;
    project.apply(&import(&files.attribute, "impedance"), progress)?;
    for horizon in &files.horizons {
        let command = AddHorizon {
            path: horizon.file.clone(),
            name: horizon.name.clone(),
            contact: horizon.contact,
            age: Age::ByDepth,
            options: ImportOptions::default(),
        };
        project.apply(&Command::AddHorizon(command), progress)?;
    }
    for fault in &files.faults {
        let command = AddFault {
            path: fault.file.clone(),
            name: fault.name.clone(),
            truncated_by: fault.truncated_by.clone(),
            options: ImportOptions::default(),
        };
        project.apply(&Command::AddFault(command), progress)?;
    }
    let named = project.document().layers().into_iter().zip(&files.layer_names);
    let names = named.map(|(layer, name)| SetLayer { layer, name: Some(name.clone()), ..SetLayer::default() });
    for style in names.chain(look.layers.iter().cloned()) {
        project.apply(&Command::SetLayer(style), progress)?;
    }
    Ok(new.publish()?)
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
