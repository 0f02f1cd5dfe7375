//! Wells: their paths, the surfaces they penetrate (tops), and the curves measured along them (logs).
//!
//! A well's axis is measured depth (MD, m, 0 at its datum, usually the kelly bushing). Its path lies in the
//! world: X east, Y north, TVDSS = true vertical depth below mean sea level, m, positive down; a datum 25 m
//! above the sea is at TVDSS = −25.
//!
//! Between two surveyed stations with directions the path is the circular arc that touches both (minimum
//! curvature); between stations that are places alone it is straight. In a time survey TVDSS becomes TWT
//! through the well's checkshots, else through the survey's constant velocity ([`TimeDepth`] says which).
//!
//! ```
//! # use survey::well::{Survey, Well, WellPath};
//! # use glam::{DVec2, DVec3};
//! let vertical = [0.0, 1000.0].map(|md_m| Survey { md_m, inclination_deg: 0.0, azimuth_deg: 0.0 });
//! let path = WellPath::minimum_curvature(DVec2::new(500.0, 700.0), 25.0, &vertical)?;
//! let well = Well::new("A-1", path);
//! assert_eq!(well.position_at_md(425.0), Some(DVec3::new(500.0, 700.0, 400.0)));
//! assert_eq!(well.position_at_md(1000.5), None);
//! # Ok::<(), survey::well::WellError>(())
//! ```

mod checkshot;
mod error;
mod log;
mod path;
mod place;
#[cfg(test)]
mod tests;

pub use checkshot::{Checkshot, TimeDepth};
pub use error::WellError;
pub use log::{Curve, LogSet};
pub use path::{Station, Survey, WellPath};
pub use place::{TopPlace, WellPlacement};

use serde::{Deserialize, Serialize};

/// A well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Well {
    /// Unique within a project.
    pub name: String,
    /// Its path.
    pub path: WellPath,
    /// The surfaces that it penetrates, in order of measured depth.
    #[serde(default)]
    pub tops: Vec<Top>,
    /// Curves measured along it.
    #[serde(default)]
    pub logs: Vec<LogSet>,
    /// Its own time–depth table.
    #[serde(default)]
    pub checkshot: Option<Checkshot>,
}

/// The point at which a well penetrates a named surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Top {
    /// Name of the surface.
    pub name: String,
    /// Measured depth, m.
    pub md_m: f64,
}

/// Whether two names mean one surface: files of wells and of horizons write them in different cases, with other blanks
/// and punctuation.
///
/// ```
/// assert!(survey::well::is_same_surface("Top Chalk", "TOP_CHALK"));
/// assert!(!survey::well::is_same_surface("Top Chalk", "Base Chalk"));
/// ```
pub fn is_same_surface(a: &str, b: &str) -> bool {
    let plain = |name: &str| name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    plain(a) == plain(b)
}

impl Well {
    /// A well without tops and logs.
    pub fn new(name: impl Into<String>, path: WellPath) -> Self {
        Self { name: name.into(), path, tops: Vec::new(), logs: Vec::new(), checkshot: None }
    }
}
