//! The fence view: a section along a line whose corners are clicked on the slice beside it.
//!
//! Spaces: s along the line and t down, in traces and samples; points of the window.

use super::lasso;
use super::overlay::Overlay;
use super::pointer::{self, Pointed};
use super::sections::name_across;
use super::texture;
use crate::state::{Action, Panel, Session};
use crate::widgets::canvas;
use crate::widgets::obstacle::{needs, unless};
use crate::work::fence::FenceRequest;
use crate::work::{Rocks, Slices};
use eframe::egui::{Button, Context, Rect, Role, Sense, TextureHandle, Ui, Vec2, WidgetInfo, vec2};
use figure::cut::{CutLine, FenceCut, length_m, place, stations};
use figure::draw::axes::{self, Axis, axis_title};
use figure::draw::section::{Marks, SectionContents};
use glam::DVec2;
use image::RgbaImage;
use render::FaceData;
use std::sync::Arc;

/// Margin for the numbers at the left and the top, points.
const MARGIN: Vec2 = vec2(52.0, 20.0);

/// The view.
#[derive(Default)]
pub(crate) struct FenceView {
    texture: Option<TextureHandle>,
    shown: Option<Shown>,
    requested: Option<(Vec<DVec2>, u64, FaceData)>,
}

/// The fence in the form that figures take.
struct Shown {
    corners: Vec<DVec2>,
    image: Arc<RgbaImage>,
    lines: Vec<CutLine>,
}

impl FenceView {
    /// Takes over a fence that was cut.
    pub(crate) fn receive(&mut self, ctx: &Context, cut: FenceCut) {
        texture::keep(&mut self.texture, ctx, "fence", texture::pixels(&cut.image));
        self.shown = Some(Shown { corners: cut.corners, image: Arc::new(cut.image), lines: cut.lines });
    }

    /// Shows the fence in all the room there is; returns what is under the cursor.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        rocks: Option<&Rocks>,
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
        if let Some(rocks) = rocks {
            let requested = (corners.clone(), rocks.key, show);
            if self.requested.as_ref() != Some(&requested) {
                slices.cut_fence(FenceRequest { corners: corners.clone(), rocks: rocks.clone(), show });
                self.requested = Some(requested);
            }
        }
        let (whole, response) = ui.allocate_exact_size(ui.available_size(), Sense::click());
        let body = body_of(whole);
        if !body.is_positive() {
            return None;
        }
        let painted = self.paint(ui, session, whole, overlay);
        let label = if painted.is_some() { "Fence section" } else { "The fence section is being cut" };
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, label));
        painted?;
        let length = stations(&corners).last().copied().unwrap_or(1.0).max(1e-6);
        let depth = geometry.size()[2].saturating_sub(1).max(1) as f64;
        let pointer = response.hover_pos().filter(|pointer| body.contains(*pointer))?;
        let share = (pointer - body.min) / body.size();
        let at = place(&corners, f64::from(share.x) * length);
        let voxel = at.extend(f64::from(share.y) * depth);
        lasso::click(ui, &response, session, voxel, actions);
        Some(pointer::at_voxel(rocks?, voxel.as_vec3(), None))
    }

    /// Paints the fence with its numbers into a rectangle; nothing until it has been cut.
    fn paint(&self, ui: &Ui, session: &Session, whole: Rect, overlay: &mut Overlay) -> Option<()> {
        let geometry = session.document.geometry.as_ref()?;
        let corners: Vec<DVec2> = session.view.fence.iter().copied().map(DVec2::from_array).collect();
        let body = body_of(whole);
        let painter = ui.painter_at(body);
        painter.rect_filled(body, 0.0, super::block::paper(ui));
        let shown = self.shown.as_ref().filter(|shown| shown.corners == corners)?;
        let along = stations(&corners);
        let depth = geometry.size()[2].saturating_sub(1).max(1) as f64;
        let extent = DVec2::new(along.last().copied().unwrap_or(1.0).max(1e-6), depth);
        let seen = canvas::page_rect(body);
        let is_interpreting = session.view.panel == Panel::Interpret;
        let contents = SectionContents {
            image: &shown.image,
            extent,
            lines: if is_interpreting { &[] } else { &shown.lines },
            horizons: &project::pictures::figures::horizons(&session.document),
            faults: &[],
            fault_colours: &session.document.faults.iter().map(|entry| entry.colour).collect::<Vec<_>>(),
            interpretation: None,
            // Lines at the corners of the fence.
            marks: Marks { down: along[1..along.len() - 1].to_vec(), ..Marks::default() },
        };
        canvas::paint(&painter, &contents.drawn(seen, seen), self.texture.as_ref().map(TextureHandle::id));
        if is_interpreting {
            overlay.on_fence(&painter, session, &corners, |st| seen.min + st / extent * seen.size());
        }
        let axis = |name: String, ends: [f64; 2], at: [f64; 2]| Axis { name, ends, at, least_step: 0.0 };
        let across = axis("m".to_owned(), [0.0, length_m(geometry, &corners)], [seen.min.x, seen.max.x]);
        let down = [0.0, depth].map(|index| geometry.vertical.value_at(index));
        let down = axis(axis_title(geometry, 2).to_owned(), down, [seen.min.y, seen.max.y]);
        let drawn = axes::drawn(canvas::page_rect(whole), seen, [&across, &down]);
        canvas::paint(&ui.painter_at(whole), &canvas::on_window(drawn, ui.visuals()), None);
        name_across(ui, whole, body, &across.name);
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
        let line = needs(some, "Click the corners of a line on the slice first");
        if unless(ui, line, Button::new("Remove last corner")).clicked() {
            actions.push(Action::Fence(last.iter().map(|at| at.to_array()).collect()));
        }
        if unless(ui, line, Button::new("New line")).clicked() {
            actions.push(Action::Fence(Vec::new()));
        }
    });
}
