//! Converts vertical values of a file to those of the survey (null value, factor, sign, unit) and checks that
//! the result is plausible.
//!
//! `survey value = sign · unit · (file value · z_factor)`. Nothing is guessed: unit and sign come from the
//! options, else from the file's own words, else they are assumed (survey's unit, positive down) and the
//! report says so. A result outside the survey's range is refused, with the option that would make it fit
//! when one would.

use super::number;
use super::options::ImportOptions;
use super::raw::{RawShape, VerticalFacts};
use super::report::{Provenance, Settled};
use super::unit::{Domain, FOOT_M, ZPositive, ZUnit};
use super::{FormatError, SurfaceKind};
use std::path::Path;
use survey::geometry::{VerticalAxis, VerticalUnit};
use survey::remedy::{Note, Remedy, Setting};

/// How values are converted.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VerticalRule {
    pub unit: Settled<ZUnit>,
    pub positive: Settled<ZPositive>,
    pub factor: f64,
    /// All of it combined: survey value = file value · scale.
    scale: f64,
    null: Option<f64>,
}

/// One value in so many must lie in the survey.
const LEAST_PARTS: usize = 10;

/// What was found during conversion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct VerticalCounts {
    pub values: usize,
    pub nulls: usize,
    pub range_in_file: [f64; 2],
    pub range: [f64; 2],
}

impl VerticalRule {
    /// Determines unit and sign.
    ///
    /// # Errors
    /// [`FormatError::UnitMismatch`] when one is a time and the other a depth.
    pub(crate) fn settle(
        file: &Path,
        facts: &VerticalFacts,
        options: &ImportOptions,
        survey: VerticalUnit,
    ) -> Result<Self, FormatError> {
        let own = match survey {
            VerticalUnit::Milliseconds => ZUnit::Milliseconds,
            VerticalUnit::Metres => ZUnit::Metres,
        };
        let mismatch = |found, evidence| FormatError::UnitMismatch {
            file: file.to_path_buf(),
            found,
            evidence,
            survey: survey.symbol(),
        };
        let unit = Settled::of(options.z_unit, facts.unit.clone(), own);
        if Domain::of_unit(unit.value) != Domain::of(survey) {
            let evidence = match &unit.source {
                Provenance::File(words) => format!("says {words}"),
                _ => "as told".into(),
            };
            return Err(mismatch(unit.value.symbol(), evidence));
        }
        if let (Provenance::Assumed, Some((domain, words))) = (&unit.source, &facts.domain)
            && *domain != Domain::of(survey)
        {
            let found = if *domain == Domain::Time { "a time" } else { "a depth" };
            return Err(mismatch(found, format!("says {words}")));
        }
        let positive = Settled::of(options.z_positive, facts.positive.clone(), ZPositive::Down);
        let sign = if positive.value == ZPositive::Up { -1.0 } else { 1.0 };
        let scale = options.z_factor * sign * unit.value.in_survey();
        Ok(Self { unit, positive, factor: options.z_factor, scale, null: options.null })
    }

    /// What was assumed, each with the option that states it.
    pub(crate) fn assumptions(&self) -> Vec<Note> {
        let mut found = Vec::new();
        if self.unit.source == Provenance::Assumed {
            let unit = self.unit.value;
            let others = if unit.is_time() { "s" } else { "ft, usft or km" };
            let fact = format!("the vertical unit is {}, the survey's: the file states none", unit.symbol());
            found.push(Note::unless(fact, Setting::ZUnit.stated_as(others)));
        }
        if self.positive.source == Provenance::Assumed {
            let fact = "vertical values grow downwards: the file does not say";
            found.push(Note::unless(fact, Setting::ZPositive.stated_as("up")));
        }
        found
    }

    /// Converts in place; nulls become NaN.
    pub(crate) fn apply(&self, shape: &mut RawShape) -> VerticalCounts {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let mut counts = VerticalCounts { values: 0, nulls: 0, range_in_file: none, range: none };
        let widen = |range: &mut [f64; 2], v: f64| *range = [range[0].min(v), range[1].max(v)];
        for value in shape.values_mut() {
            counts.values += 1;
            let is_null = number::is_null(*value, self.null);
            let converted = *value * self.scale;
            if is_null || !converted.is_finite() || converted.abs() > 1e12 {
                *value = f64::NAN;
                counts.nulls += 1;
                continue;
            }
            widen(&mut counts.range_in_file, *value);
            widen(&mut counts.range, converted);
            *value = converted;
        }
        // A normal is a covector: where depths grow, it shrinks.
        if let RawShape::Points(points) = shape {
            points.iter_mut().filter_map(|p| p.normal.as_mut()).for_each(|normal| normal.z /= self.scale);
        }
        counts
    }

    /// Refuses values that cannot belong to the survey; returns how many lie outside its range.
    ///
    /// # Errors
    /// [`FormatError::LooksLikeNull`], [`FormatError::OutsideRange`].
    pub(crate) fn check(
        &self,
        file: &Path,
        name: &str,
        values: &[f64],
        axis: &VerticalAxis,
        kind: SurfaceKind,
    ) -> Result<usize, FormatError> {
        let values: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let survey = [axis.first, axis.last()];
        // A horizon may run along the first or last sample.
        let slack = axis.interval;
        let inside = |v: f64| v >= survey[0] - slack && v <= survey[1] + slack;
        let outside = values.iter().filter(|&&v| !inside(v)).count();
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let found = values.iter().fold(none, |r, &v| [r[0].min(v), r[1].max(v)]);
        for extreme in found {
            let count = values.iter().filter(|&&v| v == extreme).count();
            let spike = kind == SurfaceKind::Horizon && !inside(extreme);
            if spike && count >= 5 && count < values.len() && count * 200 > values.len() {
                let value = round_to_file(extreme / self.scale);
                return Err(FormatError::LooksLikeNull { file: file.to_path_buf(), name: name.into(), value, count });
            }
        }
        let fit = |factor: f64| values.iter().filter(|&&v| inside(v * factor)).count();
        // A time in seconds that is read as milliseconds falls into the first sample of a survey that starts at 0.
        let largest = found[0].abs().max(found[1].abs());
        let flat = axis.unit == VerticalUnit::Milliseconds
            && self.unit.source != Provenance::Option
            && largest < 0.01 * survey[1]
            && largest * 1000.0 > 2.0 * slack
            && fit(1000.0) * 2 > values.len();
        // Faults often extend far below a survey; it suffices that they extend into it.
        let misses = match kind {
            SurfaceKind::Horizon => outside * 2 > values.len(),
            SurfaceKind::Fault => found[1] < survey[0] || found[0] > survey[1],
        };
        if !misses && !flat {
            return Ok(outside);
        }
        let likely = [1000.0, -1.0, -1000.0, FOOT_M, -FOOT_M, 1.0 / FOOT_M, -1.0 / FOOT_M, 0.001, -0.001, 2.0, 0.5];
        // A surface that was drawn beyond the survey lies in it for the greater part when its sign is changed.
        // Where nearly as much of it lies there as it is, that is no reason.
        let turned_up = fit(-1.0) * 2 > values.len() && fit(-1.0) > 2 * fit(1.0);
        let is_enough = |factor: f64| fit(factor) * 10 > values.len() * 9 || (turned_up && factor == -1.0);
        let best = likely
            .iter()
            .copied()
            .filter(|&f| is_enough(f) && largest * f.abs() > 2.0 * slack && (!flat || f.abs() > 1.0))
            .min_by(|a, b| rank(*a).total_cmp(&rank(*b)));
        // A bed may leave the block: then a part of it lies there, and nothing makes it fit better, or its unit and sign
        // are stated.
        let is_stated =
            [&self.unit.source, &self.positive.source].into_iter().all(|source| *source == Provenance::Option);
        if !flat && (best.is_none() || is_stated) && fit(1.0) * LEAST_PARTS >= values.len() {
            return Ok(outside);
        }
        let (hint, remedy) = match best {
            Some(factor) => (format!("It would fit when multiplied by {factor:.5}"), self.remedy(factor)),
            None => (
                "No change of sign or of a common unit makes it fit: check these, and whether the file belongs to this survey"
                    .to_owned(),
                Remedy::any([Setting::ZUnit, Setting::ZPositive, Setting::ZFactor].map(Setting::stated)),
            ),
        };
        Err(FormatError::OutsideRange {
            file: file.to_path_buf(),
            name: name.into(),
            found: Box::new(found),
            survey: Box::new(survey),
            unit: axis.unit.symbol(),
            outside,
            total: values.len(),
            hint: Box::new(Note::unless(hint, remedy)),
        })
    }

    /// The statement that multiplies the result by a further `factor`.
    fn remedy(&self, factor: f64) -> Remedy {
        let mut parts = Vec::new();
        let size = factor.abs();
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        let unit = match self.unit.value {
            ZUnit::Milliseconds if near(size, 1000.0) => Some(ZUnit::Seconds),
            ZUnit::Seconds if near(size, 0.001) => Some(ZUnit::Milliseconds),
            ZUnit::Metres if near(size, FOOT_M) => Some(ZUnit::Feet),
            ZUnit::Feet if near(size, 1.0 / FOOT_M) => Some(ZUnit::Metres),
            _ => None,
        };
        match unit {
            Some(unit) => parts.push(Setting::ZUnit.stated_as(unit.symbol())),
            None if !near(size, 1.0) => parts.push(Setting::ZFactor.stated_as(self.factor * size)),
            None => {}
        }
        if factor < 0.0 {
            let turned = if self.positive.value == ZPositive::Down { ZPositive::Up } else { ZPositive::Down };
            parts.push(Setting::ZPositive.stated_as(turned.word()));
        }
        Remedy::all(parts)
    }
}

/// Sign alone first, then units, then odd factors.
fn rank(factor: f64) -> f64 {
    match factor.abs() {
        1.0 => 0.0,
        s if s == 1000.0 || s == FOOT_M => 1.0,
        s if s == 0.001 || s == 1.0 / FOOT_M => 2.0,
        _ => 3.0,
    }
}

/// Rounds off the last digits of a division, so that a null reads as it does in the file.
fn round_to_file(value: f64) -> f64 {
    let rounded = (value * 1e4).round() / 1e4;
    if (rounded - value).abs() <= 1e-9 * value.abs() { rounded } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::RawPoint;

    fn points(values: &[f64]) -> RawShape {
        RawShape::Points(values.iter().map(|&z| RawPoint { z, ..RawPoint::default() }).collect())
    }

    fn axis(first: f64, count: usize, unit: VerticalUnit) -> VerticalAxis {
        VerticalAxis { first, interval: 4.0, count, unit }
    }

    fn read(values: &[f64], options: &ImportOptions, axis: &VerticalAxis) -> Result<Vec<f64>, FormatError> {
        let rule = VerticalRule::settle(Path::new("f"), &VerticalFacts::default(), options, axis.unit)?;
        let mut shape = points(values);
        rule.apply(&mut shape);
        let values: Vec<f64> = shape.values().collect();
        rule.check(Path::new("f"), "A", &values, axis, SurfaceKind::Horizon)?;
        Ok(values)
    }

    fn hint(values: &[f64], options: &ImportOptions, axis: &VerticalAxis) -> String {
        match read(values, options, axis) {
            Err(FormatError::OutsideRange { hint, .. }) => hint.to_string(),
            other => panic!("expected OutsideRange, found {other:?}"),
        }
    }

    #[test]
    fn factor_then_sign_then_unit() {
        let depth = axis(0.0, 500, VerticalUnit::Metres);
        let options = ImportOptions {
            z_unit: Some(ZUnit::Feet),
            z_positive: Some(ZPositive::Up),
            z_factor: 0.5,
            null: Some(-999.25),
            ..ImportOptions::default()
        };
        let read = read(&[-1000.0, -999.25, -2000.0], &options, &depth).unwrap();
        assert!((read[0] - 152.4).abs() < 1e-9 && read[1].is_nan() && (read[2] - 304.8).abs() < 1e-9);
    }

    #[test]
    fn a_wrong_unit_or_sign_names_the_setting_that_fits() {
        let time = axis(800.0, 100, VerticalUnit::Milliseconds);
        let plain = ImportOptions::default();
        assert!(hint(&[0.9, 1.0, 1.1], &plain, &time).contains("vertical unit s"));
        assert!(hint(&[-900.0, -1000.0], &plain, &time).contains("sign of depths up"));
        let both = hint(&[-0.9, -1.0], &plain, &time);
        assert!(both.contains("vertical unit s") && both.contains("sign of depths up"), "{both}");
        let depth = axis(1000.0, 100, VerticalUnit::Metres);
        assert!(hint(&[3600.0, 3700.0], &plain, &depth).contains("vertical unit ft"));
        assert!(hint(&[77.0, 78.0], &plain, &depth).contains("No change"));
        let up = ImportOptions { z_positive: Some(ZPositive::Up), ..ImportOptions::default() };
        assert!(hint(&[1100.0, 1200.0], &up, &depth).contains("sign of depths down"));
    }

    #[test]
    fn a_surface_drawn_beyond_the_survey_has_its_sign_changed_and_is_not_shrunk_into_the_first_sample() {
        let depth = axis(0.0, 200, VerticalUnit::Metres);
        let heights: Vec<f64> = (0..=140).map(|n| 300.0 - 10.0 * f64::from(n)).collect();
        assert!(hint(&heights, &ImportOptions::default(), &depth).contains("sign of depths up"));
    }

    #[test]
    fn a_bed_that_leaves_the_block_is_taken_and_not_told_to_change_its_sign() {
        let depth = axis(0.0, 250, VerticalUnit::Metres);
        let bed =
            |low: f64, high: f64| (0..=100).map(|n| low + (high - low) * f64::from(n) / 100.0).collect::<Vec<f64>>();
        let plain = ImportOptions::default();
        // Above it, below it, on both sides; 45, 30 and 12 % lie in it.
        for values in [bed(-900.0, 740.0), bed(-500.0, 2800.0), bed(-3800.0, 4500.0)] {
            read(&values, &plain, &depth).unwrap();
        }
        // Where it may be in feet, that is said, and a unit and a sign that are stated are believed.
        let deep = bed(550.0, 1550.0);
        assert!(hint(&deep, &plain, &depth).contains("vertical unit ft"));
        let stated = ImportOptions {
            z_unit: Some(ZUnit::Metres),
            z_positive: Some(ZPositive::Down),
            ..ImportOptions::default()
        };
        read(&deep, &stated, &depth).unwrap();
        // None of it there is a mistake all the same.
        hint(&bed(20_000.0, 30_000.0), &stated, &depth);
    }

    #[test]
    fn seconds_do_not_hide_in_the_first_sample() {
        let time = axis(0.0, 500, VerticalUnit::Milliseconds);
        assert!(hint(&[0.9, 1.0, 1.1], &ImportOptions::default(), &time).contains("vertical unit s"));
        let told = ImportOptions { z_unit: Some(ZUnit::Milliseconds), ..ImportOptions::default() };
        assert!(read(&[0.9, 1.0, 1.1], &told, &time).is_ok());
    }

    #[test]
    fn a_repeated_value_outside_is_taken_for_a_null_and_named() {
        let time = axis(0.0, 500, VerticalUnit::Milliseconds);
        let mut values = vec![-999.25; 20];
        values.extend((0..80).map(|n| 900.0 + f64::from(n)));
        match read(&values, &ImportOptions::default(), &time) {
            Err(FormatError::LooksLikeNull { value, count, .. }) => assert_eq!((value, count), (-999.25, 20)),
            other => panic!("{other:?}"),
        }
        let told = ImportOptions { null: Some(-999.25), ..ImportOptions::default() };
        assert!(read(&values, &told, &time).is_ok());
    }

    #[test]
    fn time_is_not_converted_to_depth() {
        let depth = axis(0.0, 500, VerticalUnit::Metres);
        let options = ImportOptions { z_unit: Some(ZUnit::Milliseconds), ..ImportOptions::default() };
        assert!(matches!(read(&[100.0], &options, &depth), Err(FormatError::UnitMismatch { .. })));
    }
}
