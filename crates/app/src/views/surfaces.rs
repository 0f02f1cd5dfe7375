//! Picked surfaces in front of the block, painted at once, before a picture of them is drawn.

use crate::state::camera;
use eframe::egui::{Color32, Mesh, Rect, Shape, Ui, vec2};
use figure::draw::surfaces::{Cells, seen};
use glam::DVec2;
use render::Scene;
use survey::SurveyGeometry;
use ttf::Colour;

/// Draws surfaces with their colours and opacities into a pane of the block view.
pub fn paint<'a>(
    ui: &Ui,
    pane: Rect,
    scene: &Scene,
    geometry: &SurveyGeometry,
    surfaces: impl Iterator<Item = (&'a Cells, Colour, f32)>,
) {
    let size = DVec2::new(f64::from(pane.width()), f64::from(pane.height()));
    let view = camera::view(scene, geometry, size);
    let mut mesh = Mesh::default();
    for cell in seen(&view, scene, geometry, surfaces) {
        let first = mesh.vertices.len() as u32;
        let [r, g, b] = cell.colour.rgb;
        let colour = Color32::from_rgba_unmultiplied(r, g, b, (cell.opacity * 255.0) as u8);
        for corner in cell.corners {
            mesh.colored_vertex(pane.min + vec2(corner.x as f32, corner.y as f32), colour);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first, first + 2, first + 3);
    }
    ui.painter_at(pane).add(Shape::mesh(mesh));
}
