//! Transfer functions compiled to flat tables. The CPU reads them as slices, the GPU as buffers.
//!
//! All entries are `repr(C)`, have a size that is a multiple of 16 bytes and no implicit padding, so that
//! they are uploaded to storage buffers as they are. Colours are sRGB-encoded in [0, 1]. Texture indices are
//! slots of [`TtfTables::textures`], which holds only the textures in use.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::{
    Colour, Frequency, LayerStyle, LayerTtf, ScalarInterval, Texture, TextureLibrary, TransferFunctions, TtfError,
};

/// Stands for "no texture" or "no volume" in the tables.
pub const NONE: u32 = u32::MAX;

/// The layers and the sizes of the block, which scale the patterns.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockExtent {
    /// Length of the block along x in metres, (Nx − 1)·spacing: the length of i in [0, 1].
    pub extent_i_m: f32,
    /// Length of the block along y in metres.
    pub extent_j_m: f32,
    /// The layers, bottom to top: index = layer number.
    pub layers: Vec<LayerExtent>,
    /// Metres of rock per millimetre of the printed figure. Sizes the patterns that state no frequency.
    pub metres_per_mm: f32,
}

/// A layer's name and size.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerExtent {
    /// The layer's name in the stratigraphy.
    pub name: String,
    /// Mean thickness in metres: the length of k in [0, 1].
    pub thickness_m: f32,
}

/// The numbers that hold for the whole scene.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TtfGlobals {
    /// Colour of raw samples without data. Alpha 0: the illustration shows there.
    pub no_data: [f32; 4],
    /// Domain of the raw colours.
    pub raw_domain: [f32; 2],
    /// 0 illustrative … 1 raw.
    pub blend: f32,
    /// Factor on every frequency.
    pub global_frequency: f32,
    /// Extent of j divided by extent of i, in metres.
    pub aspect_j: f32,
    /// Slot of the raw volume, or [`NONE`].
    pub raw_volume: u32,
    /// Entries in the scalar table.
    pub scalar_count: u32,
    /// Entries in the stop table.
    pub stop_count: u32,
    /// Share of every pattern that is [`FINER`] times as dense, 0 to 1.
    pub finer_share: f32,
    /// Metres that i in [0, 1] stands for ([`BlockExtent::extent_i_m`]).
    pub extent_i_m: f32,
    /// The shader's struct is a multiple of 16 bytes.
    pub padding: [u32; 2],
}

/// How much denser the finer of two patterns is that are dissolved into one another: a quarter of an octave.
pub const FINER: f32 = 1.189_207_1;

/// A layer.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LayerEntry {
    /// Plain colour (r, g, b), and the opacity in a cut-out.
    pub colour: [f32; 4],
    /// Frequency where no interval covers k (scalar textures use it).
    pub frequency: [f32; 2],
    /// First entry in the interval table.
    pub first_interval: u32,
    /// Number of entries there.
    pub interval_count: u32,
    /// Metres that k in [0, 1] stands for ([`LayerExtent::thickness_m`]), as they are displayed.
    pub thickness_m: f32,
    /// 1: the frequency follows from the tile's printed size, 0: a style states it.
    pub is_sized: u32,
    /// Zero.
    pub padding: [u32; 2],
}

/// A depth interval of a layer.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct IntervalEntry {
    /// Background (r, g, b), and the opacity of the texture on it.
    pub colour: [f32; 4],
    /// Ink (r, g, b); w = 1: the ink replaces the texture's colours, w = 0: it does not.
    pub ink: [f32; 4],
    /// Half-open range of k. Ends on a horizon are moved to ±`f32::MAX`.
    pub k: [f32; 2],
    /// Horizontal and vertical frequency.
    pub frequency: [f32; 2],
    /// Texture slot.
    pub texture: u32,
    /// 1: the frequency follows from the tile's printed size, 0: a style states it.
    pub is_sized: u32,
    /// Zero.
    pub padding: [u32; 2],
}

/// A value interval of a scalar function.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ScalarEntry {
    /// Background (r, g, b); w = 1: opaque, 0: ink only.
    pub colour: [f32; 4],
    /// Ink (r, g, b); w = 1: the ink replaces the texture's colours, w = 0: it does not.
    pub ink: [f32; 4],
    /// Half-open range of values.
    pub range: [f32; 2],
    /// Factors on the layer's frequency.
    pub factor: [f32; 2],
    /// Texture slot.
    pub texture: u32,
    /// Volume slot.
    pub volume: u32,
    /// Opacity over what is below.
    pub opacity: f32,
    /// Zero.
    pub padding: u32,
}

/// A stop of the raw colours.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct StopEntry {
    /// Straight RGBA.
    pub colour: [f32; 4],
    /// Position in the domain, 0 to 1, rising.
    pub at: f32,
    /// Zero.
    pub padding: [f32; 3],
}

/// The compiled transfer functions.
///
/// ```
/// use ttf::{BlockExtent, Colour, LayerExtent, LayerStyle, TextureLibrary, TransferFunctions, TtfTables};
/// let mut functions = TransferFunctions::default();
/// functions.layers.set(LayerStyle::plain("Salt", Colour::new(255, 0, 51)));
/// let layers = vec![LayerExtent { name: "Salt".into(), thickness_m: 200.0 }];
/// let block = BlockExtent { extent_i_m: 4000.0, extent_j_m: 2000.0, layers, metres_per_mm: 20.0 };
/// let tables = TtfTables::compile(&functions, &block, &TextureLibrary::builtin().unwrap()).unwrap();
/// assert_eq!(tables.globals.aspect_j, 0.5);
/// assert_eq!(tables.average_colour(0, 1.0), [1.0, 0.0, 0.2]);
/// ```
#[derive(Debug, Clone)]
pub struct TtfTables {
    /// Numbers that hold for the whole scene.
    pub globals: TtfGlobals,
    /// One entry per layer, bottom to top.
    pub layers: Vec<LayerEntry>,
    /// Depth intervals. Those of one layer follow one another, rising in k.
    pub intervals: Vec<IntervalEntry>,
    /// Scalar intervals in the order in which they are composited.
    pub scalars: Vec<ScalarEntry>,
    /// Stops of the raw colours.
    pub stops: Vec<StopEntry>,
    /// Names of the volumes whose values [`crate::shade`] takes, by slot.
    pub volumes: Vec<String>,
    /// The textures in use, by slot: the layers of the GPU's texture array.
    pub textures: Vec<Arc<Texture>>,
    /// Their indices in the library.
    pub patterns: Vec<usize>,
    /// Own colours of the lines of faults, as they are printed ([`TransferFunctions::faults`]).
    pub faults: Vec<Option<Colour>>,
}

impl TtfTables {
    /// Compiles the functions for a block.
    ///
    /// A layer without a style gets [`LayerTtf::default_style`]. Styles of layers that the block does not
    /// have are ignored.
    ///
    /// # Errors
    /// Everything that [`TransferFunctions::validate`] refuses; extents that are not finite and positive; a
    /// pattern that cannot be rasterised.
    pub fn compile(
        functions: &TransferFunctions,
        block: &BlockExtent,
        library: &TextureLibrary,
    ) -> Result<Self, TtfError> {
        functions.validate(library)?;
        block.validate()?;
        let mut slots = Slots::new(library);
        let mut layers = Vec::with_capacity(block.layers.len());
        let mut intervals = Vec::new();
        for (index, layer) in block.layers.iter().enumerate() {
            let style = functions
                .layers
                .style(&layer.name)
                .cloned()
                .unwrap_or_else(|| LayerTtf::default_style(&layer.name, index, library));
            let style = functions.settings.preset.layer(&style);
            let first_interval = intervals.len() as u32;
            slots.add_intervals(&style, block, layer.thickness_m, &mut intervals)?;
            let [r, g, b] = style.colour.to_unit();
            let (frequency, is_sized) = block.frequency(style.frequency, layer.thickness_m, PLAIN_TILE_MM);
            layers.push(LayerEntry {
                colour: [r, g, b, style.opacity],
                frequency,
                first_interval,
                interval_count: intervals.len() as u32 - first_interval,
                thickness_m: layer.thickness_m,
                is_sized,
                padding: [0; 2],
            });
        }
        let mut scalars = Vec::new();
        for function in &functions.scalars {
            let volume = slots.volume(&function.volume);
            for interval in &function.intervals {
                scalars.push(slots.scalar(interval, volume)?);
            }
        }
        let (mut stops, mut raw_domain, mut raw_volume, mut no_data) = (Vec::new(), [0.0, 1.0], NONE, [0.0; 4]);
        if let Some(raw) = &functions.raw {
            raw_volume = slots.volume(&raw.volume);
            raw_domain = raw.function.domain;
            no_data = opaque_or_nothing(raw.no_data);
            stops.extend(raw.function.stops.iter().map(|stop| {
                let [r, g, b] = stop.colour.to_unit();
                StopEntry { colour: [r, g, b, stop.opacity], at: stop.at, padding: [0.0; 3] }
            }));
        }
        let globals = TtfGlobals {
            no_data,
            raw_domain,
            blend: functions.settings.blend,
            global_frequency: functions.settings.global_frequency,
            aspect_j: block.extent_j_m / block.extent_i_m,
            raw_volume,
            scalar_count: scalars.len() as u32,
            stop_count: stops.len() as u32,
            finer_share: 0.0,
            extent_i_m: block.extent_i_m,
            padding: [0; 2],
        };
        let Slots { volumes, textures, library_indices: patterns, .. } = slots;
        let preset = functions.settings.preset;
        let faults = functions.faults.iter().map(|own| own.map(|colour| preset.line(colour))).collect();
        Ok(Self { globals, layers, intervals, scalars, stops, volumes, textures, patterns, faults })
    }

    /// The tables for a block that is drawn this many times as high, in which tiles keep their proportions on level beds.
    /// Frequencies that styles state are kept.
    #[must_use]
    pub fn exaggerated(mut self, factor: f32) -> Self {
        for layer in &mut self.layers {
            layer.thickness_m *= factor;
            layer.frequency[1] *= if layer.is_sized == 1 { factor } else { 1.0 };
        }
        for interval in &mut self.intervals {
            interval.frequency[1] *= if interval.is_sized == 1 { factor } else { 1.0 };
        }
        self
    }

    /// The colour that a fault's lines were given; `None`: they are drawn as the scene's outlines say.
    pub fn fault_colour(&self, fault: Option<usize>) -> Option<Colour> {
        fault.and_then(|fault| self.faults.get(fault).copied().flatten())
    }

    /// The opaque average colour of a layer at local k, its texture included. The ground has the average
    /// colour of the layer below it at k = 1 (P-illus 5). Black if there is no such layer.
    pub fn average_colour(&self, layer: u32, k: f32) -> [f32; 3] {
        let Some(entry) = self.layers.get(layer as usize) else {
            return [0.0; 3];
        };
        match self.interval_at(entry, k) {
            None => [entry.colour[0], entry.colour[1], entry.colour[2]],
            Some(interval) => {
                let [r, g, b, opacity] = interval.colour;
                let background = [r, g, b];
                let ink = (interval.ink[3] > 0.5).then_some([interval.ink[0], interval.ink[1], interval.ink[2]]);
                let full = self.textures[interval.texture as usize].average_over(background, ink);
                std::array::from_fn(|c| background[c] + (full[c] - background[c]) * opacity)
            }
        }
    }

    /// The interval of a layer that covers k.
    pub(crate) fn interval_at(&self, layer: &LayerEntry, k: f32) -> Option<&IntervalEntry> {
        let first = layer.first_interval as usize;
        self.intervals[first..first + layer.interval_count as usize]
            .iter()
            .find(|interval| k >= interval.k[0] && k < interval.k[1])
    }
}

/// Tile size assumed for a layer without a texture: the usual size in the library.
const PLAIN_TILE_MM: [f32; 2] = [20.0, 20.0];

impl BlockExtent {
    /// The stated frequency, or that of a tile at its printed size; and 1 if it is the latter.
    fn frequency(&self, stated: Option<Frequency>, thickness_m: f32, tile_mm: [f32; 2]) -> ([f32; 2], u32) {
        let tile_m = tile_mm.map(|side| side * self.metres_per_mm);
        let frequency = stated.unwrap_or_else(|| Frequency::for_tile(self.extent_i_m, thickness_m, tile_m));
        ([frequency.horizontal, frequency.vertical], u32::from(stated.is_none()))
    }

    fn validate(&self) -> Result<(), TtfError> {
        let check = |quantity: &'static str, value: f32| {
            if value.is_finite() && value > 0.0 { Ok(()) } else { Err(TtfError::BadExtent { quantity, value }) }
        };
        check("the block's extent along x", self.extent_i_m)?;
        check("the block's extent along y", self.extent_j_m)?;
        check("the figure's scale (metres per millimetre)", self.metres_per_mm)?;
        self.layers.iter().try_for_each(|layer| check("a layer's mean thickness", layer.thickness_m))
    }
}

/// Assigns slots to textures and volumes in the order in which they are first needed.
struct Slots<'a> {
    library: &'a TextureLibrary,
    library_indices: Vec<usize>,
    textures: Vec<Arc<Texture>>,
    volumes: Vec<String>,
}

impl<'a> Slots<'a> {
    fn new(library: &'a TextureLibrary) -> Self {
        Self { library, library_indices: Vec::new(), textures: Vec::new(), volumes: Vec::new() }
    }

    fn texture(&mut self, index: usize) -> Result<u32, TtfError> {
        if let Some(slot) = self.library_indices.iter().position(|&present| present == index) {
            return Ok(slot as u32);
        }
        self.textures.push(self.library.texture(index)?);
        self.library_indices.push(index);
        Ok(self.textures.len() as u32 - 1)
    }

    fn volume(&mut self, name: &str) -> u32 {
        let slot = self.volumes.iter().position(|present| present == name).unwrap_or_else(|| {
            self.volumes.push(name.to_owned());
            self.volumes.len() - 1
        });
        slot as u32
    }

    fn add_intervals(
        &mut self,
        style: &LayerStyle,
        block: &BlockExtent,
        thickness_m: f32,
        intervals: &mut Vec<IntervalEntry>,
    ) -> Result<(), TtfError> {
        let mut sorted: Vec<_> = style.intervals.iter().collect();
        sorted.sort_by(|a, b| a.k[0].total_cmp(&b.k[0]));
        for interval in sorted {
            let index = self.library.index_of(&interval.texture, &style.layer)?;
            let tile_mm = self.library.pattern(index).tile_mm;
            let stated = interval.frequency.or(style.frequency);
            let (frequency, is_sized) = block.frequency(stated, thickness_m, tile_mm);
            let [r, g, b] = interval.colour.unwrap_or(style.colour).to_unit();
            let [low, high] = interval.k;
            intervals.push(IntervalEntry {
                colour: [r, g, b, interval.opacity],
                ink: opaque_or_nothing(style.ink),
                k: [if low <= 0.0 { f32::MIN } else { low }, if high >= 1.0 { f32::MAX } else { high }],
                frequency,
                texture: self.texture(index)?,
                is_sized,
                padding: [0; 2],
            });
        }
        Ok(())
    }

    fn scalar(&mut self, interval: &ScalarInterval, volume: u32) -> Result<ScalarEntry, TtfError> {
        let index = self.library.index_of(&interval.texture, "a scalar function")?;
        Ok(ScalarEntry {
            colour: opaque_or_nothing(interval.colour),
            ink: opaque_or_nothing(interval.ink),
            range: interval.range,
            factor: interval.factor,
            texture: self.texture(index)?,
            volume,
            opacity: interval.opacity,
            padding: 0,
        })
    }
}

fn opaque_or_nothing(colour: Option<Colour>) -> [f32; 4] {
    colour.map_or([0.0; 4], |colour| {
        let [r, g, b] = colour.to_unit();
        [r, g, b, 1.0]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Colour, ScalarTtf};

    fn block(names: &[&str]) -> BlockExtent {
        let layers = names.iter().map(|name| LayerExtent { name: (*name).to_owned(), thickness_m: 300.0 }).collect();
        BlockExtent { extent_i_m: 6000.0, extent_j_m: 3000.0, layers, metres_per_mm: 20.0 }
    }

    #[test]
    fn an_unstyled_project_compiles_with_patterns_of_printed_size() {
        let library = TextureLibrary::builtin().unwrap();
        let tables = TtfTables::compile(&TransferFunctions::default(), &block(&["Salt", "Chalk"]), &library).unwrap();
        assert_eq!(tables.layers.len(), 2);
        assert_eq!(tables.textures.len(), 2);
        assert_eq!(tables.globals.aspect_j, 0.5);
        let tile_m = library.pattern(library.find("salt").unwrap()).tile_mm[0] * 20.0;
        assert_eq!(tables.intervals[0].frequency, [6000.0 / tile_m, 300.0 / tile_m]);
        assert_eq!(tables.intervals[0].k, [f32::MIN, f32::MAX]);
    }

    #[test]
    fn intervals_are_sorted_and_textures_and_volumes_shared() {
        let library = TextureLibrary::builtin().unwrap();
        let mut functions = TransferFunctions::default();
        let mut style = LayerStyle::textured("A", Colour::WHITE, "sand");
        style.intervals[0].k = [0.5, 0.8];
        let mut lower = style.intervals[0].clone();
        lower.k = [0.0, 0.5];
        style.intervals.push(lower);
        functions.layers.set(style);
        let scalar: ScalarTtf =
            toml::from_str("volume = 'v'\nintervals = [{ range = [0.0, 1.0], texture = 'sand' }]").unwrap();
        functions.scalars = vec![scalar.clone(), scalar];
        let tables = TtfTables::compile(&functions, &block(&["A"]), &library).unwrap();
        assert_eq!(tables.intervals[0].k, [f32::MIN, 0.5]);
        assert_eq!(tables.intervals[1].k, [0.5, 0.8]);
        assert_eq!((tables.textures.len(), tables.volumes.len(), tables.scalars.len()), (1, 1, 2));
    }

    #[test]
    fn tiles_keep_their_proportions_in_exaggerated_blocks_unless_a_style_states_them() {
        let library = TextureLibrary::builtin().unwrap();
        let mut functions = TransferFunctions::default();
        let mut stated = LayerStyle::textured("B", Colour::WHITE, "sand");
        stated.frequency = Some(Frequency { horizontal: 4.0, vertical: 3.0 });
        functions.layers.set(stated);
        let tables = TtfTables::compile(&functions, &block(&["A", "B"]), &library).unwrap();
        let high = tables.clone().exaggerated(2.5);
        let [i, k] = tables.intervals[0].frequency;
        assert_eq!(high.intervals[0].frequency, [i, 2.5 * k]);
        assert_eq!(high.layers[0].frequency[1], 2.5 * tables.layers[0].frequency[1]);
        assert_eq!((high.intervals[1].frequency, high.layers[1].frequency), ([4.0, 3.0], [4.0, 3.0]));
        assert_eq!(high.layers.iter().map(|layer| layer.thickness_m).collect::<Vec<_>>(), [750.0; 2]);
    }

    #[test]
    fn bad_extents_and_bad_functions_are_refused() {
        let library = TextureLibrary::builtin().unwrap();
        let compile =
            |functions: &TransferFunctions, block: &BlockExtent| TtfTables::compile(functions, block, &library);
        let mut flat = block(&["A"]);
        flat.extent_j_m = 0.0;
        assert!(matches!(compile(&TransferFunctions::default(), &flat), Err(TtfError::BadExtent { .. })));
        let mut functions = TransferFunctions::default();
        functions.settings.blend = 2.0;
        assert!(matches!(compile(&functions, &block(&["A"])), Err(TtfError::OutsideUnit { .. })));
        functions.settings.blend = 0.0;
        functions.settings.global_frequency = f32::NAN;
        assert!(matches!(compile(&functions, &block(&["A"])), Err(TtfError::BadFrequency { .. })));
    }

    #[test]
    fn entries_are_laid_out_for_the_gpu() {
        assert_eq!(size_of::<TtfGlobals>(), 64);
        assert_eq!(size_of::<LayerEntry>(), 48);
        assert_eq!(size_of::<IntervalEntry>(), 64);
        assert_eq!(size_of::<ScalarEntry>(), 64);
        assert_eq!(size_of::<StopEntry>(), 32);
    }
}
