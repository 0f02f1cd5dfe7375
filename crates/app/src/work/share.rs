//! The block for people without the program: what a reader will see, and the files.

use crate::state::{ShareForm, ShareKind};
use project::pictures::Device;
use project::{Project, ProjectError, memory_budget};
use review::{Model, ReviewSettings, SizeEstimate, glb, html};
use std::path::Path;
use survey::Progress;

/// Texels along the longest side of the block in a preview.
const PREVIEW_DENSITY: f64 = 360.0;

/// A page or a model, coarser than it is written.
pub struct SharePreview {
    /// What it was made for: [`ShareForm::previewed`].
    pub form: ShareForm,
    /// What is in it.
    pub model: Model,
    /// Triangles of the file.
    pub triangles: usize,
    /// The distances within which 99 % of the places of every surface, and all, are from the interpretation, m.
    pub deviations_m: [f64; 2],
    size: SizeEstimate,
}

impl SharePreview {
    /// About how many bytes the file will have.
    pub fn bytes(&self, density: f64) -> u64 {
        self.size.at(density / PREVIEW_DENSITY)
    }
}

/// The settings of what is shared.
fn settings(project: &Project, form: &ShareForm, density: f64) -> ReviewSettings {
    let scenes = form.scenes(project.document().scenes.iter().map(|entry| entry.name.as_str()));
    ReviewSettings::new(density, form.sections, scenes, Device::Auto, memory_budget::half_of_available())
}

/// Makes what is shared, to be looked at.
///
/// # Errors
/// There is nothing to show, data cannot be read or drawn, the triangles are too few, or the user cancelled.
pub fn preview(root: &Path, form: &ShareForm, progress: &Progress) -> Result<SharePreview, ProjectError> {
    let project = Project::open(root)?;
    let settings = settings(&project, form, PREVIEW_DENSITY);
    let made = || -> Result<_, ProjectError> {
        Ok(match form.kind {
            ShareKind::Page => {
                let model = review::make(&project, &settings, progress)?;
                let size = html::estimate(&model)?;
                (html::triangles(&model), surfaces(&model), size, model)
            }
            ShareKind::Model => {
                let made = glb::prepare(&project, &settings, form.triangles, progress)?;
                let deviations = [made.facts.usual_deviation_m, made.facts.deviation_m];
                (made.facts.triangles, deviations, made.estimate(), made.model)
            }
        })
    };
    let (triangles, deviations_m, size, model) = super::compute_apart(made)?;
    Ok(SharePreview { form: form.previewed(), model, triangles, deviations_m, size })
}

/// How far surfaces are from what they stand for.
fn surfaces(model: &Model) -> [f64; 2] {
    let all = model.horizons.iter().chain(&model.faults);
    all.fold([0.0, 0.0], |[usual, most], surface| [surface.usual_deviation_m.max(usual), surface.deviation_m.max(most)])
}

/// Writes the file; sentences about it.
///
/// # Errors
/// As [`preview`]; the page cannot be as small as it must, or the file cannot be written.
pub fn write(root: &Path, form: &ShareForm, progress: &Progress) -> Result<Vec<String>, ProjectError> {
    let project = Project::open(root)?;
    let settings = settings(&project, form, form.density);
    let path = Path::new(form.path());
    let megabytes = |bytes: u64| format!("{:.1} MB", bytes as f64 / 1e6);
    let written = || match form.kind {
        ShareKind::Page => {
            let model = review::make(&project, &settings, progress)?;
            let page = html::write(&model, path, (form.limit_mb * 1e6) as u64, progress)?;
            let mut told = vec![format!("{}: {}", path.display(), megabytes(page.bytes))];
            if page.density_share < 1.0 {
                told.push(format!(
                    "pictures of faces have {:.0} % of the detail that was asked for, so that the page has at most {} MB",
                    100.0 * page.density_share,
                    form.limit_mb
                ));
            }
            Ok(told)
        }
        ShareKind::Model => {
            let model = glb::export(&project, &settings, form.triangles, path, progress)?;
            Ok(vec![format!("{}: {}, {} triangles", path.display(), megabytes(model.bytes), model.triangles)])
        }
    };
    super::compute_apart(written)
}
