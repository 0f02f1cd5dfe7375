//! Arguments for picks, and for faults that are drawn or proposed.

use clap::{ArgAction, ArgMatches, Args, Command, FromArgMatches};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(in crate::cli) struct PickArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Place: line numbers and the vertical value
    #[arg(long, value_name = "INLINE,CROSSLINE,Z", allow_hyphen_values = true)]
    pub(in crate::cli) at: String,
    /// Horizon to add the node to; created if it does not exist
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) horizon: String,
    /// Climb this many levels above the leaf [default: 0]
    #[arg(long, value_name = "N", conflicts_with = "highest_valid")]
    pub(in crate::cli) up: Option<u32>,
    /// Climb to the highest node that is a single sheet: at most 2 % of its points lie over itself, as noise leaves
    /// them, and are left out of the horizon; at most 10 % lie over the rest of the horizon, as beside a fault that is not
    /// drawn, which is then said
    #[arg(long)]
    pub(in crate::cli) highest_valid: bool,
    /// Add a new horizon that is the level of geologic time through the place, over the whole survey and across its
    /// faults, or correct one that was made so around the place; `petroglyph time` first. Where both sides of a fault do
    /// not tell which reflection it is, it says so, and a place beyond the fault decides
    #[arg(long, conflicts_with_all = ["up", "highest_valid", "remove", "colour"])]
    pub(in crate::cli) by_time: bool,
    /// Remove the node from the horizon
    #[arg(long)]
    pub(in crate::cli) remove: bool,
    /// Colour of the horizon, #rrggbb [default: its present colour, or the next of a list]
    #[arg(long, value_name = "COLOUR")]
    pub(in crate::cli) colour: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct TimeArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Name of the new volume
    #[arg(long, default_value = "time")]
    pub(in crate::cli) name: String,
    /// Memory to use beside the candidates, such as 2G or 800M [default: half of what is available]; a survey that needs
    /// more is solved in slabs of inlines that are joined
    #[arg(long, value_name = "BYTES")]
    pub(in crate::cli) memory: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct ClimbArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Number of the pick
    pub(in crate::cli) id: u32,
    /// Levels
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(in crate::cli) levels: u32,
    /// Climb to the highest node that is a single sheet: at most 2 % of its points lie over itself, as noise leaves
    /// them, and are left out of the horizon; at most 10 % lie over the rest of it, which is then said
    #[arg(long, conflicts_with = "levels")]
    pub(in crate::cli) highest_valid: bool,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct DescendArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Number of the pick
    pub(in crate::cli) id: u32,
    /// Levels
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(in crate::cli) levels: u32,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct FillArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Horizon
    pub(in crate::cli) name: String,
    /// Leave holes with more traces than this open [default: fill all]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) max_traces: Option<usize>,
    /// Follow the reflection through the holes where there is one, and fill the rest smoothly
    #[arg(long)]
    pub(in crate::cli) along_reflection: bool,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct DrawArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Horizon; created if it does not exist
    pub(in crate::cli) name: String,
    /// Corners of the line: line numbers and the vertical value
    #[arg(long, value_name = "INLINE,CROSSLINE,Z", num_args = 1.., required = true)]
    pub(in crate::cli) line: Vec<String>,
    /// Lay its nodes on the nearest peak or trough, whichever the samples along the line are
    #[arg(long)]
    pub(in crate::cli) snap: bool,
    /// Colour of the horizon, #rrggbb [default: its present colour, or the next of a list]
    #[arg(long, value_name = "COLOUR")]
    pub(in crate::cli) colour: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct TrackArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Horizon; created if it does not exist
    pub(in crate::cli) name: String,
    /// Place on the reflection: line numbers and the vertical value
    #[arg(long, value_name = "INLINE,CROSSLINE,Z", allow_hyphen_values = true)]
    pub(in crate::cli) at: String,
    /// Traces to each side of the place, 1 to 1000
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(in crate::cli) traces: u32,
    /// Samples above and below the place, 1 to 1000
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(in crate::cli) samples: u32,
    /// Colour of the horizon, #rrggbb [default: its present colour, or the next of a list]
    #[arg(long, value_name = "COLOUR")]
    pub(in crate::cli) colour: Option<String>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct SmoothArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Horizon
    pub(in crate::cli) name: String,
    /// Traces to the farthest nodes that count, 0 to 50; 0 takes the smoothing of an assembled horizon back
    #[arg(long, value_name = "TRACES", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=50))]
    pub(in crate::cli) radius: u32,
    /// How often it is smoothed, 1 to 20
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=20))]
    pub(in crate::cli) passes: u32,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct ReplayArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Horizon [default: all that were assembled]
    pub(in crate::cli) name: Option<String>,
    /// Remove from the log the picks that no longer fit; a horizon that none fits stays as it was
    #[arg(long)]
    pub(in crate::cli) drop_unfit: bool,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct FaultPickArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Name of the fault; if it exists already, the sticks are added to it
    #[arg(long)]
    pub(in crate::cli) name: String,
    #[command(flatten)]
    pub(in crate::cli) sticks: StickArgs,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct FaultProposeArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Largest distance between the two sides of a horizon, traces [default: 14]
    #[arg(long, value_name = "TRACES")]
    pub(in crate::cli) reach: Option<usize>,
    /// Smallest throw, samples [default: 2]
    #[arg(long, value_name = "SAMPLES")]
    pub(in crate::cli) min_throw: Option<f32>,
    /// Smallest dip, degrees [default: 30]
    #[arg(long, value_name = "DEG")]
    pub(in crate::cli) min_dip: Option<f64>,
}

/// `--stick A B C --stick D E`: each occurrence is a list of its own, which derived arguments cannot
/// distinguish.
#[derive(Debug, Clone, Default)]
pub(in crate::cli) struct StickArgs(pub(in crate::cli) Vec<Vec<String>>);

/// Name of the option.
const STICK: &str = "stick";

impl Args for StickArgs {
    fn augment_args(command: Command) -> Command {
        command.arg(
            clap::Arg::new(STICK)
                .long(STICK)
                .value_name("INLINE,CROSSLINE,Z")
                .num_args(1..)
                .action(ArgAction::Append)
                .required(true)
                .help("A stick: two or more points along the fault, from top to bottom; repeat it for several"),
        )
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for StickArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let sticks = matches.get_occurrences::<String>(STICK).into_iter().flatten();
        Ok(Self(sticks.map(|stick| stick.cloned().collect()).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
