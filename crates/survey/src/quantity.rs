//! What the samples of a volume measure.

use serde::{Deserialize, Serialize};
use std::fmt;

/// What the samples of a volume measure. It is stored as its name.
///
/// ```
/// # use survey::Quantity;
/// assert_eq!(Quantity::from("geologic time".to_owned()), Quantity::GeologicTime);
/// assert_eq!(Quantity::from("impedance".to_owned()).to_string(), "impedance");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Quantity {
    /// Relative geologic time: one value along each bed.
    GeologicTime,
    /// Anything else, by its name: "amplitude", "acoustic impedance", …
    Other(String),
}

const GEOLOGIC_TIME: &str = "geologic time";

impl From<String> for Quantity {
    fn from(name: String) -> Self {
        if name == GEOLOGIC_TIME { Self::GeologicTime } else { Self::Other(name) }
    }
}

impl From<Quantity> for String {
    fn from(quantity: Quantity) -> Self {
        quantity.to_string()
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::GeologicTime => GEOLOGIC_TIME,
            Self::Other(name) => name,
        })
    }
}
