//! The numbers that arrays are made of.

use zarrs::array::{DataType, FillValue, data_type};

mod sealed {
    /// What the array library must know of a number.
    pub trait Element: zarrs::array::ElementOwned {
        /// The library's name of the type.
        fn data_type() -> super::DataType;
        /// The value of what was never written.
        fn fill(value: Self) -> super::FillValue;
    }
}

/// A number that arrays are made of.
pub trait StoredSample: sealed::Element + bytemuck::Pod + Send + Sync + PartialEq {
    /// Name of the type as Zarr spells it.
    const TYPE: &'static str;
    /// Value of what was never written: NaN, or 0 for integers.
    const FILL: Self;
    /// The value as float.
    fn to_f32(self) -> f32;
    /// The nearest value to a float; NaN becomes the fill value.
    fn from_f32(value: f32) -> Self;
}

macro_rules! stored_integer {
    ($type:ident, $name:ident) => {
        impl sealed::Element for $type {
            fn data_type() -> DataType {
                data_type::$name()
            }
            fn fill(value: Self) -> FillValue {
                value.into()
            }
        }
        impl StoredSample for $type {
            const TYPE: &'static str = stringify!($name);
            const FILL: Self = 0;
            fn to_f32(self) -> f32 {
                self as f32
            }
            fn from_f32(value: f32) -> Self {
                // The cast saturates and sends NaN to 0.
                value.round() as Self
            }
        }
    };
}

stored_integer!(i8, int8);
stored_integer!(u8, uint8);
stored_integer!(i16, int16);
stored_integer!(u16, uint16);
stored_integer!(i32, int32);
stored_integer!(u32, uint32);

impl sealed::Element for f32 {
    fn data_type() -> DataType {
        data_type::float32()
    }
    fn fill(value: Self) -> FillValue {
        value.into()
    }
}

impl StoredSample for f32 {
    const TYPE: &'static str = "float32";
    const FILL: Self = Self::NAN;
    fn to_f32(self) -> f32 {
        self
    }
    fn from_f32(value: f32) -> Self {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_become_the_nearest_integer_without_wrapping() {
        assert_eq!(i8::from_f32(1000.0), 127);
        assert_eq!(i8::from_f32(-2.5), -3);
        assert_eq!(u16::from_f32(f32::NAN), 0);
        assert_eq!(f32::from_f32(0.25), 0.25);
    }
}
