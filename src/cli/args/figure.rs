//! Arguments for figures: pages of sections, maps and blocks, with legends and scale bars.

use clap::Args;
use std::path::PathBuf;

/// What is on a page, and how large it is. Several sections, a map, wells and `--block` share one page.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Figures")]
pub(in crate::cli) struct FigureArgs {
    /// Section along this inline; repeat it for several
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(in crate::cli) inline: Vec<f64>,
    /// Section along this crossline; repeat it for several
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(in crate::cli) crossline: Vec<f64>,
    /// Horizontal section at this time or depth; repeat it for several
    #[arg(long, value_name = "Z", allow_hyphen_values = true)]
    pub(in crate::cli) slice: Vec<f64>,
    /// Proportions of sections along inlines and crosslines, vertical to horizontal [default: they fill their room]
    #[arg(long, value_name = "FACTOR")]
    pub(in crate::cli) proportions: Option<f64>,
    /// What sections and fences show: 0 the rock with its patterns, 1 measured data, or a mixture [default: measured data
    /// where there are some]
    #[arg(long, value_name = "BLEND")]
    pub(in crate::cli) section_blend: Option<f32>,
    /// Section along a line with these corners, two or more
    #[arg(long, value_name = "INLINE,CROSSLINE", num_args = 2..)]
    pub(in crate::cli) fence: Vec<String>,
    /// Map of a horizon: its depth or time in colours and contours
    #[arg(long, value_name = "HORIZON")]
    pub(in crate::cli) map: Option<String>,
    /// Map the thickness from the horizon of --map down to this one instead
    #[arg(long, value_name = "HORIZON", requires = "map")]
    pub(in crate::cli) thickness_to: Option<String>,
    /// Wells side by side, their tops joined by lines: from left to right, or all wells of the project in its order
    #[arg(long, value_name = "WELL", num_args = 0..)]
    pub(in crate::cli) correlation: Option<Vec<String>>,
    /// Draw the wells of --correlation so that this top or horizon is level
    #[arg(long, value_name = "NAME", requires = "correlation")]
    pub(in crate::cli) datum: Option<String>,
    /// Curve beside each well of --correlation, or none; repeat it for several [default: the one that most wells have]
    #[arg(long, value_name = "NAME|none", requires = "correlation")]
    pub(in crate::cli) log: Vec<String>,
    /// First and last depth or time of --correlation, from --datum if there is one [default: whole wells]
    #[arg(long, value_name = "FROM,TO", requires = "correlation", allow_hyphen_values = true)]
    pub(in crate::cli) well_range: Option<String>,
    /// Throw of a fault against the distance along it, horizon by horizon; repeat it for several faults
    #[arg(long, value_name = "FAULT")]
    pub(in crate::cli) throw: Vec<String>,
    /// State the heave of faults beside their throw, on blocks and sections, and draw it below --throw
    #[arg(long)]
    pub(in crate::cli) heave: bool,
    /// Add the block, beside the sections or the map that were asked for
    #[arg(long)]
    pub(in crate::cli) block: bool,
    /// Two blocks compared: their blends, 0 = illustrated to 1 = raw
    #[arg(long, value_name = "BLEND,BLEND")]
    pub(in crate::cli) compare: Option<String>,
    /// Lay the two blocks over one another, divided at this share of the width, instead of side by side
    #[arg(long, value_name = "0..1", requires = "compare")]
    pub(in crate::cli) wipe: Option<f64>,
    /// Show what an interpreter sees: horizons as they were picked with dotted holes, faults, proposals and
    /// sticks
    #[arg(long)]
    pub(in crate::cli) interpretation: bool,
    /// List the layers with their patterns, or the horizons with their colours
    #[arg(long)]
    pub(in crate::cli) legend: bool,
    /// Draw scale bars and state the vertical exaggeration
    #[arg(long)]
    pub(in crate::cli) scale_bar: bool,
    /// Draw a north arrow below the block, as it lies in the block's middle
    #[arg(long)]
    pub(in crate::cli) north_arrow: bool,
    /// Write on blocks and sections: axes (inlines, crosslines, depth or time along the edges), layers (names along the
    /// layers), faults (names, throw, half-arrows), heave (beside the throw), wells (names of wells and tops), quality (horizons dashed
    /// where they were filled, in short dashes with question marks where they were only continued), colours (a bar of the
    /// raw data's values), provenance (program, project, --credit); all adds the legend, the scale bars and the north arrow
    #[arg(long, value_name = "all|axes,layers,faults,heave,wells,quality,colours,provenance", value_delimiter = ',')]
    pub(in crate::cli) annotate: Vec<String>,
    /// Whose data the figure shows, for the line of provenance
    #[arg(long, value_name = "TEXT")]
    pub(in crate::cli) credit: Option<String>,
    /// Font file (.ttf, .otf, .ttc) for names in letters that the embedded face lacks, such as Arabic or Chinese; repeat
    /// it for several. NAME.ttc#2 is the third face of a collection
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) font: Vec<PathBuf>,
    /// Title above the figure
    #[arg(long, value_name = "TEXT")]
    pub(in crate::cli) title: Option<String>,
    /// Caption below the figure, broken into lines
    #[arg(long, value_name = "TEXT")]
    pub(in crate::cli) caption: Option<String>,
    /// Size of the page on paper, in centimetres at --dpi
    #[arg(long, value_name = "WxH", conflicts_with = "size")]
    pub(in crate::cli) size_cm: Option<String>,
    /// TOML file that says what the page shows, instead of the other options of the page
    #[arg(
        long,
        value_name = "FILE.toml",
        conflicts_with_all = [
            "inline", "crossline", "slice", "section_blend", "fence", "map", "correlation", "throw", "heave", "block", "compare", "size_cm", "interpretation", "legend",
            "scale_bar", "north_arrow", "annotate", "credit", "title", "caption",
        ]
    )]
    pub(in crate::cli) figure: Option<PathBuf>,
}
