//! A synthetic survey on disk, as a survey comes from others, with what an interpreter would say about its files.

use crate::error::ProjectError;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};
use survey::synth::{SynthSettings, Synthetic};
use survey::{Contact, Progress};

/// Files of a synthetic survey.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SynthSurvey {
    /// Seismic, SEG-Y.
    pub survey: PathBuf,
    /// Acoustic impedance of another size and a smaller extent, SEG-Y.
    pub attribute: PathBuf,
    /// Horizons, youngest first.
    pub horizons: Vec<SynthHorizon>,
    /// Faults.
    pub faults: Vec<SynthFault>,
    /// Names of the layers, youngest first.
    pub layer_names: Vec<String>,
    /// The closed form behind it all.
    pub truth: PathBuf,
}

/// A horizon file and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SynthHorizon {
    /// Name.
    pub name: String,
    /// What it does to its neighbours.
    pub contact: Contact,
    /// All its sheets, CSV.
    pub file: PathBuf,
}

/// A fault file and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SynthFault {
    /// Name.
    pub name: String,
    /// The fault it ends at.
    pub truncated_by: Option<String>,
    /// Its triangles, TSurf.
    pub file: PathBuf,
}

impl fmt::Display for SynthSurvey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.survey.display())?;
        writeln!(f, "{}", self.attribute.display())?;
        for horizon in &self.horizons {
            let contact = format!("{:?}", horizon.contact).to_lowercase();
            writeln!(f, "{}: horizon {}, {contact}", horizon.file.display(), horizon.name)?;
        }
        self.faults.iter().try_for_each(|fault| writeln!(f, "{}: fault {}", fault.file.display(), fault.name))?;
        writeln!(f, "{}: the truth", self.truth.display())
    }
}

/// Makes a survey and writes it to the folder `out`.
///
/// # Errors
/// A size too small for its folds and faults, files that could not be written, or cancelled.
pub fn write(out: &Path, settings: &SynthSettings, progress: &Progress) -> Result<SynthSurvey, ProjectError> {
    let made = Synthetic::generate(settings, progress)?;
    let files = made.write_dir(out, progress)?;
    let horizons = made.stratigraphy.horizons.iter().zip(files.horizons);
    let faults = made.faults.iter().zip(files.faults);
    Ok(SynthSurvey {
        survey: files.survey,
        attribute: files.attribute,
        horizons: horizons
            .map(|(place, file)| SynthHorizon { name: place.name.clone(), contact: place.contact, file })
            .collect(),
        faults: faults
            .map(|(fault, file)| SynthFault {
                name: fault.name.clone(),
                truncated_by: fault.truncated_by.clone(),
                file,
            })
            .collect(),
        layer_names: made.stratigraphy.layer_names.clone(),
        truth: files.truth,
    })
}
