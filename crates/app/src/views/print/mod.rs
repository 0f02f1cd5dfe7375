//! A picture for print: what is on the screen, in centimetres and dots an inch, with legend, scale bar and what a reader must know.
//!
//! The blocks are drawn anew at the size that they have on paper, supersampled; sections, maps and what lies over them are painted by their own views,
//! on a page instead of a window.

mod sheet;

use super::block::{self, BEHIND_VOLUMES};
use super::parts::{Part, parts};
use super::sections::entry_colour;
use super::{fence::FenceView, map::MapView, overlay::Overlay, sections::Sections};
use crate::raster;
use crate::state::{ExportForm, Layout, Panel, Session, Shown, State, showing};
use crate::work::map::{self, MapSource, MapWish, Mapped};
use crate::work::{Rocks, compute, fence, slice};
use eframe::egui::{Color32, Pos2, Rect, Ui, vec2};
use glam::DVec2;
use image::{Rgba, RgbaImage, imageops};
use project::Project;
use project::error::ProjectError;
use project::picture::load;
use project::picture::{self, Device, Painter};
use project::styles;
use render::{Background, FaceData, Scene};
use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};
use survey::Progress;
use ttf::{Colour, LayerTtf};

/// Samples a pixel along each axis.
const SAMPLES: u32 = 3;
/// Length on paper of a point, in which views are laid out: numbers along the sections are 7 points of type.
const POINT_MM: f64 = 0.215;

/// What is on the screen, and how it is to be printed.
pub struct Page {
    /// The project and how it is looked at.
    pub session: Session,
    /// What lies over the pictures while interpreting.
    pub overlay: Overlay,
    /// Which parts of the sections are seen.
    pub sections: Sections,
    /// What the map shows.
    pub mapped: Mapped,
    /// Size, resolution, file.
    pub form: ExportForm,
}

impl Page {
    /// Draws the page and writes it.
    ///
    /// # Errors
    /// Data that cannot be read or drawn, a file that cannot be written, or cancelled.
    pub fn write(mut self, progress: &Progress) -> Result<(), ProjectError> {
        let sheet = self.draw(progress)?;
        picture::write_png(Path::new(&self.form.path), &sheet, self.form.dpi)
    }

    fn draw(&mut self, progress: &Progress) -> Result<RgbaImage, ProjectError> {
        let px = {
            let per_mm = self.form.px_per_mm();
            move |mm: f64| mm * per_mm
        };
        let [width, height] = self.form.size_px();
        let has_legend = self.form.legend == Shown::Yes && !self.session.document.horizons.is_empty();
        let legend_px = if has_legend { px(sheet::LEGEND_MM) as u32 } else { 0 };
        // Sections have numbers along their edges; a scale is the block's.
        let strip_px =
            if self.form.scale_bar == Shown::Yes && self.has_block() { px(sheet::STRIP_MM) as u32 } else { 0 };
        let size_px = [width.saturating_sub(legend_px).max(1), height.saturating_sub(strip_px).max(1)];
        let scene = self.scene();
        let mut page = RgbaImage::from_pixel(width, height, self.paper());
        let project = Project::open(&self.session.root)?;
        let rocks = self.load(&project, &scene, progress)?;
        let per_point = px(POINT_MM) as f32;
        let whole = Rect::from_min_size(Pos2::ZERO, vec2(size_px[0] as f32, size_px[1] as f32) / per_point);
        let parts = parts(self.session.view.layout, whole);
        for (_, rect) in parts.iter().filter(|(part, _)| *part == Part::Block) {
            let drawn = self.blocks(&mut page, &scene, *rect, per_point, &rocks, progress)?;
            if strip_px > 0 {
                sheet::scale_bars(&mut page, f64::from(size_px[1]), &px, &drawn, &self.geometry()?);
            }
        }
        self.views(&mut page, per_point, &parts, &rocks);
        if has_legend {
            let corner = [f64::from(size_px[0]) + px(1.0), px(sheet::MARGIN_MM)];
            self.legend(&mut page, corner, &px, &project)?;
        }
        Ok(page)
    }

    fn geometry(&self) -> Result<survey::SurveyGeometry, ProjectError> {
        Ok(self.session.document.frame()?.clone())
    }

    fn has_block(&self) -> bool {
        self.session.view.layout != Layout::Fence
    }

    /// What the page is printed on; a dark ground is the block's alone.
    fn paper(&self) -> Rgba<u8> {
        let own = self.session.view.scene.background;
        let background = if block::is_dark(&self.session) { Scene::default().background } else { own };
        Rgba(background.rgba().map(|channel| (channel * 255.0 + 0.5) as u8))
    }

    fn is_interpreting(&self) -> bool {
        self.session.view.panel == Panel::Interpret
    }

    /// What the block shows, as on the screen.
    fn scene(&self) -> Scene {
        let has_candidates = self.overlay.interpreted().is_some_and(|shown| shown.key.is_some());
        let horizons = has_candidates.then(|| self.overlay.leaves(&self.session));
        showing::scene(&self.session, horizons.as_deref())
    }

    /// Reads what the page shows.
    fn load(&self, project: &Project, scene: &Scene, progress: &Progress) -> Result<Rocks, ProjectError> {
        let loaded = if self.is_interpreting() {
            // Sections may show candidates where the block does not.
            let shown = self.session.view.picking.show;
            let face_data = if scene.face_data == FaceData::Rock { shown } else { scene.face_data };
            let scene = Scene { face_data, ..scene.clone() };
            compute(|| load::load_bare(project, &scene, progress))?
        } else {
            // Half-way needs everything that any blend needs.
            let scene = Scene { blend: 0.5, ..scene.clone() };
            compute(|| load::load(project, &scene, progress))?
        };
        Ok(Arc::new(RwLock::new(loaded)))
    }

    /// Draws the block, or the blocks that are compared; answers the last as it was drawn.
    fn blocks(
        &self,
        page: &mut RgbaImage,
        scene: &Scene,
        rect: Rect,
        per_point: f32,
        rocks: &Rocks,
        progress: &Progress,
    ) -> Result<Scene, ProjectError> {
        let loaded = rocks.read().unwrap_or_else(PoisonError::into_inner);
        let mut painter = Painter::new(Device::Auto, progress)?;
        let mut scene = Scene { samples: SAMPLES, background: Background::Transparent, ..scene.clone() };
        if loaded.rock.is_none() {
            scene.ground = None;
        }
        if block::is_dark(&self.session) {
            let [r, g, b, _] = BEHIND_VOLUMES.to_array();
            scene.background = Background::Colour(Colour::new(r, g, b));
        }
        let compare = block::compare(&self.session);
        let blends = State::blends(&self.session.view);
        for (index, (pane, blend)) in block::panes(compare, rect).into_iter().zip(blends).enumerate() {
            scene.blend = blend;
            let [left, top, right, bottom] = pixels(pane, per_point);
            scene.size_px = [(right - left).max(1), (bottom - top).max(1)];
            let (image, _) = compute(|| painter.draw(&scene, &loaded, progress))?;
            let [from, _, to, _] = pixels(block::clip(compare, index, pane, self.session.view.wipe), per_point);
            let seen = imageops::crop_imm(&image, from - left, 0, to - from, image.height()).to_image();
            imageops::overlay(page, &seen, i64::from(from), i64::from(top));
        }
        Ok(scene)
    }

    /// Paints all but the pictures of the block.
    fn views(&mut self, page: &mut RgbaImage, per_point: f32, parts: &[(Part, Rect)], rocks: &Rocks) {
        let Self { session, overlay, sections, mapped, .. } = self;
        let show = if session.view.panel == Panel::Interpret { session.view.picking.show } else { FaceData::Rock };
        let (mut map, mut fence) = (MapView::default(), FenceView::default());
        let mut is_first = true;
        let source = match overlay.interpreted().filter(|_| session.view.panel == Panel::Interpret) {
            Some(shown) => session
                .document
                .geometry
                .as_ref()
                .map(|geometry| MapSource::Interpreted(shown.clone(), Box::new(geometry.clone()))),
            None => Some(MapSource::Rocks(rocks.clone())),
        };
        raster::print(page, per_point, |ui: &mut Ui| {
            for (part, rect) in parts {
                match part {
                    Part::Block => {
                        let compare = block::compare(session);
                        for pane in block::panes(compare, *rect) {
                            if !block::is_clear(session) {
                                overlay.surfaces_on_block(ui, session, pane);
                            }
                            overlay.sticks_on_block(ui, session, pane);
                        }
                        block::rule(ui, compare, *rect, session.view.wipe);
                    }
                    Part::Section(kind) => {
                        if is_first {
                            let loaded = rocks.read().unwrap_or_else(PoisonError::into_inner);
                            let at = session.view.slices[kind.axis()];
                            sections.receive(ui.ctx(), slice::cut(&loaded, *kind, at, show));
                        }
                        sections.print(ui, session, *kind, *rect, overlay);
                    }
                    Part::Map => {
                        if is_first
                            && let Some(source) = source.clone()
                            && let Some(picture) = map::draw(&MapWish { mapped: *mapped, source })
                        {
                            map.receive(ui.ctx(), picture);
                        }
                        map.print(ui, session, *rect);
                    }
                    Part::Fence => {
                        if is_first && session.view.fence.len() > 1 {
                            let corners: Vec<DVec2> =
                                session.view.fence.iter().copied().map(DVec2::from_array).collect();
                            let loaded = rocks.read().unwrap_or_else(PoisonError::into_inner);
                            fence.receive(ui.ctx(), fence::cut(&loaded, &corners, show));
                        }
                        fence.paint(ui, session, *rect, overlay);
                    }
                }
            }
            is_first = false;
        });
    }

    /// The layers with their patterns; the horizons with their colours where only lines are seen.
    fn legend(
        &self,
        page: &mut RgbaImage,
        corner: [f64; 2],
        px: &impl Fn(f64) -> f64,
        project: &Project,
    ) -> Result<(), ProjectError> {
        let document = &self.session.document;
        if self.is_interpreting() || !self.has_block() {
            let entries = document.horizons.iter().enumerate();
            let named = entries.map(|(index, entry)| (plain(entry_colour(entry, index)), entry.name.clone()));
            sheet::horizons(page, corner, px, &named.collect::<Vec<_>>());
            return Ok(());
        }
        let library = styles::pattern_library(project.root(), document)?;
        let names = document.layers();
        let styles: Vec<ttf::LayerStyle> = names
            .iter()
            .enumerate()
            .map(|(index, name)| match document.style.layers.style(name) {
                Some(style) => style.clone(),
                None => LayerTtf::default_style(name, names.len() - 1 - index, &library),
            })
            .collect();
        sheet::layers(page, corner, px, &styles, &library)
    }
}

fn plain(colour: Color32) -> Colour {
    Colour::new(colour.r(), colour.g(), colour.b())
}

/// Left, top, right and bottom in whole pixels.
fn pixels(rect: Rect, per_point: f32) -> [u32; 4] {
    [rect.left(), rect.top(), rect.right(), rect.bottom()].map(|side| (side * per_point).round().max(0.0) as u32)
}
