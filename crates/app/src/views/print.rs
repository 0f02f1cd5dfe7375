//! What is on the screen as a figure: for the preview of the page and for the exported file.
//!
//! The page itself is made by [`project::pictures::figures::make`], as for `petroglyph render`.

use super::block::{self, BEHIND_VOLUMES};
use super::overlay::{Overlay, interpreter_view};
use super::sections::Sections;
use crate::state::picking::place_of;
use crate::state::{Compare, ExportForm, Layout, Panel, SectionFill, SectionKind, Session, Shown, State, showing};
use crate::widgets::page::PREVIEW_DPI;
use crate::work::compute;
use figure::cut::value_at;
use figure::draw::block::Comparison;
use figure::map::Mapped;
use figure::{BlockPart, FencePart, Figure, MapPart, PageSize, Part, SectionPart};
use glam::DVec3;
use page::{DisplayList, FileFormat};
use project::pictures::Device;
use project::pictures::figures::{self, FigureSettings, InterpreterView};
use project::{Project, ProjectError, memory_budget};
use render::{Background, FaceData, Scene};
use std::path::{Path, PathBuf};
use survey::{Progress, SurveyGeometry};
use ttf::{Colour, Preset};

/// Samples a pixel along each axis.
const SAMPLES: u32 = 3;

/// What is on the screen, and how it is to be printed.
pub struct Page {
    root: PathBuf,
    figure: Figure,
    view: InterpreterView,
    path: String,
}

impl Page {
    /// The page that shows what is on the screen; `None` for a project without a survey geometry.
    pub fn of(
        session: &Session,
        overlay: &Overlay,
        sections: &Sections,
        mapped: Mapped,
        form: &ExportForm,
    ) -> Option<Self> {
        let geometry = session.document.geometry.as_ref()?;
        let is_interpreting = session.view.panel == Panel::Interpret;
        let parts = parts(session, geometry, overlay, sections, mapped, form.section_fill);
        // A block brings those of its scene.
        let has_block = parts.iter().any(|part| matches!(part, Part::Block(_)));
        let figure = Figure {
            labels: if has_block { Vec::new() } else { session.view.scene.labels.clone() },
            size: PageSize::Cm(form.size_cm),
            dpi: form.dpi,
            parts,
            legend: form.legend == Shown::Yes,
            scale_bar: form.scale_bar == Shown::Yes,
            north_arrow: form.north_arrow == Shown::Yes,
            annotate: form.annotate.clone(),
            credit: said(&form.credit),
            title: said(&form.title),
            caption: said(&form.caption),
            interpretation: is_interpreting,
            hidden: session.view.hidden.names().map(str::to_owned).collect(),
            preset: Some(session.view.scene.preset),
        };
        let view = interpreter_view(session, overlay.selected());
        Some(Self { root: session.root.clone(), figure, view, path: form.path.clone() })
    }

    /// What the page shows.
    pub fn figure(&self) -> &Figure {
        &self.figure
    }

    /// Lays the page out to be looked at, exactly as it is written, but without changes to its labels, and with pictures
    /// of blocks at a coarser resolution, so that it is there soon.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn preview(&self, progress: &Progress) -> Result<(DisplayList, Preset), ProjectError> {
        let project = Project::open(&self.root)?;
        let mut figure = Figure { labels: Vec::new(), ..self.figure.clone() };
        for part in &mut figure.parts {
            if let Part::Block(block) = part {
                block.scene.labels.clear();
                block.scene.samples = 2;
            }
        }
        let settings = self.settings(Some(PREVIEW_DPI));
        let (made, _) = compute(|| figures::make(&project, &figure, &self.view, &settings, progress))?;
        Ok((made.page, figure.printed_in()))
    }

    /// The kind of file that it is written to.
    fn format(&self) -> &'static FileFormat {
        FileFormat::of_page(Path::new(&self.path)).unwrap_or(FileFormat::usual())
    }

    /// How it is drawn.
    fn settings(&self, picture_dpi: Option<f64>) -> FigureSettings {
        FigureSettings {
            format: self.format(),
            device: Device::Auto,
            volume_bytes: memory_budget::half_of_available(),
            fonts: Vec::new(),
            picture_dpi,
        }
    }

    /// Makes the page and writes it.
    ///
    /// # Errors
    /// Data cannot be read or drawn, the file cannot be written, or the user cancelled.
    pub fn write(&self, progress: &Progress) -> Result<(), ProjectError> {
        let project = Project::open(&self.root)?;
        let path = Path::new(&self.path);
        let settings = self.settings(None);
        compute(|| {
            let (made, _) = figures::make(&project, &self.figure, &self.view, &settings, progress)?;
            figures::write(&made.page, self.format(), path, self.figure.dpi, &project.title())
        })
    }
}

/// Words that were typed; `None` of a field that was left empty.
fn said(words: &str) -> Option<String> {
    Some(words.trim().to_owned()).filter(|words| !words.is_empty())
}

/// The views on the screen as parts of a figure, in the order of the page.
fn parts(
    session: &Session,
    geometry: &SurveyGeometry,
    overlay: &Overlay,
    sections: &Sections,
    mapped: Mapped,
    fill: SectionFill,
) -> Vec<Part> {
    let view = &session.view;
    let show = if view.panel == Panel::Interpret { view.picking.show } else { FaceData::Rock };
    let section = |kind: SectionKind| {
        let at = value_at(geometry, kind.axis(), view.slices[kind.axis()]);
        let (zoom, proportions) = (sections.zoom(kind), view.proportions);
        Part::Section(SectionPart { kind, at, show, blend: fill.blend(), zoom, proportions })
    };
    let block = || Part::from(block_part(session, overlay));
    match view.layout {
        Layout::Block => vec![block()],
        Layout::Sections => {
            let [inline, crossline, slice] = SectionKind::ALL.map(section);
            vec![block(), inline, slice, crossline]
        }
        Layout::Map => {
            let map = map_part(session, mapped);
            std::iter::once(block()).chain(map.map(Part::Map)).collect()
        }
        Layout::Fence => {
            let corner = |at: &[f64; 2]| {
                let [inline, crossline, _] = place_of(geometry, DVec3::new(at[0], at[1], 0.0));
                [inline, crossline]
            };
            let corners: Vec<[f64; 2]> = view.fence.iter().map(corner).collect();
            let fence = (corners.len() > 1).then_some(Part::Fence(FencePart { corners, show, blend: fill.blend() }));
            std::iter::once(section(SectionKind::Slice)).chain(fence).collect()
        }
    }
}

fn map_part(session: &Session, mapped: Mapped) -> Option<MapPart> {
    let name = |index: usize| session.document.horizons.get(index).map(|entry| entry.name.clone());
    Some(match mapped {
        Mapped::Structure(horizon) => MapPart { horizon: name(horizon)?, thickness_to: None },
        Mapped::Thickness(upper, lower) => MapPart { horizon: name(upper)?, thickness_to: Some(name(lower)?) },
    })
}

/// The block, or the blocks that are compared, as on the screen.
fn block_part(session: &Session, overlay: &Overlay) -> BlockPart {
    let view = &session.view;
    let has_candidates = overlay.interpreted().is_some_and(|shown| shown.key.is_some());
    let horizons = has_candidates.then(|| overlay.leaves(session));
    let mut scene = Scene { samples: SAMPLES, ..showing::scene(session, horizons.as_deref()) };
    if block::is_dark(session) {
        let [r, g, b, _] = BEHIND_VOLUMES.to_array();
        scene.background = Background::Colour(Colour::new(r, g, b));
    }
    let blends = State::blends(view);
    let comparison = match (block::compare(session), blends.as_slice()) {
        (Compare::SideBySide, &[first, second]) => Comparison::SideBySide([first, second]),
        (Compare::Wipe, &[first, second]) => Comparison::Wipe([first, second], f64::from(view.wipe)),
        _ => Comparison::None,
    };
    BlockPart { scene, comparison }
}
