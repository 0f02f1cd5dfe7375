//! The errors of this crate. Each has its facts as fields, and its text says what to do.

use survey::Cancelled;

/// What is wrong with a scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A number outside its range, or not a number.
    #[error("{what} must be between {low} and {high}, found {found}")]
    OutOfRange {
        /// Which setting.
        what: &'static str,
        /// Its value.
        found: f64,
        /// Smallest allowed.
        low: f64,
        /// Largest allowed.
        high: f64,
    },
    /// An image without pixels, or larger than an image may be.
    #[error("an image of {width} x {height} pixels is not possible; each side must be between 1 and {limit}")]
    ImageSize {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Largest side.
        limit: u32,
    },
    /// A box without a volume.
    #[error("{what} is empty: it runs from {min:?} to {max:?}; every maximum must be larger than its minimum")]
    EmptyBox {
        /// Which box.
        what: String,
        /// Its smallest corner.
        min: [f64; 3],
        /// Its largest corner.
        max: [f64; 3],
    },
    /// A roaming box that reaches beyond the survey.
    #[error(
        "the roaming box {min:?} to {max:?} reaches beyond the survey, whose samples run from 0 to {last:?} \
         (inline, crossline, sample index); make it smaller"
    )]
    OutsideSurvey {
        /// Its smallest corner.
        min: [f64; 3],
        /// Its largest corner.
        max: [f64; 3],
        /// The survey's last sample.
        last: [f64; 3],
    },
    /// A cut-out that does not intersect the roaming box.
    #[error(
        "cut-out {index} ({min:?} to {max:?}) lies outside the roaming box {box_min:?} to {box_max:?}; move it or remove it"
    )]
    CutOutOutside {
        /// Position in the list, from 1.
        index: usize,
        /// Its smallest corner.
        min: [f64; 3],
        /// Its largest corner.
        max: [f64; 3],
        /// The roaming box's smallest corner.
        box_min: [f64; 3],
        /// The roaming box's largest corner.
        box_max: [f64; 3],
    },
    /// More of something than a scene may have.
    #[error("{found} {what} are more than the {limit} that a scene can have; remove some")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// The number found.
        found: usize,
        /// The largest number allowed.
        limit: usize,
    },
    /// A cut-out that is no box and cannot be drawn.
    #[error("cut-out {index} of those that are no boxes cannot be drawn: {reason}")]
    CutShape {
        /// Position in the list, from 1.
        index: usize,
        /// Why, and what to change.
        reason: String,
    },
    /// More cut-outs than a scene may have.
    #[error("{found} cut-outs are more than the {limit} that a scene can have; merge some")]
    TooManyCutOuts {
        /// The number found.
        found: usize,
        /// The largest number allowed.
        limit: usize,
    },
}

impl SceneError {
    /// Returns an error for a number outside [`low`, `high`], NaN included.
    pub(crate) fn check_range(what: &'static str, found: f64, low: f64, high: f64) -> Result<(), Self> {
        if found >= low && found <= high { Ok(()) } else { Err(Self::OutOfRange { what, found, low, high }) }
    }
}

/// Why a scene could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene cannot be drawn.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The transfer functions cannot be drawn.
    #[error("{0}")]
    Transfer(#[from] ttf::TtfError),
    /// The scene names a volume that is not among the inputs.
    #[error("the scene shows the volume `{name}`, which the project does not have; it has {present:?}")]
    UnknownVolume {
        /// The name asked for.
        name: String,
        /// The names of the volumes there are.
        present: Vec<String>,
    },
    /// More volumes than the renderer can bind.
    #[error("the scene uses {found} volumes; at most {limit} can be shown at once, so remove some")]
    TooManyVolumes {
        /// The number found.
        found: usize,
        /// The largest number allowed.
        limit: usize,
    },
    /// The transfer functions were compiled for another model.
    #[error("the transfer functions style {styled} layers, but the model has {layers}; compile them for this model")]
    LayerCount {
        /// Layers with a style.
        styled: usize,
        /// Layers of the model.
        layers: usize,
    },
    /// An input that this scene needs is missing.
    #[error("the scene needs {what}; {remedy}")]
    Missing {
        /// What is missing.
        what: &'static str,
        /// How to get it.
        remedy: &'static str,
    },
    /// The numbers of distances and leaves do not match the size of the candidates.
    #[error("candidates of {size:?} need {expected} distances and leaves, found {found:?}; extract them again")]
    CandidateSize {
        /// `[inlines, crosslines, samples]`.
        size: [usize; 3],
        /// Number of values of that size.
        expected: usize,
        /// Distances and leaves given.
        found: [usize; 2],
    },
    /// The user cancelled the drawing.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There is no graphics adapter, neither a GPU nor a software driver.
    #[error(
        "no graphics adapter was found ({reason}); install a Vulkan driver (the software one is in the \
         packages mesa-vulkan-drivers and libvulkan1), or render on the CPU"
    )]
    NoAdapter {
        /// The message of the graphics library.
        reason: String,
    },
    /// The adapter lacks something that the shaders need.
    #[error("the graphics adapter `{adapter}` cannot run the renderer: {reason}; render on the CPU instead")]
    Unsuitable {
        /// Its name.
        adapter: String,
        /// What is missing.
        reason: String,
    },
    /// The device has too little memory.
    #[error("the graphics adapter ran out of memory: {reason}; choose a smaller roaming box or render on the CPU")]
    OutOfMemory {
        /// The message of the graphics library.
        reason: String,
    },
    /// The device was lost while it was rendering.
    #[error("the graphics device was lost ({reason}); try again, or render on the CPU")]
    DeviceLost {
        /// The message of the graphics library.
        reason: String,
    },
    /// The graphics library refused a command, which is a defect of this program.
    #[error(
        "the graphics library refused a command: {reason}; this is a defect of the program, so render on the CPU instead"
    )]
    Device {
        /// The message of the graphics library.
        reason: String,
    },
}

impl RenderError {
    /// The scene shows surfaces of k' without an interpretation.
    pub(crate) const NO_DEPTHS: Self = Self::Missing {
        what: "horizons for surfaces of k'",
        remedy: "add horizons and parameterize the project, or name a volume",
    };
    /// A medium of a volume of which only the samples on faces were read.
    pub(crate) const ONLY_A_PART: Self = Self::Missing {
        what: "all samples of a volume that is rendered",
        remedy: "read the whole volume, or a coarser level of it",
    };
    /// The scene shows horizon candidates that are not there.
    pub(crate) const NO_CANDIDATES: Self = Self::Missing {
        what: "horizon candidates",
        remedy: "extract them first, or leave leaves and distances out of the scene",
    };
}
