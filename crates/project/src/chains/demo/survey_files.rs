//! A synthetic survey on disk, in the files in which a survey arrives from elsewhere, with its truth beside it and what
//! an interpreter would state about the files.
//!
//! ```text
//! survey.sgy  attribute.sgy   seismic; acoustic impedance of another size and a smaller extent
//! horizons/NAME.csv           all sheets: two depths at one trace across the reverse fault
//! horizons/NAME-N.irap        sheet N alone, since the format holds one depth at a node
//! faults/NAME.ts              triangles up to the tip
//! faults/NAME.dat             the same as sticks (OpendTect)
//! horizons/Salt.ts            the outline of the salt, if there is some
//! truth.json                  the closed form, the age order and where the attribute lies
//! ```

use crate::error::ProjectError;
use files::Format;
use files::segy::WriteOptions;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use store::{StoreError, replace_file};
use survey::{Contact, Fault, Horizon, Progress};
use synth::{Overturned, SynthDesign, SynthSettings, SynthTruth};
use system::command_line::CommandLine;
use system::file::FileAction;
use system::{file, memory};

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
    /// The closed form that all of it follows.
    pub truth: PathBuf,
}

/// A horizon file and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SynthHorizon {
    /// Name.
    pub name: String,
    /// Its contact with its neighbours.
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

/// Makes a survey and writes it to the folder `out`, whatever its size: samples are made a few inlines at a time.
///
/// # Errors
/// The size is too small for the survey's folds and faults, a file could not be written, or the user cancelled.
pub fn write(out: &Path, settings: &SynthSettings, progress: &Progress) -> Result<SynthSurvey, ProjectError> {
    let design = SynthDesign::new(settings)?;
    files::segy::check_room(&out.join("survey.sgy"), &design.geometry, &WriteOptions::default())?;
    let [inlines, crosslines, _] = settings.size;
    memory::check("the horizons of the survey", &[inlines, crosslines], TRACE_BYTES)?;
    let made_faults = design.faults();
    let files = write_files(&design, &made_faults, out, progress)?;
    let stratigraphy = design.stratigraphy();
    let horizons = stratigraphy.horizons.iter().zip(files.horizons);
    let faults = made_faults.iter().zip(files.faults);
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
        layer_names: stratigraphy.layer_names,
        truth: files.truth,
    })
}

/// Where the parts of a synthetic survey were written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SynthFiles {
    /// The seismic, SEG-Y.
    pub survey: PathBuf,
    /// The acoustic impedance, SEG-Y.
    pub attribute: PathBuf,
    /// A CSV file for each horizon, in the order of [`SynthDesign::horizons`].
    pub horizons: Vec<PathBuf>,
    /// A TSurf file for each fault, in the order of the faults.
    pub faults: Vec<PathBuf>,
    /// The closed form, JSON.
    pub truth: PathBuf,
}

/// Memory that horizons take for each trace while they are made and written, bytes.
const TRACE_BYTES: usize = 200;

/// Lines of the attribute that are made at a time.
const ATTRIBUTE_LINES: usize = 16;

/// Writes a survey and its interpretation into the folder `out`, which is created if necessary.
///
/// # Errors
/// A file cannot be written or the user cancelled; files written before that stay.
pub fn write_files(
    design: &SynthDesign,
    made_faults: &[Fault],
    out: &Path,
    progress: &Progress,
) -> Result<SynthFiles, ProjectError> {
    let folder = |name: &str| {
        let path = out.join(name);
        file::create_folders(&path).map_err(|source| StoreError::io(FileAction::Written, &path, source)).map(|()| path)
    };
    let (horizons, faults) = (folder("horizons")?, folder("faults")?);
    let options = WriteOptions::default();
    let survey = out.join("survey.sgy");
    let mut seismic = design.seismic(progress)?;
    let together = seismic.together();
    let mut source = |lines: Range<usize>| Ok(Cow::Owned(seismic.lines(lines)));
    files::segy::write_lines(&survey, &design.geometry, None, &options, together, &mut source, progress)?;
    drop(seismic);
    let attribute = out.join("attribute.sgy");
    let lattice = &design.attribute.geometry;
    let mut source = |lines: Range<usize>| Ok(Cow::Owned(design.impedance(lines)));
    files::segy::write_lines(&attribute, lattice, None, &options, ATTRIBUTE_LINES, &mut source, progress)?;

    let mut files =
        SynthFiles { survey, attribute, horizons: Vec::new(), faults: Vec::new(), truth: out.join("truth.json") };
    for horizon in design.horizons() {
        progress.check()?;
        let stem = &horizon.name;
        if horizon.surface.is_some() {
            let tsurf = horizons.join(format!("{stem}.ts"));
            files::write_horizon(&tsurf, &horizon, &design.geometry, Format::Tsurf)?;
            files.horizons.push(tsurf);
            continue;
        }
        let csv = horizons.join(format!("{stem}.csv"));
        files::write_horizon(&csv, &horizon, &design.geometry, Format::Csv)?;
        for (n, sheet) in horizon.sheets.iter().enumerate() {
            let alone = Horizon::new(horizon.name.clone(), vec![sheet.clone()]);
            let irap = horizons.join(format!("{stem}-{n}.irap"));
            files::write_horizon(&irap, &alone, &design.geometry, Format::Irap)?;
        }
        files.horizons.push(csv);
    }
    for fault in made_faults {
        progress.check()?;
        let stem = &fault.name;
        let tsurf = faults.join(format!("{stem}.ts"));
        files::write_fault(&tsurf, fault, &design.geometry, Format::Tsurf)?;
        files::write_fault(&faults.join(format!("{stem}.dat")), fault, &design.geometry, Format::OpendTect)?;
        files.faults.push(tsurf);
    }
    let truth = json!({
        "geometry": design.geometry,
        "stratigraphy": design.stratigraphy(),
        "attribute": { "origin": design.attribute.origin, "extent": design.attribute.extent },
        "truth": design.truth,
    });
    replace_file(&files.truth, format!("{truth:#}\n").as_bytes())?;
    Ok(files)
}

/// The files of an outcrop, and the commands that make a project of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutcropFiles {
    /// Scattered points, CSV, youngest first.
    pub horizons: Vec<PathBuf>,
    /// Triangles, TSurf.
    pub faults: Vec<PathBuf>,
    /// The closed form, JSON.
    pub truth: PathBuf,
    /// `X0,X1,Y0,Y1,Z0,Z1` of the block, as `create --bounds` takes it.
    pub bounds: String,
    /// Inlines, crosslines, samples, as `create --size` takes it.
    pub size: String,
}

impl fmt::Display for OutcropFiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.horizons.iter().chain(&self.faults).try_for_each(|file| writeln!(f, "{}", file.display()))?;
        writeln!(f, "{}: the truth", self.truth.display())?;
        let line = CommandLine::new("create").value("OUTCROP.petro");
        write!(f, "{}", line.option("--bounds", &self.bounds).option("--size", &self.size))
    }
}

/// Makes an outcrop ([`synth::Overturned`]) and writes it to the folder `out`.
///
/// # Errors
/// The size is too small, a file could not be written, or the user cancelled.
pub fn write_outcrop(
    out: &Path,
    size: [usize; 3],
    seed: u64,
    progress: &Progress,
) -> Result<OutcropFiles, ProjectError> {
    let made = Overturned::generate(size, seed)?;
    let folder = |name: &str| {
        let path = out.join(name);
        file::create_folders(&path).map_err(|source| StoreError::io(FileAction::Written, &path, source)).map(|()| path)
    };
    let (horizons, faults) = (folder("horizons")?, folder("faults")?);
    let last = made.geometry.world_from_voxel(glam::DVec3::from_array(size.map(|n| n as f64 - 1.0)));
    let first = made.geometry.world_from_voxel(glam::DVec3::ZERO);
    let bounds = [first.x, last.x, first.y, last.y, first.z, last.z].map(|c| c.to_string()).join(",");
    let size = size.map(|n| n.to_string()).join("x");
    let truth = out.join("truth.json");
    let mut files = OutcropFiles { horizons: Vec::new(), faults: Vec::new(), truth, bounds, size };
    for horizon in &made.horizons {
        progress.check()?;
        let csv = horizons.join(format!("{}.csv", horizon.name));
        files::write_horizon(&csv, horizon, &made.geometry, Format::Csv)?;
        files.horizons.push(csv);
    }
    for fault in &made.faults {
        progress.check()?;
        let tsurf = faults.join(format!("{}.ts", fault.name));
        files::write_fault(&tsurf, fault, &made.geometry, Format::Tsurf)?;
        files.faults.push(tsurf);
    }
    let truth = json!({ "geometry": made.geometry, "stratigraphy": made.stratigraphy, "outcrop": made.truth });
    replace_file(&files.truth, format!("{truth:#}\n").as_bytes())?;
    Ok(files)
}

/// Reads the truth that [`write_files`] left in a folder (or its `truth.json` itself).
///
/// # Errors
/// [`ProjectError::NotATruth`] if there is none, or the file is not one.
pub fn read_truth(path: &Path) -> Result<SynthTruth, ProjectError> {
    #[derive(Deserialize)]
    struct File {
        truth: SynthTruth,
    }
    let path = if path.is_dir() { path.join("truth.json") } else { path.to_owned() };
    let unusable = |fact: String| ProjectError::NotATruth { path: path.clone(), fact };
    let text = file::read_text(&path, file::MAX_INTERPRETATION_BYTES).map_err(|error| unusable(error.to_string()))?;
    let File { truth } = serde_json::from_str(&text).map_err(|error| unusable(error.to_string()))?;
    Ok(truth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use synth::Synthetic;

    #[test]
    fn the_written_survey_reads_back_as_it_was_made() {
        let dir = tempfile::tempdir().unwrap();
        let settings = SynthSettings { size: [72, 64, 96], seed: 1, ..SynthSettings::default() };
        let survey = Synthetic::generate(&settings, &Progress::silent()).unwrap();
        let design = SynthDesign::new(&settings).unwrap();
        let files = write_files(&design, &survey.faults, &dir.path().join("new"), &Progress::silent()).unwrap();
        for (path, geometry, volume) in [
            (&files.survey, &survey.geometry, &survey.seismic),
            (&files.attribute, &survey.attribute.geometry, &survey.attribute.volume),
        ] {
            let read = files::segy::read(path, &files::segy::SegyOptions::default(), &Progress::silent()).unwrap();
            assert!(read.volume.samples() == volume.samples(), "{}", path.display());
            let (place, there) = (DVec3::new(3.0, 5.0, 7.0), &read.geometry);
            assert!((there.world_from_voxel(place) - geometry.world_from_voxel(place)).length() < 0.02);
        }
        let options = files::ImportOptions::default();
        for (path, horizon) in files.horizons.iter().zip(&survey.horizons) {
            let (read, _) = &files::read_horizons(path, &survey.geometry, &options).unwrap()[0];
            assert_eq!(read.name, horizon.name);
            let depths = |h: &Horizon| {
                let mut all: Vec<f32> = h.sheets.iter().flat_map(|s| s.depth.iter().copied()).collect();
                all.retain(|depth| depth.is_finite());
                all.sort_by(f32::total_cmp);
                all
            };
            let (a, b) = (depths(read), depths(horizon));
            assert_eq!(a.len(), b.len(), "{}", horizon.name);
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 0.01));
        }
        for (path, fault) in files.faults.iter().zip(&survey.faults) {
            let index = survey.faults.iter().position(|f| f.name == fault.name).unwrap();
            for path in [path.clone(), path.with_extension("dat")] {
                let (read, _) = &files::read_fault(&path, &survey.geometry, &options).unwrap()[0];
                assert!(!read.mesh.triangles.is_empty(), "{}", path.display());
                for &vertex in &read.mesh.vertices {
                    let voxel = survey.geometry.voxel_from_world(vertex);
                    assert!(survey.truth.fault_side_m(index, voxel).abs() < 0.15, "{}", path.display());
                }
            }
            let (triangles, _) = &files::read_fault(path, &survey.geometry, &options).unwrap()[0];
            assert_eq!((&triangles.name, &triangles.mesh.triangles), (&fault.name, &fault.mesh.triangles));
        }
        let truth = read_truth(&files.truth).unwrap();
        let places = (0..72 * 64 * 4 * truth.horizons.len()).step_by(101);
        for (h, b, x, y) in
            places.map(|n| (n / 4 / 72 / 64, (n % 4) as u16, (n / 4 / 64 % 72) as f64, (n / 4 % 64) as f64))
        {
            assert!((truth.sheet_z(h, b, x, y) - survey.truth.sheet_z(h, b, x, y)).abs() < 1e-9);
        }
    }
}
