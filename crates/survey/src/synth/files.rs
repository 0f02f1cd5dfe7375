//! A synthetic survey as files, as a survey comes from others, with its truth beside them.
//!
//! ```text
//! survey.sgy  attribute.sgy   seismic; acoustic impedance of another size and a smaller extent
//! horizons/NAME.csv           all sheets: two depths at one trace across the reverse fault
//! horizons/NAME-N.irap        sheet N alone, since the format holds one depth at a node
//! faults/NAME.ts              triangles up to the tip
//! faults/NAME.dat             the same as sticks (OpendTect)
//! truth.json                  the closed form, the age order and where the attribute lies
//! ```

use super::{SynthTruth, Synthetic};
use crate::formats::{self, Format, FormatError};
use crate::horizon::Horizon;
use crate::progress::{Cancelled, Progress};
use crate::segy::{self, SegyError, WriteOptions};
use crate::store::{StoreError, replace_file};
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// Where the parts of a synthetic survey were written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SynthFiles {
    /// The seismic, SEG-Y.
    pub survey: PathBuf,
    /// The acoustic impedance, SEG-Y.
    pub attribute: PathBuf,
    /// A CSV file for each horizon, in the order of [`Synthetic::horizons`].
    pub horizons: Vec<PathBuf>,
    /// A TSurf file for each fault, in the order of [`Synthetic::faults`].
    pub faults: Vec<PathBuf>,
    /// The closed form, JSON.
    pub truth: PathBuf,
}

/// Why a survey could not be written.
#[derive(Debug, thiserror::Error)]
pub enum SynthFileError {
    /// A SEG-Y file.
    #[error(transparent)]
    Segy(#[from] SegyError),
    /// A horizon or fault file.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A folder or the truth.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A folder without a truth.
    #[error("{} is not the truth of a synthetic survey ({fact}); give the folder that `petroglyph synth` wrote", path.display())]
    Truth {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fact: String,
    },
    /// Stopped by the user.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SynthTruth {
    /// Reads the truth that [`Synthetic::write_dir`] left in a folder (or its `truth.json` itself).
    ///
    /// # Errors
    /// [`SynthFileError::Truth`] when there is none or it is not one.
    pub fn read(path: &Path) -> Result<Self, SynthFileError> {
        #[derive(serde::Deserialize)]
        struct File {
            truth: SynthTruth,
        }
        let path = if path.is_dir() { path.join("truth.json") } else { path.to_owned() };
        let unusable = |fact: String| SynthFileError::Truth { path: path.clone(), fact };
        let text = fs::read_to_string(&path).map_err(|error| unusable(error.to_string()))?;
        let File { truth } = serde_json::from_str(&text).map_err(|error| unusable(error.to_string()))?;
        Ok(truth)
    }
}

impl Synthetic {
    /// Writes the survey and its interpretation into the folder `out`, which is made if need be.
    ///
    /// # Errors
    /// [`SynthFileError`] when a file cannot be written or the user cancelled; files written before that stay.
    pub fn write_dir(&self, out: &Path, progress: &Progress) -> Result<SynthFiles, SynthFileError> {
        let folder = |name: &str| {
            let path = out.join(name);
            fs::create_dir_all(&path).map_err(|source| StoreError::io("written", &path, source)).map(|()| path)
        };
        let (horizons, faults) = (folder("horizons")?, folder("faults")?);
        let options = WriteOptions::default();
        let survey = out.join("survey.sgy");
        segy::write(&survey, &self.geometry, &self.seismic, &options, progress)?;
        let attribute = out.join("attribute.sgy");
        segy::write(&attribute, &self.attribute.geometry, &self.attribute.volume, &options, progress)?;

        let mut files =
            SynthFiles { survey, attribute, horizons: Vec::new(), faults: Vec::new(), truth: out.join("truth.json") };
        for horizon in &self.horizons {
            progress.check()?;
            let stem = &horizon.name;
            let csv = horizons.join(format!("{stem}.csv"));
            formats::write_horizon(&csv, horizon, &self.geometry, Format::Csv)?;
            for (n, sheet) in horizon.sheets.iter().enumerate() {
                let alone = Horizon { name: horizon.name.clone(), sheets: vec![sheet.clone()] };
                let irap = horizons.join(format!("{stem}-{n}.irap"));
                formats::write_horizon(&irap, &alone, &self.geometry, Format::Irap)?;
            }
            files.horizons.push(csv);
        }
        for fault in &self.faults {
            progress.check()?;
            let stem = &fault.name;
            let tsurf = faults.join(format!("{stem}.ts"));
            formats::write_fault(&tsurf, fault, &self.geometry, Format::Tsurf)?;
            formats::write_fault(&faults.join(format!("{stem}.dat")), fault, &self.geometry, Format::OpendTect)?;
            files.faults.push(tsurf);
        }
        let truth = json!({
            "geometry": self.geometry,
            "stratigraphy": self.stratigraphy,
            "attribute": { "origin": self.attribute.origin, "extent": self.attribute.extent },
            "truth": self.truth,
        });
        replace_file(&files.truth, format!("{truth:#}\n").as_bytes())?;
        Ok(files)
    }
}
