//! How a project is displayed: nothing of this belongs to the project until it is saved as a named scene.

pub use figure::SectionKind;

use super::picking::Picking;
use files::SurfaceKind;
use project::document::{Document, Renamed};
use project::error::Noun;
use project::pictures::scene;
use render::{Scene, Unpicked, VoxelBox};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use survey::SurveyGeometry;
use ttf::ColourMap;

/// Which views fill the middle of the window.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// The block alone.
    #[default]
    Block,
    /// The block and the three sections through one point.
    Sections,
    /// A horizon as a map beside the block.
    Map,
    /// The slice, and a section along a line drawn on it.
    Fence,
}

/// How raw and illustrated pictures are compared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compare {
    /// One picture, blended as the slider says.
    #[default]
    Blend,
    /// Illustrated on the left, raw on the right, with one camera.
    SideBySide,
    /// One over the other, divided by a line that can be dragged.
    Wipe,
}

/// What the left panel shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Panel {
    /// The stratigraphic column.
    #[default]
    Layers,
    /// Volumes, horizons, faults, wells.
    Data,
    /// Colours and textures by value.
    Values,
    /// Candidates, picks, faults.
    Interpret,
}

/// Standard positions of the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StandardView {
    /// Obliquely over a corner, the usual view of block diagrams.
    Block,
    /// Straight down, north up.
    Top,
    /// Looking north.
    North,
    /// Looking east.
    East,
    /// Looking south.
    South,
    /// Looking west.
    West,
}

impl StandardView {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 6] = [Self::Block, Self::Top, Self::North, Self::East, Self::South, Self::West];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Block => "Block",
            Self::Top => "From above",
            Self::North => "Look north",
            Self::East => "Look east",
            Self::South => "Look south",
            Self::West => "Look west",
        }
    }
}

/// The horizons and faults whose lines and surfaces are hidden, on sections and while interpreting. Rock is drawn with all
/// of them.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Hidden {
    horizons: BTreeSet<String>,
    faults: BTreeSet<String>,
}

impl Hidden {
    fn of(&self, kind: SurfaceKind) -> &BTreeSet<String> {
        if kind == SurfaceKind::Horizon { &self.horizons } else { &self.faults }
    }

    /// Whether that horizon or fault is hidden.
    pub fn has(&self, kind: SurfaceKind, name: &str) -> bool {
        self.of(kind).contains(name)
    }

    /// Whether nothing is.
    pub fn is_empty(&self) -> bool {
        self.horizons.is_empty() && self.faults.is_empty()
    }

    /// The names of all that is hidden.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.horizons.iter().chain(&self.faults).map(String::as_str)
    }

    pub(crate) fn set(&mut self, kind: SurfaceKind, name: String, hidden: bool) {
        let names = if kind == SurfaceKind::Horizon { &mut self.horizons } else { &mut self.faults };
        if hidden {
            names.insert(name);
        } else {
            names.remove(&name);
        }
    }

    /// Lets what is hidden follow what has another name.
    pub(crate) fn follow(&mut self, renamed: &Renamed) {
        for (noun, names) in [(Noun::Horizon, &mut self.horizons), (Noun::Fault, &mut self.faults)] {
            let followed = std::mem::take(names).into_iter().map(|mut name| {
                renamed.follow(noun, &mut name);
                name
            });
            names.extend(followed);
        }
    }

    fn fit(&mut self, document: &Document) {
        self.horizons.retain(|name| document.horizons.iter().any(|entry| entry.name == *name));
        self.faults.retain(|name| document.faults.iter().any(|entry| entry.name == *name));
    }
}

/// What sections show of the volumes: the raw data, and a second volume over them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SectionVolumes {
    /// Whether the raw data are hidden.
    pub without_raw: bool,
    /// The volume over them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<Blended>,
}

/// A volume that is laid over the raw data of sections.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Blended {
    /// Its name.
    pub volume: String,
    /// Its colours.
    pub map: ColourMap,
    /// How much of the raw data it covers, 0 to 1.
    pub opacity: f32,
}

impl Blended {
    /// A volume in colours that differ from the usual ones of raw data, half of them.
    pub fn new(volume: &str) -> Self {
        Self { volume: volume.to_owned(), map: ColourMap::Strata, opacity: 0.5 }
    }
}

impl SectionVolumes {
    fn fit(&mut self, document: &Document) {
        let is_there =
            |over: &Blended| document.volumes.iter().any(|entry| entry.name == over.volume && entry.geometry.is_none());
        self.over = self.over.take().filter(is_there);
    }
}

/// How the open project is displayed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ViewState {
    /// The scene: camera, box, cut-outs, blend. Its size is that of the last export.
    pub scene: Scene,
    /// Which views fill the middle.
    pub layout: Layout,
    /// How raw and illustrated are compared.
    pub compare: Compare,
    /// Position of the dividing line of the wipe, share of the width.
    pub wipe: f32,
    /// The point the sections run through, voxel.
    pub slices: [f64; 3],
    /// Vertical exaggeration of sections; `None`: they fill their views.
    #[serde(default)]
    pub proportions: Option<f64>,
    /// Corners of the fence, voxel x and y.
    #[serde(default)]
    pub fence: Vec<[f64; 2]>,
    /// What the left panel shows.
    pub panel: Panel,
    /// The layer whose style is shown.
    pub layer: Option<String>,
    /// The horizon that the map shows.
    pub horizon: Option<String>,
    /// Whether the handles of the box and the cut-outs are shown.
    pub handles: bool,
    /// What is hidden.
    #[serde(default)]
    pub hidden: Hidden,
    /// The volumes that sections show.
    #[serde(default)]
    pub volumes: SectionVolumes,
    /// The interpretation under way.
    #[serde(default)]
    pub picking: Picking,
}

impl ViewState {
    /// The view of a project's first scene, or its default view.
    pub fn of(document: &Document) -> Self {
        let mut scene = scene::choose(document, None).unwrap_or_default();
        if document.scenes.is_empty() {
            scene.outlines.unpicked = Unpicked::Dashed;
        }
        let size = document.geometry.as_ref().map_or([1; 3], SurveyGeometry::size);
        Self {
            scene,
            layout: Layout::Block,
            compare: Compare::Blend,
            wipe: 0.5,
            slices: size.map(|count| (count / 2) as f64),
            proportions: None,
            fence: Vec::new(),
            panel: Panel::Layers,
            layer: None,
            horizon: None,
            handles: true,
            hidden: Hidden::default(),
            volumes: SectionVolumes::default(),
            picking: Picking::default(),
        }
    }

    /// Shows a scene, if it fits the survey.
    pub(crate) fn show(&mut self, scene: Scene, document: &Document) {
        if document.geometry.as_ref().is_some_and(|geometry| scene.validate(geometry).is_ok()) {
            self.scene = scene;
        }
    }

    /// Drops references to what the project no longer has.
    pub fn fit(&mut self, document: &Document) {
        let Some(geometry) = &document.geometry else { return };
        if self.scene.validate(geometry).is_err() {
            self.scene = ViewState::of(document).scene;
        }
        if document.horizons.is_empty() {
            self.scene.ground = None;
        }
        if document.volumes.is_empty() {
            self.scene.blend = 0.0;
        } else if document.horizons.is_empty() {
            self.scene.blend = 1.0;
        }
        let last = VoxelBox::of_size(geometry.size()).max;
        for (at, last) in self.slices.iter_mut().zip(last) {
            *at = at.clamp(0.0, last).round();
        }
        for corner in &mut self.fence {
            *corner = [0, 1].map(|axis| corner[axis].clamp(0.0, last[axis]));
        }
        self.hidden.fit(document);
        self.volumes.fit(document);
        self.layer = self.layer.take().filter(|name| document.layers().contains(name));
        self.horizon = self.horizon.take().filter(|name| document.horizons.iter().any(|entry| entry.name == *name));
    }
}
