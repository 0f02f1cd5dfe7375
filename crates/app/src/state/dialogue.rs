//! What the window asks for in front of everything else.

use std::path::PathBuf;

/// What a file or folder is chosen for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// A project to open.
    Project,
    /// A SEG-Y file to begin a project with.
    NewSurvey,
    /// A SEG-Y file for the open project.
    MoreSurvey,
    /// A horizon file.
    Horizon,
    /// A fault file.
    Fault,
    /// A well's deviation file.
    Well,
    /// A picture to tile layers with.
    Texture,
    /// A folder for the demonstration.
    Demo,
}

/// Where a survey goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Into a project of its own.
    NewProject,
    /// Into the open project.
    OpenProject,
}

/// What an interpretation file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpreted {
    /// A horizon.
    Horizon,
    /// A fault.
    Fault,
}

/// Something asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Dialogue {
    /// A file or folder.
    Choose(Choice),
    /// How to read a survey.
    Survey {
        /// The file.
        path: PathBuf,
        /// Where it goes.
        target: Target,
    },
    /// How to read a horizon or fault.
    Interpretation {
        /// The file.
        path: PathBuf,
        /// What it holds.
        kind: Interpreted,
    },
    /// What a file that was dropped on the window holds.
    Dropped {
        /// The file.
        path: PathBuf,
    },
    /// How to read a well.
    Well {
        /// Where it runs.
        path: PathBuf,
    },
    /// Which pattern a layer gets.
    Patterns {
        /// The layer.
        layer: String,
        /// Which of its depth intervals, from the bottom; absent: the whole layer.
        interval: Option<usize>,
    },
    /// Where to draw to.
    Export(ExportForm),
    /// The list of shortcuts.
    Shortcuts,
}

/// Millimetres in an inch.
const INCH_MM: f64 = 25.4;

/// A picture as it is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportForm {
    /// PNG file to write.
    pub path: String,
    /// Width and height on paper, cm.
    pub size_cm: [f64; 2],
    /// Dots an inch.
    pub dpi: f64,
    /// Patterns with the layers' names beside the picture; while interpreting, the horizons' colours.
    pub legend: Shown,
    /// Lengths below the block.
    pub scale_bar: Shown,
}

/// Whether something is part of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// It is.
    Yes,
    /// It is not.
    No,
}

impl ExportForm {
    /// A third of a page in print quality.
    pub fn new(path: String) -> Self {
        Self { path, size_cm: [16.0, 11.0], dpi: 300.0, legend: Shown::Yes, scale_bar: Shown::Yes }
    }

    /// Size in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_cm.map(|cm| (cm * 10.0 / INCH_MM * self.dpi).round().clamp(1.0, 60_000.0) as u32)
    }

    /// Dots in a point of lettering.
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
}
