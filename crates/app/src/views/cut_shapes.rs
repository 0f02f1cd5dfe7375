//! Cut-outs that are no boxes, in the panel of the block: fences, round shafts, sloping planes.

use crate::state::Session;
use crate::widgets::obstacle::{needs, unless};
use eframe::egui::{Button, DragValue, Response, Ui};
use glam::{DVec2, DVec3};
use render::{CutShape, Scene, Side};
use survey::SurveyGeometry;

/// Radius of a new shaft as a share of the shorter side of the block.
const SHAFT: f64 = 0.25;
/// Dip of a new plane, degrees.
const DIP_DEG: f64 = 35.0;

/// Buttons that add a cut-out, and a row for each that there is.
pub fn show(ui: &mut Ui, session: &Session, scene: &mut Scene) {
    let Some(geometry) = &session.document.geometry else { return };
    ui.horizontal_wrapped(|ui| add(ui, session, scene, geometry));
    let mut removed = None;
    for n in 0..scene.cut_shapes.len() {
        let name = format!("{} {}", name(&scene.cut_shapes[n]), n + 1);
        ui.horizontal_wrapped(|ui| {
            ui.label(&name);
            let shape = &mut scene.cut_shapes[n];
            match shape {
                CutShape::Fence { .. } => fence(ui, shape, &name, geometry),
                CutShape::Outline { outline, depth, .. } => {
                    shaft(ui, outline, &name, geometry);
                    depths(ui, depth, &name, geometry);
                }
                CutShape::Plane { .. } => plane(ui, shape, &name, geometry),
            }
            if super::data::remove(ui, &format!("Remove {}", name.to_lowercase())) {
                removed = Some(n);
            }
        });
    }
    if let Some(n) = removed {
        scene.cut_shapes.remove(n);
    }
}

fn name(shape: &CutShape) -> &'static str {
    match shape {
        CutShape::Fence { .. } => "Fence",
        CutShape::Outline { .. } => "Shaft",
        CutShape::Plane { .. } => "Plane",
    }
}

fn add(ui: &mut Ui, session: &Session, scene: &mut Scene, geometry: &SurveyGeometry) {
    let block = scene.box_in(geometry);
    let view = scene.view(geometry);
    let fence = &session.view.fence;
    let line = needs(fence.len() > 1, "Click the corners of a line in the fence view first");
    let along = unless(ui, line, Button::new("Cut along fence"));
    let along = along.on_hover_text("Cut away what lies before the line of the fence view");
    if along.clicked() {
        let side = Side::facing(fence, view.towards_camera(block.centre()).truncate());
        scene.cut_shapes.push(CutShape::Fence { fence: fence.clone(), side, smooth: false, depth: None });
    }
    // In front of the viewer, so that it is seen at once.
    let towards = view.towards_camera(block.centre()).truncate().normalize_or(DVec2::X);
    let extent = block.extent().truncate();
    let before = block.centre().truncate() + towards * extent * 0.25;
    if ui.button("Round shaft").on_hover_text("Cut a round shaft").clicked() {
        let shorter_m = (extent.x * geometry.inline_vector.length()).min(extent.y * geometry.crossline_vector.length());
        scene.cut_shapes.push(CutShape::round(before, SHAFT * shorter_m, None, geometry));
    }
    if ui.button("Sloping plane").on_hover_text("Cut away what lies above a plane that dips towards you").clicked() {
        let world = geometry.inline_vector * towards.x + geometry.crossline_vector * towards.y;
        let bearing_deg = world.x.atan2(world.y).to_degrees();
        scene.cut_shapes.push(CutShape::dipping(block.centre(), bearing_deg, DIP_DEG, geometry));
    }
}

fn fence(ui: &mut Ui, shape: &mut CutShape, name: &str, geometry: &SurveyGeometry) {
    let CutShape::Fence { side, smooth, depth, .. } = shape else { return };
    if ui.button("Other side").on_hover_text(format!("Cut the other side of {} away", name.to_lowercase())).clicked() {
        *side = side.other();
    }
    ui.checkbox(smooth, "curve").on_hover_text("Lead a curve through the corners");
    depths(ui, depth, name, geometry);
}

/// The depths between which a fence or a shaft cuts.
fn depths(ui: &mut Ui, depth: &mut Option<[f64; 2]>, name: &str, geometry: &SurveyGeometry) {
    let last = geometry.size()[2].saturating_sub(1) as f64;
    let mut is_bounded = depth.is_some();
    let check = ui.checkbox(&mut is_bounded, "only between");
    if check.on_hover_text("Cut between two depths or times, otherwise through the whole block").changed() {
        *depth = is_bounded.then_some([0.0, (0.5 * last).round()]);
    }
    let Some(range) = depth else { return };
    let unit = geometry.vertical.unit.symbol();
    let [mut top, mut base] = range.map(|z| geometry.vertical.value_at(z));
    let changed = [
        field(ui, name, "from", DragValue::new(&mut top).max_decimals(0), ""),
        field(ui, name, "to", DragValue::new(&mut base).max_decimals(0), unit),
    ];
    if changed.iter().any(Response::changed) {
        let [top, base] = [top, base].map(|value| geometry.vertical.index_of(value).clamp(0.0, last));
        // At least a sample, so that there is something to cut.
        *range = [top.min(last - 1.0), base.max(top.min(last - 1.0) + 1.0)];
    }
}

fn shaft(ui: &mut Ui, outline: &mut [[f64; 2]], name: &str, geometry: &SurveyGeometry) {
    let centre = outline.iter().map(|p| DVec2::from(*p)).sum::<DVec2>() / outline.len().max(1) as f64;
    let metres = |p: DVec2| geometry.inline_vector * p.x + geometry.crossline_vector * p.y;
    let mean = outline.iter().map(|p| metres(DVec2::from(*p) - centre).length()).sum::<f64>() / outline.len() as f64;
    let lines = geometry.lines_from_voxel(centre);
    let (mut inline, mut crossline, mut radius_m) = (lines.x, lines.y, mean);
    let changed = [
        field(ui, name, "inline", DragValue::new(&mut inline).max_decimals(0), ""),
        field(ui, name, "crossline", DragValue::new(&mut crossline).max_decimals(0), ""),
        field(ui, name, "radius", DragValue::new(&mut radius_m).range(1.0..=1e5).speed(5.0).max_decimals(0), "m"),
    ];
    if changed.iter().any(Response::changed) {
        let moved = geometry.voxel_from_lines(inline, crossline);
        for p in outline {
            *p = (moved + (DVec2::from(*p) - centre) * (radius_m / mean)).to_array();
        }
    }
}

fn plane(ui: &mut Ui, shape: &mut CutShape, name: &str, geometry: &SurveyGeometry) {
    let CutShape::Plane { through, .. } = shape else { return };
    let at = DVec3::from_array(*through);
    let Some([mut bearing_deg, mut dip_deg]) = shape.bearing_and_dip(geometry) else { return };
    let mut z = geometry.vertical.value_at(at.z);
    let unit = geometry.vertical.unit.symbol();
    let changed = [
        field(ui, name, "at", DragValue::new(&mut z).max_decimals(0), unit),
        field(ui, name, "dip", DragValue::new(&mut dip_deg).range(0.0..=90.0).max_decimals(0), "°"),
        field(ui, name, "towards", DragValue::new(&mut bearing_deg).max_decimals(0), "°"),
    ];
    if changed.iter().any(Response::changed) {
        let at = at.truncate().extend(geometry.vertical.index_of(z));
        *shape = CutShape::dipping(at, bearing_deg, dip_deg, geometry);
    }
}

/// A number with its unit, which a screen reader calls by the shape's name.
fn field(ui: &mut Ui, name: &str, what: &str, value: DragValue, unit: &str) -> Response {
    ui.label(what);
    let response = ui.name_inputs(format!("{name} {what}"), |ui| ui.add(value));
    if !unit.is_empty() {
        ui.label(unit);
    }
    response
}
