//! What the user states about a file: format, vertical unit, sign, factor, null value, name and columns.
//!
//! A vertical value of the file becomes one of the survey in this order:
//!
//! 1. a value equal to `null` (or to the format's own null) is a hole;
//! 2. `v ← v · z_factor`;
//! 3. the sign is turned when the file is positive up;
//! 4. `v` is converted from the file's unit to the survey's (s → ms, ft → m).
//!
//! Claudius, whose points hold Z = −3 × TWT in ms, is read with `z_factor = −1/3`, or with `z_positive = up` and
//! `z_factor = 1/3`. Its TSurf file states `ZPOSITIVE Elevation`, so there `z_factor = 1/3` suffices together with
//! `z_unit = ms`.

use super::Format;
use super::column::Column;
use super::unit::{ZPositive, ZUnit};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Whether line numbers or coordinates place a point that has both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlaceBy {
    /// Inline and crossline.
    Lines,
    /// X and Y.
    #[serde(rename = "xy")]
    World,
}

/// The order of a grid's values in a file that does not state it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ValueOrder {
    /// Columns from the west, each from the north down: what most programs write.
    Columns,
    /// Rows from the south, each from the west.
    Rows,
}

/// What a horizon is made into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HorizonShape {
    /// Depths at the nodes of a map: a few sheets, each a height field.
    Map,
    /// The triangles or points as they are: overturned limbs, bodies.
    Any,
}

/// What the user states about a file; everything has a default.
///
/// ```
/// # use files::{ImportOptions, ZUnit};
/// let in_feet = ImportOptions { z_unit: Some(ZUnit::Feet), ..ImportOptions::default() };
/// assert_eq!((in_feet.z_factor, in_feet.z_positive), (1.0, None));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ImportOptions {
    /// The format; `None` = recognised by its signature, with the evidence in the report.
    pub format: Option<Format>,
    /// Vertical unit of the file; `None` = as the file says, else the survey's (reported as assumed).
    pub z_unit: Option<ZUnit>,
    /// Unit of X and Y; `None` = as the file says, else metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub xy_unit: Option<ZUnit>,
    /// Sign of the file; `None` = as the file says, else positive down (reported as assumed).
    pub z_positive: Option<ZPositive>,
    /// Factor on the file's values, before sign and unit; 1 by default.
    pub z_factor: f64,
    /// A value that marks nodes without data, as it is in the file.
    pub null: Option<f64>,
    /// Name of the surface; `None` = the file's own, else the file name without extension. When the file
    /// holds several surfaces, the one of this name is read.
    pub name: Option<String>,
    /// Name of the one to read when the file holds several; `None` = all.
    pub select: Option<String>,
    /// The columns of a table, in order, instead of what its header says; `None` = by the header or by what
    /// fits the survey.
    pub columns: Option<Vec<Column>>,
    /// What places points that have both line numbers and X, Y; `None` = lines, after a check that both agree.
    pub place_by: Option<PlaceBy>,
    /// Scattered points: a triangle whose circumcircle has a larger radius than this, m, becomes a hole.
    /// `None` = twice the typical distance of neighbouring points.
    pub gap_m: Option<f64>,
    /// What a horizon is made into; `None` = a map, unless its triangles or points are overturned or closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<HorizonShape>,
    /// Points of a horizon: a file with orientations of its beds (dip and azimuth, or normals), by the name of the horizon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orientations: Option<PathBuf>,
    /// CPS-3: the order of the values; `None` = the smoother of the two, with the evidence in the report.
    pub value_order: Option<ValueOrder>,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self {
            format: None,
            z_unit: None,
            xy_unit: None,
            z_positive: None,
            z_factor: 1.0,
            null: None,
            name: None,
            select: None,
            columns: None,
            place_by: None,
            gap_m: None,
            shape: None,
            orientations: None,
            value_order: None,
        }
    }
}
