//! A synthetic survey on disk, as a survey comes from others: SEG-Y volumes, files of horizons and faults, and the truth beside them.
//!
//! ```text
//! survey.sgy  attribute.sgy       seismic; acoustic impedance of another size and a smaller extent
//! horizons/NAME.csv               sheet by sheet, two depths at one trace across the reverse fault
//! faults/NAME.ts                  triangulated up to the tip
//! interpretation.toml             age order, contacts, layer names, files
//! truth/                          the closed form behind it all, and the settings it came from
//! ```

use anyhow::Context;
use serde::Serialize;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use survey::formats::{self, Format};
use survey::segy::{self, WriteOptions};
use survey::synth::{SynthSettings, Synthetic};
use survey::{Contact, Progress};

/// Files of a synthetic survey.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SynthFiles {
    /// Seismic.
    pub survey: PathBuf,
    /// Acoustic impedance.
    pub attribute: PathBuf,
    /// Horizons, youngest first: name, contact, file.
    pub horizons: Vec<InterpretedHorizon>,
    /// Faults: name, file.
    pub faults: Vec<InterpretedFault>,
    /// Names of the layers, youngest first.
    pub layer_names: Vec<String>,
    /// The exact answer.
    pub truth: PathBuf,
}

/// A horizon file and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InterpretedHorizon {
    /// Name.
    pub name: String,
    /// What it does to its neighbours.
    pub contact: Contact,
    /// File.
    pub file: PathBuf,
}

/// A fault file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InterpretedFault {
    /// Name.
    pub name: String,
    /// File.
    pub file: PathBuf,
    /// The fault it ends at.
    pub truncated_by: Option<String>,
}

impl fmt::Display for SynthFiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.survey.display())?;
        writeln!(f, "{}", self.attribute.display())?;
        self.horizons.iter().try_for_each(|h| writeln!(f, "{}: horizon {}", h.file.display(), h.name))?;
        self.faults.iter().try_for_each(|fault| writeln!(f, "{}: fault {}", fault.file.display(), fault.name))?;
        writeln!(f, "{}: the truth", self.truth.display())
    }
}

/// Makes a survey and writes it to the folder `out`.
///
/// # Errors
/// A size too small for its folds and faults, files that could not be written, or cancelled.
pub fn write(out: &Path, settings: &SynthSettings, progress: &Progress) -> anyhow::Result<SynthFiles> {
    let made = Synthetic::generate(settings, progress)?;
    let folder = |name: &str| {
        let path = out.join(name);
        fs::create_dir_all(&path).with_context(|| format!("{} could not be made", path.display())).map(|()| path)
    };
    let (horizons, faults, truth) = (folder("horizons")?, folder("faults")?, folder("truth")?);
    let survey = out.join("survey.sgy");
    segy::write(&survey, &made.geometry, &made.seismic, &WriteOptions::default(), progress)?;
    let attribute = out.join("attribute.sgy");
    let impedance = &made.attribute;
    segy::write(&attribute, &impedance.geometry, &impedance.volume, &WriteOptions::default(), progress)?;
    let mut files = SynthFiles {
        survey,
        attribute,
        horizons: Vec::new(),
        faults: Vec::new(),
        layer_names: made.stratigraphy.layer_names.clone(),
        truth,
    };
    for (horizon, place) in made.horizons.iter().zip(&made.stratigraphy.horizons) {
        progress.check()?;
        let file = horizons.join(format!("{}.csv", horizon.name));
        formats::write_horizon(&file, horizon, &made.geometry, Format::Csv)?;
        files.horizons.push(InterpretedHorizon { name: horizon.name.clone(), contact: place.contact, file });
    }
    for fault in &made.faults {
        let file = faults.join(format!("{}.ts", fault.name));
        formats::write_fault(&file, fault, &made.geometry, Format::Tsurf)?;
        files.faults.push(InterpretedFault {
            name: fault.name.clone(),
            file,
            truncated_by: fault.truncated_by.clone(),
        });
    }
    #[derive(Serialize)]
    struct Interpretation<'a> {
        layer_names: &'a [String],
        horizons: &'a [InterpretedHorizon],
        faults: &'a [InterpretedFault],
    }
    let interpretation =
        Interpretation { layer_names: &files.layer_names, horizons: &files.horizons, faults: &files.faults };
    write_text(&out.join("interpretation.toml"), &toml::to_string_pretty(&interpretation)?)?;
    write_text(&files.truth.join("settings.toml"), &toml::to_string_pretty(settings)?)?;
    write_text(&files.truth.join("truth.json"), &serde_json::to_string_pretty(&made.truth)?)?;
    Ok(files)
}

fn write_text(path: &Path, text: &str) -> anyhow::Result<()> {
    fs::write(path, text).with_context(|| format!("{} could not be written", path.display()))
}
