//! The numeric types of arrays.

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

/// A numeric type that the elements of an array may have.
pub trait StoredSample: PartialEq + Send + Sync + sealed::Element + bytemuck::Pod {
    /// Value of what was never written: NaN, or 0 for integers.
    const FILL: Self;
    /// The type's name as Zarr spells it.
    const NAME: &'static str;
}

macro_rules! stored {
    ($type:ident, $name:ident, $fill:expr) => {
        impl sealed::Element for $type {
            fn data_type() -> DataType {
                data_type::$name()
            }
            fn fill(value: Self) -> FillValue {
                value.into()
            }
        }
        impl StoredSample for $type {
            const FILL: Self = $fill;
            const NAME: &'static str = stringify!($name);
        }
    };
}

stored!(i8, int8, 0);
stored!(u8, uint8, 0);
stored!(i16, int16, 0);
stored!(u16, uint16, 0);
stored!(i32, int32, 0);
stored!(u32, uint32, 0);
stored!(f32, float32, f32::NAN);
stored!(f64, float64, f64::NAN);
