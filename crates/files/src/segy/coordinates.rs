//! X and Y of the traces: their bytes in the trace headers, their number type, and the position of the
//! survey.

use glam::DVec2;

use super::SegyOptions;
use super::angles::{Angles, look_like_degrees, note_unknown_units};
use super::columns::{Columns, HeaderColumn, HeaderLayout};
use super::error::SegyProblem;
use super::field_sweep::coordinate_pairs;
use super::header::{Field, at};
use super::info::{Findings, GeometrySummary, LengthUnit, in_figures};
use super::lines::LineLattice;
use super::number_type::NumberType;
use super::place::{FittedPlace, MAX_RESIDUAL_BINS};
use super::sample::f32_from_ibm;
use super::vertical::scaled;
use survey::geometry::LineAxis;
use survey::remedy::{Note, Remedy, Setting};

/// Known positions of X and Y in the trace header: CDP (the standard's), source, receiver.
pub(super) const HOMES: [[u16; 2]; 3] = [[at::CDP_X, at::CDP_Y], [73, 77], [81, 85]];

/// Bin size where a file has no coordinates, m.
const ASSUMED_BIN_M: f64 = 25.0;

/// Sides of bins that surveys have, m.
const BIN_M: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// Sides of most bins, m.
const USUAL_BIN_M: std::ops::RangeInclusive<f64> = 5.0..=60.0;

/// Projected coordinates stay below this, in m or ft.
const MAX_COORDINATE: f64 = 1e8;

/// The cosine of the angle between the axes from which they are called skewed.
const MAX_SKEW: f64 = 1e-3;

/// The same of X and Y that are where no convention has them: surveys are laid out at right angles.
const MAX_SKEW_ANYWHERE: f64 = 0.01;

/// What integers are multiplied by.
#[derive(Debug, Clone, Copy)]
enum Scalar<'a> {
    /// The field of each trace.
    OfTrace(&'a HeaderColumn),
    Stated(i16),
}

impl Scalar<'_> {
    fn at(self, trace: usize) -> i32 {
        match self {
            Self::OfTrace(column) => column.at(trace),
            Self::Stated(scalar) => i32::from(scalar),
        }
    }

    fn range(self) -> [i32; 2] {
        match self {
            Self::OfTrace(column) => column.range,
            Self::Stated(scalar) => [i32::from(scalar); 2],
        }
    }
}

/// X and Y of every trace. Integers are scaled; floats are not, by usage and by revision 2.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coordinates<'a> {
    pub bytes: [u16; 2],
    pub number_type: NumberType,
    columns: &'a Columns,
    x: &'a HeaderColumn,
    y: &'a HeaderColumn,
    scalar: Scalar<'a>,
}

/// X and Y at two bytes; the type if it is known.
type Home = ([u16; 2], Option<NumberType>);

impl<'a> Coordinates<'a> {
    fn new(columns: &'a Columns, (bytes, number_type): Home, options: &SegyOptions) -> Self {
        let [x, y] = bytes.map(|byte| columns.get(Field::I32(byte)));
        let scalar = match options.coordinate_scalar {
            Some(scalar) => Scalar::Stated(scalar),
            None => Scalar::OfTrace(columns.get(Field::I16(scalar_byte(options)))),
        };
        let mut coordinates = Self { bytes, number_type: number_type.unwrap_or_default(), columns, x, y, scalar };
        if number_type.is_none() && coordinates.look_like_floats() {
            coordinates.number_type = NumberType::F32;
        }
        coordinates
    }

    /// X and Y of a trace; none if both are 0.
    #[inline]
    pub(super) fn of(&self, trace: usize) -> Option<DVec2> {
        let (x, y) = (self.x.at(trace), self.y.at(trace));
        let world = match self.number_type {
            NumberType::F64 => {
                let [x, y] = self.bytes.map(|byte| self.columns.double(byte, trace));
                DVec2::new(x, y)
            }
            NumberType::F32 | NumberType::Ibm32 => {
                let float = |field: i32| {
                    let bits = field.cast_unsigned();
                    f64::from(if self.number_type == NumberType::F32 {
                        f32::from_bits(bits)
                    } else {
                        f32_from_ibm(bits)
                    })
                };
                DVec2::new(float(x), float(y))
            }
            NumberType::I32 | NumberType::I16 | NumberType::U16 => {
                let scalar = self.scalar.at(trace);
                let [x, y] = [x, y].map(|field| scaled(self.columns.reinterpret(field, self.number_type), scalar));
                DVec2::new(x, y)
            }
        };
        (world.is_finite() && world != DVec2::ZERO).then_some(world)
    }

    /// Whether the integers are too large for places on Earth, and would be reasonable as floats. A fit
    /// cannot tell: between two powers of two the bits of floats are evenly spaced integers.
    fn look_like_floats(&self) -> bool {
        [self.x, self.y].iter().flat_map(|column| column.range).all(|bits| {
            let float = f32::from_bits(bits.cast_unsigned()).abs();
            (1.0..MAX_COORDINATE as f32).contains(&float) && scaled(bits, self.scalar.at(0)).abs() > MAX_COORDINATE
        })
    }

    /// Whether X and Y are, each for itself, the numbers of one and the same axis once more, as they are stored or scaled.
    fn repeat(&self, lattice: &LineLattice) -> [bool; 2] {
        // Where a number of the lattice is beyond what a field can hold, no field repeats it.
        let number = |axis: &LineAxis, n: usize| i64::from(axis.first) + i64::from(axis.step) * n as i64;
        // [axis][inline or crossline][as stored or scaled]
        let mut same = [[[true; 2]; 2]; 2];
        for (inline, crossline, trace) in lattice.traces() {
            let numbers = [number(&lattice.inlines, inline), number(&lattice.crosslines, crossline)];
            let scaled = self.of(trace).unwrap_or(DVec2::ZERO).to_array();
            let stored = [self.x, self.y].map(|column| i64::from(column.at(trace)));
            for axis in 0..2 {
                for (line, number) in numbers.into_iter().enumerate() {
                    same[axis][line][0] &= stored[axis] == number;
                    same[axis][line][1] &= scaled[axis] == number as f64;
                }
            }
            if !same.as_flattened().as_flattened().contains(&true) {
                break;
            }
        }
        same.map(|lines| lines.as_flattened().contains(&true))
    }

    /// Whether X and Y grow by one, as they are stored, or by the step of its numbers from each line to the next, and
    /// along one axis each: they count lines.
    fn count(&self, lattice: &LineLattice, fit: &FittedPlace) -> bool {
        let unit = match self.number_type {
            NumberType::I32 | NumberType::I16 | NumberType::U16 => scaled(1, self.scalar.at(0)),
            NumberType::F32 | NumberType::F64 | NumberType::Ibm32 => 1.0,
        };
        let counts = |vector: DVec2, axis: &LineAxis| {
            let [most, least] = [vector.abs().max_element() / unit, vector.abs().min_element() / unit];
            let is = |step: f64| (most - step).abs() < 1e-6 * step;
            least < 1e-6 * most && (is(1.0) || is(f64::from(axis.step).abs()))
        };
        counts(fit.inline_vector, &lattice.inlines) && counts(fit.crossline_vector, &lattice.crosslines)
    }

    /// Why they may be something else than coordinates.
    fn doubt(&self, lattice: &LineLattice, fit: &FittedPlace) -> Option<&'static str> {
        match self.repeat(lattice) {
            [true, true] => Some("X and Y are line numbers once more"),
            [true, false] => Some("X is a line number once more"),
            [false, true] => Some("Y is a line number once more"),
            [false, false] => {
                self.count(lattice, fit).then_some("X and Y grow by one from line to line, as counters do")
            }
        }
    }

    /// Largest X or Y, in their unit.
    fn largest(&self) -> f64 {
        (0..self.columns.count())
            .filter_map(|trace| self.of(trace))
            .fold(0.0, |most, at| at.abs().max_element().max(most))
    }

    /// The scalar that would make bins of these sides, in metres as they are read, those of a survey: a power of ten,
    /// where the numbers are integers; and what it would do.
    fn better_scalar(&self, sides: [f64; 2]) -> Option<(i32, String)> {
        let [now, same] = self.scalar.range();
        let is_integer = matches!(self.number_type, NumberType::I32 | NumberType::I16 | NumberType::U16);
        let unscaled = sides.map(|side| side / scaled(1, now));
        let likely = [-10, -100, -1000, -10_000, 1, 10, 100].into_iter().find(|scalar| {
            let is_usual = |side: f64| USUAL_BIN_M.contains(&(side * scaled(1, *scalar)));
            is_integer && now == same && unscaled.into_iter().all(is_usual)
        })?;
        let [a, b] = unscaled.map(|side| in_figures(side * scaled(1, likely)));
        Some((likely, format!("with a coordinate scalar of {likely} in place of {now} they would be {a} by {b} m")))
    }

    /// Whether X or Y varies.
    fn vary(&self) -> bool {
        self.x.constant().is_none() || self.y.constant().is_none() || self.number_type == NumberType::F64
    }

    /// How they are stored, for a list of evidence.
    fn storage(&self) -> String {
        match (self.number_type, self.scalar) {
            (NumberType::F32 | NumberType::F64 | NumberType::Ibm32, _) => {
                format!("floats ({})", self.number_type.name())
            }
            (_, Scalar::Stated(scalar)) => format!("scalar {scalar}, as stated"),
            (_, Scalar::OfTrace(column)) if column.range[0] == column.range[1] => format!("scalar {}", column.range[0]),
            (_, Scalar::OfTrace(column)) => format!("scalar {} to {}", column.range[0], column.range[1]),
        }
    }
}

/// Byte of the coordinate scalar.
fn scalar_byte(options: &SegyOptions) -> u16 {
    options.scalar_byte.unwrap_or(at::COORDINATE_SCALAR)
}

/// The smallest and the largest scalar of X and Y: the file's, or the stated one.
pub(super) fn scalar_range(columns: &Columns, options: &SegyOptions) -> [i32; 2] {
    let stated = options.coordinate_scalar.map(|scalar| [i32::from(scalar); 2]);
    stated.unwrap_or_else(|| columns.get(Field::I16(scalar_byte(options))).range)
}

/// Whether X or Y is known to be stored at a byte.
pub(super) fn is_coordinate(byte: u16) -> bool {
    HOMES.iter().flatten().any(|home| *home == byte)
}

/// Fields that X and Y may need.
pub(super) fn coordinate_fields(options: &SegyOptions, layout: HeaderLayout) -> Vec<Field> {
    let mut fields = vec![Field::I16(scalar_byte(options))];
    for (bytes, number_type) in homes(options, layout) {
        for byte in bytes {
            fields.push(Field::I32(byte));
            if number_type == Some(NumberType::F64) {
                fields.push(Field::I32(byte + 4));
            }
        }
    }
    fields
}

/// The first X and Y that vary, whatever lattice they give.
pub(super) fn varying<'a>(columns: &'a Columns, options: &SegyOptions) -> Option<Coordinates<'a>> {
    homes(options, columns.layout())
        .into_iter()
        .map(|home| Coordinates::new(columns, home, options))
        .find(|coordinates| coordinates.vary() && (0..columns.count()).any(|trace| coordinates.of(trace).is_some()))
}

/// How good a fit is: 0 if X and Y are not affine in the lattice, [`SURE`] if nothing speaks against it.
fn rank(coordinates: &Coordinates<'_>, fit: &FittedPlace, lattice: &LineLattice) -> u8 {
    if !fit.agrees() {
        return 0;
    }
    1 + u8::from(has_plausible_bins(fit, 1.0)) * (1 + u8::from(coordinates.doubt(lattice, fit).is_none()))
}

/// The rank of coordinates without a doubt.
const SURE: u8 = 3;

/// The first home and storage whose X and Y are affine in the lattice, with bins of a plausible size if there are any, and
/// no counters; failing that, any two neighbouring fields that are, where all were read; failing that, the first that
/// spans an area. `lines` are the bytes of the line numbers, which are no coordinates, and neither is what repeats them
/// elsewhere.
pub(super) fn locate<'a>(
    lattice: &LineLattice,
    lines: [u16; 2],
    columns: &'a Columns,
    options: &SegyOptions,
) -> Option<(Coordinates<'a>, FittedPlace)> {
    let of = |home: Home| {
        let coordinates = Coordinates::new(columns, home, options);
        let is_free = !home.0.iter().any(|byte| lines.contains(byte)) && coordinates.vary();
        let is_own = is_free && (is_stated(options) || coordinates.repeat(lattice) != [true; 2]);
        is_own.then(|| Some((coordinates, FittedPlace::fit(lattice, |trace| coordinates.of(trace))?))).flatten()
    };
    let mut best: Option<((Coordinates<'a>, FittedPlace), u8)> = None;
    for found in homes(options, columns.layout()).into_iter().filter_map(of) {
        let rank = rank(&found.0, &found.1, lattice);
        if best.as_ref().is_none_or(|(_, best)| rank > *best) {
            best = Some((found, rank));
        }
        if rank == SURE {
            break;
        }
    }
    if options.coordinate_type.is_none() && best.as_ref().is_none_or(|(_, rank)| *rank < SURE) {
        // The bits of an IBM float are a number as IEEE float and as integer too: the size of bins tells.
        let ibm = homes(options, columns.layout()).into_iter().filter(|(_, number_type)| number_type.is_none());
        let sure = ibm.filter_map(|(bytes, _)| of((bytes, Some(NumberType::Ibm32))));
        if let Some(found) = sure.into_iter().find(|found| rank(&found.0, &found.1, lattice) == SURE) {
            return Some(found);
        }
    }
    if is_open(options) && best.as_ref().is_none_or(|(_, rank)| *rank < SURE) {
        let anywhere = coordinate_pairs(columns).into_iter().filter_map(|bytes| of((bytes, options.coordinate_type)));
        let is_sure = |found: &(Coordinates<'_>, FittedPlace)| {
            rank(&found.0, &found.1, lattice) == SURE && found.1.skew() < MAX_SKEW_ANYWHERE
        };
        let sure = anywhere.into_iter().find(is_sure);
        return sure.or(best.map(|(found, _)| found));
    }
    best.map(|(found, _)| found)
}

/// Whether X and Y may be anywhere.
fn is_open(options: &SegyOptions) -> bool {
    options.bin_m.is_none() && !is_stated(options)
}

/// Whether X and Y at the usual places are missing or doubtful, so that every field is worth a look.
pub(super) fn needs_any_place(
    lattice: &LineLattice,
    lines: [u16; 2],
    columns: &Columns,
    options: &SegyOptions,
) -> bool {
    is_open(options) && lattice.places() > 1 && !confirm(lattice, lines, columns, options)
}

/// Whether X and Y, at other bytes than the lines, leave no doubt that this is their lattice.
pub(super) fn confirm(lattice: &LineLattice, lines: [u16; 2], columns: &Columns, options: &SegyOptions) -> bool {
    let is_sure = |(coordinates, fit)| rank(&coordinates, &fit, lattice) == SURE;
    locate(lattice, lines, columns, options).is_some_and(is_sure)
}

/// Whether the user says where X and Y are.
fn is_stated(options: &SegyOptions) -> bool {
    options.x_byte.is_some() || options.y_byte.is_some()
}

/// Whether both sides of a bin are of a size that surveys have; `metres` is that of the unit.
fn has_plausible_bins(fit: &FittedPlace, metres: f64) -> bool {
    [fit.inline_vector, fit.crossline_vector].iter().all(|side| BIN_M.contains(&(side.length() * metres)))
}

/// Bytes at which X and Y are looked for.
fn homes(options: &SegyOptions, HeaderLayout { bytes: header_bytes, named }: HeaderLayout) -> Vec<Home> {
    let stated = options.coordinate_type;
    match (options.bin_m, options.x_byte, options.y_byte) {
        (Some(_), ..) => Vec::new(),
        (None, None, None) => {
            let [_, extended_y] = at::EXTENDED_CDP;
            let has_extension = header_bytes >= usize::from(extended_y) + 7 && stated.is_none();
            let extended = has_extension.then_some((at::EXTENDED_CDP, Some(NumberType::F64)));
            let usual = HOMES.into_iter().map(|bytes| (bytes, stated));
            // The standard's two places first.
            let (mut homes, rest): (Vec<Home>, Vec<Home>) = usual.partition(|(bytes, _)| bytes[0] == at::CDP_X);
            homes.extend(extended);
            homes.extend(rest);
            if let Some(named) = named.coordinates {
                homes.retain(|(bytes, _)| *bytes != named);
                homes.insert(0, (named, stated));
            }
            homes
        }
        (None, x, y) => vec![([x.unwrap_or(at::CDP_X), y.unwrap_or(at::CDP_Y)], stated)],
    }
}

/// Where the lattice is, and the bytes that say so.
#[derive(Debug, Clone, Copy)]
pub(super) struct CoordinatePlace {
    pub bytes: Option<[u16; 2]>,
    /// In the unit of the coordinates.
    pub summary: GeometrySummary,
}

impl CoordinatePlace {
    /// From X and Y; assumed where there are none, or as stated.
    pub(super) fn find(
        lattice: &LineLattice,
        lines: [u16; 2],
        columns: &Columns,
        unit: LengthUnit,
        options: &SegyOptions,
        findings: &mut Findings,
    ) -> Result<Self, SegyProblem> {
        let Some((coordinates, fit)) = locate(lattice, lines, columns, options) else {
            return Ok(Self::assumed(lattice, columns, unit, options, findings));
        };
        let units = columns.get(Field::I16(at::COORDINATE_UNIT));
        if options.coordinate_unit.is_none() {
            match Angles::of(units) {
                Some(angles) => angles.must_be_lengths(coordinates.largest(), &fit, findings)?,
                None => note_unknown_units(units, findings),
            }
        }
        note_doubts((&coordinates, &fit), lattice, unit, columns, options, findings);
        note_fit(&coordinates, &fit, unit, options, findings);
        Ok(Self {
            bytes: Some(coordinates.bytes),
            summary: GeometrySummary {
                origin: fit.origin.to_array(),
                inline_vector: fit.inline_vector.to_array(),
                crossline_vector: fit.crossline_vector.to_array(),
                residual_rms_bins: Some(fit.rms_bins),
                residual_max_bins: Some(fit.max_bins),
            },
        })
    }

    fn assumed(
        lattice: &LineLattice,
        columns: &Columns,
        unit: LengthUnit,
        options: &SegyOptions,
        findings: &mut Findings,
    ) -> Self {
        let bin = options.bin_m.unwrap_or(ASSUMED_BIN_M) / unit.metres();
        let homes = homes(options, columns.layout());
        let mut place = Self {
            bytes: None,
            summary: GeometrySummary {
                origin: [0.0; 2],
                inline_vector: [bin, 0.0],
                crossline_vector: [0.0, bin],
                residual_rms_bins: None,
                residual_max_bins: None,
            },
        };
        if let Some(bin_m) = options.bin_m {
            findings.evidence(format!("place: square bins of {bin_m} m at 0, 0, as stated"));
        } else if lattice.places() == 1
            && let Some((bytes, world)) =
                homes.iter().find_map(|&home| Some((home.0, Coordinates::new(columns, home, options).of(0)?)))
        {
            place.bytes = Some(bytes);
            place.summary.origin = world.to_array();
        } else {
            let places = homes.iter().map(|([x, y], _)| format!("{x} and {y}")).collect::<Vec<_>>().join(", ");
            let bytes = Remedy::all([Setting::XByte.stated(), Setting::YByte.stated()]);
            findings.assumption(Note::unless(
                format!(
                    "the survey lies at 0, 0 with square bins of {ASSUMED_BIN_M} m: no X and Y that span an \
                     area, and do not repeat the line numbers, were found at bytes {places}"
                ),
                Remedy::any([bytes, Setting::Bin.stated()]),
            ));
        }
        place
    }
}

/// Reasons to doubt that these are the coordinates. Of bytes that the user states, the size of the bins alone is doubted.
fn note_doubts(
    (coordinates, fit): (&Coordinates<'_>, &FittedPlace),
    lattice: &LineLattice,
    unit: LengthUnit,
    columns: &Columns,
    options: &SegyOptions,
    findings: &mut Findings,
) {
    note_bins(coordinates, fit, unit, options, findings);
    if is_stated(options) {
        return;
    }
    let [x, y] = coordinates.bytes;
    let named = columns.layout().named.coordinates;
    if named != Some(coordinates.bytes) && !HOMES.contains(&coordinates.bytes) && coordinates.bytes != at::EXTENDED_CDP
    {
        findings.assumption(Note::unless(
            format!(
                "X and Y are at bytes {x} and {y}, where no convention has them: they alone fit the lattice of lines"
            ),
            other_bytes(),
        ));
    }
    if let Some(doubt) = coordinates.doubt(lattice, fit) {
        findings.warning(Note::unless(
            format!("at bytes {x} and {y} {doubt}: the place and the size of the survey are doubtful"),
            Remedy::any([other_bytes(), Setting::Bin.stated()]),
        ));
    }
    if let Some([named_x, named_y]) = named.filter(|named| *named != coordinates.bytes) {
        findings.warning(Note::unless(
            format!(
                "the text header names bytes {named_x} and {named_y} for X and Y, which make no lattice there; bytes {x} \
                 and {y} do and are taken"
            ),
            other_bytes(),
        ));
    }
}

fn other_bytes() -> Remedy {
    Remedy::all([Setting::XByte.stated(), Setting::YByte.stated()])
}

/// Bins that no survey has, and what would make them plausible.
fn note_bins(
    coordinates: &Coordinates<'_>,
    fit: &FittedPlace,
    unit: LengthUnit,
    options: &SegyOptions,
    findings: &mut Findings,
) {
    if has_plausible_bins(fit, unit.metres()) {
        return;
    }
    let [x, y] = coordinates.bytes;
    let sides = [fit.inline_vector, fit.crossline_vector].map(|side| side.length() * unit.metres());
    let [inline, crossline] = sides.map(in_figures);
    let (scalar, likely) = if look_like_degrees(coordinates.largest(), fit) {
        (None, "X and Y may be degrees, which have to be projected first".to_owned())
    } else if let Some((scalar, likely)) = coordinates.better_scalar(sides) {
        (Some(Setting::CoordinateScalar.stated_as(scalar)), likely)
    } else {
        let scalar = Some(Setting::CoordinateScalar.stated());
        (scalar, "other bytes may hold them, or another coordinate scalar or unit may be meant".to_owned())
    };
    let bytes = (!is_stated(options)).then(other_bytes);
    findings.warning(Note::unless(
        format!("X and Y at bytes {x} and {y} make bins of {inline} by {crossline} m, which no survey has: {likely}"),
        Remedy::any(scalar.into_iter().chain(bytes).chain([Setting::CoordinateUnit.stated(), Setting::Bin.stated()])),
    ));
}

fn note_fit(
    coordinates: &Coordinates<'_>,
    fit: &FittedPlace,
    unit: LengthUnit,
    options: &SegyOptions,
    findings: &mut Findings,
) {
    let is_found = options.coordinate_type.is_none();
    let [low, high] = coordinates.scalar.range();
    let is_of_file = matches!(coordinates.scalar, Scalar::OfTrace(_));
    let byte = scalar_byte(options);
    let scalar = coordinates.storage();
    findings.evidence(format!(
        "place: X at byte {} and Y at byte {}, {scalar}; bins of {} by {} {}; X and Y of {} traces lie \
         within {:.3} bin of the lattice (root mean square)",
        coordinates.bytes[0],
        coordinates.bytes[1],
        in_figures(fit.inline_vector.length()),
        in_figures(fit.crossline_vector.length()),
        unit.symbol(),
        fit.traces,
        fit.rms_bins
    ));
    let is_float = matches!(coordinates.number_type, NumberType::F32 | NumberType::F64 | NumberType::Ibm32);
    if is_float && is_found {
        let why = match coordinates.number_type {
            NumberType::F32 => ": as the integers that the standard has, they are no places on Earth",
            NumberType::Ibm32 => ": as integers or IEEE floats they make no bins of a survey",
            _ => ", in the trace header extension of revision 2",
        };
        findings.assumption(Note::unless(
            format!(
                "X and Y are {} floats without a scalar{why}",
                if coordinates.number_type == NumberType::Ibm32 { "IBM" } else { "IEEE" }
            ),
            Setting::CoordinateType.stated_as("i32, f32, f64 or ibm32"),
        ));
    } else if !is_float && low != high {
        findings.warning(format!(
            "the coordinate scalar (byte {byte}) differs between traces, {low} to {high}; each trace's own is used"
        ));
    } else if !is_float && is_of_file && !matches!(low.abs(), 0 | 1 | 10 | 100 | 1000 | 10_000) {
        findings
            .warning(format!("the coordinate scalar (byte {byte}) is {low}, which is no power of ten; it is applied"));
    }
    if fit.outliers > 0 {
        findings.warning(format!(
            "X and Y of {} traces lie more than {MAX_RESIDUAL_BINS} bin off the lattice, trace {} by {:.1} \
             bins: check the line and coordinate bytes",
            fit.outliers,
            fit.worst_trace + 1,
            fit.max_bins
        ));
    }
    if fit.skew() > MAX_SKEW {
        findings.warning(format!(
            "inlines and crosslines are not perpendicular (the cosine of their angle is {:.4})",
            fit.skew()
        ));
    }
    if fit.without > 0 {
        findings.evidence(format!(
            "{} traces have no X and Y (both 0); they are placed by their line numbers",
            fit.without
        ));
    }
}
