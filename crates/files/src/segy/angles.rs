//! X and Y that are angles, by what byte 89 says or by their size, and lengths that are called angles.

use super::columns::HeaderColumn;
use super::error::SegyProblem;
use super::info::Findings;
use super::place::FittedPlace;
use survey::remedy::{Note, Remedy, Setting};

/// A degree of latitude on the ground, m.
const DEGREE_M: f64 = 111_000.0;

/// Sides of bins that surveys in angles have, m: a degree of longitude may be half as long as one of latitude, or less.
const BIN_M: std::ops::RangeInclusive<f64> = 1.0..=3000.0;

/// A unit of angles.
pub(super) struct Angles {
    /// Byte 89.
    code: i32,
    unit: &'static str,
    /// The largest number that is an angle.
    largest: f64,
    /// What one of them is on the ground, m.
    metres: f64,
}

const DEGREES: Angles = Angles { code: 3, unit: "decimal degrees", largest: 360.0, metres: DEGREE_M };

impl Angles {
    /// What the codes at byte 89 mean; none if they are no unit of angles.
    pub(super) fn of(codes: &HeaderColumn) -> Option<Self> {
        let of = |code: i32| match code {
            2 => Some(Self { code, unit: "seconds of arc", largest: 1_296_000.0, metres: DEGREE_M / 3600.0 }),
            3 => Some(DEGREES),
            // Written as DDDMMSS, where most neighbours differ by seconds.
            4 => Some(Self {
                code,
                unit: "degrees, minutes and seconds",
                largest: 3_600_000.0,
                metres: DEGREE_M / 3600.0,
            }),
            _ => None,
        };
        match codes.constant() {
            Some(code) => of(code),
            None => codes.iter().find_map(of),
        }
    }

    /// Whether X and Y, of which the largest is `reach`, can be these angles.
    fn fit(&self, reach: f64, fit: &FittedPlace) -> bool {
        let sides = [fit.inline_vector, fit.crossline_vector].map(|side| side.length() * self.metres);
        reach <= self.largest && sides.iter().all(|side| BIN_M.contains(side))
    }

    /// Refuses X and Y unless they cannot be angles, or not those of a survey.
    pub(super) fn must_be_lengths(
        &self,
        reach: f64,
        fit: &FittedPlace,
        findings: &mut Findings,
    ) -> Result<(), SegyProblem> {
        let Self { code, unit, .. } = *self;
        if self.fit(reach, fit) {
            return Err(SegyProblem::AngularCoordinates { code: code as i16, unit });
        }
        let why = if reach > self.largest {
            format!("X and Y reach {reach:.0}, which no angle does")
        } else {
            "as angles they would make bins that no survey has".to_owned()
        };
        findings.warning(Note::unless(
            format!("byte 89 is {code}, {unit}, but {why}; they are taken as lengths"),
            Remedy::any([Setting::CoordinateUnit.stated(), Setting::Bin.stated()]),
        ));
        Ok(())
    }
}

/// Whether X and Y, as lengths no survey, would be one in degrees.
pub(super) fn look_like_degrees(reach: f64, fit: &FittedPlace) -> bool {
    DEGREES.fit(reach, fit)
}

/// Codes that the standard does not have.
pub(super) fn note_unknown_units(codes: &HeaderColumn, findings: &mut Findings) {
    if let Some(code) = codes.iter().find(|code| !(0..=1).contains(code)) {
        findings.warning(format!(
            "byte 89 holds {code}, which is no unit of coordinates (1 is length); X and Y are taken as lengths"
        ));
    }
}
