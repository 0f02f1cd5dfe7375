//! Arguments for scenes.

use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum SceneAction {
    /// List the named scenes
    #[command(after_help = "Example:\n  petroglyph scene list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Save a scene under a name
    #[command(after_help = "Examples:\
                      \n  petroglyph scene add north.petro corner --cut nearest,0.5,0.4 --azimuth 30 \
                      --exaggeration 2\n  petroglyph scene add north.petro figure3 --from figure3.toml")]
    Add(Box<SceneAddArgs>),
    /// Print a scene as TOML, to edit and give to `render --scene` or `scene add --from`
    #[command(after_help = "Example:\n  petroglyph scene show north.petro corner > corner.toml")]
    Show {
        /// Project folder
        project: PathBuf,
        /// Name of the scene [default: the one that `render` starts from]
        name: Option<String>,
    },
    /// Rename a scene
    #[command(after_help = "Example:\n  petroglyph scene rename north.petro corner \"Corner cut away\"")]
    Rename {
        /// Project folder
        project: PathBuf,
        /// Name of the scene
        from: String,
        /// New name
        to: String,
    },
    /// Remove a scene
    #[command(after_help = "Example:\n  petroglyph scene remove north.petro corner")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Name of the scene
        name: String,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct SceneAddArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Name of the scene
    pub(in crate::cli) name: String,
    /// TOML file to start from, as `scene show` prints it
    #[arg(long, value_name = "FILE.toml")]
    pub(in crate::cli) from: Option<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) view: ViewArgs,
}

/// Changes to a scene.
#[derive(Debug, Default, Args)]
pub(in crate::cli) struct ViewArgs {
    /// Size of the image in pixels
    #[arg(long, value_name = "WxH")]
    pub(in crate::cli) size: Option<String>,
    /// Blend from 0 = illustrative to 1 = raw data
    #[arg(long, value_name = "0..1")]
    pub(in crate::cli) blend: Option<f32>,
    /// How layer coordinates are looked up: exact, or the packed volume of the published method
    #[arg(long, value_name = "exact|packed")]
    pub(in crate::cli) lookup: Option<String>,
    /// Vertical exaggeration
    #[arg(long, value_name = "FACTOR")]
    pub(in crate::cli) exaggeration: Option<f64>,
    /// Bearing in which the camera looks, degrees clockwise from north
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(in crate::cli) azimuth: Option<f64>,
    /// Height of the camera above the horizontal, degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub(in crate::cli) elevation: Option<f64>,
    /// Use a perspective with this opening angle instead of a parallel projection
    #[arg(long, value_name = "DEG")]
    pub(in crate::cli) perspective: Option<f64>,
    /// Magnification, as a factor on the scale at which the block fits the image
    #[arg(long, value_name = "FACTOR")]
    pub(in crate::cli) zoom: Option<f64>,
    /// Show only this part of the survey: inlines, crosslines, vertical values
    #[arg(long = "box", value_name = "IL0,IL1,XL0,XL1,Z0,Z1", allow_hyphen_values = true)]
    pub(in crate::cli) roaming_box: Option<String>,
    /// Cut a corner off over the whole height: nearest, min-min, min-max, max-min or max-max (first and last
    /// inline, crossline), and the share of the block's length along inlines and crosslines; repeat it for
    /// several
    #[arg(long, value_name = "CORNER[,SHARE,SHARE]")]
    pub(in crate::cli) cut: Vec<String>,
    /// Cut a box out; repeat it for several
    #[arg(long, value_name = "IL0,IL1,XL0,XL1,Z0,Z1", allow_hyphen_values = true)]
    pub(in crate::cli) cut_box: Vec<String>,
    /// Cut everything away that lies before a wall on a line with these corners, two or more: line numbers, or
    /// well:NAME for the head of a well. The line's ends go on straight
    #[arg(long, value_name = "IL,XL|well:NAME", num_args = 2.., allow_hyphen_values = false)]
    pub(in crate::cli) cut_fence: Vec<String>,
    /// The side of --cut-fence that is cut away, seen along the line on a map with inlines' indices to the right and
    /// crosslines' upwards [default: the viewer's]
    #[arg(long, value_name = "left|right", requires = "cut_fence")]
    pub(in crate::cli) cut_side: Option<String>,
    /// Lead a curve through the corners of --cut-fence
    #[arg(long, requires = "cut_fence")]
    pub(in crate::cli) cut_smooth: bool,
    /// Cut a round shaft: inline, crossline, radius in metres; repeat it for several
    #[arg(long, value_name = "IL,XL,RADIUS_M", allow_hyphen_values = true)]
    pub(in crate::cli) cut_round: Vec<String>,
    /// Limit --cut-fence and --cut-round to these vertical values
    #[arg(long, value_name = "Z0,Z1", allow_hyphen_values = true)]
    pub(in crate::cli) cut_depth: Option<String>,
    /// Cut everything away above a plane through a place: inline, crossline, vertical value, bearing of its dip and
    /// dip in degrees; repeat it for several
    #[arg(long, value_name = "IL,XL,Z,BEARING,DIP", allow_hyphen_values = true)]
    pub(in crate::cli) cut_plane: Vec<String>,
    /// Show the relief of the topmost horizon instead of a flat top
    #[arg(long, value_name = "on|off")]
    pub(in crate::cli) ground: Option<String>,
    /// Opacity of that relief
    #[arg(long, value_name = "0..1")]
    pub(in crate::cli) ground_opacity: Option<f32>,
    /// Fill what lies above that relief with water, up to this depth or time, to which the block reaches at least; ground
    /// above it stays dry; `off`: air
    #[arg(long, value_name = "LEVEL|off", allow_hyphen_values = true)]
    pub(in crate::cli) water: Option<String>,
    /// What faces show: the rock, the leaves of horizon candidates in colours, the distance to the nearest
    /// candidate, or how much patterns are distorted (white: not; blue: too dense or narrow; orange: too
    /// sparse or wide), with the shares of area printed. In volume rendering, leaves colour the horizons
    /// shown, or all candidates
    #[arg(long, value_name = "rock|leaves|distance|distortion")]
    pub(in crate::cli) show: Option<String>,
    /// Colour leaves by the node this many levels up their surface tree; 0 = the leaf itself. Shows leaves
    /// unless --show says otherwise
    #[arg(long, value_name = "N")]
    pub(in crate::cli) level: Option<u32>,
    /// Draw lines along horizons, faults and edges; dashed: dashed on the block where a horizon was not picked, but
    /// filled or extrapolated (sections and fences always are)
    #[arg(long, value_name = "on|dashed|off")]
    pub(in crate::cli) outlines: Option<String>,
    /// Factor on the frequency of every pattern
    #[arg(long, value_name = "FACTOR")]
    pub(in crate::cli) global_frequency: Option<f32>,
    /// What patterns are fixed to in a close-up: to the rock, so that they grow with it, or to the paper, so that they
    /// keep the size that they have where the whole survey fits the picture
    #[arg(long, value_name = "rock|paper")]
    pub(in crate::cli) pattern_size: Option<String>,
    /// Colours, black patterns on white, or shades of grey. What is measured stays in shades of grey where there are no
    /// colours
    #[arg(long, value_name = "colour|black-and-white|greyscale")]
    pub(in crate::cli) preset: Option<String>,
    /// Samples per pixel along each axis
    #[arg(long, value_name = "N")]
    pub(in crate::cli) samples: Option<u32>,
    /// Colour behind the block, or `transparent`
    #[arg(long, value_name = "#RRGGBB")]
    pub(in crate::cli) background: Option<String>,
}
