//! What can go wrong, with the facts and what to do about it.

use survey::Cancelled;

/// A scene that has no picture.
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
    #[error("an image of {width} x {height} pixels cannot be made; each side must be between 1 and {limit}")]
    ImageSize {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Largest side.
        limit: u32,
    },
    /// A box without a volume.
    #[error("{what} has no volume: it runs from {min:?} to {max:?}; every max must be larger than its min")]
    EmptyBox {
        /// Which box.
        what: String,
        /// Its smallest corner.
        min: [f64; 3],
        /// Its largest corner.
        max: [f64; 3],
    },
    /// The roaming box leaves the survey.
    #[error(
        "the roaming box {min:?} to {max:?} leaves the survey, whose samples run from 0 to {last:?} (inline, crossline, sample index)"
    )]
    OutsideSurvey {
        /// Its smallest corner.
        min: [f64; 3],
        /// Its largest corner.
        max: [f64; 3],
        /// The survey's last sample.
        last: [f64; 3],
    },
    /// A cut-out that cuts nothing.
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
    /// More of something than a scene can have.
    #[error("{found} {what} are more than the {limit} a scene can have")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        found: usize,
        /// How many are possible.
        limit: usize,
    },
    /// Cut-outs that leave nothing to see, or too many of them.
    #[error("{found} cut-outs are more than the {limit} a scene can have; merge some")]
    TooManyCutOuts {
        /// How many.
        found: usize,
        /// How many are possible.
        limit: usize,
    },
}

/// Why no picture was made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene has no picture.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The transfer functions cannot be drawn.
    #[error("{0}")]
    Transfer(#[from] ttf::Error),
    /// The scene names a volume that was not given.
    #[error("the scene shows the volume `{name}`, which the project does not have; it has {present:?}")]
    UnknownVolume {
        /// The name asked for.
        name: String,
        /// The names there are.
        present: Vec<String>,
    },
    /// More volumes than the renderer can bind.
    #[error("the scene uses {found} volumes; at most {limit} can be shown at once")]
    TooManyVolumes {
        /// How many.
        found: usize,
        /// How many are possible.
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
    /// A part of the input that this scene needs is missing.
    #[error("the scene needs {what}; {remedy}")]
    Missing {
        /// What is missing.
        what: &'static str,
        /// How to get it.
        remedy: &'static str,
    },
    /// The distances or leaves do not fill their box.
    #[error("candidates of {size:?} need {expected} distances and leaves, found {found:?}; extract them again")]
    CandidateSize {
        /// `[inlines, crosslines, samples]`.
        size: [usize; 3],
        /// Values the box holds.
        expected: usize,
        /// Distances and leaves given.
        found: [usize; 2],
    },
    /// The user stopped it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No GPU or software driver.
    #[error(
        "no graphics adapter was found ({reason}); install a Vulkan driver (the software one is in the packages mesa-vulkan-drivers and libvulkan1), or render on the CPU"
    )]
    NoAdapter {
        /// What the graphics library says.
        reason: String,
    },
    /// The adapter lacks something the passes need.
    #[error("the graphics adapter `{adapter}` cannot run the renderer: {reason}; render on the CPU instead")]
    Unsuitable {
        /// Its name.
        adapter: String,
        /// What is missing.
        reason: String,
    },
    /// Out of memory on the device.
    #[error("the graphics adapter ran out of memory: {reason}; take a smaller roaming box or render on the CPU")]
    OutOfMemory {
        /// What the graphics library says.
        reason: String,
    },
    /// The device went away while rendering.
    #[error("the graphics device was lost ({reason}); try again, or render on the CPU")]
    DeviceLost {
        /// What the graphics library says.
        reason: String,
    },
    /// The graphics library refused a command: a mistake in this program.
    #[error("the graphics library refused a command: {reason}")]
    Device {
        /// What the graphics library says.
        reason: String,
    },
}

/// A scene that shows surfaces of k' without an interpretation.
pub(crate) const NO_DEPTHS: RenderError = RenderError::Missing {
    what: "horizons for surfaces of k'",
    remedy: "add horizons and parameterize the project, or name a volume",
};
/// A scene that shows candidates which are not there.
pub(crate) const NO_CANDIDATES: RenderError = RenderError::Missing {
    what: "horizon candidates",
    remedy: "extract them first, or leave leaves and distances out of the scene",
};
