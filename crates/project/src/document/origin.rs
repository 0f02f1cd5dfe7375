//! Where the data of a project came from. It is a fact that is asked for; words are made of it only where they are shown.

use super::references::{FAULT, HORIZON, VOLUME};
use super::{Document, VolumeEntry};
use crate::error::{Noun, ProjectError};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use survey::Quantity;

/// Where the data of an entry came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Origin {
    /// Read from a file.
    Imported {
        /// The path of the file when it was read.
        path: PathBuf,
        /// Its length in bytes.
        bytes: u64,
        /// How it was read, for people: format, units, sign, byte positions.
        reading: String,
    },
    /// Given as an array by a program in another language.
    Array,
    /// A volume whose bricks stay in object storage.
    Linked {
        /// Its address.
        url: String,
    },
    /// A volume that was computed from another.
    Attribute {
        /// What was computed.
        attribute: AttributeKind,
        /// The name of the other volume.
        of: String,
    },
    /// Geologic time that was computed from a volume.
    GeologicTime {
        /// The name of the volume.
        of: String,
    },
    /// i, j and k that were computed, with k from geologic time.
    TimeFraction {
        /// The name of the volume of geologic time.
        of: String,
    },
    /// A horizon that a person put together from candidates; its log says how.
    Picked,
    /// The surface of a block that was told as events.
    History,
    /// Moved back in time with the rock, from another project's.
    Restored {
        /// Who chose the horizons of that project.
        chosen_by: Chooser,
    },
    /// Drawn by a person, or tracked from a place: a horizon by its log, a fault by its sticks.
    Drawn,
    /// The level of geologic time through places at which a person pointed.
    ByTime {
        /// Inline, crossline and vertical value of each.
        seeds: Vec<[f64; 3]>,
        /// Where nothing tells which reflection it is, the largest part first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        queries: Vec<HorizonQuery>,
    },
    /// A level of geologic time as it is.
    Level {
        /// Its value, samples.
        time: f32,
        /// Who chose it.
        chosen_by: Chooser,
    },
    /// The outline of an isolated body that the program found along the reflections.
    Outlined,
    /// A surface at a share of the thickness between two horizons.
    Share {
        /// The share, from the upper one.
        share: f32,
        /// The names of the horizons, the upper one first.
        between: [String; 2],
    },
    /// A fault that the program proposed and a person accepted.
    Proposed {
        /// The names of the horizons that are offset at it; none: it was found in the volume.
        horizons: Vec<String>,
    },
}

/// A part of a horizon by time of which nothing tells that it is the same reflection: it is assumed until a place is
/// pointed at there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HorizonQuery {
    /// The fault beyond which it lies.
    pub beyond: QueryBorder,
    /// Inline, crossline and vertical value in its midst, on what is assumed.
    pub at: [f64; 3],
    /// Its share of the horizon's nodes, 0 to 1.
    pub share: f64,
}

/// What a part of a horizon lies beyond.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum QueryBorder {
    /// A fault of the project, by its name.
    Fault(String),
    /// A fault that was found in the volume and that the project does not have.
    FoundFault,
    /// A jump by half a period or more, without a fault.
    Jump,
}

impl fmt::Display for HorizonQuery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let beyond = match &self.beyond {
            QueryBorder::Fault(name) => format!("beyond \"{name}\""),
            QueryBorder::FoundFault => "beyond a fault that was found in the volume".to_owned(),
            QueryBorder::Jump => "beyond a jump".to_owned(),
        };
        let [inline, crossline, z] = self.at;
        write!(
            f,
            "which reflection is it {beyond}? {:.1} % of it is only assumed there, for both sides do not tell; point at the \
             right one near inline {inline:.0}, crossline {crossline:.0} (assumed at {z:.1})",
            100.0 * self.share
        )
    }
}

/// Who chose something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Chooser {
    /// The user.
    Person,
    /// The program.
    Program,
}

/// The attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AttributeKind {
    /// Semblance: how alike neighbouring traces are along the reflections; low at faults.
    Semblance,
    /// Envelope: the strength of the reflections, whatever their phase.
    Envelope,
    /// Dip: the steepness of the reflections, as three volumes.
    Dip,
    /// Fault likelihood: where a steep plane breaks the reflections, 0 to 1.
    FaultLikelihood,
    /// The throw at each place of a ridge of the fault likelihood.
    Throw,
    /// The volume with its beds laid flat by the newest geologic time: a Wheeler diagram.
    Flattened,
    /// How fast the newest geologic time runs down the traces: more than 1 where beds are missing, as at an unconformity.
    Hiatus,
}

impl AttributeKind {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Semblance, Self::Envelope, Self::Dip, Self::FaultLikelihood, Self::Throw, Self::Flattened, Self::Hiatus];

    /// The word for it on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Semblance => "semblance",
            Self::Envelope => "envelope",
            Self::Dip => "dip",
            Self::FaultLikelihood => "fault-likelihood",
            Self::Throw => "throw",
            Self::Flattened => "flattened",
            Self::Hiatus => "hiatus",
        }
    }
}

impl Origin {
    /// The file or the address that the data can be had from again; `None`: they were made in the project.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Imported { path, .. } => Some(path),
            Self::Linked { url } => Some(Path::new(url)),
            _ => None,
        }
    }

    /// The names in it, each with what it can be the name of.
    pub(super) fn names_mut(&mut self) -> Vec<(&'static [Noun], &mut String)> {
        match self {
            Self::Attribute { of, .. } | Self::GeologicTime { of } | Self::TimeFraction { of } => vec![(VOLUME, of)],
            Self::Share { between, .. } => between.iter_mut().map(|name| (HORIZON, name)).collect(),
            Self::Proposed { horizons } => horizons.iter_mut().map(|name| (HORIZON, name)).collect(),
            Self::ByTime { queries, .. } => {
                let named = queries.iter_mut().filter_map(|query| match &mut query.beyond {
                    QueryBorder::Fault(name) => Some((FAULT, name)),
                    QueryBorder::FoundFault | QueryBorder::Jump => None,
                });
                named.collect()
            }
            _ => Vec::new(),
        }
    }

    /// Places at which a person pointed in geologic time; none for anything else.
    pub fn seeds(&self) -> &[[f64; 3]] {
        if let Self::ByTime { seeds, .. } = self { seeds } else { &[] }
    }

    /// Where nothing tells which reflection a horizon by time is.
    pub fn queries(&self) -> &[HorizonQuery] {
        if let Self::ByTime { queries, .. } = self { queries } else { &[] }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Imported { path, reading, .. } => write!(f, "{reading}, from {}", path.display()),
            Self::Array => f.write_str("an array of Python"),
            Self::Linked { url } => write!(f, "linked to {url}: its bricks are read where they lie"),
            Self::Attribute { attribute, of } => write!(f, "{} of the volume {of}", attribute.name()),
            Self::GeologicTime { of } => write!(f, "geologic time of the volume {of}"),
            Self::TimeFraction { of } => write!(f, "k by geologic time of the volume {of}"),
            Self::Picked => f.write_str("assembled from picks"),
            Self::History => f.write_str("told by the geological history"),
            Self::Restored { .. } => f.write_str("moved back in time with the rock"),
            Self::Drawn => f.write_str("drawn"),
            Self::Outlined => f.write_str("outline of an isolated body, which the program found"),
            Self::ByTime { seeds, .. } => {
                f.write_str("geologic time through ")?;
                if let Some([inline, crossline, z]) = seeds.first() {
                    write!(f, "inline {inline}, crossline {crossline}, {z}")?;
                }
                if seeds.len() > 1 { write!(f, " and {} more", seeds.len() - 1) } else { Ok(()) }
            }
            Self::Level { time, chosen_by: Chooser::Person } => write!(f, "geologic time {time}"),
            Self::Level { time, chosen_by: Chooser::Program } => {
                write!(f, "geologic time {time}, which the program chose")
            }
            Self::Share { share, between: [top, base] } => {
                write!(f, "{:.1} % of the thickness from {top} to {base}", 100.0 * share)
            }
            Self::Proposed { horizons } if horizons.is_empty() => f.write_str("found in the volume"),
            Self::Proposed { horizons } => write!(f, "proposed from the offsets of {}", horizons.join(", ")),
        }
    }
}

/// Why what a project shows is no interpretation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Uninterpreted {
    /// It has no horizon.
    RawData,
    /// The program chose every horizon among the levels of geologic time that it had computed.
    ComputedLevels,
}

impl fmt::Display for Uninterpreted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::RawData => "Uninterpreted: raw data alone",
            Self::ComputedLevels => "Uninterpreted: layers by computed geologic time, not by rock",
        })
    }
}

impl Document {
    /// Why it is no interpretation; `None`: a person chose one of its horizons at least.
    pub fn uninterpreted(&self) -> Option<Uninterpreted> {
        let is_chosen = |origin: &Origin| {
            !matches!(
                origin,
                Origin::Level { chosen_by: Chooser::Program, .. }
                    | Origin::Restored { chosen_by: Chooser::Program }
                    | Origin::Outlined
            )
        };
        match self.horizons.is_empty() {
            true => Some(Uninterpreted::RawData),
            false => {
                (!self.horizons.iter().any(|entry| is_chosen(&entry.origin))).then_some(Uninterpreted::ComputedLevels)
            }
        }
    }

    /// The volume that the present extraction is of; the first one on the project's lattice where that is not recorded.
    ///
    /// # Errors
    /// [`ProjectError::NoVolume`].
    pub fn amplitudes(&self) -> Result<&VolumeEntry, ProjectError> {
        let extracted = self.extraction.as_ref().map(|entry| &entry.volume);
        let own = || self.volumes.iter().filter(|entry| entry.geometry.is_none());
        own().find(|entry| extracted == Some(&entry.name)).or_else(|| own().next()).ok_or(ProjectError::NoVolume)
    }

    /// The newest volume of geologic time on the project's lattice, wherever it was computed.
    pub fn geologic_time(&self) -> Option<&VolumeEntry> {
        let is_time = |entry: &&VolumeEntry| entry.geometry.is_none() && entry.quantity == Some(Quantity::GeologicTime);
        self.volumes.iter().rev().find(is_time)
    }

    /// The origins of everything that has a name, in the project's order, by kind and name.
    pub fn origins(&self) -> serde_json::Value {
        fn named<'a, T: Serialize + 'a>(all: impl Iterator<Item = (&'a str, T)>) -> serde_json::Value {
            all.map(|(name, origin)| serde_json::json!({ "name": name, "origin": origin })).collect()
        }
        let stratigraphy = self.stratigraphy();
        let layers: Vec<_> = (0..stratigraphy.layer_count()).rev().map(|n| (stratigraphy.layer_name(n), n)).collect();
        serde_json::json!({
            "volumes": named(self.volumes.iter().map(|entry| (entry.name.as_str(), &entry.origin))),
            "horizons": named(self.horizons.iter().map(|entry| (entry.name.as_str(), &entry.origin))),
            "faults": named(self.faults.iter().map(|entry| (entry.name.as_str(), &entry.origin))),
            "wells": named(self.wells.iter().map(|entry| (entry.name.as_str(), &entry.origin))),
            "layers": named(layers.iter().map(|(name, n)| (name.as_str(), stratigraphy.layer_origin(*n)))),
        })
    }
}
