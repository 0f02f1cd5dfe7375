//! Wells of a project in voxels, as pictures show them.

use crate::content;
use crate::derived;
use crate::error::ProjectError;
use crate::facts::{Facts, Query};
use glam::DVec3;
use survey::well::Top;
use survey::{Progress, SurveyGeometry, Well};
use ttf::Colour;

/// A well of the project in voxels.
pub struct LoadedWell {
    /// Its name.
    pub name: String,
    /// Its own colour.
    pub colour: Option<Colour>,
    /// Its path from the head down.
    pub path: Vec<DVec3>,
    /// Its tops.
    pub tops: Vec<DVec3>,
    /// Their names.
    pub top_names: Vec<String>,
    /// A curve measured along it: its gamma ray, or else its first.
    pub log: Option<LoadedLog>,
}

/// A curve measured along a well.
pub struct LoadedLog {
    /// Its short name.
    pub name: String,
    /// Its values and their places, voxels; NaN where nothing was measured.
    pub points: Vec<(DVec3, f32)>,
    /// Its smallest and largest value.
    pub range: [f32; 2],
}

/// The curve that is shown beside a well.
fn shown_log(well: &Well, geometry: &SurveyGeometry) -> Option<LoadedLog> {
    let curves = || well.logs.iter().flat_map(|set| set.curves.iter().map(move |curve| (set, curve)));
    let (set, curve) = curves().find(|(_, curve)| curve.name.eq_ignore_ascii_case("GR")).or_else(|| curves().next())?;
    let values = curve.values.iter().copied().filter(|value| value.is_finite());
    let range = values.fold([f32::MAX, f32::MIN], |[low, high], value| [low.min(value), high.max(value)]);
    let place = |(md_m, value): (&f64, &f32)| Some((well.voxel_at_md(*md_m, geometry)?, *value));
    let points: Vec<(DVec3, f32)> = set.md_m.iter().zip(&curve.values).filter_map(place).collect();
    (range[0] <= range[1]).then(|| LoadedLog { name: curve.name.clone(), points, range })
}

/// The wells of a project, in voxels.
#[derive(Debug, Clone, Copy)]
pub struct Wells;

impl Query for Wells {
    const WHAT: &'static str = "wells";
    type Answer = Vec<LoadedWell>;

    fn key(&self, Facts { document, .. }: Facts<'_>) -> Result<String, ProjectError> {
        Ok(derived::key_of(&(&document.wells, document.frame()?)))
    }

    fn compute(&self, Facts { root, document }: Facts<'_>, _: &Progress) -> Result<Vec<LoadedWell>, ProjectError> {
        let geometry = document.frame()?;
        let placed = document.wells.iter().map(|entry| {
            let well = content::read_well(root, entry)?;
            let place = |top: &Top| Some((well.voxel_at_md(top.md_m, geometry)?, top.name.clone()));
            let (tops, top_names) = well.tops.iter().filter_map(place).unzip();
            let (path, log) = (well.path_in_voxels(geometry), shown_log(&well, geometry));
            Ok(LoadedWell { name: entry.name.clone(), colour: entry.colour, path, tops, top_names, log })
        });
        placed.collect()
    }

    fn bytes(wells: &Vec<LoadedWell>) -> usize {
        let points = |well: &LoadedWell| well.log.as_ref().map_or(0, |log| size_of_val(&log.points[..]));
        wells.iter().map(|well| size_of_val(&well.path[..]) + points(well)).sum()
    }
}
