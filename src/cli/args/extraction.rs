//! Arguments for extracting horizon candidates.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(in crate::cli) struct ExtractArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Volume to extract from [default: the first on the project's lattice]
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) volume: Option<String>,
    /// Memory to use, such as 4G: what takes more in one piece (31 bytes a voxel) is done in bricks, with the same
    /// result; a killed one goes on when it is started again [default: half of what is available]
    #[arg(long, value_name = "BYTES")]
    pub(in crate::cli) memory: Option<String>,
    /// How surfaces grow: `ours`, or `paper` for the published method
    #[arg(long, value_name = "ours|paper", default_value = "ours")]
    pub(in crate::cli) method: String,
    /// What surfaces follow: peak, trough or zero; separate several by commas
    #[arg(long, value_name = "KINDS", default_value = "peak,trough")]
    pub(in crate::cli) extrema: String,
    /// Smallest width, traces: surfaces and connections narrower than this are not grown
    #[arg(long, value_name = "TRACES", default_value_t = 4)]
    pub(in crate::cli) min_front_width: usize,
    /// Share of the common boundary of two pieces of a surface that must support joining them: a smaller
    /// share gives fewer and larger surfaces; more than 1 joins none
    #[arg(long, value_name = "SHARE", default_value_t = 0.4)]
    pub(in crate::cli) join_share: f32,
    /// Evidence required along a plane to count it as a fault, which cuts surfaces: a larger value gives
    /// fewer cuts. Use 100 to 200 for chaotic or clipped data; `inf` looks for no faults
    #[arg(long, value_name = "NATS", default_value_t = 25.0)]
    pub(in crate::cli) fault_evidence: f32,
    /// Smallest number of triangles in a leaf of a surface's tree
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub(in crate::cli) min_leaf_triangles: u32,
    /// Largest distance to a surface that is stored, voxels
    #[arg(long, value_name = "VOXELS", default_value_t = 10.0)]
    pub(in crate::cli) max_distance: f32,
}
