//! The coordinate systems that files name: whether places are angles, and the unit of X and Y.

use super::FormatError;
use super::SurfaceKind;
use super::raw::RawSurface;
use super::text::{SourceFile, excerpt};
use super::unit::ZUnit;

/// What a file says of its coordinate system.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) enum Crs {
    /// Nothing.
    #[default]
    Unknown,
    /// Longitude and latitude, with the words.
    Geographic(String),
    /// X and Y in a unit, if it is one that is known, with the words.
    Projected(Option<ZUnit>, String),
}

impl Crs {
    /// That of well-known text, as in `.prj` files and GeoPackages, of either version.
    pub(super) fn of_wkt(text: &str) -> Self {
        let plain = text.trim().to_ascii_uppercase();
        let words = excerpt(text.trim().split(',').next().unwrap_or(text));
        let begins = |starts: &[&str]| starts.iter().any(|start| plain.starts_with(start));
        // The system of X and Y is the first of a compound one.
        if begins(&["COMPD_CS[", "COMPOUNDCRS[", "BOUNDCRS["])
            && let Some(inner) = ["PROJCS[", "PROJCRS[", "GEOGCS[", "GEOGCRS[", "LOCAL_CS["]
                .iter()
                .filter_map(|start| plain.find(start))
                .min()
        {
            // Upper case of ASCII leaves every byte where it is.
            return Self::of_wkt(text.trim().get(inner..).unwrap_or_default());
        }
        if begins(&["GEOGCS[", "GEOGCRS[", "GEODCRS[", "GEODETICCRS["]) {
            return Self::Geographic(words);
        }
        if !begins(&["PROJCS[", "PROJCRS[", "LOCAL_CS[", "ENGCRS["]) {
            return Self::Unknown;
        }
        // Units before the projection are those of its angles, units after the first are those of heights.
        let own = ["CS[CARTESIAN", "PROJECTION["].iter().find_map(|word| plain.find(word)).unwrap_or(0);
        let size = |unit: &str| unit.split(']').next()?.split(',').nth(1)?.trim().parse::<f64>().ok();
        let unit = plain[own..].split("UNIT[").skip(1).find_map(size);
        Self::Projected(unit.and_then(unit_of_metres), words)
    }

    /// An error where places are angles.
    pub(super) fn refuse_degrees(&self, source: &SourceFile, kind: SurfaceKind) -> Result<(), FormatError> {
        match self {
            Self::Geographic(words) => Err(source.degrees(kind, words)),
            Self::Unknown | Self::Projected(..) => Ok(()),
        }
    }

    /// Tells a surface in which unit its X and Y are.
    pub(super) fn state(&self, surface: &mut RawSurface) {
        if let Self::Projected(Some(unit), words) = self {
            surface.horizontal = Some((*unit, words.clone()));
        }
    }
}

/// The unit that has so many metres.
pub(super) fn unit_of_metres(size: f64) -> Option<ZUnit> {
    ZUnit::LENGTHS.into_iter().find(|unit| (size / unit.in_survey() - 1.0).abs() < 1e-7)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn well_known_text_of_many_programs() {
        let geographic = "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],\
                          PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";
        let utm = |unit: &str| {
            format!(
                "PROJCS[\"UTM 31\",{geographic},PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"Scale_Factor\",0.9996],{unit}]"
            )
        };
        let unit = |text: &str| match Crs::of_wkt(text) {
            Crs::Projected(unit, _) => unit,
            other => panic!("{other:?}"),
        };
        assert!(matches!(Crs::of_wkt(geographic), Crs::Geographic(words) if words.contains("GCS_WGS_1984")));
        assert!(matches!(Crs::of_wkt("GEOGCRS[\"WGS 84\",ENSEMBLE[\"x\"]]"), Crs::Geographic(_)));
        assert_eq!(unit(&utm("UNIT[\"Meter\",1.0]")), Some(ZUnit::Metres));
        assert_eq!(unit(&utm("UNIT[\"Foot_US\",0.3048006096012192]")), Some(ZUnit::SurveyFeet));
        assert_eq!(unit(&utm("UNIT[\"Foot\",0.3048]")), Some(ZUnit::Feet));
        assert_eq!(unit(&utm("UNIT[\"furlong\",201.168]")), None);
        let compound =
            format!("COMPD_CS[\"UTM + height\",{},VERT_CS[\"h\",UNIT[\"foot\",0.3048]]]", utm("UNIT[\"metre\",1]"));
        assert_eq!(unit(&compound), Some(ZUnit::Metres), "the other is the unit of heights");
        let second = "PROJCRS[\"UTM 31\",BASEGEOGCRS[\"WGS 84\",ANGLEUNIT[\"degree\",0.0174]],CONVERSION[\"UTM\",PARAMETER[\"k\",0.9996,\
                      SCALEUNIT[\"unity\",1]]],CS[Cartesian,2],AXIS[\"(E)\",east],LENGTHUNIT[\"US survey foot\",0.304800609601219]]";
        assert_eq!(unit(second), Some(ZUnit::SurveyFeet));
        for text in ["", "nonsense", "PROJ"] {
            assert_eq!(Crs::of_wkt(text), Crs::Unknown, "{text}");
        }
    }
}
