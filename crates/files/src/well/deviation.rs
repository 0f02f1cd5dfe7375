//! Deviation files: CSV or blanks, with named columns.
//!
//! | columns | path |
//! |---|---|
//! | MD, inclination, azimuth | minimum curvature from the head |
//! | X, Y and TVDSS, Z or TVD; MD where known | straight between the places |
//! | dX, dY (from the head) and TVD, TVDSS or Z | straight between the places |
//!
//! A file with both angles and places is read by its angles, and a note states how far the places are off. The head
//! comes from the option, the comments (`# WELL HEAD X-COORDINATE: …`), or X, Y of the first row; the datum comes from
//! the option or the comments, otherwise it is taken as 0 and reported. The sign of Z is determined by its trend: a
//! hole goes down.

use super::columns::WellColumn;
use super::error::WellFileError;
use super::options::WellOptions;
use super::table::Table;
use glam::{DVec2, DVec3};
use std::path::Path;
use survey::remedy::{Note, Remedy, Setting};
use survey::well::{Survey, WellPath};

/// A deviation as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// The path.
    pub path: WellPath,
    /// Name of the well in the file.
    pub name: Option<String>,
    /// What was read and assumed, one sentence each.
    pub notes: Vec<Note>,
    /// What the user should check, one sentence each.
    pub warnings: Vec<Note>,
}

/// An example of a header that suffices.
const EXAMPLE: &str = "md_m,inclination_deg,azimuth_deg or md_m,x,y,tvdss_m";

/// Reads a deviation.
///
/// # Errors
/// [`WellFileError`] with the line or the column that is missing.
///
/// ```
/// # use files::well::{WellOptions, parse_deviation};
/// let text = "md_m,inc,azi\n0,0,0\n1000,0,0\n";
/// let options = WellOptions { head: Some([10.0, 20.0]), datum_m: Some(30.0), ..WellOptions::default() };
/// let read = parse_deviation("A.csv".as_ref(), text, &options)?;
/// assert_eq!(read.path.position_at_md(1000.0).unwrap().to_array(), [10.0, 20.0, 970.0]);
/// # Ok::<(), files::well::WellFileError>(())
/// ```
pub fn parse_deviation(file: &Path, text: &str, options: &WellOptions) -> Result<Deviation, WellFileError> {
    let mut table = Table::parse(file, text);
    if table.rows.is_empty() {
        return Err(WellFileError::Empty { file: file.to_owned(), what: "rows of a deviation" });
    }
    if table.columns.is_empty() {
        return Err(WellFileError::Columns {
            file: file.to_owned(),
            why: "no line names the columns".into(),
            example: EXAMPLE,
        });
    }
    let name = table.fact(&["well", "name"]).or_else(|| table.fact(&["well_name"])).map(str::to_string);
    let names: Vec<&str> = options.name.as_deref().into_iter().chain(name.as_deref()).collect();
    let names: Vec<String> = names.into_iter().map(str::to_string).collect();
    table.keep_well(&options.well_in_file, &names.iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut reading = DeviationReading { file, table: &table, options, notes: Vec::new(), warnings: Vec::new() };
    let path = reading.path()?;
    let (notes, warnings) = (reading.notes, reading.warnings);
    Ok(Deviation { path, name, notes, warnings })
}

struct DeviationReading<'a> {
    file: &'a Path,
    table: &'a Table<'a>,
    options: &'a WellOptions,
    notes: Vec<Note>,
    warnings: Vec<Note>,
}

impl DeviationReading<'_> {
    fn path(&mut self) -> Result<WellPath, WellFileError> {
        let datum_m = self.datum();
        let md = self.column(WellColumn::Md)?;
        let inclination = self.angles(WellColumn::Inclination)?;
        let azimuth = match self.angles(WellColumn::Azimuth)? {
            Some(found) => Some(found),
            None => {
                let found = self.angles(WellColumn::AzimuthTrue)?;
                if found.is_some() {
                    self.warnings.push(
                        "the azimuths are from true north and were taken as from grid north; add the \
                         convergence in the file if it matters"
                            .into(),
                    );
                }
                found
            }
        };
        let places = self.places(datum_m)?;
        if let (Some(md), Some(inclination), Some(azimuth)) = (&md, inclination, azimuth) {
            let head = self.head(places.as_deref())?;
            let surveys: Vec<Survey> = (0..md.len())
                .map(|n| Survey { md_m: md[n], inclination_deg: inclination[n], azimuth_deg: azimuth[n] })
                .collect();
            let path = WellPath::minimum_curvature(head, datum_m, &surveys)?;
            self.notes.push(format!("path by minimum curvature through {} surveys", surveys.len()).into());
            if surveys[0].md_m > 0.0 {
                self.notes.push(format!("vertical from the head to the first survey at {} m", surveys[0].md_m).into());
            }
            self.compare(&path, md, places.as_deref());
            return Ok(path);
        }
        let Some(places) = places else {
            return Err(WellFileError::Columns {
                file: self.file.to_owned(),
                why: "the columns hold neither MD, inclination, azimuth nor X, Y and a depth".into(),
                example: EXAMPLE,
            });
        };
        let stations: Vec<(Option<f64>, DVec3)> =
            places.iter().enumerate().map(|(n, p)| (md.as_ref().map(|md| md[n]), *p)).collect();
        if md.is_none() {
            self.notes.push("no measured depths: added up along straight lines between the places".into());
        }
        self.notes.push(format!("path straight between {} places", stations.len()).into());
        Ok(WellPath::through(datum_m, &stations)?)
    }

    /// How far the file's own places are from the path.
    fn compare(&mut self, path: &WellPath, md: &[f64], places: Option<&[DVec3]>) {
        let Some(places) = places else { return };
        let off = |(md, p): (&f64, &DVec3)| path.position_at_md(*md).map_or(0.0, |q| q.distance(*p));
        let worst = md.iter().zip(places).map(off).fold(0.0, f64::max);
        let [first, last] = path.md_range_m();
        let line = format!("the file's own places are up to {worst:.2} m from this path");
        if worst > 0.002 * (last - first) + 1.0 {
            self.warnings.push(Note::unless(
                format!("{line}; check the head, the datum and which north the azimuths are from"),
                Remedy::any([Setting::Head, Setting::Datum].map(Setting::stated)),
            ));
        } else {
            self.notes.push(line.into());
        }
    }

    fn datum(&mut self) -> f64 {
        if let Some(told) = self.options.datum_m {
            return told;
        }
        let keys: [&[&str]; 7] =
            [&["datum"], &["kelly"], &["kb"], &["rkb"], &["rotary"], &["derrick"], &["drill floor"]];
        for words in keys {
            if let Some(found) = self.table.length_fact(words) {
                self.notes.push(format!("datum {found} m above sea level, as the file says").into());
                return found;
            }
        }
        self.warnings.push(Note::unless(
            "no height of the datum (KB) is given: taken as 0 m above sea level",
            Setting::Datum.stated(),
        ));
        0.0
    }

    fn head(&mut self, places: Option<&[DVec3]>) -> Result<DVec2, WellFileError> {
        if let Some([x, y]) = self.options.head {
            return Ok(DVec2::new(x, y));
        }
        let fact = |axis: &str| {
            let long = format!("{axis}-coordinate");
            let plain = format!("{axis} coordinate");
            [&["head", long.as_str()][..], &["head", plain.as_str()], &[long.as_str()], &[plain.as_str()]]
                .into_iter()
                .find_map(|words| self.table.length_fact(words))
                .or_else(|| {
                    let key = |k: &str| k == format!("head_{axis}") || k == format!("head {axis}") || k == axis;
                    let (_, value) = self.table.facts.iter().find(|(k, _)| key(k))?;
                    value.split_whitespace().next()?.parse().ok()
                })
        };
        if let (Some(x), Some(y)) = (fact("x"), fact("y")) {
            self.notes.push(format!("head at {x}, {y}, as the file says").into());
            return Ok(DVec2::new(x, y));
        }
        let has_xy = self.table.position(WellColumn::X).is_some() && self.table.position(WellColumn::Y).is_some();
        if let Some(first) = places.filter(|_| has_xy).and_then(|p| p.first()) {
            self.notes.push(format!("head at {}, {}, the first row's X, Y", first.x, first.y).into());
            return Ok(first.truncate());
        }
        Err(WellFileError::NoHead { file: self.file.to_owned() })
    }

    /// A length column, in m.
    fn column(&mut self, column: WellColumn) -> Result<Option<Vec<f64>>, WellFileError> {
        let Some(at) = self.table.position(column) else { return Ok(None) };
        // X, Y are in the survey's metres unless their names say otherwise, whatever the unit of depths.
        let told = match column {
            WellColumn::X | WellColumn::Y => self.table.units[at].or(Some(crate::unit::ZUnit::Metres)),
            _ => self.options.md_unit,
        };
        let to_m = self.table.length_to_m(at, told, &mut self.notes)?;
        let rows = self.table.rows.iter().map(|row| Ok(self.table.number(row, at)? * to_m));
        rows.collect::<Result<Vec<f64>, WellFileError>>().map(Some)
    }

    fn angles(&mut self, column: WellColumn) -> Result<Option<Vec<f64>>, WellFileError> {
        let Some(at) = self.table.position(column) else { return Ok(None) };
        let rows = self.table.rows.iter().map(|row| self.table.number(row, at));
        rows.collect::<Result<Vec<f64>, WellFileError>>().map(Some)
    }

    /// X, Y and TVDSS of every row, where the columns give them.
    fn places(&mut self, datum_m: f64) -> Result<Option<Vec<DVec3>>, WellFileError> {
        let Some(depths) = self.depths(datum_m)? else { return Ok(None) };
        let (x, y) = (self.column(WellColumn::X)?, self.column(WellColumn::Y)?);
        if let (Some(x), Some(y)) = (x, y) {
            return Ok(Some((0..x.len()).map(|n| DVec3::new(x[n], y[n], depths[n])).collect()));
        }
        let (dx, dy) = (self.column(WellColumn::Dx)?, self.column(WellColumn::Dy)?);
        let (Some(dx), Some(dy)) = (dx, dy) else { return Ok(None) };
        let head = match self.head(None) {
            Ok(head) => head,
            // The angles may still give the path; if they do not, the missing head is reported there.
            Err(error) if self.table.position(WellColumn::Inclination).is_none() => return Err(error),
            Err(_) => return Ok(None),
        };
        Ok(Some((0..dx.len()).map(|n| DVec3::new(head.x + dx[n], head.y + dy[n], depths[n])).collect()))
    }

    /// TVDSS of every row.
    fn depths(&mut self, datum_m: f64) -> Result<Option<Vec<f64>>, WellFileError> {
        for column in [WellColumn::Tvdss, WellColumn::Z, WellColumn::Tvd] {
            let Some(mut depths) = self.column(column)? else { continue };
            let (first, last) = (depths[0], depths[depths.len() - 1]);
            if last < first && column != WellColumn::Tvd {
                depths.iter_mut().for_each(|d| *d = -*d);
                let name = if column == WellColumn::Z { "Z" } else { "TVDSS" };
                self.notes.push(
                    format!("{name} falls from {first} to {last} along the hole: elevations, turned positive down")
                        .into(),
                );
            }
            if column == WellColumn::Tvd {
                depths.iter_mut().for_each(|d| *d -= datum_m);
            }
            return Ok(Some(depths));
        }
        Ok(None)
    }
}
