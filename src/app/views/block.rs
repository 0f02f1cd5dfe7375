//! The block: pictures from the painter, turned and cut by hand.
//!
//! Two spaces: points of the window, and pixels of the picture (points × the display's scale). Cameras are changed in points: [`camera`]
//! needs proportions only.

use super::lasso::{self, LassoLine};
use super::overlay::Overlay;
use super::pointed::{self, Pointed};
use super::texture;
use crate::app::state::faces::{self, Handle};
use crate::app::state::{Action, Compare, Lasso, LassoOn, Look, Panel, PickingStep, Session, State, camera, showing};
use crate::app::theme;
use crate::app::work::{Drawing, Drawn, PictureWish, Rocks, Touch};
use crate::pipeline::Loaded;
use eframe::egui::{
    Align2, Color32, ColorImage, CursorIcon, FontId, Modifiers, PointerButton, Pos2, Rect, Response, Role, Sense,
    Stroke, TextureHandle, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use glam::DVec2;
use render::{Background, Scene};

/// How near the pointer must be to take hold of a handle or of the wipe's line, points.
const REACH: f32 = 11.0;
/// Natural logarithm of the zoom that a point of wheel travel makes.
const WHEEL: f64 = 0.0022;
/// Wheel travel that moves a face by a sample, points.
const WHEEL_STEP: f32 = 24.0;

/// A view is narrow for two blocks beside one another below this width, heights.
const NARROW: f32 = 1.4;

/// What white volumes are seen before.
pub const BEHIND_VOLUMES: Color32 = Color32::from_rgb(0x2c, 0x33, 0x3a);

/// What the hand holds.
enum Grab {
    Turn,
    Shift,
    Wipe,
    Face { handle: Handle, start: Box<Scene>, from: Pos2, size: DVec2 },
}

/// The view.
#[derive(Default)]
pub struct BlockView {
    panes: Vec<Option<TextureHandle>>,
    /// The pictures' pixels, left to right.
    pixels: Vec<Option<ColorImage>>,
    wished: Option<(Vec<Scene>, u64, bool)>,
    /// The scenes on the screen, if they are drawn in all their pixels.
    fine: Option<Vec<Scene>>,
    number: u64,
    shown: u64,
    is_final: bool,
    grab: Option<Grab>,
    /// Wheel travel over a handle not yet used, points.
    wheel: f32,
    lasso: LassoLine,
    device: String,
}

impl BlockView {
    /// What draws the pictures.
    pub fn device(&self) -> &str {
        &self.device
    }

    /// Whether the picture shown is the last word on what is wished.
    pub fn is_settled(&self) -> bool {
        self.is_final && self.shown == self.number
    }

    /// Puts the picture on the clipboard, on white; of two that are compared, the illustrated one.
    pub fn copy(&self, ctx: &eframe::egui::Context) {
        let Some(mut image) = self.pixels.iter().flatten().next().cloned() else { return };
        for pixel in &mut image.pixels {
            let [r, g, b, alpha] = pixel.to_array();
            let white = u8::MAX - alpha;
            *pixel = Color32::from_rgb(r.saturating_add(white), g.saturating_add(white), b.saturating_add(white));
        }
        ctx.copy_image(image);
    }

    /// Takes a picture in.
    pub fn receive(&mut self, ctx: &eframe::egui::Context, drawn: Drawn) {
        if drawn.number < self.shown || drawn.pane >= self.panes.len() {
            return;
        }
        self.shown = drawn.number;
        self.is_final = drawn.is_final;
        self.device = drawn.device;
        if let Some((scenes, ..)) = self.wished.as_ref().filter(|_| drawn.number == self.number) {
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

    /// Shows the block in all the room there is; answers what is under the cursor.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        rocks: Option<(&Rocks, u64)>,
        drawing: &Drawing,
        overlay: &Overlay,
        actions: &mut Vec<Action>,
    ) -> Option<Pointed> {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Block"));
        let view = &session.view;
        let holds = |part: fn(&Loaded) -> bool| {
            rocks.is_some_and(|(rocks, _)| rocks.try_read().is_ok_and(|loaded| part(&loaded)))
        };
        let horizons = holds(|loaded| loaded.candidates.is_some()).then(|| overlay.leaves(session));
        let mut shown = showing::scene(session, horizons.as_deref());
        // After interpreting there is no model yet to take the relief from.
        if !holds(|loaded| loaded.rock.is_some()) {
            shown.ground = None;
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
        if !has_lasso {
            self.touch(ui, &response, session, pane, rect, &handles, actions);
        }
        if let Some((rocks, version)) = rocks {
            self.wish(scenes, rocks, version, drawing);
        }
        self.paint(ui, session, compare, &rects, rect);
        // Where the block is seen through, the picture shows the horizons itself, once it is drawn.
        if !is_clear(session) || !self.is_settled() {
            overlay.surfaces_on_block(ui, session, pane);
        }
        overlay.sticks_on_block(ui, session, pane);
        if let Some(line) = self.lasso.draw(&ui.painter_at(rect), &response, has_lasso) {
            let corners = line.into_iter().map(|at| dvec(at - pane.min)).collect();
            let on = LassoOn::Block(Box::new(view.scene.clone()), size);
            actions.push(Action::Picking(PickingStep::Erase(Lasso { on, corners })));
        }
        if response.contains_pointer() || self.grab.is_some() {
            self.paint_handles(ui, &handles, pane, response.hover_pos());
        }
        let pointed = response.hover_pos().filter(|_| self.grab.is_none()).and_then(|at| {
            let loaded = rocks?.0.try_read().ok()?;
            pointed::on_block(&loaded, &shown, size, dvec(at - pane.min))
        });
        if let (true, Some((how, at)), Some((rocks, _))) =
            (is_clear(session), lasso::pick_at(ui, &response, session), rocks)
        {
            // What is seen there may lie anywhere behind the face.
            let scene = Scene { size_px: pane_px(pane), ..shown };
            let (root, rocks) = (session.root.clone(), rocks.clone());
            drawing.touch(Touch { root, scene, at: dvec(at - pane.min), how, rocks });
        } else if let Some(pointed) = &pointed {
            lasso::click(ui, &response, session, pointed.voxel, actions);
        }
        pointed
    }

    #[expect(clippy::too_many_arguments, reason = "what the hand can touch, and where")]
    fn touch(
        &mut self,
        ui: &Ui,
        response: &Response,
        session: &Session,
        pane: Rect,
        whole: Rect,
        handles: &[Handle],
        actions: &mut Vec<Action>,
    ) {
        let Some(geometry) = session.document.geometry.as_ref() else { return };
        let view = &session.view;
        let size = dvec(pane.size());
        let wipe_x = whole.left() + whole.width() * view.wipe;
        let modifiers = ui.input(|input| input.modifiers);
        if response.drag_started()
            && let Some(at) = ui.input(|input| input.pointer.press_origin())
        {
            let handle = handles.iter().find(|handle| (screen(pane, handle.at) - at).length() < REACH);
            self.grab = Some(match handle {
                _ if view.compare == Compare::Wipe && (at.x - wipe_x).abs() < REACH => Grab::Wipe,
                Some(handle) => Grab::Face { handle: *handle, start: Box::new(view.scene.clone()), from: at, size },
                None if modifiers.shift || !response.dragged_by(PointerButton::Primary) => Grab::Shift,
                None => Grab::Turn,
            });
        }
        let mut scene = view.scene.clone();
        let delta = dvec(response.drag_delta());
        if let (Some(grab), Some(at)) = (&self.grab, response.interact_pointer_pos()) {
            match grab {
                Grab::Turn => camera::orbit(&mut scene, geometry, size, delta),
                Grab::Shift => camera::pan(&mut scene, size, delta),
                Grab::Wipe => actions.push(Action::Wipe((at.x - whole.left()) / whole.width())),
                Grab::Face { handle, start, from, size } => {
                    scene = faces::pull(start, geometry, *size, handle, dvec(at - *from));
                }
            }
        }
        if response.drag_stopped() || !response.dragged() {
            self.grab = None;
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let is_near = |handle: &&Handle| (screen(pane, handle.at) - at).length() < REACH;
            let factor = (f64::from(scroll) * WHEEL).exp() * f64::from(pinch);
            if let Some(handle) = handles.iter().find(is_near) {
                self.wheel += scroll;
                let steps = (self.wheel / WHEEL_STEP).trunc();
                self.wheel -= steps * WHEEL_STEP;
                if steps != 0.0 {
                    scene = faces::move_face(&scene, geometry, size, handle.face, f64::from(steps));
                }
            } else if (factor - 1.0).abs() > 1e-6 {
                camera::zoom_at(&mut scene, size, dvec(at - pane.min), factor);
            }
            let on_wipe = view.compare == Compare::Wipe && (at.x - wipe_x).abs() < REACH;
            if on_wipe {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
            } else if handles.iter().any(|handle| is_near(&handle)) {
                ui.ctx().set_cursor_icon(CursorIcon::Grab);
            }
        }
        if response.double_clicked() && modifiers == Modifiers::NONE {
            actions.push(Action::Stand(crate::app::state::StandardView::Block));
        }
        if scene != view.scene {
            actions.push(Action::Show(Box::new(scene)));
        }
    }

    /// Asks for other pictures when something that shows has changed.
    fn wish(&mut self, scenes: Vec<Scene>, rocks: &Rocks, version: u64, drawing: &Drawing) {
        let is_moving = self.grab.is_some();
        let wished = (scenes, version, is_moving);
        if self.wished.as_ref() == Some(&wished) {
            return;
        }
        self.panes.resize_with(wished.0.len(), || None);
        self.number += 1;
        // Surfaces are laid over the picture at once: it can stay until one with them in it is there.
        let is_alike = |fine: &Vec<Scene>| {
            fine.len() == wished.0.len()
                && fine.iter().zip(&wished.0).all(|(fine, scene)| is_but_for_horizons(fine, scene))
        };
        let begins_fine = !is_moving && self.fine.as_ref().is_some_and(is_alike);
        drawing.draw(PictureWish {
            number: self.number,
            scenes: wished.0.clone(),
            rocks: rocks.clone(),
            is_moving,
            begins_fine,
        });
        self.wished = Some(wished);
    }

    fn paint(&self, ui: &Ui, session: &Session, compare: Compare, rects: &[Rect], whole: Rect) {
        let painter = ui.painter_at(whole);
        painter.rect_filled(whole, 0.0, if is_clear(session) { BEHIND_VOLUMES } else { paper(ui) });
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
        let held = match &self.grab {
            Some(Grab::Face { handle, .. }) => Some(handle.face),
            Some(_) => return,
            None => None,
        };
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

/// Whether two pictures differ in nothing but the horizons that are seen in them.
fn is_but_for_horizons(one: &Scene, other: &Scene) -> bool {
    let without = |scene: &Scene| {
        let mut scene = scene.clone();
        scene.media.horizons.clear();
        scene
    };
    without(one) == without(other)
}

/// How pictures are compared: while interpreting there is only one.
pub fn compare(session: &Session) -> Compare {
    if session.view.panel == Panel::Interpret { Compare::Blend } else { session.view.compare }
}

/// Where each of the compared pictures lies. Blocks are broader than high: in a narrow view two stand one over the other.
pub fn panes(compare: Compare, rect: Rect) -> Vec<Rect> {
    match compare {
        Compare::SideBySide => {
            let (first, second) = if is_narrow(rect) {
                rect.split_top_bottom_at_fraction(0.5)
            } else {
                rect.split_left_right_at_fraction(0.5)
            };
            vec![first, second]
        }
        Compare::Blend => vec![rect],
        Compare::Wipe => vec![rect, rect],
    }
}

fn is_narrow(rect: Rect) -> bool {
    rect.width() < NARROW * rect.height()
}

/// The part of a pane that its picture is seen in.
pub fn clip(compare: Compare, index: usize, rect: Rect, wipe: f32) -> Rect {
    let wipe_x = rect.left() + rect.width() * wipe;
    match (compare, index) {
        (Compare::Wipe, 0) => Rect::from_min_max(rect.min, pos2(wipe_x, rect.max.y)),
        (Compare::Wipe, _) => Rect::from_min_max(pos2(wipe_x, rect.min.y), rect.max),
        _ => rect,
    }
}

/// What parts compared pictures, and which is which.
pub fn rule(ui: &Ui, compare: Compare, whole: Rect, wipe: f32) {
    let painter = ui.painter_at(whole);
    let thin = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    let (at, align) = match compare {
        Compare::Blend => return,
        Compare::SideBySide if is_narrow(whole) => {
            painter.hline(whole.x_range(), whole.center().y, thin);
            ([whole.min, whole.left_center()].map(|at| at + vec2(12.0, 10.0)), [Align2::LEFT_TOP; 2])
        }
        _ => {
            let accent = theme::accent(ui.visuals());
            let is_wipe = compare == Compare::Wipe;
            let x = if is_wipe { whole.left() + whole.width() * wipe } else { whole.center().x };
            painter.vline(x, whole.y_range(), if is_wipe { Stroke::new(2.0, accent) } else { thin });
            if is_wipe {
                painter.circle_filled(pos2(x, whole.center().y), 8.0, accent);
            }
            let top = pos2(x, whole.top() + 10.0);
            ([top - vec2(12.0, 0.0), top + vec2(12.0, 0.0)], [Align2::RIGHT_TOP, Align2::LEFT_TOP])
        }
    };
    for ((at, align), text) in at.into_iter().zip(align).zip(["illustrated", "raw"]) {
        // Pictures lie on light paper in either theme.
        painter.text(at, align, text, FontId::proportional(13.0), Color32::from_gray(0x20));
    }
}

/// Whether the block is seen through.
pub fn is_clear(session: &Session) -> bool {
    session.view.panel == Panel::Interpret && session.view.picking.look == Look::SeeThrough
}

/// A pane's size in points, as a picture's.
fn pane_px(pane: Rect) -> [u32; 2] {
    [pane.width(), pane.height()].map(|side| side.max(1.0) as u32)
}

/// The largest rectangle of a picture's shape in the middle of another: a picture of before the view was resized keeps its shape.
fn fitted(rect: Rect, shape: Vec2) -> Rect {
    let scale = (rect.width() / shape.x).min(rect.height() / shape.y);
    let is_same = (rect.width() / rect.height() / (shape.x / shape.y) - 1.0).abs() < 0.03;
    if is_same { rect } else { Rect::from_center_size(rect.center(), shape * scale) }
}

/// What pictures lie on.
pub fn paper(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { Color32::from_rgb(0xd2, 0xcf, 0xc8) } else { Color32::WHITE }
}

fn dvec(v: Vec2) -> DVec2 {
    DVec2::new(f64::from(v.x), f64::from(v.y))
}

fn screen(pane: Rect, at: DVec2) -> Pos2 {
    pane.min + Vec2::new(at.x as f32, at.y as f32)
}
