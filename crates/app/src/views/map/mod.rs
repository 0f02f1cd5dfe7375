//! The map: a horizon's structure, or the thickness below it, north up, with contours, the sections' lines and a colour bar.

mod labels;

use super::texture;
use crate::state::{Action, Session};
use crate::theme;
use crate::work::map::{MapPicture, MapSource, MapWish, Mapped, Maps};
use eframe::egui::{
    Align2, Color32, ComboBox, Context, FontId, Mesh, Pos2, Rect, Role, Sense, Shape, Stroke, TextWrapMode,
    TextureHandle, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use glam::DVec2;
use survey::SurveyGeometry;

/// Greatest height of the colour bar, points.
const BAR: f32 = 320.0;
/// Zoom stays between these.
const ZOOM: [f32; 2] = [0.8, 40.0];

/// The view.
#[derive(Default)]
pub struct MapView {
    texture: Option<TextureHandle>,
    shown: Option<MapPicture>,
    wished: Option<(Mapped, u64, bool)>,
    thickness: bool,
    zoom: Option<f32>,
    shift: Vec2,
}

/// From voxel x, y to the screen: north up, one scale both ways.
struct Sheet {
    geometry: SurveyGeometry,
    middle: DVec2,
    centre: Pos2,
    scale: f64,
}

impl Sheet {
    fn new(geometry: &SurveyGeometry, rect: Rect, zoom: f32, shift: Vec2) -> Self {
        let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) as f64);
        let corners = [[0.0, 0.0], [nx, 0.0], [nx, ny], [0.0, ny]];
        let world = corners.map(|[x, y]| geometry.inline_vector * x + geometry.crossline_vector * y);
        let low = world.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = world.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        let extent = (high - low).max(DVec2::splat(1e-6));
        let fit = (f64::from(rect.width()) / extent.x).min(f64::from(rect.height()) / extent.y);
        Self {
            geometry: geometry.clone(),
            middle: (low + high) * 0.5,
            centre: rect.center() + shift,
            scale: fit * f64::from(zoom),
        }
    }

    fn screen(&self, voxel: DVec2) -> Pos2 {
        let world = self.geometry.inline_vector * voxel.x + self.geometry.crossline_vector * voxel.y;
        let off = (world - self.middle) * self.scale;
        self.centre + vec2(off.x as f32, -off.y as f32)
    }

    fn voxel(&self, at: Pos2) -> DVec2 {
        let off = at - self.centre;
        let world = self.middle + DVec2::new(f64::from(off.x), -f64::from(off.y)) / self.scale;
        self.geometry.voxel_from_world((world + self.geometry.origin).extend(0.0)).truncate()
    }
}

impl MapView {
    /// Takes a map in.
    pub fn receive(&mut self, ctx: &Context, picture: MapPicture) {
        texture::keep(&mut self.texture, ctx, "map", texture::pixels(&picture.image));
        self.shown = Some(picture);
    }

    /// Shows the map in all the room there is, made from `source` in its present state.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        source: Option<(MapSource, u64)>,
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
        if let Some((source, version)) = source {
            let wished = Some((mapped, version, matches!(source, MapSource::Rocks(_))));
            if self.wished != wished {
                self.wished = wished;
                maps.map(MapWish { mapped, source });
            }
        }
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Map"));
        let body = body_of(rect);
        let zoom = self.touch(ui, &response, body);
        let sheet = Sheet::new(geometry, body, zoom, self.shift);
        ui.painter_at(rect).rect_filled(rect, 0.0, super::block::paper(ui));
        self.paint(ui, session, rect, &sheet);
        if response.clicked()
            && let Some(at) = response.interact_pointer_pos()
        {
            let voxel = sheet.voxel(at);
            actions.push(Action::Slices([voxel.x, voxel.y, session.view.slices[2]]));
        }
    }

    /// What it shows of a project that has horizons.
    pub fn mapped(&self, session: &Session) -> Mapped {
        let (upper, lower) = chosen(session);
        match lower.filter(|_| self.thickness) {
            Some(lower) => Mapped::Thickness(upper, lower),
            None => Mapped::Structure(upper),
        }
    }

    /// Paints the whole map under its name, for a printed page.
    pub fn print(&self, ui: &Ui, session: &Session, rect: Rect) {
        let (Some(geometry), Some(shown)) = (&session.document.geometry, &self.shown) else { return };
        let name = |index: usize| session.document.horizons.get(index).map_or("", |entry| entry.name.as_str());
        let text = match shown.mapped {
            Mapped::Structure(horizon) => name(horizon).to_owned(),
            Mapped::Thickness(upper, lower) => format!("Thickness from {} down to {}", name(upper), name(lower)),
        };
        let at = rect.center_top() + vec2(0.0, 2.0);
        ui.painter().text(at, Align2::CENTER_TOP, text, FontId::proportional(14.0), ui.visuals().text_color());
        self.paint(ui, session, rect, &Sheet::new(geometry, body_of(rect), 1.0, Vec2::ZERO));
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
                ComboBox::from_id_salt("mapped").selected_text(&horizons[upper].name).show_ui(ui, |ui| {
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
            ui.add_enabled_ui(lower.is_some(), |ui| {
                let hint =
                    lower.map_or_else(String::new, |lower| format!("Vertical, down to {}", horizons[lower].name));
                if ui.selectable_label(self.thickness, "Thickness").on_hover_text(hint).clicked() {
                    self.thickness = true;
                }
            });
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

    fn paint(&self, ui: &Ui, session: &Session, rect: Rect, sheet: &Sheet) {
        let painter = ui.painter_at(rect);
        let (Some(texture), Some(shown), Some(geometry)) = (&self.texture, &self.shown, &session.document.geometry)
        else {
            return;
        };
        let [nx, ny, _] = geometry.size().map(|count| count.saturating_sub(1) as f64);
        let half = [0.5 / (nx as f32 + 1.0), 0.5 / (ny as f32 + 1.0)];
        let mut mesh = Mesh::with_texture(texture.id());
        for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            let uv = pos2(half[0] + u as f32 * (1.0 - 2.0 * half[0]), half[1] + v as f32 * (1.0 - 2.0 * half[1]));
            let pos = sheet.screen(DVec2::new(u * nx, v * ny));
            mesh.vertices.push(eframe::egui::epaint::Vertex { pos, uv, color: Color32::WHITE });
        }
        mesh.indices = vec![0, 1, 2, 0, 2, 3];
        painter.add(Shape::mesh(mesh));
        for ends in &shown.hatching {
            painter.line_segment(ends.map(|end| sheet.screen(end)), Stroke::new(0.9, Color32::from_black_alpha(170)));
        }
        // Clear of the north arrow.
        let room = Rect::from_min_max(rect.min + vec2(40.0, 8.0), rect.max - vec2(96.0, 8.0));
        labels::paint(&painter, &shown.contours, |place| sheet.screen(place), room);
        let line = Stroke::new(1.5, theme::accent(ui.visuals()));
        let [x, y, _] = session.view.slices;
        painter.line_segment([DVec2::new(x, 0.0), DVec2::new(x, ny)].map(|end| sheet.screen(end)), line);
        painter.line_segment([DVec2::new(0.0, y), DVec2::new(nx, y)].map(|end| sheet.screen(end)), line);
        self.bar(ui, session, rect, shown);
        north(ui, rect);
    }

    /// Which colour is which value.
    fn bar(&self, ui: &Ui, session: &Session, rect: Rect, shown: &MapPicture) {
        let painter = ui.painter_at(rect);
        let bar = Rect::from_min_size(
            pos2(rect.right() - 84.0, rect.top() + 60.0),
            vec2(16.0, (rect.height() - 130.0).clamp(40.0, BAR)),
        );
        let colours = ttf::RgbaFunction::over(ttf::ColourMap::Strata, [0.0, 1.0]);
        let steps = 64;
        for step in 0..steps {
            let share = step as f32 / steps as f32;
            let [r, g, b, _] = colours.evaluate(1.0 - share).map(|channel| (channel * 255.0 + 0.5) as u8);
            let top = bar.top() + bar.height() * share;
            let part =
                Rect::from_min_max(pos2(bar.left(), top), pos2(bar.right(), top + bar.height() / steps as f32 + 0.5));
            painter.rect_filled(part, 0.0, Color32::from_rgb(r, g, b));
        }
        let unit = session.document.geometry.as_ref().map_or("", |geometry| geometry.vertical.unit.symbol());
        let ink = Color32::from_gray(0x20);
        let font = FontId::proportional(12.0);
        let [first, last] = match shown.mapped {
            Mapped::Structure(_) => shown.range,
            Mapped::Thickness(..) => [shown.range[1], shown.range[0]],
        };
        for (y, value) in [(bar.top(), first), (bar.center().y, 0.5 * (first + last)), (bar.bottom(), last)] {
            painter.text(pos2(bar.right() + 5.0, y), Align2::LEFT_CENTER, format!("{value:.0}"), font.clone(), ink);
        }
        painter.text(pos2(bar.left(), bar.top() - 10.0), Align2::LEFT_BOTTOM, unit, font.clone(), ink);
        let below = pos2(rect.right() - 10.0, bar.bottom() + 14.0);
        let text = format!("every {} {unit}", shown.interval);
        painter.text(below, Align2::RIGHT_TOP, text, font.clone(), ink);
        if !shown.hatching.is_empty() {
            painter.text(below + vec2(0.0, 16.0), Align2::RIGHT_TOP, "hatched: not picked", font, ink);
        }
    }
}

/// The horizon chosen, and the next one down.
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

fn north(ui: &Ui, rect: Rect) {
    let painter = ui.painter_at(rect);
    let ink = Color32::from_gray(0x20);
    let foot = pos2(rect.left() + 22.0, rect.top() + 50.0);
    let tip = foot - vec2(0.0, 26.0);
    painter.line_segment([foot, tip], Stroke::new(1.6, ink));
    painter.add(Shape::convex_polygon(
        vec![tip - vec2(0.0, 6.0), tip + vec2(4.5, 5.0), tip + vec2(-4.5, 5.0)],
        ink,
        Stroke::NONE,
    ));
    painter.text(foot + vec2(0.0, 3.0), Align2::CENTER_TOP, "N", FontId::proportional(13.0), ink);
}
