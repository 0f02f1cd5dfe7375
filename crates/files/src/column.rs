//! The content of a table's column, from the name of the column.

use super::unit::{Domain, ZPositive, ZUnit, words};
use serde::{Deserialize, Serialize};

/// The content of a table's column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Column {
    /// Inline number.
    Inline,
    /// Crossline number.
    Crossline,
    /// World X.
    X,
    /// World Y.
    Y,
    /// Vertical value.
    Z,
    /// Name of the surface.
    Name,
    /// Number of a fault stick.
    Stick,
    /// Number of a polygon or line, each of which is a fault of its own.
    Polygon,
    /// Number of a node along its stick.
    Node,
    /// Number of a sheet.
    Sheet,
    /// The X, Y and Z of a point's normal, in the directions of X, Y and Z.
    Nx,
    /// See [`Column::Nx`].
    Ny,
    /// See [`Column::Nx`].
    Nz,
    /// Which of several surfaces a point belongs to, as a number.
    Level,
    /// Dip from the horizontal, degrees.
    Dip,
    /// Direction of the dip, degrees clockwise from north.
    Azimuth,
    /// 1 where beds are the right way up, -1 where they are overturned.
    Polarity,
    /// The origin of the depth, in the words of [`survey::Quality`].
    Quality,
    /// Anything else; not read.
    Other,
}

impl Column {
    /// Parses a list of columns as options give it, such as `inline,crossline,z`; `-` or `_` stands for a column that
    /// is not read.
    ///
    /// # Errors
    /// The word that names no column.
    ///
    /// ```
    /// # use files::Column;
    /// assert_eq!(Column::parse_list("x,y,-,twt"), Ok(vec![Column::X, Column::Y, Column::Other, Column::Z]));
    /// assert_eq!(Column::parse_list("x,why"), Err("why".to_string()));
    /// ```
    pub fn parse_list(text: &str) -> Result<Vec<Self>, String> {
        text.split(',')
            .map(|word| match word.trim() {
                "-" | "_" | "other" => Ok(Self::Other),
                word => match of_name(word).column {
                    Self::Other => Err(word.to_string()),
                    column => Ok(column),
                },
            })
            .collect()
    }
}

/// What the name of a column states.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NamedColumn {
    pub column: Column,
    pub unit: Option<ZUnit>,
    pub domain: Option<Domain>,
    pub positive: Option<ZPositive>,
}

/// Parses the name of a column: `Inline`, `XL`, `twt_ms`, `Depth (ft)`, `"X"`, `INT,Inline` …
pub(super) fn of_name(name: &str) -> NamedColumn {
    let words::ColumnName { word, unit } = words::of_column(name);
    let (column, domain, positive) = match word.as_str() {
        "inline" | "iline" | "il" | "inl" | "in_line" | "inline_number" | "inline_no" | "inlineno" | "iline_no"
        | "inline_3d" | "inline3d" | "i_line" => (Column::Inline, None, None),
        "crossline" | "xline" | "xl" | "crl" | "cross_line" | "x_line" | "crossline_number" | "crossline_no"
        | "crosslineno" | "xline_no" | "crossline_3d" | "crossline3d" => (Column::Crossline, None, None),
        "x" | "easting" | "east" | "utmx" | "utm_x" | "x_utm" | "cdp_x" | "cdpx" | "x_coord" | "xcoord" | "coord_x"
        | "x_utme" | "x_coordinate" | "xcoordinate" | "x_world" | "world_x" | "rechtswert" | "este" => {
            (Column::X, None, None)
        }
        "y" | "northing" | "north" | "utmy" | "utm_y" | "y_utm" | "cdp_y" | "cdpy" | "y_coord" | "ycoord"
        | "coord_y" | "y_utmn" | "y_coordinate" | "ycoordinate" | "y_world" | "world_y" | "hochwert" | "norte" => {
            (Column::Y, None, None)
        }
        "z" | "z_value" | "zvalue" | "value" | "z_coordinate" => (Column::Z, None, None),
        "twt" | "time" | "twt_auto" | "twt_picked" | "twtt" | "twtime" | "two_way_time" | "t" | "laufzeit" | "zeit"
        | "temps" | "tiempo" | "tempo" => (Column::Z, Some(Domain::Time), None),
        "depth" | "tvd" | "tvdss" | "tvdmsl" | "z_tvdss" | "z_depth" | "tiefe" | "teufe" | "profondeur"
        | "profundidad" | "profundidade" => (Column::Z, Some(Domain::Depth), None),
        "elevation" | "elev" | "altitude" | "z_elevation" | "elevation_z" | "z_elev" => {
            (Column::Z, Some(Domain::Depth), Some(ZPositive::Up))
        }
        "name" | "horizon" | "surface" | "fault" | "horizon_name" | "fault_name" | "surface_name" | "formation"
        | "formation_name" | "feature_name" | "interface" => (Column::Name, None, None),
        "val" | "strati" | "horizon_id" | "surface_id" | "formation_id" | "id" | "surf_id" => {
            (Column::Level, None, None)
        }
        "dip" => (Column::Dip, None, None),
        "azimuth" | "dip_azimuth" | "dip_direction" | "dip_dir" | "dipdir" => (Column::Azimuth, None, None),
        "polarity" => (Column::Polarity, None, None),
        "stick" | "stick_id" | "stick_number" | "stick_no" | "sticknr" | "segment" | "seg_id" | "stick_index" => {
            (Column::Stick, None, None)
        }
        "poly_id" | "polygon_id" | "polygon" | "pol_id" | "polyid" => (Column::Polygon, None, None),
        "node" | "knot" | "node_id" | "node_number" | "knot_number" | "node_no" | "node_index" => {
            (Column::Node, None, None)
        }
        "nx" | "normal_x" | "normalx" | "norm_x" | "g_x" | "gx" => (Column::Nx, None, None),
        "ny" | "normal_y" | "normaly" | "norm_y" | "g_y" | "gy" => (Column::Ny, None, None),
        "nz" | "normal_z" | "normalz" | "norm_z" | "g_z" | "gz" => (Column::Nz, None, None),
        "sheet" | "sheet_index" => (Column::Sheet, None, None),
        "quality" => (Column::Quality, None, None),
        _ => (Column::Other, None, None),
    };
    NamedColumn { column, unit, domain, positive }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_programs() {
        for (name, column) in [
            ("Inline", Column::Inline),
            ("XL", Column::Crossline),
            ("\"X\"", Column::X),
            ("INT,Crossline", Column::Crossline),
            ("Y (NORTHING)", Column::Y),
            ("twt_ms", Column::Z),
            ("Depth (ft)", Column::Z),
            ("stick#", Column::Stick),
            ("POLY_ID", Column::Polygon),
            ("X_UTME", Column::X),
            ("Z_TVDSS", Column::Z),
            ("Correlation", Column::Other),
        ] {
            assert_eq!(of_name(name).column, column, "{name}");
        }
        assert_eq!(of_name("twt_ms").unit, Some(ZUnit::Milliseconds));
        assert_eq!(of_name("Depth (ft)").unit, Some(ZUnit::Feet));
        assert_eq!(of_name("elevation").positive, Some(ZPositive::Up));
    }
}
