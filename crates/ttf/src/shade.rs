//! The colour of a point on a cut face: the CPU reference of what the GPU computes.
//!
//! Step by step (P-illus 4, figure 7), all on sRGB-encoded values:
//! 1. The layer's colour, or that of its interval at k: `c`.
//! 2. The interval's texture sample T (premultiplied, inked): `c ← T·o + c·(1 − T.a·o)`, o its opacity.
//! 3. For each scalar interval that holds its volume's value, in stack order: its sample over its
//!    background, T, composited the same way. Its frequency is the layer's here times its factor.
//! 4. The raw colour: `c ← c + (raw − c)·blend`.
//!
//! A texture sample is the weighted sum over the face's mappings ([`crate::FaceFrame`]).
//! NaN: no k or no (i, j) leaves the plain colour; no scalar value lies in no interval; no raw value
//! takes the no-data colour, or leaves the illustration if there is none.

use crate::coordinates::FaceFrame;
use crate::tables::{NONE, TtfTables};

/// A point of a face in flat space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPoint {
    /// Along x; 0 to 1 over the block, beyond it near the walls.
    pub i: f32,
    /// Along y; 0 to 1 over the block, beyond it near the walls.
    pub j: f32,
    /// Local depth in the layer: 0 bottom horizon, 1 top horizon.
    pub k: f32,
    /// Layer number from the bottom.
    pub layer: u32,
}

/// How (i, j, k) change over one sample step on the image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlatFootprint {
    /// Change of (i, j, k) per step to the right.
    pub dx: [f32; 3],
    /// Change of (i, j, k) per step down.
    pub dy: [f32; 3],
}

/// Everything about a point that [`shade`] asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadePoint {
    /// Where it is in flat space.
    pub flat: FlatPoint,
    /// How flat space changes around it.
    pub footprint: FlatFootprint,
    /// The face it lies on.
    pub face: FaceFrame,
    /// Gradient of k in metric space (x, y, z down), any length.
    pub grad_k: [f32; 3],
}

/// Straight RGBA of a point, sRGB-encoded; alpha is 1 where the layer exists, 0 where there is none.
///
/// `scalars` holds one value per entry of [`TtfTables::volumes`]; missing ones count as no data.
pub fn shade(tables: &TtfTables, point: &ShadePoint, scalars: &[f32]) -> [f32; 4] {
    let Some(layer) = tables.layers.get(point.flat.layer as usize) else {
        return [0.0; 4];
    };
    let value_of = |volume: u32| scalars.get(volume as usize).copied().unwrap_or(f32::NAN);
    let mut colour = [layer.colour[0], layer.colour[1], layer.colour[2]];
    let mut frequency = layer.frequency;
    let flat = [point.flat.i, point.flat.j, point.flat.k];
    if flat.iter().all(|part| part.is_finite()) {
        let sampler = Sampler::new(tables, point);
        if let Some(interval) = tables.interval_at(layer, point.flat.k) {
            frequency = interval.frequency;
            colour = [interval.colour[0], interval.colour[1], interval.colour[2]];
            let ink = inked(sampler.sample(interval.texture, frequency), interval.ink);
            colour = over(colour, ink, interval.colour[3]);
        }
        for entry in &tables.scalars {
            let value = value_of(entry.volume);
            if value >= entry.range[0] && value < entry.range[1] {
                let scaled = [frequency[0] * entry.factor[0], frequency[1] * entry.factor[1]];
                let ink = inked(sampler.sample(entry.texture, scaled), entry.ink);
                colour = over(colour, on_background(ink, entry.colour), entry.opacity);
            }
        }
    }
    let colour = blend_raw(tables, colour, value_of(tables.globals.raw_volume));
    [colour[0], colour[1], colour[2], 1.0]
}

/// Blends an illustrated colour to the raw colour of `value` (step 4); NaN is no data.
pub fn blend_raw(tables: &TtfTables, colour: [f32; 3], value: f32) -> [f32; 3] {
    if tables.globals.raw_volume == NONE {
        return colour;
    }
    let blend = tables.globals.blend;
    let (raw, share) = if value.is_nan() {
        (tables.globals.no_data, tables.globals.no_data[3] * blend)
    } else {
        (raw_colour(tables, value), blend)
    };
    std::array::from_fn(|c| colour[c] + (raw[c] - colour[c]) * share)
}

/// The raw colours at a value that is not NaN: piecewise linear between the stops, clamped.
fn raw_colour(tables: &TtfTables, value: f32) -> [f32; 4] {
    let [low, high] = tables.globals.raw_domain;
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    let mut colour = tables.stops[0].colour;
    for pair in tables.stops.windows(2) {
        if t >= pair[0].at {
            let span = pair[1].at - pair[0].at;
            let fraction = if span > 0.0 { ((t - pair[0].at) / span).min(1.0) } else { 1.0 };
            colour = std::array::from_fn(|c| pair[0].colour[c] + (pair[1].colour[c] - pair[0].colour[c]) * fraction);
        }
    }
    colour
}

/// Recolours a premultiplied sample where `ink` asks for it.
fn inked(sample: [f32; 4], ink: [f32; 4]) -> [f32; 4] {
    let alpha = sample[3];
    let replaced = |c: usize| sample[c] + (ink[c] * alpha - sample[c]) * ink[3];
    [replaced(0), replaced(1), replaced(2), alpha]
}

/// A premultiplied sample over a background that is opaque (w = 1) or absent (w = 0).
fn on_background(sample: [f32; 4], background: [f32; 4]) -> [f32; 4] {
    let rest = (1.0 - sample[3]) * background[3];
    [
        sample[0] + background[0] * rest,
        sample[1] + background[1] * rest,
        sample[2] + background[2] * rest,
        sample[3] + rest,
    ]
}

/// A premultiplied colour at an opacity over an opaque one.
fn over(bottom: [f32; 3], top: [f32; 4], opacity: f32) -> [f32; 3] {
    std::array::from_fn(|c| top[c] * opacity + bottom[c] * (1.0 - top[3] * opacity))
}

/// The point's mappings, ready to sample any texture at any frequency.
struct Sampler<'a> {
    tables: &'a TtfTables,
    weights: [f32; 3],
    /// Per mapping: uv at the point, its change to the right and down; before frequencies.
    coordinates: [[[f32; 2]; 3]; 3],
}

impl<'a> Sampler<'a> {
    fn new(tables: &'a TtfTables, point: &ShadePoint) -> Self {
        let flat = [point.flat.i, point.flat.j, point.flat.k];
        let coordinates = point
            .face
            .mappings(tables.globals.aspect_j)
            .map(|mapping| [flat, point.footprint.dx, point.footprint.dy].map(|vector| mapping.apply(vector)));
        Self { tables, weights: point.face.weights(point.grad_k).to_array(), coordinates }
    }

    fn sample(&self, texture: u32, frequency: [f32; 2]) -> [f32; 4] {
        let texture = &self.tables.textures[texture as usize];
        let [horizontal, vertical] = frequency.map(|part| part * self.tables.globals.global_frequency);
        let scales = [[horizontal, vertical], [horizontal, vertical], [horizontal, horizontal]];
        let mut sum = [0.0; 4];
        for ((weight, coordinates), scale) in self.weights.iter().zip(&self.coordinates).zip(scales) {
            if *weight > 0.0 {
                let [uv, dx, dy] = coordinates.map(|pair| [pair[0] * scale[0], pair[1] * scale[1]]);
                let texel = texture.sample(uv, dx, dy);
                for channel in 0..4 {
                    sum[channel] += weight * texel[channel];
                }
            }
        }
        sum
    }
}
