//! Figures of a project. The command line and the window load what a figure needs, and make its page, in the
//! same way.
//!
//! A figure with a block needs what the block's scene needs. A figure of sections and maps alone needs the model but no
//! layer coordinates, and what an interpreter sees needs no model at all.

mod batch;
mod confusion;
mod fonts;
mod interpreter;
mod little_room;
mod output;
mod series;

pub(crate) use batch::check_all;
pub use batch::{WrittenFigure, make_all};
pub use confusion::{NamedConfusion, confusions};
pub use fonts::{FontFile, faces, font_files};
pub use interpreter::{InterpreterView, borrowed};
pub use output::write;
pub use series::{Series, SeriesPanel, SeriesSize, make_series};

use crate::Project;
use crate::content;
use crate::document::{Document, WellEntry};
use crate::error::ProjectError;
use crate::pictures::load::{self, Extent, Loaded, Request, Stage};
use crate::pictures::{Device, Painter};
use crate::styles;
use figure::cut::{SectionKind, SectionSource};
use figure::draw::NamedColour;
use figure::draw::block::BlockPainter;
use figure::{Annotation, FencePart, Figure, FigureError, FigureInputs, Part, SectionPart};
use glam::{Vec2, Vec3};
use image::RgbaImage;
use interpreter::InterpreterPicks;
use page::FileFormat;
use page::list::DisplayList;
use render::places::Places;
use render::vector::{VectorBlock, vectors};
use render::{FaceData, Faces, Media, RenderError, Scene};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use survey::{Progress, SurveyGeometry, Well};
use system::memory;
use ttf::{LayerStyle, Preset, TextureLibrary};

/// The page of a figure, and how it was made.
pub struct MadeFigure {
    /// The page.
    pub page: DisplayList,
    /// The device that drew its blocks; `None` if it has none.
    pub device: Option<String>,
    /// The duration of the stages.
    pub stages: Vec<Stage>,
    /// The neighbouring layers of its blocks that cannot be told apart.
    pub confusions: Vec<NamedConfusion>,
}

/// Settings for making a figure.
pub struct FigureSettings {
    /// What its page is written to. Rock is traced, so that patterns are sharp at any resolution; a block alone in a file of
    /// pixels is painted, as it is on the screen.
    pub format: &'static FileFormat,
    /// The painter for blocks.
    pub device: Device,
    /// Largest memory for the samples of a volume, bytes.
    pub volume_bytes: u64,
    /// Font files for letters that the embedded face and the project's own fonts lack.
    pub fonts: Vec<PathBuf>,
    /// Coarsest resolution that pictures of blocks may have, dots an inch, where a page is looked at soon; absent: the
    /// figure's. All else is laid out as at the figure's.
    pub picture_dpi: Option<f64>,
}

/// The page itself refuses longer sides.
const LONGEST_SIDE: u32 = 1 << 15;

/// Memory that is needed for each pixel of a page: its colour, and once more in the file.
const PIXEL_BYTES: usize = 8;

/// Loads what a figure needs, and makes its page. `view` is what only an interpreter's view knows. While what was loaded is
/// held, the next figure finds it.
///
/// # Errors
/// Data are damaged, a place or horizon does not exist, the page has no room, or the user cancelled.
pub fn make(
    project: &Project,
    figure: &Figure,
    view: &InterpreterView,
    settings: &FigureSettings,
    progress: &Progress,
) -> Result<(MadeFigure, Loaded), ProjectError> {
    faces(project, &settings.fonts)?.scope(|| lettered(project, figure, view, settings, progress))
}

/// The same, lettered in the faces of this thread.
fn lettered(
    project: &Project,
    figure: &Figure,
    view: &InterpreterView,
    settings: &FigureSettings,
    progress: &Progress,
) -> Result<(MadeFigure, Loaded), ProjectError> {
    let document = project.document();
    let figure = &settled(figure, document);
    memory::check("the page", &figure.size_px().map(|side| side.min(LONGEST_SIDE) as usize), PIXEL_BYTES)?;
    let is_painted = is_painted(figure, settings);
    let mut painter = if is_painted { Some(Painter::new(settings.device, progress)?) } else { None };
    let scene = Scene { preset: figure.printed_in(), ..needs(figure) };
    let has_block = figure.parts.iter().any(|part| matches!(part, Part::Block(_)));
    let places = section_places(figure, document.frame()?);
    let extent = if !(has_block || figure.has_rock_sections()) || figure.interpretation {
        Extent::Data(Some(&places).filter(|_| !has_block))
    } else if painter.as_ref().is_some_and(Painter::is_processor) {
        Extent::Faces
    } else {
        Extent::Whole
    };
    let request = Request::new(&scene).of(extent).within(settings.volume_bytes);
    let page = |loaded: &Loaded| {
        let asked = Asked { project, figure, scene: &scene, view, settings };
        let make = |inputs: &FigureInputs, painter: &mut FigurePainter| {
            little_room::made(figure, progress, |figure| figure::make(figure, inputs, painter))
        };
        let (page, stages) = with_inputs(&asked, loaded, &mut painter, progress, make)?;
        warn_of_boxes(&page, progress);
        let device = painter.as_ref().map(|painter| painter.device().to_owned());
        Ok(MadeFigure { page, device, stages, confusions: look_alikes(&asked, loaded)? })
    };
    load::drawn(project.facts(), &request, progress, page)
}

/// Whether the rock of a figure is painted, and not traced.
fn is_painted(figure: &Figure, settings: &FigureSettings) -> bool {
    figure.is_block_alone() && settings.format.has_pixels()
}

/// A figure of a project, and what it is drawn by.
struct Asked<'a> {
    project: &'a Project,
    figure: &'a Figure,
    /// Needs the same as the figure.
    scene: &'a Scene,
    view: &'a InterpreterView,
    settings: &'a FigureSettings,
}

/// The neighbouring layers of a figure that cannot be told apart.
fn look_alikes(asked: &Asked<'_>, loaded: &Loaded) -> Result<Vec<NamedConfusion>, ProjectError> {
    let document = asked.project.document();
    let library = &styles::pattern_library(asked.project.root(), document)?;
    confusions(loaded.rock.as_deref(), &styles::layer_styles(document, library), library, asked.scene)
}

/// Does something with what a figure takes of what was loaded, and with the painter of its blocks; also the duration of
/// the stages until then.
fn with_inputs<T>(
    asked: &Asked<'_>,
    loaded: &Loaded,
    painter: &mut Option<Painter>,
    progress: &Progress,
    mut make: impl FnMut(&FigureInputs, &mut FigurePainter) -> Result<T, FigureError>,
) -> Result<(T, Vec<Stage>), ProjectError> {
    let &Asked { project, figure, view, settings, .. } = asked;
    let document = project.document();
    let horizons = horizons(document);
    let has_wells = figure.parts.iter().any(|part| matches!(part, Part::Correlation(_)));
    let names_wells = figure.annotate.contains(&Annotation::Wells);
    let wells = if has_wells || names_wells { wells_of(project)? } else { Vec::new() };
    let stages: Vec<Stage>;
    // Sections and maps of measured data need the model without the coordinates of its layers.
    let model = match &loaded.rock {
        Some(rock) => {
            stages = rock.stages.clone();
            None
        }
        None => {
            let built = if figure.interpretation { None } else { load::structural_model(project.facts(), progress)? };
            let (model, stage) = built.unzip();
            stages = stage.into_iter().collect();
            model
        }
    };
    let picks =
        if figure.interpretation { Some(InterpreterPicks::read(project, &horizons, view, progress)?) } else { None };
    let shown = picks.as_ref().map(|picks| {
        let mut shown = picks.borrowed();
        shown.horizons.retain(|horizon| !figure.hides(horizon.name));
        shown.faults.retain(|fault| !figure.hides(fault.name));
        shown
    });
    let library = &styles::pattern_library(project.root(), document)?;
    let styles = styles::layer_styles(document, library);
    let layers: Vec<LayerStyle> = styles.iter().map(|style| figure.printed_in().layer(style)).collect();
    let (volumes, paths) = (loaded.named_volumes(), loaded.well_paths());
    let mut data = loaded.inputs(&volumes, &paths);
    data.model = data.model.or(model.as_deref());
    let inputs = FigureInputs {
        source: SectionSource { data, raw: loaded.raw.as_ref() },
        horizons: &horizons,
        strata: &document.stratigraphy().horizons,
        outlined: &document.outlined(),
        wells: &wells,
        faults: &document.faults.iter().map(|entry| entry.name.clone()).collect::<Vec<_>>(),
        fault_colours: &document.faults.iter().map(|entry| entry.colour).collect::<Vec<_>>(),
        layers: &layers,
        library: Some(library),
        interpretation: shown.as_ref(),
        provenance: &format!("Petroglyph {} · {}", env!("CARGO_PKG_VERSION"), project.title()),
    };
    let preset = figure.printed_in();
    let share = settings.picture_dpi.map_or(1.0, |dpi| (dpi / figure.dpi).min(1.0));
    let is_painted = is_painted(figure, settings);
    let mut painter = FigurePainter { is_painted, painter, settings, loaded, library, preset, share, stages, progress };
    let made = make(&inputs, &mut painter)?;
    Ok((made, painter.stages))
}

/// The figure with what its sections show: measured data where there are some, and the rock otherwise. One of a restored
/// interpretation says so.
fn settled(figure: &Figure, document: &Document) -> Figure {
    let mut figure = figure.clone();
    let raw = styles::transfer_functions(document).raw;
    let has_data = raw.is_some_and(|raw| document.volumes.iter().any(|entry| entry.name == raw.volume));
    for part in &mut figure.parts {
        if let Part::Section(SectionPart { blend, .. }) | Part::Fence(FencePart { blend, .. }) = part {
            blend.get_or_insert(if has_data { 1.0 } else { 0.0 });
        }
    }
    if let (Some(restored), Some(geometry)) = (&document.restored, &document.geometry) {
        let words = restored.words(geometry.vertical.unit);
        figure.caption = Some(figure.caption.map_or_else(|| words.clone(), |caption| format!("{caption} {words}")));
    }
    figure
}

/// Says which texts have letters that the face lacks.
fn warn_of_boxes(page: &DisplayList, progress: &Progress) {
    let is_box = |c: char| !c.is_whitespace() && !ttf::text::is_known(c);
    let mut texts: Vec<&str> = page.texts().into_iter().map(|text| text.text.as_str()).collect();
    texts.retain(|text| text.chars().any(is_box));
    texts.sort_unstable();
    texts.dedup();
    if let Some(first) = texts.first() {
        let subject = match texts.len() - 1 {
            0 => format!("\"{first}\" has"),
            more => format!("\"{first}\" and {more} more have"),
        };
        let mut lacking: Vec<char> = texts.iter().flat_map(|text| text.chars()).filter(|c| is_box(*c)).collect();
        lacking.sort_unstable();
        lacking.dedup();
        let advice = fonts::advice(lacking);
        progress.warn(format!(
            "{subject} letters that the figures' face lacks, and they are drawn as boxes; the face has Latin, \
             Greek and Cyrillic letters: name a font file with the others by --font FILE, or by `fonts = [\"FILE\"]` at the \
             top of project.toml{advice}"
        ));
    }
}

/// Paints or traces the rock of a figure; a device is looked for when the first picture is asked for.
struct FigurePainter<'a> {
    is_painted: bool,
    painter: &'a mut Option<Painter>,
    settings: &'a FigureSettings,
    loaded: &'a Loaded,
    /// The patterns.
    library: &'a TextureLibrary,
    preset: Preset,
    /// Share of the pixels along each side that pictures are painted with.
    share: f64,
    stages: Vec<Stage>,
    progress: &'a Progress,
}

impl FigurePainter<'_> {
    /// The scene with what can be shown of it: while a project is being interpreted it has no model to take the
    /// relief from.
    fn shown(&self, scene: &Scene) -> Scene {
        let ground = scene.ground.filter(|_| self.loaded.rock.is_some());
        Scene { ground, preset: self.preset, ..scene.clone() }
    }

    /// Pixels of what is painted and not traced.
    fn painted_px(&self, scene: &Scene) -> [u32; 2] {
        scene.size_px.map(|side| (f64::from(side) * self.share).round().max(1.0) as u32)
    }
}

impl BlockPainter for FigurePainter<'_> {
    fn paint(&mut self, scene: &Scene) -> Result<RgbaImage, RenderError> {
        let scene = Scene { size_px: self.painted_px(scene), ..self.shown(scene) };
        let painter = match &mut *self.painter {
            Some(painter) => painter,
            empty => empty.insert(Painter::new(self.settings.device, self.progress)?),
        };
        let (image, stage) = painter.draw(&scene, self.loaded, self.progress)?;
        self.stages.push(stage);
        Ok(image)
    }

    fn trace(&mut self, scene: &Scene, tolerance_px: f64) -> Result<Option<VectorBlock>, RenderError> {
        if self.is_painted {
            return Ok(None);
        }
        let start = Instant::now();
        let scene = self.loaded.complete(&self.shown(scene));
        let (volumes, wells) = (self.loaded.named_volumes(), self.loaded.well_paths());
        let inputs = self.loaded.inputs(&volumes, &wells);
        let mut traced = vectors(&scene, &inputs, self.library, tolerance_px, self.painted_px(&scene), self.progress)?;
        if !self.preset.is_colour()
            && let Some(over) = traced.as_mut().and_then(|traced| traced.over.as_mut())
        {
            Arc::make_mut(over).pixels_mut().for_each(|pixel| pixel.0 = self.preset.pixel(pixel.0));
        }
        self.stages.push(Stage::new("paths", start.elapsed()));
        Ok(traced)
    }
}

/// The planes of the sections of a figure, on which alone it takes samples.
pub(crate) fn section_places(figure: &Figure, geometry: &SurveyGeometry) -> Places<'static> {
    let mut places = Places::default();
    let last = geometry.size().map(|count| count.saturating_sub(1) as f32);
    let whole = [Vec3::ZERO, Vec3::from_array(last)];
    for part in &figure.parts {
        match part {
            Part::Section(section) => {
                let at = match section.kind {
                    SectionKind::Inline => geometry.inlines.index_of(section.at),
                    SectionKind::Crossline => geometry.crosslines.index_of(section.at),
                    SectionKind::Slice => geometry.vertical.index_of(section.at),
                };
                // It may be moved to the nearest sample.
                for at in [at.floor() as f32, at as f32, at.ceil() as f32] {
                    places.add_plane(Vec3::AXES[section.kind.axis()], at, whole);
                }
            }
            Part::Fence(fence) => {
                let corners: Vec<Vec2> =
                    fence.corners.iter().map(|[x, y]| geometry.voxel_from_lines(*x, *y).as_vec2()).collect();
                for leg in corners.windows(2) {
                    let normal = (leg[1] - leg[0]).perp().normalize_or_zero();
                    let (low, high) = (leg[0].min(leg[1]) - 1.0, leg[0].max(leg[1]) + 1.0);
                    places.add_plane(normal.extend(0.0), normal.dot(leg[0]), [low.extend(0.0), high.extend(last[2])]);
                }
            }
            Part::Block(_) | Part::Map(_) | Part::Correlation(_) | Part::Throw(_) => {}
        }
    }
    places
}

/// A scene that needs everything that the parts of a figure need.
fn needs(figure: &Figure) -> Scene {
    let mut scene = Scene::default();
    let mut is_raw = false;
    let mut shown = FaceData::Rock;
    for part in &figure.parts {
        match part {
            Part::Block(block) => {
                is_raw |= block.comparison != figure::draw::block::Comparison::None;
                scene = block.scene.clone();
            }
            Part::Section(section) => (is_raw, shown) = (is_raw || section.blend != Some(0.0), section.show),
            Part::Fence(fence) => (is_raw, shown) = (is_raw || fence.blend != Some(0.0), fence.show),
            Part::Map(_) | Part::Correlation(_) | Part::Throw(_) => {}
        }
    }
    if scene.face_data == FaceData::Rock {
        scene.face_data = shown;
    }
    if is_raw {
        // A blend in between needs everything that any blend needs.
        scene.blend = 0.5;
    }
    scene
}

/// The block as an interpreter sees it: raw data with the horizons in front; volume rendering stays.
pub fn interpreted(scene: &Scene) -> Scene {
    let is_through = scene.media.faces == Faces::None;
    let media = if is_through { scene.media.clone() } else { Media::default() };
    Scene { blend: 1.0, ground: None, media, ..scene.clone() }
}

/// The wells of a project under the names that they have in it.
fn wells_of(project: &Project) -> Result<Vec<Well>, ProjectError> {
    let read = |entry: &WellEntry| Ok(Well { name: entry.name.clone(), ..content::read_well(project.root(), entry)? });
    project.document().wells.iter().map(read).collect()
}

/// The horizons of a project with the colours that figures and the window draw them in.
pub fn horizons(document: &Document) -> Vec<NamedColour> {
    let entries = document.horizons.iter().enumerate();
    let named = entries.map(|(index, entry)| NamedColour {
        name: entry.name.clone(),
        colour: figure::style::horizon_colour(entry.own_colour(), index),
    });
    named.collect()
}
