//! Arguments for the series of a block's geological history.

use super::{DrawingArgs, ViewArgs};
use clap::Args;
use std::path::PathBuf;

/// What the name of a page's file says.
fn out() -> String {
    format!("File to write: {}", page::endings_of_pages())
}

#[derive(Debug, Args)]
pub(in crate::cli) struct HistoryArgs {
    /// Project folder, made by `create --history`; any other with --restore
    pub(in crate::cli) project: PathBuf,
    #[arg(help = out())]
    pub(in crate::cli) out: PathBuf,
    /// Events after which the block is shown, counted from 1 and separated by commas; 2.5 is half of the third [default:
    /// every event that changes something visible]
    #[arg(long, value_name = "N", value_delimiter = ',')]
    pub(in crate::cli) stages: Vec<f64>,
    /// Show the block restored to these horizons, as `petroglyph restore` does, oldest first, and then as it is today
    #[arg(long, value_name = "HORIZON", num_args = 1.., conflicts_with = "stages")]
    pub(in crate::cli) restore: Vec<String>,
    /// With --restore: lay horizons on their regional slopes instead of level
    #[arg(long, requires = "restore")]
    pub(in crate::cli) regional: bool,
    /// Named scene of the project, or a TOML file, for all panels [default: the project's first, else a three-quarter view]
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub(in crate::cli) scene: Option<String>,
    /// Size of the page on paper, in centimetres at --dpi [default: 17 wide, and as high as the panels need]
    #[arg(long, value_name = "WxH", conflicts_with = "size")]
    pub(in crate::cli) size_cm: Option<String>,
    /// Resolution of the page, dots per inch
    #[arg(long, value_name = "D", default_value_t = 300.0)]
    pub(in crate::cli) dpi: f64,
    /// Leave the legend out, which lists the rocks of all panels
    #[arg(long)]
    pub(in crate::cli) no_legend: bool,
    /// Draw a north arrow below the panels
    #[arg(long)]
    pub(in crate::cli) north_arrow: bool,
    /// Title above the panels [default: that of the history; "" for none]
    #[arg(long, value_name = "TEXT")]
    pub(in crate::cli) title: Option<String>,
    /// Caption below everything, broken into lines
    #[arg(long, value_name = "TEXT")]
    pub(in crate::cli) caption: Option<String>,
    /// Font file (.ttf, .otf, .ttc) for names in letters that the embedded face lacks; repeat it for several
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) font: Vec<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) drawing: DrawingArgs,
    #[command(flatten)]
    pub(in crate::cli) view: ViewArgs,
}
