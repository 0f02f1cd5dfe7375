//! Collars of drill holes: where each begins, and how long it is.

use super::columns::WellColumn;
use super::error::WellFileError;
use super::options::WellOptions;
use super::report::WellReport;
use super::table::Table;
use glam::DVec3;
use std::path::Path;

/// The collar of a hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Collar {
    /// X, Y and elevation above sea level, m.
    pub position: DVec3,
    /// Length of the hole, m.
    pub length_m: Option<f64>,
}

/// Reads the collar of the well.
///
/// # Errors
/// [`WellFileError`] with the line or the column that is missing.
pub(super) fn parse_collar(
    file: &Path,
    text: &str,
    options: &WellOptions,
    report: &mut WellReport,
) -> Result<Collar, WellFileError> {
    let mut table = Table::parse(file, text);
    if table.rows.is_empty() {
        return Err(WellFileError::Empty { file: file.to_owned(), what: "collars" });
    }
    let names: Vec<&str> = options.name.as_deref().into_iter().collect();
    table.keep_well(&options.well_in_file, &names)?;
    let at = |column| table.position(column);
    let (Some(x), Some(y), Some(z)) = (at(WellColumn::X), at(WellColumn::Y), at(WellColumn::Z)) else {
        return Err(WellFileError::Columns {
            file: file.to_owned(),
            why: "a collar needs X, Y and an elevation".into(),
            example: "hole_id,x,y,z,depth",
        });
    };
    let mut number = |at: usize, told| -> Result<f64, WellFileError> {
        Ok(table.number(&table.rows[0], at)? * table.length_to_m(at, told, report)?)
    };
    let position = DVec3::new(number(x, options.xy_unit)?, number(y, options.xy_unit)?, number(z, options.md_unit)?);
    let length = at(WellColumn::Length).or_else(|| at(WellColumn::Md));
    let length_m = length.map(|at| number(at, options.md_unit)).transpose()?.filter(|length| *length > 0.0);
    Ok(Collar { position, length_m })
}
