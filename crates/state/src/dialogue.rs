//! The dialogues.

use figure::Annotation;
use files::segy::{self, WriteFormat};
use files::{Format, SurfaceKind};
use review::ShareKind;
use review::glb::OFFICE_TRIANGLES;
use review::html::SIZE_MB;
use std::path::{Path, PathBuf};

/// What a file or folder is chosen for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// A project to open.
    Project,
    /// A SEG-Y file to start a project with.
    NewSurvey,
    /// A SEG-Y file for the open project.
    MoreSurvey,
    /// A horizon file.
    Horizon,
    /// A fault file.
    Fault,
    /// A well's deviation file.
    Well,
    /// A picture to use as a tile of a pattern.
    Texture,
    /// A folder for the demonstration.
    Demo,
}

/// The target of an import.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// A new project.
    NewProject,
    /// Into the open project.
    OpenProject,
}

/// What an interpretation file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileContent {
    /// A horizon.
    Horizon,
    /// A fault.
    Fault,
}

/// A dialogue.
#[derive(Debug, Clone, PartialEq)]
pub enum Dialogue {
    /// Choose a file or folder.
    Choose(Choice),
    /// State how to read a survey.
    Survey {
        /// The file.
        path: PathBuf,
        /// The target of the import.
        target: Target,
    },
    /// State how to read a horizon or fault.
    Interpretation {
        /// The file.
        path: PathBuf,
        /// What it holds.
        kind: FileContent,
    },
    /// Ask what a file that was dropped on the window holds.
    Dropped {
        /// The file.
        path: PathBuf,
    },
    /// State how to read a well.
    Well {
        /// The deviation file.
        path: PathBuf,
    },
    /// Choose a pattern for a layer.
    Patterns {
        /// The layer.
        layer: String,
        /// Which of its depth intervals, counted from the bottom; `None`: the whole layer.
        interval: Option<usize>,
    },
    /// Export the picture.
    Export(ExportForm),
    /// Share the block with people without the program.
    Share(ShareForm),
    /// Write a volume, a horizon or a fault for other programs.
    Data(DataForm),
    /// The list of shortcuts.
    Shortcuts,
}

impl Dialogue {
    /// Whether it asks for this file to be written.
    pub fn writes(&self, path: &Path) -> bool {
        let stated = match self {
            Self::Export(form) => form.path.as_str(),
            Self::Share(form) => form.path(),
            Self::Data(form) => form.path.as_str(),
            _ => return false,
        };
        [stated, stated.trim()].iter().any(|stated| Path::new(stated) == path)
    }
}

/// What is written for other programs, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Written {
    /// A horizon or a fault in a format.
    Surface(SurfaceKind, Format),
    /// A volume as SEG-Y with samples of this format; `None`: as they are stored.
    Volume(Option<WriteFormat>),
}

impl Written {
    /// The defaults: a table of a horizon, triangles of a fault.
    pub fn surface(kind: SurfaceKind) -> Self {
        Self::Surface(kind, if kind == SurfaceKind::Horizon { Format::Csv } else { Format::Tsurf })
    }

    /// What it is called.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Surface(SurfaceKind::Horizon, _) => "horizon",
            Self::Surface(SurfaceKind::Fault, _) => "fault",
            Self::Volume(_) => "volume",
        }
    }

    /// The usual ending of its files.
    fn extension(self) -> &'static str {
        match self {
            Self::Surface(_, format) => format.extension(),
            Self::Volume(_) => segy::ENDINGS[0],
        }
    }
}

/// What is written of the project's data, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DataForm {
    /// What it is, and the file's format.
    pub what: Written,
    /// Its name.
    pub name: String,
    /// File to write.
    pub path: String,
}

impl DataForm {
    /// A file beside the project in `folder`.
    pub fn new(what: Written, name: &str, folder: Option<&Path>) -> Self {
        let plain: String =
            name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
        let file = format!("{plain}.{}", what.extension());
        let path = folder.map_or_else(|| PathBuf::from(&file), |folder| folder.join(&file)).display().to_string();
        Self { what, name: name.to_owned(), path }
    }

    /// Takes another format, and the file's ending with it where that was the usual one.
    pub fn choose(&mut self, what: Written) {
        if let Some(stem) = self.path.strip_suffix(&format!(".{}", self.what.extension())) {
            self.path = format!("{stem}.{}", what.extension());
        }
        self.what = what;
    }
}

/// Millimetres in an inch.
const INCH_MM: f64 = 25.4;

/// The settings of an export.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportForm {
    /// File to write; the ending of its name says what it holds.
    pub path: String,
    /// Width and height on paper, cm.
    pub size_cm: [f64; 2],
    /// Dots an inch.
    pub dpi: f64,
    /// List the layers with their patterns beside the picture; while interpreting, the horizons with their colours.
    pub legend: Shown,
    /// Draw a scale bar below the block.
    pub scale_bar: Shown,
    /// Draw a north arrow below the block.
    pub north_arrow: Shown,
    /// What is written on and around the block.
    pub annotate: Vec<Annotation>,
    /// Whose data it shows; empty: not said.
    pub credit: String,
    /// A line above the picture; empty: none.
    pub title: String,
    /// A sentence or two below the picture; empty: none.
    pub caption: String,
    /// What sections and fences on the page show.
    pub section_fill: SectionFill,
    /// Whether a picture is wanted although a horizon was picked on less than half of its traces.
    pub accepts_sparse: bool,
}

/// What sections and fences show on a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionFill {
    /// Measured data, as on the screen.
    Measured,
    /// Measured data and the rock, half and half.
    Half,
    /// The rock with its patterns.
    Rock,
}

impl SectionFill {
    /// The share of measured data; `None`: measured data where there are some.
    pub fn blend(self) -> Option<f32> {
        match self {
            Self::Measured => None,
            Self::Half => Some(0.5),
            Self::Rock => Some(0.0),
        }
    }
}

/// Whether the page has a part such as a legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// It is.
    Yes,
    /// It is not.
    No,
}

impl ExportForm {
    /// The defaults: a third of a page in print quality.
    pub fn new(path: String) -> Self {
        Self {
            path,
            size_cm: [16.0, 11.0],
            dpi: 300.0,
            legend: Shown::Yes,
            scale_bar: Shown::Yes,
            north_arrow: Shown::No,
            annotate: vec![Annotation::Axes, Annotation::Layers, Annotation::Faults],
            credit: String::new(),
            title: String::new(),
            caption: String::new(),
            section_fill: SectionFill::Measured,
            accepts_sparse: false,
        }
    }

    /// Size in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_cm.map(|cm| (cm * 10.0 / INCH_MM * self.dpi).round().clamp(1.0, 60_000.0) as u32)
    }

    /// Pixels in a point of lettering.
    pub fn px_per_mm(&self) -> f64 {
        self.dpi / INCH_MM
    }
}

/// What is shared, and where it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct ShareForm {
    /// Whether it is the page or the model.
    pub kind: ShareKind,
    /// The page's file.
    pub page: String,
    /// The model's file.
    pub model: String,
    /// Scenes that the page leaves out.
    pub left_out: Vec<String>,
    /// The scene that the model shows; `None`: the first, or the default view.
    pub scene: Option<String>,
    /// Texels along the longest side of the block.
    pub density: f64,
    /// Sections of each kind to step through in the page.
    pub sections: usize,
    /// Largest size of the page, MB.
    pub limit_mb: f64,
    /// Most triangles of the model.
    pub triangles: usize,
    /// Whether it is wanted although a horizon was hardly picked.
    pub accepts_sparse: bool,
}

impl ShareForm {
    /// The defaults, with files beside the project in `root`.
    pub fn new(root: &Path) -> Self {
        let beside = |kind: ShareKind| root.with_extension(kind.ending()).display().to_string();
        Self {
            kind: ShareKind::Page,
            page: beside(ShareKind::Page),
            model: beside(ShareKind::Model),
            left_out: Vec::new(),
            scene: None,
            density: review::DENSITY,
            sections: review::SECTIONS,
            limit_mb: SIZE_MB,
            triangles: OFFICE_TRIANGLES,
            accepts_sparse: false,
        }
    }

    /// The file to write.
    pub fn path(&self) -> &str {
        match self.kind {
            ShareKind::Page => self.page.trim(),
            ShareKind::Model => self.model.trim(),
        }
    }

    /// Whether the file has the ending of what it is.
    pub fn has_ending(&self) -> bool {
        self.kind.is_of(Path::new(self.path()))
    }

    /// The scenes that are shown of those that a project has; none of them: the default view.
    pub fn scenes<'a>(&self, of_project: impl Iterator<Item = &'a str>) -> Vec<String> {
        let is_wanted = |name: &str| match self.kind {
            ShareKind::Page => !self.left_out.iter().any(|left_out| left_out == name),
            ShareKind::Model => self.scene.as_deref() == Some(name),
        };
        of_project.filter(|name| is_wanted(name)).map(str::to_owned).collect()
    }

    /// What of it decides what is previewed: not where files lie, nor what only their size depends on.
    pub fn previewed(&self) -> Self {
        let (density, limit_mb) = (review::DENSITY, SIZE_MB);
        Self { page: String::new(), model: String::new(), density, limit_mb, accepts_sparse: false, ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shared_has_the_ending_and_the_scenes_of_its_kind() {
        let mut form = ShareForm::new(Path::new("work/north.petro"));
        assert!(form.has_ending() && form.path().ends_with("north.html"));
        form.left_out = vec!["b".to_owned()];
        assert_eq!(form.scenes(["a", "b", "c"].into_iter()), ["a", "c"]);
        (form.kind, form.scene) = (ShareKind::Model, Some("b".to_owned()));
        assert!(form.has_ending() && form.path().ends_with("north.glb"));
        assert_eq!(form.scenes(["a", "b", "c"].into_iter()), ["b"]);
        let other = ShareForm { model: "x.gltf".to_owned(), density: 64.0, ..form.clone() };
        assert!(!other.has_ending());
        assert_eq!(other.previewed(), form.previewed());
    }

    #[test]
    fn an_inch_has_its_dots() {
        let form = ExportForm { size_cm: [2.54, 5.08], dpi: 300.0, ..ExportForm::new(String::new()) };
        assert_eq!(form.size_px(), [300, 600]);
    }

    #[test]
    fn the_ending_of_a_surfaces_file_follows_its_format() {
        let horizon = Written::surface(SurfaceKind::Horizon);
        let mut form = DataForm::new(horizon, "Top / Chalk", Some(Path::new("work")));
        assert_eq!(Path::new(&form.path), Path::new("work").join("Top___Chalk.csv"));
        form.choose(Written::Surface(SurfaceKind::Horizon, Format::Tsurf));
        assert!(form.path.ends_with("Top___Chalk.ts"), "{}", form.path);
        form.path = "mine.txt".to_owned();
        form.choose(horizon);
        assert_eq!(form.path, "mine.txt");
        assert!(DataForm::new(Written::Volume(None), "seismic", None).path.ends_with("seismic.sgy"));
    }
}
