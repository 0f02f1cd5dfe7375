//! Arguments for pictures, synthetic surveys and measurements.

use super::{FigureArgs, SegyArgs, ViewArgs};
use clap::Args;
use std::path::PathBuf;

/// What the name of a page's file says.
fn out() -> String {
    format!("File to write: {}", page::endings_of_pages())
}

#[derive(Debug, Args)]
pub(in crate::cli) struct RenderArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    #[arg(help = out())]
    pub(in crate::cli) out: PathBuf,
    /// Named scene of the project, or a TOML file [default: the project's first, else a three-quarter view]
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub(in crate::cli) scene: Option<String>,
    /// Resolution written into the picture, dots per inch; it sets the printed size
    #[arg(long, value_name = "D", default_value_t = 300.0)]
    pub(in crate::cli) dpi: f64,
    /// Technique: illustrate (textured faces), volume rendering as occlusion (shaded without gradients),
    /// phong (shaded by gradients), interleaved (both, in stripes) or volume (unshaded), or map (a map of the
    /// topmost horizon unless --map names one) [default: as the scene says, else illustrate]
    #[arg(long, value_name = "illustrate|occlusion|phong|interleaved|volume|map")]
    pub(in crate::cli) technique: Option<String>,
    /// Volume that volume rendering shows; with textured faces it fills the cut-outs, in the layers that have
    /// an opacity if there are any [default: the volume shown as raw data]
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) medium: Option<String>,
    /// Values up to this share of the volume's clip are transparent, larger ones increasingly opaque; from -1
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, allow_hyphen_values = true)]
    pub(in crate::cli) clear_below: f32,
    /// Horizon shown in the volume, with its colour, opacity and the light it gives off; repeat it for
    /// several
    #[arg(long, value_name = "NAME[,#RRGGBB[,OPACITY[,LIGHT]]]")]
    pub(in crate::cli) horizon: Vec<String>,
    /// Isosurface: of a volume by its name, or of `k`, which is the number of the layer from the bottom
    /// (counted from 0) plus k; without --medium the volume itself is not shown; repeat it for several
    #[arg(long, value_name = "NAME,VALUE[,#RRGGBB[,OPACITY]]")]
    pub(in crate::cli) isosurface: Vec<String>,
    /// Where the volume shows: everywhere, near the horizons shown, or away from them
    #[arg(long, value_name = "everywhere|near|away", default_value = "everywhere")]
    pub(in crate::cli) scope: String,
    #[command(flatten)]
    pub(in crate::cli) drawing: DrawingArgs,
    #[command(flatten)]
    pub(in crate::cli) figure: FigureArgs,
    #[command(flatten)]
    pub(in crate::cli) view: ViewArgs,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct IllustrateArgs {
    /// SEG-Y file
    pub(in crate::cli) survey: PathBuf,
    #[arg(help = out())]
    pub(in crate::cli) out: PathBuf,
    /// Number of layers, at least 2; fewer are drawn where fewer levels stand out
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub(in crate::cli) layers: usize,
    /// Project folder to create, to go on from [default: OUT with the ending .petro]
    #[arg(long)]
    pub(in crate::cli) project: Option<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) drawing: DrawingArgs,
    #[command(flatten)]
    pub(in crate::cli) segy: SegyArgs,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct FiguresArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Folder to write into; created if it does not exist. Files of the figures' names are replaced, others stay
    pub(in crate::cli) out: PathBuf,
    /// Font file for names in letters that the embedded face and the project's own fonts lack; repeat it for several
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) font: Vec<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) drawing: DrawingArgs,
}

/// What draws, and with how much memory.
#[derive(Debug, Args)]
pub(in crate::cli) struct DrawingArgs {
    /// Device that draws: the graphics adapter, or the processor when there is none (auto), or one of the two
    #[arg(long, value_name = "auto|gpu|cpu", default_value = "auto")]
    pub(in crate::cli) device: String,
    /// Largest memory for the samples of one volume, such as 2G; a larger volume is shown at a coarser level
    /// of its pyramid [default: half of what is free]
    #[arg(long, value_name = "BYTES")]
    pub(in crate::cli) volume_memory: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct ParameterizeArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Take i, j, k from a Zarr v3 group that another program wrote, instead of computing them: arrays i, j, k (float32,
    /// NaN outside), layer (0 = deepest) and block (uint8 or uint16), by inline, crossline and sample over the whole survey
    #[arg(long, value_name = "FILE.zarr", conflicts_with = "computed")]
    pub(in crate::cli) from: Option<PathBuf>,
    /// Take k between two horizons from geologic time, as its fraction between theirs: textures follow every bed
    /// (`petroglyph time` first)
    #[arg(long, conflicts_with_all = ["from", "computed"])]
    pub(in crate::cli) by_time: bool,
    /// Compute i, j, k here again, after --from or --by-time
    #[arg(long)]
    pub(in crate::cli) computed: bool,
    /// Samples of the stored arrays along inlines, crosslines and depth [default: the survey's]
    #[arg(long, value_name = "NxNxN")]
    pub(in crate::cli) size: Option<String>,
    /// Memory to use beside the model and its grids, such as 2G or 800M: fewer threads sample at a time; the arrays are the
    /// same [default: 64M for each thread]
    #[arg(long, value_name = "BYTES")]
    pub(in crate::cli) memory: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct SynthArgs {
    /// Folder to write into; created if it does not exist
    pub(in crate::cli) out: PathBuf,
    /// Inlines, crosslines and samples
    #[arg(long, value_name = "NxNxN", default_value = "128x128x128")]
    pub(in crate::cli) size: String,
    /// Seed of the random numbers that choose directions, beds and noise
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(in crate::cli) seed: u64,
    /// RMS signal over RMS noise; `none` for no noise
    #[arg(long, value_name = "R", default_value = "4")]
    pub(in crate::cli) snr: String,
    /// With a dome of salt that overhangs and pierces the beds
    #[arg(long)]
    pub(in crate::cli) salt: bool,
    /// Instead, an outcrop without seismic: nine horizons as scattered points with an overturned limb, three faults
    #[arg(long, conflicts_with_all = ["salt", "snr"])]
    pub(in crate::cli) overturned: bool,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct DemoArgs {
    /// Folder to write into
    #[arg(long, value_name = "DIR", default_value = "out/demo")]
    pub(in crate::cli) out: PathBuf,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct BenchArgs {
    /// Use small sizes, which take seconds instead of minutes
    #[arg(long)]
    pub(in crate::cli) quick: bool,
    /// Write the model that is measured here as NumPy files, to time other programs on
    #[arg(long, value_name = "DIR")]
    pub(in crate::cli) dump: Option<PathBuf>,
    /// Measure instead how fast a SEG-Y cube is read and stored, with files in this folder, which stay there
    /// for other programs
    #[arg(long, value_name = "DIR", conflicts_with = "dump")]
    pub(in crate::cli) segy: Option<PathBuf>,
}
