//! A square tile of ink that wraps around: what crosses an edge is drawn again at the opposite edge.
//!
//! Unit: points at printed size (1 pt = 25.4/72 mm); x right, y **down** as in SVG.

use std::fmt::Write;

/// A point in the tile, in points.
pub(crate) type Point = [f32; 2];

/// Radius of a grain of sand.
pub(crate) const DOT: f32 = 0.45;
/// Width of the lines within a sign.
pub(crate) const THIN: f32 = 0.55;
/// Width of the lines that make a pattern: joints, bedding, outlines.
pub(crate) const LINE: f32 = 0.65;

/// The ink of all patterns: a warm black.
const INK: &str = "#231f1b";

/// Deterministic pseudo-random numbers (SplitMix64, Steele, Lea and Flood 2014).
pub(crate) struct Dice(u64);

impl Dice {
    /// A sequence of its own for each pattern.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// A number that is uniformly distributed in [low, high).
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * ((z >> 40) as f32 / (1_u64 << 24) as f32)
    }

    /// A uniformly distributed angle.
    pub(crate) fn turn(&mut self) -> f32 {
        self.between(0.0, std::f32::consts::TAU)
    }

    /// A number that is uniformly distributed in [−size, size).
    pub(crate) fn jitter(&mut self, size: f32) -> f32 {
        self.between(-size, size)
    }
}

enum Style {
    Stroke(f32),
    Fill,
}

struct Element {
    style: Style,
    /// The commands of the path, each with its points.
    commands: Vec<(char, Vec<Point>)>,
}

/// The drawing.
pub(crate) struct Tile {
    /// Side in points.
    pub side: f32,
    elements: Vec<Element>,
}

impl Tile {
    /// An empty tile.
    pub(crate) fn new(side: f32) -> Self {
        Self { side, elements: Vec::new() }
    }

    /// A straight stroke.
    pub(crate) fn line(&mut self, from: Point, to: Point, width: f32) {
        self.polyline(&[from, to], width);
    }

    /// Straight strokes through points.
    pub(crate) fn polyline(&mut self, points: &[Point], width: f32) {
        let mut commands = vec![('M', vec![points[0]])];
        commands.extend(points[1..].iter().map(|&point| ('L', vec![point])));
        self.elements.push(Element { style: Style::Stroke(width), commands });
    }

    /// A smooth stroke through points (Catmull–Rom).
    pub(crate) fn curve(&mut self, points: &[Point], width: f32) {
        let last = points.len() - 1;
        let at = |index: isize| points[index.clamp(0, last as isize) as usize];
        let mut commands = vec![('M', vec![points[0]])];
        for index in 0..last as isize {
            commands.push(spline(at(index - 1), at(index), at(index + 1), at(index + 2)));
        }
        self.elements.push(Element { style: Style::Stroke(width), commands });
    }

    /// A smooth closed outline through points.
    pub(crate) fn blob(&mut self, points: &[Point], width: f32) {
        let commands = closed_curve(points);
        self.elements.push(Element { style: Style::Stroke(width), commands });
    }

    /// A closed outline with corners.
    pub(crate) fn polygon(&mut self, points: &[Point], width: f32) {
        let mut commands = vec![('M', vec![points[0]])];
        commands.extend(points[1..].iter().map(|&point| ('L', vec![point])));
        commands.push(('Z', Vec::new()));
        self.elements.push(Element { style: Style::Stroke(width), commands });
    }

    /// A filled area with corners.
    pub(crate) fn filled_polygon(&mut self, points: &[Point]) {
        self.polygon(points, 0.0);
        if let Some(element) = self.elements.last_mut() {
            element.style = Style::Fill;
        }
    }

    /// A smooth filled area.
    pub(crate) fn filled_blob(&mut self, points: &[Point]) {
        self.elements.push(Element { style: Style::Fill, commands: closed_curve(points) });
    }

    /// A round dot: a stroke of no length with round ends.
    pub(crate) fn dot(&mut self, centre: Point, radius: f32) {
        let commands = vec![('M', vec![centre]), ('L', vec![centre])];
        self.elements.push(Element { style: Style::Stroke(2.0 * radius), commands });
    }

    /// An upright ellipse in outline.
    pub(crate) fn ellipse(&mut self, centre: Point, radii: [f32; 2], width: f32) {
        let commands = circle(centre, radii);
        self.elements.push(Element { style: Style::Stroke(width), commands });
    }

    /// An upright filled ellipse.
    pub(crate) fn filled_ellipse(&mut self, centre: Point, radii: [f32; 2]) {
        let commands = circle(centre, radii);
        self.elements.push(Element { style: Style::Fill, commands });
    }

    /// The shortest offset from one point to another, across the edges of the tile.
    pub(crate) fn offset(&self, from: Point, to: Point) -> Point {
        [to[0] - from[0], to[1] - from[1]].map(|part| part - (part / self.side).round() * self.side)
    }

    /// Distance of two points across the edges of the tile.
    pub(crate) fn distance(&self, a: Point, b: Point) -> f32 {
        let [x, y] = self.offset(a, b);
        x.hypot(y)
    }

    /// Poisson-disc points: at least `gap` apart, none closer than `clearance` to an obstacle (centre,
    /// radius), as many as 40 000 attempts place. Their density is even, without rows or gaps.
    pub(crate) fn scatter(&self, dice: &mut Dice, gap: f32, obstacles: &[(Point, f32)], clearance: f32) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        for _ in 0..40_000 {
            let candidate = [dice.between(0.0, self.side), dice.between(0.0, self.side)];
            let free = points.iter().all(|&point| self.distance(point, candidate) >= gap)
                && obstacles.iter().all(|&(centre, radius)| self.distance(centre, candidate) >= radius + clearance);
            if free {
                points.push(candidate);
            }
        }
        points
    }

    /// Discs of the given radii, largest first, at least `gap` apart. Each lies where a random attempt first
    /// finds room; a disc that finds none is left out.
    pub(crate) fn pack(&self, dice: &mut Dice, radii: &[f32], gap: f32) -> Vec<(Point, f32)> {
        let mut discs: Vec<(Point, f32)> = Vec::new();
        for &radius in radii {
            for _ in 0..4_000 {
                let centre = [dice.between(0.0, self.side), dice.between(0.0, self.side)];
                if discs.iter().all(|&(other, size)| self.distance(other, centre) >= size + radius + gap) {
                    discs.push((centre, radius));
                    break;
                }
            }
        }
        discs
    }

    /// The drawing as SVG. Elements that cross an edge are repeated at the opposite edge.
    pub(crate) fn to_svg(&self) -> String {
        let side = self.side;
        let mut groups: Vec<(String, String)> = Vec::new();
        for element in &self.elements {
            let (style, reach) = match element.style {
                Style::Fill => (format!("fill=\"{INK}\""), 0.0),
                Style::Stroke(width) => (
                    format!(
                        "fill=\"none\" stroke=\"{INK}\" stroke-width=\"{width}\" stroke-linecap=\"round\" stroke-linejoin=\"round\""
                    ),
                    width,
                ),
            };
            let data = self.wrapped(element, reach);
            match groups.iter_mut().find(|(present, _)| *present == style) {
                Some((_, path)) => path.push_str(&data),
                None => groups.push((style, data)),
            }
        }
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{side}pt\" height=\"{side}pt\" viewBox=\"0 0 {side} {side}\">\n"
        );
        for (style, path) in groups {
            let _ = writeln!(svg, "<path {style} d=\"{path}\"/>");
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// Path data of all copies of an element that touch the tile.
    fn wrapped(&self, element: &Element, reach: f32) -> String {
        let points = || element.commands.iter().flat_map(|(_, points)| points);
        let bound = |axis: usize| {
            points().fold((f32::MAX, f32::MIN), |(low, high), point| (low.min(point[axis]), high.max(point[axis])))
        };
        let shifts = |(low, high): (f32, f32)| {
            (-4..=4)
                .map(|step| step as f32 * self.side)
                .filter(move |shift| high + shift + reach > 0.0 && low + shift - reach < self.side)
                .collect::<Vec<f32>>()
        };
        let (across, down) = (shifts(bound(0)), shifts(bound(1)));
        let mut data = String::new();
        for dy in down {
            for dx in &across {
                for (command, points) in &element.commands {
                    data.push(*command);
                    for (index, point) in points.iter().enumerate() {
                        let gap = if index == 0 { "" } else { " " };
                        let _ = write!(data, "{gap}{} {}", short(point[0] + dx), short(point[1] + dy));
                    }
                }
                data.push('\n');
            }
        }
        data
    }
}

/// Two decimals are 0.004 mm: finer than any printer.
fn short(value: f32) -> f32 {
    (value * 100.0).round() / 100.0 + 0.0
}

fn spline(before: Point, from: Point, to: Point, after: Point) -> (char, Vec<Point>) {
    let handle = |a: Point, at: Point, b: Point, sign: f32| {
        [at[0] + sign * (b[0] - a[0]) / 6.0, at[1] + sign * (b[1] - a[1]) / 6.0]
    };
    ('C', vec![handle(before, from, to, 1.0), handle(from, to, after, -1.0), to])
}

fn closed_curve(points: &[Point]) -> Vec<(char, Vec<Point>)> {
    let count = points.len();
    let at = |index: usize| points[index % count];
    let mut commands = vec![('M', vec![points[0]])];
    for index in 0..count {
        commands.push(spline(at(index + count - 1), at(index), at(index + 1), at(index + 2)));
    }
    commands.push(('Z', Vec::new()));
    commands
}

fn circle([x, y]: Point, [a, b]: [f32; 2]) -> Vec<(char, Vec<Point>)> {
    // A cubic that approximates a quarter circle to 0.03 %.
    let (p, q) = (a * 0.552_285, b * 0.552_285);
    vec![
        ('M', vec![[x + a, y]]),
        ('C', vec![[x + a, y + q], [x + p, y + b], [x, y + b]]),
        ('C', vec![[x - p, y + b], [x - a, y + q], [x - a, y]]),
        ('C', vec![[x - a, y - q], [x - p, y - b], [x, y - b]]),
        ('C', vec![[x + p, y - b], [x + a, y - q], [x + a, y]]),
        ('Z', Vec::new()),
    ]
}

/// A point in polar form around a centre, with the y radius scaled by `flat`.
pub(crate) fn polar(centre: Point, radius: f32, angle: f32, flat: f32) -> Point {
    [centre[0] + radius * angle.cos(), centre[1] + radius * flat * angle.sin()]
}

/// A rounded, slightly irregular outline: a pebble. `tilt` turns its long axis.
pub(crate) fn pebble(dice: &mut Dice, centre: Point, radius: f32, flat: f32, tilt: f32) -> Vec<Point> {
    let phases = [dice.turn(), dice.turn()];
    let (sin, cos) = tilt.sin_cos();
    (0..9)
        .map(|step| {
            let angle = step as f32 * std::f32::consts::TAU / 9.0;
            let swell = 0.97 + 0.07 * (2.0 * angle + phases[0]).sin() + 0.06 * (3.0 * angle + phases[1]).sin();
            let [x, y] = polar([0.0, 0.0], radius * swell * 0.9, angle, flat);
            [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos]
        })
        .collect()
}

/// An angular fragment.
pub(crate) fn shard(dice: &mut Dice, centre: Point, radius: f32) -> Vec<Point> {
    let corners = [3, 4, 4, 5][dice.between(0.0, 4.0) as usize];
    let turn = dice.turn();
    let step = std::f32::consts::TAU / corners as f32;
    (0..corners)
        .map(|corner| {
            let angle = turn + corner as f32 * step + dice.jitter(step * 0.3);
            polar(centre, radius * dice.between(0.72, 1.0), angle, 1.0)
        })
        .collect()
}

/// The outline of a nodule of chert: a flattened ellipse with blunt ends.
pub(crate) fn nodule([x, y]: Point, [half, rise]: [f32; 2]) -> Vec<Point> {
    let at = |step: usize| {
        let (sin, cos) = (step as f32 * std::f32::consts::TAU / 14.0).sin_cos();
        [x + half * cos.signum() * cos.abs().powf(0.75), y + rise * sin.signum() * sin.abs().powf(0.65)]
    };
    (0..14).map(at).collect()
}

/// A valve of a shell: a crescent, `half` wide to each side. `up` is 1 for a hollow below, −1 for one above.
pub(crate) fn shell(centre: Point, half: f32, up: f32) -> Vec<Point> {
    let arc = |from: f32, to: f32, high: f32| {
        (0..16).map(move |step| {
            let angle = from + (to - from) * step as f32 / 16.0;
            [centre[0] + half * angle.cos(), centre[1] + up * (half * 0.4 - high * angle.sin())]
        })
    };
    let pi = std::f32::consts::PI;
    arc(0.0, pi, half * 0.86).chain(arc(pi, 0.0, half * 0.28)).collect()
}

/// Short lines across an outline at `angle` from the horizontal, `gap` apart, kept `inset` from its edge along them.
pub(crate) fn hatch(tile: &mut Tile, outline: &[Point], angle: f32, gap: f32, inset: f32, width: f32) {
    let (sin, cos) = angle.sin_cos();
    // Along the lines and across them.
    let turned: Vec<Point> = outline.iter().map(|p| [p[0] * cos + p[1] * sin, p[1] * cos - p[0] * sin]).collect();
    let (low, high) = turned.iter().fold((f32::MAX, f32::MIN), |(low, high), p| (low.min(p[1]), high.max(p[1])));
    let mut across = low + gap * 0.5;
    while across < high {
        let mut ends: Vec<f32> = Vec::new();
        for (index, &from) in turned.iter().enumerate() {
            let to = turned[(index + 1) % turned.len()];
            if (from[1] < across) != (to[1] < across) {
                ends.push(from[0] + (to[0] - from[0]) * (across - from[1]) / (to[1] - from[1]));
            }
        }
        ends.sort_by(f32::total_cmp);
        for pair in ends.chunks_exact(2) {
            let (start, end) = (pair[0] + inset, pair[1] - inset);
            if end > start {
                let back = |along: f32| [along * cos - across * sin, along * sin + across * cos];
                tile.line(back(start), back(end), width);
            }
        }
        across += gap;
    }
}

/// The places of signs in staggered rows: an even number of rows, each shifted by half a step against the one above.
pub(crate) fn staggered(side: f32, rows: usize, columns: usize) -> impl Iterator<Item = Point> {
    let (height, step) = (side / rows as f32, side / columns as f32);
    (0..rows).flat_map(move |row| {
        (0..columns)
            .map(move |column| [(column as f32 + 0.5 * (row % 2) as f32 + 0.25) * step, (row as f32 + 0.5) * height])
    })
}
