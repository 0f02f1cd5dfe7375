//! Coordinates of a volume, for programs that label arrays: `inline`, `crossline` and `sample` along the axes of the
//! same names, `cdp_x` and `cdp_y` for each trace.
//!
//! `xarray.open_zarr` finds them by the names of the axes and by the attribute `coordinates` of the samples. Petroglyph
//! itself never reads them: the lattice is in the group's header. A volume without them, of an earlier version, is
//! whole.

use super::array::{StoredArray, write_described};
use super::error::StoreError;
use super::layout::ArrayLayout;
use super::volume_info::VolumeInfo;
use glam::DVec3;
use serde_json::{Map, Value, json};
use std::path::Path;
use survey::Quantity;
use survey::geometry::{LineAxis, SurveyGeometry, VerticalUnit};
use survey::progress::Progress;

/// The arrays.
const NAMES: [&str; 5] = ["inline", "crossline", "sample", "cdp_x", "cdp_y"];

/// What the samples' array says about itself.
pub(super) fn attributes(level: usize, info: &VolumeInfo) -> Map<String, Value> {
    let mut said = Map::new();
    if level == 0 {
        said.insert("coordinates".to_owned(), json!("cdp_x cdp_y"));
        let told = [("long_name", info.quantity.as_ref().map(Quantity::to_string)), ("units", info.unit.clone())];
        said.extend(told.into_iter().filter_map(|(key, value)| Some((key.to_owned(), json!(value?)))));
    }
    said
}

/// Writes the coordinates of a volume's traces and samples.
pub(super) fn write(group: &Path, geometry: &SurveyGeometry, progress: &Progress) -> Result<(), StoreError> {
    let said = |long_name: &str, units: Option<&str>| {
        let units = units.map(|units| ("units".to_owned(), json!(units)));
        Map::from_iter([("long_name".to_owned(), json!(long_name))].into_iter().chain(units))
    };
    let quiet = progress.muted();
    let lines = |name: &'static str, axis: &LineAxis| {
        let numbers: Vec<i32> = (0..axis.count).map(|n| axis.number_at(n as f64).round() as i32).collect();
        let layout = ArrayLayout::whole(&[axis.count], &[name]);
        write_described(group, name, (layout, said(&format!("{name} number"), None)), 0, &numbers, &quiet)
    };
    lines("inline", &geometry.inlines)?;
    lines("crossline", &geometry.crosslines)?;
    let vertical = &geometry.vertical;
    let samples: Vec<f64> = (0..vertical.count).map(|n| vertical.value_at(n as f64)).collect();
    let vertical_name = if vertical.unit == VerticalUnit::Milliseconds { "two-way time" } else { "depth" };
    let layout = ArrayLayout::whole(&[vertical.count], &["sample"]);
    let about = said(vertical_name, Some(vertical.unit.symbol()));
    write_described(group, "sample", (layout, about), f64::NAN, &samples, &quiet)?;
    let size = geometry.size();
    for (axis, name) in ["cdp_x", "cdp_y"].into_iter().enumerate() {
        let at = |n: usize| geometry.world_from_voxel(DVec3::new((n / size[1]) as f64, (n % size[1]) as f64, 0.0));
        let places: Vec<f64> = (0..size[0] * size[1]).map(|n| at(n)[axis]).collect();
        let layout = ArrayLayout::map([size[0], size[1]], ["inline", "crossline"]);
        let about = said(["X of the trace", "Y of the trace"][axis], Some("m"));
        write_described(group, name, (layout, about), f64::NAN, &places, &quiet)?;
    }
    Ok(())
}

/// The coordinates that a volume has.
pub(super) fn stored(group: &Path) -> Result<Vec<StoredArray>, StoreError> {
    NAMES.iter().filter(|name| group.join(name).exists()).map(|name| StoredArray::open(group, name)).collect()
}

#[cfg(test)]
mod tests {
    use crate::array::StoredArray;
    use crate::{VolumeInfo, write_volume};
    use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};

    #[test]
    fn every_line_trace_and_sample_has_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.zarr");
        let mut geometry = SurveyGeometry::regular([3, 4, 5], 25.0, 4.0, VerticalUnit::Milliseconds);
        (geometry.inlines.first, geometry.inlines.step, geometry.vertical.first) = (100, 2, 800.0);
        let info = VolumeInfo::of(geometry.clone());
        write_volume(&path, &Volume::filled([3, 4, 5], 1.0f32), &info, &Progress::silent()).unwrap();
        let open = |name: &str| StoredArray::open(&path, name).unwrap();
        assert_eq!(open("inline").read::<i32>(&Progress::silent()).unwrap(), [100, 102, 104]);
        assert_eq!(open("sample").read::<f64>(&Progress::silent()).unwrap(), [800.0, 804.0, 808.0, 812.0, 816.0]);
        let x = open("cdp_x").read::<f64>(&Progress::silent()).unwrap();
        let y = open("cdp_y").read::<f64>(&Progress::silent()).unwrap();
        for n in 0..12 {
            let world = geometry.world_from_voxel(glam::DVec3::new((n / 4) as f64, (n % 4) as f64, 0.0));
            assert_eq!([x[n], y[n]], [world.x, world.y]);
        }
    }
}
