//! The section views: inline, crossline and slice through one point, amplitudes with horizons and faults over them.
//!
//! Spaces: (s, t) of the section, in samples; points of the window, y down. Both axes are stretched, so that a section
//! fills its view whatever its shape. Ctrl and the wheel zoom about the pointer, a drag moves, the wheel alone goes to
//! the next section.

mod faults;
mod freehand;
mod lines;
mod wells;

pub(crate) use lines::{entry_colour, name_across};

use super::lasso::{self, LassoLine};
use super::overlay::{Overlay, stick_point};
use super::pointer::{self, Pointed};
use super::texture;
use crate::state::{
    Action, Lasso, LassoOn, Layout, Panel, PickingStep, SectionKind, SectionVolumes, Session, StickPoint, Tool,
};
use crate::widgets::canvas;
use crate::widgets::event_order::wheel_lines;
use crate::work::{CutOf, Rocks, SliceRequest, Slices};
use eframe::egui::{
    Align2, Color32, Context, DragValue, FontId, Label, Painter, PointerButton, Pos2, Rect, Response, RichText, Role,
    Sense, Stroke, TextureHandle, Ui, Vec2, WidgetInfo, vec2,
};
use figure::cut::SectionCut;
use figure::cut::{CutLine, value_at};
use figure::draw::NamedColour;
use figure::draw::axes::{self, Axis, axis_title};
use figure::draw::section::{SectionContents, Zoom};
use freehand::Freehand;
use glam::DVec2;
use image::RgbaImage;
use project::styles;
use render::FaceData;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use survey::SurveyGeometry;

/// Margin for the numbers at the left and the top, points.
const MARGIN: Vec2 = vec2(52.0, 20.0);
/// How long the picture of another section may stand under a title.
const BELIEVED: Duration = Duration::from_millis(200);
/// Smallest and largest zoom.
const ZOOM: [f32; 2] = [1.0, 40.0];

/// One section on the screen.
struct Pane {
    texture: Option<TextureHandle>,
    /// The picture in the form that figures take, with its lines.
    shown: Option<(Arc<RgbaImage>, Vec<CutLine>)>,
    requested: Option<CutOf>,
    /// What the picture shows.
    of: Option<CutOf>,
    /// When another was requested than the picture shows.
    behind: Option<Instant>,
    zoom: f32,
    /// Shares of the view that the whole section takes at zoom 1.
    fit: Vec2,
    /// The point of the section that is in the middle of the view, shares of its width and height.
    middle: Vec2,
    /// The part of a line of the wheel that has not changed the section yet.
    wheel: f32,
    /// The point of a stick that is being dragged.
    held: Option<StickPoint>,
    lasso: LassoLine,
    freehand: Freehand,
}

impl Default for Pane {
    fn default() -> Self {
        Self {
            texture: None,
            shown: None,
            requested: None,
            of: None,
            behind: None,
            zoom: 1.0,
            fit: Vec2::splat(1.0),
            middle: vec2(0.5, 0.5),
            wheel: 0.0,
            held: None,
            lasso: LassoLine::default(),
            freehand: Freehand::default(),
        }
    }
}

/// The three sections.
#[derive(Default)]
pub struct Sections {
    panes: HashMap<SectionKind, Pane>,
}

impl Sections {
    /// Takes over a section that was cut.
    pub fn receive(&mut self, ctx: &Context, cut: SectionCut, of: CutOf) {
        let pane = self.panes.entry(cut.kind).or_default();
        pane.of = Some(of);
        texture::keep(&mut pane.texture, ctx, cut.kind.name(), texture::pixels(&cut.image));
        pane.shown = Some((Arc::new(cut.image), cut.lines));
    }

    /// Shows one section in all the room there is; returns what is under the cursor.
    #[expect(clippy::too_many_arguments, reason = "a panel is handed the parts of the window it needs, and no others")]
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        kind: SectionKind,
        rocks: Option<&Rocks>,
        slices: &Slices,
        overlay: &mut Overlay,
        actions: &mut Vec<Action>,
    ) -> Option<Pointed> {
        let geometry = session.document.geometry.as_ref()?;
        let pane = self.panes.entry(kind).or_default();
        let at = session.view.slices[kind.axis()];
        let is_interpreting = session.view.panel == Panel::Interpret;
        let volumes = &session.view.volumes;
        let show = if is_interpreting { session.view.picking.show } else { FaceData::Rock };
        if let Some(rocks) = rocks
            && pane.requested.as_ref().is_none_or(|of| (of.0, of.1, of.2, &of.3) != (at, rocks.key, show, volumes))
        {
            pane.requested = Some((at, rocks.key, show, volumes.clone()));
            let project = (session.root.clone(), Arc::new(session.document.clone()));
            let volumes = volumes.clone();
            slices.cut(SliceRequest { kind, at, rocks: rocks.clone(), show, volumes, project });
        }
        header(ui, session, kind, geometry, actions);
        let (whole, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("{} section", kind.name())));
        let body = body_of(whole);
        if !body.is_positive() {
            return None;
        }
        pane.fit = lines::fitted(session, geometry, kind, body.size());
        let has_lasso = lasso::is_held(ui, session);
        if !has_lasso {
            pane.drag_point(ui, session, kind, &response, body, actions);
            pane.touch(ui, &response, body, Freehand::is_in_hand(session));
        }
        let image = pane.paint(ui, session, kind, whole, overlay)?;
        let painter = ui.painter_at(body);
        let extent = kind.extent(geometry.size());
        let to_section = |pointer: Pos2| {
            let share = (pointer - image.min) / image.size();
            DVec2::new(f64::from(share.x) * extent.x, f64::from(share.y) * extent.y)
        };
        if let Some(loaded) = rocks {
            let page = |st: DVec2| image.min + vec2((st.x / extent.x) as f32, (st.y / extent.y) as f32) * image.size();
            wells::draw(&painter, session, (kind, body), &loaded.wells, page);
        }
        pane.cover(ui, &painter, kind, body);
        if let Some(line) = pane.lasso.draw(ui, &painter, &response, has_lasso) {
            let corners = line.into_iter().map(to_section).collect();
            let on = LassoOn::Section(kind, at);
            actions.push(Action::Picking(PickingStep::Erase(Lasso { on, corners })));
        }
        if Freehand::is_in_hand(session)
            && !has_lasso
            && let Some(line) = pane.freehand.draw(ui, &painter, &response)
        {
            let inside = line.into_iter().map(|at| to_section(at).clamp(DVec2::ZERO, extent));
            let voxels = inside.map(|st| kind.voxel(at, st)).collect();
            actions.push(Action::Picking(PickingStep::Line(voxels)));
        }
        let st = response.hover_pos().filter(|pointer| body.contains(*pointer)).map(to_section)?;
        if !(st.x >= 0.0 && st.y >= 0.0 && st.x <= extent.x && st.y <= extent.y) {
            return None;
        }
        let voxel = kind.voxel(at, st);
        pane.step(ui, session, kind, actions);
        if kind == SectionKind::Slice && session.view.layout == Layout::Fence {
            if response.clicked() {
                let mut fence = session.view.fence.clone();
                fence.push([voxel.x, voxel.y]);
                actions.push(Action::Fence(fence));
            }
        } else if is_interpreting && session.view.picking.tool == Tool::Faults {
            let on_page = canvas::page_rect(image);
            let page = |st: DVec2| on_page.min + st / extent * on_page.size();
            faults::touch(ui, &response, session, overlay, (kind, voxel), page, actions);
        } else {
            lasso::click(ui, &response, session, voxel, actions);
        }
        Some(pointer::at_voxel(rocks?, voxel.as_vec3(), Some(kind.axis())))
    }
}

impl Sections {
    /// The visible part of a section.
    pub fn zoom(&self, kind: SectionKind) -> Zoom {
        let pane = self.panes.get(&kind);
        pane.map_or_else(Zoom::default, |pane| Zoom {
            factor: f64::from(pane.zoom),
            middle: [pane.middle.x, pane.middle.y].map(f64::from),
        })
    }
}

/// The section itself, without the numbers along its edges.
fn body_of(whole: Rect) -> Rect {
    Rect::from_min_max(whole.min + MARGIN, whole.max - vec2(13.0, 4.0))
}

impl Pane {
    /// Whether the picture shows another section than the one that its title names.
    fn is_behind(&self) -> bool {
        self.of.is_some() && self.of != self.requested
    }

    /// Covers the picture where it has been of another section for so long that it would be believed.
    fn cover(&mut self, ui: &Ui, painter: &Painter, kind: SectionKind, body: Rect) {
        if !self.is_behind() {
            self.behind = None;
            return;
        }
        if self.behind.get_or_insert_with(Instant::now).elapsed() < BELIEVED {
            ui.ctx().request_repaint_after(BELIEVED);
            return;
        }
        painter.rect_filled(body, 0.0, super::block::paper(ui).gamma_multiply(0.7));
        let text = format!("Drawing the {}…", kind.name().to_lowercase());
        painter.text(body.center(), Align2::CENTER_CENTER, text, FontId::proportional(15.0), Color32::BLACK);
    }

    /// Paints the section with its numbers into a rectangle; returns the rectangle of the whole section.
    fn paint(&self, ui: &Ui, session: &Session, kind: SectionKind, whole: Rect, overlay: &mut Overlay) -> Option<Rect> {
        let geometry = session.document.geometry.as_ref()?;
        let body = body_of(whole);
        let extent = kind.extent(geometry.size());
        let image = self.image_rect(body);
        let painter = ui.painter_at(body);
        painter.rect_filled(body, 0.0, super::block::paper(ui));
        let is_interpreting = session.view.panel == Panel::Interpret;
        let (on_page, seen) = (canvas::page_rect(image), canvas::page_rect(body.intersect(image)));
        if let (Some((pixels, lines)), Some(texture)) = (&self.shown, &self.texture) {
            let lines = if is_interpreting { Cow::Borrowed(&[][..]) } else { lines::visible(session, lines) };
            let horizons = project::pictures::figures::horizons(&session.document);
            let faults: Vec<_> = session.document.faults.iter().map(|entry| entry.colour).collect();
            let contents = contents(pixels, &lines, (&horizons, &faults), extent, session, kind);
            canvas::paint(&painter, &contents.drawn(seen, on_page), Some(texture.id()));
        }
        if is_interpreting {
            overlay.on_section(&painter, session, kind, |st| on_page.min + st / extent * on_page.size());
        }
        let [s, t] = kind.axes();
        let axis = |axis: usize, last: f64, at: [f64; 2]| Axis {
            name: axis_title(geometry, axis).to_owned(),
            ends: [0.0, last].map(|index| value_at(geometry, axis, index)),
            at,
            least_step: if axis < 2 { 1.0 } else { 0.0 },
        };
        let across = axis(s, extent.x, [on_page.min.x, on_page.max.x]);
        let down = axis(t, extent.y, [on_page.min.y, on_page.max.y]);
        let drawn = axes::drawn(canvas::page_rect(whole), seen, [&across, &down]);
        canvas::paint(&ui.painter_at(whole), &canvas::on_window(drawn, ui.visuals()), None);
        name_across(ui, whole, body, &across.name);
        Some(image)
    }

    /// The rectangle of the whole section on the screen.
    fn image_rect(&self, body: Rect) -> Rect {
        let size = body.size() * self.fit * self.zoom;
        Rect::from_min_size(body.center() - self.middle * size, size)
    }

    /// Moves and zooms, unless a drag draws a line.
    fn touch(&mut self, ui: &Ui, response: &Response, body: Rect, has_line: bool) {
        let draws = has_line && response.dragged_by(PointerButton::Primary);
        if response.dragged() && self.held.is_none() && !draws {
            self.middle -= response.drag_delta() / (body.size() * self.fit * self.zoom);
        }
        if let Some(pointer) = response.hover_pos() {
            let factor = ui.input(|input| input.zoom_delta());
            if factor != 1.0 {
                let before = self.image_rect(body);
                let share = (pointer - before.min) / before.size();
                self.zoom = (self.zoom * factor).clamp(ZOOM[0], ZOOM[1]);
                self.middle = share - (pointer - body.center()) / (body.size() * self.fit * self.zoom);
            }
        }
        if response.double_clicked() {
            (self.zoom, self.middle) = (1.0, vec2(0.5, 0.5));
        }
        // What is smaller than the view stays in its middle.
        let half = (Vec2::splat(0.5) / (self.fit * self.zoom)).min(Vec2::splat(0.5));
        self.middle = self.middle.clamp(half, Vec2::splat(1.0) - half);
    }

    /// Drags a point of a stick, while sticks are drawn: one of a fault that exists is moved when it is let go.
    fn drag_point(
        &mut self,
        ui: &Ui,
        session: &Session,
        kind: SectionKind,
        response: &Response,
        body: Rect,
        actions: &mut Vec<Action>,
    ) {
        let is_drawing = session.view.panel == Panel::Interpret && session.view.picking.tool == Tool::Sticks;
        let Some(geometry) = session.document.geometry.as_ref().filter(|_| is_drawing) else {
            self.held = None;
            return;
        };
        let (image, extent) = (self.image_rect(body), kind.extent(geometry.size()));
        let page = |st: DVec2| image.min + vec2((st.x / extent.x) as f32, (st.y / extent.y) as f32) * image.size();
        if response.drag_started()
            && let Some(at) = ui.input(|input| input.pointer.press_origin())
        {
            self.held = stick_point(session, kind, at, page);
        }
        let Some(held) = &self.held else { return };
        if let Some(at) = response.interact_pointer_pos() {
            let share = (at - image.min) / image.size();
            let st = DVec2::new(f64::from(share.x) * extent.x, f64::from(share.y) * extent.y);
            let to = kind.voxel(session.view.slices[kind.axis()], st.clamp(DVec2::ZERO, extent));
            if held.fault.is_none() || response.drag_stopped() {
                actions.push(Action::Picking(PickingStep::MovePoint(held.clone(), to)));
            } else {
                ui.painter_at(body).circle(at, 4.0, Color32::WHITE, Stroke::new(1.5, Color32::BLACK));
            }
        }
        if response.drag_stopped() {
            self.held = None;
        }
    }

    /// Goes to the next section by the wheel.
    fn step(&mut self, ui: &Ui, session: &Session, kind: SectionKind, actions: &mut Vec<Action>) {
        self.wheel += wheel_lines(ui);
        let steps = self.wheel.trunc();
        if steps != 0.0 {
            self.wheel -= steps;
            let mut slices = session.view.slices;
            slices[kind.axis()] -= f64::from(steps);
            actions.push(Action::Slices(slices));
        }
    }
}

/// What a section shows, in the form that figures print.
fn contents<'a>(
    image: &'a Arc<RgbaImage>,
    lines: &'a [CutLine],
    (horizons, fault_colours): (&'a [NamedColour], &'a [Option<ttf::Colour>]),
    extent: DVec2,
    session: &Session,
    kind: SectionKind,
) -> SectionContents<'a> {
    let marks = lines::marks(session, kind);
    SectionContents { image, extent, lines, horizons, faults: &[], fault_colours, interpretation: None, marks }
}

/// Name and number of the section; the number can be typed and dragged.
fn header(ui: &mut Ui, session: &Session, kind: SectionKind, geometry: &SurveyGeometry, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let label = ui.strong(kind.name());
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
            let button = ui.button(sign).on_hover_text(format!("{word} {}", kind.name().to_lowercase()));
            if button.clicked() {
                let mut slices = session.view.slices;
                slices[axis] += step;
                actions.push(Action::Slices(slices));
            }
        }
        proportions(ui, session, kind, actions);
        shown_volumes(ui, session);
    });
}

/// Says which volumes the section shows, where that is not the raw data alone.
fn shown_volumes(ui: &mut Ui, session: &Session) {
    let (document, SectionVolumes { without_raw, over }) = (&session.document, &session.view.volumes);
    let raw = styles::transfer_functions(document).raw.map_or_else(String::new, |raw| raw.volume);
    let text = match over {
        Some(over) if *without_raw => format!("{}, {:.0} %", over.volume, 100.0 * over.opacity),
        Some(over) => format!("{} over {raw}, {:.0} %", over.volume, 100.0 * over.opacity),
        None if *without_raw => format!("{raw} is hidden"),
        None => return,
    };
    let colours = over.as_ref().and_then(|over| styles::raw_colour(document, Some(&over.volume), over.map, None).ok());
    let label = ui.add(Label::new(RichText::new(text).weak()).truncate());
    if let (Some(over), Some([low, high])) = (over, colours.map(|raw| raw.function.domain)) {
        label.on_hover_text(format!("{} from {low:.4} to {high:.4} ({})", over.volume, over.map.name()));
    }
}

/// The choice of the sections' proportions.
fn proportions(ui: &mut Ui, session: &Session, kind: SectionKind, actions: &mut Vec<Action>) {
    let present = session.view.proportions;
    let words = |factor: Option<f64>| match factor {
        None => "Fill".to_owned(),
        Some(factor) => format!("{factor} : 1"),
    };
    let button = ui.menu_button(words(present), |ui| {
        for choice in [None, Some(1.0), Some(2.0), Some(5.0), Some(10.0)] {
            let name = choice.map_or_else(|| "Fill the view".to_owned(), |_| words(choice));
            if ui.radio(present == choice, name).clicked() {
                actions.push(Action::Proportions(choice));
                ui.close();
            }
        }
    });
    let hint = format!("Proportions of sections, vertical to horizontal ({})", kind.name());
    button.response.on_hover_text(hint);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Blended;

    #[test]
    fn a_picture_of_another_section_is_known_to_be_one() {
        let of = |at: f64, version: u64, show: FaceData| (at, version, show, SectionVolumes::default());
        let (here, there) = (of(3.0, 1, FaceData::Rock), of(4.0, 1, FaceData::Rock));
        let mut pane = Pane { requested: Some(here.clone()), ..Pane::default() };
        assert!(!pane.is_behind(), "nothing is shown yet");
        pane.of = Some(here);
        let mut blended = of(3.0, 1, FaceData::Rock);
        blended.3.over = Some(Blended::new("chaos"));
        assert!(!pane.is_behind());
        for other in [there, of(3.0, 2, FaceData::Rock), of(3.0, 1, FaceData::Leaves), blended] {
            pane.requested = Some(other);
            assert!(pane.is_behind(), "{:?}", pane.requested);
        }
    }
}
