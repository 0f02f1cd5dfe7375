//! The position of a sample: voxel indices, line numbers, world coordinates and metres.
//!
//! The horizontal map is affine, `[X Y]ᵀ = origin + x·inline_vector + y·crossline_vector`, and may be
//! rotated, skewed or mirrored. The vertical axis is TWT in ms or depth in m, positive down. All conversions
//! are methods of [`SurveyGeometry`].

use glam::{DMat2, DMat3, DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Most voxels of a survey, 2⁴²: sixteen times the largest that were recorded.
pub const MAX_VOXELS: u64 = 1 << 42;

/// Largest coordinate, m, and vertical value in its unit: far beyond the Earth, and exact to a millimetre.
pub const MAX_COORDINATE: f64 = 1e9;

/// Highest velocity, m/s: above that of any rock and of any unit mistaken for m/s.
const MAX_VELOCITY_M_S: f64 = 1e6;

/// Velocity assumed for two-way time when the project states none, m/s.
pub const DEFAULT_VELOCITY_M_S: f64 = 2000.0;

/// Line numbers with a constant step, ascending or descending.
///
/// ```
/// # use survey::LineAxis;
/// let inlines = LineAxis { first: 100, step: 2, count: 11 };
/// assert_eq!(inlines.last(), 120);
/// assert_eq!(inlines.number_at(2.0), 104.0);
/// assert_eq!(inlines.index_of(105.0), 2.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineAxis {
    /// Number of the line at index 0.
    pub first: i32,
    /// Difference between the numbers of neighbouring lines; never 0, negative when the numbers descend.
    pub step: i32,
    /// Count of lines.
    pub count: usize,
}

impl LineAxis {
    /// Number of the last line.
    pub fn last(&self) -> i32 {
        // The last number fits into an i32, but the product may not.
        let last = i64::from(self.first) + i64::from(self.step) * (self.count.max(1) as i64 - 1);
        last as i32
    }

    /// Fractional index of a (fractional) line number.
    #[inline]
    pub fn index_of(&self, number: f64) -> f64 {
        (number - f64::from(self.first)) / f64::from(self.step)
    }

    /// Line number at a fractional index.
    #[inline]
    pub fn number_at(&self, index: f64) -> f64 {
        f64::from(self.first) + index * f64::from(self.step)
    }
}

/// What the vertical axis measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum VerticalUnit {
    /// Two-way travel time in milliseconds.
    #[serde(rename = "ms")]
    Milliseconds,
    /// Depth in metres.
    #[serde(rename = "m")]
    Metres,
}

impl VerticalUnit {
    /// The unit's symbol, `ms` or `m`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Milliseconds => "ms",
            Self::Metres => "m",
        }
    }
}

/// Samples at a constant interval, positive down.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VerticalAxis {
    /// Value of sample 0, in `unit`.
    pub first: f64,
    /// Distance between samples, in `unit`; positive.
    pub interval: f64,
    /// Count of samples.
    pub count: usize,
    /// What is measured.
    pub unit: VerticalUnit,
}

impl VerticalAxis {
    /// Value of the last sample.
    pub fn last(&self) -> f64 {
        self.first + self.interval * (self.count.max(1) as f64 - 1.0)
    }

    /// Fractional sample index of a vertical value.
    #[inline]
    pub fn index_of(&self, value: f64) -> f64 {
        (value - self.first) / self.interval
    }

    /// Vertical value at a fractional sample index.
    #[inline]
    pub fn value_at(&self, index: f64) -> f64 {
        self.first + index * self.interval
    }
}

/// The lattice of a survey and its position in world coordinates.
///
/// ```
/// # use glam::{DVec2, DVec3};
/// # use survey::{LineAxis, SurveyGeometry, VerticalUnit};
/// let geometry = SurveyGeometry {
///     inlines: LineAxis { first: 100, step: 2, count: 11 },
///     crosslines: LineAxis { first: 500, step: -1, count: 21 },
///     origin: DVec2::new(1000.0, 2000.0),
///     ..SurveyGeometry::regular([11, 21, 31], 25.0, 4.0, VerticalUnit::Milliseconds)
/// };
/// let voxel = geometry.voxel_from_lines(104.0, 497.0);
/// assert_eq!(voxel, DVec2::new(2.0, 3.0));
/// assert_eq!(geometry.lines_from_voxel(voxel), DVec2::new(104.0, 497.0));
///
/// let world = geometry.world_from_voxel(voxel.extend(10.0));
/// assert_eq!(world, DVec3::new(1050.0, 2075.0, 40.0));
/// assert!(geometry.voxel_from_world(world).abs_diff_eq(DVec3::new(2.0, 3.0, 10.0), 1e-9));
///
/// // 4 ms of two-way time at 2000 m/s are 4 m of depth.
/// assert_eq!(geometry.sample_m(), 4.0);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurveyGeometry {
    /// Inline numbers along x.
    pub inlines: LineAxis,
    /// Crossline numbers along y.
    pub crosslines: LineAxis,
    /// Samples along z.
    pub vertical: VerticalAxis,
    /// World X, Y of voxel (0, 0), m.
    pub origin: DVec2,
    /// World step from one inline index to the next (x + 1), m.
    pub inline_vector: DVec2,
    /// World step from one crossline index to the next (y + 1), m.
    pub crossline_vector: DVec2,
    /// Velocity that turns TWT into metres, m/s; unused for depth.
    pub velocity_m_s: f64,
}

/// Why a geometry cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// An axis has no lines or samples.
    #[error("the {axis} axis is empty; a volume needs at least one line or sample on each axis")]
    Empty {
        /// Name of the axis.
        axis: &'static str,
    },
    /// A line step is 0.
    #[error("the {axis} step is 0; lines need distinct numbers")]
    ZeroStep {
        /// Name of the axis.
        axis: &'static str,
    },
    /// The bin cell has no area.
    #[error(
        "the bin cell is degenerate: inline vector {inline:?} m and crossline vector {crossline:?} m span no \
         area; check the coordinate bytes and scalar"
    )]
    DegenerateBin {
        /// The inline vector.
        inline: [f64; 2],
        /// The crossline vector.
        crossline: [f64; 2],
    },
    /// More voxels than any survey has.
    #[error(
        "{inlines} x {crosslines} x {samples} voxels are more than a survey may have, {MAX_VOXELS}; state smaller counts"
    )]
    TooLarge {
        /// Inlines.
        inlines: usize,
        /// Crosslines.
        crosslines: usize,
        /// Samples.
        samples: usize,
    },
    /// Line numbers that do not fit 32 bits.
    #[error("the last {axis} number, {last}, is beyond 32 bits; count or step of the {axis} axis is wrong")]
    LineNumber {
        /// Name of the axis.
        axis: &'static str,
        /// What the last number would be.
        last: i64,
    },
    /// Coordinates, vertical values or a velocity that are no numbers or beyond the Earth.
    #[error("{what} reaches {found:e}, beyond what a survey may have, {limit:e}; check the unit")]
    Beyond {
        /// Which quantity.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The limit.
        limit: f64,
    },
    /// The sample interval or velocity is not a positive number.
    #[error("{what} must be a positive number, found {found}")]
    NotPositive {
        /// Which quantity.
        what: &'static str,
        /// Its value.
        found: f64,
    },
}

impl SurveyGeometry {
    /// An unrotated survey with square bins. Inline index i lies at X = i·bin_m and crossline index j at Y =
    /// j·bin_m. Line numbers start at 1 with step 1; the vertical axis starts at 0 with the step `interval`.
    ///
    /// ```
    /// # use survey::{SurveyGeometry, VerticalUnit};
    /// let g = SurveyGeometry::regular([11, 21, 31], 25.0, 4.0, VerticalUnit::Metres);
    /// assert_eq!(g.world_from_voxel(glam::DVec3::new(10.0, 20.0, 30.0)), glam::DVec3::new(250.0, 500.0, 120.0));
    /// ```
    pub fn regular(size: [usize; 3], bin_m: f64, interval: f64, unit: VerticalUnit) -> Self {
        Self {
            inlines: LineAxis { first: 1, step: 1, count: size[0] },
            crosslines: LineAxis { first: 1, step: 1, count: size[1] },
            vertical: VerticalAxis { first: 0.0, interval, count: size[2], unit },
            origin: DVec2::ZERO,
            inline_vector: DVec2::new(bin_m, 0.0),
            crossline_vector: DVec2::new(0.0, bin_m),
            velocity_m_s: DEFAULT_VELOCITY_M_S,
        }
    }

    /// Checks that the axes are not empty, that steps, interval and velocity are valid, that the bin has an
    /// area, and that counts, line numbers and coordinates are within what a survey may have. Every
    /// conversion relies on this, and so does everything that multiplies counts.
    ///
    /// # Errors
    /// The first [`GeometryError`] found.
    pub fn validate(&self) -> Result<(), GeometryError> {
        for (axis, count) in
            [("inline", self.inlines.count), ("crossline", self.crosslines.count), ("sample", self.vertical.count)]
        {
            if count == 0 {
                return Err(GeometryError::Empty { axis });
            }
        }
        for (axis, step) in [("inline", self.inlines.step), ("crossline", self.crosslines.step)] {
            if step == 0 {
                return Err(GeometryError::ZeroStep { axis });
            }
        }
        for (what, found) in [("the sample interval", self.vertical.interval), ("the velocity", self.velocity_m_s)] {
            if !(found > 0.0 && found.is_finite()) {
                return Err(GeometryError::NotPositive { what, found });
            }
        }
        let area = self.inline_vector.perp_dot(self.crossline_vector).abs();
        let sides = self.inline_vector.length() * self.crossline_vector.length();
        // A NaN in either vector must fail too, hence the negated comparison.
        if !(sides > 0.0 && area > 1e-6 * sides) {
            return Err(GeometryError::DegenerateBin {
                inline: self.inline_vector.to_array(),
                crossline: self.crossline_vector.to_array(),
            });
        }
        self.validate_extent()
    }

    /// Checks how far the survey reaches.
    fn validate_extent(&self) -> Result<(), GeometryError> {
        let [inlines, crosslines, samples] = self.size();
        let voxels = [inlines, crosslines, samples].iter().try_fold(1u64, |n, &count| n.checked_mul(count as u64));
        if voxels.is_none_or(|voxels| voxels > MAX_VOXELS) {
            return Err(GeometryError::TooLarge { inlines, crosslines, samples });
        }
        for (axis, lines) in [("inline", self.inlines), ("crossline", self.crosslines)] {
            let last = i128::from(lines.first) + i128::from(lines.step) * (lines.count as i128 - 1);
            if i32::try_from(last).is_err() {
                let last = last.clamp(i64::MIN.into(), i64::MAX.into()) as i64;
                return Err(GeometryError::LineNumber { axis, last });
            }
        }
        let corner = |x: usize, y: usize| {
            let xy = self.inline_vector * x as f64 + self.crossline_vector * y as f64 + self.origin;
            if xy.is_nan() { f64::NAN } else { xy.abs().max_element() }
        };
        let corners = [corner(0, 0), corner(inlines, 0), corner(0, crosslines), corner(inlines, crosslines)];
        let depths = [self.vertical.first, self.vertical.last()].map(f64::abs);
        let reached = corners.map(|found| ("the map", found, MAX_COORDINATE)).into_iter();
        let reached = reached.chain(depths.map(|found| ("the vertical axis", found, MAX_COORDINATE)));
        for (what, found, limit) in reached.chain([("the velocity", self.velocity_m_s, MAX_VELOCITY_M_S)]) {
            if found.is_nan() || found > limit {
                return Err(GeometryError::Beyond { what, found, limit });
            }
        }
        Ok(())
    }

    /// Counts `[inlines, crosslines, samples]`.
    #[inline]
    pub fn size(&self) -> [usize; 3] {
        [self.inlines.count, self.crosslines.count, self.vertical.count]
    }

    /// World X, Y (m) and vertical value of a voxel position.
    #[inline]
    pub fn world_from_voxel(&self, voxel: DVec3) -> DVec3 {
        let xy = self.origin + self.inline_vector * voxel.x + self.crossline_vector * voxel.y;
        xy.extend(self.vertical.value_at(voxel.z))
    }

    /// Voxel position of world X, Y (m) and a vertical value.
    #[inline]
    pub fn voxel_from_world(&self, world: DVec3) -> DVec3 {
        let map = DMat2::from_cols(self.inline_vector, self.crossline_vector).inverse();
        (map * (world.truncate() - self.origin)).extend(self.vertical.index_of(world.z))
    }

    /// Voxel x, y of a pair of line numbers.
    #[inline]
    pub fn voxel_from_lines(&self, inline: f64, crossline: f64) -> DVec2 {
        DVec2::new(self.inlines.index_of(inline), self.crosslines.index_of(crossline))
    }

    /// Inline and crossline number (fractional) of voxel x, y.
    #[inline]
    pub fn lines_from_voxel(&self, voxel: DVec2) -> DVec2 {
        DVec2::new(self.inlines.number_at(voxel.x), self.crosslines.number_at(voxel.y))
    }

    /// Metres of depth in one unit of the vertical axis: velocity/2 per second of TWT, or 1.
    pub fn metres_per_vertical_unit(&self) -> f64 {
        match self.vertical.unit {
            VerticalUnit::Milliseconds => self.velocity_m_s / 2000.0,
            VerticalUnit::Metres => 1.0,
        }
    }

    /// Metres of depth between two samples.
    pub fn sample_m(&self) -> f64 {
        self.vertical.interval * self.metres_per_vertical_unit()
    }

    /// The linear part of the map from voxel to metric space (X and Y offset from the origin, depth), m per
    /// voxel.
    pub fn metric_from_voxel(&self) -> DMat3 {
        DMat3::from_cols(
            self.inline_vector.extend(0.0),
            self.crossline_vector.extend(0.0),
            DVec3::new(0.0, 0.0, self.sample_m()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_line_is_found_over_the_whole_range_of_numbers() {
        assert_eq!(LineAxis { first: i32::MAX, step: -5, count: 858_993_460 }.last(), i32::MIN);
        assert_eq!(LineAxis { first: i32::MIN, step: i32::MAX, count: 3 }.last(), i32::MAX - 1);
        assert_eq!(LineAxis { first: 100, step: -2, count: 6 }.last(), 90);
    }

    fn rotated() -> SurveyGeometry {
        let (sin, cos) = 0.5_f64.sin_cos();
        SurveyGeometry {
            inlines: LineAxis { first: 100, step: -2, count: 20 },
            crosslines: LineAxis { first: 300, step: 3, count: 30 },
            vertical: VerticalAxis { first: 876.0, interval: 4.0, count: 40, unit: VerticalUnit::Milliseconds },
            origin: DVec2::new(605_000.0, 6_073_000.0),
            inline_vector: DVec2::new(12.5 * cos, 12.5 * sin),
            crossline_vector: DVec2::new(25.0 * sin, -25.0 * cos),
            velocity_m_s: 2500.0,
        }
    }

    #[test]
    fn voxel_world_round_trip_on_a_rotated_mirrored_survey() {
        let g = rotated();
        g.validate().unwrap();
        assert!(g.inline_vector.perp_dot(g.crossline_vector) < 0.0);
        let voxel = DVec3::new(3.25, 17.5, 11.125);
        assert!((g.voxel_from_world(g.world_from_voxel(voxel)) - voxel).length() < 1e-9);
    }

    #[test]
    fn lines_count_down_and_step() {
        let g = rotated();
        assert_eq!(g.inlines.last(), 62);
        assert_eq!(g.voxel_from_lines(98.0, 306.0), DVec2::new(1.0, 2.0));
        assert_eq!(g.lines_from_voxel(DVec2::new(1.0, 2.0)), DVec2::new(98.0, 306.0));
    }

    #[test]
    fn twt_becomes_metres_through_half_the_velocity() {
        assert_eq!(rotated().sample_m(), 5.0);
    }

    #[test]
    fn what_reaches_beyond_any_survey_is_refused() {
        let refused = |change: fn(&mut SurveyGeometry)| {
            let mut geometry = rotated();
            change(&mut geometry);
            geometry.validate().unwrap_err()
        };
        assert!(matches!(refused(|g| g.vertical.interval = 1e300), GeometryError::Beyond { .. }));
        assert!(matches!(refused(|g| g.vertical.first = f64::NAN), GeometryError::Beyond { .. }));
        assert!(matches!(refused(|g| g.origin.x = f64::INFINITY), GeometryError::Beyond { .. }));
        assert!(matches!(refused(|g| g.origin.y = f64::NAN), GeometryError::Beyond { .. }));
        assert!(matches!(refused(|g| g.velocity_m_s = 1e300), GeometryError::Beyond { .. }));
        assert!(matches!(refused(|g| g.vertical.count = usize::MAX), GeometryError::TooLarge { .. }));
        assert!(matches!(refused(|g| g.inlines.step = i32::MAX), GeometryError::LineNumber { .. }));
        let size = [100_000; 3];
        let large = SurveyGeometry::regular(size, 1.0, 1.0, VerticalUnit::Metres);
        assert!(matches!(large.validate(), Err(GeometryError::TooLarge { .. })));
    }

    #[test]
    fn parallel_lines_are_refused() {
        let mut g = rotated();
        g.crossline_vector = g.inline_vector * 2.0;
        assert!(matches!(g.validate(), Err(GeometryError::DegenerateBin { .. })));
        g.crossline_vector = DVec2::new(f64::NAN, 0.0);
        assert!(g.validate().is_err());
    }
}
