//! What the user states about a well: its name, its head, its datum and the unit of lengths along it.

use super::columns::WellColumn;
use crate::unit::ZUnit;
use serde::{Deserialize, Serialize};

/// What the user states about a well's files; everything has a default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WellOptions {
    /// Name of the well; it also chooses rows of files that hold several wells.
    pub name: Option<String>,
    /// Name of the well in such files, when it is another.
    pub well_in_file: Option<String>,
    /// X, Y of the head, m; `None` = as the deviation file says.
    pub head: Option<[f64; 2]>,
    /// Height of the datum above mean sea level, m; `None` = as the file says, else 0, with a warning.
    pub datum_m: Option<f64>,
    /// Unit of lengths along the well if columns do not state one; `None` = as the file says, else metres, reported.
    pub md_unit: Option<ZUnit>,
    /// Unit of X and Y if columns do not state one; `None` = as the file says, else metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub xy_unit: Option<ZUnit>,
    /// The columns of the deviation, in order, instead of what its header says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub columns: Option<Vec<WellColumn>>,
}
