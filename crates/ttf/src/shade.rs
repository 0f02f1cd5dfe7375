//! The colour of a point on a cut face. This is the CPU reference of the shader `shade.wgsl`.
//!
//! Step by step (P-illus 4, figure 7), all on sRGB-encoded values:
//! 1. The layer's colour, or that of its interval at k: `c`.
//! 2. The interval's texture sample T (premultiplied, with its ink colour): `c ← T·o + c·(1 − T.a·o)`, where
//!    o is its opacity.
//! 3. For each scalar interval that contains the value of its volume, in stack order: T is the texture sample
//!    over its background, composited the same way. Its frequency is that of the layer at this point times
//!    its factor.
//! 4. The raw colour: `c ← c + (raw − c)·blend`.
//!
//! A texture sample is the weighted sum over the face's mappings ([`crate::FaceFrame`]).
//!
//! NaN stands for missing values. Without k or (i, j) the layer has its plain colour. A missing scalar value
//! lies in no interval. A missing raw value takes the no-data colour, or leaves the illustration unchanged if
//! there is none.

use crate::coordinates::{FaceFrame, MappingWeights};
use crate::tables::{FINER, NONE, TtfGlobals, TtfTables};

/// A point of a face in flat space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerPoint {
    /// Along x: 0 to 1 over the block. May lie outside that range near the side faces.
    pub i: f32,
    /// Along y: 0 to 1 over the block. May lie outside that range near the side faces.
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

/// What [`shade`] needs to know about a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadePoint {
    /// Where it is in flat space.
    pub flat: LayerPoint,
    /// How flat space changes around it.
    pub footprint: FlatFootprint,
    /// The face it lies on.
    pub face: FaceFrame,
    /// How much of each mapping of the face is seen ([`FaceFrame::weights`]).
    pub weights: MappingWeights,
}

/// Straight RGBA of a point, sRGB-encoded. Alpha is 1 where the layer exists and 0 where it does not.
///
/// `scalars` holds one value per entry of [`TtfTables::volumes`]; a missing entry counts as no data.
///
/// ```
/// use ttf::{BlockExtent, Colour, FaceFrame, FlatFootprint, LayerExtent, LayerPoint, LayerStyle, MappingWeights};
/// use ttf::{ShadePoint, TextureLibrary, TransferFunctions, TtfTables};
/// let mut functions = TransferFunctions::default();
/// functions.layers.set(LayerStyle::plain("Salt", Colour::new(255, 0, 51)));
/// let layers = vec![LayerExtent { name: "Salt".into(), thickness_m: 200.0 }];
/// let block = BlockExtent { extent_i_m: 4000.0, extent_j_m: 2000.0, layers, metres_per_mm: 20.0 };
/// let tables = TtfTables::compile(&functions, &block, &TextureLibrary::builtin().unwrap()).unwrap();
/// let point = ShadePoint {
///     flat: LayerPoint { i: 0.5, j: 0.5, k: 0.5, layer: 0 },
///     footprint: FlatFootprint::default(),
///     face: FaceFrame::new([0.0, 1.0, 0.0]),
///     weights: MappingWeights::ALONG,
/// };
/// assert_eq!(ttf::shade(&tables, &point, &[]), [1.0, 0.0, 0.2, 1.0]);
/// ```
pub fn shade(tables: &TtfTables, point: &ShadePoint, scalars: &[f32]) -> [f32; 4] {
    let Some(layer) = tables.layers.get(point.flat.layer as usize) else {
        return [0.0; 4];
    };
    let value_of = |volume: u32| scalars.get(volume as usize).copied().unwrap_or(f32::NAN);
    let mut colour = [layer.colour[0], layer.colour[1], layer.colour[2]];
    let mut frequency = layer.frequency;
    let flat = [point.flat.i, point.flat.j, point.flat.k];
    if flat.iter().all(|part| part.is_finite()) {
        let sampler = TextureSampler::new(tables, point);
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

/// Blends an illustrated colour with the raw colour of `value` (step 4). NaN is no data.
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

/// The raw colour of a value that is not NaN: linear between the stops, clamped.
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

/// Replaces the colour of a premultiplied sample where `ink` says so.
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

/// The mappings of a point, from which any texture can be sampled at any frequency.
struct TextureSampler<'a> {
    tables: &'a TtfTables,
    weights: [f32; 3],
    /// Per mapping: uv at the point, its change to the right and down; before frequencies.
    coordinates: [[[f32; 2]; 3]; 3],
}

impl<'a> TextureSampler<'a> {
    fn new(tables: &'a TtfTables, point: &ShadePoint) -> Self {
        let flat = [point.flat.i, point.flat.j, point.flat.k];
        let FlatFootprint { dx, dy } = point.footprint;
        let coordinates = point
            .face
            .mappings(tables.globals.aspect_j)
            .map(|mapping| [mapping.place(flat), mapping.apply(dx), mapping.apply(dy)]);
        Self { tables, weights: point.weights.to_array(), coordinates }
    }

    /// A texture at a frequency, dissolved into the finer one as the tables say.
    fn sample(&self, texture: u32, frequency: [f32; 2]) -> [f32; 4] {
        let TtfGlobals { global_frequency, finer_share, .. } = self.tables.globals;
        let scaled = frequency.map(|part| part * global_frequency);
        let coarse = self.sample_at(texture, scaled);
        if finer_share <= 0.0 {
            return coarse;
        }
        let fine = self.sample_at(texture, scaled.map(|part| part * FINER));
        std::array::from_fn(|c| coarse[c] + finer_share * (fine[c] - coarse[c]))
    }

    fn sample_at(&self, texture: u32, [horizontal, vertical]: [f32; 2]) -> [f32; 4] {
        let texture = &self.tables.textures[texture as usize];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        BlockExtent, Colour, ColourMap, Frequency, LayerExtent, LayerStyle, LayerTtf, RawColour, RgbaFunction,
        ScalarInterval, ScalarTtf, TextureLibrary, TransferFunctions, TtfSettings,
    };

    /// A library with two user tiles: `red` opaque, and `stripes`: black left half, nothing in the right.
    fn library() -> TextureLibrary {
        let folder = tempfile::tempdir().unwrap();
        let mut library = TextureLibrary::builtin().unwrap();
        for (name, pixel) in [
            ("red", (|_, _| image::Rgba([255, 0, 0, 255])) as fn(u32, u32) -> image::Rgba<u8>),
            ("stripes", |x, _| image::Rgba([0, 0, 0, if x < 256 { 255 } else { 0 }])),
        ] {
            let path = folder.path().join(format!("{name}.png"));
            image::RgbaImage::from_fn(512, 512, pixel).save(&path).unwrap();
            library.add_user(&path).unwrap();
        }
        library
    }

    fn block() -> BlockExtent {
        let layer = |name: &str| LayerExtent { name: name.to_owned(), thickness_m: 100.0 };
        BlockExtent {
            extent_i_m: 1000.0,
            extent_j_m: 2000.0,
            layers: vec![layer("A"), layer("B")],
            metres_per_mm: 10.0,
        }
    }

    fn functions() -> TransferFunctions {
        let mut a = LayerStyle::textured("A", Colour::WHITE, "stripes");
        a.frequency = Some(Frequency { horizontal: 4.0, vertical: 1.0 });
        TransferFunctions {
            layers: LayerTtf { styles: vec![a, LayerStyle::plain("B", Colour::new(0, 0, 255))] },
            ..TransferFunctions::default()
        }
    }

    fn at(i: f32, k: f32, layer: u32) -> ShadePoint {
        ShadePoint {
            flat: LayerPoint { i, j: 0.1, k, layer },
            footprint: FlatFootprint::default(),
            face: FaceFrame::new([0.0, 1.0, 0.0]),
            weights: MappingWeights::ALONG,
        }
    }

    fn scalar(volume: &str, range: [f32; 2], texture: &str, opacity: f32) -> ScalarTtf {
        let interval =
            ScalarInterval { range, texture: texture.to_owned(), factor: [1.0, 1.0], opacity, colour: None, ink: None };
        ScalarTtf { volume: volume.to_owned(), intervals: vec![interval] }
    }

    fn colour(functions: &TransferFunctions, point: &ShadePoint, scalars: &[f32]) -> [f32; 3] {
        let tables = TtfTables::compile(functions, &block(), &library()).unwrap();
        let [r, g, b, alpha] = shade(&tables, point, scalars);
        assert_eq!(alpha, 1.0);
        [r, g, b]
    }

    #[test]
    fn the_layers_texture_lies_at_its_frequency_on_its_colour() {
        let functions = functions();
        // Four repeats over i: black in the first half of each quarter.
        for (i, expected) in [(0.06, 0.0), (0.19, 1.0), (0.31, 0.0), (0.94, 1.0)] {
            assert_eq!(colour(&functions, &at(i, 0.5, 0), &[]), [expected; 3], "{i}");
        }
        assert_eq!(colour(&functions, &at(0.06, 0.5, 1), &[]), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn one_pattern_has_one_size_on_both_pairs_of_faces() {
        // j is twice as long as i, so the tile repeats eight times over it.
        let mut point = at(0.06, 0.5, 0);
        point.face = FaceFrame::new([1.0, 0.0, 0.0]);
        for (j, expected) in [(0.03, 0.0), (0.095, 1.0), (0.155, 0.0)] {
            point.flat.j = j;
            assert_eq!(colour(&functions(), &point, &[]), [expected; 3], "{j}");
        }
    }

    #[test]
    fn global_frequency_and_factors_multiply() {
        let mut functions = functions();
        functions.settings.global_frequency = 0.5;
        // Two repeats now: black up to 0.25.
        assert_eq!(colour(&functions, &at(0.19, 0.5, 0), &[]), [0.0; 3]);
        functions.scalars = vec![scalar("s", [0.0, 1.0], "stripes", 1.0)];
        functions.scalars[0].intervals[0].factor = [4.0, 1.0];
        functions.scalars[0].intervals[0].colour = Some(Colour::new(255, 0, 0));
        // Eight repeats of the scalar texture: black up to 1/16, its red ground after it.
        assert_eq!(colour(&functions, &at(0.03, 0.5, 0), &[0.5]), [0.0; 3]);
        assert_eq!(colour(&functions, &at(0.09, 0.5, 0), &[0.5]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn opacity_composites_in_closed_form() {
        for (opacity, expected) in [(0.0, [0.0, 0.0, 1.0]), (0.5, [0.5, 0.0, 0.5]), (1.0, [1.0, 0.0, 0.0])] {
            let mut functions = functions();
            functions.scalars = vec![scalar("s", [0.0, 1.0], "red", opacity)];
            assert_eq!(colour(&functions, &at(0.06, 0.5, 1), &[0.0]), expected);
        }
        let mut functions = functions();
        functions.layers.styles[0].intervals[0].opacity = 0.25;
        assert_eq!(colour(&functions, &at(0.06, 0.5, 0), &[]), [0.75; 3]);
    }

    #[test]
    fn the_stack_is_composited_in_order_and_no_data_passes_through() {
        let mut functions = functions();
        let mut green = scalar("second", [0.0, 1.0], "plain", 0.5);
        green.intervals[0].colour = Some(Colour::new(0, 255, 0));
        functions.scalars = vec![scalar("first", [0.0, 1.0], "red", 1.0), green.clone()];
        let point = at(0.06, 0.5, 1);
        assert_eq!(colour(&functions, &point, &[0.5, 0.5]), [0.5, 0.5, 0.0]);
        assert_eq!(colour(&functions, &point, &[0.5, f32::NAN]), [1.0, 0.0, 0.0]);
        assert_eq!(colour(&functions, &point, &[f32::NAN, 0.5]), [0.0, 0.5, 0.5]);
        assert_eq!(colour(&functions, &point, &[1.0, 1.0]), [0.0, 0.0, 1.0]);
        assert_eq!(colour(&functions, &point, &[]), [0.0, 0.0, 1.0]);
        functions.scalars.swap(0, 1);
        assert_eq!(colour(&functions, &point, &[0.5, 0.5]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn the_blend_runs_from_illustration_to_raw_colour() {
        let mut functions = functions();
        functions.raw = Some(RawColour::new("amplitude", RgbaFunction::centred(ColourMap::RedWhiteBlack, 2.0)));
        let point = at(0.06, 0.5, 1);
        let raw = functions.raw.as_ref().unwrap().function.evaluate(-1.5);
        for (blend, share) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0)] {
            functions.settings = TtfSettings { blend, ..TtfSettings::default() };
            let found = colour(&functions, &point, &[-1.5]);
            for (channel, illustration) in [0.0, 0.0, 1.0_f32].into_iter().enumerate() {
                let expected = illustration + (raw[channel] - illustration) * share;
                assert!((found[channel] - expected).abs() < 1e-6);
            }
        }
        let grey = functions.raw.as_ref().unwrap().no_data.unwrap().to_unit();
        assert_eq!(colour(&functions, &point, &[f32::NAN]), grey);
        functions.raw.as_mut().unwrap().no_data = None;
        assert_eq!(colour(&functions, &point, &[f32::NAN]), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn raw_colours_are_those_of_the_function_everywhere() {
        for map in ColourMap::ALL {
            let mut functions = functions();
            functions.settings.blend = 1.0;
            let mut function = RgbaFunction::over(map, [-3.0, 7.0]);
            let step = function.stops[1];
            function.stops.insert(1, crate::RgbaStop { colour: Colour::BLACK, ..step });
            functions.raw = Some(RawColour::new("amplitude", function.clone()));
            let tables = TtfTables::compile(&functions, &block(), &library()).unwrap();
            for step in -10..=130 {
                let value = -4.0 + step as f32 * 0.1;
                let found = shade(&tables, &at(0.0, 0.5, 1), &[value]);
                let expected = function.evaluate(value);
                assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-5), "{value}: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn without_coordinates_the_layer_is_plain_and_without_a_layer_there_is_nothing() {
        let functions = functions();
        assert_eq!(colour(&functions, &at(f32::NAN, 0.5, 0), &[]), [1.0; 3]);
        assert_eq!(colour(&functions, &at(0.06, f32::NAN, 0), &[]), [1.0; 3]);
        let tables = TtfTables::compile(&functions, &block(), &library()).unwrap();
        assert_eq!(shade(&tables, &at(0.06, 0.5, 2), &[]), [0.0; 4]);
    }

    #[test]
    fn ink_replaces_the_drawings_colours_and_the_ground_takes_the_average() {
        let mut functions = functions();
        functions.layers.styles[0].ink = Some(Colour::new(0, 255, 0));
        assert_eq!(colour(&functions, &at(0.06, 0.5, 0), &[]), [0.0, 1.0, 0.0]);
        let tables = TtfTables::compile(&functions, &block(), &library()).unwrap();
        assert_eq!(tables.average_colour(0, 1.0), [0.5, 1.0, 0.5]);
        assert_eq!(tables.average_colour(1, 1.0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_wide_footprint_shows_the_average() {
        let mut point = at(0.3, 0.5, 0);
        point.footprint = FlatFootprint { dx: [0.25, 0.0, 0.0], dy: [0.0, 0.0, 1.0] };
        let found = colour(&functions(), &point, &[]);
        assert!(found.iter().all(|channel| (channel - 0.5).abs() < 0.01), "{found:?}");
    }
}
