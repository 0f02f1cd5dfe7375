//! Inline, crossline and slice through one point: amplitudes with horizons and faults over them.
//!
//! Spaces: (s, t) of the section, one a sample; points of the window, y down. Both axes are stretched to the view, so a section fills
//! it whatever its shape; the wheel with Ctrl zooms about the pointer, a drag moves, the wheel alone goes to the next section.

use super::lasso::{self, LassoLine};
use super::overlay::Overlay;
use super::pointed::{self, Pointed};
use crate::app::state::{Action, Lasso, LassoOn, Layout, Panel, PickingStep, Session, SliceKind};
use crate::app::theme;
use crate::app::work::{Rocks, SlicePicture, SliceWish, Slices};
use crate::project::document::HorizonEntry;
use eframe::egui::{
    Align2, Color32, ColorImage, Context, DragValue, FontId, Pos2, Rect, Role, Sense, Shape, Stroke, TextureHandle,
    TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use glam::{DVec2, DVec3};
use render::FaceData;
use std::collections::HashMap;
use survey::SurveyGeometry;
use survey::section::{LineKind, LineQuality};

/// Room for numbers at the left and the top, points.
const MARGIN: Vec2 = vec2(52.0, 20.0);
/// Least distance between numbers along an axis, points.
const TICK_EVERY: f32 = 74.0;
/// Zoom stays between these.
const ZOOM: [f32; 2] = [1.0, 40.0];
/// Wheel travel that goes to the next section, points.
const WHEEL_STEP: f32 = 24.0;

/// One section on the screen.
struct Pane {
    texture: Option<TextureHandle>,
    shown: Option<SlicePicture>,
    wished: Option<(f64, u64, FaceData)>,
    zoom: f32,
    /// Which part of the section is in the middle, shares.
    middle: Vec2,
    /// Wheel travel not yet used.
    wheel: f32,
    lasso: LassoLine,
}

impl Default for Pane {
    fn default() -> Self {
        Self {
            texture: None,
            shown: None,
            wished: None,
            zoom: 1.0,
            middle: vec2(0.5, 0.5),
            wheel: 0.0,
            lasso: LassoLine::default(),
        }
    }
}

/// The three sections.
#[derive(Default)]
pub struct Sections {
    panes: HashMap<SliceKind, Pane>,
}

impl Sections {
    /// Takes a section in.
    pub fn receive(&mut self, ctx: &Context, picture: SlicePicture) {
        let pane = self.panes.entry(picture.kind).or_default();
        let size = [picture.image.width() as usize, picture.image.height() as usize];
        let image = ColorImage::from_rgba_unmultiplied(size, &picture.image);
        match &mut pane.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            none => *none = Some(ctx.load_texture(format!("{:?}", picture.kind), image, TextureOptions::LINEAR)),
        }
        pane.shown = Some(picture);
    }

    /// Shows one section in all the room there is; answers what is under the cursor.
    #[expect(clippy::too_many_arguments, reason = "a panel is handed the parts of the window it needs, and no others")]
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        kind: SliceKind,
        rocks: Option<(&Rocks, u64)>,
        slices: &Slices,
        overlay: &mut Overlay,
        actions: &mut Vec<Action>,
    ) -> Option<Pointed> {
        let geometry = session.document.geometry.as_ref()?;
        let pane = self.panes.entry(kind).or_default();
        let at = session.view.slices[kind.axis()];
        let is_interpreting = session.view.panel == Panel::Interpret;
        let show = if is_interpreting { session.view.picking.show } else { FaceData::Rock };
        if let Some((rocks, version)) = rocks
            && pane.wished != Some((at, version, show))
        {
            pane.wished = Some((at, version, show));
            slices.cut(SliceWish { kind, at, rocks: rocks.clone(), show });
        }
        header(ui, session, kind, geometry, actions);
        let (whole, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("{} section", name(kind))));
        let body = Rect::from_min_max(whole.min + MARGIN, whole.max - vec2(4.0, 4.0));
        if !body.is_positive() {
            return None;
        }
        let has_lasso = lasso::is_held(ui, session);
        if !has_lasso {
            pane.touch(ui, &response, body);
        }
        let extent = extent(kind, geometry.size());
        let image = pane.image_rect(body);
        let painter = ui.painter_at(body);
        painter.rect_filled(body, 0.0, super::block::paper(ui));
        if let Some(texture) = &pane.texture {
            // Sample centres lie at the ends of the axes: half a pixel of the raster hangs over.
            let half = vec2(0.5 / (extent.x as f32 + 1.0), 0.5 / (extent.y as f32 + 1.0));
            let uv = Rect::from_min_max(pos2(half.x, half.y), pos2(1.0 - half.x, 1.0 - half.y));
            painter.image(texture.id(), image, uv, Color32::WHITE);
        }
        let to_screen = |st: DVec2| {
            image.min + vec2((st.x / extent.x) as f32 * image.width(), (st.y / extent.y) as f32 * image.height())
        };
        if let Some(picture) = pane.shown.as_ref().filter(|_| session.view.panel != Panel::Interpret) {
            for line in &picture.lines {
                let points: Vec<Pos2> = line.points.iter().map(|st| to_screen(*st)).collect();
                draw_line(&painter, points, line.kind, line.quality, session);
            }
        }
        overlay.on_section(&painter, session, kind, &to_screen);
        fence_line(ui, &painter, session, kind, &to_screen);
        cross(ui, &painter, session, kind, body, &to_screen);
        ticks(ui, whole, body, image, kind, geometry);
        let to_section = |pointer: Pos2| {
            let share = (pointer - image.min) / image.size();
            DVec2::new(f64::from(share.x) * extent.x, f64::from(share.y) * extent.y)
        };
        if let Some(line) = pane.lasso.draw(&painter, &response, has_lasso) {
            let corners = line.into_iter().map(to_section).collect();
            let on = LassoOn::Section(kind, at);
            actions.push(Action::Picking(PickingStep::Erase(Lasso { on, corners })));
        }
        let st = response.hover_pos().filter(|pointer| body.contains(*pointer)).map(to_section)?;
        if !(st.x >= 0.0 && st.y >= 0.0 && st.x <= extent.x && st.y <= extent.y) {
            return None;
        }
        let voxel = voxel(kind, at, st);
        pane.step(ui, session, kind, actions);
        if kind == SliceKind::Slice && session.view.layout == Layout::Fence {
            if response.clicked() {
                let mut fence = session.view.fence.clone();
                fence.push([voxel.x, voxel.y]);
                actions.push(Action::Fence(fence));
            }
        } else {
            lasso::click(ui, &response, session, voxel, actions);
        }
        let loaded = rocks?.0.try_read().ok()?;
        Some(pointed::at_voxel(&loaded, voxel.as_vec3(), Some(kind.axis())))
    }
}

impl Pane {
    /// Where the whole section lies on the screen.
    fn image_rect(&self, body: Rect) -> Rect {
        let size = body.size() * self.zoom;
        Rect::from_min_size(body.center() - self.middle * size, size)
    }

    fn touch(&mut self, ui: &Ui, response: &eframe::egui::Response, body: Rect) {
        if response.dragged() {
            self.middle -= response.drag_delta() / (body.size() * self.zoom);
        }
        if let Some(pointer) = response.hover_pos() {
            let factor = ui.input(|input| input.zoom_delta());
            if factor != 1.0 {
                let before = self.image_rect(body);
                let share = (pointer - before.min) / before.size();
                self.zoom = (self.zoom * factor).clamp(ZOOM[0], ZOOM[1]);
                self.middle = share - (pointer - body.center()) / (body.size() * self.zoom);
            }
        }
        if response.double_clicked() {
            (self.zoom, self.middle) = (1.0, vec2(0.5, 0.5));
        }
        let half = 0.5 / self.zoom;
        self.middle = self.middle.clamp(Vec2::splat(half), Vec2::splat(1.0 - half));
    }

    /// The wheel goes to the next section.
    fn step(&mut self, ui: &Ui, session: &Session, kind: SliceKind, actions: &mut Vec<Action>) {
        let (scroll, has_zoomed) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta() != 1.0));
        if has_zoomed {
            return;
        }
        self.wheel += scroll;
        let steps = (self.wheel / WHEEL_STEP).trunc();
        if steps != 0.0 {
            self.wheel -= steps * WHEEL_STEP;
            let mut slices = session.view.slices;
            slices[kind.axis()] -= f64::from(steps);
            actions.push(Action::Slices(slices));
        }
    }
}

/// What a section is called.
pub fn name(kind: SliceKind) -> &'static str {
    match kind {
        SliceKind::Inline => "Inline",
        SliceKind::Crossline => "Crossline",
        SliceKind::Slice => "Slice",
    }
}

/// The voxel axes that run to the right and down.
fn axes(kind: SliceKind) -> [usize; 2] {
    match kind {
        SliceKind::Inline => [1, 2],
        SliceKind::Crossline => [0, 2],
        SliceKind::Slice => [0, 1],
    }
}

/// Largest s and t; never 0, so that shares exist.
fn extent(kind: SliceKind, size: [usize; 3]) -> DVec2 {
    let [s, t] = axes(kind).map(|axis| size[axis].saturating_sub(1).max(1) as f64);
    DVec2::new(s, t)
}

/// Voxel position of (s, t).
fn voxel(kind: SliceKind, at: f64, st: DVec2) -> DVec3 {
    match kind {
        SliceKind::Inline => DVec3::new(at, st.x, st.y),
        SliceKind::Crossline => DVec3::new(st.x, at, st.y),
        SliceKind::Slice => DVec3::new(st.x, st.y, at),
    }
}

/// The value that people know a place on a voxel axis by.
fn value_at(geometry: &SurveyGeometry, axis: usize, index: f64) -> f64 {
    match axis {
        0 => geometry.inlines.number_at(index),
        1 => geometry.crosslines.number_at(index),
        _ => geometry.vertical.value_at(index),
    }
}

/// Name and number of the section; the number can be typed and dragged.
fn header(ui: &mut Ui, session: &Session, kind: SliceKind, geometry: &SurveyGeometry, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let label = ui.strong(name(kind));
        let axis = kind.axis();
        let last = geometry.size()[axis].saturating_sub(1) as f64;
        let index = session.view.slices[axis];
        let mut number = value_at(geometry, axis, index);
        let ends = [value_at(geometry, axis, 0.0), value_at(geometry, axis, last)];
        let per_sample = value_at(geometry, axis, 1.0) - value_at(geometry, axis, 0.0);
        let suffix = if axis == 2 { format!(" {}", geometry.vertical.unit.symbol()) } else { String::new() };
        let drag = DragValue::new(&mut number)
            .speed(per_sample.abs() * 0.5)
            .range(ends[0].min(ends[1])..=ends[0].max(ends[1]))
            .max_decimals(if axis == 2 { 1 } else { 0 })
            .suffix(suffix);
        if ui.add(drag).labelled_by(label.id).changed() {
            let mut slices = session.view.slices;
            slices[axis] = ((number - ends[0]) / per_sample).round();
            actions.push(Action::Slices(slices));
        }
        for (word, step) in [("Previous", -1.0), ("Next", 1.0)] {
            let sign = if step < 0.0 { "‹" } else { "›" };
            let button = ui.small_button(sign).on_hover_text(format!("{word} {}", name(kind).to_lowercase()));
            if button.clicked() {
                let mut slices = session.view.slices;
                slices[axis] += step;
                actions.push(Action::Slices(slices));
            }
        }
    });
}

/// Colours of horizons, youngest first, told apart by most eyes and on grey.
const HORIZON_COLOURS: [Color32; 8] = [
    Color32::from_rgb(0x00, 0x9e, 0x73),
    Color32::from_rgb(0xe6, 0x9f, 0x00),
    Color32::from_rgb(0x00, 0x72, 0xb2),
    Color32::from_rgb(0xcc, 0x79, 0xa7),
    Color32::from_rgb(0x56, 0xb4, 0xe9),
    Color32::from_rgb(0xd5, 0x5e, 0x00),
    Color32::from_rgb(0xb8, 0xa8, 0x00),
    Color32::from_rgb(0x66, 0x33, 0x99),
];

/// The colour of a horizon: its own, or else that of its place.
pub fn horizon_colour(own: Option<ttf::Colour>, index: usize) -> Color32 {
    match own {
        Some(colour) => Color32::from_rgb(colour.rgb[0], colour.rgb[1], colour.rgb[2]),
        None => HORIZON_COLOURS[index % HORIZON_COLOURS.len()],
    }
}

/// The colour that an entry is drawn in.
pub fn entry_colour(entry: &HorizonEntry, index: usize) -> Color32 {
    horizon_colour(entry.assembly.as_ref().map(|log| log.colour), index)
}

/// Solid where picked, dashed where filled, dotted where extrapolated; on a light halo, so that it is seen on any amplitude.
pub(super) fn draw_line(
    painter: &eframe::egui::Painter,
    points: Vec<Pos2>,
    kind: LineKind,
    quality: LineQuality,
    session: &Session,
) {
    let own = |horizon: usize| session.document.horizons.get(horizon)?.assembly.as_ref().map(|log| log.colour);
    let (colour, width) = match kind {
        LineKind::Horizon { horizon } => (horizon_colour(own(horizon), horizon), 2.0),
        LineKind::Fault { .. } => (Color32::BLACK, 2.2),
        LineKind::Frame => return,
    };
    painter.add(Shape::line(points.clone(), Stroke::new(width + 2.0, Color32::from_white_alpha(150))));
    let stroke = Stroke::new(width, colour);
    match quality {
        LineQuality::Certain => drop(painter.add(Shape::line(points, stroke))),
        LineQuality::Approximate => drop(painter.add(Shape::dashed_line(&points, stroke, 8.0, 5.0))),
        LineQuality::Inferred => drop(painter.add(Shape::dashed_line(&points, stroke, 2.5, 4.0))),
    }
}

/// Where the fence runs, on the slice.
fn fence_line(
    ui: &Ui,
    painter: &eframe::egui::Painter,
    session: &Session,
    kind: SliceKind,
    to_screen: &impl Fn(DVec2) -> Pos2,
) {
    if kind != SliceKind::Slice || session.view.layout != Layout::Fence {
        return;
    }
    let points: Vec<Pos2> = session.view.fence.iter().map(|at| to_screen(DVec2::from_array(*at))).collect();
    let accent = theme::accent(ui.visuals());
    painter.add(Shape::line(points.clone(), Stroke::new(5.0, Color32::from_white_alpha(180))));
    painter.add(Shape::line(points.clone(), Stroke::new(2.5, accent)));
    for point in points {
        painter.circle(point, 4.0, Color32::WHITE, Stroke::new(2.0, accent));
    }
}

/// Where the other two sections run.
fn cross(
    ui: &Ui,
    painter: &eframe::egui::Painter,
    session: &Session,
    kind: SliceKind,
    body: Rect,
    to_screen: &impl Fn(DVec2) -> Pos2,
) {
    let [s, t] = axes(kind).map(|axis| session.view.slices[axis]);
    let at = to_screen(DVec2::new(s, t));
    let stroke = Stroke::new(1.0, theme::accent(ui.visuals()).gamma_multiply(0.8));
    painter.vline(at.x, body.y_range(), stroke);
    painter.hline(body.x_range(), at.y, stroke);
}

/// The least of 1, 2, 5 × 10ⁿ that is not less.
pub(super) fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.max(1e-9).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * decade)
        .find(|step| *step >= least * 0.999)
        .unwrap_or(decade)
}

/// Numbers along the upper and the left edge.
fn ticks(ui: &Ui, whole: Rect, body: Rect, image: Rect, kind: SliceKind, geometry: &SurveyGeometry) {
    let font = FontId::proportional(11.5);
    let colour = ui.visuals().weak_text_color();
    let painter = ui.painter_at(whole);
    let extent = extent(kind, geometry.size());
    for (direction, axis) in axes(kind).into_iter().enumerate() {
        let is_across = direction == 0;
        let length = if is_across { image.width() } else { image.height() };
        let last = if is_across { extent.x } else { extent.y };
        let ends = [value_at(geometry, axis, 0.0), value_at(geometry, axis, last)];
        let per_point = (ends[1] - ends[0]) / f64::from(length);
        if per_point == 0.0 {
            continue;
        }
        let step = round_step(per_point.abs() * f64::from(TICK_EVERY)).max(if axis < 2 { 1.0 } else { 0.0 });
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let mut value = (low / step).ceil() * step;
        while value <= high {
            let along = ((value - ends[0]) / per_point) as f32;
            let text = if step < 1.0 { format!("{value:.1}") } else { format!("{value:.0}") };
            if is_across {
                let x = image.left() + along;
                if body.x_range().contains(x) {
                    painter.vline(x, body.top() - 4.0..=body.top(), Stroke::new(1.0, colour));
                    painter.text(pos2(x, body.top() - 5.0), Align2::CENTER_BOTTOM, text, font.clone(), colour);
                }
            } else {
                let y = image.top() + along;
                if body.y_range().contains(y) {
                    painter.hline(body.left() - 4.0..=body.left(), y, Stroke::new(1.0, colour));
                    painter.text(pos2(body.left() - 6.0, y), Align2::RIGHT_CENTER, text, font.clone(), colour);
                }
            }
            value += step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_between_numbers_are_round() {
        for (least, said) in [(0.3, 0.5), (1.0, 1.0), (1.1, 2.0), (4.9, 5.0), (70.0, 100.0)] {
            assert!((round_step(least) - said).abs() < 1e-9, "{least}");
        }
    }

    #[test]
    fn every_section_runs_through_its_point() {
        for kind in SliceKind::ALL {
            let at = DVec3::new(3.0, 5.0, 7.0).to_array();
            let [s, t] = axes(kind).map(|axis| at[axis]);
            assert_eq!(voxel(kind, at[kind.axis()], DVec2::new(s, t)).to_array(), at);
        }
    }
}
