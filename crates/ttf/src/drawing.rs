//! A tile as paths: what a vector figure draws where a picture samples texels.
//!
//! Paths are in tile units: u runs right and v up over [0, 1], as in [`crate::Texture`]. A path that a tile repeats
//! on its opposite edge, so that it closes over the seam, is kept once: the next copy of the tile brings the other
//! half. Lines and areas in one colour each are all that the program's own patterns use. A drawing with anything else
//! (text, gradients, clips, groups seen through) has no [`TileDrawing`], and a figure paints its pixels.

use resvg::tiny_skia::{self, PathSegment};
use resvg::usvg::{self, FillRule, LineCap, Node, Paint};

use crate::TtfError;
use std::mem::discriminant;
use std::ops::Range;

/// Pieces of one tile, back to front.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TileDrawing {
    /// The pieces.
    pub shapes: Vec<TileShape>,
}

/// A line or an area of a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct TileShape {
    /// Where it runs.
    pub path: Vec<TileSegment>,
    /// How it is drawn.
    pub paint: TilePaint,
    /// Straight sRGB colour.
    pub colour: [f32; 3],
    /// 0 = clear … 1 = opaque.
    pub opacity: f32,
}

/// A step of a path, tile units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TileSegment {
    /// Begins a new piece.
    Move([f64; 2]),
    /// A straight line.
    Line([f64; 2]),
    /// A cubic Bézier curve: two control points and the end.
    Cubic([f64; 2], [f64; 2], [f64; 2]),
    /// Back to where the piece began.
    Close,
}

/// How a shape is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum TilePaint {
    /// Its inside, by the non-zero or the even-odd rule.
    Area {
        /// Whether the even-odd rule holds.
        even_odd: bool,
    },
    /// A line along it.
    Line {
        /// Width as a share of the tile's width.
        width: f64,
        /// Dashes and gaps in turn, as shares of the tile's width; none: solid.
        dashes: Vec<f64>,
        /// Whether ends are round.
        round: bool,
    },
}

/// Corners of two pieces closer than this are the same, tile units.
const SAME: f64 = 1e-3;

/// The drawing of an SVG tile; `None` if it holds what has no place here.
///
/// # Errors
/// [`TtfError::BadSvg`] and [`TtfError::RefusedSvg`] with the name given.
pub(crate) fn drawing_of(name: &str, svg: &str) -> Result<Option<TileDrawing>, TtfError> {
    let tree = crate::svg::parse(name, svg.as_bytes())?;
    let size = [f64::from(tree.size().width()), f64::from(tree.size().height())];
    let mut drawing = TileDrawing::default();
    let is_whole = gather(tree.root(), size, &mut drawing.shapes);
    Ok(is_whole.then_some(drawing))
}

/// Adds what a group holds; `false` if something has no place.
fn gather(group: &usvg::Group, size: [f64; 2], shapes: &mut Vec<TileShape>) -> bool {
    let is_plain = group.clip_path().is_none()
        && group.mask().is_none()
        && group.filters().is_empty()
        && group.opacity().get() >= 1.0
        && group.blend_mode() == usvg::BlendMode::Normal;
    is_plain
        && group.children().iter().all(|node| match node {
            Node::Group(inner) => gather(inner, size, shapes),
            Node::Path(path) => add(path, size, shapes),
            Node::Image(_) | Node::Text(_) => false,
        })
}

/// Adds the shapes of a path; `false` if they have no place.
fn add(path: &usvg::Path, size: [f64; 2], shapes: &mut Vec<TileShape>) -> bool {
    if !path.is_visible() {
        return true;
    }
    let transform = path.abs_transform();
    let pieces = pieces(path.data(), transform, size);
    let mut whole = true;
    let mut put = |paint: &Paint, opacity: f32, how: TilePaint, pieces: Vec<Vec<TileSegment>>| {
        let Paint::Color(colour) = paint else {
            whole = false;
            return;
        };
        let colour = [colour.red, colour.green, colour.blue].map(|channel| f32::from(channel) / 255.0);
        shapes.extend(once(pieces).into_iter().map(|path| TileShape { path, paint: how.clone(), colour, opacity }));
    };
    if let Some(fill) = path.fill() {
        let how = TilePaint::Area { even_odd: fill.rule() == FillRule::EvenOdd };
        put(fill.paint(), fill.opacity().get(), how, with_holes(pieces.clone()));
    }
    if let Some(stroke) = path.stroke() {
        // Tiles are not sheared; the mean of both scales is the scale of a width.
        let scale = f64::from((transform.sx * transform.sy - transform.kx * transform.ky).abs().sqrt()) / size[0];
        let how = TilePaint::Line {
            width: f64::from(stroke.width().get()) * scale,
            dashes: stroke.dasharray().unwrap_or_default().iter().map(|dash| f64::from(*dash) * scale).collect(),
            round: stroke.linecap() == LineCap::Round,
        };
        put(stroke.paint(), stroke.opacity().get(), how, pieces);
    }
    whole
}

/// The pieces of a path, each beginning with its own move, tile units.
fn pieces(path: &tiny_skia::Path, transform: tiny_skia::Transform, size: [f64; 2]) -> Vec<Vec<TileSegment>> {
    let Some(path) = path.clone().transform(transform) else { return Vec::new() };
    let place = |p: tiny_skia::Point| [f64::from(p.x) / size[0], 1.0 - f64::from(p.y) / size[1]];
    let mut pieces: Vec<Vec<TileSegment>> = Vec::new();
    let mut at = [0.0; 2];
    for segment in path.segments() {
        let step = match segment {
            PathSegment::MoveTo(p) => {
                at = place(p);
                pieces.push(vec![TileSegment::Move(at)]);
                continue;
            }
            PathSegment::LineTo(p) => TileSegment::Line(place(p)),
            PathSegment::QuadTo(control, p) => {
                // The same curve as a cubic one.
                let (control, end) = (place(control), place(p));
                let towards = |from: [f64; 2]| [0, 1].map(|n| from[n] + (control[n] - from[n]) * 2.0 / 3.0);
                TileSegment::Cubic(towards(at), towards(end), end)
            }
            PathSegment::CubicTo(a, b, p) => TileSegment::Cubic(place(a), place(b), place(p)),
            PathSegment::Close => TileSegment::Close,
        };
        if let Some(end) = step.end() {
            at = end;
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(step);
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

impl TileSegment {
    /// Where it ends; `None` of [`TileSegment::Close`], which ends where its piece began.
    pub fn end(&self) -> Option<[f64; 2]> {
        match self {
            Self::Move(p) | Self::Line(p) | Self::Cubic(_, _, p) => Some(*p),
            Self::Close => None,
        }
    }
}

impl TileDrawing {
    /// Shapes that follow one another and look alike, as ranges.
    pub fn alike(&self) -> Vec<Range<usize>> {
        let mut groups: Vec<Range<usize>> = Vec::new();
        for (n, shape) in self.shapes.iter().enumerate() {
            let same = |first: &TileShape| {
                (&first.paint, first.colour, first.opacity) == (&shape.paint, shape.colour, shape.opacity)
                    // Copies that lie over one another would cancel.
                    && shape.paint != TilePaint::Area { even_odd: true }
            };
            match groups.last_mut().filter(|group| same(&self.shapes[group.start])) {
                Some(group) => group.end = n + 1,
                None => groups.push(n..n + 1),
            }
        }
        groups
    }
}

impl TileShape {
    /// From end to end of its segments, in widths of a tile of this width by height.
    pub fn steps(&self, aspect: f64) -> Vec<[f64; 2]> {
        let mut steps = Vec::new();
        let mut at = [0.0; 2];
        for segment in &self.path {
            let (TileSegment::Move(to) | TileSegment::Line(to) | TileSegment::Cubic(_, _, to)) = segment else {
                continue;
            };
            if !matches!(segment, TileSegment::Move(_)) {
                steps.push([to[0] - at[0], (to[1] - at[1]) / aspect]);
            }
            at = *to;
        }
        steps
    }

    /// Smallest and largest corner of its points, control points included.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        bounds(&self.path)
    }

    /// Its lines one by one, such as the dashes of a row; an area is whole, since it may have holes.
    pub fn lines(&self) -> Vec<&[TileSegment]> {
        let begins = |segment: &&TileSegment| matches!(segment, TileSegment::Move(_));
        match self.paint {
            TilePaint::Area { .. } => vec![&self.path[..]],
            TilePaint::Line { .. } => self.path.chunk_by(|_, next| !begins(&next)).collect(),
        }
    }
}

/// Smallest and largest corner of a path's points, control points included.
pub fn bounds(path: &[TileSegment]) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for p in path.iter().flat_map(points) {
        for axis in 0..2 {
            bounds[0][axis] = bounds[0][axis].min(p[axis]);
            bounds[1][axis] = bounds[1][axis].max(p[axis]);
        }
    }
    bounds
}

/// Its points: up to three.
fn points(segment: &TileSegment) -> impl Iterator<Item = [f64; 2]> + use<> {
    let points = match *segment {
        TileSegment::Move(p) | TileSegment::Line(p) => [Some(p), None, None],
        TileSegment::Cubic(a, b, p) => [Some(a), Some(b), Some(p)],
        TileSegment::Close => [None; 3],
    };
    points.into_iter().flatten()
}

/// Joins pieces that lie inside another one with it: they are its holes.
fn with_holes(pieces: Vec<Vec<TileSegment>>) -> Vec<Vec<TileSegment>> {
    let mut areas: Vec<([[f64; 2]; 2], Vec<TileSegment>)> = Vec::new();
    for piece in pieces {
        let inner = bounds(&piece);
        let holds = |outer: &[[f64; 2]; 2]| (0..2).all(|n| outer[0][n] <= inner[0][n] && inner[1][n] <= outer[1][n]);
        match areas.iter_mut().find(|(outer, _)| holds(outer)) {
            Some((_, area)) => area.extend(piece),
            None => areas.push((inner, piece)),
        }
    }
    areas.into_iter().map(|(_, area)| area).collect()
}

/// Each piece once, moved by whole tiles so that its middle lies in [0, 1).
fn once(pieces: Vec<Vec<TileSegment>>) -> Vec<Vec<TileSegment>> {
    let mut kept: Vec<([f64; 2], Vec<TileSegment>)> = Vec::new();
    for piece in pieces {
        let [low, high] = bounds(&piece);
        let home = [0, 1].map(|n| -(0.5 * (low[n] + high[n]) + SAME).floor());
        let piece: Vec<TileSegment> = piece.iter().map(|segment| moved(segment, home)).collect();
        let low = bounds(&piece)[0];
        let again = kept.iter().any(|(corner, other)| {
            // Copies lie whole tiles apart.
            let by = [0, 1].map(|n| (low[n] - corner[n]).round());
            (0..2).all(|n| (low[n] - corner[n] - by[n]).abs() < SAME) && is_same(other, &piece, by)
        });
        if !again {
            kept.push((low, piece));
        }
    }
    kept.into_iter().map(|(_, piece)| piece).collect()
}

fn moved(segment: &TileSegment, by: [f64; 2]) -> TileSegment {
    let place = |p: [f64; 2]| [p[0] + by[0], p[1] + by[1]];
    match *segment {
        TileSegment::Move(p) => TileSegment::Move(place(p)),
        TileSegment::Line(p) => TileSegment::Line(place(p)),
        TileSegment::Cubic(a, b, p) => TileSegment::Cubic(place(a), place(b), place(p)),
        TileSegment::Close => TileSegment::Close,
    }
}

fn is_same(a: &[TileSegment], b: &[TileSegment], by: [f64; 2]) -> bool {
    let near = |(a, b): (&TileSegment, &TileSegment)| {
        let is_alike = discriminant(a) == discriminant(b);
        is_alike && points(&moved(a, by)).zip(points(b)).all(|(a, b)| (0..2).all(|n| (a[n] - b[n]).abs() < SAME))
    };
    a.len() == b.len() && a.iter().zip(b).all(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TextureLibrary;

    fn drawn(inside: &str) -> Option<TileDrawing> {
        let svg = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="30">{inside}</svg>"#);
        drawing_of("test", &svg).unwrap()
    }

    #[test]
    fn paths_are_in_tile_units_with_v_upwards() {
        let drawing = drawn(r##"<path fill="none" d="M0 30L30 15" stroke="#ff0000" stroke-width="6"/>"##).unwrap();
        let line = &drawing.shapes[0];
        assert_eq!(line.path, [TileSegment::Move([0.0, 0.0]), TileSegment::Line([0.5, 0.5])]);
        assert_eq!(line.colour, [1.0, 0.0, 0.0]);
        assert_eq!(line.paint, TilePaint::Line { width: 0.1, dashes: Vec::new(), round: false });
    }

    #[test]
    fn what_closes_over_an_edge_is_kept_once() {
        let twice = drawn(r#"<circle cx="0" cy="10" r="3"/><circle cx="60" cy="10" r="3"/>"#).unwrap();
        assert_eq!(twice.shapes.len(), 2, "two elements are two shapes");
        let one = drawn(r#"<path d="M-2 9L2 9L2 12Z M58 9L62 9L62 12Z M20 9L22 9L22 12Z"/>"#).unwrap();
        assert_eq!(one.shapes.len(), 2);
        for shape in &one.shapes {
            let [low, high] = shape.bounds();
            assert!((0.0..1.0).contains(&(0.5 * (low[0] + high[0]) + SAME)), "{low:?} {high:?}");
        }
    }

    #[test]
    fn a_hole_stays_with_its_area() {
        let ring = drawn(r#"<path fill-rule="evenodd" d="M10 5L30 5L30 25L10 25Z M15 10L25 10L25 20L15 20Z"/>"#);
        let ring = ring.unwrap();
        assert_eq!(ring.shapes.len(), 1);
        assert_eq!(ring.shapes[0].paint, TilePaint::Area { even_odd: true });
        let moves = ring.shapes[0].path.iter().filter(|step| matches!(step, TileSegment::Move(_))).count();
        assert_eq!(moves, 2);
    }

    #[test]
    fn gradients_and_glass_have_no_place() {
        let gradient = r##"<linearGradient id="g"><stop offset="0" stop-color="red"/><stop offset="1"/></linearGradient>
            <rect width="30" height="30" fill="url(#g)"/>"##;
        assert!(drawn(gradient).is_none());
        assert!(
            drawn(r#"<g opacity="0.5"><rect width="9" height="9"/><rect x="3" width="9" height="9"/></g>"#).is_none()
        );
    }

    #[test]
    fn every_pattern_of_the_program_has_a_drawing() {
        let library = TextureLibrary::builtin().unwrap();
        for index in 0..library.len() {
            let drawing = library.drawing(index).unwrap();
            let name = &library.pattern(index).name;
            let drawing = drawing.unwrap_or_else(|| panic!("{name} has no drawing"));
            assert_eq!(drawing.shapes.is_empty(), name == "plain", "{name}");
        }
    }
}
