//! GeoTIFF: a grid of heights, one band, as GDAL, QGIS and ArcGIS write it.
//!
//! Places are those of the tags ModelPixelScale and ModelTiepoint, or ModelTransformation; a pixel is an area, whose
//! place is its outer corner, or a point (GTRasterType). Values of GDAL_NODATA and tiles that are not there are holes;
//! scale, offset, name and unit of the band come from GDAL_METADATA. Neither the format nor, as a rule, the file states
//! the sign: models of the ground are elevations, positive up.
//!
//! # Memory
//! The file, 8 bytes for each pixel, and one tile. A file has at most [`PIXELS_A_BYTE`] pixels for each of its bytes.

use super::crs::{Crs, unit_of_metres};
use super::grid::Scan;
use super::number;
use super::raw::{RawSurface, ReadContext};
use super::text::SourceFile;
use super::unit::ZUnit;
use super::{Codec, Format, FormatError};
use glam::DVec2;
use std::io::Cursor;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

pub(super) const CODEC: Codec =
    Codec { read_horizon: Some(read), ..Codec::of(Format::GeoTiff, "geotiff", "tif", detect) };

/// More pixels than deflate or LZW put into a byte.
const PIXELS_A_BYTE: u64 = 1400;
/// Keys of the GeoKeyDirectory.
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const LINEAR_UNIT: u16 = 3076;
const VERTICAL_UNIT: u16 = 4099;
/// GDAL's tag of metadata.
const GDAL_METADATA: Tag = Tag::Unknown(42112);

type Pixels<'a> = Decoder<Cursor<&'a [u8]>>;

fn detect(source: &SourceFile) -> Option<String> {
    let starts = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    starts.iter().any(|start| source.bytes.starts_with(*start)).then(|| "it begins as a TIFF".to_owned())
}

/// The sentence of a file that the decoder refuses.
fn refused(source: &SourceFile, error: &TiffError) -> FormatError {
    let instead = "write it anew with gdal_translate -b 1 -co COMPRESS=DEFLATE";
    match error {
        TiffError::UnsupportedError(what) => source.bad_grid(format!("{what}; {instead}")),
        other => source.bad_grid(format!("{other}; check that it was copied in full")),
    }
}

fn read(source: &SourceFile, context: &ReadContext<'_>) -> Result<Vec<RawSurface>, FormatError> {
    let failed = |error: TiffError| refused(source, &error);
    let mut limits = Limits::default();
    let most = source.bytes.len().saturating_mul(PIXELS_A_BYTE as usize);
    limits.decoding_buffer_size = most;
    limits.intermediate_buffer_size = most;
    let mut pixels = Decoder::new(Cursor::new(source.bytes.as_slice())).map_err(failed)?.with_limits(limits);
    let is_grey = matches!(pixels.colortype().map_err(failed)?, ColorType::Gray(_));
    let from_white = pixels.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation).ok().flatten() == Some(0);
    if !is_grey || from_white {
        return Err(source
            .bad_grid("it is a picture, or has several bands: write its one band of heights, gdal_translate -b 1"));
    }
    let (width, height) = pixels.dimensions().map_err(failed)?;
    let count = [width as usize, height as usize];
    if u64::from(width) * u64::from(height) > most as u64 {
        return Err(source.length("bytes at least", count[0] * count[1] / PIXELS_A_BYTE as usize, source.bytes.len()));
    }
    system::memory::check("its pixels", &count, 8)
        .map_err(|error| FormatError::Memory { file: source.path.clone(), source: error })?;
    let keys = GeoKeys::of(&mut pixels);
    if [Some(2), Some(3)].contains(&keys.short(MODEL_TYPE)) {
        return Err(source.degrees(context.kind, "the model type of its GeoKeys"));
    }
    let place = Place::of(&mut pixels, &keys).ok_or_else(|| {
        source.bad_grid("it has no place (ModelTiepoint): write it with one, gdal_translate -a_ullr, or with its world file beside it")
    })?;
    let words = band_facts(&mut pixels);
    let null = text_of(&mut pixels, Tag::GdalNodata).and_then(|text| number::of(text.trim_matches(['\0', ' '])));
    let [scale, offset] = [("scale", 1.0), ("offset", 0.0)].map(|(role, or)| words.number(role).unwrap_or(or));
    let mut values = values(source, &mut pixels, count)?;
    let is_null = |value: f64| number::is_null(value, null);
    values.iter_mut().for_each(|value| *value = if is_null(*value) { f64::NAN } else { *value * scale + offset });
    let scan = Scan { first: place.first, along: place.along, across: place.across, count };
    let mut surface = scan.surface(source, words.of("description").map(str::to_owned), values, f64::is_nan)?;
    if scale != 1.0 || offset != 0.0 {
        surface
            .notes
            .push(format!("values were multiplied by the file's scale {scale}, and its offset {offset} was added"));
    }
    surface.notes.extend(null.map(|null| format!("the file's null is {null}")));
    let unit = |key: u16| match keys.short(key)? {
        9001 => Some(ZUnit::Metres),
        9002 => Some(ZUnit::Feet),
        9003 => Some(ZUnit::SurveyFeet),
        9036 => Some(ZUnit::Kilometres),
        _ => None,
    };
    let own = keys.size_of_unit.and_then(unit_of_metres).or(unit(LINEAR_UNIT));
    Crs::Projected(own, "ProjLinearUnits".to_owned()).state(&mut surface);
    let stated = words.of("unittype").and_then(|word| Some((ZUnit::parse(word)?, format!("band unit {word}"))));
    surface.vertical.unit = stated.or(unit(VERTICAL_UNIT).map(|unit| (unit, "VerticalUnits".to_owned())));
    if has_mask(&mut pixels) {
        let fact =
            "it has a mask of holes, which is not read: write a null instead, gdal_translate -mask none -a_nodata";
        surface.warnings.push(fact.to_owned().into());
    }
    Ok(vec![surface])
}

fn doubles(pixels: &mut Pixels<'_>, tag: Tag) -> Vec<f64> {
    pixels.find_tag(tag).ok().flatten().and_then(|value| value.into_f64_vec().ok()).unwrap_or_default()
}

fn text_of(pixels: &mut Pixels<'_>, tag: Tag) -> Option<String> {
    pixels.find_tag(tag).ok().flatten().and_then(|value| value.into_string().ok())
}

/// The keys of the coordinate system.
struct GeoKeys {
    words: Vec<u16>,
    /// Metres of a unit that has no code.
    size_of_unit: Option<f64>,
}

impl GeoKeys {
    fn of(pixels: &mut Pixels<'_>) -> Self {
        let found = pixels.find_tag(Tag::GeoKeyDirectoryTag).ok().flatten();
        let words: Vec<u16> = found.and_then(|value| value.into_u16_vec().ok()).unwrap_or_default();
        let sizes = doubles(pixels, Tag::GeoDoubleParamsTag);
        let own = words.as_chunks::<4>().0.iter().skip(1).find(|[key, place, ..]| (*key, *place) == (3077, 34736));
        let size_of_unit = own.and_then(|[.., at]| sizes.get(usize::from(*at)).copied());
        Self { words, size_of_unit }
    }

    /// A key whose value stands in the directory itself.
    fn short(&self, wanted: u16) -> Option<u16> {
        let mut keys = self.words.as_chunks::<4>().0.iter().skip(1);
        keys.find(|[key, place, ..]| *key == wanted && *place == 0).map(|[.., value]| *value)
    }
}

/// Where the middle of the first pixel lies, and the steps to the next one and to the next row.
struct Place {
    first: DVec2,
    along: DVec2,
    across: DVec2,
}

impl Place {
    fn of(pixels: &mut Pixels<'_>, keys: &GeoKeys) -> Option<Self> {
        let (scale, tie) = (doubles(pixels, Tag::ModelPixelScaleTag), doubles(pixels, Tag::ModelTiepointTag));
        let matrix = doubles(pixels, Tag::ModelTransformationTag);
        let (corner, along, across) = match (&matrix[..], &scale[..], &tie[..]) {
            ([a, b, _, x, d, e, _, y, ..], ..) => (DVec2::new(*x, *y), DVec2::new(*a, *d), DVec2::new(*b, *e)),
            (_, [dx, dy, ..], [i, j, _, x, y, _, ..]) => {
                let (along, across) = (DVec2::new(*dx, 0.0), DVec2::new(0.0, -*dy));
                (DVec2::new(*x, *y) - along * *i - across * *j, along, across)
            }
            _ => return None,
        };
        let is_point = keys.short(RASTER_TYPE) == Some(2);
        let first = if is_point { corner } else { corner + 0.5 * (along + across) };
        Some(Self { first, along, across })
    }
}

/// What GDAL writes of the first band.
struct BandFacts(String);

fn band_facts(pixels: &mut Pixels<'_>) -> BandFacts {
    BandFacts(text_of(pixels, GDAL_METADATA).unwrap_or_default())
}

impl BandFacts {
    /// The text of the item with a role.
    fn of(&self, role: &str) -> Option<&str> {
        let role = format!("role=\"{role}\"");
        let item = self.0.split("<Item ").find(|item| {
            let head = item.split('>').next().unwrap_or("");
            head.contains(&role) && (head.contains("sample=\"0\"") || !head.contains("sample="))
        })?;
        let text = item.split_once('>')?.1.split('<').next()?.trim();
        (!text.is_empty()).then_some(text)
    }

    fn number(&self, role: &str) -> Option<f64> {
        self.of(role).and_then(number::plain).filter(|v| v.is_finite())
    }
}

/// Whether a further picture of the file is a mask.
fn has_mask(pixels: &mut Pixels<'_>) -> bool {
    let is_mask = |pixels: &mut Pixels<'_>| {
        pixels.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten().is_some_and(|kind| kind & 4 != 0)
    };
    // Files have a handful of reduced copies; what comes after many is not looked at.
    (0..32).any(|_| pixels.more_images() && pixels.next_image().is_ok() && is_mask(pixels))
}

/// The values, row by row from the first; NaN where a tile or strip is not there.
fn values(source: &SourceFile, pixels: &mut Pixels<'_>, [width, height]: [usize; 2]) -> Result<Vec<f64>, FormatError> {
    let failed = |error: TiffError| refused(source, &error);
    let is_tiled = pixels.get_chunk_type() == ChunkType::Tile;
    let tags = if is_tiled { [Some(Tag::TileWidth), Some(Tag::TileLength)] } else { [None, Some(Tag::RowsPerStrip)] };
    let mut side = |tag: Option<Tag>, or: usize| {
        let found = tag.map_or(Ok(None), |tag| pixels.find_tag_unsigned::<u32>(tag)).map_err(failed)?;
        Ok::<usize, FormatError>(found.map_or(or, |side| side as usize))
    };
    let (across, down) = (side(tags[0], width)?, side(tags[1], height)?);
    let down = if is_tiled { down } else { down.min(height) };
    let largest = (source.bytes.len() as u64).saturating_mul(PIXELS_A_BYTE);
    if across == 0 || down == 0 || (across as u64).saturating_mul(down as u64) > largest {
        return Err(source.bad_grid(format!("tiles of {across} by {down} pixels in {} bytes", source.bytes.len())));
    }
    let sizes = if is_tiled { Tag::TileByteCounts } else { Tag::StripByteCounts };
    let sizes = pixels.get_tag_u64_vec(sizes).map_err(failed)?;
    let (columns, rows) = (width.div_ceil(across), height.div_ceil(down));
    if sizes.len() != columns * rows {
        return Err(source.length("tiles or strips", columns * rows, sizes.len()));
    }
    let mut values = vec![f64::NAN; width * height];
    for (n, size) in sizes.iter().enumerate().filter(|(_, size)| **size > 0) {
        let [x, y] = [n % columns * across, n / columns * down];
        let (wide, high) = (across.min(width - x), down.min(height - y));
        let chunk = numbers(pixels.read_chunk(n as u32).map_err(failed)?);
        if chunk.len() != wide * high {
            return Err(source.length(
                "pixels of a tile of which there are bytes",
                wide * high,
                chunk.len().min(*size as usize),
            ));
        }
        for (row, line) in chunk.chunks_exact(wide).enumerate() {
            let at = (y + row) * width + x;
            values[at..at + wide].copy_from_slice(line);
        }
    }
    Ok(values)
}

fn numbers(chunk: DecodingResult) -> Vec<f64> {
    fn each<T: Copy>(values: &[T], of: fn(T) -> f64) -> Vec<f64> {
        values.iter().map(|value| of(*value)).collect()
    }
    match chunk {
        DecodingResult::U8(values) => each(&values, f64::from),
        DecodingResult::U16(values) => each(&values, f64::from),
        DecodingResult::U32(values) => each(&values, f64::from),
        DecodingResult::U64(values) => each(&values, |value| value as f64),
        DecodingResult::I8(values) => each(&values, f64::from),
        DecodingResult::I16(values) => each(&values, f64::from),
        DecodingResult::I32(values) => each(&values, f64::from),
        DecodingResult::I64(values) => each(&values, |value| value as f64),
        DecodingResult::F16(values) => each(&values, |value| f64::from(value.to_f32())),
        DecodingResult::F32(values) => each(&values, f64::from),
        DecodingResult::F64(values) => each(&values, |value| value),
    }
}
