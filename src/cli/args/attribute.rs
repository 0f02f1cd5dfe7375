//! Arguments for attributes.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(in crate::cli) struct AttributeArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// semblance (similarity of neighbouring traces, low at faults), envelope (strength of reflections),
    /// dip (their steepness), fault-likelihood (0 to 1 where a steep plane breaks the reflections), throw (of faults, where
    /// both sides match after one; samples, reverse ones negative); of geologic time, `petroglyph time` first, flattened (a Wheeler diagram: beds laid
    /// flat; empty where beds are missing) or hiatus (how fast it runs down the traces: high at unconformities)
    #[arg(long, value_name = "semblance|envelope|dip|fault-likelihood|throw|flattened|hiatus")]
    pub(in crate::cli) kind: String,
    /// Name of the new volume; a dip adds NAME-inline and NAME-crossline
    #[arg(long)]
    pub(in crate::cli) name: String,
    /// Volume to compute it from [default: the first]
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) volume: Option<String>,
    /// Steepest dip looked for, samples per line [default: 4]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) max_dip: Option<usize>,
    /// Memory to use, such as 2G or 800M [default: half of what is available]
    #[arg(long, value_name = "BYTES")]
    pub(in crate::cli) memory: Option<String>,
}
