//! `petroglyph illustrate`: a block diagram of a survey that nobody has interpreted.
//!
//! SEG-Y → import → candidates → faults where both sides match after a throw → geologic time → layers between its
//! strongest, most continuous levels, and bodies where what reflects is isolated → patterns by the character of the
//! reflections → a block with a legend. The project is kept, to go on from. A pattern does not claim a rock: the legend says
//! how the reflections look, and the title says that nothing was interpreted.

use crate::Project;
use crate::command::{
    AcceptFault, Command, ComputeTime, Extract, ImportVolume, OutlineBodies, PickByTime, ProposeFaults, SetLayer,
    TimeLevel, isolated,
};
use crate::document::{Document, Polarity};
use crate::error::ProjectError;
use crate::folder::refuse_inside_project;
use crate::interpretation::proposals;
use crate::interpretation::times::Times;
use crate::pictures::Device;
use crate::pictures::figures::{self, FigureSettings, InterpreterView};
use crate::pictures::scene;
use figure::{Annotation, BlockPart, Figure, PageSize};
use files::segy::SegyOptions;
use interp::ExtractSettings;
use page::FileFormat;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Instant;
use survey::Progress;
use time::{Character, TimeSettings, characters, strongest_levels};
use ttf::Colour;

/// How a survey is illustrated.
#[derive(Debug, Clone)]
pub struct IllustrateSettings {
    /// Number of layers; fewer are drawn where fewer levels stand out.
    pub layers: usize,
    /// How the SEG-Y file is read.
    pub options: SegyOptions,
    /// Device that draws.
    pub device: Device,
    /// Largest memory for the samples of a volume, bytes.
    pub volume_bytes: u64,
}

/// What was illustrated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Illustrated {
    /// The picture.
    pub file: PathBuf,
    /// The project, to go on from.
    pub project: PathBuf,
    /// The layers, top first.
    pub layers: Vec<String>,
    /// Seconds from the file to the picture.
    pub seconds: f64,
}

impl fmt::Display for Illustrated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {} layers, not interpreted", self.file.display(), self.layers.len())?;
        self.layers.iter().try_for_each(|layer| writeln!(f, "  {layer}"))?;
        write!(f, "the project to go on from is {}; {:.1} s", self.project.display(), self.seconds)
    }
}

/// Name of the volume of amplitudes.
const SEISMIC: &str = "seismic";
/// Size of the page, cm.
const PAGE_CM: [f64; 2] = [20.0, 13.0];
/// Its resolution, dots an inch.
const DPI: f64 = 200.0;
const TITLE: &str = "Uninterpreted: layers by computed geologic time";

/// Colours of the layers from the top: each differs from the next, and none claims a rock.
const COLOURS: [[u8; 3]; 8] = [
    [0xE9, 0xDD, 0xB8],
    [0xC9, 0xB9, 0x8F],
    [0xD9, 0xC7, 0xC0],
    [0xA9, 0xBC, 0xB4],
    [0xE0, 0xC8, 0x9A],
    [0xB7, 0xA8, 0xB0],
    [0xCF, 0xD2, 0xB5],
    [0xB4, 0x9C, 0x86],
];

/// Makes the picture and the project beside it.
///
/// # Errors
/// There is already something at `project`, the file is no survey, no level of time stands out, a file could not be
/// written, or the user cancelled. Without a picture there is no project either, unless drawing failed.
pub fn run(
    survey: &Path,
    out: &Path,
    project: &Path,
    settings: &IllustrateSettings,
    progress: &Progress,
) -> Result<Illustrated, ProjectError> {
    let start = Instant::now();
    refuse_inside_project(out)?;
    let format = FileFormat::of_page(out).unwrap_or(FileFormat::usual());
    let mut new = Project::create(project, None)?;
    let layers = build(new.project(), survey, settings, progress)?;
    let project = new.publish()?;
    let document = project.document();
    let mut scene = scene::choose(document, None)?;
    // The topmost layer is one of those that were asked for, not air.
    scene.ground = None;
    scene::prepare(document, &mut scene, progress)?;
    let figure = Figure {
        size: PageSize::Cm(PAGE_CM),
        dpi: DPI,
        parts: vec![BlockPart { scene, ..BlockPart::default() }.into()],
        legend: true,
        scale_bar: true,
        annotate: vec![Annotation::Axes, Annotation::Provenance],
        title: Some(TITLE.to_owned()),
        caption: Some(caption(document)),
        ..Figure::default()
    };
    let drawing = FigureSettings {
        format,
        device: settings.device,
        volume_bytes: settings.volume_bytes,
        fonts: Vec::new(),
        picture_dpi: None,
    };
    let (made, _) = figures::make(&project, &figure, &InterpreterView::default(), &drawing, progress)?;
    figures::write(&made.page, format, out, DPI, &project.title())?;
    Ok(Illustrated {
        file: out.to_owned(),
        project: project.root().to_owned(),
        layers,
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// What the boundaries are, and what patterns say.
fn caption(document: &Document) -> String {
    let has_bodies = !document.outlined().is_empty();
    let bodies = if has_bodies { " Bodies lie between two reflections that meet all around their rim." } else { "" };
    format!(
        "Boundaries are level surfaces of a geologic time that was computed from the reflections alone; patterns show how \
         strong and how continuous the reflections are, not which rock it is.{bodies}"
    )
}

/// Everything up to the styles; returns the names of the layers.
fn build(
    project: &mut Project,
    survey: &Path,
    settings: &IllustrateSettings,
    progress: &Progress,
) -> Result<Vec<String>, ProjectError> {
    let import = ImportVolume {
        path: survey.to_owned(),
        name: Some(SEISMIC.to_owned()),
        polarity: Polarity::Normal,
        options: settings.options.clone(),
        memory_bytes: None,
        moved: false,
        origin: None,
    };
    project.apply(&Command::Import(import), progress)?;
    layers_by_time(project, settings.layers, progress)
}

/// Most isolated bodies that are drawn.
const MOST_BODIES: usize = 3;
/// Samples above and below a body that its reflections take up.
const BESIDE_BODY: f32 = 3.0;
/// How a body looks: neither layered nor of a colour of the layers.
const ISOLATED: (&str, &str) = ("strong, isolated", "plain");
const BODY_COLOUR: [u8; 3] = [0xC8, 0x7A, 0x62];

/// Number of layers where none is stated.
pub const LAYERS: usize = 6;

/// Gives a project with a volume and without horizons layers between levels of geologic time, outlines of isolated
/// bodies, and styles by the character of the reflections; what was extracted, the faults and geologic time are taken as
/// they are where they exist. Returns the names of the layers. Each step can be undone.
///
/// # Errors
/// No level of time stands out, data are damaged, or the user cancelled.
pub fn layers_by_time(project: &mut Project, layers: usize, progress: &Progress) -> Result<Vec<String>, ProjectError> {
    if project.document().extraction.is_none() {
        project.apply(
            &Command::Extract(Extract {
                volume: None,
                settings: ExtractSettings::default(),
                memory_bytes: None,
                just_stored: false,
            }),
            progress,
        )?;
    }
    if project.document().faults.is_empty() {
        accept_faults(project, progress)?;
    }
    if project.document().geologic_time().is_none() {
        let time = ComputeTime { name: "time".to_owned(), settings: TimeSettings::default(), memory_bytes: None };
        project.apply(&Command::Time(time), progress)?;
    }
    let times = Times::load(project.facts(), progress)?;
    let bodies = isolated(&times, MOST_BODIES, project.document().frame()?);
    // What reflects in a body is the body's: no level is drawn for it, nor does it count for the layers around it.
    let mut beside = Cow::Borrowed(&times.amplitudes);
    bodies.iter().for_each(|(body, _)| body.blank(beside.to_mut(), BESIDE_BODY));
    let levels = strongest_levels(&times.tau, &beside, layers.saturating_sub(1));
    if levels.is_empty() {
        return Err(ProjectError::NoLevels);
    }
    let chosen: Vec<f32> = levels.iter().map(|level| level.time).collect();
    let found = characters(&times.tau, &beside, &chosen);
    drop(beside);
    drop(times);
    for (n, level) in levels.iter().enumerate() {
        let pick = PickByTime { level: TimeLevel::Chosen(level.time), horizon: format!("Level {}", n + 1) };
        project.apply(&Command::PickByTime(pick), progress)?;
    }
    if !bodies.is_empty() {
        let outlines = OutlineBodies { name: "Body".to_owned(), most: MOST_BODIES };
        project.apply(&Command::OutlineBodies(outlines), progress)?;
    }
    let layered = found.iter().zip(COLOURS.into_iter().cycle()).map(|(character, colour)| (look(character), colour));
    let looks = layered.chain(bodies.iter().map(|_| (ISOLATED, BODY_COLOUR)));
    let mut names = Vec::new();
    for (n, (layer, ((words, pattern), [r, g, b]))) in project.document().layers().into_iter().zip(looks).enumerate() {
        let name = format!("{}: {words}", n + 1);
        let style = SetLayer {
            layer,
            name: Some(name.clone()),
            pattern: Some(pattern.to_owned()),
            colour: Some(Colour::new(r, g, b)),
            ..SetLayer::default()
        };
        project.apply(&Command::SetLayer(style), progress)?;
        names.push(name);
    }
    Ok(names)
}

/// Adds the faults that are found in the volume, but for those that only may be ones.
fn accept_faults(project: &mut Project, progress: &Progress) -> Result<(), ProjectError> {
    project.apply(&Command::ProposeFaults(ProposeFaults::default()), progress)?;
    for proposal in proposals::open(project.root(), project.document()).iter().filter(|proposal| !proposal.is_minor) {
        let accept = AcceptFault { id: proposal.id, name: proposal.name.clone() };
        project.apply(&Command::AcceptFault(accept), progress)?;
    }
    Ok(())
}

/// Continuity above which reflections count as continuous, and below which as chaotic.
const CONTINUOUS: f32 = 0.4;
const CHAOTIC: f32 = 0.12;
/// Strength above which reflections count as strong, and below which as weak; 1 is usual.
const STRONG: f32 = 1.1;
const WEAK: f32 = 0.8;

/// The words and the pattern for a character of reflections.
fn look(character: &Character) -> (&'static str, &'static str) {
    let Character { strength, continuity } = *character;
    let is_continuous = continuity >= CONTINUOUS;
    match () {
        () if continuity < CHAOTIC => ("chaotic", "breccia"),
        () if strength >= STRONG && is_continuous => ("strong, continuous", "limestone-shale"),
        () if strength >= STRONG => ("strong, discontinuous", "sandstone-crossbedded"),
        () if strength < WEAK && is_continuous => ("weak, continuous", "shale"),
        () if strength < WEAK => ("weak, discontinuous", "siltstone"),
        () if is_continuous => ("continuous", "sandstone-shale"),
        () => ("discontinuous", "sandstone-bedded"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_follow_strength_and_continuity() {
        let words = |strength, continuity| look(&Character { strength, continuity }).0;
        assert_eq!(words(1.4, 0.7), "strong, continuous");
        assert_eq!(words(0.5, 0.2), "weak, discontinuous");
        assert_eq!(words(2.0, 0.05), "chaotic");
        assert_eq!(words(1.0, 0.5), "continuous");
    }
}
