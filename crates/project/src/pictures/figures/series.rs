//! A page of several projects of one series, such as the stages of a block's history: the same scene of each under its
//! caption, at one scale and with one legend.

use super::{
    Asked, FigurePainter, FigureSettings, InterpreterView, MadeFigure, NamedConfusion, faces, little_room, look_alikes,
    warn_of_boxes, with_inputs,
};
use crate::Project;
use crate::error::ProjectError;
use crate::pictures::load::{self, Loaded, Request};
use crate::pictures::{Painter, scene};
use crate::styles;
use figure::{Annotation, BlockPart, Figure, FigureError, FigureInputs, PageSize, SeriesLegend, SeriesPage};
use render::Scene;
use survey::Progress;
use system::memory;

/// A panel of a series.
#[derive(Clone, Copy)]
pub struct SeriesPanel<'a> {
    /// The project whose block it shows.
    pub project: &'a Project,
    /// What is written above it, after its letter.
    pub caption: &'a str,
}

/// How large the page of a series is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeriesSize {
    /// So large.
    Page(PageSize),
    /// So wide, cm, and as high as its panels need.
    Width(f64),
}

/// A series.
#[derive(Clone, Copy)]
pub struct Series<'a> {
    /// Its panels, in their order. They have blocks of the same size.
    pub panels: &'a [SeriesPanel<'a>],
    /// What all of them show.
    pub scene: &'a Scene,
    /// What else is on the page: resolution, words, legend, scale bar and north arrow; parts and size are not looked at.
    pub figure: &'a Figure,
    /// How large the page is.
    pub size: SeriesSize,
}

impl Series<'_> {
    /// The figure of one panel: what the project has of the scene.
    fn of(&self, project: &Project) -> Result<Figure, ProjectError> {
        let mut shown = scene::of_what_is_there(project.document(), self.scene);
        scene::prepare(project.document(), &mut shown, &Progress::silent())?;
        let size = match self.size {
            SeriesSize::Page(size) => size,
            SeriesSize::Width(width) => PageSize::Cm([width, width]),
        };
        let parts = vec![BlockPart { scene: shown, ..BlockPart::default() }.into()];
        Ok(Figure { parts, size, annotate: Vec::new(), ..self.figure.clone() })
    }
}

/// Makes the page of a series, lettered in the faces of its last project. What is loaded for one panel is let go of before
/// the next, and each is loaded twice: for the legend that they share, and for its picture.
///
/// # Errors
/// There is no panel or no room for them, data are damaged, or the user cancelled.
pub fn make_series(
    series: &Series<'_>,
    settings: &FigureSettings,
    progress: &Progress,
) -> Result<(MadeFigure, Figure), ProjectError> {
    let last = series.panels.last().ok_or(FigureError::Parts { found: 0 })?.project;
    faces(last, &settings.fonts)?.scope(|| lettered(series, last, settings, progress))
}

fn lettered(
    series: &Series<'_>,
    last: &Project,
    settings: &FigureSettings,
    progress: &Progress,
) -> Result<(MadeFigure, Figure), ProjectError> {
    let view = InterpreterView::default();
    let mut painter: Option<Painter> = None;
    let captions: Vec<String> = series.panels.iter().map(|panel| panel.caption.to_owned()).collect();
    progress.begin("panels", 2 * captions.len() as u64);
    let mut legend = SeriesLegend::default();
    let (mut stages, mut confusions) = (Vec::new(), Vec::new());
    // From the last, whose order of layers is the one that the legend has.
    for panel in series.panels.iter().rev() {
        let (figure, loaded) = load(series, panel, settings, progress)?;
        let asked = Asked { project: panel.project, figure: &figure.0, scene: &figure.1, view: &view, settings };
        let add = |inputs: &FigureInputs, _: &mut FigurePainter| legend.add(&figure.0, inputs);
        stages.extend(with_inputs(&asked, &loaded, &mut painter, &progress.muted(), add)?.1);
        for pair in look_alikes(&asked, &loaded)? {
            if !confusions.iter().any(|known: &NamedConfusion| known.layers == pair.layers) && !is_sliver(&pair) {
                confusions.push(pair);
            }
        }
        progress.step(1)?;
    }
    let mut figure = series.of(last)?;
    let geometry = last.document().frame()?;
    let library = styles::pattern_library(last.root(), last.document())?;
    let known = (geometry, Some(&library));
    if let SeriesSize::Width(width) = series.size {
        figure.size = PageSize::Cm(legend.size_cm(width, &figure, &captions, known));
    }
    memory::check(
        "the page",
        &figure.size_px().map(|side| side.min(super::LONGEST_SIDE) as usize),
        super::PIXEL_BYTES,
    )?;
    let origin = format!("Petroglyph {} · {}", env!("CARGO_PKG_VERSION"), last.title());
    let said = std::iter::once(origin).chain(series.figure.credit.iter().map(|credit| format!("data: {credit}")));
    let provenance = said.collect::<Vec<_>>().join(" · ");
    let is_said = series.figure.annotate.contains(&Annotation::Provenance) || series.figure.credit.is_some();
    let provenance = is_said.then_some(&provenance);
    let lay_out = |figure: &Figure| SeriesPage::lay_out(figure, &captions, &legend, known, provenance);
    let mut page = little_room::made(&figure, progress, lay_out)?;
    for panel in series.panels {
        let (own, loaded) = load(series, panel, settings, progress)?;
        let asked = Asked { project: panel.project, figure: &own.0, scene: &own.1, view: &view, settings };
        let draw = |inputs: &FigureInputs, painter: &mut FigurePainter| page.draw(&own.0, inputs, painter);
        stages.extend(with_inputs(&asked, &loaded, &mut painter, &progress.muted(), draw)?.1);
        progress.step(1)?;
    }
    let page = page.finish();
    warn_of_boxes(&page, progress);
    let device = painter.as_ref().map(|painter| painter.device().to_owned());
    Ok((MadeFigure { page, device, stages, confusions }, figure))
}

/// Whether one of two layers is what is left above the top of the other, of no thickness.
fn is_sliver(pair: &NamedConfusion) -> bool {
    let [one, other] = &pair.layers;
    [(one, other), (other, one)].iter().any(|(above, of)| above.strip_prefix("Above ") == Some(of.as_str()))
}

/// The figure of a panel with the scene that is loaded for it, and what was loaded.
fn load(
    series: &Series<'_>,
    panel: &SeriesPanel<'_>,
    settings: &FigureSettings,
    progress: &Progress,
) -> Result<((Figure, Scene), Loaded), ProjectError> {
    let figure = series.of(panel.project)?;
    let scene = Scene { preset: figure.printed_in(), ..super::needs(&figure) };
    let request = Request::new(&scene).within(settings.volume_bytes);
    let loaded = load::load(panel.project.facts(), &request, &progress.muted())?;
    Ok(((figure, scene), loaded))
}
