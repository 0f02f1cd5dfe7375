//! Places points at voxel x, y: by their line numbers, by their coordinates, or by whichever of the two fits
//! the survey.

use super::FormatError;
use super::columns::is_inside;
use super::error::HorizontalExtent;
use super::options::PlaceBy;
use super::raw::RawPoint;
use glam::{DVec2, DVec3};
use std::path::Path;
use survey::geometry::SurveyGeometry;

/// Points over the survey.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlacedPoints {
    /// Voxel x, y per point.
    pub voxels: Vec<DVec2>,
    /// Number of points that lie beside the survey.
    pub outside: usize,
    /// The decision that was made.
    pub note: Option<String>,
}

/// World X, Y of voxel x, y.
pub(super) fn world_xy(geometry: &SurveyGeometry, voxel: DVec2) -> DVec2 {
    geometry.world_from_voxel(voxel.extend(0.0)).truncate()
}

/// Voxel x, y of world X, Y.
pub(super) fn voxel_xy(geometry: &SurveyGeometry, world: DVec2) -> DVec2 {
    geometry.voxel_from_world(DVec3::new(world.x, world.y, 0.0)).truncate()
}

/// Places every point.
///
/// A point with both line numbers and X, Y is placed by its lines if most such points agree to half a bin. If they do
/// not, the reading that lies over the survey is taken and reported; if both do, the user is asked.
///
/// # Errors
/// [`FormatError::OutsideSurvey`] when no point lies over the survey, [`FormatError::LinesDisagree`].
pub(super) fn place(
    file: &Path,
    name: &str,
    points: &[RawPoint],
    geometry: &SurveyGeometry,
    place_by: Option<PlaceBy>,
) -> Result<PlacedPoints, FormatError> {
    let of_lines = |p: &RawPoint| p.lines.map(|l| geometry.voxel_from_lines(l.x, l.y));
    let of_xy = |p: &RawPoint| p.xy.map(|w| voxel_xy(geometry, w));
    let both: Vec<(DVec2, DVec2)> = points.iter().filter_map(|p| of_lines(p).zip(of_xy(p))).collect();
    let mut note = None;
    let by = match place_by {
        Some(by) => by,
        None if both.is_empty() => PlaceBy::Lines,
        None => {
            let agree = both.iter().filter(|(l, w)| (*l - *w).abs().max_element() <= 0.5).count();
            let inside =
                |pick: fn(&(DVec2, DVec2)) -> DVec2| both.iter().filter(|b| is_inside(pick(b), geometry)).count();
            let (lines_inside, xy_inside) = (inside(|b| b.0), inside(|b| b.1));
            if agree * 2 >= both.len() {
                PlaceBy::Lines
            } else if lines_inside * 20 < xy_inside {
                note = Some("placed by X, Y: the line numbers are not the survey's".into());
                PlaceBy::World
            } else if xy_inside * 20 < lines_inside {
                note = Some(
                    "placed by inline, crossline: the X, Y are not the survey's; another coordinate system?".into(),
                );
                PlaceBy::Lines
            } else if lines_inside == 0 && xy_inside == 0 {
                PlaceBy::World
            } else {
                let world = |v: DVec2| world_xy(geometry, v);
                let mut apart: Vec<f64> = both.iter().map(|(l, w)| world(*l).distance(world(*w))).collect();
                apart.sort_by(f64::total_cmp);
                return Err(FormatError::LinesDisagree {
                    file: file.to_path_buf(),
                    name: name.into(),
                    metres: apart[apart.len() / 2],
                });
            }
        }
    };
    let voxels: Vec<DVec2> = points
        .iter()
        .map(|p| match by {
            PlaceBy::Lines => of_lines(p).or_else(|| of_xy(p)),
            PlaceBy::World => of_xy(p).or_else(|| of_lines(p)),
        })
        // A reader gives every point one of the two.
        .map(|v| v.unwrap_or(DVec2::NAN))
        .collect();
    let outside = voxels.iter().filter(|v| !is_inside(**v, geometry)).count();
    if outside == voxels.len() {
        let has_xy = points.iter().any(|p| p.xy.is_some());
        return Err(if by == PlaceBy::Lines && !has_xy {
            outside_by_lines(file, name, &voxels, geometry)
        } else {
            outside_by_world(file, name, voxels.iter().map(|v| world_xy(geometry, *v)), geometry)
        });
    }
    Ok(PlacedPoints { voxels, outside, note })
}

/// World X, Y of the survey's corners.
fn corners(geometry: &SurveyGeometry) -> [DVec2; 4] {
    let [nx, ny, _] = geometry.size();
    let (x, y) = (nx as f64 - 1.0, ny as f64 - 1.0);
    [(0.0, 0.0), (x, 0.0), (0.0, y), (x, y)].map(|(x, y)| world_xy(geometry, DVec2::new(x, y)))
}

/// The error for a surface that lies beside the survey in world coordinates, with a hint on what would bring it there.
pub(super) fn outside_by_world(
    file: &Path,
    name: &str,
    points: impl Iterator<Item = DVec2>,
    geometry: &SurveyGeometry,
) -> FormatError {
    let points: Vec<DVec2> = points.filter(|p| p.is_finite()).collect();
    let survey = HorizontalExtent::of(corners(geometry));
    let fits = |f: &dyn Fn(DVec2) -> DVec2| {
        points.iter().filter(|p| is_inside(voxel_xy(geometry, f(**p)), geometry)).count() * 2 > points.len()
    };
    let exchanged = fits(&|p| DVec2::new(p.y, p.x));
    let hint = if exchanged {
        "X and Y seem to be exchanged".to_string()
    } else if let Some((_, unit)) =
        [(0.3048, "feet"), (1000.0, "kilometres"), (0.001, "millimetres"), (0.01, "centimetres"), (0.1, "decimetres")]
            .into_iter()
            .find(|(factor, _)| fits(&|p| p * *factor))
    {
        format!("The coordinates seem to be in {unit}: convert them to metres")
    } else {
        "Check the coordinate system (CRS), the unit of X and Y, and whether the file belongs to this survey"
            .to_string()
    };
    FormatError::OutsideSurvey {
        file: file.to_path_buf(),
        name: name.into(),
        axes: "X and Y",
        found: Box::new(HorizontalExtent::of(points)),
        survey: Box::new(survey),
        hint,
        exchanged,
    }
}

fn outside_by_lines(file: &Path, name: &str, voxels: &[DVec2], geometry: &SurveyGeometry) -> FormatError {
    let found = HorizontalExtent::of(voxels.iter().map(|v| geometry.lines_from_voxel(*v)));
    let swapped = voxels.iter().filter(|v| {
        let lines = geometry.lines_from_voxel(**v);
        is_inside(geometry.voxel_from_lines(lines.y, lines.x), geometry)
    });
    let exchanged = swapped.count() * 2 > voxels.len();
    let hint = if exchanged {
        "Inline and crossline seem to be exchanged"
    } else {
        "Check the line numbering and whether the file belongs to this survey"
    };
    let last = DVec2::new(f64::from(geometry.inlines.last()), f64::from(geometry.crosslines.last()));
    let first = DVec2::new(f64::from(geometry.inlines.first), f64::from(geometry.crosslines.first));
    FormatError::OutsideSurvey {
        file: file.to_path_buf(),
        name: name.into(),
        axes: "inlines and crosslines",
        found: Box::new(found),
        survey: Box::new(HorizontalExtent::of([first, last])),
        hint: hint.into(),
        exchanged,
    }
}
