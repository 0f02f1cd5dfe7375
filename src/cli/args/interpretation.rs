//! Arguments for volumes, horizons and faults.

use super::SegyArgs;
use super::assembly::{DrawArgs, FaultPickArgs, FaultProposeArgs, FillArgs, ReplayArgs, SmoothArgs, TrackArgs};
use clap::{Args, Subcommand};
use files::{Format, SurfaceKind};
use std::path::PathBuf;

fn written_formats() -> String {
    let written =
        Format::all().filter(|format| format.writes(SurfaceKind::Horizon) || format.writes(SurfaceKind::Fault));
    let written = written.map(Format::name).collect::<Vec<_>>().join(", ");
    format!("Format of the file: {written} [default: by its extension]")
}

#[derive(Debug, Args)]
pub(in crate::cli) struct ImportArgs {
    /// SEG-Y file, NumPy array on the project's lattice, or folder of a volume that a project or the Python package has stored
    pub(in crate::cli) survey: PathBuf,
    /// Project folder; created if it does not exist
    pub(in crate::cli) project: PathBuf,
    /// Name of the volume [default: seismic, for further ones the file's name]
    #[arg(long)]
    pub(in crate::cli) name: Option<String>,
    /// What a positive amplitude means: normal (SEG: more impedance) or reverse
    #[arg(long, default_value = "normal", value_name = "normal|reverse")]
    pub(in crate::cli) polarity: String,
    /// Memory to use, such as 2G or 800M [default: half of what is available]
    #[arg(long, value_name = "BYTES")]
    pub(in crate::cli) memory: Option<String>,
    #[command(flatten)]
    pub(in crate::cli) segy: SegyArgs,
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum VolumeAction {
    /// List the volumes
    #[command(after_help = "Example:\n  petroglyph volume list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Take in a volume that stays in object storage: its bricks are read, and cached, as they are needed
    #[command(after_help = "Examples:\n  petroglyph volume link north.petro s3://surveys/north.zarr --name seismic\
                      \n  petroglyph volume link north.petro https://example.org/surveys/north.zarr\n\n\
                      The volume is one of this program, written there by `petroglyph export` or copied. Credentials come\n\
                      from the environment alone: AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, AWS_REGION, AWS_ENDPOINT_URL;\n\
                      GOOGLE_APPLICATION_CREDENTIALS; AZURE_STORAGE_ACCOUNT_NAME, AZURE_STORAGE_ACCOUNT_KEY. Blocks are\n\
                      cached in PETROGLYPH_CACHE [default: ~/.cache/petroglyph], up to PETROGLYPH_CACHE_BYTES [10 GiB].\n\
                      The program must be built with `--features remote`.")]
    Link {
        /// Project folder; made if there is none
        project: PathBuf,
        /// Address of the volume: s3://, gs://, az://, https://
        url: String,
        /// Name of the volume [default: seismic, or the last part of the address]
        #[arg(long)]
        name: Option<String>,
    },
    /// Rename a volume
    #[command(after_help = "Example:\n  petroglyph volume rename north.petro seismic \"Full stack 2019\"")]
    Rename {
        /// Project folder
        project: PathBuf,
        /// Volume
        from: String,
        /// New name
        to: String,
    },
    /// Remove a volume
    #[command(after_help = "Example:\n  petroglyph volume remove north.petro impedance")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Volume
        name: String,
    },
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum HorizonAction {
    /// Read a horizon
    #[command(after_help = "Examples:\n  petroglyph horizon add north.petro top.irap --name \"Top Chalk\"\
                      \n  petroglyph horizon add north.petro a.csv --name A --z-unit ms --z-positive up \
                      --z-factor 0.3333 --contact erosional")]
    Add(Box<HorizonAddArgs>),
    /// List the horizons, youngest first
    #[command(after_help = "Example:\n  petroglyph horizon list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Show what a horizon holds: depths, holes, sheets, source
    #[command(after_help = "Example:\n  petroglyph horizon show north.petro \"Top Chalk\"")]
    Show {
        /// Project folder
        project: PathBuf,
        /// Horizon
        name: String,
    },
    /// Rename a horizon
    #[command(after_help = "Example:\n  petroglyph horizon rename north.petro A \"Top Chalk\"")]
    Rename {
        /// Project folder
        project: PathBuf,
        /// Horizon
        from: String,
        /// New name
        to: String,
    },
    /// Draw a line of a horizon by hand, where there is no candidate; it needs no extraction
    #[command(after_help = "Example:\
                      \n  petroglyph horizon draw north.petro \"Top Chalk\" --line 1250,1300,902 1250,1340,915 --snap")]
    Draw(DrawArgs),
    /// Track a reflection from one place within a window, never across a fault; it needs no extraction
    #[command(
        after_help = "Example:\n  petroglyph horizon track north.petro \"Top Chalk\" --at 1250,1300,902 --traces 80"
    )]
    Track(TrackArgs),
    /// Fill the holes of a horizon, never across a fault
    #[command(after_help = "Example:\n  petroglyph horizon fill north.petro \"Top Chalk\" --max-traces 200")]
    Fill(FillArgs),
    /// Smooth a horizon, never across a fault; one that was assembled stays smoothed when its picks change
    #[command(after_help = "Example:\n  petroglyph horizon smooth north.petro \"Top Chalk\" --radius 4 --passes 2")]
    Smooth(SmoothArgs),
    /// Add a stack of horizons: isochrons by geologic time, or surfaces at equal shares of the thickness between two
    #[command(
        after_help = "Examples:\n  petroglyph horizon stack north.petro Chalk --count 8 --between \"Top Chalk\" \"Base Chalk\"\
                      \n  petroglyph horizon stack north.petro Slice --count 12 --between \"Top Chalk\" \"Base Chalk\" --spacing proportional\
                      \n  petroglyph export north.petro chalk-3.csv --horizon \"Chalk 3\" --values seismic --window 4"
    )]
    Stack(StackArgs),
    /// Make the picks of horizons again, after another extraction
    #[command(after_help = "Example:\n  petroglyph horizon replay north.petro")]
    Replay(ReplayArgs),
    /// Remove a pick, or what was drawn or tracked, as if it had never been made
    #[command(after_help = "Example:\n  petroglyph horizon unpick north.petro 3")]
    Unpick {
        /// Project folder
        project: PathBuf,
        /// Number of the pick
        id: u32,
    },
    /// Give a horizon another colour
    #[command(after_help = "Example:\n  petroglyph horizon colour north.petro \"Top Chalk\" #0072b2")]
    Colour {
        /// Project folder
        project: PathBuf,
        /// Horizon
        name: String,
        /// Colour, #rrggbb
        colour: String,
    },
    /// State how a horizon meets its neighbours
    #[command(after_help = "Example:\n  petroglyph horizon contact north.petro \"Base Tertiary\" erosional")]
    Contact {
        /// Project folder
        project: PathBuf,
        /// Horizon
        name: String,
        /// conformable, erosional, onlap, intrusive, or truncated-intrusion (cut off by younger erosion)
        contact: String,
    },
    /// Remove a horizon
    #[command(after_help = "Example:\n  petroglyph horizon remove north.petro \"Top Chalk\"")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Horizon
        name: String,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct StackArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// What the names of the horizons begin with; a number follows
    pub(in crate::cli) name: String,
    /// Number of horizons
    #[arg(long, value_name = "N")]
    pub(in crate::cli) count: usize,
    /// The horizon above and the horizon below [default: isochrons over all of the survey's rock]
    #[arg(long, num_args = 2, value_names = ["TOP", "BASE"])]
    pub(in crate::cli) between: Vec<String>,
    /// isochrons (equal steps of geologic time, `petroglyph time` first) or proportional (equal shares of the thickness)
    #[arg(long, value_name = "isochrons|proportional", default_value = "isochrons")]
    pub(in crate::cli) spacing: String,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct HorizonAddArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Horizon file
    pub(in crate::cli) file: PathBuf,
    /// Name of the horizon
    #[arg(long)]
    pub(in crate::cli) name: String,
    /// How it meets its neighbours: conformable, erosional, onlap, intrusive, or truncated-intrusion (cut off by the
    /// erosion surfaces above it) [default: conformable]
    #[arg(long)]
    pub(in crate::cli) contact: Option<String>,
    /// Put it just above this horizon [default: by its depth]
    #[arg(long, value_name = "HORIZON", conflicts_with = "below")]
    pub(in crate::cli) above: Option<String>,
    /// Put it just below this horizon [default: by its depth]
    #[arg(long, value_name = "HORIZON")]
    pub(in crate::cli) below: Option<String>,
    /// Orientations of its beds in a table of their own (dip and azimuth, or normals), where a surface of any shape is
    /// fitted through points
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) orientations: Option<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) reading: ReadingArgs,
}

/// What the user states about a horizon or fault file.
#[derive(Debug, Default, Args)]
pub(in crate::cli) struct ReadingArgs {
    /// Format of the file [default: recognised]
    #[arg(long)]
    pub(in crate::cli) format: Option<String>,
    /// Vertical unit of the file [default: as the file says, else the project's]
    #[arg(long, value_name = "ms|s|us|m|ft|usft|km|in")]
    pub(in crate::cli) z_unit: Option<String>,
    /// Unit of X and Y of the file [default: as the file says, else m]
    #[arg(long, value_name = "m|ft|usft|km")]
    pub(in crate::cli) xy_unit: Option<String>,
    /// Direction in which the values of the file increase [default: as the file says, else down]
    #[arg(long, value_name = "down|up")]
    pub(in crate::cli) z_positive: Option<String>,
    /// Factor that the file's values are multiplied by, before sign and unit are applied
    #[arg(long, value_name = "F", allow_hyphen_values = true)]
    pub(in crate::cli) z_factor: Option<f64>,
    /// Value that marks nodes without data
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub(in crate::cli) null: Option<f64>,
    /// Name in the file, if it holds several
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) select: Option<String>,
    /// Columns of a table in order, such as `inline,crossline,z` or `x,y,-,z`
    #[arg(long, value_name = "LIST")]
    pub(in crate::cli) columns: Option<String>,
    /// What places points that have both line numbers and coordinates
    #[arg(long, value_name = "lines|xy")]
    pub(in crate::cli) place_by: Option<String>,
    /// CPS-3: the order of the values, columns from the north or rows from the south [default: the smoother]
    #[arg(long, value_name = "columns|rows")]
    pub(in crate::cli) value_order: Option<String>,
    /// A horizon as depths on a map, or of any shape (overturned limbs, closed bodies) [default: as its triangles or
    /// points are]
    #[arg(long, value_name = "map|any")]
    pub(in crate::cli) shape: Option<String>,
    /// Scattered points: gaps that a circle of this radius fits into stay holes
    #[arg(long = "gap", value_name = "M")]
    pub(in crate::cli) gap_m: Option<f64>,
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum FaultAction {
    /// Read a fault
    #[command(after_help = "Examples:\n  petroglyph fault add north.petro f1.ts --name F1\
                      \n  petroglyph fault add north.petro sticks.dat --name F2 --z-unit ms --truncated-by F1")]
    Add(Box<FaultAddArgs>),
    /// Draw a fault from sticks
    #[command(after_help = "Example:\
                      \n  petroglyph fault pick north.petro --name F1 --stick 1250,1300,900 1250,1310,1020 \
                      --stick 1270,1302,900 1270,1312,1020")]
    Pick(FaultPickArgs),
    /// Move a point of a stick that a fault was drawn with
    #[command(after_help = "Example:\n  petroglyph fault move north.petro F1 --stick 2 --point 1 --to 1270,1303,890")]
    Move {
        /// Project folder
        project: PathBuf,
        /// Fault
        name: String,
        /// Which of its sticks, counted from 1
        #[arg(long)]
        stick: usize,
        /// Which of the stick's points, counted from 1
        #[arg(long)]
        point: usize,
        /// Inline, crossline, time or depth
        #[arg(long, value_name = "INLINE,CROSSLINE,Z", allow_hyphen_values = true)]
        to: String,
    },
    /// Propose faults: surfaces in the volume whose two sides match after a throw, and where horizons are offset
    #[command(after_help = "Example:\n  petroglyph fault propose north.petro")]
    Propose(FaultProposeArgs),
    /// Accept a proposed fault
    #[command(after_help = "Example:\n  petroglyph fault accept north.petro 1 --name F1")]
    Accept {
        /// Project folder
        project: PathBuf,
        /// Number of the proposal
        id: u32,
        /// Name of the fault
        #[arg(long)]
        name: String,
    },
    /// Cut a fault in two: from top to bottom through a place, or along its strike at a level
    ///
    /// The larger part keeps the name and what ends at it.
    #[command(after_help = "Examples:\n  petroglyph fault cut north.petro F1 --at 1260,1311,980\
                      \n  petroglyph fault cut north.petro F1 --at 1260,1311,980 --along strike --name \"F1 deep\"")]
    Cut {
        /// Project folder
        project: PathBuf,
        /// Fault
        fault: String,
        /// Inline, crossline, time or depth
        #[arg(long, value_name = "INLINE,CROSSLINE,Z", allow_hyphen_values = true)]
        at: String,
        /// Which way the cut runs
        #[arg(long, value_name = "dip|strike", default_value = "dip", value_parser = ["dip", "strike"])]
        along: String,
        /// Name of the smaller part [default: the fault's, with a number]
        #[arg(long)]
        name: Option<String>,
    },
    /// Make one fault of several that continue one another
    ///
    /// Its surface is made from their sticks, or from lines on every so many sections, and closes the gaps between them.
    /// Faults that run side by side are two, and are refused.
    #[command(after_help = "Example:\n  petroglyph fault merge north.petro F1 F2 --name F1")]
    Merge {
        /// Project folder
        project: PathBuf,
        /// The faults
        #[arg(required = true, num_args = 2..)]
        faults: Vec<String>,
        /// Name of the new one [default: that of the first]
        #[arg(long)]
        name: Option<String>,
    },
    /// Give a proposed or imported fault sticks, so that their points can be moved
    #[command(after_help = "Example:\n  petroglyph fault sticks north.petro F1")]
    Sticks {
        /// Project folder
        project: PathBuf,
        /// Fault
        fault: String,
    },
    /// List the faults
    #[command(after_help = "Example:\n  petroglyph fault list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// State at which other fault a fault ends
    #[command(after_help = "Example:\n  petroglyph fault truncate north.petro F2 --by F1")]
    Truncate {
        /// Project folder
        project: PathBuf,
        /// Fault
        name: String,
        /// The fault it ends at [default: none]
        #[arg(long, value_name = "FAULT")]
        by: Option<String>,
    },
    /// State how far a fault reaches beyond what was drawn of it
    ///
    /// A fault ends where it was drawn; only where it was picked to within half the spacing of its picks, and at most
    /// four lines or samples, of the volume's border does it reach the border. What lies beyond its tip is not broken.
    #[command(after_help = "Examples:\n  petroglyph fault extent north.petro F1 grow 150\
                      \n  petroglyph fault extent north.petro F1 drawn")]
    Extent {
        /// Project folder
        project: PathBuf,
        /// Fault
        name: String,
        /// `drawn`, or `grow` and how many metres it reaches farther on every side
        #[arg(value_name = "drawn|grow M", num_args = 1..=2, required = true, allow_negative_numbers = true)]
        extent: Vec<String>,
    },
    /// Give a fault another colour, on sections and on the block
    #[command(after_help = "Example:\n  petroglyph fault colour north.petro F1 #c0182c")]
    Colour {
        /// Project folder
        project: PathBuf,
        /// Fault
        name: String,
        /// Colour, #rrggbb
        colour: String,
    },
    /// Rename a fault
    #[command(after_help = "Example:\n  petroglyph fault rename north.petro F1 \"Main fault\"")]
    Rename {
        /// Project folder
        project: PathBuf,
        /// Fault
        from: String,
        /// New name
        to: String,
    },
    /// Remove a fault
    #[command(after_help = "Example:\n  petroglyph fault remove north.petro F1")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Fault
        name: String,
    },
}

#[derive(Debug, Args)]
pub(in crate::cli) struct FaultAddArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Fault file
    pub(in crate::cli) file: PathBuf,
    /// Name of the fault
    #[arg(long)]
    pub(in crate::cli) name: String,
    /// The fault it ends at
    #[arg(long, value_name = "FAULT")]
    pub(in crate::cli) truncated_by: Option<String>,
    /// How far it reaches beyond what was drawn: not at all, or so many metres on every side [default: drawn]
    #[arg(long, value_name = "drawn|grow M", num_args = 1..=2, allow_negative_numbers = true)]
    pub(in crate::cli) extent: Vec<String>,
    #[command(flatten)]
    pub(in crate::cli) reading: ReadingArgs,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct ExportArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// File to write; for a volume also an address in object storage: s3://, gs://, az://, https://
    pub(in crate::cli) out: PathBuf,
    /// Horizon to write
    #[arg(long, value_name = "NAME", required_unless_present_any = ["candidates", "fault", "volume", "model"], conflicts_with_all = ["fault", "volume"])]
    pub(in crate::cli) horizon: Option<String>,
    /// Fault to write, as opendtect (sticks) or tsurf (triangles)
    #[arg(long, value_name = "NAME", conflicts_with = "volume")]
    pub(in crate::cli) fault: Option<String>,
    /// Write all horizon candidates instead, as CSV with inline, crossline, z, leaf and surface of each point
    #[arg(long, conflicts_with_all = ["horizon", "fault", "format", "volume"])]
    pub(in crate::cli) candidates: bool,
    #[arg(long, conflicts_with = "volume", help = written_formats())]
    pub(in crate::cli) format: Option<String>,
    /// Write the values of these volumes at the horizon's nodes, as CSV
    #[arg(long, value_name = "VOLUME", num_args = 1.., requires = "horizon", conflicts_with_all = ["format", "when_rotated"])]
    pub(in crate::cli) values: Vec<String>,
    /// With --values: also their mean, root mean square and greatest magnitude over so many samples above and below
    #[arg(long, value_name = "SAMPLES", default_value_t = 0, requires = "values")]
    pub(in crate::cli) window: usize,
    /// Volume to write as SEG-Y
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) volume: Option<String>,
    /// SEG-Y sample format: 1 IBM float, 3 16-bit integer, 5 IEEE float, 8 8-bit integer, 11 and 16 unsigned
    /// 16-bit and 8-bit integer [default: as the volume is stored]
    #[arg(long, value_name = "1|3|5|8|11|16", requires = "volume")]
    pub(in crate::cli) format_code: Option<u16>,
    /// ZMAP+ and CPS-3, which hold no rotated grids: resample such a grid, or refuse it [default: resample]
    #[arg(long, value_name = "resample|refuse")]
    pub(in crate::cli) when_rotated: Option<String>,
    /// Write the block as a 3D model for slides (.glb): faces with their pictures, horizons, faults, wells
    #[arg(long, conflicts_with_all = ["horizon", "fault", "candidates", "volume", "format", "when_rotated"])]
    pub(in crate::cli) model: bool,
    /// Scene whose block is the model [default: the first of the project, or the default view]
    #[arg(long, value_name = "NAME", requires = "model")]
    pub(in crate::cli) scene: Option<String>,
    /// Most triangles of the model; Office takes 100000
    #[arg(long, value_name = "N", default_value_t = review::glb::OFFICE_TRIANGLES, requires = "model")]
    pub(in crate::cli) triangles: usize,
    /// Texels along the longest side of the model's block
    #[arg(long, value_name = "TEXELS", default_value_t = review::DENSITY, requires = "model")]
    pub(in crate::cli) density: f64,
    #[command(flatten)]
    pub(in crate::cli) drawing: super::DrawingArgs,
}
