//! The content of `project.toml`: the whole state of a project except for the bulk data, to which it refers
//! by file.
//!
//! The text is made for people: it can be read, compared and edited. Every command rewrites it in one fixed
//! order, so that two files differ only where the projects differ.

mod comments;
pub(crate) mod data_file;
mod entries;
mod ids;
mod layers;
mod migration;
mod origin;
mod picks;
mod references;
mod restored;

use crate::error::{Noun, ProjectError};
pub(crate) use entries::is_zero;
pub use entries::{
    ExtractionEntry, FaultEntry, FigureEntry, HorizonEntry, NoteEntry, ParameterizationEntry, Polarity, ProposalsEntry,
    Refinement, SceneEntry, Style, TextureEntry, VolumeEntry, WellEntry,
};
pub use ids::{Id, Renamed};
pub use origin::{AttributeKind, Chooser, HorizonQuery, Origin, QueryBorder, Uninterpreted};
use param::KDefinition;
pub use picks::{Assembly, Drawn, DrawnEntry, FaultSticks, PickEntry};
pub use restored::RestoredEntry;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use survey::geometry::MAX_COORDINATE;
use survey::{StratigraphicHorizon, Stratigraphy, SurveyGeometry};

/// The version that this program writes, and the newest that it reads. Older ones are translated when they are read.
pub const VERSION: u32 = 2;

/// Most steps of a project: far beyond any work, and far from where numbers of 32 bits end.
const MAX_STEP: u32 = 1_000_000_000;

/// The state of a project.
///
/// ```
/// use project::document::Document;
/// use std::path::Path;
///
/// let path = Path::new("north.petro/project.toml");
/// let document = Document::empty(None);
/// let text = document.to_text(path)?;
/// assert_eq!(Document::from_text(&text, path)?, document);
/// # Ok::<(), project::ProjectError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Version of this format.
    pub version: u32,
    /// Position in the history: the number of the command that led here.
    pub step: u32,
    /// The number of the last id that was given; none is given twice.
    #[serde(default)]
    pub last_id: u32,
    /// The lattice in which everything is placed; `None` until a volume is imported or bounds are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<SurveyGeometry>,
    /// The text of the geological history that the block was made from, if it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geological_history: Option<String>,
    /// How many events of it have happened, the last one perhaps in part; absent: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub history_until: Option<f64>,
    /// What the interpretation was restored from, if it was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restored: Option<RestoredEntry>,
    /// Names of the layers, youngest first; if empty, they are named after the horizons.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layer_names: Vec<String>,
    /// Font files for names in letters that the figures' own face lacks, relative to the project's folder, in the order in
    /// which they are asked for a character.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fonts: Vec<String>,
    /// Volumes in order of import; the first is the one shown as raw data.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub volumes: Vec<VolumeEntry>,
    /// The extraction on which picks are made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extraction: Option<ExtractionEntry>,
    /// The faults that were proposed last.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault_proposals: Option<ProposalsEntry>,
    /// Horizons in age order, youngest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub horizons: Vec<HorizonEntry>,
    /// Faults in order of import.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<FaultEntry>,
    /// Wells in order of import.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wells: Vec<WellEntry>,
    /// Sticks of the faults that were drawn here.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sticks: Vec<FaultSticks>,
    /// The user's own tiles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub textures: Vec<TextureEntry>,
    /// Textures of layers and volumes, colours of raw data.
    #[serde(default)]
    pub style: Style,
    /// Definitions of k by layer name; other layers have the default one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub k: BTreeMap<String, KDefinition>,
    /// i, j, k from another program, in place of those computed here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameterization: Option<ParameterizationEntry>,
    /// Named scenes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scenes: Vec<SceneEntry>,
    /// Notes on places, in the order in which they were written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<NoteEntry>,
    /// Figures that are made together, in the order in which they are made.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<FigureEntry>,
}

/// The comment at the top of the file.
const HEADER: &str = "# A Petroglyph project. Commands change this file and remember its former states in \
                      history/; `petroglyph undo` goes back.\n\n";

impl Document {
    /// A project without content.
    pub fn empty(geometry: Option<SurveyGeometry>) -> Self {
        Self {
            version: VERSION,
            step: 0,
            last_id: 0,
            geometry,
            geological_history: None,
            history_until: None,
            restored: None,
            layer_names: Vec::new(),
            fonts: Vec::new(),
            volumes: Vec::new(),
            extraction: None,
            fault_proposals: None,
            horizons: Vec::new(),
            faults: Vec::new(),
            wells: Vec::new(),
            sticks: Vec::new(),
            textures: Vec::new(),
            style: Style::default(),
            k: BTreeMap::new(),
            parameterization: None,
            scenes: Vec::new(),
            notes: Vec::new(),
            figures: Vec::new(),
        }
    }

    /// The text of `project.toml`, with the comments of its former text `old`.
    pub(crate) fn to_text_after(&self, old: &str, path: &Path) -> Result<String, ProjectError> {
        Ok(comments::keep_comments(old, self.to_text(path)?))
    }

    /// The text of `project.toml`.
    pub fn to_text(&self, path: &Path) -> Result<String, ProjectError> {
        let body = toml::to_string_pretty(&self.with_ids())
            .map_err(|error| ProjectError::Malformed { path: path.to_owned(), detail: error.to_string() })?;
        Ok(format!("{HEADER}{body}"))
    }

    /// Reads the text of `project.toml`; `path` is named in errors.
    ///
    /// # Errors
    /// [`ProjectError::Newer`] before anything else is checked; [`ProjectError::Malformed`] otherwise.
    pub fn from_text(text: &str, path: &Path) -> Result<Self, ProjectError> {
        let malformed = |detail: String| ProjectError::Malformed { path: path.to_owned(), detail };
        #[derive(Deserialize)]
        struct Version {
            version: u32,
        }
        let Version { version } = toml::from_str(text).map_err(|error| malformed(error.to_string()))?;
        if version > VERSION {
            return Err(ProjectError::Newer { path: path.to_owned(), found: version, supported: VERSION });
        }
        let mut document: Self = match version {
            VERSION => toml::from_str(text).map_err(|error| malformed(error.to_string()))?,
            _ => migration::read(text, path).map_err(malformed)?,
        };
        document.resolve_ids();
        document.check().map_err(malformed)?;
        Ok(document)
    }

    /// Checks what the types cannot express.
    fn check(&self) -> Result<(), String> {
        if let Some(geometry) = &self.geometry {
            geometry.validate().map_err(|error| error.to_string())?;
        } else if !(self.volumes.is_empty()
            && self.horizons.is_empty()
            && self.faults.is_empty()
            && self.wells.is_empty())
        {
            return Err("it has data but no geometry".to_owned());
        }
        if self.step > MAX_STEP {
            return Err(format!("the step {} is beyond the last that a project can have, {MAX_STEP}", self.step));
        }
        for entry in &self.volumes {
            let own = entry.geometry.as_ref().map_or(Ok(()), SurveyGeometry::validate);
            own.map_err(|error| format!("volume \"{}\": {error}", entry.name))?;
        }
        if !self.layer_names.is_empty() && self.layer_names.len() != self.horizons.len() + 1 {
            return Err(format!(
                "{} horizons make {} layers, but layer_names has {}",
                self.horizons.len(),
                self.horizons.len() + 1,
                self.layer_names.len()
            ));
        }
        for noun in [Noun::Volume, Noun::Horizon, Noun::Fault, Noun::Well, Noun::Layer, Noun::Texture, Noun::Scene] {
            let names = self.names(noun);
            if let Some(twice) = names.iter().enumerate().find(|(index, name)| names[..*index].contains(name)) {
                return Err(format!("two {noun}s are named \"{}\"", twice.1));
            }
        }
        self.check_truncation().map_err(|error| error.to_string())?;
        self.check_growth().map_err(|error| error.to_string())?;
        // With any other name a project could read data that is not its own, and a later command could delete it.
        for (kind, file) in self.files_by_kind() {
            if !data_file::is_data_file(kind, file) {
                return Err(format!("the file \"{file}\" is not of the form {kind}/NAME"));
            }
        }
        Ok(())
    }

    /// The names of one kind, in the project's order.
    pub fn names(&self, noun: Noun) -> Vec<String> {
        match noun {
            Noun::Volume => self.volumes.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Horizon => self.horizons.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Fault => self.faults.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Well => self.wells.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Layer => self.layers(),
            Noun::Texture => self.textures.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Parameterization => self.parameterization.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Scene => self.scenes.iter().map(|entry| entry.name.clone()).collect(),
            Noun::Note => (1..=self.notes.len()).map(|number| number.to_string()).collect(),
            Noun::Figure => self.figures.iter().map(|entry| entry.file.clone()).collect(),
        }
    }

    /// All data files, relative to the project's folder.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files_by_kind().map(|(_, file)| file)
    }

    /// All data files with the folder in which each must lie.
    fn files_by_kind(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let volumes = self.volumes.iter().map(|entry| ("volumes", entry.file.as_str()));
        let horizons = self.horizons.iter().map(|entry| ("horizons", entry.file.as_str()));
        let faults = self.faults.iter().map(|entry| ("faults", entry.file.as_str()));
        let wells = self.wells.iter().map(|entry| ("wells", entry.file.as_str()));
        let textures = self.textures.iter().map(|entry| ("textures", entry.file.as_str()));
        let maps = self.parameterization.iter().map(|entry| ("parameterizations", entry.file.as_str()));
        volumes.chain(horizons).chain(faults).chain(wells).chain(textures).chain(maps)
    }

    /// The horizons' order, contacts and the layers between them.
    pub fn stratigraphy(&self) -> Stratigraphy {
        let horizon = |entry: &HorizonEntry| StratigraphicHorizon { name: entry.name.clone(), contact: entry.contact };
        Stratigraphy { horizons: self.horizons.iter().map(horizon).collect(), layer_names: self.layer_names.clone() }
    }

    /// Which of the horizons outline a body that the program found.
    pub fn outlined(&self) -> Vec<usize> {
        let horizons = self.horizons.iter().enumerate();
        horizons.filter(|(_, entry)| entry.origin == Origin::Outlined).map(|(index, _)| index).collect()
    }

    /// The survey geometry.
    ///
    /// # Errors
    /// [`ProjectError::NoGeometry`] while there is none.
    pub fn frame(&self) -> Result<&SurveyGeometry, ProjectError> {
        self.geometry.as_ref().ok_or(ProjectError::NoGeometry)
    }

    /// What the part of each fault in the model depends on: its triangles, at which fault it ends, how far it grows.
    pub(crate) fn fault_shapes(&self) -> Vec<String> {
        let ends_at = |name: &String| self.faults.iter().position(|fault| fault.name == *name);
        let shape = |fault: &FaultEntry| {
            format!("{} {:?} {}", fault.hash, fault.truncated_by.as_ref().and_then(ends_at), fault.grown_m)
        };
        self.faults.iter().map(shape).collect()
    }

    /// Refuses faults that end at one another in a circle, and faults that end at a fault that does not exist.
    ///
    /// # Errors
    /// [`ProjectError::Unknown`] or [`ProjectError::CircularTruncation`].
    pub(crate) fn check_truncation(&self) -> Result<(), ProjectError> {
        for fault in &self.faults {
            let mut path = vec![fault.name.clone()];
            let mut next = fault.truncated_by.as_deref();
            while let Some(name) = next {
                let index = self.position(Noun::Fault, name)?;
                path.push(name.to_owned());
                if path.len() > self.faults.len() + 1 || name == fault.name {
                    return Err(ProjectError::CircularTruncation { path });
                }
                next = self.faults[index].truncated_by.as_deref();
            }
        }
        Ok(())
    }

    /// Refuses a fault that would reach less than nothing, or beyond any survey, past what was drawn.
    ///
    /// # Errors
    /// [`ProjectError::BadGrowth`].
    pub(crate) fn check_growth(&self) -> Result<(), ProjectError> {
        match self.faults.iter().find(|fault| !(0.0..=MAX_COORDINATE).contains(&fault.grown_m)) {
            Some(fault) => Err(ProjectError::BadGrowth { fault: fault.name.clone(), grown_m: fault.grown_m }),
            None => Ok(()),
        }
    }

    /// The position of a named entry.
    ///
    /// # Errors
    /// [`ProjectError::Unknown`] with the names that exist.
    pub fn position(&self, noun: Noun, name: &str) -> Result<usize, ProjectError> {
        let names = self.names(noun);
        names.iter().position(|present| present == name).ok_or_else(|| match (noun, names.len()) {
            (Noun::Note, 0) => ProjectError::BadNote(format!("there is no note {name}: the project has none")),
            (Noun::Note, count) => {
                ProjectError::BadNote(format!("there is no note {name}: they are numbered 1 to {count}"))
            }
            _ => ProjectError::Unknown { noun, name: name.to_owned(), known: names },
        })
    }

    /// Checks that a name can be given to something new.
    ///
    /// # Errors
    /// [`ProjectError::BadName`]; [`ProjectError::Duplicate`], also if only the case differs, because file systems and
    /// people do not distinguish such names.
    pub(crate) fn check_new_name(&self, noun: Noun, name: &str) -> Result<(), ProjectError> {
        let bad = |fact| Err(ProjectError::BadName { noun, name: name.to_owned(), fact });
        if name.trim().is_empty() {
            return bad("it is empty");
        }
        if name.trim() != name {
            return bad("it begins or ends with a blank");
        }
        if name.chars().any(char::is_control) {
            return bad("it contains control characters");
        }
        if name.chars().count() > 80 {
            return bad("it is longer than 80 characters");
        }
        let lower = name.to_lowercase();
        if self.names(noun).iter().any(|present| present.to_lowercase() == lower) {
            return Err(ProjectError::Duplicate { noun, name: name.to_owned() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::{Contact, VerticalUnit};

    fn horizon(name: &str) -> HorizonEntry {
        HorizonEntry {
            id: Id::default(),
            name: name.into(),
            contact: Contact::Erosional,
            file: format!("horizons/{name}.zarr"),
            hash: "00".into(),
            origin: Origin::Imported { path: "a b.csv".into(), bytes: 10, reading: "csv".into() },
            assembly: None,
            colour: None,
            refined: Vec::new(),
            gap_m: None,
        }
    }

    fn document() -> Document {
        let geometry = SurveyGeometry::regular([11, 21, 31], 25.0, 4.0, VerticalUnit::Milliseconds);
        let mut document = Document::empty(Some(geometry));
        document.horizons = vec![horizon("A"), horizon("B")];
        document
    }

    #[test]
    fn text_and_state_invert() {
        let mut document = document();
        document.resolve_ids();
        let path = Path::new("project.toml");
        let text = document.to_text(path).unwrap();
        let read = Document::from_text(&text, path).unwrap();
        assert_eq!(read, document);
        assert_eq!(read.to_text(path).unwrap(), text);
    }

    #[test]
    fn a_newer_version_is_told_from_a_broken_file() {
        let path = Path::new("project.toml");
        let newer = "version = 99\nsomething_else = true\n";
        assert!(matches!(Document::from_text(newer, path), Err(ProjectError::Newer { found: 99, .. })));
        assert!(matches!(Document::from_text("version = 1\nnonsense = 1", path), Err(ProjectError::Malformed { .. })));
    }

    #[test]
    fn only_data_of_its_own_kind_is_accepted() {
        for file in
            ["/etc/passwd", "../other.petro/horizons/A.zarr", "horizons/../../x", "", "horizons", "volumes/A.zarr"]
        {
            let mut document = document();
            document.horizons[0].file = file.into();
            assert!(document.check().is_err(), "{file}");
        }
    }

    #[test]
    fn names_that_differ_in_case_only_are_duplicates() {
        let document = document();
        assert!(matches!(document.check_new_name(Noun::Horizon, "a"), Err(ProjectError::Duplicate { .. })));
        assert!(matches!(document.check_new_name(Noun::Horizon, " "), Err(ProjectError::BadName { .. })));
        document.check_new_name(Noun::Fault, "A").unwrap();
        assert!(matches!(document.position(Noun::Horizon, "C"), Err(ProjectError::Unknown { .. })));
    }
}
