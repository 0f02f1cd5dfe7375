//! `petroglyph history`: the block after each event of its geological history, or restored to its horizons, side by side on one
//! page.

use super::args::HistoryArgs;
use super::draw::{advise, choose, written};
use super::page::size_cm;
use super::report::Report;
use super::request::{Usage, drawing, page_format};
use super::view::ViewChanges;
use figure::{Figure, PageSize};
use page::FileFormat;
use project::chains::stages::{self, StageProject, Stages};
use project::error::Noun;
use project::folder::refuse_inside_project;
use project::pictures::figures::{self, FigureSettings, Series, SeriesPanel, SeriesSize};
use project::pictures::{Device, scene};
use project::{Project, memory_budget};
use render::Scene;
use restore::{Datum, RestoreSettings};
use std::path::PathBuf;
use survey::Progress;

/// Width of a page where nothing is said about it, cm.
const USUAL_WIDTH_CM: f64 = 17.0;

/// What is said below restorations.
const KINEMATIC: &str = "Restorations are kinematic: not balanced, not decompacted.";

/// A series that was asked for.
#[derive(Debug)]
pub(super) struct SeriesRequest {
    project: PathBuf,
    out: PathBuf,
    /// None: those that change something.
    stages: Vec<f64>,
    /// Horizons to restore the block to, in place of stages.
    restore: Vec<String>,
    datum: Datum,
    scene: Option<String>,
    size_cm: Option<[f64; 2]>,
    has_size: bool,
    dpi: f64,
    has_legend: bool,
    has_north_arrow: bool,
    title: Option<String>,
    caption: Option<String>,
    fonts: Vec<PathBuf>,
    device: Device,
    volume_bytes: Option<u64>,
    view: ViewChanges,
    format: &'static FileFormat,
}

impl TryFrom<HistoryArgs> for SeriesRequest {
    type Error = Usage;

    fn try_from(typed: HistoryArgs) -> Result<Self, Usage> {
        for (n, stage) in typed.stages.iter().enumerate() {
            if typed.stages[..n].contains(stage) {
                return Err(format!("--stages: {stage} is named twice; each stage is one panel"));
            }
        }
        for (n, horizon) in typed.restore.iter().enumerate() {
            if typed.restore[..n].contains(horizon) {
                return Err(format!("--restore: \"{horizon}\" is named twice; each restoration is one panel"));
            }
        }
        let (device, volume_bytes) = drawing(&typed.drawing)?;
        Ok(Self {
            format: page_format(&typed.out)?,
            project: typed.project,
            out: typed.out,
            stages: typed.stages,
            restore: typed.restore,
            datum: if typed.regional { Datum::Regional } else { Datum::Flat },
            scene: typed.scene,
            size_cm: typed.size_cm.as_deref().map(size_cm).transpose()?,
            has_size: typed.view.size.is_some(),
            dpi: typed.dpi,
            has_legend: !typed.no_legend,
            has_north_arrow: typed.north_arrow,
            title: typed.title,
            caption: typed.caption,
            fonts: typed.font,
            device,
            volume_bytes,
            view: typed.view.try_into()?,
        })
    }
}

/// Makes the page and writes it.
pub(super) fn draw(request: &SeriesRequest, progress: &Progress) -> anyhow::Result<Report> {
    refuse_inside_project(&request.out)?;
    let project = Project::open(&request.project)?;
    let stages = request.restore.is_empty().then(|| Stages::of(&project)).transpose()?;
    let mut shown = choose(&project, request.scene.as_deref())?;
    let mut view = request.view.with_wells(&project)?;
    if request.scene.is_none() && project.document().scenes.is_empty() {
        view = view.with_nearest_cut(&shown);
    }
    view.change(&mut shown, project.document().frame()?)?;
    scene::prepare(project.document(), &mut shown, progress)?;
    let Panels { wanted, made, title } = match &stages {
        Some(stages) => told(request, stages, &shown, progress)?,
        None => restored(request, &project, progress)?,
    };
    let panels: Vec<SeriesPanel<'_>> =
        made.iter().map(|(stage, caption)| SeriesPanel { project: stage.project(), caption }).collect();
    let title = request.title.clone().or(title);
    let said = [request.caption.as_deref(), Some(KINEMATIC).filter(|_| !request.restore.is_empty())];
    let caption = said.into_iter().flatten().collect::<Vec<_>>().join(" ");
    let figure = Figure {
        dpi: request.dpi,
        legend: request.has_legend,
        scale_bar: true,
        north_arrow: request.has_north_arrow,
        title: title.filter(|title| !title.is_empty()),
        caption: Some(caption).filter(|caption| !caption.is_empty()),
        preset: Some(shown.preset),
        ..Figure::default()
    };
    let size = match (request.size_cm, request.has_size) {
        (Some(size), _) => SeriesSize::Page(PageSize::Cm(size)),
        (None, true) => SeriesSize::Page(PageSize::Px(shown.size_px)),
        (None, false) => SeriesSize::Width(USUAL_WIDTH_CM),
    };
    let series = Series { panels: &panels, scene: &shown, figure: &figure, size };
    let volume_bytes = request.volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    let (format, device, fonts) = (request.format, request.device, request.fonts.clone());
    let settings = FigureSettings { format, device, volume_bytes, fonts, picture_dpi: None };
    let (page, figure) = figures::make_series(&series, &settings, progress)?;
    figures::write(&page.page, format, &request.out, figure.dpi, &project.title())?;
    let mut report = Report::line(written(&request.out, figure.size_px(), figure.dpi));
    let captions: Vec<&str> = made.iter().map(|(_, caption)| caption.as_str()).collect();
    for (n, caption) in captions.iter().enumerate() {
        report.say(format!("  {}  {caption}", figure::panel_letter(n)));
    }
    advise(&request.project, page.confusions, &mut report);
    report
        .field("file", &request.out)
        .field("size_px", figure.size_px())
        .field("dpi", figure.dpi)
        .field("stages", &wanted)
        .field("captions", &captions)
        .field("exaggeration", shown.exaggeration)
        .field("device", page.device);
    Ok(report)
}

/// What the panels of a page show.
struct Panels<'a> {
    /// Stages of a history; none of restorations.
    wanted: Vec<f64>,
    /// The project of each panel, and what is written above it.
    made: Vec<(StageProject<'a>, String)>,
    title: Option<String>,
}

/// The block after its events.
fn told<'a>(
    request: &SeriesRequest,
    stages: &Stages<'a>,
    shown: &Scene,
    progress: &Progress,
) -> anyhow::Result<Panels<'a>> {
    let wanted = match &request.stages[..] {
        [] => stages.seen_to_change(shown, progress)?,
        asked => asked.to_vec(),
    };
    let captions = wanted.iter().map(|stage| stages.caption(*stage)).collect::<Result<Vec<_>, _>>()?;
    progress.begin("stages", wanted.len() as u64);
    let mut made = Vec::new();
    for (stage, caption) in wanted.iter().zip(captions) {
        made.push((stages.at(*stage, &progress.muted())?, caption));
        progress.step(1)?;
    }
    Ok(Panels { wanted, made, title: stages.title().map(str::to_owned) })
}

/// The block restored to horizons, oldest first, and today.
fn restored<'a>(request: &SeriesRequest, project: &'a Project, progress: &Progress) -> anyhow::Result<Panels<'a>> {
    let mut horizons = Vec::new();
    for horizon in &request.restore {
        horizons.push((project.document().position(Noun::Horizon, horizon)?, horizon));
    }
    horizons.sort_unstable();
    let settings = RestoreSettings { datum: request.datum, depth: None };
    progress.begin("restorations", horizons.len() as u64);
    let mut made = Vec::new();
    for (_, horizon) in horizons.into_iter().rev() {
        let stage = stages::restored(project, horizon, settings, &progress.muted())?;
        made.push((stage, format!("Restored to {horizon}")));
        progress.step(1)?;
    }
    made.push((StageProject::Finished(project), "Today".to_owned()));
    Ok(Panels { wanted: Vec::new(), made, title: None })
}
