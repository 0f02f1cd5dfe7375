//! What was meant: typed text turned into commands and values, or refused as wrong usage.

use super::args::{Action, CreateArgs};
use crate::command::{Command, SetVelocity};
use glam::DVec2;
use std::path::PathBuf;
use survey::{SurveyGeometry, VerticalUnit};

/// Something to do.
#[derive(Debug)]
pub(super) enum Request {
    /// Say what a file or project holds.
    Info(PathBuf),
    /// Make a project.
    Create { project: PathBuf, geometry: Option<SurveyGeometry> },
    /// Change a project.
    Change { project: PathBuf, command: Command },
    /// Go back.
    Undo(PathBuf),
    /// Go forward.
    Redo(PathBuf),
    /// Forget the history.
    Prune(PathBuf),
}

/// What is wrong with the usage.
pub(super) type Usage = String;

impl TryFrom<Action> for Request {
    type Error = Usage;

    fn try_from(action: Action) -> Result<Self, Usage> {
        Ok(match action {
            Action::Info { path } => Self::Info(path),
            Action::Create(typed) => Self::Create { geometry: frame(&typed)?, project: typed.project },
            Action::Velocity { project, velocity_m_s } => {
                Self::Change { project, command: Command::SetVelocity(SetVelocity { velocity_m_s }) }
            }
            Action::Undo { project } => Self::Undo(project),
            Action::Redo { project } => Self::Redo(project),
            Action::Prune { project } => Self::Prune(project),
        })
    }
}

/// The lattice that `--bounds`, `--size` and `--z-unit` describe: its first and last samples lie on the bounds.
fn frame(typed: &CreateArgs) -> Result<Option<SurveyGeometry>, Usage> {
    let Some(bounds) = &typed.bounds else { return Ok(None) };
    let [x0, x1, y0, y1, z0, z1] = numbers::<6>("--bounds", bounds, ',')?;
    let size = match &typed.size {
        Some(size) => counts::<3>("--size", size)?,
        None => [128; 3],
    };
    let unit = match typed.z_unit.as_deref() {
        None | Some("m") => VerticalUnit::Metres,
        Some("ms") => VerticalUnit::Milliseconds,
        Some(other) => return Err(format!("--z-unit {other}: expected m or ms")),
    };
    for (axis, low, high) in [("X", x0, x1), ("Y", y0, y1), ("Z", z0, z1)] {
        if low >= high {
            return Err(format!("--bounds {bounds}: {axis}0 = {low} must be less than {axis}1 = {high}"));
        }
    }
    if let Some(count) = size.iter().find(|&&count| count < 2) {
        return Err(format!("--size: each axis needs at least 2 samples, found {count}"));
    }
    let step = |low: f64, high: f64, count: usize| (high - low) / (count as f64 - 1.0);
    let mut geometry = SurveyGeometry::regular(size, 1.0, step(z0, z1, size[2]), unit);
    geometry.vertical.first = z0;
    geometry.origin = DVec2::new(x0, y0);
    geometry.inline_vector = DVec2::new(step(x0, x1, size[0]), 0.0);
    geometry.crossline_vector = DVec2::new(0.0, step(y0, y1, size[1]));
    Ok(Some(geometry))
}

/// Exactly N finite numbers.
pub(super) fn numbers<const N: usize>(option: &str, text: &str, separator: char) -> Result<[f64; N], Usage> {
    let parsed: Option<Vec<f64>> =
        text.split(separator).map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    parsed
        .and_then(|values| values.try_into().ok())
        .ok_or_else(|| format!("{option} {text}: expected {N} numbers separated by `{separator}`"))
}

/// N positive counts separated by `x`.
pub(super) fn counts<const N: usize>(option: &str, text: &str) -> Result<[usize; N], Usage> {
    let parsed: Option<Vec<usize>> =
        text.split(['x', 'X', '×']).map(|part| part.trim().parse().ok().filter(|&count| count > 0)).collect();
    parsed
        .and_then(|values| values.try_into().ok())
        .ok_or_else(|| format!("{option} {text}: expected {N} counts such as {}", ["64"; N].join("x")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(bounds: &str, size: &str) -> CreateArgs {
        CreateArgs { project: "a.petro".into(), bounds: Some(bounds.into()), size: Some(size.into()), z_unit: None }
    }

    #[test]
    fn bounds_are_the_first_and_last_samples() {
        let geometry = frame(&typed("1000,5000,-200,200,-100,900", "5x3x11")).unwrap().unwrap();
        geometry.validate().unwrap();
        let last = geometry.world_from_voxel(glam::DVec3::new(4.0, 2.0, 10.0));
        assert_eq!(last, glam::DVec3::new(5000.0, 200.0, 900.0));
        assert_eq!(geometry.world_from_voxel(glam::DVec3::ZERO), glam::DVec3::new(1000.0, -200.0, -100.0));
    }

    #[test]
    fn wrong_bounds_and_sizes_are_usage_errors() {
        for (bounds, size) in [
            ("0,1,0,1,0", "4x4x4"),
            ("0,1,0,1,1,0", "4x4x4"),
            ("0,1,0,nan,0,1", "4x4x4"),
            ("0,1,0,1,0,1", "4x4"),
            ("0,1,0,1,0,1", "4x4x1"),
            ("0,1,0,1,0,1", "4x4x-4"),
        ] {
            assert!(frame(&typed(bounds, size)).is_err(), "{bounds} {size}");
        }
    }
}
