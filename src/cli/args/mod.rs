//! The arguments of the command line.

mod animate;
mod assembly;
mod attribute;
mod extraction;
mod figure;
mod history;
mod interpretation;
mod layer;
mod output;
mod restore;
mod review;
mod scene;
mod segy;
mod well;

pub(super) use animate::AnimateArgs;
pub(super) use assembly::{
    ClimbArgs, DescendArgs, DrawArgs, FaultPickArgs, FaultProposeArgs, FillArgs, PickArgs, ReplayArgs, SmoothArgs,
    TimeArgs, TrackArgs,
};
pub(super) use attribute::AttributeArgs;
pub(super) use extraction::ExtractArgs;
pub(super) use figure::FigureArgs;
pub(super) use history::HistoryArgs;
pub(super) use interpretation::{
    ExportArgs, FaultAction, FaultAddArgs, HorizonAction, HorizonAddArgs, ImportArgs, ReadingArgs, StackArgs,
    VolumeAction,
};
pub(super) use layer::{LayerAction, LayerSetArgs, RawArgs, ScalarAction, TextureArgs};
pub(super) use output::{
    BenchArgs, DemoArgs, DrawingArgs, FiguresArgs, IllustrateArgs, ParameterizeArgs, RenderArgs, SynthArgs,
};
pub(super) use restore::RestoreArgs;
pub(super) use review::{NoteAction, ReviewArgs};
pub(super) use scene::{SceneAction, ViewArgs};
pub(super) use segy::SegyArgs;
pub(super) use well::{WellAction, WellAddArgs};

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Turns a 3D seismic survey and its interpretation into geological illustrations.
#[derive(Debug, Parser)]
#[command(name = "petroglyph", version, about, propagate_version = true, max_term_width = 110)]
pub(super) struct Arguments {
    /// Write one JSON object to stdout as the answer
    #[arg(long, global = true)]
    pub(super) json: bool,
    /// How long a command that changes a project waits while another is changing it; then it is refused
    #[arg(long, global = true, value_name = "SECONDS", default_value_t = project::folder::DEFAULT_WAIT.as_secs_f64(), hide_short_help = true)]
    pub(super) wait: f64,
    #[command(subcommand)]
    pub(super) action: Action,
}

#[derive(Debug, Subcommand)]
pub(super) enum Action {
    /// Run the whole chain from a synthetic survey to finished pictures
    #[command(after_help = "Example:\n  petroglyph demo --out out/demo")]
    Demo(DemoArgs),
    /// Draw a block of a survey that nobody has interpreted, with layers of one geologic time
    #[command(after_help = "Example:\n  petroglyph illustrate survey.sgy block.png --layers 6\n\n\
                      It imports the survey into a new project beside the picture, extracts candidates, computes\n\
                      geologic time and draws the strongest, most continuous levels, and as bodies what reflects\n\
                      strongly but ends on all sides: a flat spot, a build-up. The picture says that it is not\n\
                      interpreted.")]
    Illustrate(IllustrateArgs),
    /// Make a synthetic survey with its interpretation and its truth
    #[command(after_help = "Example:\n  petroglyph synth out/synth --size 128x128x128 --seed 7 --snr 3")]
    Synth(SynthArgs),
    /// Show what a file or project holds
    #[command(after_help = "Example:\n  petroglyph info survey.sgy\
                      \n  petroglyph info survey.sgy --inline-byte 193 --crossline-byte 189\
                      \n  petroglyph info top-chalk.irap\n  petroglyph info north.petro --json\
                      \n  petroglyph info north.petro --distortion")]
    Info {
        /// SEG-Y, horizon, fault or well file, or project folder
        path: PathBuf,
        /// Of a project: compute how much patterns are distorted, layer by layer, on the faces of its first scene (or
        /// the default view) at vertical exaggeration 1
        #[arg(long)]
        distortion: bool,
        #[command(flatten)]
        segy: SegyArgs,
        #[command(flatten)]
        reading: ReadingArgs,
    },
    /// Create a project without seismic
    #[command(
        after_help = "Example:\n  petroglyph create sketch.petro --bounds 0,5000,0,4000,0,2000 --size 201x161x101 --z-unit m\n  petroglyph create lines.petro --bounds 0,5000,0,4000,0,2000 --inlines 1001,1201 --crosslines 2000,2320,2\n  petroglyph create horst.petro --history horst.toml"
    )]
    Create(CreateArgs),
    /// Take an interpretation back in time: a new project without what is younger than a horizon, its throws and folds undone
    #[command(after_help = "Examples:\n  petroglyph restore north.petro chalk.petro --to \"Top Chalk\"\
                      \n  petroglyph restore north.petro chalk.petro --to \"Top Chalk\" --regional\
                      \n  petroglyph restore north.petro chalk.petro --to \"Top Chalk\" --dip 2,270 --depth 1500\n\n\
                      Blocks move on the map so that the heaves of the horizon close, then vertical shear lays it flat. It is\n\
                      kinematic and not balanced, which figures of the new project say; how lengths and areas change is printed\n\
                      (docs/restore.md).")]
    Restore(RestoreArgs),
    /// Read a SEG-Y volume into a project
    #[command(after_help = "Examples:\n  petroglyph import survey.sgy north.petro\
                      \n  petroglyph import large.sgy north.petro --memory 4G\
                      \n  petroglyph import impedance.sgy north.petro --name impedance --inline-byte 9 \
                      --crossline-byte 21")]
    Import(ImportArgs),
    /// Compute a volume from a volume: semblance, envelope, dip, fault likelihood, throw
    #[command(after_help = "Examples:\n  petroglyph attribute north.petro --kind semblance --name faults\
                      \n  petroglyph attribute north.petro --kind dip --name dip --volume seismic --memory 2G")]
    Attribute(AttributeArgs),
    /// Volumes of a project
    #[command(subcommand)]
    Volume(VolumeAction),
    /// Horizons of a project
    #[command(subcommand)]
    Horizon(HorizonAction),
    /// Faults of a project
    #[command(subcommand)]
    Fault(FaultAction),
    /// Wells of a project
    #[command(subcommand)]
    Well(WellAction),
    /// Find horizon candidates in a volume: surfaces, their trees, and the closest leaf of every voxel
    #[command(after_help = "Examples:\n  petroglyph extract north.petro\
                      \n  petroglyph extract north.petro --memory 4G\
                      \n  petroglyph extract north.petro --extrema peak --min-front-width 6 --json")]
    Extract(ExtractArgs),
    /// Compute geologic time: a volume in which every bed has one value, also beyond faults
    #[command(after_help = "Example:\n  petroglyph time north.petro\n\n\
                      It needs horizon candidates (`petroglyph extract`) and is cut at the faults of the project, or at\n\
                      faults that it finds where none is drawn.")]
    Time(TimeArgs),
    /// Pick a candidate and add it to a horizon, or take it out; or add the level of geologic time through a place
    #[command(after_help = "Examples:\
                      \n  petroglyph pick north.petro --at 1250,1302,948 --horizon \"Top Chalk\" \
                      --highest-valid\
                      \n  petroglyph pick north.petro --at 1310,1302,960 --horizon \"Top Chalk\" --up 2 --remove\
                      \n  petroglyph pick north.petro --at 1250,1302,948 --horizon \"Top Chalk\" --by-time")]
    Pick(PickArgs),
    /// Move a pick up its tree
    #[command(after_help = "Example:\n  petroglyph climb north.petro 3 --levels 2")]
    Climb(ClimbArgs),
    /// Move a pick down its tree
    #[command(after_help = "Example:\n  petroglyph descend north.petro 3")]
    Descend(DescendArgs),
    /// Measure the extraction against the truth of a synthetic survey
    #[command(after_help = "Example:\n  petroglyph evaluate synthetic.petro out/synth --json")]
    Evaluate {
        /// Project folder
        project: PathBuf,
        /// Folder that `petroglyph synth` wrote
        truth: PathBuf,
    },
    /// Write a horizon, a fault, the points of all candidates, a volume or a 3D model to a file, or a volume to object
    /// storage
    #[command(after_help = "Examples:\n  petroglyph export north.petro top.irap --horizon \"Top Chalk\" --format irap\
                      \n  petroglyph export north.petro points.csv --candidates\
                      \n  petroglyph export north.petro out.sgy --volume seismic\
                      \n  petroglyph export north.petro s3://surveys/coherence.zarr --volume coherence\
                      \n  petroglyph export north.petro block.glb --model --scene corner\n\n\
                      In object storage a volume is a Zarr v3 group, whole or not there; `petroglyph volume link` takes it\n\
                      into another project, and says which variables hold credentials.")]
    Export(Box<ExportArgs>),
    /// State the velocity that turns two-way time into metres
    #[command(after_help = "Example:\n  petroglyph velocity north.petro 2500")]
    Velocity {
        /// Project folder
        project: PathBuf,
        /// Velocity, m/s
        #[arg(allow_negative_numbers = true)]
        velocity_m_s: f64,
    },
    /// The look of layers: names, colours, patterns
    #[command(subcommand)]
    Layer(LayerAction),
    /// Textures by the values of a volume, over the layers
    #[command(subcommand)]
    Scalar(ScalarAction),
    /// Choose which volume is shown as raw data, and in which colours
    #[command(after_help = "Example:\n  petroglyph raw north.petro --volume seismic --map grey")]
    Raw(RawArgs),
    /// Add a tile of your own to a project
    #[command(after_help = "Example:\n  petroglyph texture north.petro coal-seam.svg --width-mm 12")]
    Texture(TextureArgs),
    /// Scenes: views of the project under names
    #[command(subcommand)]
    Scene(SceneAction),
    /// Compute the layer coordinates i, j, k and keep them in the project
    #[command(after_help = "Examples:\n  petroglyph parameterize north.petro --size 128x128x128\n  petroglyph \
                      parameterize north.petro --memory 1G\n  petroglyph parameterize north.petro --from geochron.zarr")]
    Parameterize(ParameterizeArgs),
    /// Draw a picture
    #[command(after_help = "Examples:\n  petroglyph render north.petro block.png\
                      \n  petroglyph render north.petro half.png --blend 0.5 --cut nearest,0.5,0.4 --azimuth \
                      30 --size 2400x1800 --dpi 300\
                      \n  petroglyph render north.petro figure.png --legend --scale-bar --size-cm 16x11\
                      \n  petroglyph render north.petro compared.png --compare 0,1 --wipe 0.5 --scale-bar\
                      \n  petroglyph render north.petro section.png --inline 1250 --size-cm 16x9 --scale-bar\
                      \n  petroglyph render north.petro four.png --block --inline 1250 --crossline 1302 \
                      --slice 948 --legend\
                      \n  petroglyph render north.petro fence.png --fence 1200,1300 1250,1340 1290,1310 \
                      --interpretation\n  petroglyph render north.petro map.png --map \"Top Chalk\" --scale-bar\
                      \n  petroglyph render north.petro isochore.png --map \"Top Chalk\" --thickness-to \"Base \
                      Chalk\"")]
    Render(Box<RenderArgs>),
    /// Make all figures that the project lists as `figures` in its project.toml
    #[command(after_help = "Example:\n  petroglyph figures north.petro out/figures\n\n\
                      A figure in project.toml, with the words of `render --figure` (guide: Batches of figures):\
                      \n  [[figures]]\n  file = \"block.pdf\"\n  scene = \"corner\"\n  size = { cm = [16.0, 11.0] }\n  legend = true")]
    Figures(FiguresArgs),
    /// Draw the block after each event of its geological history, side by side on one page
    #[command(after_help = "Examples:\n  petroglyph history horst.petro horst.pdf\
                      \n  petroglyph history horst.petro horst.svg --stages 1,3,5 --size-cm 17x9 --exaggeration 1.5\
                      \n\nThe block has a history if it was made by `petroglyph create BLOCK.petro --history FILE.toml`. All panels\
                      \nhave the same camera, the same scale and one legend; layers look as in the project.")]
    History(Box<HistoryArgs>),
    /// Draw an animation: around the block, from illustration to raw data, through the block or its history, or between
    /// two scenes
    #[command(after_help = "Animated PNG, GIF and numbered frames are written; animated WebP and films are not.\n\n\
                      Examples:\n  petroglyph animate north.petro turn.png --frames 72 --size 800x600\
                      \n  petroglyph animate north.petro blend.gif --motion blend --cut nearest,0.45,0.45\
                      \n  petroglyph animate north.petro sections.gif --motion section --along crossline\
                      \n  petroglyph animate horst.petro time.png --motion history --frames 60\
                      \n  petroglyph animate north.petro frames --scene overview --to corner --once")]
    Animate(Box<AnimateArgs>),
    /// Write a page for any browser: the block in 3D, to turn, cut, blend and read, without a network
    #[command(after_help = "Examples:\n  petroglyph review north.petro north.html\
                      \n  petroglyph review north.petro small.html --scene corner --sections 0 --size-limit 3\
                      \n\nThe page is one file. It shows its pictures also where scripts are not allowed, and on paper.")]
    Review(ReviewArgs),
    /// Notes on places, which reviews show
    #[command(subcommand)]
    Note(NoteAction),
    /// Open the window, for the whole work from volume to picture
    #[command(after_help = "Examples:\n  petroglyph view\n  petroglyph view north.petro")]
    View {
        /// Project folder; without one the start page opens
        project: Option<PathBuf>,
        /// Record how long each frame takes, as CSV; frames then follow one another without pause
        #[arg(long, value_name = "FILE", hide = true)]
        frame_times: Option<PathBuf>,
    },
    /// Draw a sheet of every pattern with its name
    #[command(after_help = "Example:\n  petroglyph patterns patterns.png")]
    Patterns {
        /// PNG file to write
        out: PathBuf,
        /// Project whose own tiles are shown too
        #[arg(long)]
        project: Option<PathBuf>,
    },
    /// Measure how long the stages take on this machine
    #[command(after_help = "Example:\n  petroglyph bench --quick --json")]
    Bench(BenchArgs),
    /// Undo the last command
    #[command(after_help = "Example:\n  petroglyph undo north.petro")]
    Undo {
        /// Project folder
        project: PathBuf,
    },
    /// Redo the command that was undone last
    #[command(after_help = "Example:\n  petroglyph redo north.petro")]
    Redo {
        /// Project folder
        project: PathBuf,
    },
    /// Check that everything in a project is there, undamaged and can be drawn; the exit code is 1 if something is not, or
    /// cannot be read
    #[command(after_help = "Examples:\n  petroglyph check north.petro\n  petroglyph check north.petro --repair")]
    Check {
        /// Project folder
        project: PathBuf,
        /// Remove leftovers and damaged derived data, set damaged history aside, restore a damaged project.toml; data
        /// that a state needs are never deleted
        #[arg(long)]
        repair: bool,
    },
    /// Delete the history and the data that only the history refers to
    #[command(after_help = "Example:\n  petroglyph prune north.petro")]
    Prune {
        /// Project folder
        project: PathBuf,
    },
}

#[derive(Debug, Args)]
pub(super) struct CreateArgs {
    /// Project folder to create, usually NAME.petro
    pub(super) project: PathBuf,
    /// A text file that tells the block as events: beds, tilt, folds, faults, erosion (docs/history.md)
    #[arg(long, value_name = "FILE.toml", conflicts_with = "bounds")]
    pub(super) history: Option<PathBuf>,
    /// World bounds X0,X1,Y0,Y1,Z0,Z1: X and Y in metres, Z in the vertical unit, positive down
    #[arg(long, value_name = "X0,X1,Y0,Y1,Z0,Z1", allow_hyphen_values = true)]
    pub(super) bounds: Option<String>,
    /// Samples along X, Y and Z [default: 128x128x128]
    #[arg(long, value_name = "NxNxN", requires = "bounds")]
    pub(super) size: Option<String>,
    /// Numbers of the inlines, which count along X: FIRST,LAST or FIRST,LAST,STEP [default: from 1]
    #[arg(long, value_name = "FIRST,LAST[,STEP]", requires = "bounds", allow_hyphen_values = true)]
    pub(super) inlines: Option<String>,
    /// Numbers of the crosslines, which count along Y, in the same way
    #[arg(long, value_name = "FIRST,LAST[,STEP]", requires = "bounds", allow_hyphen_values = true)]
    pub(super) crosslines: Option<String>,
    /// Unit of Z: m or ms (two-way time) [default: m]
    #[arg(long, value_name = "UNIT", requires = "bounds")]
    pub(super) z_unit: Option<String>,
}
