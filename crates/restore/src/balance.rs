//! What restoring changed: lengths and areas on a section, areas on the map.
//!
//! The section is the middle inline or crossline, whichever the heaves of the horizon cross more, or else the one on which it is
//! steeper. It ends where its ends came to lie, so that both sections hold the same rock. On it a horizon has a length and a layer
//! an area; what is continued to a fault counts. Areas on the map and of surfaces are those of the nodes that were interpreted.

use crate::restoration::Moves;
use crate::target::is_known;
use glam::DVec2;
use model::StructuralModel;
use model::section::{LineKind, Section, SectionPlane};
use serde::Serialize;
use survey::SurveyGeometry;

/// A quantity today and after restoring.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Span {
    /// Today.
    pub present: f64,
    /// Restored.
    pub restored: f64,
    /// The change from today's to the restored one, percent of today's; none of nothing.
    pub percent: Option<f64>,
}

impl Span {
    fn new(present: f64, restored: f64) -> Self {
        let percent = (present > 0.0).then(|| 100.0 * (restored / present - 1.0));
        Self { present, restored, percent }
    }
}

/// What became of a horizon.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonBalance {
    /// Its name.
    pub horizon: String,
    /// Length on the section, m.
    pub length_m: Span,
    /// Area on the map of what was interpreted, m².
    pub map_m2: Span,
    /// Area of the surface itself, m².
    pub surface_m2: Span,
}

/// What became of a layer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LayerBalance {
    /// Its name.
    pub layer: String,
    /// Area on the section, m².
    pub section_m2: Span,
}

/// What became of lengths and areas.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Balance {
    /// Where the section is: "inline" or "crossline".
    pub along: &'static str,
    /// The number of that line.
    pub line: f64,
    /// The horizons from the restored one down.
    pub horizons: Vec<HorizonBalance>,
    /// The layers below it that have a base, from the top down.
    pub layers: Vec<LayerBalance>,
}

/// How far above and below the survey the section reaches, in heights of it.
const BEYOND: f64 = 0.5;

/// Compares a model with its restored one, whose horizons are those of `kept`.
pub(crate) fn of(moves: &Moves<'_>, geometry: &SurveyGeometry, after: &StructuralModel, kept: &[usize]) -> Balance {
    let before = moves.model;
    let axis = section_axis(moves);
    let [nx, ny, nz] = before.size().map(|count| count as f64);
    let middle = if axis == 1 { (0.5 * (nx - 1.0)).round() } else { (0.5 * (ny - 1.0)).round() };
    let last = if axis == 1 { ny - 1.0 } else { nx - 1.0 };
    let map = |s: f64| if axis == 1 { DVec2::new(middle, s) } else { DVec2::new(s, middle) };
    // Where an end of the section comes to lie.
    let moved = |s: f64| {
        let at = map(s);
        let holds = |block: &u16| {
            let z = before.sheet(moves.target, *block).z_at(at.x as f32, at.y as f32);
            before.faults().holds(*block, at.extend(f64::from(z)).as_vec3())
        };
        let block = (0..before.block_count() as u16).find(holds).unwrap_or(0);
        s + moves.shift.at(block, at)[axis]
    };
    let cut = |model: &StructuralModel, [from, to]: [f64; 2]| {
        let low = map(from).extend(-BEYOND * nz);
        let high = map(to).extend((1.0 + BEYOND) * nz);
        let plane = if axis == 1 {
            SectionPlane::inline(middle, low, high)
        } else {
            SectionPlane::crossline(middle, low, high)
        };
        Measured::new(model, &Section::new(model, &plane))
    };
    let (now, then) = (cut(before, [0.0, last]), cut(after, [moved(0.0), moved(last)]));
    let horizons = kept.iter().enumerate().map(|(index, &h)| {
        let [map_m2, surface_m2] = surface(moves, h);
        HorizonBalance {
            horizon: before.stratigraphy().horizons[h].name.clone(),
            length_m: Span::new(now.lengths[h], then.lengths[index]),
            map_m2,
            surface_m2,
        }
    });
    let layer = |(index, &h): (usize, &usize)| {
        let [old, new] = [(before, h), (after, index)].map(|(model, top)| model.layer_count() - 2 - top);
        (new > 0).then(|| LayerBalance {
            layer: before.stratigraphy().layer_name(old),
            section_m2: Span::new(now.areas[old], then.areas[new]),
        })
    };
    let lines = geometry.lines_from_voxel(map(0.0));
    let (along, line) = if axis == 1 { ("inline", lines.x) } else { ("crossline", lines.y) };
    Balance { along, line, horizons: horizons.collect(), layers: kept.iter().enumerate().filter_map(layer).collect() }
}

/// Along which axis the section runs: 1 (y) on an inline.
fn section_axis(moves: &Moves<'_>) -> usize {
    let metric = moves.model.metric();
    let sides = [metric.x_axis.length(), metric.y_axis.length()];
    let heaves: DVec2 =
        moves.ties.iter().filter(|tie| tie.is_real).map(|tie| tie.apart().abs() * DVec2::from_array(sides)).sum();
    if heaves.max_element() > 0.0 {
        return usize::from(heaves.y > heaves.x);
    }
    let sheet = moves.model.sheet(moves.target, 0);
    let [nx, ny, _] = moves.model.size();
    let mut steep = DVec2::ZERO;
    for (x, y) in (0..nx.saturating_sub(1)).flat_map(|x| (0..ny.saturating_sub(1)).map(move |y| (x as i32, y as i32))) {
        let z = f64::from(sheet.node(x, y));
        steep.x += (f64::from(sheet.node(x + 1, y)) - z).abs() / sides[0];
        steep.y += (f64::from(sheet.node(x, y + 1)) - z).abs() / sides[1];
    }
    usize::from(steep.y > steep.x)
}

/// What a section shows.
struct Measured {
    /// Of each horizon, m.
    lengths: Vec<f64>,
    /// Of each layer, m².
    areas: Vec<f64>,
}

impl Measured {
    fn new(model: &StructuralModel, section: &Section) -> Self {
        let metric = model.metric();
        let [s, t] = [section.plane.s_axis, section.plane.t_axis].map(|axis| metric * axis);
        let mut measured =
            Self { lengths: vec![0.0; model.stratigraphy().horizons.len()], areas: vec![0.0; model.layer_count()] };
        for line in &section.lines {
            if let LineKind::Horizon { horizon } = line.kind {
                let length = |pair: &[DVec2]| (s * (pair[1].x - pair[0].x) + t * (pair[1].y - pair[0].y)).length();
                measured.lengths[horizon] += line.points.windows(2).map(length).sum::<f64>();
            }
        }
        let cell = s.cross(t).length();
        for polygon in &section.layers {
            let twice = |ring: &Vec<DVec2>| {
                let next = ring.iter().cycle().skip(1);
                ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
            };
            measured.areas[usize::from(polygon.layer)] += 0.5 * cell * polygon.rings.iter().map(twice).sum::<f64>();
        }
        measured
    }
}

/// The area of a horizon on the map and of its surface.
fn surface(moves: &Moves<'_>, horizon: usize) -> [Span; 2] {
    let model = moves.model;
    let metric = model.metric();
    let [nx, ny, _] = model.size();
    let cell = metric.x_axis.cross(metric.y_axis).length();
    let mut sums = [0.0; 4];
    for n in 0..nx * ny {
        let at = DVec2::new((n / ny) as f64, (n % ny) as f64);
        for block in 0..model.block_count() as u16 {
            if !is_known(model, horizon, block, at) {
                continue;
            }
            let now = |at: DVec2| f64::from(model.sheet(horizon, block).z_at(at.x as f32, at.y as f32));
            let then = |at: DVec2| now(at) - moves.sheets[usize::from(block)].z_at(at) + moves.plane.z_at(at);
            let tilted = |z: &dyn Fn(DVec2) -> f64| {
                let along = |axis: DVec2| metric * axis.extend(0.5 * (z(at + axis) - z(at - axis)));
                along(DVec2::X).cross(along(DVec2::Y)).length()
            };
            // A node on the side stands for half a cell.
            let half = |c: f64, count: usize| if c == 0.0 || c == count as f64 - 1.0 { 0.5 } else { 1.0 };
            let share = half(at.x, nx) * half(at.y, ny);
            let grown = 1.0 + moves.shift.dilation(block, at);
            sums[0] += share * cell;
            sums[1] += share * cell * grown;
            sums[2] += share * tilted(&now);
            sums[3] += share * tilted(&then) * grown;
        }
    }
    [Span::new(sums[0], sums[1]), Span::new(sums[2], sums[3])]
}
