//! Arguments for the look of layers, volumes and raw data.

use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum LayerAction {
    /// List the layers, youngest first, with their style
    #[command(after_help = "Example:\n  petroglyph layer list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Change how a layer looks
    #[command(after_help = "Examples:\n  petroglyph layer set north.petro \"A - B\" --name Chalk --pattern chalk\
                      \n  petroglyph layer set north.petro Chalk --rock \"oolitic limestone\" --age Campanian\
                      \n  petroglyph layer set north.petro Chalk --interval 0,0.3,marl --interval 0.3,1,chalk \
                      --frequency 12,3")]
    Set(Box<LayerSetArgs>),
    /// Give a layer its default style again
    #[command(after_help = "Example:\n  petroglyph layer reset north.petro Chalk")]
    Reset {
        /// Project folder
        project: PathBuf,
        /// Layer
        layer: String,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct LayerSetArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Layer, as `layer list` names it
    pub(in crate::cli) layer: String,
    /// New name
    #[arg(long)]
    pub(in crate::cli) name: Option<String>,
    /// Pattern over the whole layer (`petroglyph patterns` draws them all); sets its usual colour, too
    #[arg(long, conflicts_with = "interval")]
    pub(in crate::cli) pattern: Option<String>,
    /// Rock, whose pattern and usual colour the layer takes: a term of the CGI simple lithology vocabulary
    /// (`alkali olivine basalt`), or words that end in one (`oolitic limestone`)
    #[arg(long, value_name = "NAME", conflicts_with_all = ["pattern", "interval"])]
    pub(in crate::cli) rock: Option<String>,
    /// Unit of geological time, whose colour on the international chart the layer takes (`Campanian`)
    #[arg(long, value_name = "NAME", conflicts_with = "colour")]
    pub(in crate::cli) age: Option<String>,
    /// Colour under the pattern
    #[arg(long, value_name = "#RRGGBB")]
    pub(in crate::cli) colour: Option<String>,
    /// Colour of the pattern's lines
    #[arg(long, value_name = "#RRGGBB")]
    pub(in crate::cli) ink: Option<String>,
    /// Repeats of the tile across the block and through the layer
    #[arg(long, value_name = "H,V")]
    pub(in crate::cli) frequency: Option<String>,
    /// Opacity inside a cut-out, 0 to 1
    #[arg(long, value_name = "0..1")]
    pub(in crate::cli) opacity: Option<f32>,
    /// How the pattern runs through the layer: flow (the smoothest way between its horizons, the default but below an
    /// erosion surface, where it is parallel-to-bottom, and above an onlap surface, where it is parallel-to-top),
    /// harmonic (the same by the letter of ∇²k = 0 in the top and bottom layer and between horizons of any shape,
    /// too), distance (the ratio of distances to both, as published; follows every wiggle), proportional (the
    /// vertical fraction), parallel-to-bottom or parallel-to-top
    #[arg(long, value_name = "DEFINITION")]
    pub(in crate::cli) k: Option<String>,
    /// Pattern of a part of the layer's depth, 0 at the base to 1 at the top; repeat it for each part
    #[arg(long, value_name = "LOW,HIGH,PATTERN[,OPACITY]")]
    pub(in crate::cli) interval: Vec<String>,
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum ScalarAction {
    /// List the textures laid over the layers by the values of volumes
    #[command(after_help = "Example:\n  petroglyph scalar list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Lay textures over the layers where a volume's values lie in a range
    #[command(
        after_help = "Example:\n  petroglyph scalar set north.petro impedance --interval -inf,4500,sand,0.6 --interval 9000,inf,dolostone"
    )]
    Set {
        /// Project folder
        project: PathBuf,
        /// Volume
        volume: String,
        /// Range of values, pattern, its opacity, and factors on the layer's frequencies; repeat it for each
        /// range
        #[arg(long, value_name = "LOW,HIGH,PATTERN[,OPACITY[,H,V]]", required = true, allow_hyphen_values = true)]
        interval: Vec<String>,
    },
    /// Remove the textures of a volume
    #[command(after_help = "Example:\n  petroglyph scalar remove north.petro impedance")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Volume
        volume: String,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct RawArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Volume to show [default: the one shown at present, else the first]
    #[arg(long)]
    pub(in crate::cli) volume: Option<String>,
    /// Colour map: seismics, petrel-like, red-white-black, grey, cool-warm, strata
    #[arg(long, default_value = "seismics")]
    pub(in crate::cli) map: String,
    /// Values of the first and the last colour [default: plus and minus the 99th percentile]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true)]
    pub(in crate::cli) range: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct TextureArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// PNG, JPEG or SVG tile; layers refer to it by the file's name without extension
    pub(in crate::cli) file: PathBuf,
    /// Printed width of the tile
    #[arg(long, value_name = "MM")]
    pub(in crate::cli) width_mm: Option<f32>,
}
