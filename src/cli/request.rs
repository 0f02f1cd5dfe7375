//! Turns arguments into requests with commands and values, or refuses them as wrong usage.

use super::animate::AnimateRequest;
use super::args::{
    Action, DrawingArgs, IllustrateArgs, LayerAction, LayerSetArgs, NoteAction, RawArgs, RenderArgs, RestoreArgs,
    ScalarAction, SceneAction, SynthArgs, VolumeAction,
};
use super::frame::frame;
use super::page::PageRequest;
use super::review::{ModelRequest, ReviewRequest};
use super::series::SeriesRequest;
use super::view::ViewChanges;
use super::well;
use super::{assembly, extraction, interpretation};
use crate::bench;
use files::segy::{SegyOptions, WriteFormat};
use files::{ExportOptions, Format, ImportOptions, SurfaceKind};
use interp::faults::ProposeSettings;
use page::FileFormat;
use param::KDefinition;
use project::chains::illustrate::IllustrateSettings;
use project::command::{
    AddNote, AddTexture, Command, Extract, LinkVolume, Remove, RemoveScalar, Rename, ResetLayer, Restore, SetColour,
    SetLayer, SetParameterization, SetScalar, SetVelocity,
};
use project::document::{NoteEntry, Polarity};
use project::error::Noun;
use project::memory_budget;
use project::pictures::Device;
use project::pictures::scene::{ShownHorizon, ShownIsosurface, Technique, VolumeRendering};
use render::{IsosurfaceSource, Scope};
use restore::{Datum, RestoreSettings};
use std::path::{Path, PathBuf};
use std::time::Duration;
use survey::SurveyGeometry;
use synth::SynthSettings;
use ttf::{Colour, ColourMap, DepthInterval, Frequency, ScalarInterval, ScalarTtf};

/// A request.
#[derive(Debug)]
pub(super) enum Request {
    /// Make a synthetic survey and pictures of it.
    Demo { out: PathBuf },
    /// Draw a survey that nobody has interpreted.
    Illustrate { survey: PathBuf, out: PathBuf, project: PathBuf, settings: IllustrateSettings },
    /// Make a synthetic survey.
    Synth { out: PathBuf, settings: SynthSettings },
    /// An outcrop of the size and seed of the settings.
    SynthOutcrop { out: PathBuf, settings: SynthSettings },
    /// Describe a file or project.
    Info { path: PathBuf, distortion: bool, segy: SegyOptions, reading: ImportOptions },
    /// Import or link a volume; the project is created if it does not exist.
    Import { project: PathBuf, command: Command },
    /// Create a project.
    Create { project: PathBuf, geometry: Option<SurveyGeometry>, history: Option<PathBuf> },
    /// Restore a project to one of its horizons, into a new one.
    Restore { out: PathBuf, restore: Restore },
    /// Change a project.
    Change { project: PathBuf, command: Command },
    /// Measure an extraction against a truth.
    Evaluate { project: PathBuf, truth: PathBuf },
    /// Propose faults.
    ProposeFaults { project: PathBuf, settings: ProposeSettings },
    /// Save a scene that is based on one of the project or of a file.
    AddScene { project: PathBuf, name: String, from: Option<PathBuf>, view: ViewChanges },
    /// Set the colours of raw data.
    SetRaw { project: PathBuf, volume: Option<String>, map: ColourMap, range: Option<[f32; 2]> },
    /// List parts of a project.
    List { project: PathBuf, what: Listing },
    /// Extract horizon candidates.
    Extract { project: PathBuf, extract: Extract },
    /// Write the points of all candidates to a file.
    ExportCandidates { project: PathBuf, out: PathBuf },
    /// Write a horizon to a file.
    Export { project: PathBuf, out: PathBuf, surface: (SurfaceKind, String), format: Format, options: ExportOptions },
    /// Write a volume as SEG-Y, by default in the type it is stored in.
    ExportVolume { project: PathBuf, out: PathBuf, volume: String, format: Option<WriteFormat> },
    /// Write a volume to object storage.
    UploadVolume { project: PathBuf, url: String, volume: String },
    /// Write a scene's block as a 3D model.
    ExportModel(ModelRequest),
    /// Write a page for browsers.
    Review(ReviewRequest),
    /// Write the values of volumes along a horizon.
    ExportValues { project: PathBuf, out: PathBuf, horizon: String, values: Vec<String>, window: usize },
    /// Compute i, j, k.
    Parameterize {
        project: PathBuf,
        size: Option<[usize; 3]>,
        change: Option<SetParameterization>,
        memory: Option<u64>,
    },
    /// Draw a picture.
    Render(RenderRequest),
    /// Draw the stages of a history on one page.
    Series(SeriesRequest),
    /// Draw an animation.
    Animate(AnimateRequest),
    /// Make all figures of a project, with at most so many bytes of memory for the samples of a volume.
    Figures { project: PathBuf, out: PathBuf, fonts: Vec<PathBuf>, device: Device, volume_bytes: Option<u64> },
    /// Open the window.
    Window { project: Option<PathBuf>, frame_times: Option<PathBuf> },
    /// Draw all patterns.
    Patterns { out: PathBuf, project: Option<PathBuf> },
    /// Measure stages.
    Bench { sizes: bench::Sizes, dump: Option<PathBuf> },
    /// Measure how fast a SEG-Y cube is read.
    BenchSegy { side: usize, folder: PathBuf },
    /// Undo the last command.
    Undo(PathBuf),
    /// Redo the command that was undone last.
    Redo(PathBuf),
    /// Check a project without changing it.
    Check(PathBuf),
    /// Check a project and repair what can be repaired.
    Repair(PathBuf),
    /// Delete the history.
    Prune(PathBuf),
}

/// A picture to draw.
#[derive(Debug)]
pub(super) struct RenderRequest {
    pub(super) project: PathBuf,
    pub(super) out: PathBuf,
    /// Name of a scene, or a TOML file.
    pub(super) scene: Option<String>,
    pub(super) view: ViewChanges,
    pub(super) dpi: f64,
    pub(super) device: Device,
    /// Largest memory for the samples of a volume, bytes.
    pub(super) volume_bytes: Option<u64>,
    /// The options of volume rendering, if any were given.
    pub(super) volume_rendering: VolumeRendering,
    /// What is on the page; by default the block alone.
    pub(super) page: PageRequest,
    /// The format of the file.
    pub(super) format: &'static FileFormat,
}

/// What to list of a project.
#[derive(Debug)]
pub(super) enum Listing {
    /// Volumes.
    Volumes,
    /// Horizons, youngest first.
    Horizons,
    /// A horizon in detail.
    Horizon(String),
    /// Faults.
    Faults,
    /// Wells.
    Wells,
    /// A well in detail.
    Well(String),
    /// Layers and their styles.
    Layers,
    /// Scalar functions.
    Scalars,
    /// Named scenes.
    Scenes,
    /// One scene as TOML; `None`: the one that rendering starts from.
    Scene(Option<String>),
    /// Notes on places.
    Notes,
}

/// What is wrong with the usage.
pub(super) type Usage = String;

impl TryFrom<Action> for Request {
    type Error = Usage;

    fn try_from(action: Action) -> Result<Self, Usage> {
        let change = |project: PathBuf, command: Command| Self::Change { project, command };
        Ok(match action {
            Action::Demo(typed) => Self::Demo { out: typed.out },
            Action::Synth(typed) => synth(&typed)?,
            Action::Info { path, distortion, segy, reading } => Self::Info {
                distortion,
                path,
                segy: super::segy::segy_options(&segy)?,
                reading: interpretation::import_options(reading)?,
            },
            Action::View { project, frame_times } => Self::Window { project, frame_times },
            Action::Import(typed) => Self::Import {
                project: typed.project.clone(),
                command: Command::Import(interpretation::import(typed)?),
            },
            Action::Attribute(typed) => interpretation::attribute(typed)?,
            Action::Volume(action) => volume(action),
            Action::Horizon(action) => interpretation::horizon(action)?,
            Action::Fault(action) => interpretation::fault(action)?,
            Action::Well(action) => well::well(action)?,
            Action::Extract(typed) => extraction::extract(typed)?,
            Action::Illustrate(typed) => illustrate(typed)?,
            Action::Time(typed) => assembly::time(typed)?,
            Action::Pick(typed) => assembly::pick(typed)?,
            Action::Climb(typed) => assembly::climb(typed),
            Action::Descend(typed) => assembly::descend(typed),
            Action::Evaluate { project, truth } => Self::Evaluate { project, truth },
            Action::Export(typed) => interpretation::export(*typed)?,
            Action::Parameterize(typed) => {
                let size = typed.size.as_deref().map(|size| counts::<3>("--size", size)).transpose()?;
                let changes = typed.from.is_some() || typed.computed || typed.by_time;
                let change = changes.then_some(SetParameterization { from: typed.from, by_time: typed.by_time });
                let memory = interpretation::bytes("--memory", typed.memory.as_deref())?;
                Self::Parameterize { project: typed.project, size, change, memory }
            }
            Action::Render(typed) => Self::Render(render_request(*typed)?),
            Action::History(typed) => Self::Series((*typed).try_into()?),
            Action::Animate(typed) => Self::Animate((*typed).try_into()?),
            Action::Review(typed) => Self::Review(typed.try_into()?),
            Action::Note(action) => note(action)?,
            Action::Figures(typed) => {
                let (device, volume_bytes) = drawing(&typed.drawing)?;
                Self::Figures { project: typed.project, out: typed.out, fonts: typed.font, device, volume_bytes }
            }
            Action::Patterns { out, project } => Self::Patterns { out, project },
            Action::Bench(typed) => {
                let sizes = if typed.quick { bench::Sizes::Quick } else { bench::Sizes::Full };
                match typed.segy {
                    Some(folder) => Self::BenchSegy { side: if typed.quick { 128 } else { 512 }, folder },
                    None => Self::Bench { sizes, dump: typed.dump },
                }
            }
            Action::Create(typed) => {
                Self::Create { geometry: frame(&typed)?, project: typed.project, history: typed.history }
            }
            Action::Restore(typed) => restored(typed)?,
            Action::Velocity { project, velocity_m_s } => {
                change(project, Command::SetVelocity(SetVelocity { velocity_m_s }))
            }
            Action::Layer(LayerAction::List { project }) => Self::List { project, what: Listing::Layers },
            Action::Layer(LayerAction::Set(typed)) => {
                let (project, command) = set_layer(*typed)?;
                change(project, Command::SetLayer(command))
            }
            Action::Layer(LayerAction::Reset { project, layer }) => {
                change(project, Command::ResetLayer(ResetLayer { layer }))
            }
            Action::Scalar(ScalarAction::List { project }) => Self::List { project, what: Listing::Scalars },
            Action::Scalar(ScalarAction::Set { project, volume, interval }) => {
                let intervals = interval.iter().map(|text| scalar_interval(text)).collect::<Result<_, _>>()?;
                change(project, Command::SetScalar(SetScalar { function: ScalarTtf { volume, intervals } }))
            }
            Action::Scalar(ScalarAction::Remove { project, volume }) => {
                change(project, Command::RemoveScalar(RemoveScalar { volume }))
            }
            Action::Raw(typed) => raw(typed)?,
            Action::Texture(typed) => {
                change(typed.project, Command::AddTexture(AddTexture { path: typed.file, width_mm: typed.width_mm }))
            }
            Action::Scene(action) => scene(action)?,
            Action::Undo { project } => Self::Undo(project),
            Action::Redo { project } => Self::Redo(project),
            Action::Check { project, repair } => {
                if repair {
                    Self::Repair(project)
                } else {
                    Self::Check(project)
                }
            }
            Action::Prune { project } => Self::Prune(project),
        })
    }
}

/// Restores an interpretation.
fn restored(typed: RestoreArgs) -> Result<Request, Usage> {
    let dipping = typed.dip.as_deref().map(|text| numbers::<2>("--dip", text, ',')).transpose()?;
    let datum = match dipping {
        Some([dip, direction]) => Datum::Dipping { dip, direction },
        None if typed.regional => Datum::Regional,
        None => Datum::Flat,
    };
    if let Some(depth) = typed.depth.filter(|depth| !depth.is_finite()) {
        return Err(format!("--depth {depth}: expected a depth in the survey's vertical unit"));
    }
    let settings = RestoreSettings { datum, depth: typed.depth };
    Ok(Request::Restore { out: typed.out, restore: Restore { source: typed.project, to: typed.to, settings } })
}

/// Gives something another name.
pub(super) fn rename(project: PathBuf, noun: Noun, from: String, to: String) -> Request {
    Request::Change { project, command: Command::Rename(Rename { noun, from, to }) }
}

/// Removes something.
pub(super) fn remove(project: PathBuf, noun: Noun, name: String) -> Request {
    Request::Change { project, command: Command::Remove(Remove { noun, name }) }
}

/// Gives something another colour.
pub(super) fn coloured(project: PathBuf, noun: Noun, name: String, colour: &str) -> Result<Request, Usage> {
    let colour = colour.parse().map_err(|_| format!("colour {colour}: expected #rrggbb"))?;
    Ok(Request::Change { project, command: Command::SetColour(SetColour { noun, name, colour }) })
}

fn note(action: NoteAction) -> Result<Request, Usage> {
    Ok(match action {
        NoteAction::List { project } => Request::List { project, what: Listing::Notes },
        NoteAction::Add { project, text, at, scene } => {
            let at = numbers::<3>("--at", &at, ',')?;
            Request::Change { project, command: Command::AddNote(AddNote { note: NoteEntry { text, at, scene } }) }
        }
        NoteAction::Remove { project, number } => remove(project, Noun::Note, number.to_string()),
    })
}

fn set_layer(typed: LayerSetArgs) -> Result<(PathBuf, SetLayer), Usage> {
    let frequency = match &typed.frequency {
        None => None,
        Some(text) => {
            let [horizontal, vertical] = numbers::<2>("--frequency", text, ',')?;
            Some(Frequency { horizontal: horizontal as f32, vertical: vertical as f32 })
        }
    };
    let change = SetLayer {
        layer: typed.layer,
        name: typed.name,
        colour: typed.colour.as_deref().map(colour).transpose()?,
        ink: typed.ink.as_deref().map(colour).transpose()?,
        pattern: typed.pattern,
        rock: typed.rock,
        age: typed.age,
        intervals: typed.interval.iter().map(|text| depth_interval(text)).collect::<Result<_, _>>()?,
        frequency,
        opacity: typed.opacity,
        k: typed.k.as_deref().map(k_definition).transpose()?,
        style: None,
    };
    if change == (SetLayer { layer: change.layer.clone(), ..SetLayer::default() }) {
        return Err(
            "layer set: nothing to change; give --name, --pattern, --rock, --colour or another option".to_owned()
        );
    }
    Ok((typed.project, change))
}

fn k_definition(text: &str) -> Result<KDefinition, Usage> {
    match text {
        "flow" => Ok(KDefinition::Flow),
        "harmonic" => Ok(KDefinition::Harmonic),
        "distance" | "distance-ratio" => Ok(KDefinition::DistanceRatio),
        "proportional" => Ok(KDefinition::Proportional),
        "parallel-to-bottom" => Ok(KDefinition::ParallelToBottom),
        "parallel-to-top" => Ok(KDefinition::ParallelToTop),
        other => Err(format!(
            "--k {other}: expected flow, harmonic, distance, proportional, parallel-to-bottom or parallel-to-top"
        )),
    }
}

fn illustrate(typed: IllustrateArgs) -> Result<Request, Usage> {
    if typed.layers < 2 {
        return Err(format!("--layers {}: expected at least 2", typed.layers));
    }
    page_format(&typed.out)?;
    let (device, volume_bytes) = drawing(&typed.drawing)?;
    let settings = IllustrateSettings {
        layers: typed.layers,
        options: super::segy::segy_options(&typed.segy)?,
        device,
        volume_bytes: volume_bytes.unwrap_or_else(memory_budget::half_of_available),
    };
    let project = typed.project.unwrap_or_else(|| typed.out.with_extension("petro"));
    Ok(Request::Illustrate { survey: typed.survey, out: typed.out, project, settings })
}

fn synth(typed: &SynthArgs) -> Result<Request, Usage> {
    let snr = match typed.snr.as_str() {
        "none" => None,
        text => match text.parse::<f64>() {
            Ok(snr) if snr > 0.0 && snr.is_finite() => Some(snr),
            _ => return Err(format!("--snr {text}: expected a positive number or none")),
        },
    };
    let settings = SynthSettings {
        size: counts::<3>("--size", &typed.size)?,
        seed: typed.seed,
        snr,
        salt: typed.salt,
        ..SynthSettings::default()
    };
    let out = typed.out.clone();
    Ok(if typed.overturned { Request::SynthOutcrop { out, settings } } else { Request::Synth { out, settings } })
}

fn render_request(typed: RenderArgs) -> Result<RenderRequest, Usage> {
    let technique = match typed.technique.as_deref() {
        None => None,
        Some("illustrate") => Some(Technique::Illustrate),
        Some("occlusion") => Some(Technique::Occlusion),
        Some("phong") => Some(Technique::Phong),
        Some("interleaved") => Some(Technique::Interleaved),
        Some("volume") => Some(Technique::Volume),
        // A map is a figure, not a technique of the block.
        Some("map") => None,
        Some(other) => {
            return Err(format!(
                "--technique {other}: expected illustrate, occlusion, phong, interleaved, volume or map"
            ));
        }
    };
    if !(typed.clear_below >= -1.0 && typed.clear_below < 1.0) {
        return Err(format!("--clear-below {}: expected -1 to less than 1", typed.clear_below));
    }
    let (device, volume_bytes) = drawing(&typed.drawing)?;
    if !(typed.dpi >= 1.0 && typed.dpi <= 10_000.0) {
        return Err(format!("--dpi {}: expected 1 to 10000", typed.dpi));
    }
    let is_map = typed.technique.as_deref() == Some("map");
    Ok(RenderRequest {
        page: PageRequest::meant(typed.figure, is_map)?,
        format: page_format(&typed.out)?,
        project: typed.project,
        out: typed.out,
        scene: typed.scene,
        view: typed.view.try_into()?,
        dpi: typed.dpi,
        volume_bytes,
        device,
        volume_rendering: VolumeRendering {
            technique,
            medium: typed.medium,
            clear_below: typed.clear_below,
            horizons: typed.horizon.iter().map(|text| shown_horizon(text)).collect::<Result<_, _>>()?,
            isosurfaces: typed.isosurface.iter().map(|text| shown_isosurface(text)).collect::<Result<_, _>>()?,
            scope: match typed.scope.as_str() {
                "everywhere" => Scope::Everywhere,
                "near" => Scope::NearHorizons,
                "away" => Scope::AwayFromHorizons,
                other => return Err(format!("--scope {other}: expected everywhere, near or away")),
            },
        },
    })
}

/// The kind of file that the ending of a name says.
pub(super) fn page_format(out: &Path) -> Result<&'static FileFormat, Usage> {
    FileFormat::of_page(out)
        .ok_or_else(|| format!("{}: its name must end in {}", out.display(), page::endings_of_pages()))
}

/// What draws, and the largest memory for the samples of a volume, bytes.
pub(super) fn drawing(typed: &DrawingArgs) -> Result<(Device, Option<u64>), Usage> {
    let device = match typed.device.as_str() {
        "auto" => Device::Auto,
        "gpu" => Device::Gpu,
        "cpu" => Device::Cpu,
        other => return Err(format!("--device {other}: expected auto, gpu or cpu")),
    };
    Ok((device, interpretation::bytes("--volume-memory", typed.volume_memory.as_deref())?))
}

/// `NAME[,#RRGGBB[,OPACITY[,LIGHT]]]`
fn shown_horizon(text: &str) -> Result<ShownHorizon, Usage> {
    let mut parts = text.split(',');
    let name = parts.next().unwrap_or_default().to_owned();
    let colour = parts.next().map(colour).transpose()?;
    let mut number = |unless: f32| match parts.next() {
        None => Ok(unless),
        Some(part) => part.parse::<f32>().map_err(|_| format!("--horizon {text}: {part} is not a number")),
    };
    let (opacity, emission) = (number(1.0)?, number(0.0)?);
    if parts.next().is_some() {
        return Err(format!("--horizon {text}: expected NAME,#RRGGBB,OPACITY,LIGHT"));
    }
    Ok(ShownHorizon { name, colour, opacity, emission })
}

/// `NAME,VALUE[,#RRGGBB[,OPACITY]]`
fn shown_isosurface(text: &str) -> Result<ShownIsosurface, Usage> {
    let usage = || format!("--isosurface {text}: expected NAME,VALUE[,#RRGGBB[,OPACITY]]");
    let parts: Vec<&str> = text.split(',').collect();
    let number = |part: &str| part.parse::<f32>().map_err(|_| usage());
    let ([name, value] | [name, value, _] | [name, value, _, _]) = parts[..] else { return Err(usage()) };
    Ok(ShownIsosurface {
        of: if name == "k" { IsosurfaceSource::Depth } else { IsosurfaceSource::Volume(name.to_owned()) },
        value: number(value)?,
        colour: parts.get(2).map(|part| colour(part)).transpose()?,
        opacity: parts.get(3).map_or(Ok(1.0), |part| number(part))?,
    })
}

fn colour(text: &str) -> Result<Colour, Usage> {
    text.parse().map_err(|error: ttf::TtfError| error.to_string())
}

/// `LOW,HIGH,PATTERN[,OPACITY]`
fn depth_interval(text: &str) -> Result<DepthInterval, Usage> {
    let usage = || format!("--interval {text}: expected LOW,HIGH,PATTERN or LOW,HIGH,PATTERN,OPACITY");
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let number = |part: &str| part.parse::<f32>().map_err(|_| usage());
    let (low, high, texture, opacity) = match parts[..] {
        [low, high, texture] => (number(low)?, number(high)?, texture, 1.0),
        [low, high, texture, opacity] => (number(low)?, number(high)?, texture, number(opacity)?),
        _ => return Err(usage()),
    };
    Ok(DepthInterval { k: [low, high], texture: texture.to_owned(), frequency: None, opacity, colour: None })
}

/// `LOW,HIGH,PATTERN[,OPACITY[,H,V]]`
fn scalar_interval(text: &str) -> Result<ScalarInterval, Usage> {
    let usage = || {
        format!(
            "--interval {text}: expected LOW,HIGH,PATTERN, LOW,HIGH,PATTERN,OPACITY or LOW,HIGH,PATTERN,OPACITY,H,V"
        )
    };
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let number = |part: &str| part.parse::<f32>().map_err(|_| usage());
    let (low, high, texture, opacity, factor) = match parts[..] {
        [low, high, texture] => (low, high, texture, 1.0, [1.0; 2]),
        [low, high, texture, opacity] => (low, high, texture, number(opacity)?, [1.0; 2]),
        [low, high, texture, opacity, h, v] => (low, high, texture, number(opacity)?, [number(h)?, number(v)?]),
        _ => return Err(usage()),
    };
    let range = [number(low)?, number(high)?];
    Ok(ScalarInterval { range, texture: texture.to_owned(), factor, opacity, colour: None, ink: None })
}

fn raw(typed: RawArgs) -> Result<Request, Usage> {
    let map = ColourMap::from_name(&typed.map).ok_or_else(|| {
        format!("--map {}: expected one of {}", typed.map, ColourMap::ALL.map(ColourMap::name).join(", "))
    })?;
    let range = typed.range.as_deref().map(|text| numbers::<2>("--range", text, ',')).transpose()?;
    let range = range.map(|range| range.map(|value| value as f32));
    Ok(Request::SetRaw { project: typed.project, volume: typed.volume, map, range })
}

/// A time that is waited for.
pub(super) fn seconds(option: &str, value: f64) -> Result<Duration, Usage> {
    Duration::try_from_secs_f64(value).map_err(|_| format!("{option} {value}: expected a number of seconds from 0"))
}

/// Exactly N finite numbers.
pub(super) fn numbers<const N: usize>(option: &str, text: &str, separator: char) -> Result<[f64; N], Usage> {
    let parsed: Option<Vec<f64>> =
        text.split(separator).map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    parsed
        .and_then(|values| values.try_into().ok())
        .ok_or_else(|| format!("{option} {text}: expected {N} numbers separated by `{separator}`"))
}

/// N positive counts separated by `x`.
pub(super) fn counts<const N: usize>(option: &str, text: &str) -> Result<[usize; N], Usage> {
    let parsed: Option<Vec<usize>> =
        text.split(['x', 'X', '×']).map(|part| part.trim().parse().ok().filter(|&count| count > 0)).collect();
    parsed
        .and_then(|values| values.try_into().ok())
        .ok_or_else(|| format!("{option} {text}: expected {N} counts such as {}", ["64"; N].join("x")))
}

/// What is asked for about volumes.
fn volume(action: VolumeAction) -> Request {
    match action {
        VolumeAction::List { project } => Request::List { project, what: Listing::Volumes },
        VolumeAction::Link { project, url, name } => {
            let link = LinkVolume { url, name, polarity: Polarity::default() };
            Request::Import { project, command: Command::LinkVolume(link) }
        }
        VolumeAction::Rename { project, from, to } => rename(project, Noun::Volume, from, to),
        VolumeAction::Remove { project, name } => remove(project, Noun::Volume, name),
    }
}

/// What is asked for with scenes.
fn scene(action: SceneAction) -> Result<Request, Usage> {
    Ok(match action {
        SceneAction::List { project } => Request::List { project, what: Listing::Scenes },
        SceneAction::Show { project, name } => Request::List { project, what: Listing::Scene(name) },
        SceneAction::Add(typed) => Request::AddScene {
            project: typed.project,
            name: typed.name,
            from: typed.from,
            view: typed.view.try_into()?,
        },
        SceneAction::Rename { project, from, to } => rename(project, Noun::Scene, from, to),
        SceneAction::Remove { project, name } => remove(project, Noun::Scene, name),
    })
}
