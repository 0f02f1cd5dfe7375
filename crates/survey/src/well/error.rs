//! Errors in the path of a well or in its time–depth table, with the facts that a user needs to correct them.

use crate::remedy::{Remedy, Setting};

/// Why a path or a time–depth table is invalid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WellError {
    /// Values that must increase do not.
    #[error("the {what} must increase, but {after} follows {before}; sort the file or remove the row")]
    NotIncreasing {
        /// Which values.
        what: &'static str,
        /// The value before.
        before: f64,
        /// The value after.
        after: f64,
    },
    /// An inclination or azimuth is out of range.
    #[error(
        "at {md_m} m the inclination is {inclination_deg} and the azimuth {azimuth_deg} degrees; inclinations \
         are 0 to 180 from the vertical, azimuths 0 to 360 from north"
    )]
    Angle {
        /// Measured depth.
        md_m: f64,
        /// The inclination.
        inclination_deg: f64,
        /// The azimuth.
        azimuth_deg: f64,
    },
    /// The hole turns too sharply between two stations to have been drilled.
    #[error(
        "the hole turns by {dogleg_deg:.0} degrees before {md_m} m, which cannot be drilled; check inclination and azimuth"
    )]
    Dogleg {
        /// Measured depth.
        md_m: f64,
        /// The turn.
        dogleg_deg: f64,
    },
    /// Two stations are further apart than the hole between them is long.
    #[error(
        "before {md_m} m the hole is {along_m:.2} m long but its ends are {straight_m:.2} m apart; check the \
         units of measured depth and of X, Y"
    )]
    ShorterThanStraight {
        /// Measured depth.
        md_m: f64,
        /// Along the hole.
        along_m: f64,
        /// In a straight line.
        straight_m: f64,
    },
    /// A path needs two stations.
    #[error("a path needs two stations, found {stations}; check that the file's rows are the deviation")]
    TooShort {
        /// How many there are.
        stations: usize,
    },
    /// A coordinate is infinite or no number.
    #[error("a coordinate is no number or beyond 1e12; check the units")]
    NotANumber,
}

impl WellError {
    /// What to state so that the numbers become valid, where that may help.
    pub fn remedy(&self) -> Option<Remedy> {
        matches!(self, Self::ShorterThanStraight { .. }).then(|| Setting::MdUnit.stated_as("m or ft"))
    }
}
