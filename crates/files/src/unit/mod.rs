//! Units of a file: of its vertical values, of X and Y and of lengths along wells; time or depth; and the direction in
//! which vertical values grow.
//!
//! [`words`] is the only place that reads units out of text.

pub(crate) mod words;

use serde::{Deserialize, Serialize};
use survey::geometry::VerticalUnit;

/// Metres in an international foot.
pub(crate) const FOOT_M: f64 = 0.3048;
/// Metres in a US survey foot.
pub(crate) const SURVEY_FOOT_M: f64 = 1200.0 / 3937.0;

/// A unit of vertical values or of lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ZUnit {
    /// Two-way time, milliseconds.
    #[serde(rename = "ms")]
    Milliseconds,
    /// Two-way time, seconds.
    #[serde(rename = "s")]
    Seconds,
    /// Two-way time, microseconds.
    #[serde(rename = "us")]
    Microseconds,
    /// Metres.
    #[serde(rename = "m")]
    Metres,
    /// Kilometres.
    #[serde(rename = "km")]
    Kilometres,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetres,
    /// International feet, 0.3048 m.
    #[serde(rename = "ft")]
    Feet,
    /// US survey feet, 1200/3937 m.
    #[serde(rename = "usft")]
    SurveyFeet,
    /// Inches.
    #[serde(rename = "in")]
    Inches,
}

impl ZUnit {
    /// Every unit.
    pub const ALL: [Self; 9] = [
        Self::Milliseconds,
        Self::Seconds,
        Self::Microseconds,
        Self::Metres,
        Self::Kilometres,
        Self::Centimetres,
        Self::Feet,
        Self::SurveyFeet,
        Self::Inches,
    ];

    /// The lengths in which places are given.
    pub const LENGTHS: [Self; 4] = [Self::Metres, Self::Feet, Self::SurveyFeet, Self::Kilometres];

    /// The unit's symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Milliseconds => "ms",
            Self::Seconds => "s",
            Self::Microseconds => "us",
            Self::Metres => "m",
            Self::Kilometres => "km",
            Self::Centimetres => "cm",
            Self::Feet => "ft",
            Self::SurveyFeet => "usft",
            Self::Inches => "in",
        }
    }

    /// Milliseconds or metres in one of it.
    ///
    /// ```
    /// # use files::ZUnit;
    /// assert_eq!(ZUnit::Seconds.in_survey(), 1000.0);
    /// assert_eq!(3937.0 * ZUnit::SurveyFeet.in_survey(), 1200.0);
    /// ```
    pub fn in_survey(self) -> f64 {
        match self {
            Self::Milliseconds | Self::Metres => 1.0,
            Self::Seconds | Self::Kilometres => 1000.0,
            Self::Microseconds => 0.001,
            Self::Centimetres => 0.01,
            Self::Feet => FOOT_M,
            Self::SurveyFeet => SURVEY_FOOT_M,
            Self::Inches => 0.0254,
        }
    }

    /// Whether it is a unit of time.
    pub fn is_time(self) -> bool {
        matches!(self, Self::Milliseconds | Self::Seconds | Self::Microseconds)
    }

    /// Reads a unit's symbol or name, in any spelling; `None` when it is no unit.
    ///
    /// ```
    /// # use files::ZUnit;
    /// assert_eq!(ZUnit::parse("Milliseconds"), Some(ZUnit::Milliseconds));
    /// assert_eq!(ZUnit::parse("US Survey Feet"), Some(ZUnit::SurveyFeet));
    /// assert_eq!(ZUnit::parse("furlong"), None);
    /// ```
    pub fn parse(text: &str) -> Option<Self> {
        words::unit_of(text)
    }
}

/// The direction in which vertical values grow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ZPositive {
    /// Larger values are deeper or later.
    Down,
    /// Larger values are higher: elevations, negative times.
    Up,
}

impl ZPositive {
    /// "down" or "up".
    pub fn word(self) -> &'static str {
        match self {
            Self::Down => "down",
            Self::Up => "up",
        }
    }
}

/// The domain, if the name of a column states no more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Domain {
    Time,
    Depth,
}

impl Domain {
    pub(crate) fn of(unit: VerticalUnit) -> Self {
        match unit {
            VerticalUnit::Milliseconds => Self::Time,
            VerticalUnit::Metres => Self::Depth,
        }
    }

    /// That of values in a unit.
    pub(crate) fn of_unit(unit: ZUnit) -> Self {
        if unit.is_time() { Self::Time } else { Self::Depth }
    }
}
