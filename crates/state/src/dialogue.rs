//! The dialogues.

use figure::Annotation;
use formats::{Format, SurfaceKind};
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
    /// Write a horizon or fault for other programs.
    Surface(SurfaceForm),
    /// The list of shortcuts.
    Shortcuts,
}

/// What is written of a horizon or fault, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SurfaceForm {
    /// Whether it is a horizon or a fault.
    pub kind: SurfaceKind,
    /// Its name.
    pub name: String,
    /// File to write.
    pub path: String,
    /// The file's format.
    pub format: Format,
}

impl SurfaceForm {
    /// The defaults: a table of a horizon, triangles of a fault, beside the project in `folder`.
    pub fn new(kind: SurfaceKind, name: &str, folder: Option<&Path>) -> Self {
        let format = if kind == SurfaceKind::Horizon { Format::Csv } else { Format::Tsurf };
        let plain: String =
            name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
        let file = format!("{plain}.{}", format.extension());
        let path = folder.map_or_else(|| PathBuf::from(&file), |folder| folder.join(&file)).display().to_string();
        Self { kind, name: name.to_owned(), path, format }
    }

    /// Takes another format, and the file's ending with it where that was the usual one.
    pub fn choose(&mut self, format: Format) {
        if let Some(stem) = self.path.strip_suffix(&format!(".{}", self.format.extension())) {
            self.path = format!("{stem}.{}", format.extension());
        }
        self.format = format;
    }
}

/// Millimetres in an inch.
const INCH_MM: f64 = 25.4;

/// The settings of an export.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportForm {
    /// File to write: .png or .tif for pixels, .svg or .pdf for paths and text.
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
    /// Whether a picture is wanted although a horizon was picked on less than half of its traces.
    pub accepts_sparse: bool,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inch_has_its_dots() {
        let form = ExportForm { size_cm: [2.54, 5.08], dpi: 300.0, ..ExportForm::new(String::new()) };
        assert_eq!(form.size_px(), [300, 600]);
    }

    #[test]
    fn the_ending_of_a_surfaces_file_follows_its_format() {
        let mut form = SurfaceForm::new(SurfaceKind::Horizon, "Top / Chalk", Some(Path::new("work")));
        assert_eq!(Path::new(&form.path), Path::new("work").join("Top___Chalk.csv"));
        form.choose(Format::Tsurf);
        assert!(form.path.ends_with("Top___Chalk.ts"), "{}", form.path);
        form.path = "mine.txt".to_owned();
        form.choose(Format::Csv);
        assert_eq!(form.path, "mine.txt");
    }
}
