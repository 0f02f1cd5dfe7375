//! Arguments for animations.

use super::{DrawingArgs, ViewArgs};
use clap::Args;
use page::{FileFormat, endings};
use std::path::PathBuf;

/// What the name of an animation says.
fn out() -> String {
    let frame = |number: u32| format!("{number:04}.{}", FileFormat::usual().ending());
    format!(
        "File to write ({}), or a new folder for numbered frames ({}, {}, …), from which other programs make films",
        endings(FileFormat::animations()),
        frame(1),
        frame(2)
    )
}

#[derive(Debug, Args)]
pub(in crate::cli) struct AnimateArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    #[arg(help = out())]
    pub(in crate::cli) out: PathBuf,
    /// Named scene of the project to start from, or a TOML file [default: the project's first, else a three-quarter view]
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub(in crate::cli) scene: Option<String>,
    /// What moves: the camera around the block, the blend from illustration to raw data, a section through the block, the
    /// block through its geological history (create --history), or everything from the scene to that of --to
    #[arg(long, value_name = "turntable|blend|section|history|scenes", default_value = "turntable")]
    pub(in crate::cli) motion: String,
    /// Degrees that the camera turns, clockwise seen from above; negative: the other way around
    #[arg(long, value_name = "DEG", default_value_t = 360.0, allow_hyphen_values = true)]
    pub(in crate::cli) turn: f64,
    /// Direction in which the section moves: across inlines, across crosslines, or down
    #[arg(long, value_name = "inline|crossline|slice", default_value = "inline")]
    pub(in crate::cli) along: String,
    /// Scene that the motion leads to, a name or a TOML file; it means --motion scenes
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub(in crate::cli) to: Option<String>,
    /// Number of frames, 2 to 2000
    #[arg(long, value_name = "N", default_value_t = 48)]
    pub(in crate::cli) frames: u32,
    /// Frames a second, 0.1 to 50
    #[arg(long, value_name = "RATE", default_value_t = 12.0)]
    pub(in crate::cli) rate: f64,
    /// End at the end: otherwise all but whole turns and histories go back to the beginning in the second half of the frames
    #[arg(long)]
    pub(in crate::cli) once: bool,
    #[command(flatten)]
    pub(in crate::cli) drawing: DrawingArgs,
    #[command(flatten)]
    pub(in crate::cli) view: ViewArgs,
}
