//! A fence: a section along a line that is drawn on the slice beside it, corner by corner.
//!
//! Spaces: s along the line and t down, one a trace and a sample; points of the window.

use super::lasso;
use super::overlay::Overlay;
use super::pointed::{self, Pointed};
use super::sections::{draw_line, round_step};
use super::texture;
use crate::state::{Action, Panel, Session};
use crate::theme;
use crate::work::fence::{FencePicture, FenceWish, place, stations};
use crate::work::{Rocks, Slices};
use eframe::egui::{
    Align2, Button, Color32, Context, FontId, Pos2, Rect, Role, Sense, Stroke, TextureHandle, Ui, Vec2, WidgetInfo,
    pos2, vec2,
};
use glam::DVec2;
use render::FaceData;

/// Room for numbers at the left and the top, points.
const MARGIN: Vec2 = vec2(52.0, 20.0);
/// Least distance between numbers along an axis, points.
const TICK_EVERY: f32 = 74.0;

/// The view.
#[derive(Default)]
pub struct FenceView {
    texture: Option<TextureHandle>,
    shown: Option<FencePicture>,
    wished: Option<(Vec<DVec2>, u64, FaceData)>,
}

impl FenceView {
    /// Takes a fence in.
    pub fn receive(&mut self, ctx: &Context, picture: FencePicture) {
        texture::keep(&mut self.texture, ctx, "fence", texture::pixels(&picture.image));
        self.shown = Some(picture);
    }

    /// Shows the fence in all the room there is; answers what is under the cursor.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        rocks: Option<(&Rocks, u64)>,
        slices: &Slices,
        overlay: &mut Overlay,
        actions: &mut Vec<Action>,
    ) -> Option<Pointed> {
        let geometry = session.document.geometry.as_ref()?;
        let corners: Vec<DVec2> = session.view.fence.iter().copied().map(DVec2::from_array).collect();
        header(ui, &corners, actions);
        if corners.len() < 2 {
            ui.label("Click on the slice: each click is a corner of the line that the section runs along.");
            return None;
        }
        let is_interpreting = session.view.panel == Panel::Interpret;
        let show = if is_interpreting { session.view.picking.show } else { FaceData::Rock };
        if let Some((rocks, version)) = rocks {
            let wished = (corners.clone(), version, show);
            if self.wished.as_ref() != Some(&wished) {
                slices.cut_fence(FenceWish { corners: corners.clone(), rocks: rocks.clone(), show });
                self.wished = Some(wished);
            }
        }
        let (whole, response) = ui.allocate_exact_size(ui.available_size(), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Fence section"));
        let body = body_of(whole);
        if !body.is_positive() {
            return None;
        }
        self.paint(ui, session, whole, overlay)?;
        let length = stations(&corners).last().copied().unwrap_or(1.0).max(1e-6);
        let depth = geometry.size()[2].saturating_sub(1).max(1) as f64;
        let pointer = response.hover_pos().filter(|pointer| body.contains(*pointer))?;
        let share = (pointer - body.min) / body.size();
        let at = place(&corners, f64::from(share.x) * length);
        let voxel = at.extend(f64::from(share.y) * depth);
        lasso::click(ui, &response, session, voxel, actions);
        let loaded = rocks?.0.try_read().ok()?;
        Some(pointed::at_voxel(&loaded, voxel.as_vec3(), None))
    }

    /// Paints the fence with its numbers into a rectangle; nothing where it is not cut yet.
    pub fn paint(&self, ui: &Ui, session: &Session, whole: Rect, overlay: &mut Overlay) -> Option<()> {
        let geometry = session.document.geometry.as_ref()?;
        let corners: Vec<DVec2> = session.view.fence.iter().copied().map(DVec2::from_array).collect();
        let body = body_of(whole);
        let painter = ui.painter_at(body);
        painter.rect_filled(body, 0.0, super::block::paper(ui));
        let shown = self.shown.as_ref().filter(|shown| shown.corners == corners)?;
        let along = stations(&corners);
        let length = along.last().copied().unwrap_or(1.0).max(1e-6);
        let depth = geometry.size()[2].saturating_sub(1).max(1) as f64;
        let to_screen = |st: DVec2| -> Pos2 {
            body.min + vec2((st.x / length) as f32 * body.width(), (st.y / depth) as f32 * body.height())
        };
        if let Some(texture) = &self.texture {
            painter.image(texture.id(), body, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        }
        if session.view.panel == Panel::Interpret {
            overlay.on_fence(&painter, session, &corners, &to_screen);
        } else {
            for line in &shown.lines {
                let points = line.points.iter().map(|st| to_screen(*st)).collect();
                draw_line(&painter, points, line.kind, line.quality, session);
            }
        }
        let accent = theme::accent(ui.visuals());
        for s in &along[1..along.len() - 1] {
            painter.vline(to_screen(DVec2::new(*s, 0.0)).x, body.y_range(), Stroke::new(1.2, accent));
        }
        let metres = |corners: &[DVec2]| -> f64 {
            corners
                .windows(2)
                .map(|pair| {
                    let step = pair[1] - pair[0];
                    (geometry.inline_vector * step.x + geometry.crossline_vector * step.y).length()
                })
                .sum()
        };
        let ends = [geometry.vertical.value_at(0.0), geometry.vertical.value_at(depth)];
        ticks(ui, whole, body, [[0.0, metres(&corners)], ends]);
        Some(())
    }
}

/// The section itself, without the numbers along its edges.
fn body_of(whole: Rect) -> Rect {
    Rect::from_min_max(whole.min + MARGIN, whole.max - vec2(13.0, 4.0))
}

fn header(ui: &mut Ui, corners: &[DVec2], actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        ui.strong("Fence");
        let last = &corners[..corners.len().saturating_sub(1)];
        let some = !corners.is_empty();
        if ui.add_enabled(some, Button::new("Last corner back")).clicked() {
            actions.push(Action::Fence(last.iter().map(|at| at.to_array()).collect()));
        }
        if ui.add_enabled(some, Button::new("New line")).clicked() {
            actions.push(Action::Fence(Vec::new()));
        }
    });
}

/// Metres along the upper edge, vertical values along the left one.
fn ticks(ui: &Ui, whole: Rect, body: Rect, ends: [[f64; 2]; 2]) {
    let font = FontId::proportional(11.5);
    let colour = ui.visuals().weak_text_color();
    let painter = ui.painter_at(whole);
    for (direction, [first, last]) in ends.into_iter().enumerate() {
        let room = if direction == 0 { body.width() } else { body.height() };
        let per_point = (last - first) / f64::from(room);
        if per_point <= 0.0 {
            continue;
        }
        let step = round_step(per_point * f64::from(TICK_EVERY));
        let mut value = (first / step).ceil() * step;
        while value <= last {
            let at = ((value - first) / per_point) as f32;
            let unit = if direction == 0 { " m" } else { "" };
            let text = if step < 1.0 { format!("{value:.1}{unit}") } else { format!("{value:.0}{unit}") };
            if direction == 0 {
                let x = body.left() + at;
                painter.vline(x, body.top() - 4.0..=body.top(), Stroke::new(1.0, colour));
                painter.text(pos2(x, body.top() - 5.0), Align2::CENTER_BOTTOM, text, font.clone(), colour);
            } else {
                let y = body.top() + at;
                painter.hline(body.left() - 4.0..=body.left(), y, Stroke::new(1.0, colour));
                painter.text(pos2(body.left() - 6.0, y), Align2::RIGHT_CENTER, text, font.clone(), colour);
            }
            value += step;
        }
    }
}
