//! How line numbers and coordinates are stored in a trace header.

use serde::{Deserialize, Serialize};

/// How a number is stored in a trace header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NumberType {
    /// Two's complement integer, 4 bytes; the standard's.
    #[default]
    I32,
    /// Two's complement integer, 2 bytes.
    I16,
    /// Unsigned integer, 2 bytes.
    U16,
    /// IEEE float, 4 bytes.
    F32,
    /// IEEE float, 8 bytes.
    F64,
    /// IBM float, 4 bytes.
    Ibm32,
}

impl NumberType {
    /// Every type.
    pub const ALL: [Self; 6] = [Self::I32, Self::I16, Self::U16, Self::F32, Self::F64, Self::Ibm32];

    /// The word of `--line-type` and `--coordinate-type`.
    pub fn name(self) -> &'static str {
        match self {
            Self::I32 => "i32",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Ibm32 => "ibm32",
        }
    }

    /// Bytes it takes.
    pub fn bytes(self) -> usize {
        match self {
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::F32 | Self::Ibm32 => 4,
            Self::F64 => 8,
        }
    }
}
