//! Time–depth tables of a well: TVDSS (m) against two-way time (ms). Also the rule for a survey in time
//! without one.
//!
//! Between shots, time is linear in depth. Beyond the first and the last shot the nearest interval velocity
//! applies.

use super::error::WellError;
use serde::{Deserialize, Serialize};

/// A time–depth table in which both depth and time increase.
///
/// ```
/// # use survey::well::Checkshot;
/// let table = Checkshot::new(vec![[0.0, 0.0], [1000.0, 1000.0], [2500.0, 2000.0]])?;
/// assert_eq!(table.twt_at_tvdss(500.0), 500.0);
/// assert_eq!(table.tvdss_at_twt(1500.0), 1750.0);
/// assert_eq!(table.velocity_range_m_s(), [2000.0, 3000.0]);
/// # Ok::<(), survey::well::WellError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct Checkshot {
    /// (TVDSS in m, TWT in ms), at least two.
    points: Vec<[f64; 2]>,
}

impl TryFrom<Vec<[f64; 2]>> for Checkshot {
    type Error = WellError;

    fn try_from(points: Vec<[f64; 2]>) -> Result<Self, WellError> {
        Self::new(points)
    }
}

impl From<Checkshot> for Vec<[f64; 2]> {
    fn from(checkshot: Checkshot) -> Self {
        checkshot.points
    }
}

/// How depths along a well become vertical values of a survey.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeDepth {
    /// The survey is in depth: TVDSS is the vertical value.
    Depth,
    /// Through the well's checkshots.
    Checkshot,
    /// Through a constant velocity, m/s, from mean sea level.
    ConstantVelocity(f64),
}

impl std::fmt::Display for TimeDepth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Depth => f.write_str("depth below sea level"),
            Self::Checkshot => f.write_str("time through the well's checkshots"),
            Self::ConstantVelocity(v) => {
                write!(f, "time through a constant {v} m/s from sea level, because the well has no checkshots")
            }
        }
    }
}

impl Checkshot {
    /// A table of (TVDSS in m, TWT in ms).
    ///
    /// # Errors
    /// [`WellError::NotIncreasing`] in either column, [`WellError::TooShort`], [`WellError::NotANumber`].
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, WellError> {
        if points.len() < 2 {
            return Err(WellError::TooShort { stations: points.len() });
        }
        if points.iter().flatten().any(|v| !v.is_finite() || v.abs() > 1e9) {
            return Err(WellError::NotANumber);
        }
        for (axis, what) in ["checkshot depth", "checkshot time"].into_iter().enumerate() {
            if let Some(pair) = points.windows(2).find(|w| w[1][axis] <= w[0][axis]) {
                return Err(WellError::NotIncreasing { what, before: pair[0][axis], after: pair[1][axis] });
            }
        }
        Ok(Self { points })
    }

    /// The table: TVDSS in m, TWT in ms.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// TWT (ms) at a TVDSS (m).
    pub fn twt_at_tvdss(&self, tvdss_m: f64) -> f64 {
        self.along(tvdss_m, 0, 1)
    }

    /// TVDSS (m) at a TWT (ms).
    pub fn tvdss_at_twt(&self, twt_ms: f64) -> f64 {
        self.along(twt_ms, 1, 0)
    }

    fn along(&self, value: f64, from: usize, to: usize) -> f64 {
        let after = self.points.partition_point(|p| p[from] <= value).clamp(1, self.points.len() - 1);
        let (a, b) = (self.points[after - 1], self.points[after]);
        a[to] + (value - a[from]) * (b[to] - a[to]) / (b[from] - a[from])
    }

    /// Lowest and highest interval velocity, m/s.
    pub fn velocity_range_m_s(&self) -> [f64; 2] {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let of = |w: &[[f64; 2]]| 2000.0 * (w[1][0] - w[0][0]) / (w[1][1] - w[0][1]);
        self.points.windows(2).map(of).fold(none, |r, v| [r[0].min(v), r[1].max(v)])
    }
}
