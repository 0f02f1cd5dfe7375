//! Picked surfaces before the block, as shaded cells seen as through glass.
//!
//! A sheet is drawn in at most [`CELLS`] cells along each axis, from the far ones to the near ones. A cell
//! is lighter the more it faces the viewer. Cells of one sheet share their edges exactly: they are filled
//! without gaps or overlaps, which anti-aliased areas side by side would show. Spaces: voxels; pixels of
//! the picture.

use crate::interpretation::TraceSheet;
use glam::{DVec2, DVec3};
use image::{Rgba, RgbaImage, imageops};
use render::{Scene, View};
use survey::{Quality, SurveyGeometry};
use ttf::Colour;

/// Most cells of a sheet along an axis: drawing them takes a few milliseconds.
pub const CELLS: usize = 56;
/// Opacity before the block: of horizons, of the one that is picked, and of the selection.
pub const OPACITY: [f32; 3] = [0.22, 0.6, 0.85];
/// Samples a pixel along each axis.
const SAMPLES: u32 = 2;

/// How far the colour of what was not picked is taken towards white.
const FILLED_LIGHTER: f32 = 0.6;

/// A sheet as cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cells {
    cells: Vec<Cell>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    corners: [DVec3; 4],
    /// Whether more of its corners were filled or extrapolated than picked: it is drawn lighter.
    is_filled: bool,
}

impl Cells {
    /// Of a sheet of `[inlines, crosslines]`.
    pub fn of(sheet: &TraceSheet, [nx, ny]: [usize; 2]) -> Self {
        let stride = nx.max(ny).div_ceil(CELLS).max(1);
        let nodes = |count: usize| {
            let mut nodes: Vec<usize> = (0..count).step_by(stride).collect();
            if nodes.last().is_some_and(|last| *last + 1 < count) {
                nodes.push(count - 1);
            }
            nodes
        };
        let (xs, ys) = (nodes(nx), nodes(ny));
        // Where the trace itself has no value, one beside it stands in: holes smaller than a cell are not to be seen
        // here.
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
                    let quality = corners.map(|corner| sheet.quality[corner.x as usize * ny + corner.y as usize]);
                    let is_open = |quality: &&Quality| matches!(quality, Quality::Filled | Quality::Extrapolated);
                    cells.push(Cell { corners, is_filled: quality.iter().filter(is_open).count() > 2 });
                }
            }
        }
        Self { cells }
    }
}

/// A cell as it is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenCell {
    /// Its corners in the picture, around it.
    pub corners: [DVec2; 4],
    /// Its colour, shaded.
    pub colour: Colour,
    /// Its opacity.
    pub opacity: f32,
}

/// All cells within the block, from the far ones to the near ones, in a picture that `view` looks at.
pub fn seen<'a>(
    view: &View,
    scene: &Scene,
    geometry: &SurveyGeometry,
    surfaces: impl Iterator<Item = (&'a Cells, Colour, f32)>,
) -> Vec<SeenCell> {
    let block = scene.box_in(geometry);
    let towards = view.towards_camera(block.centre());
    let (low, high) = (block.low(), block.high());
    let metres = DVec3::new(
        geometry.inline_vector.length(),
        geometry.crossline_vector.length(),
        geometry.sample_m() * scene.exaggeration,
    );
    let to_viewer = (towards * metres).normalize_or_zero();
    let mut drawn: Vec<(f64, SeenCell)> = Vec::new();
    for (cells, colour, opacity) in surfaces {
        for Cell { corners, is_filled } in &cells.cells {
            let middle = (corners[0] + corners[2]) * 0.5;
            if middle.cmplt(low).any() || middle.cmpgt(high).any() {
                continue;
            }
            let [a, b, c, d] = corners.map(|corner| corner * metres);
            let normal = (c - a).cross(d - b).normalize_or_zero();
            let light = 0.45 + 0.55 * normal.dot(to_viewer).abs() as f32;
            let lighter = if *is_filled { FILLED_LIGHTER } else { 0.0 };
            let own = |channel: u8| f32::from(channel) + lighter * (255.0 - f32::from(channel));
            let shaded = Colour { rgb: colour.rgb.map(|channel| (own(channel) * light) as u8) };
            let cell = SeenCell { corners: corners.map(|corner| view.project(corner)), colour: shaded, opacity };
            drawn.push(((middle * metres).dot(to_viewer), cell));
        }
    }
    drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
    drawn.into_iter().map(|(_, cell)| cell).collect()
}

/// Cells as a picture of this size, transparent where there are none.
pub fn picture(cells: &[SeenCell], [width, height]: [u32; 2]) -> RgbaImage {
    let mut fine = RgbaImage::new(width * SAMPLES, height * SAMPLES);
    for cell in cells {
        let [a, b, c, d] = cell.corners.map(|corner| corner * f64::from(SAMPLES));
        let [red, green, blue] = cell.colour.rgb;
        for triangle in [[a, b, c], [a, c, d]] {
            fill(&mut fine, triangle, [red, green, blue].map(f32::from), cell.opacity);
        }
    }
    let mut image = imageops::thumbnail(&fine, width, height);
    // Colours are premultiplied while they are averaged.
    for Rgba([r, g, b, alpha]) in image.pixels_mut() {
        for channel in [r, g, b] {
            *channel = (u32::from(*channel) * 255 / u32::from((*alpha).max(1))).min(255) as u8;
        }
    }
    image
}

/// Lays a triangle over premultiplied pixels whose middles lie in it, or on an upper or left side, so that
/// neighbours share none.
fn fill(image: &mut RgbaImage, [a, mut b, mut c]: [DVec2; 3], colour: [f32; 3], opacity: f32) {
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 || !area.is_finite() {
        return;
    }
    if area < 0.0 {
        std::mem::swap(&mut b, &mut c);
    }
    let low = a.min(b).min(c) - 0.5;
    let high = a.max(b).max(c) - 0.5;
    let span = |low: f64, high: f64, end: u32| {
        let last = (high.floor() + 1.0).clamp(0.0, f64::from(end));
        low.ceil().clamp(0.0, last) as u32..last as u32
    };
    let sides = [(a, b), (b, c), (c, a)];
    for y in span(low.y, high.y, image.height()) {
        for x in span(low.x, high.x, image.width()) {
            let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let inside = sides.iter().all(|(from, to)| {
                let off = (*to - *from).perp_dot(at - *from);
                // Clockwise with y down: upper sides run to the right, left sides upwards.
                let is_own = to.y < from.y || to.y == from.y && to.x > from.x;
                off > 0.0 || off == 0.0 && is_own
            });
            if inside {
                let pixel = image.get_pixel_mut(x, y);
                let [red, green, blue] = colour;
                for (channel, ink) in pixel.0.iter_mut().zip([red, green, blue, 255.0]) {
                    *channel = (ink * opacity + f32::from(*channel) * (1.0 - opacity) + 0.5) as u8;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_sheet_is_drawn_in_few_cells_up_to_its_far_corner() {
        let [nx, ny] = [301, 120];
        let (z, quality) = (vec![7.0; nx * ny], vec![Quality::Tracked; nx * ny]);
        let cells = Cells::of(&TraceSheet { block: 0, z: &z, quality: &quality }, [nx, ny]).cells;
        assert!(cells.len() <= CELLS * CELLS);
        let high = cells.iter().flat_map(|cell| cell.corners).fold(DVec3::ZERO, |high, corner| high.max(corner));
        assert_eq!(high, DVec3::new(300.0, 119.0, 7.0));
    }

    #[test]
    fn a_hole_larger_than_a_cell_stays_open() {
        let [nx, ny] = [40, 40];
        let z: Vec<f32> = (0..nx * ny).map(|n| if (10..30).contains(&(n / ny)) { f32::NAN } else { 1.0 }).collect();
        let quality = vec![Quality::Tracked; nx * ny];
        let cells = Cells::of(&TraceSheet { block: 0, z: &z, quality: &quality }, [nx, ny]).cells;
        assert!(cells.iter().flat_map(|cell| cell.corners).all(|corner| corner.x < 10.0 || corner.x >= 30.0));
        assert!(!cells.is_empty());
    }

    #[test]
    fn what_was_filled_is_lighter() {
        let geometry = SurveyGeometry::regular([9, 9, 9], 25.0, 4.0, survey::VerticalUnit::Milliseconds);
        let (z, mut quality) = (vec![4.0; 81], vec![Quality::Tracked; 81]);
        quality[..27].fill(Quality::Filled);
        quality[27..36].fill(Quality::Extrapolated);
        let cells = Cells::of(&TraceSheet { block: 0, z: &z, quality: &quality }, [9, 9]);
        let scene = Scene::default();
        let drawn =
            seen(&scene.view(&geometry), &scene, &geometry, [(&cells, Colour::new(0, 100, 200), 0.5)].into_iter());
        let light = drawn.iter().filter(|cell| cell.colour.rgb[0] > 0).count();
        // Three rows of cells lie between filled nodes; a fourth has as many picked ones as filled.
        assert_eq!((light, drawn.len()), (3 * 8, 8 * 8));
    }

    #[test]
    fn cells_that_share_an_edge_leave_no_seam() {
        let cell = |left: f64, right: f64| SeenCell {
            corners: [[left, 2.3], [right, 2.3], [right, 9.1], [left, 9.1]].map(DVec2::from_array),
            colour: Colour::new(200, 100, 50),
            opacity: 0.5,
        };
        let image = picture(&[cell(1.0, 5.37), cell(5.37, 11.0)], [12, 12]);
        for x in 1..11 {
            let pixel = image.get_pixel(x, 5).0;
            assert!(pixel[3].abs_diff(128) <= 1 && pixel[0].abs_diff(200) <= 2, "{x}: {pixel:?}");
        }
    }
}
