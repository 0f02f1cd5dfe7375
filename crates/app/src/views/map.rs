//! The map: the depth of a horizon, or the thickness below it, north up, with contours, the lines of the sections and a
//! colour bar.

use super::texture;
use crate::state::{Action, Session};
use crate::widgets::canvas;
use crate::widgets::obstacle::{needs, unless};
use crate::work::map::{MapData, MapRequest, Maps};
use eframe::egui::{
    Button, ComboBox, Context, Rect, Role, Sense, TextWrapMode, TextureHandle, Ui, Vec2, WidgetInfo, vec2,
};
use figure::draw::map::{self as drawing, MapFrame};
use figure::map::{HorizonMap, Mapped};
use glam::DVec2;

/// Smallest and largest zoom.
const ZOOM: [f32; 2] = [0.8, 40.0];

/// The view.
#[derive(Default)]
pub(crate) struct MapView {
    texture: Option<TextureHandle>,
    shown: Option<HorizonMap>,
    requested: Option<(Mapped, u64, bool)>,
    thickness: bool,
    zoom: Option<f32>,
    shift: Vec2,
}

impl MapView {
    /// Takes over a map that was drawn.
    pub(crate) fn receive(&mut self, ctx: &Context, map: HorizonMap) {
        texture::keep(&mut self.texture, ctx, "map", texture::pixels(&map.image));
        self.shown = Some(map);
    }

    /// Shows the map in all the room there is; `data` is what it is made from.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        data: Option<(MapData, u64)>,
        maps: &Maps,
        actions: &mut Vec<Action>,
    ) {
        let Some(geometry) = &session.document.geometry else { return };
        let horizons = &session.document.horizons;
        if horizons.is_empty() {
            ui.label("A map shows a horizon. Add or pick one first.");
            return;
        }
        let (upper, lower) = chosen(session);
        self.header(ui, session, upper, lower, actions);
        let mapped = self.mapped(session);
        if let Some((data, version)) = data {
            let requested = Some((mapped, version, matches!(data, MapData::Rocks(_))));
            if self.requested != requested {
                self.requested = requested;
                maps.map(MapRequest { mapped, data });
            }
        }
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Map"));
        let body = body_of(rect);
        let zoom = self.touch(ui, &response, body);
        let shift = DVec2::new(f64::from(self.shift.x), f64::from(self.shift.y)) / canvas::SCALE;
        let frame = MapFrame::new(geometry, canvas::page_rect(body), f64::from(zoom), shift);
        ui.painter_at(rect).rect_filled(rect, 0.0, super::block::paper(ui));
        self.paint(ui, session, rect, &frame);
        if response.clicked()
            && let Some(at) = response.interact_pointer_pos()
        {
            let voxel = frame.voxel(canvas::page(at));
            actions.push(Action::Slices([voxel.x, voxel.y, session.view.slices[2]]));
        }
    }

    /// The content of the map, for a project that has horizons.
    pub(crate) fn mapped(&self, session: &Session) -> Mapped {
        let (upper, lower) = chosen(session);
        match lower.filter(|_| self.thickness) {
            Some(lower) => Mapped::Thickness(upper, lower),
            None => Mapped::Structure(upper),
        }
    }

    fn header(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        upper: usize,
        lower: Option<usize>,
        actions: &mut Vec<Action>,
    ) {
        let horizons = &session.document.horizons;
        ui.horizontal_wrapped(|ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
            let label = ui.strong("Map of");
            let mut chosen = upper;
            ui.label_inputs_by(label.id, |ui| {
                ComboBox::from_id_salt("mapped").selected_text(&horizons[upper].name).truncate().show_ui(ui, |ui| {
                    for (index, entry) in horizons.iter().enumerate() {
                        ui.selectable_value(&mut chosen, index, &entry.name);
                    }
                });
            });
            if chosen != upper {
                actions.push(Action::Horizon(Some(horizons[chosen].name.clone())));
            }
            if ui.selectable_label(!self.thickness, "Structure").clicked() {
                self.thickness = false;
            }
            let hint = lower.map_or_else(String::new, |lower| format!("Vertical, down to {}", horizons[lower].name));
            let none = needs(lower.is_some(), "There is no horizon below this one");
            let thickness = unless(ui, none, Button::selectable(self.thickness, "Thickness"));
            if thickness.on_hover_text(hint).clicked() {
                self.thickness = true;
            }
        });
    }

    fn touch(&mut self, ui: &Ui, response: &eframe::egui::Response, body: Rect) -> f32 {
        let mut zoom = self.zoom.unwrap_or(1.0);
        if response.dragged() {
            self.shift += response.drag_delta();
        }
        if let Some(at) = response.hover_pos() {
            let factor = ui.input(|input| (input.smooth_scroll_delta().y * 0.0022).exp() * input.zoom_delta());
            let next = (zoom * factor).clamp(ZOOM[0], ZOOM[1]);
            let off = at - body.center();
            self.shift = off - (off - self.shift) * (next / zoom);
            zoom = next;
        }
        if response.double_clicked() {
            (zoom, self.shift) = (1.0, Vec2::ZERO);
        }
        self.zoom = Some(zoom);
        zoom
    }

    fn paint(&self, ui: &Ui, session: &Session, rect: Rect, frame: &MapFrame) {
        let painter = ui.painter_at(rect);
        let (Some(texture), Some(shown), Some(geometry)) = (&self.texture, &self.shown, &session.document.geometry)
        else {
            return;
        };
        let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) as f64);
        // The caption keeps clear of the legend.
        let room = Rect::from_min_max(rect.min + vec2(8.0, 8.0), rect.max - vec2(96.0, 8.0));
        canvas::paint(&painter, &drawing::contents(shown, frame, canvas::page_rect(room)), Some(texture.id()));
        let [x, y, _] = session.view.slices;
        let lines = [[DVec2::new(x, 0.0), DVec2::new(x, ny)], [DVec2::new(0.0, y), DVec2::new(nx, y)]];
        canvas::paint(&painter, &drawing::marks(&lines.map(|line| line.to_vec()), frame), None);
        let column = Rect::from_min_max(rect.right_top() + vec2(-80.0, 14.0), rect.max - vec2(6.0, 40.0));
        let explained = drawing::explained(shown, geometry, canvas::page_rect(column));
        explained.iter().for_each(|group| canvas::paint(&painter, group, None));
        let below = rect.right_bottom() - vec2(10.0, 8.0);
        let text = page::list::Text::new(canvas::page(below), drawing::caption(shown, geometry));
        let text = text.sized(figure::style::NUMBER_PT).haloed(1.0, ttf::Colour::WHITE);
        let text = text.anchored(page::list::Across::End, page::list::Upright::Baseline);
        let caption = page::list::Group::new(page::list::GroupKind::Annotation, "caption").with([text.into()]);
        canvas::paint(&painter, &caption, None);
    }
}

/// The chosen horizon, and the next one down.
fn chosen(session: &Session) -> (usize, Option<usize>) {
    let horizons = &session.document.horizons;
    let chosen = session.view.horizon.as_ref().and_then(|name| horizons.iter().position(|entry| entry.name == *name));
    let upper = chosen.unwrap_or(0);
    (upper, (upper + 1 < horizons.len()).then_some(upper + 1))
}

/// The map itself, without north arrow and colour bar.
fn body_of(rect: Rect) -> Rect {
    Rect::from_min_max(rect.min + vec2(16.0, 24.0), rect.max - vec2(96.0, 16.0))
}
