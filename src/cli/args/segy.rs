//! Arguments for a SEG-Y file.

use clap::Args;

/// What the user states about a SEG-Y file; `info` shows what is found without any statement.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Options of SEG-Y files")]
pub(in crate::cli) struct SegyArgs {
    /// Trace header byte of the inline number
    #[arg(long, value_name = "B")]
    pub(in crate::cli) inline_byte: Option<u16>,
    /// Trace header byte of the crossline number
    #[arg(long, value_name = "B")]
    pub(in crate::cli) crossline_byte: Option<u16>,
    /// How line numbers are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else what is found]
    #[arg(long, value_name = "TYPE")]
    pub(in crate::cli) line_type: Option<String>,
    /// Where line numbers come from: headers, coordinates (the lattice of X and Y, numbered from 1) or
    /// coordinates-swapped [default: headers]
    #[arg(long, value_name = "SOURCE")]
    pub(in crate::cli) line_numbers: Option<String>,
    /// Trace header byte of X
    #[arg(long, value_name = "B")]
    pub(in crate::cli) x_byte: Option<u16>,
    /// Trace header byte of Y
    #[arg(long, value_name = "B")]
    pub(in crate::cli) y_byte: Option<u16>,
    /// How X and Y are stored: i32, i16, u16, f32, f64 or ibm32 [default: i32, else f32 if that gives valid
    /// places]
    #[arg(long, value_name = "TYPE")]
    pub(in crate::cli) coordinate_type: Option<String>,
    /// Trace header byte of the coordinate scalar [default: 71]
    #[arg(long, value_name = "B", conflicts_with = "coordinate_scalar")]
    pub(in crate::cli) scalar_byte: Option<u16>,
    /// Coordinate scalar, whatever the file holds: 10 multiplies by ten, -10 divides
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(in crate::cli) coordinate_scalar: Option<i16>,
    /// Byte order: big or little
    #[arg(long, value_name = "big|little")]
    pub(in crate::cli) byte_order: Option<String>,
    /// Sample format, whatever the header says: ibm32, ieee32, ieee64, int8, int16, int24, int32, int64,
    /// uint8, ...
    #[arg(long, value_name = "FORMAT")]
    pub(in crate::cli) sample_format: Option<String>,
    /// Amplitude that stands for no data, or none [default: found by evidence]
    #[arg(long, value_name = "V|none", allow_hyphen_values = true)]
    pub(in crate::cli) null_amplitude: Option<String>,
    /// Sample interval, in the vertical unit
    #[arg(long, value_name = "STEP", allow_hyphen_values = true)]
    pub(in crate::cli) interval: Option<f64>,
    /// Value of the first sample, in the vertical unit
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub(in crate::cli) start: Option<f64>,
    /// Vertical unit: ms, m or ft
    #[arg(long = "vertical-unit", value_name = "UNIT")]
    pub(in crate::cli) vertical_unit: Option<String>,
    /// Unit of X and Y: m or ft
    #[arg(long, value_name = "UNIT")]
    pub(in crate::cli) coordinate_unit: Option<String>,
    /// Ignore X and Y: square bins of this size in metres, from 0, 0
    #[arg(long = "bin", value_name = "M", allow_hyphen_values = true)]
    pub(in crate::cli) bin_m: Option<f64>,
    /// Trace weight N at byte 169: apply (2^-N, the standard), inverse (2^N) or ignore [default: apply]
    #[arg(long, value_name = "WORD")]
    pub(in crate::cli) trace_weight: Option<String>,
    /// Which of several traces at one place to keep: first or last [default: first, if they are few]
    #[arg(long, value_name = "first|last")]
    pub(in crate::cli) duplicates: Option<String>,
}
