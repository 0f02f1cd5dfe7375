//! Orientations in a file of their own, joined to the points of a horizon: GemPy and others write points of surfaces and
//! orientations of beds as two tables.
//!
//! An orientation need not lie on the surface. So each point without a normal takes the mean of the orientations of its
//! surface, weighted by 1/d², with d the distance in metres (Shepard, "A two-dimensional interpolation function for
//! irregularly-spaced data", 1968); a point at an orientation takes that one.

use super::options::ImportOptions;
use super::placement::world_xy;
use super::raw::{RawPoint, RawShape, RawSurface};
use super::text::SourceFile;
use super::vertical::VerticalRule;
use super::{FormatError, SurfaceKind, horizon, read_source};
use glam::{DVec2, DVec3};
use std::path::Path;
use survey::geometry::SurveyGeometry;
use survey::remedy::Note;

/// Nearer than this is the same place, m.
const SAME_PLACE_M: f64 = 1e-3;

/// Gives each surface the orientations of its name from the file that the options state, if they state one.
///
/// # Errors
/// The file cannot be read.
pub(super) fn attach(
    surfaces: &mut [RawSurface],
    name_of: impl Fn(&RawSurface) -> String,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<(), FormatError> {
    let Some(path) = &options.orientations else { return Ok(()) };
    // What is stated of columns and names is about the points.
    let stated =
        ImportOptions { format: None, columns: None, select: None, name: None, orientations: None, ..options.clone() };
    let (_, mut found) = read_source(&SourceFile::open(path)?, Some(geometry), &stated, SurfaceKind::Horizon)?;
    found.iter_mut().for_each(|oriented| oriented.convert_places(options.xy_unit));
    let called = |surface: &RawSurface| surface.name.as_deref().map(|name| name.trim().to_lowercase());
    for surface in surfaces {
        let names = [called(surface), Some(name_of(surface).trim().to_lowercase())];
        let own = found.iter().find(|oriented| called(oriented).is_some() && names.contains(&called(oriented)));
        // A table without names is about all of it.
        let own = own.or_else(|| found.iter().find(|oriented| found.len() == 1 && oriented.name.is_none()));
        match own {
            Some(own) => surface.orientations = Some(Box::new(own.clone())),
            None => {
                let known: Vec<&str> = found.iter().filter_map(|oriented| oriented.name.as_deref()).collect();
                let fact = format!(
                    "{} has no orientations of it; it has those of {}",
                    path.display(),
                    if known.is_empty() { "no surface by name".to_owned() } else { known.join(", ") }
                );
                surface.warnings.push(Note::from(fact));
            }
        }
    }
    Ok(())
}

/// Gives points without a normal those of the orientations around them; returns what there is to say.
///
/// # Errors
/// The orientations are of the other domain: times or depths.
pub(super) fn join(
    file: &Path,
    points: &mut [RawPoint],
    oriented: RawSurface,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<String, FormatError> {
    let rule = VerticalRule::settle(file, &oriented.vertical, options, geometry.vertical.unit)?;
    let mut shape = oriented.shape;
    rule.apply(&mut shape);
    let scale = geometry.metric_from_voxel().z_axis.length() / geometry.vertical.interval;
    let place = |point: &RawPoint| {
        let lines = || point.lines.map(|at| world_xy(geometry, geometry.voxel_from_lines(at.x, at.y)));
        let xy: Option<DVec2> = point.xy.or_else(lines);
        Some(xy?.extend(point.z * scale)).filter(|place| place.is_finite())
    };
    let RawShape::Points(found) = &mut shape else {
        return Ok("the file of orientations has none: it holds a grid or triangles".to_owned());
    };
    horizon::take_dips(found, geometry);
    let known: Vec<(DVec3, DVec3)> =
        found.iter().filter_map(|point| Some((place(point)?, point.normal?.try_normalize()?))).collect();
    let mut joined = 0;
    for point in points.iter_mut().filter(|point| point.normal.is_none()) {
        let Some(at) = place(point) else { continue };
        let weight = |other: DVec3| at.distance_squared(other).max(SAME_PLACE_M * SAME_PLACE_M).recip();
        let mean: DVec3 = known.iter().map(|(place, normal)| *normal * weight(*place)).sum();
        point.normal = mean.try_normalize();
        joined += usize::from(point.normal.is_some());
    }
    Ok(format!("{} orientations give {joined} of its points their normals, the nearer the more", known.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_horizons;
    use survey::geometry::VerticalUnit;

    #[test]
    fn a_point_takes_the_orientations_around_it() {
        let geometry = SurveyGeometry::regular([41, 41, 101], 25.0, 10.0, VerticalUnit::Metres);
        let oriented = |x: f64, dip: f64| RawPoint {
            xy: Some(DVec2::new(x, 500.0)),
            z: 400.0,
            dip: Some([dip, 90.0, 1.0]),
            ..RawPoint::default()
        };
        let table = RawSurface::new(None, RawShape::Points(vec![oriented(200.0, 0.0), oriented(800.0, 60.0)]));
        let at = |x: f64| RawPoint { xy: Some(DVec2::new(x, 500.0)), z: 400.0, ..RawPoint::default() };
        let own = DVec3::new(0.0, 1.0, 0.0);
        let mut points = vec![at(200.0), at(500.0), at(800.0), RawPoint { normal: Some(own), ..at(300.0) }];
        let options = ImportOptions::default();
        let said = join(Path::new("o.csv"), &mut points, table, &geometry, &options).unwrap();
        assert!(said.starts_with("2 orientations give 3 of its points"), "{said}");
        let normals: Vec<DVec3> = points.iter().filter_map(|point| point.normal).collect();
        // Towards the younger beds is up, against the depth; between the two it is halfway.
        let of_dip = |dip: f64| DVec3::new(dip.to_radians().sin(), 0.0, -dip.to_radians().cos());
        for (found, wanted) in normals.iter().zip([of_dip(0.0), of_dip(30.0), of_dip(60.0), own]) {
            assert!(found.distance(wanted) < 1e-6, "{normals:?}");
        }
    }

    #[test]
    fn a_table_of_orientations_is_joined_by_the_name_of_the_surface() {
        let folder = tempfile::tempdir().unwrap();
        let geometry = SurveyGeometry::regular([41, 41, 101], 25.0, 10.0, VerticalUnit::Metres);
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let rows = |name: &str, z: f64| -> String {
            let place = |n: i32| [100 + 137 * (n % 6) + 11 * (n / 6), 100 + 151 * (n / 6) - 7 * (n % 6)];
            (0..36).map(place).map(|[x, y]| format!("{x},{y},{},{name}\n", z + 0.1 * f64::from(x))).collect()
        };
        let points = write("points.csv", &format!("X,Y,Z,formation\n{}{}", rows("Chalk", 300.0), rows("Shale", 600.0)));
        let dips = write("dips.csv", "X,Y,Z,azimuth,dip,polarity,formation\n500,500,350,90,5.7,1,Chalk\n");
        let read = |orientations: &Path| {
            let options = ImportOptions { orientations: Some(orientations.to_owned()), ..ImportOptions::default() };
            read_horizons(&points, &geometry, &options).unwrap()
        };
        let found = read(&dips);
        let [chalk, shale] = [&found[0].1, &found[1].1];
        assert!(chalk.notes.iter().any(|note| note.contains("1 orientations give 36 of its points")), "{chalk}");
        assert!(shale.warnings.iter().any(|note| note.fact.contains("no orientations of it; it has those of Chalk")));
        // Without names they are about all.
        let all = write("all.csv", "X,Y,Z,dip,azimuth,polarity\n500,500,350,5.7,90,1\n500,600,350,5.7,90,1\n");
        assert!(read(&all).iter().all(|(_, report)| report.notes.iter().any(|note| note.contains("2 orientations"))));
        assert!(matches!(
            read_horizons(
                &points,
                &geometry,
                &ImportOptions { orientations: Some(folder.path().join("none.csv")), ..ImportOptions::default() }
            ),
            Err(FormatError::Io { .. })
        ));
    }
}
