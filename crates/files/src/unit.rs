//! The vertical values of a file: their unit, time or depth, and the direction in which they grow.

use serde::{Deserialize, Serialize};
use survey::geometry::VerticalUnit;

/// Vertical unit of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ZUnit {
    /// Two-way time, milliseconds.
    #[serde(rename = "ms")]
    Milliseconds,
    /// Two-way time, seconds.
    #[serde(rename = "s")]
    Seconds,
    /// Depth, metres.
    #[serde(rename = "m")]
    Metres,
    /// Depth, international feet.
    #[serde(rename = "ft")]
    Feet,
}

impl ZUnit {
    /// The unit's symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Milliseconds => "ms",
            Self::Seconds => "s",
            Self::Metres => "m",
            Self::Feet => "ft",
        }
    }

    /// Reads a unit's symbol or name; `None` when it is none of the four.
    ///
    /// ```
    /// # use files::ZUnit;
    /// assert_eq!(ZUnit::parse("Milliseconds"), Some(ZUnit::Milliseconds));
    /// assert_eq!(ZUnit::parse("ft"), Some(ZUnit::Feet));
    /// assert_eq!(ZUnit::parse("furlong"), None);
    /// ```
    pub fn parse(text: &str) -> Option<Self> {
        match text.trim().to_ascii_lowercase().as_str() {
            "ms" | "msec" | "msecs" | "millisecond" | "milliseconds" => Some(Self::Milliseconds),
            "s" | "sec" | "secs" | "second" | "seconds" => Some(Self::Seconds),
            "m" | "meter" | "meters" | "metre" | "metres" => Some(Self::Metres),
            "ft" | "feet" | "foot" => Some(Self::Feet),
            _ => None,
        }
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
}
