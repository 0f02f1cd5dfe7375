//! All figures of a project at once, into one folder.
//!
//! What can be refused is refused before the first is made, and none has its name before all are made: a figure that
//! cannot be made leaves the folder as it was.

use super::{FigureSettings, InterpreterView, NamedConfusion, interpreted, make, write};
use crate::Project;
use crate::document::{Document, FigureEntry};
use crate::error::ProjectError;
use crate::folder::refuse_inside_project;
use crate::pictures::{Device, scene};
use figure::{BlockPart, Figure, Part};
use page::FileFormat;
use serde::Serialize;
use std::fs;
use std::path::{Component, Path, PathBuf};
use store::Replacement;
use survey::Progress;

/// A figure that was written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WrittenFigure {
    /// Its file.
    pub file: PathBuf,
    /// Its width and height in pixels at its resolution.
    pub size_px: [u32; 2],
    /// Its resolution, dots per inch.
    pub dpi: f64,
    /// The device that drew its blocks; `None` if it has none.
    pub device: Option<String>,
    /// The neighbouring layers of its blocks that cannot be told apart.
    pub look_alikes: Vec<NamedConfusion>,
}

/// Makes every figure that the project lists, and writes them to the folder `out`, which is created. `volume_bytes` is
/// the largest memory for the samples of a volume, `fonts` are files for letters that the project has no face for.
///
/// # Errors
/// The project lists no figures; one of them has the name of another, a name that is no file's, an ending without a
/// format, a scene that is not there, or cannot be made; a file could not be written; the user cancelled.
pub fn make_all(
    project: &Project,
    out: &Path,
    (device, volume_bytes): (Device, u64),
    fonts: &[PathBuf],
    progress: &Progress,
) -> Result<Vec<WrittenFigure>, ProjectError> {
    let meant = check(project.document(), progress)?;
    for (file, ..) in &meant {
        refuse_inside_project(&out.join(file))?;
    }
    let is_new = !out.exists();
    let written = stage(project, out, &meant, (device, volume_bytes, fonts), progress);
    if written.is_err() && is_new {
        // What was staged is gone by now; a folder in which someone else has put something stays.
        let _ = fs::remove_dir(out);
    }
    written
}

/// A figure that can be made: its file, format and page.
type Meant<'a> = (&'a str, &'static FileFormat, Figure);

/// Makes all figures under hidden names, then gives them their names.
fn stage(
    project: &Project,
    out: &Path,
    meant: &[Meant],
    (device, volume_bytes, fonts): (Device, u64, &[PathBuf]),
    progress: &Progress,
) -> Result<Vec<WrittenFigure>, ProjectError> {
    let mut staged = Vec::new();
    // Held, so that the next figure finds it.
    let mut rock = None;
    for &(file, format, ref figure) in meant {
        let fonts = fonts.to_vec();
        let settings = FigureSettings { format, device, volume_bytes, fonts, picture_dpi: None };
        let (made, loaded) =
            make(project, figure, &InterpreterView::default(), &settings, progress).map_err(of_figure(file))?;
        rock = loaded.rock.or(rock);
        let path = out.join(file);
        let replacement = Replacement::of(&path)?;
        write(&made.page, format, replacement.path(), figure.dpi, &project.title())?;
        let size_px = figure.size_px();
        let (dpi, device, look_alikes) = (figure.dpi, made.device, made.confusions);
        staged.push((replacement, WrittenFigure { file: path, size_px, dpi, device, look_alikes }));
    }
    let mut written = Vec::new();
    for (replacement, figure) in staged {
        replacement.commit()?;
        written.push(figure);
    }
    Ok(written)
}

/// Checks that no figure of a state is refused for its name, format or scene.
///
/// # Errors
/// The first that is.
pub(crate) fn check_all(document: &Document) -> Result<(), ProjectError> {
    if document.figures.is_empty() { Ok(()) } else { check(document, &Progress::silent()).map(drop) }
}

/// The figures, none of which is refused for its name, format or scene.
fn check<'a>(document: &'a Document, progress: &Progress) -> Result<Vec<Meant<'a>>, ProjectError> {
    if document.figures.is_empty() {
        return Err(ProjectError::NoFigures);
    }
    let mut meant: Vec<Meant> = Vec::new();
    for entry in &document.figures {
        let file = entry.file.as_str();
        let bad = |fact: String| ProjectError::BadFigure { file: file.to_owned(), fact };
        let is_name =
            Path::new(file).components().eq([Component::Normal(file.as_ref())]) && !file.contains(['/', '\\']);
        if !is_name {
            return Err(bad("a figure has the name of a file, without a folder".to_owned()));
        }
        // File systems do not all distinguish names by the case of letters.
        if meant.iter().any(|(other, ..)| other.to_lowercase() == file.to_lowercase()) {
            return Err(bad("another figure has this file".to_owned()));
        }
        let format = FileFormat::of_page(file.as_ref())
            .ok_or_else(|| bad(format!("its name must end in {}", page::endings(FileFormat::pages()))))?;
        let has_block = entry.figure.parts.iter().any(|part| matches!(part, Part::Block(_)));
        if entry.scene.is_some() && !has_block && !entry.figure.parts.is_empty() {
            let fact =
                "it names a scene, but none of its parts is a block; leave the scene out, or add the part block = {}";
            return Err(bad(fact.to_owned()));
        }
        let figure = page(document, entry, progress).map_err(of_figure(file))?;
        meant.push((file, format, figure));
    }
    Ok(meant)
}

/// The page of an entry, with its scene in its blocks.
fn page(document: &Document, entry: &FigureEntry, progress: &Progress) -> Result<Figure, ProjectError> {
    let mut figure = entry.figure.clone();
    if figure.parts.is_empty() {
        let mut shown = scene::choose(document, entry.scene.as_deref())?;
        if figure.interpretation {
            shown = interpreted(&shown);
        }
        figure.parts.push(BlockPart { scene: shown, ..BlockPart::default() }.into());
    } else if let Some(name) = &entry.scene {
        let shown = scene::choose(document, Some(name))?;
        let blocks =
            figure.parts.iter_mut().filter_map(|part| if let Part::Block(block) = part { Some(block) } else { None });
        blocks.for_each(|block| block.scene = if figure.interpretation { interpreted(&shown) } else { shown.clone() });
    }
    for part in &mut figure.parts {
        if let Part::Block(block) = part {
            scene::prepare(document, &mut block.scene, progress)?;
        }
    }
    Ok(figure)
}

/// Names the figure in an error that is about the figure.
fn of_figure(file: &str) -> impl Fn(ProjectError) -> ProjectError + use<'_> {
    move |error| match error {
        ProjectError::Unknown { .. } | ProjectError::Scene(_) | ProjectError::Figure(_) | ProjectError::Memory(_) => {
            ProjectError::BadFigure { file: file.to_owned(), fact: error.to_string() }
        }
        other => other,
    }
}
