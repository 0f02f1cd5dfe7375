//! Picked surfaces before the block, drawn at once: sheets as shaded cells, as through glass, without waiting for a picture.
//!
//! A sheet is drawn in at most `CELLS` cells along each axis, from the far ones to the near ones. A cell is lighter the more it faces the viewer.
//! Spaces: voxels; points of the window.

use crate::state::camera;
use eframe::egui::{Color32, Mesh, Pos2, Rect, Shape, Ui, vec2};
use glam::{DVec2, DVec3};
use interp::reassembly::VoxelSheet;
use render::Scene;
use survey::SurveyGeometry;

/// Most cells of a sheet along an axis: drawing them takes a few milliseconds.
const CELLS: usize = 56;

/// A sheet as cells, each with its corners.
pub struct Cells {
    cells: Vec<[DVec3; 4]>,
}

impl Cells {
    /// Of a sheet of `[inlines, crosslines]`.
    pub fn of(sheet: &VoxelSheet, [nx, ny]: [usize; 2]) -> Self {
        let stride = nx.max(ny).div_ceil(CELLS).max(1);
        let nodes = |count: usize| {
            let mut nodes: Vec<usize> = (0..count).step_by(stride).collect();
            if nodes.last().is_some_and(|last| *last + 1 < count) {
                nodes.push(count - 1);
            }
            nodes
        };
        let (xs, ys) = (nodes(nx), nodes(ny));
        // Where the trace itself has no value, one beside it stands in: holes smaller than a cell are not to be seen here.
        let value = |x: usize, y: usize| {
            let reach = stride / 2;
            let own = sheet.z[x * ny + y];
            if own.is_finite() || reach == 0 {
                return own;
            }
            let near = |at: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
            let found = near(x, nx).flat_map(|x| near(y, ny).map(move |y| x * ny + y)).map(|n| sheet.z[n]);
            found.into_iter().find(|z| z.is_finite()).unwrap_or(f32::NAN)
        };
        let mut cells = Vec::new();
        for pair in xs.windows(2) {
            for other in ys.windows(2) {
                let corner = |x: usize, y: usize| DVec3::new(x as f64, y as f64, f64::from(value(x, y)));
                let corners = [
                    corner(pair[0], other[0]),
                    corner(pair[1], other[0]),
                    corner(pair[1], other[1]),
                    corner(pair[0], other[1]),
                ];
                if corners.iter().all(|corner| corner.z.is_finite()) {
                    cells.push(corners);
                }
            }
        }
        Self { cells }
    }
}

/// Draws surfaces into a pane of the block view.
pub fn paint<'a>(
    ui: &Ui,
    pane: Rect,
    scene: &Scene,
    geometry: &SurveyGeometry,
    surfaces: impl Iterator<Item = (&'a Cells, Color32)>,
) {
    let size = DVec2::new(f64::from(pane.width()), f64::from(pane.height()));
    let view = camera::view(scene, geometry, size);
    let block = scene.box_in(geometry);
    let towards = view.towards_camera(block.centre());
    let (low, high) = (DVec3::from_array(block.min), DVec3::from_array(block.max));
    let metres = DVec3::new(
        geometry.inline_vector.length(),
        geometry.crossline_vector.length(),
        geometry.sample_m() * scene.exaggeration,
    );
    let to_viewer = (towards * metres).normalize_or_zero();
    let mut drawn: Vec<(f64, [Pos2; 4], Color32)> = Vec::new();
    for (cells, colour) in surfaces {
        for corners in &cells.cells {
            let middle = (corners[0] + corners[2]) * 0.5;
            if middle.cmplt(low).any() || middle.cmpgt(high).any() {
                continue;
            }
            let [a, b, c, d] = corners.map(|corner| corner * metres);
            let normal = (c - a).cross(d - b).normalize_or_zero();
            let light = 0.45 + 0.55 * normal.dot(to_viewer).abs() as f32;
            let at = corners.map(|corner| {
                let at = view.project(corner);
                pane.min + vec2(at.x as f32, at.y as f32)
            });
            drawn.push(((middle * metres).dot(to_viewer), at, shaded(colour, light)));
        }
    }
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut mesh = Mesh::default();
    for (_, corners, colour) in drawn {
        let first = mesh.vertices.len() as u32;
        for corner in corners {
            mesh.colored_vertex(corner, colour);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first, first + 2, first + 3);
    }
    ui.painter_at(pane).add(Shape::mesh(mesh));
}

fn shaded(colour: Color32, light: f32) -> Color32 {
    let [r, g, b, alpha] = colour.to_srgba_unmultiplied();
    let dim = |channel: u8| (f32::from(channel) * light) as u8;
    Color32::from_rgba_unmultiplied(dim(r), dim(g), dim(b), alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::Quality;

    #[test]
    fn a_large_sheet_is_drawn_in_few_cells_over_all_of_it() {
        let [nx, ny] = [301, 120];
        let sheet = VoxelSheet { block: 0, z: vec![7.0; nx * ny], quality: vec![Quality::Tracked; nx * ny] };
        let cells = Cells::of(&sheet, [nx, ny]).cells;
        assert!(cells.len() <= CELLS * CELLS);
        let high = cells.iter().flatten().fold(DVec3::ZERO, |high, corner| high.max(*corner));
        assert_eq!(high, DVec3::new(300.0, 119.0, 7.0));
    }

    #[test]
    fn a_hole_larger_than_a_cell_stays_open() {
        let [nx, ny] = [40, 40];
        let z = (0..nx * ny).map(|n| if (10..30).contains(&(n / ny)) { f32::NAN } else { 1.0 }).collect();
        let sheet = VoxelSheet { block: 0, z, quality: vec![Quality::Tracked; nx * ny] };
        let cells = Cells::of(&sheet, [nx, ny]).cells;
        assert!(cells.iter().flatten().all(|corner| corner.x < 10.0 || corner.x >= 30.0));
        assert!(!cells.is_empty());
    }
}
