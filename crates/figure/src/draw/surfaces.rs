//! Picked surfaces before the block, as shaded cells seen as through glass.
//!
//! A sheet is drawn in at most [`CELLS`] cells along each axis, from the far ones to the near ones. A cell
//! is lighter the more it faces the viewer. Cells of one sheet share their edges exactly: they are filled
//! without gaps or overlaps, which anti-aliased areas side by side would show. Spaces: voxels; pixels of
//! the picture.

use crate::interpretation::{FaultMesh, TraceSheet};
use glam::{DVec2, DVec3};
use image::{Rgba, RgbaImage, imageops};
use render::{Faces, Scene, View};
use std::collections::HashMap;
use survey::{Quality, SurveyGeometry};
use ttf::Colour;

/// Most cells of a sheet along an axis: drawing them takes a few milliseconds.
pub const CELLS: usize = 56;
/// Opacity before the block: of horizons, of the one that is picked, and of the selection.
pub const OPACITY: [f32; 3] = [0.22, 0.6, 0.85];
/// Opacity of faults, and the colour of black ones, which have no shades.
const FAULT: (f32, Colour) = (0.34, Colour::new(0x8a, 0x8f, 0x98));
/// The same before volume rendering, which is to be seen through them.
const FAULT_BEFORE_VOLUMES: f32 = 0.16;
/// Longest side of a fault's triangle, of the sides that [`CELLS`] have.
const LONGEST: f64 = 1.6;
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

    /// Of a fault's triangles in a survey of this size. Long triangles are halved, so that they end where the block does
    /// and are told by their distance; of very many small ones, neighbours are joined.
    fn of_fault(triangles: &[[DVec3; 3]], size: [usize; 3]) -> Self {
        let step = DVec3::from(size.map(|count| count as f64 / CELLS as f64)).max(DVec3::ONE);
        let mut open = if triangles.len() > CELLS * CELLS { joined(triangles, step) } else { triangles.to_vec() };
        let most = open.len() + 3 * CELLS * CELLS;
        let mut cells = Vec::new();
        let last = DVec3::from(size.map(|count| count.saturating_sub(1) as f64));
        while let Some([a, b, c]) = open.pop() {
            if a.min(b).min(c).cmpgt(last).any() || a.max(b).max(c).cmplt(DVec3::ZERO).any() {
                continue;
            }
            let length = |from: DVec3, to: DVec3| ((to - from) / step).length();
            let sides = [(length(a, b), [a, b, c]), (length(b, c), [b, c, a]), (length(c, a), [c, a, b])];
            let (longest, [a, b, c]) =
                sides.into_iter().fold((0.0, [a, b, c]), |most, side| if side.0 > most.0 { side } else { most });
            if longest > LONGEST && cells.len() + open.len() < most {
                let middle = (a + b) * 0.5;
                open.extend([[a, middle, c], [middle, b, c]]);
            } else {
                cells.push(Cell { corners: [a, b, c, c], is_filled: false });
            }
        }
        Self { cells }
    }
}

/// A fault in a survey of this size: its cells and colour.
pub fn of_fault(fault: &FaultMesh, size: [usize; 3]) -> (Cells, Colour) {
    let colour = if fault.colour == Colour::BLACK { FAULT.1 } else { fault.colour };
    (Cells::of_fault(fault.triangles, size), colour)
}

/// The opacity of a fault before a block that shows this.
pub fn fault_opacity(faces: Faces) -> f32 {
    if faces == Faces::None { FAULT_BEFORE_VOLUMES } else { FAULT.0 }
}

/// Triangles whose corners are joined within boxes of these sides: the first corner stands for those of its box.
fn joined(triangles: &[[DVec3; 3]], step: DVec3) -> Vec<[DVec3; 3]> {
    let mut places: HashMap<[i64; 3], DVec3> = HashMap::new();
    let own = |place: DVec3, places: &mut HashMap<[i64; 3], DVec3>| {
        let key = (place / step).floor().to_array().map(|n| n as i64);
        *places.entry(key).or_insert(place)
    };
    let corners = triangles.iter().map(|corners| corners.map(|place| own(place, &mut places)));
    corners.filter(|[a, b, c]| a != b && b != c && c != a).collect()
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
mod tests;
