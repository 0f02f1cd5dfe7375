//! A pattern on a face: the tile's drawing, carried through the inverse of the map from rock to pattern.
//!
//! The map takes a place (s, t) of the face to tile units (u, v): a mapping of (i, j, k), times frequencies. A point of
//! the drawing in the copy (m, n) of the tile lies where the map is (u + m, v + n); Newton's method finds it from the
//! point before. Copies are found on a lattice of about a voxel over the area: each cell says which copies of which
//! shapes it may hold. Beyond the area the region's own coordinates go on, so that what lies across its border
//! is whole and the area's outline cuts it.

use super::typical::{most_frequent, typical};
use super::{PatternPaint, Polyline};
use crate::face_map::FaceMap;
use crate::resolved_scene::{ResolvedInterpretation, ResolvedScene};
use glam::{DMat2, DVec2, Vec3};
use model::Region;
use model::section::{SectionPlane, band};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use ttf::{Mapping, TileDrawing, TilePaint, TileSegment, TileShape};

/// Longest side of a cell of the lattice, voxels.
const CELL: f64 = 1.0;
/// Most cells on a side of the lattice.
const MOST_CELLS: f64 = 1024.0;
/// A cell over which the pattern changes by more tiles is left out: the map folds there.
const MOST_TILES: f64 = 64.0;
/// Copies of a shape are looked for so far from it, tiles: no drawing reaches farther.
const REACH: f64 = ttf::MOST_REACH as f64;
/// Newton's method stops this close, tile units.
const CLOSE: f64 = 2e-4;
/// A place that is off by less is found, tile units.
const FOUND: f64 = 2e-3;
/// A smaller change of tile coordinates, square tiles per square voxel, is none.
const FLAT: f64 = 1e-12;
/// Longest step of Newton's method, voxels.
const LONGEST_STEP: f64 = 4.0;
/// Most steps of Newton's method.
const STEPS: usize = 12;
/// Deepest subdivision of a line or curve.
const DEEPEST: u32 = 8;
/// Parts that a curve is divided into at least.
const CURVE_PARTS: u32 = 2;
/// Shapes smaller than this are left out where the pattern is squeezed, tiles: dots would become a blot.
const DOT: f64 = 0.12;
/// Where dots are left out: so much narrower than in the middle of the area.
const SQUEEZED: f64 = 0.3;
/// Beds thinner than this have no pattern, heights of a tile: less than a row of bricks.
const SCRAP: f64 = 0.06;
/// The mapping whose v runs across the map and not down the layers, by its number.
const MAP: usize = 2;
/// An area over less than this share of its layer's thickness is no bed but a corner of one.
const ACROSS: f64 = 0.5;
/// A line is torn where its places still lie this far apart after [`DEEPEST`] divisions, pixels.
const TORN_PX: f64 = 1.5;

/// A tile's drawing, and its printed width divided by its height.
pub(super) struct Tile {
    pub drawing: Arc<TileDrawing>,
    pub aspect: f64,
}

/// The pattern of one region on one face.
pub(super) struct FacePattern<'a> {
    pub resolved: &'a ResolvedScene<'a>,
    pub interpretation: ResolvedInterpretation<'a>,
    /// How patterns lie on the face.
    pub map: FaceMap,
    pub plane: SectionPlane,
    pub region: Region,
    /// Repeats of the tile over i and over k.
    pub frequency: [f32; 2],
    /// How far a curve may lie from its straight pieces, pixels.
    pub tolerance_px: f64,
}

/// Pieces of the pattern that look alike, in the colour that the tile has.
pub(super) struct DrawnPart {
    pub paint: PatternPaint,
    pub colour: [f32; 3],
    pub opacity: f32,
    pub lines: Vec<Polyline>,
}

/// A copy of a shape of the tile: shape, tiles to the right and upwards.
type Copy = (usize, i64, i64);

/// One mapping of the face, and the cells in which it has the largest weight.
struct MappedCells<'a> {
    face: &'a FacePattern<'a>,
    mapping: Mapping,
    scale: [f64; 2],
    lattice: &'a Lattice,
    /// Whether each cell belongs to the area and to this mapping.
    is_mine: Vec<bool>,
}

/// A grid over the area.
struct Lattice {
    low: DVec2,
    step: DVec2,
    cells: [usize; 2],
    /// Whether each cell touches the area.
    is_inside: Vec<bool>,
}

impl Lattice {
    fn over(rings: &[Vec<DVec2>]) -> Option<Self> {
        let all = || rings.iter().flatten().copied();
        let low = all().fold(DVec2::INFINITY, DVec2::min);
        let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
        let size = high - low;
        if !(size.is_finite() && size.min_element() > 0.0) {
            return None;
        }
        let cells = (size / CELL).ceil().clamp(DVec2::ONE, DVec2::splat(MOST_CELLS));
        let mut lattice =
            Self { low, step: size / cells, cells: [cells.x as usize, cells.y as usize], is_inside: Vec::new() };
        lattice.is_inside = vec![false; lattice.cells[0] * lattice.cells[1]];
        lattice.fill(rings);
        Some(lattice)
    }

    /// Marks the cells that the rings pass, and those whose middle lies within them.
    fn fill(&mut self, rings: &[Vec<DVec2>]) {
        for ring in rings {
            for n in 0..ring.len() {
                let (a, b) = (ring[n], ring[(n + 1) % ring.len()]);
                let steps = ((b - a) / self.step).abs().max_element().mul_add(4.0, 1.0).ceil() as usize;
                for step in 0..=steps {
                    if let Some(cell) = self.cell_at(a.lerp(b, step as f64 / steps as f64)) {
                        self.is_inside[cell] = true;
                    }
                }
            }
        }
        for x in 0..self.cells[0] {
            // Where the line of the middles of this column crosses the rings.
            let s = self.low.x + (x as f64 + 0.5) * self.step.x;
            let mut crossings: Vec<f64> = Vec::new();
            for ring in rings {
                for n in 0..ring.len() {
                    let (a, b) = (ring[n], ring[(n + 1) % ring.len()]);
                    if (a.x <= s) != (b.x <= s) {
                        crossings.push(a.y + (b.y - a.y) * (s - a.x) / (b.x - a.x));
                    }
                }
            }
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let row = |t: f64| ((t - self.low.y) / self.step.y - 0.5).ceil().max(0.0) as usize;
                for y in row(pair[0])..row(pair[1]).min(self.cells[1]) {
                    self.is_inside[x * self.cells[1] + y] = true;
                }
            }
        }
    }

    fn cell_at(&self, st: DVec2) -> Option<usize> {
        let at = (st - self.low) / self.step;
        // The far border belongs to the last cell.
        let index = |at: f64, count: usize| {
            (at > -1e-9 && at < count as f64 + 1e-9).then(|| (at.max(0.0) as usize).min(count - 1))
        };
        Some(index(at.x, self.cells[0])? * self.cells[1] + index(at.y, self.cells[1])?)
    }

    fn corner(&self, cell: usize) -> DVec2 {
        self.low + self.step * DVec2::new((cell / self.cells[1]) as f64, (cell % self.cells[1]) as f64)
    }

    fn middle(&self, cell: usize) -> DVec2 {
        self.corner(cell) + 0.5 * self.step
    }
}

impl FacePattern<'_> {
    /// The pattern over an area, (s, t), back to front; `None` where that is too thin for it.
    pub(super) fn drawn(&self, rings: &[Vec<DVec2>], tile: &Tile, thickness_px: f64) -> Option<Vec<DrawnPart>> {
        let groups = tile.drawing.alike();
        let Some(lattice) = Lattice::over(rings).filter(|_| !groups.is_empty()) else { return Some(Vec::new()) };
        let mappings = self.map.frame.mappings(self.resolved.tables.globals.aspect_j);
        let [horizontal, vertical] = self.frequency.map(f64::from);
        let scales = [[horizontal, vertical], [horizontal, vertical], [horizontal, horizontal]];
        let leading: Vec<Option<usize>> =
            (0..lattice.is_inside.len()).map(|cell| self.leading(&lattice, cell)).collect();
        let most = most_frequent(&leading);
        let mut parts = Vec::new();
        for (n, (mapping, scale)) in mappings.into_iter().zip(scales).enumerate() {
            let is_mine: Vec<bool> = leading.iter().map(|leading| *leading == Some(n)).collect();
            if is_mine.iter().any(|mine| *mine) {
                let cells = MappedCells { face: self, mapping, scale, lattice: &lattice, is_mine };
                let px_from_tile = cells.px_from_tile();
                // A narrow part of a wall is as thick as its bed.
                let of_bed = if n == MAP { 0.0 } else { cells.bed_px(self.depths(rings), px_from_tile) };
                let is_thin =
                    most == Some(n) && thickness_px.max(of_bed) < SCRAP * px_from_tile.x_axis.length() / tile.aspect;
                if is_thin && self.is_across(rings) {
                    return None;
                }
                parts.extend(cells.drawn(tile, &groups, px_from_tile));
            }
        }
        Some(parts)
    }

    /// The mapping with the largest weight in a cell of the area.
    fn leading(&self, lattice: &Lattice, cell: usize) -> Option<usize> {
        if !lattice.is_inside[cell] {
            return None;
        }
        let p = self.plane.voxel(lattice.middle(cell)).as_vec3();
        let (_, jacobian) = self.interpretation.flat_at(p, Some(self.region));
        let weights = self.map.weights(&self.resolved.tables, self.region.layer, &jacobian).to_array();
        (0..3).max_by(|a, b| weights[*a].total_cmp(&weights[*b]))
    }

    /// Whether an area reaches over most of its layer's thickness.
    fn is_across(&self, rings: &[Vec<DVec2>]) -> bool {
        let [low, high] = self.depths(rings);
        high - low > ACROSS
    }

    /// The least and the largest k on the rim of an area.
    fn depths(&self, rings: &[Vec<DVec2>]) -> [f64; 2] {
        let depths = rings.iter().flatten().map(|at| self.depth(*at));
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        depths.fold(ends, |[low, high], depth| [low.min(depth), high.max(depth)])
    }

    /// k at a place of the face.
    fn depth(&self, st: DVec2) -> f64 {
        f64::from(self.interpretation.flat_at(self.plane.voxel(st).as_vec3(), Some(self.region)).0.k)
    }

    /// The rings, pixels, of the part of an area whose depth in the layer lies in an interval.
    pub(super) fn band(&self, rings: &[Vec<DVec2>], k: [f32; 2]) -> Vec<Vec<DVec2>> {
        let Some(lattice) = Lattice::over(rings) else { return Vec::new() };
        let [columns, rows] = lattice.cells;
        let depth = |n: usize| {
            let st = lattice.low + lattice.step * DVec2::new((n / (rows + 1)) as f64, (n % (rows + 1)) as f64);
            self.depth(st)
        };
        let depths: Vec<f64> = (0..(columns + 1) * (rows + 1)).into_par_iter().map(depth).collect();
        let value = |x: usize, y: usize| depths[x * (rows + 1) + y];
        let is_inside = |x: usize, y: usize| lattice.is_inside[x * rows + y];
        let px = |at: &DVec2| self.px(lattice.low + lattice.step * *at);
        let found = band(lattice.cells, value, is_inside, k.map(f64::from));
        found.iter().map(|ring| ring.iter().map(px).collect()).collect()
    }

    fn px(&self, st: DVec2) -> DVec2 {
        self.resolved.view.project(self.plane.voxel(st))
    }
}

impl MappedCells<'_> {
    /// Tile coordinates of a place, and how they change over (s, t), column by column.
    fn uv(&self, st: DVec2) -> (DVec2, DMat2) {
        let plane = &self.face.plane;
        let p = plane.voxel(st).as_vec3();
        let (flat, jacobian) = self.face.interpretation.flat_at(p, Some(self.face.region));
        let scaled = |[u, v]: [f32; 2]| DVec2::new(f64::from(u) * self.scale[0], f64::from(v) * self.scale[1]);
        let along = |axis: glam::DVec3| {
            let step = jacobian.map(|row| Vec3::from_array(row).dot(axis.as_vec3()));
            scaled(self.mapping.apply(step))
        };
        let at = scaled(self.mapping.place([flat.i, flat.j, flat.k]));
        (at, DMat2::from_cols(along(plane.s_axis), along(plane.t_axis)))
    }

    /// The place whose tile coordinates are `target`, looked for from a place nearby, and whether it was found: the
    /// map may fold, and ends some way beyond the area.
    fn place(&self, target: DVec2, from: DVec2) -> (DVec2, bool) {
        let (mut best, mut best_off) = (from, f64::INFINITY);
        let mut st = from;
        for _ in 0..STEPS {
            let (uv, change) = self.uv(st);
            let off = target - uv;
            if off.length() >= best_off || !off.is_finite() {
                // Farther away than before: half the way back.
                st = 0.5 * (st + best);
                continue;
            }
            (best, best_off) = (st, off.length());
            if best_off < CLOSE || change.determinant().abs() < FLAT {
                break;
            }
            st += (change.inverse() * off).clamp_length_max(LONGEST_STEP);
        }
        (best, best_off < FOUND)
    }

    /// The parts of the pattern in these cells.
    fn drawn(&self, tile: &Tile, groups: &[std::ops::Range<usize>], px_from_tile: DMat2) -> Vec<DrawnPart> {
        let copies: Vec<(Copy, DVec2)> = self.copies(&tile.drawing).into_iter().collect();
        let px_per_tile = (px_from_tile.determinant().abs() * tile.aspect).sqrt();
        let traced: Vec<(usize, Vec<Polyline>)> = copies
            .par_iter()
            .map(|((shape, m, n), near)| {
                let by = DVec2::new(*m as f64, *n as f64);
                (*shape, self.traced(&tile.drawing.shapes[*shape], by, *near, px_per_tile))
            })
            .collect();
        let mut parts = Vec::new();
        for group in groups {
            let lines = traced.iter().filter(|(shape, _)| group.contains(shape));
            let shape = &tile.drawing.shapes[group.start];
            let px_across = px_across(&tile.drawing.shapes[group.clone()], px_from_tile, tile.aspect);
            let part = |lines: Vec<Polyline>| DrawnPart {
                paint: paint(&shape.paint, [px_across, px_per_tile * px_per_tile / px_across.max(1e-9)]),
                colour: shape.colour,
                opacity: shape.opacity,
                lines,
            };
            if shape.paint == (TilePaint::Area { even_odd: true }) {
                parts.extend(lines.filter(|(_, lines)| !lines.is_empty()).map(|(_, lines)| part(lines.clone())));
            } else {
                let lines: Vec<Polyline> = lines.flat_map(|(_, lines)| lines.iter().cloned()).collect();
                parts.extend((!lines.is_empty()).then(|| part(lines)));
            }
        }
        parts
    }

    /// Copies of shapes that may reach into the area, in a fixed order, each with a place near it.
    fn copies(&self, drawing: &TileDrawing) -> BTreeMap<Copy, DVec2> {
        let bounds: Vec<[[f64; 2]; 2]> = drawing.shapes.iter().map(TileShape::bounds).collect();
        let mut copies = BTreeMap::new();
        for cell in (0..self.is_mine.len()).filter(|cell| self.is_mine[*cell]) {
            let corner = self.lattice.corner(cell);
            let step = self.lattice.step;
            let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|at| self.uv(corner + step * at).0);
            let low = corners.into_iter().fold(DVec2::INFINITY, DVec2::min);
            let high = corners.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
            // A cell over which the map bends holds a little more than its corners say.
            let (low, high) = (low - 0.1 * (high - low), high + 0.1 * (high - low));
            let tiles = (high - low).max_element();
            if tiles.is_nan() || tiles >= MOST_TILES {
                continue;
            }
            for (shape, [least, most]) in bounds.iter().enumerate() {
                // No shape brings more copies into a cell than one that reaches as far as a tile's may.
                let range = |axis: usize| {
                    let (least, most) = (least[axis].max(-REACH), most[axis].min(1.0 + REACH));
                    let first = (low[axis] - most).ceil() as i64;
                    first..=(high[axis] - least).floor() as i64
                };
                for m in range(0) {
                    for n in range(1) {
                        copies.entry((shape, m, n)).or_insert_with(|| self.lattice.middle(cell));
                    }
                }
            }
        }
        copies
    }

    /// A copy of a shape in pixels; nothing if it does not reach into the cells.
    fn traced(&self, shape: &TileShape, by: DVec2, near: DVec2, px_per_tile: f64) -> Vec<Polyline> {
        let [low, high] = shape.bounds().map(DVec2::from_array);
        if (high - low).max_element() < DOT && self.is_squeezed(0.5 * (low + high) + by, near, px_per_tile) {
            return Vec::new();
        }
        let mut trace = Trace {
            cells: self,
            by,
            is_area: matches!(shape.paint, TilePaint::Area { .. }),
            at: DVec2::ZERO,
            begin: DVec2::ZERO,
            st: near,
            reaches: false,
            is_drawing: false,
            is_torn: false,
            lines: Vec::new(),
        };
        shape.path.iter().for_each(|segment| trace.add(segment));
        if !(trace.reaches || self.is_around(&trace.lines, near)) {
            return Vec::new();
        }
        // An area needs three corners, a line a second point, if only in the same place.
        let least = if trace.is_area { 3 } else { 2 };
        trace.lines.retain(|line| line.points.len() >= least);
        trace.lines
    }

    /// Whether tiles are much narrower at a point of the pattern than in the middle of the area.
    fn is_squeezed(&self, target: DVec2, near: DVec2, px_per_tile: f64) -> bool {
        let (st, _) = self.place(target, near);
        let (_, change) = self.uv(st);
        let axes = [DVec2::X, DVec2::Y].map(|axis| (self.face.px(st + 1e-3 * axis) - self.face.px(st)) * 1e3);
        let px_from_uv = DMat2::from_cols(axes[0], axes[1]) * change.inverse();
        // The smaller singular value, from the sum of squares and the determinant.
        let (sum, product) =
            (px_from_uv.x_axis.length_squared() + px_from_uv.y_axis.length_squared(), px_from_uv.determinant().abs());
        let narrowest = (0.5 * (sum - (sum * sum - 4.0 * product * product).max(0.0).sqrt())).max(0.0).sqrt();
        // A face seen from aside is narrow everywhere: its squeeze is that of its pixels.
        let face = DMat2::from_cols(axes[0], axes[1]);
        let aside = (face.determinant().abs() / (face.x_axis.length() * face.y_axis.length())).clamp(0.05, 1.0);
        narrowest < SQUEEZED * aside * px_per_tile
    }

    /// Whether a straight stretch passes one of these cells, though its ends may lie beside them.
    fn are_passed(&self, [a, b]: &[TracedEnd; 2]) -> bool {
        let steps = (2.0 * ((b.st - a.st) / self.lattice.step).abs().max_element()).ceil().max(1.0) as usize;
        let cell = |n: usize| self.lattice.cell_at(a.st.lerp(b.st, n as f64 / steps as f64));
        (0..=steps).filter_map(cell).any(|cell| self.is_mine[cell])
    }

    /// Whether lines run around the place near which they were looked for.
    fn is_around(&self, lines: &[Polyline], near: DVec2) -> bool {
        let at = self.face.px(near);
        let points = || lines.iter().flat_map(|line| line.points.iter().copied());
        let (low, high) = (points().fold(DVec2::INFINITY, DVec2::min), points().fold(DVec2::NEG_INFINITY, DVec2::max));
        low.cmple(at).all() && high.cmpge(at).all()
    }

    /// How tiles lie in most of the area: pixels from tile units, (u, v).
    fn px_from_tile(&self) -> DMat2 {
        let mine: Vec<usize> = (0..self.is_mine.len()).filter(|cell| self.is_mine[*cell]).collect();
        let every = mine.len().div_ceil(200).max(1);
        let map = |cell: &usize| {
            let st = self.lattice.middle(*cell);
            let [s, t] = [DVec2::X, DVec2::Y].map(|axis| (self.face.px(st + 1e-3 * axis) - self.face.px(st)) * 1e3);
            DMat2::from_cols(s, t) * self.uv(st).1.inverse()
        };
        let maps: Vec<DMat2> = mine.iter().step_by(every).map(map).filter(DMat2::is_finite).collect();
        typical(&maps)
    }
}

impl MappedCells<'_> {
    /// How thick a bed between two k is in the middle of the area, pixels, where v is k.
    fn bed_px(&self, [low, high]: [f64; 2], px_from_tile: DMat2) -> f64 {
        let px_per_v = px_from_tile.determinant().abs() / px_from_tile.x_axis.length().max(1e-9);
        ((high - low).max(0.0) * self.scale[1] * px_per_v).max(0.0)
    }
}

/// Pixels to a stroke's width of a tile, the mean over all its directions: on a face seen aslant they differ.
fn px_across(shapes: &[TileShape], px_from_tile: DMat2, aspect: f64) -> f64 {
    let px_from_square = px_from_tile * DMat2::from_diagonal(DVec2::new(1.0, aspect));
    let area = px_from_square.determinant().abs();
    let steps = || shapes.iter().flat_map(|shape| shape.steps(aspect)).map(DVec2::from_array);
    let across = |step: DVec2| area * step.length_squared() / (px_from_square * step).length().max(1e-12);
    let (sum, long): (f64, f64) = (steps().map(across).sum(), steps().map(DVec2::length).sum());
    if long > CLOSE { sum / long } else { area.sqrt() }
}

/// A paint in pixels, by those to a tile's width across strokes and along them.
fn paint(paint: &TilePaint, [px_across, px_along]: [f64; 2]) -> PatternPaint {
    match paint {
        TilePaint::Area { even_odd } => PatternPaint::Area { even_odd: *even_odd },
        TilePaint::Line { width, dashes, round } => PatternPaint::Line {
            width_px: width * px_across,
            dashes_px: dashes.iter().map(|dash| dash * px_along).collect(),
            round: *round,
        },
    }
}

/// A shape being carried onto the face.
///
/// Where a place is not found, or the next one is not beside it, a line is interrupted and an area goes straight on.
struct Trace<'a> {
    cells: &'a MappedCells<'a>,
    /// Tiles that the copy lies to the right and upwards.
    by: DVec2,
    is_area: bool,
    /// The last point in the tile, and where its piece began.
    at: DVec2,
    begin: DVec2,
    /// The last place on the face.
    st: DVec2,
    /// Whether a place lay in a cell of the area.
    reaches: bool,
    /// Whether the next point goes on with the last line.
    is_drawing: bool,
    /// Whether the present piece was interrupted.
    is_torn: bool,
    lines: Vec<Polyline>,
}

/// An end of a stretch of a line: where on its segment, and where on the face, if it was found.
#[derive(Clone, Copy)]
struct TracedEnd {
    at: f64,
    st: DVec2,
    px: DVec2,
    is_found: bool,
}

impl Trace<'_> {
    fn add(&mut self, segment: &TileSegment) {
        let from = self.at;
        let tile = DVec2::from_array;
        match *segment {
            TileSegment::Move(p) => {
                let p = tile(p);
                (self.at, self.begin) = (p, p);
                (self.is_drawing, self.is_torn) = (false, false);
                let first = self.end(0.0, p);
                if first.is_found || self.is_area {
                    self.lines.push(Polyline { points: Vec::new(), closed: false });
                    self.is_drawing = true;
                }
                if first.is_found {
                    self.push(first);
                }
                self.is_torn = !first.is_found;
            }
            TileSegment::Line(p) => self.follow(1, &|t| from.lerp(tile(p), t)),
            TileSegment::Cubic(a, b, p) => self.follow(CURVE_PARTS, &|t| {
                let (a, b, p) = (tile(a), tile(b), tile(p));
                let u = 1.0 - t;
                u * u * u * from + 3.0 * u * u * t * a + 3.0 * u * t * t * b + t * t * t * p
            }),
            TileSegment::Close => self.close(from),
        }
    }

    /// Goes back to where the piece began.
    fn close(&mut self, from: DVec2) {
        let begin = self.begin;
        let goes_back = from.distance(begin) > CLOSE;
        if goes_back {
            self.follow(1, &|t| from.lerp(begin, t));
        }
        self.at = begin;
        let is_whole = self.is_area || !self.is_torn;
        if let Some(line) = self.lines.last_mut().filter(|_| is_whole) {
            // The first point is not repeated.
            if goes_back && line.points.len() > 1 && !self.is_torn {
                line.points.pop();
            }
            line.closed = true;
        }
    }

    /// The place of a point of the tile; it is looked for from the last place.
    fn end(&mut self, at: f64, tile: DVec2) -> TracedEnd {
        let (st, is_found) = self.cells.place(tile + self.by, self.st);
        if is_found {
            self.st = st;
            self.reaches |= self.cells.lattice.cell_at(st).is_some_and(|cell| self.cells.is_mine[cell]);
        }
        TracedEnd { at, st, px: self.cells.face.px(st), is_found }
    }

    /// Adds the points of a segment, which runs over t in [0, 1], in so many parts at least.
    fn follow(&mut self, parts: u32, segment: &dyn Fn(f64) -> DVec2) {
        let mut last = self.end(0.0, segment(0.0));
        for part in 1..=parts {
            let at = f64::from(part) / f64::from(parts);
            let next = self.end(at, segment(at));
            self.divide(segment, last, next, 0);
            last = next;
        }
        if last.is_found {
            self.st = last.st;
        }
        self.at = segment(1.0);
    }

    /// Adds the points after `a` up to `b`, until what is between them is straight.
    fn divide(&mut self, segment: &dyn Fn(f64) -> DVec2, a: TracedEnd, b: TracedEnd, depth: u32) {
        let at = 0.5 * (a.at + b.at);
        self.st = if a.is_found { a.st } else { b.st };
        let middle = self.end(at, segment(at));
        let all_found = a.is_found && middle.is_found && b.is_found;
        let off = middle.px.distance(0.5 * (a.px + b.px));
        let is_straight = all_found && off <= self.cells.face.tolerance_px;
        let is_lost = !(a.is_found || middle.is_found || b.is_found);
        if depth < DEEPEST && !is_straight && !is_lost {
            self.divide(segment, a, middle, depth + 1);
            self.divide(segment, middle, b, depth + 1);
        } else if is_straight || (all_found && a.px.distance(b.px) < TORN_PX) {
            self.reaches = self.reaches || [[a, middle], [middle, b]].iter().any(|ends| self.cells.are_passed(ends));
            self.push(b);
        } else {
            self.is_torn = true;
            self.is_drawing &= self.is_area;
            if b.is_found {
                self.push(b);
            }
        }
    }

    fn push(&mut self, end: TracedEnd) {
        match self.lines.last_mut().filter(|_| self.is_drawing) {
            Some(line) => line.points.push(end.px),
            None => self.lines.push(Polyline { points: vec![end.px], closed: false }),
        }
        self.is_drawing = true;
    }
}
