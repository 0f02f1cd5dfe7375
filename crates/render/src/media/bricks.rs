//! Empty-space skipping: which bricks are visible, and how far the nearest visible brick is.
//!
//! A brick is visible for a medium if the medium's function has an opacity somewhere in the range of the
//! volume's samples in the brick, *and* some layer that may be in the brick is not transparent. It is visible
//! for a horizon if a sample close enough to the horizon belongs to one of its leaves. Every brick stores the
//! distance to the nearest visible brick, in bricks and by the largest axis, up to [`FARTHEST`]; a ray may
//! skip to the border of that cube of bricks. This distance transform replaces an octree: every skip takes a
//! single lookup.
//!
//! Voxel space of the survey; brick (bx, by, bz) spans [8·bx, 8·bx + 8] along x, and so on. Each brick is one
//! 32-bit word: the distance for the surroundings in bits 0–7, for the cut-outs in bits 8–15, and in bits
//! 16–23 the layer if the brick lies in a single one, else `MIXED`.

use super::preparation::BRICK;
use super::{LayerOpacity, Medium, MediumColour};
use crate::ground::air_layer;
use glam::Vec3;
use model::StructuralModel;
use rayon::prelude::*;
use ttf::{TtfTables, linear_from_srgb};

/// Largest distance stored, bricks.
pub const FARTHEST: u8 = 15;
/// Stands for several layers, or an unknown layer.
pub(crate) const MIXED: u8 = 255;

/// The content of a brick, before distances are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BrickContent {
    /// Whether the brick is visible in the surroundings, and in the cut-outs.
    pub shows: [bool; 2],
    /// The layer if there is a single one, else `MIXED`.
    pub layer: u8,
}

/// The bricks of a survey.
#[derive(Debug, Clone, PartialEq)]
pub struct Bricks {
    /// Number of bricks along each axis.
    pub size: [usize; 3],
    /// Words of the bricks, `[x][y][z]`.
    pub words: Vec<u32>,
}

impl Bricks {
    /// The bricks of a survey with these numbers of samples; `content` gives the content of the brick at an
    /// index along each axis.
    pub fn new(samples: [usize; 3], content: impl Fn([usize; 3]) -> BrickContent + Sync) -> Self {
        let size = samples.map(|n| n.saturating_sub(1).div_ceil(BRICK).max(1));
        let contents: Vec<BrickContent> = (0..size.iter().product::<usize>())
            .into_par_iter()
            .map(|n| content([n / (size[1] * size[2]), n / size[2] % size[1], n % size[2]]))
            .collect();
        let distances = [0, 1].map(|place| distances(size, contents.iter().map(|c| c.shows[place]).collect()));
        let words = contents
            .iter()
            .enumerate()
            .map(|(n, c)| u32::from(distances[0][n]) | u32::from(distances[1][n]) << 8 | u32::from(c.layer) << 16)
            .collect();
        Self { size, words }
    }

    /// The brick that contains a voxel position.
    #[inline(always)]
    pub fn at(&self, p: Vec3) -> [i32; 3] {
        let along = |v: f32, axis: usize| ((v * (1.0 / BRICK as f32)) as i32).clamp(0, self.size[axis] as i32 - 1);
        [along(p.x, 0), along(p.y, 1), along(p.z, 2)]
    }

    /// The word of a brick.
    #[inline(always)]
    pub fn word(&self, [x, y, z]: [i32; 3]) -> u32 {
        self.words[(x as usize * self.size[1] + y as usize) * self.size[2] + z as usize]
    }

    /// The first sample of a line, at or after number `n`, that lies in a visible brick of the surroundings
    /// (`shift` 0) or of the cut-outs (`shift` 8); `end` if there is none.
    #[inline(always)]
    pub(crate) fn first_shown(&self, line: &SampleLine, mut n: u32, end: u32, shift: u32) -> u32 {
        while n < end {
            let brick = self.at(line.at + line.per * n as f32);
            let distance = (self.word(brick) >> shift & 255) as i32;
            if distance == 0 {
                return n;
            }
            n = line.leaves(brick, distance - 1).max(n + 1);
        }
        end
    }

    /// Voxel positions of the smallest and largest corner of a brick.
    pub fn corners(brick: [usize; 3]) -> [Vec3; 2] {
        let low = Vec3::from_array(brick.map(|n| (n * BRICK) as f32));
        [low, low + BRICK as f32]
    }
}

/// Evenly spaced samples on a straight line, voxels.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SampleLine {
    /// The first sample.
    pub at: Vec3,
    /// The offset from one sample to the next.
    pub per: Vec3,
    inverse: Vec3,
}

impl SampleLine {
    /// A line from its first sample and the offset to the next.
    pub(crate) fn new(at: Vec3, per: Vec3) -> Self {
        Self { at, per, inverse: per.recip() }
    }

    /// Number of the first sample behind a brick that is grown by `around` bricks on every side.
    #[inline(always)]
    fn leaves(&self, [x, y, z]: [i32; 3], around: i32) -> u32 {
        let along = |first: i32, at: f32, per: f32, inverse: f32| {
            let border = if per > 0.0 { first + 1 + around } else { first - around };
            let places = ((border * BRICK as i32) as f32 - at) * inverse;
            // A negative number or NaN means that the line is parallel to the border or leaves it behind.
            if places >= 0.0 { places } else { f32::MAX }
        };
        let (at, per, inverse) = (self.at, self.per, self.inverse);
        let (x, y) = (along(x, at.x, per.x, inverse.x), along(y, at.y, per.y, inverse.y));
        (x.min(y).min(along(z, at.z, per.z, inverse.z)) as u32).saturating_add(1)
    }
}

/// Distance to the nearest marked brick by the largest axis.
fn distances(size: [usize; 3], marked: Vec<bool>) -> Vec<u8> {
    let mut field: Vec<u8> = marked.into_iter().map(|m| if m { 0 } else { FARTHEST }).collect();
    // Growing the marked set by one brick is separable: along each axis, a brick next to one of the set joins
    // it.
    for reached in 1..FARTHEST {
        let before = field.clone();
        let mut grown: Vec<bool> = before.iter().map(|d| *d < reached).collect();
        for axis in 0..3 {
            let stride = [size[1] * size[2], size[2], 1][axis];
            let source = grown.clone();
            for (n, to) in grown.iter_mut().enumerate() {
                let along = n / stride % size[axis];
                *to |= along > 0 && source[n - stride] || along + 1 < size[axis] && source[n + stride];
            }
        }
        let mut changed = false;
        for (d, inside) in field.iter_mut().zip(grown) {
            if inside && *d == FARTHEST {
                *d = reached;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    field
}

/// The layer of each brick, found without a lookup of every voxel in the model.
#[derive(Debug)]
pub(crate) struct LayerMap {
    size: [usize; 3],
    layers: Vec<u8>,
}

/// Number of columns along a side of a brick at which sheets are evaluated.
const ASKED: usize = 5;
/// Largest ratio by which the offset from a fault may grow faster than distance.
const FAULT_SLOPE: f64 = 1.25;
/// Largest deviation of a sheet from straight lines between two of these columns, voxels.
const BEND: f32 = 0.75;

impl LayerMap {
    /// The layers of a model: a brick lies in a single layer if it lies in a single block (no fault is within
    /// reach) and no sheet of that block crosses it.
    pub(crate) fn new(model: &StructuralModel) -> Self {
        let size = model.size().map(|n| n.saturating_sub(1).div_ceil(BRICK).max(1));
        let metric = model.metric();
        let half_diagonal_m = (metric * glam::DVec3::splat(BRICK as f64 * 0.5)).length();
        let radius_m = (half_diagonal_m * FAULT_SLOPE) as f32;
        let layers = (0..size[0] * size[1])
            .into_par_iter()
            .flat_map_iter(|column| {
                let [bx, by] = [column / size[1], column % size[1]];
                let spans = sheet_spans(model, [bx, by]);
                (0..size[2])
                    .map(move |bz| {
                        let [low, high] = Bricks::corners([bx, by, bz]);
                        let middle = (low + high) * 0.5;
                        let faults = model.faults();
                        if (0..faults.surfaces().len()).any(|f| faults.side(f, middle).abs() < radius_m) {
                            return MIXED;
                        }
                        let block = usize::from(model.block_at(middle));
                        let crossed = spans[block].iter().enumerate().any(|(horizon, [top, base])| {
                            match model.level(horizon, block as u16) {
                                Some(level) => level.may_cross(low, high),
                                None => *top < high.z && *base > low.z,
                            }
                        });
                        if crossed {
                            return MIXED;
                        }
                        u8::try_from(model.layer_at(middle, block as u16)).unwrap_or(MIXED)
                    })
                    .collect::<Vec<_>>()
            })
            .collect();
        Self { size, layers }
    }

    /// The layer of a brick, or [`MIXED`].
    pub(crate) fn layer(&self, [x, y, z]: [usize; 3]) -> u8 {
        self.layers[(x * self.size[1] + y) * self.size[2] + z]
    }
}

/// Shallowest and deepest voxel z of every sheet over a column of bricks, `[block][horizon]`.
fn sheet_spans(model: &StructuralModel, [bx, by]: [usize; 2]) -> Vec<Vec<[f32; 2]>> {
    let step = BRICK as f32 / (ASKED - 1) as f32;
    let spans = |block: usize, horizon: usize| {
        let sheet = model.sheet(horizon, block as u16);
        let mut span = [f32::MAX, f32::MIN];
        for n in 0..ASKED * ASKED {
            let x = (bx * BRICK) as f32 + (n / ASKED) as f32 * step;
            let y = (by * BRICK) as f32 + (n % ASKED) as f32 * step;
            let z = sheet.z_at(x, y);
            span = [span[0].min(z), span[1].max(z)];
        }
        [span[0] - BEND, span[1] + BEND]
    };
    let horizons = model.stratigraphy().horizons.len();
    (0..model.block_count()).map(|block| (0..horizons).map(|h| spans(block, h)).collect()).collect()
}

/// How layers change the appearance of a medium, bottom to top.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerAppearance {
    /// Linear colour, and the factor on the opacity.
    pub entries: Vec<[f32; 4]>,
    /// Whether the colour replaces that of the medium.
    pub colours: bool,
    /// Colours of the parts of layers that are divided by depth, for each layer; empty for others. Where no part is, the
    /// colour is that of the entry.
    pub shades: Vec<Vec<Shade>>,
}

/// The linear colour of a part of a layer, from one k up to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shade {
    /// Smallest k, and the k from which on it is not.
    pub k: [f32; 2],
    /// Linear colour.
    pub colour: [f32; 3],
}

impl LayerAppearance {
    /// The appearance that a medium takes from the layer styles. The air above a visible ground is
    /// transparent. `None` if layers do not change the medium.
    pub fn new(
        medium: &Medium,
        tables: &TtfTables,
        model: Option<&StructuralModel>,
        ground_is_shown: bool,
    ) -> Option<Self> {
        let model = model?;
        let colours = medium.colour == MediumColour::Layers;
        let shades: Vec<Vec<Shade>> =
            (0..model.layer_count()).map(|layer| if colours { shades(tables, layer) } else { Vec::new() }).collect();
        let entry = |layer: usize| {
            let style = tables.layers.get(layer)?;
            let undivided = tables.average_colour(layer as u32, 0.5);
            let [r, g, b] = match shades[layer].is_empty() {
                true => undivided,
                false => [style.colour[0], style.colour[1], style.colour[2]],
            }
            .map(linear_from_srgb);
            let opacity = if medium.layers == LayerOpacity::Followed { style.colour[3] } else { 1.0 };
            Some([r, g, b, opacity])
        };
        let mut entries: Vec<[f32; 4]> =
            (0..model.layer_count()).map(|layer| entry(layer).unwrap_or([1.0; 4])).collect();
        if ground_is_shown && let Some(air) = entries.get_mut(usize::from(air_layer(model))) {
            air[3] = 0.0;
        }
        (colours || entries.iter().any(|entry| entry[3] != 1.0)).then_some(Self { entries, colours, shades })
    }

    /// The colour of a layer at a local k.
    #[inline]
    pub fn colour(&self, layer: usize, k: f32) -> [f32; 3] {
        let shade = self.shades[layer].iter().find(|shade| k >= shade.k[0] && k < shade.k[1]);
        let [r, g, b, _] = self.entries[layer];
        shade.map_or([r, g, b], |shade| shade.colour)
    }
}

/// The colours of the parts of a layer; none if it is not divided.
fn shades(tables: &TtfTables, layer: usize) -> Vec<Shade> {
    let Some(style) = tables.layers.get(layer) else { return Vec::new() };
    let first = style.first_interval as usize;
    let intervals = &tables.intervals[first..first + style.interval_count as usize];
    let is_whole = |interval: &ttf::tables::IntervalEntry| interval.k == [f32::MIN, f32::MAX];
    if intervals.iter().all(is_whole) {
        return Vec::new();
    }
    // Inside an interval one colour holds; its lower end belongs to it.
    let shade = |k: [f32; 2]| Shade { k, colour: tables.average_colour(layer as u32, k[0]).map(linear_from_srgb) };
    intervals.iter().map(|interval| shade(interval.k)).collect()
}

#[cfg(test)]
mod tests;
