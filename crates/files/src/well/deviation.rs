//! Deviation files: CSV or blanks, with named columns.
//!
//! | columns | path |
//! |---|---|
//! | X, Y and TVDSS, Z or TVD; MD where known | through these places; with angles in arcs between them |
//! | MD, inclination (or dip), azimuth | minimum curvature from the head |
//! | dX, dY (from the head) and TVD, TVDSS or Z | straight between the places |
//!
//! Places in a file win over angles: a sidetrack begins where its first place is. The file is told how far the angles
//! alone would lead from them. Where the user states a head, the angles are followed from there.
//!
//! The head comes from the option, a collar, the comments (`# WELL HEAD X-COORDINATE: …`), or X, Y of the first row. The
//! datum comes from the option; from TVD and TVDSS, whose difference it is; from a collar or the comments; from TVDSS at
//! MD 0; otherwise it is taken as 0 and reported. The sign of Z is determined by its trend: a hole goes down.
//!
//! Mines give dips from the horizontal, negative downwards in most files. Rows without a number are left out and counted.
//! Wells of ResInsight and Eclipse have the name alone on a line, then X, Y, TVDSS and MD, which no line names: they are
//! taken so where the lengths between the places are those of MD.

use super::collar::Collar;
use super::columns::WellColumn;
use super::error::WellFileError;
use super::options::WellOptions;
use super::report::WellReport;
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
    /// What was read and assumed.
    pub report: WellReport,
}

/// An example of a header that suffices.
const EXAMPLE: &str = "md_m,inclination_deg,azimuth_deg or md_m,x,y,tvdss_m";

/// Datums that two places of a file give differ by more than this, m, only where they contradict one another.
const SAME_DATUM_M: f64 = 0.05;

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
    deviation_of(file, text, None, options)
}

/// Reads a deviation whose head is that of a collar.
pub(super) fn deviation_of(
    file: &Path,
    text: &str,
    collar: Option<&Collar>,
    options: &WellOptions,
) -> Result<Deviation, WellFileError> {
    let mut table = Table::parse(file, text);
    if table.rows.is_empty() {
        return Err(WellFileError::Empty { file: file.to_owned(), what: "rows of a deviation" });
    }
    let mut report = WellReport::default();
    if let Some(columns) = &options.columns {
        table.state(columns);
    } else if table.columns.is_empty() {
        resinsight(file, &mut table, &mut report)?;
    }
    let titled = table.title.map(str::to_owned);
    let fact =
        || table.fact(&["well", "name"]).or_else(|| table.fact(&["well_name"])).or_else(|| table.fact(&["wellname"]));
    let name = titled.or_else(|| fact().map(str::to_string));
    let names: Vec<String> = options.name.iter().chain(&name).cloned().collect();
    table.keep_well(&options.well_in_file, &names.iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut reading = DeviationReading { file, table: &table, collar, options, report };
    let path = reading.path()?;
    Ok(Deviation { path, name, report: reading.report })
}

/// Takes rows of four numbers that no line names as X, Y, TVDSS and MD, if the lengths say that they are.
pub(super) fn resinsight(file: &Path, table: &mut Table<'_>, report: &mut WellReport) -> Result<(), WellFileError> {
    use WellColumn::{Md, Tvdss, X, Y};
    let numbers: Vec<Vec<f64>> = table
        .rows
        .iter()
        .map(|row| (0..row.fields.len()).map(|at| table.value(row, at).unwrap_or(f64::NAN)).collect())
        .collect();
    let are_lengths = |pair: &[Vec<f64>]| match pair {
        [a, b] if a.len() == 4 && b.len() == 4 => {
            let straight = DVec3::new(b[0] - a[0], b[1] - a[1], b[2] - a[2]).length();
            let along = b[3] - a[3];
            along > 0.0 && straight <= along * 1.001 + 0.02 && straight >= 0.5 * along
        }
        _ => false,
    };
    let width = numbers.first().map_or(0, Vec::len);
    if numbers.len() >= 2 && numbers.windows(2).all(are_lengths) {
        table.assume(&[X, Y, Tvdss, Md]);
        report.assume(Note::unless(
            "no line names the columns: taken as X, Y, TVDSS, MD, whose lengths agree",
            Setting::Columns.stated_as("md,inc,azi"),
        ));
        return Ok(());
    }
    Err(WellFileError::UnnamedColumns {
        file: file.to_owned(),
        width,
        example: if width >= 4 { "x,y,tvdss,md" } else { "md,inc,azi" },
    })
}

struct DeviationReading<'a> {
    file: &'a Path,
    table: &'a Table<'a>,
    collar: Option<&'a Collar>,
    options: &'a WellOptions,
    report: WellReport,
}

/// What the rows hold, m and degrees; NaN where a number is missing.
struct Rows {
    md: Option<Vec<f64>>,
    /// Inclination and azimuth.
    angles: Option<Vec<[f64; 2]>>,
    places: Option<Vec<DVec3>>,
}

impl Rows {
    fn retain(&mut self, kept: &[bool]) {
        fn of<T: Copy>(values: &mut Option<Vec<T>>, kept: &[bool]) {
            if let Some(values) = values {
                let mut n = 0;
                values.retain(|_| {
                    n += 1;
                    kept[n - 1]
                });
            }
        }
        of(&mut self.md, kept);
        of(&mut self.angles, kept);
        of(&mut self.places, kept);
    }
}

impl DeviationReading<'_> {
    fn path(&mut self) -> Result<WellPath, WellFileError> {
        let datum_m = self.datum()?;
        let md = self.column(WellColumn::Md)?;
        let inclination = self.inclination()?;
        let azimuth = match self.number(WellColumn::Azimuth)? {
            Some(azimuth) => Some((azimuth, false)),
            None => self.number(WellColumn::AzimuthTrue)?.map(|azimuth| (azimuth, true)),
        };
        let places = self.places(datum_m)?;
        let is_true = azimuth.as_ref().is_some_and(|(_, is_true)| *is_true);
        let angles = inclination.zip(azimuth.map(|(azimuth, _)| azimuth));
        let angles = angles.map(|(inc, azi)| inc.into_iter().zip(azi).map(|(inc, azi)| [inc, azi]).collect());
        let mut rows = Rows { md, angles, places };
        let has_angles = rows.md.is_some() && rows.angles.is_some();
        let by_angles = has_angles && (rows.places.is_none() || self.options.head.is_some());
        self.drop_incomplete(&mut rows, by_angles)?;
        match (&rows.md, &rows.angles, &rows.places) {
            (Some(md), Some(angles), places) if by_angles => {
                if is_true {
                    self.report.warn_once(
                        "the azimuths are from true north and were taken as from grid north; add the convergence in the \
                         file if it matters",
                    );
                }
                self.by_angles(datum_m, md, angles, places.as_deref())
            }
            (_, _, Some(_)) => self.through_places(datum_m, &rows),
            _ => Err(WellFileError::Columns {
                file: self.file.to_owned(),
                why: "the columns hold neither MD, inclination, azimuth nor X, Y and a depth".into(),
                example: EXAMPLE,
            }),
        }
    }

    /// Leaves out the rows in which a number is missing that the path needs.
    fn drop_incomplete(&mut self, rows: &mut Rows, by_angles: bool) -> Result<(), WellFileError> {
        let is_whole = |n: usize| {
            let md = rows.md.as_ref().is_none_or(|md| md[n].is_finite());
            let place = rows.places.as_ref().is_none_or(|places| places[n].is_finite());
            let angle = rows.angles.as_ref().is_none_or(|angles| angles[n].iter().all(|a| a.is_finite()));
            md && if by_angles { angle } else { place }
        };
        let kept: Vec<bool> = (0..self.table.rows.len()).map(is_whole).collect();
        let missing = kept.iter().filter(|kept| !**kept).count();
        if missing == kept.len() {
            return Err(WellFileError::Empty {
                file: self.file.to_owned(),
                what: "rows of a deviation with all numbers",
            });
        }
        if missing > 0 {
            rows.retain(&kept);
            let line = self.table.rows[kept.iter().position(|kept| !kept).unwrap_or(0)].line.number;
            self.report.warn_once(format!(
                "{missing} of {} stations lack a number and were left out, the first in line {line}",
                kept.len()
            ));
        }
        Ok(())
    }

    fn by_angles(
        &mut self,
        datum_m: f64,
        md: &[f64],
        angles: &[[f64; 2]],
        places: Option<&[DVec3]>,
    ) -> Result<WellPath, WellFileError> {
        let head = self.head(places)?;
        let mut surveys = surveys(md, angles);
        if let ([only], Some(length)) = (surveys.as_slice(), self.collar.and_then(|collar| collar.length_m)) {
            // A hole of a mine is often surveyed once.
            surveys.push(Survey { md_m: length, ..*only });
        }
        if let Some(first) = surveys.first().copied().filter(|first| first.md_m > 0.0 && self.collar.is_some()) {
            surveys.insert(0, Survey { md_m: 0.0, ..first });
        }
        let path = WellPath::minimum_curvature(head, datum_m, &surveys)?;
        self.report.note(format!("path by minimum curvature through {} surveys", surveys.len()));
        if surveys[0].md_m > 0.0 {
            self.report.note(format!("vertical from the head to the first survey at {} m", surveys[0].md_m));
        }
        if let Some(places) = places {
            let off = |(md, p): (&f64, &DVec3)| path.position_at_md(*md).map_or(0.0, |q| q.distance(*p));
            let worst = md.iter().zip(places).map(off).fold(0.0, f64::max);
            let line =
                format!("the file's own places are up to {worst:.2} m from this path, which begins at the stated head");
            let [first, last] = path.md_range_m();
            if worst > 0.002 * (last - first) + 1.0 { self.report.warn_once(line) } else { self.report.note(line) }
        }
        Ok(path)
    }

    fn through_places(&mut self, datum_m: f64, rows: &Rows) -> Result<WellPath, WellFileError> {
        let places = rows.places.as_deref().unwrap_or_default();
        let stations: Vec<(Option<f64>, DVec3)> =
            places.iter().enumerate().map(|(n, p)| (rows.md.as_ref().map(|md| md[n]), *p)).collect();
        let Some(md) = &rows.md else {
            self.report.note("no measured depths: added up along straight lines between the places");
            self.report.note(format!("path straight between {} places", stations.len()));
            return Ok(WellPath::through(datum_m, &stations)?);
        };
        let straight = WellPath::through(datum_m, &stations)?;
        let whole = rows.angles.as_ref().filter(|angles| angles.iter().flatten().all(|angle| angle.is_finite()));
        let Some(angles) = whole else {
            self.report.note(format!("path straight between {} places", stations.len()));
            return Ok(straight);
        };
        let surveys = surveys(md, angles);
        let Ok((path, worst, at)) = straight.with_directions(&surveys) else {
            self.report
                .warn_once("the angles are not those of a hole; the path runs straight between the file's places");
            return Ok(straight);
        };
        let [first, last] = path.md_range_m();
        let line = format!(
            "path through the file's own {} places; the angles alone, from the first of them, lead up to {worst:.2} m beside \
             them (MD {at:.0} m)",
            places.len()
        );
        if worst > 0.002 * (last - first) + 1.0 {
            self.report.warn_once(Note::unless(
                format!("{line}, so it runs straight between them"),
                Remedy::any([Setting::Head, Setting::Columns].map(Setting::stated)),
            ));
            return Ok(straight);
        }
        self.report.note(line);
        Ok(path)
    }

    /// The height of the datum above mean sea level: the first of what is stated, and what contradicts it.
    fn datum(&mut self) -> Result<f64, WellFileError> {
        let mut stated: Vec<(f64, String)> = Vec::new();
        stated.extend(self.options.datum_m.map(|told| (told, "as stated".to_owned())));
        if let (Some(tvd), Some((below, column))) = (self.column(WellColumn::Tvd)?, self.below_sea()?) {
            let mut apart: Vec<f64> =
                tvd.iter().zip(&below).map(|(tvd, z)| tvd - z).filter(|d| d.is_finite()).collect();
            apart.sort_by(f64::total_cmp);
            let [low, high] = [0.05, 0.95].map(|share: f64| apart.get((share * apart.len() as f64) as usize).copied());
            if let Some((low, high)) = low.zip(high).filter(|(low, high)| high - low < 0.5) {
                let datum = (0.5 * (low + high) * 1e4).round() / 1e4;
                stated.push((datum, format!("TVD minus {column}")));
            }
        }
        stated.extend(self.collar.map(|collar| (collar.position.z, "the collar's elevation".to_owned())));
        let keys: [&[&str]; 7] =
            [&["datum"], &["kelly"], &["kb"], &["rkb"], &["rotary"], &["derrick"], &["drill floor"]];
        let of_file = keys.into_iter().find_map(|words| self.table.length_fact(words));
        stated.extend(of_file.map(|found| (found, "as the file says".to_owned())));
        if stated.is_empty()
            && let (Some(md), Some((below, column))) = (self.column(WellColumn::Md)?, self.below_sea()?)
            && md.first() == Some(&0.0)
            && below.first().is_some_and(|z| z.is_finite())
        {
            stated.push((-below[0], format!("{column} at MD 0")));
        }
        let Some((datum, why)) = stated.first().cloned() else {
            self.report.warn_once(Note::unless(
                "no height of the datum (KB) is given: taken as 0 m above sea level",
                Setting::Datum.stated(),
            ));
            return Ok(0.0);
        };
        if let Some((other, against)) = stated.iter().find(|(other, _)| (other - datum).abs() > SAME_DATUM_M) {
            self.report.warn_once(Note::unless(
                format!("the datum above sea level is {datum} m ({why}) and {other} m ({against}); {datum} m is taken"),
                Setting::Datum.stated_as(other),
            ));
        } else if self.options.datum_m.is_none() {
            self.report.note(format!("datum {datum} m above sea level ({why})"));
        }
        Ok(datum)
    }

    fn head(&mut self, places: Option<&[DVec3]>) -> Result<DVec2, WellFileError> {
        if let Some([x, y]) = self.options.head {
            return Ok(DVec2::new(x, y));
        }
        if let Some(collar) = self.collar {
            return Ok(collar.position.truncate());
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
                    crate::number::of(value.split_whitespace().next()?)
                })
        };
        if let (Some(x), Some(y)) = (fact("x"), fact("y")) {
            self.report.note(format!("head at {x}, {y}, as the file says"));
            return Ok(DVec2::new(x, y));
        }
        let has_xy = self.table.position(WellColumn::X).is_some() && self.table.position(WellColumn::Y).is_some();
        if let Some(first) = places.filter(|_| has_xy).and_then(|p| p.first()) {
            self.report.note(format!("head at {}, {}, the first row's X, Y", first.x, first.y));
            return Ok(first.truncate());
        }
        if let (Some(x), Some(y)) = (self.column(WellColumn::X)?, self.column(WellColumn::Y)?)
            && let (Some(&x), Some(&y)) = (x.first(), y.first())
            && (x + y).is_finite()
        {
            self.report.note(format!("head at {x}, {y}, the first row's X, Y; the others are not used without depths"));
            return Ok(DVec2::new(x, y));
        }
        Err(WellFileError::NoHead { file: self.file.to_owned() })
    }

    /// A length column, in m.
    fn column(&mut self, column: WellColumn) -> Result<Option<Vec<f64>>, WellFileError> {
        let Some(at) = self.table.position(column) else { return Ok(None) };
        let told = match column {
            WellColumn::X | WellColumn::Y => self.options.xy_unit,
            _ => self.options.md_unit,
        };
        let to_m = self.table.length_to_m(at, told, &mut self.report)?;
        let rows = self.table.rows.iter().map(|row| Ok(self.table.value(row, at)? * to_m));
        rows.collect::<Result<Vec<f64>, WellFileError>>().map(Some)
    }

    fn number(&self, column: WellColumn) -> Result<Option<Vec<f64>>, WellFileError> {
        let Some(at) = self.table.position(column) else { return Ok(None) };
        let rows = self.table.rows.iter().map(|row| self.table.value(row, at));
        rows.collect::<Result<Vec<f64>, WellFileError>>().map(Some)
    }

    /// Angles from the vertical: as they are, or from dips, which most mines count negative downwards.
    fn inclination(&mut self) -> Result<Option<Vec<f64>>, WellFileError> {
        if let Some(found) = self.number(WellColumn::Inclination)? {
            return Ok(Some(found));
        }
        let Some(dips) = self.number(WellColumn::Dip)? else { return Ok(None) };
        let down = dips.iter().filter(|dip| **dip < 0.0).count() * 2 >= dips.len();
        let sign = if down { -1.0 } else { 1.0 };
        self.report.assume(Note::unless(
            format!(
                "dips are from the horizontal, {} downwards, as most of them are",
                if down { "negative" } else { "positive" }
            ),
            Setting::Columns.stated_as("md,inc,azi"),
        ));
        Ok(Some(dips.into_iter().map(|dip| 90.0 - sign * dip).collect()))
    }

    /// X, Y and TVDSS of every row, where the columns give them.
    fn places(&mut self, datum_m: f64) -> Result<Option<Vec<DVec3>>, WellFileError> {
        let depths = match self.below_sea()? {
            Some((depths, column)) => {
                if column == "Z" || column == "TVDSS" {
                    self.note_turned()?;
                }
                depths
            }
            None => match self.column(WellColumn::Tvd)? {
                Some(tvd) => tvd.into_iter().map(|tvd| tvd - datum_m).collect(),
                None => return Ok(None),
            },
        };
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

    /// TVDSS of every row, positive down, and the name of its column.
    fn below_sea(&mut self) -> Result<Option<(Vec<f64>, &'static str)>, WellFileError> {
        for (column, name) in [(WellColumn::Tvdss, "TVDSS"), (WellColumn::Z, "Z")] {
            let Some(mut depths) = self.column(column)? else { continue };
            if trend(&depths).is_some_and(|(first, last)| last < first) {
                depths.iter_mut().for_each(|d| *d = -*d);
            }
            return Ok(Some((depths, name)));
        }
        Ok(None)
    }

    /// Says that depths are elevations.
    fn note_turned(&mut self) -> Result<(), WellFileError> {
        for (column, name) in [(WellColumn::Tvdss, "TVDSS"), (WellColumn::Z, "Z")] {
            let Some(depths) = self.column(column)? else { continue };
            if let Some((first, last)) = trend(&depths).filter(|(first, last)| last < first) {
                let fact =
                    format!("{name} falls from {first} to {last} along the hole: elevations, turned positive down");
                self.report.note(fact);
            }
            break;
        }
        Ok(())
    }
}

/// The first and the last number that are there.
fn trend(values: &[f64]) -> Option<(f64, f64)> {
    let known = || values.iter().copied().filter(|value| value.is_finite());
    known().next().zip(known().next_back())
}

fn surveys(md: &[f64], angles: &[[f64; 2]]) -> Vec<Survey> {
    let of = |(md_m, [inclination_deg, azimuth_deg]): (&f64, &[f64; 2])| Survey {
        md_m: *md_m,
        inclination_deg: *inclination_deg,
        azimuth_deg: *azimuth_deg,
    };
    md.iter().zip(angles).map(of).collect()
}
