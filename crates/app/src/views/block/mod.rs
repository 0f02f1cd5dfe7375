//! The block view: pictures from the painter, turned and cut with the pointer.
//!
//! Two spaces: points of the window, and pixels of the picture (points × the display's scale). Cameras are changed in
//! points, since [`camera`](crate::state::camera) depends on proportions only.

mod compare;
mod hand;
mod sticks;

pub use compare::{clip, compare};
pub(crate) use compare::{panes, rule};

use super::lasso::{self, LassoLine};
use super::overlay::Overlay;
use super::pointer::{self, Pointed};
use super::texture;
use crate::state::faces::{self, Handle};
use crate::state::{Action, Compare, Lasso, LassoOn, Look, Panel, PickingStep, Session, State, showing};
use crate::widgets::theme;
use crate::work::{Drawing, Drawn, PictureRequest, Rocks, Touch};
use compare::fitted;
use eframe::egui::{Color32, ColorImage, Pos2, Rect, Role, Sense, Stroke, TextureHandle, Ui, Vec2, WidgetInfo, pos2};
use glam::DVec2;
use hand::Hand;
use project::pictures::load::Loaded;
use render::{Background, Faces, Media, Scene};

/// Distance within which the pointer catches a handle or the dividing line of the wipe, points.
const REACH: f32 = 11.0;

/// Background of volumes that are rendered in white.
pub(crate) const BEHIND_VOLUMES: Color32 = Color32::from_rgb(0x2c, 0x33, 0x3a);

/// The view.
#[derive(Default)]
pub(crate) struct BlockView {
    panes: Vec<Option<TextureHandle>>,
    /// The pixels of the pictures, left to right.
    pixels: Vec<Option<ColorImage>>,
    requested: Option<(Vec<Scene>, u64, bool)>,
    /// The scenes on the screen, once they are drawn at full resolution.
    fine: Option<Vec<Scene>>,
    /// Whether the requested picture, and the one on the screen, have the dark background.
    dark: [bool; 2],
    number: u64,
    shown: u64,
    is_final: bool,
    hand: Hand,
    /// The point of a stick that is dragged.
    held: Option<sticks::Held>,
    lasso: LassoLine,
    device: String,
}

impl BlockView {
    /// The device that draws the pictures.
    pub(crate) fn device(&self) -> &str {
        &self.device
    }

    /// Whether the picture shown is the final one of the present request.
    pub(crate) fn is_settled(&self) -> bool {
        self.is_final && self.shown == self.number
    }

    /// The number of the picture that is shown: later ones have larger numbers.
    pub(crate) fn picture_number(&self) -> u64 {
        self.shown
    }

    /// Copies the picture to the clipboard, on white; of two compared pictures, the illustrated one.
    pub(crate) fn copy(&self, ctx: &eframe::egui::Context) {
        let Some(mut image) = self.pixels.iter().flatten().next().cloned() else { return };
        for pixel in &mut image.pixels {
            let [r, g, b, alpha] = pixel.to_array();
            let white = u8::MAX - alpha;
            *pixel = Color32::from_rgb(r.saturating_add(white), g.saturating_add(white), b.saturating_add(white));
        }
        ctx.copy_image(image);
    }

    /// Takes over a picture that was drawn.
    pub(crate) fn receive(&mut self, ctx: &eframe::egui::Context, drawn: Drawn) {
        if drawn.number < self.shown || drawn.pane >= self.panes.len() {
            return;
        }
        self.shown = drawn.number;
        self.is_final = drawn.is_final;
        self.device = drawn.device;
        if let Some((scenes, ..)) = self.requested.as_ref().filter(|_| drawn.number == self.number) {
            self.dark[1] = self.dark[0];
            if scenes.get(drawn.pane).is_none_or(|scene| scene.size_px != [drawn.image.width(), drawn.image.height()]) {
                self.fine = None;
            } else if drawn.pane + 1 == scenes.len() {
                self.fine = Some(scenes.clone());
            }
        }
        let pixels = texture::pixels(&drawn.image);
        self.pixels.resize(self.panes.len(), None);
        self.pixels[drawn.pane] = Some(pixels.clone());
        texture::keep(&mut self.panes[drawn.pane], ctx, &format!("block {}", drawn.pane), pixels);
    }

    /// Shows the block in all the room there is; returns what is under the cursor.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        rocks: Option<&Rocks>,
        drawing: &Drawing,
        overlay: &Overlay,
        actions: &mut Vec<Action>,
    ) -> Option<Pointed> {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Block"));
        let view = &session.view;
        let holds = |part: &dyn Fn(&Loaded) -> bool| rocks.is_some_and(|loaded| part(loaded));
        let horizons = holds(&|loaded| loaded.candidates.is_some()).then(|| overlay.leaves(session));
        let mut shown = showing::scene(session, horizons.as_deref());
        // Just after interpreting the model is not loaded yet, so there is no relief to draw.
        if !holds(&|loaded| loaded.rock.is_some()) {
            shown.ground = None;
        }
        // Volumes and horizons of the volume rendering are shown once they have been read.
        if view.panel != Panel::Interpret && !holds(&|loaded| loaded.holds_media(&shown.media)) {
            shown.media = Media::default();
        }
        let compare = compare(session);
        let rects = panes(compare, rect);
        let scale = ui.pixels_per_point();
        let scenes: Vec<Scene> = rects
            .iter()
            .zip(State::blends(view))
            .map(|(rect, blend)| {
                let size_px = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
                Scene { size_px, blend, background: Background::Transparent, ..shown.clone() }
            })
            .collect();
        let pane = response
            .hover_pos()
            .map_or(rects[0], |at| *rects.iter().find(|rect| rect.contains(at)).unwrap_or(&rects[0]));
        let geometry = session.document.geometry.as_ref()?;
        let size = dvec(pane.size());
        let handles = if view.handles { faces::handles(&view.scene, geometry, size) } else { Vec::new() };
        let has_lasso = lasso::is_held(ui, session);
        if !has_lasso && !sticks::drag(&mut self.held, ui, session, &response, pane, actions) {
            self.hand.touch(ui, &response, session, [pane, rect], &handles, actions);
        }
        if let Some(rocks) = rocks {
            self.dark[0] = is_dark(session);
            self.request(scenes, rocks, drawing);
        }
        self.paint(ui, session, compare, &rects, rect);
        // In volume rendering the picture contains the horizons, once it is final.
        overlay.surfaces_on_block(ui, session, pane, is_clear(session) && self.is_settled());
        overlay.sticks_on_block(ui, session, pane);
        if let Some(line) = self.lasso.draw(ui, &ui.painter_at(rect), &response, has_lasso) {
            let corners = line.into_iter().map(|at| dvec(at - pane.min)).collect();
            let on = LassoOn::Block(Box::new(view.scene.clone()), size);
            actions.push(Action::Picking(PickingStep::Erase(Lasso { on, corners })));
        }
        if response.contains_pointer() || self.hand.is_closed() {
            self.paint_handles(ui, &handles, pane, response.hover_pos());
        }
        let pointed = response
            .hover_pos()
            .filter(|_| !self.hand.is_closed())
            .and_then(|at| pointer::on_block(rocks?, &shown, size, dvec(at - pane.min)));
        if let (true, Some((how, at)), Some(rocks)) = (is_clear(session), lasso::pick_at(ui, &response, session), rocks)
        {
            // In volume rendering the place that was clicked may lie anywhere behind the face.
            let scene = Scene { size_px: pane_px(pane), ..shown };
            let (root, rocks) = (session.root.clone(), rocks.clone());
            drawing.touch(Touch { root, scene, at: dvec(at - pane.min), how, rocks });
        } else if let Some(pointed) = &pointed {
            lasso::click(ui, &response, session, pointed.voxel, actions);
        }
        pointed
    }

    /// Requests other pictures when something visible has changed.
    fn request(&mut self, scenes: Vec<Scene>, rocks: &Rocks, drawing: &Drawing) {
        let is_moving = self.hand.is_closed();
        let requested = (scenes, rocks.key, is_moving);
        if self.requested.as_ref() == Some(&requested) {
            return;
        }
        self.panes.resize_with(requested.0.len(), || None);
        self.number += 1;
        // Surfaces are painted over the picture at once, so the picture can stay until one that contains them is drawn.
        let is_alike = |fine: &Vec<Scene>| {
            fine.len() == requested.0.len()
                && fine.iter().zip(&requested.0).all(|(fine, scene)| is_but_for_horizons(fine, scene))
        };
        let begins_fine = !is_moving && self.fine.as_ref().is_some_and(is_alike);
        // The same view of other data or styles: its outlines are on the screen already, only colours change.
        let is_restyled = !is_moving && self.fine.as_ref() == Some(&requested.0);
        drawing.draw(PictureRequest {
            number: self.number,
            scenes: requested.0.clone(),
            rocks: rocks.clone(),
            is_moving,
            begins_fine,
            is_restyled,
        });
        self.requested = Some(requested);
    }

    fn paint(&self, ui: &Ui, session: &Session, compare: Compare, rects: &[Rect], whole: Rect) {
        let painter = ui.painter_at(whole);
        painter.rect_filled(whole, 0.0, if self.dark[1] { BEHIND_VOLUMES } else { paper(ui) });
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let wipe = session.view.wipe;
        for (index, (rect, texture)) in rects.iter().zip(&self.panes).enumerate() {
            let Some(texture) = texture else { continue };
            let clip = clip(compare, index, *rect, wipe);
            ui.painter_at(clip).image(texture.id(), fitted(*rect, texture.size_vec2()), uv, Color32::WHITE);
        }
        rule(ui, compare, whole, wipe);
    }

    fn paint_handles(&self, ui: &Ui, handles: &[Handle], pane: Rect, pointer: Option<Pos2>) {
        let accent = theme::accent(ui.visuals());
        let held = self.hand.face();
        if held.is_none() && self.hand.is_closed() {
            return;
        }
        let painter = ui.painter_at(pane);
        for handle in handles {
            let at = screen(pane, handle.at);
            let is_hot = held == Some(handle.face)
                || held.is_none() && pointer.is_some_and(|pointer| (pointer - at).length() < REACH);
            let along = Vec2::new(handle.along.x as f32, handle.along.y as f32).normalized() * 15.0;
            if is_hot {
                painter.line_segment([at - along, at + along], Stroke::new(2.5, accent));
            }
            painter.circle(at, if is_hot { 7.0 } else { 5.0 }, Color32::WHITE, Stroke::new(2.0, accent));
        }
    }
}

/// Whether two scenes differ in nothing but the horizons in their volume rendering.
fn is_but_for_horizons(one: &Scene, other: &Scene) -> bool {
    let without = |scene: &Scene| {
        let mut scene = scene.clone();
        scene.media.horizons.clear();
        scene
    };
    without(one) == without(other)
}

/// Whether the block shows volume rendering while interpreting.
pub fn is_clear(session: &Session) -> bool {
    session.view.panel == Panel::Interpret && session.view.picking.look == Look::VolumeRendering
}

/// The size of a pane in points, as the size of a picture.
fn pane_px(pane: Rect) -> [u32; 2] {
    [pane.width(), pane.height()].map(|side| side.max(1.0) as u32)
}

/// Whether the block has the dark background, because volumes are white.
pub(crate) fn is_dark(session: &Session) -> bool {
    is_clear(session) || session.view.panel != Panel::Interpret && session.view.scene.media.faces == Faces::None
}

/// The background of pictures.
pub fn paper(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { Color32::from_rgb(0xd2, 0xcf, 0xc8) } else { Color32::WHITE }
}

fn dvec(v: Vec2) -> DVec2 {
    DVec2::new(f64::from(v.x), f64::from(v.y))
}

fn screen(pane: Rect, at: DVec2) -> Pos2 {
    pane.min + Vec2::new(at.x as f32, at.y as f32)
}
