//! The errors that can prevent a model from being built, and the decisions that were made while building it.

use std::fmt;
use survey::geometry::GeometryError;
use survey::progress::Cancelled;
use survey::topology::TopologyError;

/// Why no model could be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The survey geometry cannot be used.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The stratigraphy names a horizon that was not given.
    #[error(
        "the stratigraphy names horizon \"{name}\", but no such horizon was given; add it or take it out of the stratigraphy"
    )]
    MissingHorizon {
        /// Name in the stratigraphy.
        name: String,
    },
    /// Two horizons or two faults have the same name.
    #[error("two {what} are named \"{name}\"; rename one of them")]
    DuplicateName {
        /// "horizons" or "faults".
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A horizon has no usable node.
    #[error(
        "horizon \"{name}\" has no node inside the survey ({outside} outside, {holes} holes); check its \
         coordinates, vertical unit, sign and null value"
    )]
    EmptyHorizon {
        /// Name of the horizon.
        name: String,
        /// Nodes with a depth, outside the survey.
        outside: usize,
        /// Nodes without a depth.
        holes: usize,
    },
    /// There are more horizons or faults than the model can hold.
    #[error("{found} {what} were given, at most {limit} can be used; leave some to a project of their own")]
    TooMany {
        /// "horizons" or "faults".
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A fault has no area.
    #[error(
        "fault \"{name}\" has no triangle with an area and finite corners; check its coordinates and vertical unit"
    )]
    EmptyFault {
        /// Name of the fault.
        name: String,
    },
    /// A fault folds over itself: it passes twice over one place of its own best-fit plane.
    #[error(
        "fault \"{name}\" folds back over itself by up to {offset_m:.0} m near X {:.0}, Y {:.0}, vertical \
         {:.0}, and no smooth surface lies near it; leave out what does not belong to it, or give it as several faults, \
         each of which turns by less than 150 degrees",
        world[0], world[1], world[2]
    )]
    FoldedFault {
        /// Name of the fault.
        name: String,
        /// World position of the worst place.
        world: [f64; 3],
        /// Distance between the two branches there, m.
        offset_m: f64,
    },
    /// A fault is truncated by a fault that was not given.
    #[error(
        "fault \"{name}\" is truncated by \"{by}\", which is not among the faults; add it or remove the truncation"
    )]
    UnknownTruncation {
        /// The truncated fault.
        name: String,
        /// The name it refers to.
        by: String,
    },
    /// Faults truncate one another in a circle.
    #[error("faults truncate one another in a circle: {}; remove one of these truncations", names.join(" → "))]
    CyclicTruncation {
        /// The faults along the circle.
        names: Vec<String>,
    },
    /// The picks of two horizons are in the wrong order.
    #[error(
        "horizon \"{younger}\" lies below \"{older}\" at {nodes} nodes of fault block {block}, by up to \
         {worst:.1} samples near inline {:.0}, crossline {:.0}; \
         correct their order in the stratigraphy, edit the picks there, or make one of them an erosional, onlap or intrusive contact",
        lines[0], lines[1]
    )]
    CrossingHorizons {
        /// The horizon that should be above.
        younger: String,
        /// The horizon that should be below.
        older: String,
        /// Fault block.
        block: u16,
        /// Nodes that cross by more than the tolerance.
        nodes: usize,
        /// The largest crossing, samples.
        worst: f32,
        /// Inline and crossline number of the worst place.
        lines: [f64; 2],
    },
    /// A surface of any shape cannot be used.
    #[error("horizon \"{name}\": {problem}{}", near(place, unit))]
    Surface {
        /// Name of the horizon.
        name: String,
        /// Why, and what to do.
        problem: SurfaceProblem,
        /// Inline, crossline and vertical value of a place where it shows.
        place: Option<[f64; 3]>,
        /// Unit of the vertical value.
        unit: &'static str,
    },
}

/// What keeps a surface of any shape from being a horizon.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SurfaceProblem {
    /// Its triangles are no surface.
    #[error(transparent)]
    Topology(TopologyError),
    /// It passes through itself.
    #[error("its triangles cross each other; mend the surface there, or give its two parts as two horizons")]
    Crossing,
    /// The border of a body lies inside the volume.
    #[error("it is to be a body, but it is open inside the volume; close it, or let it reach the edge of the volume")]
    OpenBody,
    /// One cannot tell which side of it a place lies on.
    #[error(
        "it ends inside the volume in a way that leaves open which side is which; continue it to the edge of the volume"
    )]
    Contradiction,
    /// Points do not say where a body is closed.
    #[error(
        "a body needs triangles, points alone do not say what lies inside; give a closed mesh (TSurf), or normals (columns nx, ny, nz)"
    )]
    PointBody,
    /// Points with normals are too few for a surface.
    #[error("{0} points with a normal are too few for a surface; give at least 8, better a hundred")]
    FewNormals(usize),
    /// Normals point to both sides of a surface.
    #[error(
        "{turned} of its {of} normals point to the other side than those around them; turn them so that all point out of \
         the body, or all to the younger side"
    )]
    TurnedNormals {
        /// Normals that point to the other side.
        turned: usize,
        /// All normals.
        of: usize,
    },
    /// Points of one horizon do not say which side is younger.
    #[error(
        "its points alone do not say which side is older; give a horizon above or below it as well, normals (columns nx, ny, \
         nz) or triangles (TSurf)"
    )]
    PointsAlone,
}

fn near(place: &Option<[f64; 3]>, unit: &str) -> String {
    place.map_or_else(String::new, |[inline, crossline, z]| {
        format!(" (near inline {inline:.0}, crossline {crossline:.0}, {z:.0} {unit})")
    })
}

/// How a horizon was placed in a block in which it was not picked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InferredPlacement {
    /// By its thickness, or its share of the interval, between its neighbours in another block.
    Thickness {
        /// The block the thickness was taken from.
        donor: u16,
    },
    /// As the surface through the picks of all other blocks.
    OtherBlocks,
}

/// A decision that the user should know about.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelNote {
    /// A horizon is not in the stratigraphy and was left out.
    Ignored {
        /// Name of the horizon.
        horizon: String,
    },
    /// Depths of a horizon lie outside the survey and its margin.
    Outside {
        /// Name of the horizon.
        horizon: String,
        /// How many.
        nodes: usize,
    },
    /// A sheet carries the number of a block that it does not lie in.
    Reassigned {
        /// Name of the horizon.
        horizon: String,
        /// Block it was given for.
        given: u16,
        /// Block its nodes lie in.
        used: u16,
    },
    /// Nodes close to a fault were dropped.
    SetBack {
        /// Name of the horizon.
        horizon: String,
        /// How many.
        nodes: usize,
    },
    /// Nodes were picked on the wrong side of a fault and left out.
    Strays {
        /// Name of the horizon.
        horizon: String,
        /// How many.
        nodes: usize,
    },
    /// Two sheets of one block overlap. The better one was used.
    Overlap {
        /// Name of the horizon.
        horizon: String,
        /// Traces with two depths.
        nodes: usize,
        /// Their largest difference, samples.
        worst: f32,
    },
    /// A sheet was continued where it has no data inside the volume.
    Extended {
        /// Name of the horizon.
        horizon: String,
        /// Fault block.
        block: u16,
        /// Traces of the block's part of the horizon that have no data.
        traces: usize,
    },
    /// A horizon with no or too few nodes in a block was placed there.
    Placed {
        /// Name of the horizon.
        horizon: String,
        /// Fault block.
        block: u16,
        /// How.
        by: InferredPlacement,
    },
    /// Continued parts of two horizons crossed and were pulled together.
    Clamped {
        /// The horizon that should be above.
        younger: String,
        /// The horizon that should be below.
        older: String,
        /// Fault block.
        block: u16,
        /// Traces inside the block where they did.
        nodes: usize,
        /// The largest crossing, samples.
        worst: f32,
    },
    /// Picks of two horizons cross at a few nodes: the younger one ends at the older one there.
    Crossed {
        /// The horizon that should be above.
        younger: String,
        /// The horizon that should be below.
        older: String,
        /// Nodes that cross by more than the tolerance.
        nodes: usize,
        /// The largest crossing, samples.
        worst: f32,
        /// Inline and crossline number of the worst place.
        lines: [f64; 2],
    },
    /// Points of a series do not lie on the surface that fits all of them best.
    Misfit {
        /// Name of the horizon.
        horizon: String,
        /// How many.
        points: usize,
        /// The farthest, voxels.
        worst: f32,
    },
    /// Two bodies share room.
    BodiesOverlap {
        /// The one that is drawn there.
        younger: String,
        /// The other.
        older: String,
        /// Inline and crossline number of a place in both.
        lines: [f64; 2],
    },
    /// A part of a fault does not divide the volume: too many faults cross one another there.
    FaultLeftOut {
        /// Its name.
        fault: String,
        /// The share of what was interpreted, percent.
        percent: f64,
        /// Number of other faults of which parts are left out as well.
        others: usize,
    },
    /// Two faults cross, and both go on beyond.
    FaultsCross {
        /// Their names.
        faults: [String; 2],
        /// Inline and crossline number of a place where they do.
        lines: [f64; 2],
        /// Number of other pairs that cross as well.
        others: usize,
    },
}

impl ModelNote {
    /// Whether parts of the interpretation contradict one another: what is drawn there may not be what was meant.
    pub fn is_contradiction(&self) -> bool {
        matches!(
            self,
            Self::BodiesOverlap { .. }
                | Self::FaultsCross { .. }
                | Self::FaultLeftOut { .. }
                | Self::Misfit { .. }
                | Self::Crossed { .. }
        )
    }
}

impl fmt::Display for ModelNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ignored { horizon } => {
                write!(f, "horizon \"{horizon}\" is not in the stratigraphy and was left out")
            }
            Self::Outside { horizon, nodes } => {
                write!(f, "{nodes} depths of horizon \"{horizon}\" lie outside the survey and were left out")
            }
            Self::Reassigned { horizon, given, used } => {
                write!(
                    f,
                    "a sheet of horizon \"{horizon}\" for fault block {given} lies in block {used} and was used there"
                )
            }
            Self::SetBack { horizon, nodes } => {
                write!(f, "{nodes} nodes of horizon \"{horizon}\" close to a fault were dropped")
            }
            Self::Strays { horizon, nodes } => {
                write!(f, "{nodes} nodes of horizon \"{horizon}\" lie on the wrong side of a fault and were left out")
            }
            Self::Overlap { horizon, nodes, worst } => write!(
                f,
                "horizon \"{horizon}\" has two depths in one fault block at {nodes} traces, up to {worst:.1} samples apart"
            ),
            Self::Extended { horizon, block, traces } => {
                write!(f, "horizon \"{horizon}\" was continued over {traces} traces of fault block {block}")
            }
            Self::Placed { horizon, block, by: InferredPlacement::Thickness { donor } } => write!(
                f,
                "horizon \"{horizon}\" has no or too few picks in fault block {block} and was placed by the \
                 thickness it has in block {donor}"
            ),
            Self::Placed { horizon, block, by: InferredPlacement::OtherBlocks } => write!(
                f,
                "horizon \"{horizon}\" has no or too few picks in fault block {block} and was continued from the other blocks"
            ),
            Self::Clamped { younger, older, block, nodes, worst } => write!(
                f,
                "horizons \"{younger}\" and \"{older}\", continued without data, crossed by up to {worst:.1} \
                 samples at {nodes} traces of fault block {block} and were pulled together"
            ),
            Self::Crossed { younger, older, nodes, worst, lines: [inline, crossline] } => write!(
                f,
                "horizon \"{younger}\" lies below \"{older}\" at {nodes} nodes, by up to {worst:.1} samples near inline \
                 {inline:.0}, crossline {crossline:.0}; it ends at \"{older}\" there"
            ),
            Self::Misfit { horizon, points, worst } => write!(
                f,
                "{points} points of horizon \"{horizon}\" lie up to {worst:.1} voxels off the surface through all points \
                 of its series; they contradict their neighbours"
            ),
            Self::BodiesOverlap { younger, older, lines: [inline, crossline] } => write!(
                f,
                "bodies \"{younger}\" and \"{older}\" overlap near inline {inline:.0}, crossline {crossline:.0}; \
                 \"{younger}\", which is younger, is drawn there"
            ),
            Self::FaultLeftOut { fault, percent, others } => {
                write!(
                    f,
                    "{percent:.0} % of fault \"{fault}\" is not drawn: so many faults cross there that parts of them would \
                     divide no rock; state where faults end at one another, or remove small ones"
                )?;
                match others {
                    0 => Ok(()),
                    1 => write!(f, ". So it is with another fault"),
                    _ => write!(f, ". So it is with {others} other faults"),
                }
            }
            Self::FaultsCross { faults: [a, b], lines: [inline, crossline], others } => {
                write!(
                    f,
                    "faults \"{a}\" and \"{b}\" cross near inline {inline:.0}, crossline {crossline:.0} and both go on \
                     beyond, so that they cut the rock into four blocks there; if one of them ends at the other, state \
                     that it is truncated by it"
                )?;
                match others {
                    0 => Ok(()),
                    1 => write!(f, ". Another pair of faults crosses as well"),
                    _ => write!(f, ". {others} other pairs of faults cross as well"),
                }
            }
        }
    }
}

/// What was filled, extended, placed and pulled together while a model was built.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelReport {
    /// The notes, in the order in which the decisions were made.
    pub notes: Vec<ModelNote>,
}
