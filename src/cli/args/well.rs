//! Arguments for wells.

use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum WellAction {
    /// Read a well: its deviation, and tops, logs and checkshots along it
    #[command(after_help = "Examples:\
                      \n  petroglyph well add north.petro A-1.csv --name A-1 --kb 25 --tops tops.csv --las \
                      A-1.las\
                      \n  petroglyph well add north.petro A-2.dev --name A-2 --head 460000,5930000 --kb 25 \
                      --checkshot A-2.ckb\
                      \n  petroglyph well add mine.petro survey.csv --name DDH-1 --collar collar.csv --tops \
                      lithology.csv\n\
                      \nThe deviation's header names its columns, or --columns does: x, y, tvdss (places, which win); md, \
                      inclination, azimuth (minimum curvature); or dx, dy, tvd. Tops may be intervals (from, to, rock).")]
    Add(Box<WellAddArgs>),
    /// List the wells
    #[command(after_help = "Example:\n  petroglyph well list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Show where a well runs, where its tops lie relative to the horizons, and what was measured along it
    #[command(after_help = "Example:\n  petroglyph well show north.petro A-1")]
    Show {
        /// Project folder
        project: PathBuf,
        /// Well
        name: String,
    },
    /// Give a well another colour, in the block and on sections
    #[command(after_help = "Example:\n  petroglyph well colour north.petro A-1 #c0182c")]
    Colour {
        /// Project folder
        project: PathBuf,
        /// Well
        name: String,
        /// Colour, #rrggbb
        colour: String,
    },
    /// Rename a well
    #[command(after_help = "Example:\n  petroglyph well rename north.petro A-1 \"16/1-9\"")]
    Rename {
        /// Project folder
        project: PathBuf,
        /// Well
        from: String,
        /// New name
        to: String,
    },
    /// Remove a well
    #[command(after_help = "Example:\n  petroglyph well remove north.petro A-1")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Well
        name: String,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct WellAddArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Deviation file
    pub(in crate::cli) deviation: PathBuf,
    /// Name of the well
    #[arg(long)]
    pub(in crate::cli) name: String,
    /// Tops: names and depths
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) tops: Option<PathBuf>,
    /// LAS file (1.2, 2.0 or 3.0); repeat it for several
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) las: Vec<PathBuf>,
    /// Time-depth table: TVDSS and TWT
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) checkshot: Option<PathBuf>,
    /// X, Y of the well head in metres [default: as the deviation says]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub(in crate::cli) head: Option<String>,
    /// Height of the datum (kelly bushing) above sea level in metres [default: as the deviation says]
    #[arg(long = "kb", value_name = "M", allow_hyphen_values = true)]
    pub(in crate::cli) datum_m: Option<f64>,
    /// Collars of drill holes (hole, X, Y, elevation, length), where the deviation is a survey of them
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) collar: Option<PathBuf>,
    /// Columns of the deviation, in order, instead of what it says: md, inc, dip, azi, x, y, dx, dy, tvd, tvdss, z, well,
    /// and - for what is not read
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub(in crate::cli) columns: Option<String>,
    /// Unit of depths whose columns do not state one [default: as the file says, else m]
    #[arg(long, visible_alias = "unit", value_name = "m|ft|usft|km")]
    pub(in crate::cli) md_unit: Option<String>,
    /// Unit of X and Y whose columns do not state one [default: as the file says, else m]
    #[arg(long, value_name = "m|ft|usft|km")]
    pub(in crate::cli) xy_unit: Option<String>,
    /// Name of the well in files that hold several [default: --name]
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) well_in_file: Option<String>,
}
