//! The arguments of restoring an interpretation.

use clap::Args;
use std::path::PathBuf;

/// `petroglyph restore`.
#[derive(Debug, Args)]
pub(in crate::cli) struct RestoreArgs {
    /// Project folder, which is not changed
    pub(in crate::cli) project: PathBuf,
    /// Project folder to create, usually NAME.petro
    pub(in crate::cli) out: PathBuf,
    /// The horizon that is laid flat; what is younger is taken away
    #[arg(long, value_name = "HORIZON")]
    pub(in crate::cli) to: String,
    /// Lay it on its regional slope, the plane that fits it best by least squares, instead of level
    #[arg(long, conflicts_with = "dip")]
    pub(in crate::cli) regional: bool,
    /// Lay it on a plane that dips by so many degrees in a direction, degrees clockwise from north
    #[arg(long, value_name = "DEGREES,DIRECTION")]
    pub(in crate::cli) dip: Option<String>,
    /// Its depth in the middle of the survey, in the vertical unit [default: the mean of its nodes stays where it is]
    #[arg(long, value_name = "DEPTH", allow_negative_numbers = true)]
    pub(in crate::cli) depth: Option<f64>,
}
