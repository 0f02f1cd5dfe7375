//! The path of a well: stations by measured depth, and the interpolation between them.
//!
//! **Minimum curvature** (Taylor & Mason 1972; Sawaryn & Thorogood 2005, SPE 84246): stations with unit
//! tangents t₀, t₁ at angle β are joined by the arc of radius Δs/β. At the share f of its length, with w =
//! sin β,
//!
//! ```text
//! t(f) = (sin((1−f)β)·t₀ + sin(fβ)·t₁) / w
//! p(f) = p₀ + Δs/β · ((cos((1−f)β) − cos β)·t₀ + (1 − cos fβ)·t₁) / w
//! ```
//!
//! which at f = 1 is the usual Δs/2 · (t₀ + t₁) · tan(β/2)/(β/2). For β → 0 it is the parabola p₀ + Δs·(f·t₀ +
//! f²/2·(t₁ − t₀)). Vectors are (east, north, down), m; azimuths count clockwise from grid north,
//! inclinations from the vertical.

use super::error::WellError;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// One measurement of a directional survey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// Measured depth, m.
    pub md_m: f64,
    /// Angle from the vertical, degrees.
    pub inclination_deg: f64,
    /// Direction clockwise from grid north, degrees.
    pub azimuth_deg: f64,
}

/// A point on the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Station {
    /// Measured depth, m.
    pub md_m: f64,
    /// X, Y and TVDSS, m.
    pub position: DVec3,
    /// Unit vector along the hole (east, north, down), where it was surveyed.
    pub direction: Option<DVec3>,
}

/// A well's path: at least two stations, measured depths increasing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredPath", into = "StoredPath")]
pub struct WellPath {
    datum_m: f64,
    stations: Vec<Station>,
}

#[derive(Serialize, Deserialize)]
struct StoredPath {
    datum_m: f64,
    stations: Vec<Station>,
}

impl From<WellPath> for StoredPath {
    fn from(path: WellPath) -> Self {
        Self { datum_m: path.datum_m, stations: path.stations }
    }
}

impl TryFrom<StoredPath> for WellPath {
    type Error = WellError;

    fn try_from(stored: StoredPath) -> Result<Self, WellError> {
        Self::of_stations(stored.datum_m, stored.stations)
    }
}

/// Below this angle, in radians, an arc is computed as a parabola: both differ by less than β³.
const STRAIGHT_RAD: f64 = 1e-4;
/// No drilled hole turns by more than this between two neighbouring surveys.
const MAX_DOGLEG_DEG: f64 = 150.0;

impl Survey {
    /// The unit vector along the hole: east, north, down.
    pub fn direction(&self) -> DVec3 {
        let (sin_inc, cos_inc) = self.inclination_deg.to_radians().sin_cos();
        let (sin_azi, cos_azi) = self.azimuth_deg.to_radians().sin_cos();
        DVec3::new(sin_inc * sin_azi, sin_inc * cos_azi, cos_inc)
    }
}

/// Place and direction at the share f of the arc between two stations.
fn arc(p0: DVec3, t0: DVec3, t1: DVec3, length_m: f64, f: f64) -> (DVec3, DVec3) {
    // The angle from the chord of the unit vectors stays accurate where the arc cosine of their product does
    // not.
    let beta = 2.0 * (0.5 * (t1 - t0).length()).clamp(0.0, 1.0).asin();
    if beta < STRAIGHT_RAD {
        let place = p0 + length_m * (f * t0 + 0.5 * f * f * (t1 - t0));
        return (place, (t0 + f * (t1 - t0)).normalize_or(t0));
    }
    let w = beta.sin();
    let direction = (((1.0 - f) * beta).sin() * t0 + (f * beta).sin() * t1) / w;
    let place =
        p0 + length_m / beta * ((((1.0 - f) * beta).cos() - beta.cos()) * t0 + (1.0 - (f * beta).cos()) * t1) / w;
    (place, direction)
}

impl WellPath {
    /// The path of a directional survey from the well head by minimum curvature. `datum_m` is the datum's
    /// height above mean sea level. Above the first survey the hole is vertical, from MD 0 at the head.
    ///
    /// # Errors
    /// [`WellError::NotIncreasing`], [`WellError::Angle`], [`WellError::Dogleg`], [`WellError::TooShort`].
    pub fn minimum_curvature(head: DVec2, datum_m: f64, surveys: &[Survey]) -> Result<Self, WellError> {
        for s in surveys {
            if !(0.0..=180.0).contains(&s.inclination_deg) || !s.azimuth_deg.is_finite() || s.azimuth_deg.abs() > 720.0
            {
                return Err(WellError::Angle {
                    md_m: s.md_m,
                    inclination_deg: s.inclination_deg,
                    azimuth_deg: s.azimuth_deg,
                });
            }
        }
        let mut rows: Vec<(f64, DVec3)> = surveys.iter().map(|s| (s.md_m, s.direction())).collect();
        if rows.first().is_some_and(|(md, _)| *md > 0.0) {
            rows.insert(0, (0.0, DVec3::Z));
        }
        let mut stations: Vec<Station> = Vec::with_capacity(rows.len());
        for (md_m, direction) in rows {
            let position = match stations.last() {
                None => head.extend(md_m - datum_m),
                Some(last) => {
                    let before = last.direction.unwrap_or(DVec3::Z);
                    let dogleg_deg = before.angle_between(direction).to_degrees();
                    if dogleg_deg > MAX_DOGLEG_DEG {
                        return Err(WellError::Dogleg { md_m, dogleg_deg });
                    }
                    arc(last.position, before, direction, md_m - last.md_m, 1.0).0
                }
            };
            stations.push(Station { md_m, position, direction: Some(direction) });
        }
        Self::of_stations(datum_m, stations)
    }

    /// The path of straight lines through points. Unknown measured depths are the length along the path,
    /// counted from the vertical distance of the first point below the datum.
    ///
    /// # Errors
    /// [`WellError::NotIncreasing`], [`WellError::TooShort`], [`WellError::ShorterThanStraight`].
    pub fn through(datum_m: f64, places: &[(Option<f64>, DVec3)]) -> Result<Self, WellError> {
        let mut stations: Vec<Station> = Vec::with_capacity(places.len());
        for &(md, position) in places {
            let md_m = md.unwrap_or_else(|| match stations.last() {
                Some(last) => last.md_m + last.position.distance(position),
                None => (position.z + datum_m).max(0.0),
            });
            stations.push(Station { md_m, position, direction: None });
        }
        Self::of_stations(datum_m, stations)
    }

    /// The same stations with directions, in arcs between them; and how far the directions alone, from the first station
    /// on, lead from the others at most, m, and at which measured depth.
    ///
    /// # Errors
    /// [`WellError::Angle`], [`WellError::Dogleg`], [`WellError::TooShort`] where there is not one survey a station.
    pub fn with_directions(&self, surveys: &[Survey]) -> Result<(Self, f64, f64), WellError> {
        if surveys.len() != self.stations.len() {
            return Err(WellError::TooShort { stations: surveys.len() });
        }
        // It also checks the angles.
        Self::minimum_curvature(self.head(), self.datum_m, surveys)?;
        let mut path = self.clone();
        let (mut reached, mut worst, mut at) = (self.stations[0].position, 0.0, self.stations[0].md_m);
        for n in 0..surveys.len() {
            path.stations[n].direction = Some(surveys[n].direction());
            if n > 0 {
                let length_m = surveys[n].md_m - surveys[n - 1].md_m;
                reached = arc(reached, surveys[n - 1].direction(), surveys[n].direction(), length_m, 1.0).0;
                let off = reached.distance(self.stations[n].position);
                if off > worst {
                    (worst, at) = (off, surveys[n].md_m);
                }
            }
        }
        Ok((path, worst, at))
    }

    fn of_stations(datum_m: f64, stations: Vec<Station>) -> Result<Self, WellError> {
        if stations.len() < 2 {
            return Err(WellError::TooShort { stations: stations.len() });
        }
        let sane = |s: &Station| s.md_m.is_finite() && s.position.is_finite() && s.position.abs().max_element() < 1e12;
        if !datum_m.is_finite() || !stations.iter().all(sane) {
            return Err(WellError::NotANumber);
        }
        for pair in stations.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            if b.md_m <= a.md_m {
                return Err(WellError::NotIncreasing { what: "measured depth", before: a.md_m, after: b.md_m });
            }
            // A hole cannot be shorter than the straight line; numbers rounded in a file may be slightly
            // short.
            let straight_m = a.position.distance(b.position);
            let along_m = b.md_m - a.md_m;
            if straight_m > along_m * 1.02 + 0.5 {
                return Err(WellError::ShorterThanStraight { md_m: b.md_m, along_m, straight_m });
            }
        }
        Ok(Self { datum_m, stations })
    }

    /// Height of the datum (MD 0) above mean sea level, m.
    pub fn datum_m(&self) -> f64 {
        self.datum_m
    }

    /// The stations in order of measured depth.
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// X, Y at the first station, m.
    pub fn head(&self) -> DVec2 {
        self.stations[0].position.truncate()
    }

    /// First and last measured depth, m.
    pub fn md_range_m(&self) -> [f64; 2] {
        [self.stations[0].md_m, self.stations[self.stations.len() - 1].md_m]
    }

    /// Place and direction at a measured depth; None outside the surveyed range.
    fn at(&self, md_m: f64) -> Option<(DVec3, DVec3)> {
        let [first, last] = self.md_range_m();
        if !(first..=last).contains(&md_m) {
            return None;
        }
        let after = self.stations.partition_point(|s| s.md_m <= md_m).clamp(1, self.stations.len() - 1);
        Some(self.on_segment(after, md_m))
    }

    /// Between stations `after − 1` and `after`.
    fn on_segment(&self, after: usize, md_m: f64) -> (DVec3, DVec3) {
        let (a, b) = (&self.stations[after - 1], &self.stations[after]);
        let length_m = b.md_m - a.md_m;
        let f = (md_m - a.md_m) / length_m;
        match (a.direction, b.direction) {
            (Some(t0), Some(t1)) => {
                let (place, direction) = arc(a.position, t0, t1, length_m, f);
                // At the stations themselves their stored positions are exact.
                (
                    if f == 0.0 {
                        a.position
                    } else if f == 1.0 {
                        b.position
                    } else {
                        // Places that were given are reached, though the arc may end a little beside them.
                        place + f * (b.position - arc(a.position, t0, t1, length_m, 1.0).0)
                    },
                    direction,
                )
            }
            _ => (a.position.lerp(b.position, f), (b.position - a.position).normalize_or(DVec3::Z)),
        }
    }

    /// X, Y and TVDSS (m) at a measured depth (m); None outside the surveyed range.
    pub fn position_at_md(&self, md_m: f64) -> Option<DVec3> {
        self.at(md_m).map(|(place, _)| place)
    }

    /// Unit vector along the hole (east, north, down) at a measured depth (m).
    pub fn direction_at_md(&self, md_m: f64) -> Option<DVec3> {
        self.at(md_m).map(|(_, direction)| direction)
    }

    /// Measured depths (m) at which the path crosses a TVDSS (m), from the top; a horizontal hole may cross
    /// several times.
    ///
    /// # Cost
    /// O(stations).
    pub fn mds_at_tvdss(&self, tvdss_m: f64) -> Vec<f64> {
        let mut found: Vec<f64> = Vec::new();
        for after in 1..self.stations.len() {
            let (low, high) = (self.stations[after - 1].md_m, self.stations[after].md_m);
            let z = |md: f64| self.on_segment(after, md).0.z - tvdss_m;
            // Within the angles allowed, an arc reverses its vertical direction at most once: eight parts
            // bracket every crossing.
            let parts = if self.stations[after].direction.is_some() { 8 } else { 1 };
            let at = |n: usize| if n == parts { high } else { low + (high - low) * n as f64 / f64::from(parts as u32) };
            for n in 0..parts {
                let (mut a, mut b) = (at(n), at(n + 1));
                let (za, zb) = (z(a), z(b));
                if za == 0.0 {
                    found.push(a);
                } else if za * zb < 0.0 {
                    for _ in 0..80 {
                        let middle = 0.5 * (a + b);
                        if z(middle) * za > 0.0 { a = middle } else { b = middle }
                    }
                    found.push(0.5 * (a + b));
                }
            }
        }
        let [_, last] = self.md_range_m();
        if self.position_at_md(last).is_some_and(|p| p.z == tvdss_m) {
            found.push(last);
        }
        found.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        found
    }

    /// Measured depths along the path: every station, and steps of at most `step_m` between them.
    pub fn mds_by_step(&self, step_m: f64) -> Vec<f64> {
        let mut found = Vec::new();
        for pair in self.stations.windows(2) {
            let (low, high) = (pair[0].md_m, pair[1].md_m);
            let parts = ((high - low) / step_m).ceil().clamp(1.0, 1e5) as usize;
            found.extend((0..parts).map(|n| low + (high - low) * n as f64 / parts as f64));
        }
        found.push(self.md_range_m()[1]);
        found
    }

    /// The sharpest bend between two stations, degrees per 30 m.
    pub fn dogleg_severity(&self) -> f64 {
        let bend = |w: &[Station]| {
            let (t0, t1) = (w[0].direction?, w[1].direction?);
            Some(t0.angle_between(t1).to_degrees() * 30.0 / (w[1].md_m - w[0].md_m))
        };
        self.stations.windows(2).filter_map(bend).fold(0.0, f64::max)
    }
}
