//! The content of the columns of well tables, by their names.

use crate::unit::ZUnit;

/// A column of a deviation, tops or checkshot table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WellColumn {
    /// Measured depth.
    Md,
    /// Angle from the vertical, degrees.
    Inclination,
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

/// The column of a name and the unit it states: `MD (ft)`, `tvdss_m`, `INCL`, `DEPTH[M]`.
pub(super) fn of_name(name: &str) -> (WellColumn, Option<ZUnit>) {
    let mut name = name.trim().trim_matches('"').to_ascii_lowercase();
    if let Some((kind, after)) = name.split_once(',')
        && matches!(kind, "int" | "float" | "string" | "bool" | "double")
    {
        name = after.trim().to_string();
    }
    let mut unit = None;
    if let Some(open) = name.find(['(', '[']) {
        unit = ZUnit::parse(name[open + 1..].trim_end_matches([')', ']', ' ']));
        name.truncate(open);
    }
    let mut word = name.trim().replace([' ', '-', '.', '#'], "_").trim_matches('_').to_string();
    if let Some((stem, suffix)) = word.rsplit_once('_')
        && let Some(found) = ZUnit::parse(suffix)
    {
        unit = unit.or(Some(found));
        word = stem.to_string();
    }
    if let Some(stem) = word.strip_suffix("_deg").or_else(|| word.strip_suffix("_degrees")) {
        word = stem.to_string();
    }
    let column = match word.as_str() {
        "md" | "measured_depth" | "mdkb" | "md_kb" | "mdrkb" | "md_rkb" | "mdrt" | "md_rt" | "dept" | "depth_md"
        | "depth" | "measdepth" => WellColumn::Md,
        "inc" | "incl" | "inclination" | "dev" | "deviation" | "drift" | "angle" | "devi" => WellColumn::Inclination,
        "azi" | "azim" | "azimuth" | "hazi" | "azim_gn" | "azi_gn" | "azimuth_gn" | "azimuth_grid" | "azim_grid"
        | "azi_grid" | "azimuth_gridnorth" => WellColumn::Azimuth,
        "azim_tn" | "azi_tn" | "azimuth_tn" | "azimuth_true" | "azim_true" | "azi_true" => WellColumn::AzimuthTrue,
        "x" | "easting" | "east" | "x_coord" | "xcoord" | "utm_x" | "x_utm" | "x_coordinate" | "surface_x" => {
            WellColumn::X
        }
        "y" | "northing" | "north" | "y_coord" | "ycoord" | "utm_y" | "y_utm" | "y_coordinate" | "surface_y" => {
            WellColumn::Y
        }
        "dx" | "ew" | "e_w" | "x_offset" | "xoff" | "east_offset" | "dispew" | "ew_offset" | "deltax" | "delta_x" => {
            WellColumn::Dx
        }
        "dy" | "ns" | "n_s" | "y_offset" | "yoff" | "north_offset" | "dispns" | "ns_offset" | "deltay" | "delta_y" => {
            WellColumn::Dy
        }
        "tvd" | "tvdkb" | "tvd_kb" | "tvdrkb" | "tvd_rkb" | "tvdrt" | "true_vertical_depth" | "tvdbkb" => {
            WellColumn::Tvd
        }
        "tvdss" | "tvd_ss" | "tvdsub" | "tvdmsl" | "tvd_msl" | "ssd" | "subsea" | "tvdsd" => WellColumn::Tvdss,
        "z" | "elevation" | "elev" | "z_msl" | "zmsl" => WellColumn::Z,
        "twt" | "twt_picked" | "time" | "two_way_time" | "twtt" | "twt_auto" => WellColumn::Twt,
        "owt" | "one_way_time" | "owtt" => WellColumn::Owt,
        "surface" | "top" | "tops" | "marker" | "name" | "horizon" | "formation" | "pick" | "marker_name"
        | "top_name" | "surface_name" | "formation_name" | "unit" => WellColumn::Surface,
        "well" | "well_name" | "wellname" | "uwi" | "borehole" | "wellbore" | "well_identifier" => WellColumn::Well,
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
