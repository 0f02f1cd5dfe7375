//! The numeric types of samples.

/// The numeric type of the samples of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleType {
    /// Integers of one byte.
    Int8,
    /// Integers of one byte, unsigned.
    Uint8,
    /// Integers of two bytes.
    Int16,
    /// Integers of two bytes, unsigned.
    Uint16,
    /// Integers of four bytes.
    Int32,
    /// Integers of four bytes, unsigned.
    Uint32,
    /// IEEE floats of four bytes.
    Float32,
}

impl SampleType {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Int8, Self::Uint8, Self::Int16, Self::Uint16, Self::Int32, Self::Uint32, Self::Float32];

    /// The type of a name, as Zarr spells it.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.name() == name)
    }

    /// Bytes of a sample.
    pub const fn bytes(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float32 => 4,
        }
    }

    /// Its name as Zarr spells it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Int8 => "int8",
            Self::Uint8 => "uint8",
            Self::Int16 => "int16",
            Self::Uint16 => "uint16",
            Self::Int32 => "int32",
            Self::Uint32 => "uint32",
            Self::Float32 => "float32",
        }
    }
}

/// A mutable slice of samples of one of the types.
#[derive(Debug, PartialEq)]
pub enum SamplesMut<'a> {
    /// Of [`SampleType::Int8`].
    Int8(&'a mut [i8]),
    /// Of [`SampleType::Uint8`].
    Uint8(&'a mut [u8]),
    /// Of [`SampleType::Int16`].
    Int16(&'a mut [i16]),
    /// Of [`SampleType::Uint16`].
    Uint16(&'a mut [u16]),
    /// Of [`SampleType::Int32`].
    Int32(&'a mut [i32]),
    /// Of [`SampleType::Uint32`].
    Uint32(&'a mut [u32]),
    /// Of [`SampleType::Float32`].
    Float32(&'a mut [f32]),
}

/// Evaluates an expression on the slice in [`SamplesMut`], whatever its type: what is generic then stands once.
///
/// ```
/// # use survey::sample::{Sample, SamplesMut};
/// fn set<T: Sample>(out: &mut [T], value: f32) {
///     out.fill(T::from_f32(value));
/// }
/// let mut values = [0i16; 2];
/// let out = SamplesMut::Int16(&mut values);
/// survey::of_any_type!(out, |samples| set(samples, 7.0));
/// assert_eq!(values, [7, 7]);
/// ```
#[macro_export]
macro_rules! of_any_type {
    ($out:expr, |$samples:ident| $body:expr) => {
        match $out {
            $crate::sample::SamplesMut::Int8($samples) => $body,
            $crate::sample::SamplesMut::Uint8($samples) => $body,
            $crate::sample::SamplesMut::Int16($samples) => $body,
            $crate::sample::SamplesMut::Uint16($samples) => $body,
            $crate::sample::SamplesMut::Int32($samples) => $body,
            $crate::sample::SamplesMut::Uint32($samples) => $body,
            $crate::sample::SamplesMut::Float32($samples) => $body,
        }
    };
}

/// A numeric type that samples of a volume may have.
///
/// ```
/// # use survey::sample::{Sample, SampleType};
/// assert_eq!(<i8 as Sample>::TYPE, SampleType::Int8);
/// assert_eq!(i8::from_f32(200.0), 127);
/// assert_eq!(i16::from_f32(f32::NAN), 0);
/// assert_eq!(u8::to_f32(7), 7.0);
/// ```
pub trait Sample: Copy + Default + Send + Sync + PartialEq + 'static {
    /// Its type.
    const TYPE: SampleType;
    /// The value as float.
    fn to_f32(self) -> f32;
    /// The value nearest to a float; NaN becomes 0 in types that have no NaN.
    fn from_f32(value: f32) -> Self;
    /// The slice, tagged with its type.
    fn slots(slots: &mut [Self]) -> SamplesMut<'_>;
}

macro_rules! integer_sample {
    ($type:ident, $variant:ident) => {
        impl Sample for $type {
            const TYPE: SampleType = SampleType::$variant;
            #[inline]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline]
            fn from_f32(value: f32) -> Self {
                // The cast saturates and sends NaN to 0.
                value.round() as Self
            }
            #[inline]
            fn slots(slots: &mut [Self]) -> SamplesMut<'_> {
                SamplesMut::$variant(slots)
            }
        }
    };
}

integer_sample!(i8, Int8);
integer_sample!(u8, Uint8);
integer_sample!(i16, Int16);
integer_sample!(u16, Uint16);
integer_sample!(i32, Int32);
integer_sample!(u32, Uint32);

impl Sample for f32 {
    const TYPE: SampleType = SampleType::Float32;
    #[inline]
    fn to_f32(self) -> f32 {
        self
    }
    #[inline]
    fn from_f32(value: f32) -> Self {
        value
    }
    #[inline]
    fn slots(slots: &mut [Self]) -> SamplesMut<'_> {
        SamplesMut::Float32(slots)
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
