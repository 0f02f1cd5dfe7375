//! X and Y of the traces: where they are in the trace headers, how they are stored, and the place they give the survey.

use glam::DVec2;

use super::SegyOptions;
use super::columns::{Column, Columns};
use super::error::SegyProblem;
use super::header::{Field, at};
use super::info::{Findings, GeometrySummary, LengthUnit};
use super::lines::Lattice;
use super::place::{MAX_RESIDUAL_BINS, Placement};
use super::vertical::scaled;

/// Known homes of X and Y: CDP (the standard's), source, receiver.
pub(super) const HOMES: [[u16; 2]; 3] = [[at::CDP_X, at::CDP_Y], [73, 77], [81, 85]];

/// Bin size where a file has no coordinates, m.
const ASSUMED_BIN_M: f64 = 25.0;

/// Projected coordinates stay below this, in m or ft.
const MAX_COORDINATE: f64 = 1e8;

/// The cosine of the angle between the axes from which they are called skewed.
const MAX_SKEW: f64 = 1e-3;

/// How X and Y are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Storage {
    /// Integers with the scalar at byte 71, the standard's way.
    Scaled,
    /// IEEE floats without a scalar; some writers do so.
    Float,
}

/// X and Y of every trace.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coordinates<'a> {
    pub bytes: [u16; 2],
    pub storage: Storage,
    x: &'a Column,
    y: &'a Column,
    scalar: &'a Column,
}

impl<'a> Coordinates<'a> {
    fn new(columns: &'a Columns, bytes: [u16; 2], storage: Storage) -> Self {
        let [x, y] = bytes.map(|byte| columns.get(Field::I32(byte)));
        Self { bytes, storage, x, y, scalar: columns.get(Field::I16(at::COORDINATE_SCALAR)) }
    }

    /// X and Y of a trace; none if both are 0.
    pub fn of(&self, trace: usize) -> Option<DVec2> {
        let (x, y) = (self.x.at(trace), self.y.at(trace));
        if (x, y) == (0, 0) {
            return None;
        }
        let world = match self.storage {
            Storage::Scaled => {
                let scalar = self.scalar.at(trace);
                DVec2::new(scaled(x, scalar), scaled(y, scalar))
            }
            Storage::Float => {
                let float = |bits: i32| f64::from(f32::from_bits(bits.cast_unsigned()));
                DVec2::new(float(x), float(y))
            }
        };
        world.is_finite().then_some(world)
    }

    /// Whether the integers are too large for places on Earth, and would be reasonable as floats. A fit cannot tell:
    /// between two powers of two the bits of floats are evenly spaced integers.
    fn look_like_floats(&self) -> bool {
        [self.x, self.y].iter().flat_map(|column| column.range).all(|bits| {
            let float = f32::from_bits(bits.cast_unsigned()).abs();
            (1.0..MAX_COORDINATE as f32).contains(&float) && scaled(bits, self.scalar.at(0)).abs() > MAX_COORDINATE
        })
    }

    /// Whether X or Y varies.
    fn vary(&self) -> bool {
        self.x.constant().is_none() || self.y.constant().is_none()
    }
}

/// The first home and storage whose X and Y are affine in the lattice; failing that, the first that spans an area.
/// `lines` are the bytes of the line numbers, which are no coordinates.
pub(super) fn locate<'a>(
    lattice: &Lattice,
    lines: [u16; 2],
    columns: &'a Columns,
    options: &SegyOptions,
) -> Option<(Coordinates<'a>, Placement)> {
    let homes = homes(options).into_iter().filter(|bytes| !bytes.iter().any(|byte| lines.contains(byte)));
    let mut fits = homes
        .map(|bytes| {
            let scaled = Coordinates::new(columns, bytes, Storage::Scaled);
            if scaled.look_like_floats() { Coordinates { storage: Storage::Float, ..scaled } } else { scaled }
        })
        .filter(Coordinates::vary)
        .filter_map(|coordinates| Some((coordinates, Placement::fit(lattice, |trace| coordinates.of(trace))?)));
    let first = fits.next()?;
    if first.1.agrees() {
        return Some(first);
    }
    Some(fits.find(|(_, placement)| placement.agrees()).unwrap_or(first))
}

/// Bytes at which X and Y are looked for.
fn homes(options: &SegyOptions) -> Vec<[u16; 2]> {
    match (options.bin_m, options.x_byte, options.y_byte) {
        (Some(_), ..) => Vec::new(),
        (None, None, None) => HOMES.to_vec(),
        (None, x, y) => vec![[x.unwrap_or(at::CDP_X), y.unwrap_or(at::CDP_Y)]],
    }
}

/// Where the lattice is, and the bytes that say so.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub bytes: Option<[u16; 2]>,
    /// In the unit of the coordinates.
    pub summary: GeometrySummary,
}

impl Place {
    /// From X and Y; assumed where there are none, or as stated.
    pub fn find(
        lattice: &Lattice,
        lines: [u16; 2],
        columns: &Columns,
        unit: LengthUnit,
        options: &SegyOptions,
        findings: &mut Findings,
    ) -> Result<Self, SegyProblem> {
        let Some((coordinates, fit)) = locate(lattice, lines, columns, options) else {
            return Ok(Self::assumed(lattice, columns, unit, options, findings));
        };
        let codes = columns.get(Field::I16(at::COORDINATE_UNIT)).range;
        codes.into_iter().try_for_each(refuse_angles)?;
        note_fit(&coordinates, &fit, unit, findings);
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
        lattice: &Lattice,
        columns: &Columns,
        unit: LengthUnit,
        options: &SegyOptions,
        findings: &mut Findings,
    ) -> Self {
        let bin = options.bin_m.unwrap_or(ASSUMED_BIN_M) / unit.metres();
        let homes = homes(options);
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
                homes.iter().find_map(|&bytes| Some((bytes, Coordinates::new(columns, bytes, Storage::Scaled).of(0)?)))
        {
            place.bytes = Some(bytes);
            place.summary.origin = world.to_array();
        } else {
            findings.assumption(format!(
                "the survey lies at 0, 0 with square bins of {ASSUMED_BIN_M} m: no X and Y that span an area were found at bytes {} (--x-byte and --y-byte, or --bin, state otherwise)",
                homes.iter().map(|[x, y]| format!("{x} and {y}")).collect::<Vec<_>>().join(", ")
            ));
        }
        place
    }
}

fn refuse_angles(code: i32) -> Result<(), SegyProblem> {
    let unit = match code {
        2 => "seconds of arc",
        3 => "decimal degrees",
        4 => "degrees, minutes and seconds",
        _ => return Ok(()),
    };
    Err(SegyProblem::AngularCoordinates { code: code as i16, unit })
}

fn note_fit(coordinates: &Coordinates<'_>, fit: &Placement, unit: LengthUnit, findings: &mut Findings) {
    let [low, high] = coordinates.scalar.range;
    let scalar = match (coordinates.storage, low == high) {
        (Storage::Scaled, true) => format!("scalar {low}"),
        (Storage::Scaled, false) => format!("scalar {low} to {high}"),
        (Storage::Float, _) => "IEEE floats".to_owned(),
    };
    findings.evidence(format!(
        "place: X at byte {} and Y at byte {}, {scalar}; bins of {:.2} by {:.2} {}; X and Y of {} traces lie within {:.3} bin of the lattice (root mean square)",
        coordinates.bytes[0],
        coordinates.bytes[1],
        fit.inline_vector.length(),
        fit.crossline_vector.length(),
        unit.symbol(),
        fit.traces,
        fit.rms_bins
    ));
    if coordinates.storage == Storage::Float {
        findings.assumption(
            "X and Y are IEEE floats without a scalar: as the integers that the standard has, they are no places on Earth".to_owned(),
        );
    } else if low != high {
        findings.warning(format!(
            "the coordinate scalar (byte 71) differs between traces, {low} to {high}; each trace's own is used"
        ));
    } else if !matches!(low.abs(), 0 | 1 | 10 | 100 | 1000 | 10_000) {
        findings.warning(format!("the coordinate scalar (byte 71) is {low}, which is no power of ten; it is applied"));
    }
    if fit.outliers > 0 {
        findings.warning(format!(
            "X and Y of {} traces lie more than {MAX_RESIDUAL_BINS} bin off the lattice, trace {} by {:.1} bins: check the line and coordinate bytes",
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
