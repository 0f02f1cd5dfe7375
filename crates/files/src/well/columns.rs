//! The content of the columns of well tables, by their names.

use crate::unit::{ZUnit, words};
use serde::{Deserialize, Serialize};

/// A column of a deviation, tops or checkshot table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WellColumn {
    /// Measured depth.
    Md,
    /// Where an interval begins, along the hole.
    From,
    /// Where an interval ends.
    To,
    /// Length of the hole.
    Length,
    /// Angle from the vertical, degrees.
    Inclination,
    /// Angle from the horizontal, degrees.
    Dip,
    /// Azimuth from grid north, or from a north that is not specified.
    Azimuth,
    /// Azimuth from true north.
    AzimuthTrue,
    /// World X.
    X,
    /// World Y.
    Y,
    /// Offset to the east of the head.
    Dx,
    /// Offset to the north of the head.
    Dy,
    /// True vertical depth below the datum.
    Tvd,
    /// True vertical depth below mean sea level.
    Tvdss,
    /// A vertical coordinate from mean sea level, of either sign.
    Z,
    /// Two-way time.
    Twt,
    /// One-way time.
    Owt,
    /// Name of a surface.
    Surface,
    /// Name of a well.
    Well,
    /// Anything else.
    Other,
}

impl WellColumn {
    /// Parses a list of columns as options give it, such as `x,y,tvdss,md`; `-` or `_` stands for a column that is not
    /// read.
    ///
    /// # Errors
    /// The word that names no column.
    ///
    /// ```
    /// # use files::well::WellColumn;
    /// assert_eq!(WellColumn::parse_list("md,-,inc"), Ok(vec![WellColumn::Md, WellColumn::Other, WellColumn::Inclination]));
    /// assert_eq!(WellColumn::parse_list("md,why"), Err("why".to_string()));
    /// ```
    pub fn parse_list(text: &str) -> Result<Vec<Self>, String> {
        text.split(',')
            .map(|word| match word.trim() {
                "-" | "_" | "other" => Ok(Self::Other),
                word => match of_name(word).0 {
                    Self::Other => Err(word.to_string()),
                    column => Ok(column),
                },
            })
            .collect()
    }
}

/// The column of a name and the unit it states: `MD (ft)`, `tvdss_m`, `INCL`, `DEPTH[M]`.
pub(super) fn of_name(name: &str) -> (WellColumn, Option<ZUnit>) {
    let words::ColumnName { mut word, unit } = words::of_column(name);
    if let Some(stem) = word.strip_suffix("_deg").or_else(|| word.strip_suffix("_degrees")) {
        word = stem.to_string();
    }
    let column =
        match word.as_str() {
            "md" | "measured_depth" | "mdkb" | "md_kb" | "mdrkb" | "md_rkb" | "mdrt" | "md_rt" | "dept"
            | "depth_md" | "depth" | "measdepth" | "mdepth" | "at" | "teufe" | "tiefe" | "profondeur"
            | "profundidad" | "profundidade" => WellColumn::Md,
            "from" | "depth_from" | "from_depth" | "von" | "de" | "desde" => WellColumn::From,
            "to" | "depth_to" | "to_depth" | "bis" | "hasta" => WellColumn::To,
            "dip" | "plunge" | "inclination_from_horizontal" => WellColumn::Dip,
            "length" | "max_depth" | "total_depth" | "td" | "eoh" | "hole_length" => WellColumn::Length,
            "inc" | "incl" | "inclination" | "dev" | "deviation" | "drift" | "angle" | "devi" => {
                WellColumn::Inclination
            }
            "azi" | "azim" | "azimuth" | "hazi" | "bearing" | "brg" | "trend" | "azim_gn" | "azi_gn" | "azimuth_gn"
            | "azimuth_grid" | "azim_grid" | "azi_grid" | "azimuth_gridnorth" => WellColumn::Azimuth,
            "azim_tn" | "azi_tn" | "azimuth_tn" | "azimuth_true" | "azim_true" | "azi_true" => WellColumn::AzimuthTrue,
            "x" | "easting" | "east" | "collar_x" | "x_collar" | "rechtswert" | "x_coord" | "xcoord" | "utm_x"
            | "x_utm" | "x_coordinate" | "surface_x" => WellColumn::X,
            "y" | "northing" | "north" | "collar_y" | "y_collar" | "hochwert" | "y_coord" | "ycoord" | "utm_y"
            | "y_utm" | "y_coordinate" | "surface_y" => WellColumn::Y,
            "dx" | "ew" | "e_w" | "x_offset" | "xoff" | "east_offset" | "dispew" | "ew_offset" | "deltax"
            | "delta_x" => WellColumn::Dx,
            "dy" | "ns" | "n_s" | "y_offset" | "yoff" | "north_offset" | "dispns" | "ns_offset" | "deltay"
            | "delta_y" => WellColumn::Dy,
            "tvd" | "tvdkb" | "tvd_kb" | "tvdrkb" | "tvd_rkb" | "tvdrt" | "true_vertical_depth" | "tvdbkb" => {
                WellColumn::Tvd
            }
            "tvdss" | "tvd_ss" | "tvdsub" | "tvdmsl" | "tvd_msl" | "ssd" | "subsea" | "tvdsd" | "tvd_sd"
            | "tvd_subsea" => WellColumn::Tvdss,
            "z" | "elevation" | "elev" | "z_elevation" | "elevation_z" | "z_elev" | "rl" | "collar_z" | "z_collar"
            | "z_msl" | "zmsl" => WellColumn::Z,
            "twt" | "twt_picked" | "time" | "two_way_time" | "twtt" | "twt_auto" => WellColumn::Twt,
            "owt" | "one_way_time" | "owtt" => WellColumn::Owt,
            "surface" | "top" | "tops" | "marker" | "name" | "horizon" | "formation" | "pick" | "marker_name"
            | "top_name" | "surface_name" | "formation_name" | "unit" | "lithology" | "lith" | "rock" | "code"
            | "zone" => WellColumn::Surface,
            "well" | "well_name" | "wellname" | "uwi" | "borehole" | "wellbore" | "well_identifier" | "hole_id"
            | "holeid" | "bhid" | "hole" | "dhid" | "drillhole" | "site_id" => WellColumn::Well,
            _ => WellColumn::Other,
        };
    (column, unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_programs() {
        for (name, column) in [
            ("MD (ft)", WellColumn::Md),
            ("INCL", WellColumn::Inclination),
            ("AZIM_TN", WellColumn::AzimuthTrue),
            ("AZIM_GN", WellColumn::Azimuth),
            ("inclination_deg", WellColumn::Inclination),
            ("TVDSS[m]", WellColumn::Tvdss),
            ("STRING,Surface", WellColumn::Surface),
            ("TWT picked (ms)", WellColumn::Twt),
            ("DLS", WellColumn::Other),
        ] {
            assert_eq!(of_name(name).0, column, "{name}");
        }
        assert_eq!(of_name("MD (ft)").1, Some(ZUnit::Feet));
        assert_eq!(of_name("TWT picked (ms)").1, Some(ZUnit::Milliseconds));
        assert_eq!(of_name("tvdss_m").1, Some(ZUnit::Metres));
    }
}
