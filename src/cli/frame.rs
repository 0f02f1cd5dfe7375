//! The lattice of a survey without seismic, from what was typed for `petroglyph create`.

use super::args::CreateArgs;
use super::request::{Usage, counts, numbers};
use glam::DVec2;
use survey::{LineAxis, SurveyGeometry, VerticalUnit};

/// Samples along an axis for which nothing is stated.
const USUAL_COUNT: usize = 128;

/// The lattice that `--bounds`, `--size`, `--inlines`, `--crosslines` and `--z-unit` describe: its first and last
/// samples lie on the bounds.
pub(super) fn frame(typed: &CreateArgs) -> Result<Option<SurveyGeometry>, Usage> {
    let Some(bounds) = &typed.bounds else { return Ok(None) };
    let [x0, x1, y0, y1, z0, z1] = numbers::<6>("--bounds", bounds, ',')?;
    let stated = typed.size.as_ref().map(|size| counts::<3>("--size", size)).transpose()?;
    let mut size = stated.unwrap_or([USUAL_COUNT; 3]);
    let options = [("--inlines", &typed.inlines), ("--crosslines", &typed.crosslines)];
    let mut axes = [None, None];
    for (axis, (option, text)) in options.into_iter().enumerate() {
        let Some(text) = text else { continue };
        let lines = lines(option, text)?;
        if stated.is_some_and(|size| size[axis] != lines.count) {
            return Err(format!(
                "{option} {text} are {} lines, and --size states {}: leave one of them out",
                lines.count, size[axis]
            ));
        }
        size[axis] = lines.count;
        axes[axis] = Some(lines);
    }
    let unit = match typed.z_unit.as_deref() {
        None | Some("m") => VerticalUnit::Metres,
        Some("ms") => VerticalUnit::Milliseconds,
        Some(other) => return Err(format!("--z-unit {other}: expected m or ms")),
    };
    for (axis, low, high) in [("X", x0, x1), ("Y", y0, y1), ("Z", z0, z1)] {
        if low >= high {
            return Err(format!("--bounds {bounds}: {axis}0 = {low} must be less than {axis}1 = {high}"));
        }
    }
    if let Some(count) = size.iter().find(|&&count| count < 2) {
        return Err(format!("--size: each axis needs at least 2 samples, found {count}"));
    }
    let step = |low: f64, high: f64, count: usize| (high - low) / (count as f64 - 1.0);
    let mut geometry = SurveyGeometry::regular(size, 1.0, step(z0, z1, size[2]), unit);
    geometry.vertical.first = z0;
    geometry.origin = DVec2::new(x0, y0);
    geometry.inline_vector = DVec2::new(step(x0, x1, size[0]), 0.0);
    geometry.crossline_vector = DVec2::new(0.0, step(y0, y1, size[1]));
    let [inlines, crosslines] = axes;
    geometry.inlines = inlines.unwrap_or(geometry.inlines);
    geometry.crosslines = crosslines.unwrap_or(geometry.crosslines);
    geometry.validate().map_err(|error| format!("--bounds {bounds}: {error}"))?;
    Ok(Some(geometry))
}

/// Line numbers from the first to the last, by a step that is 1 unless it is stated.
fn lines(option: &str, text: &str) -> Result<LineAxis, Usage> {
    let wrong = || {
        format!(
            "{option} {text}: expected FIRST,LAST or FIRST,LAST,STEP, whole numbers where steps lead from the first to the last"
        )
    };
    let parsed: Vec<i64> = text
        .split(',')
        .map(|part| part.trim().parse::<i32>().map(i64::from))
        .collect::<Result<_, _>>()
        .map_err(|_| wrong())?;
    let (first, last, step) = match parsed[..] {
        [first, last] => (first, last, (last - first).signum()),
        [first, last, step] => (first, last, step),
        _ => return Err(wrong()),
    };
    if step == 0 || (last - first) % step != 0 || (last - first) / step < 1 {
        return Err(wrong());
    }
    let (first, step) = (first as i32, i32::try_from(step).map_err(|_| wrong())?);
    Ok(LineAxis { first, step, count: ((last - i64::from(first)) / i64::from(step)) as usize + 1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(bounds: &str, size: &str) -> CreateArgs {
        CreateArgs {
            project: "a.petro".into(),
            history: None,
            bounds: Some(bounds.into()),
            size: Some(size.into()),
            inlines: None,
            crosslines: None,
            z_unit: None,
        }
    }

    #[test]
    fn bounds_are_the_first_and_last_samples() {
        let geometry = frame(&typed("1000,5000,-200,200,-100,900", "5x3x11")).unwrap().unwrap();
        geometry.validate().unwrap();
        let last = geometry.world_from_voxel(glam::DVec3::new(4.0, 2.0, 10.0));
        assert_eq!(last, glam::DVec3::new(5000.0, 200.0, 900.0));
        assert_eq!(geometry.world_from_voxel(glam::DVec3::ZERO), glam::DVec3::new(1000.0, -200.0, -100.0));
    }

    #[test]
    fn wrong_bounds_and_sizes_are_usage_errors() {
        for (bounds, size) in [
            ("0,1,0,1,0", "4x4x4"),
            ("0,1,0,1,1,0", "4x4x4"),
            ("0,1,0,nan,0,1", "4x4x4"),
            ("0,1,0,1,0,1", "4x4"),
            ("0,1,0,1,0,1", "4x4x1"),
            ("0,1,0,1,0,1", "4x4x-4"),
        ] {
            assert!(frame(&typed(bounds, size)).is_err(), "{bounds} {size}");
        }
    }

    #[test]
    fn stated_lines_number_the_lattice() {
        let of = |inlines: &str, crosslines: &str, size: Option<&str>| {
            frame(&CreateArgs {
                size: size.map(str::to_owned),
                inlines: Some(inlines.into()),
                crosslines: Some(crosslines.into()),
                ..typed("0,100,0,300,0,50", "")
            })
        };
        let geometry = of("100,110", "240,210,-10", None).unwrap().unwrap();
        assert_eq!(geometry.inlines, LineAxis { first: 100, step: 1, count: 11 });
        assert_eq!(geometry.crosslines, LineAxis { first: 240, step: -10, count: 4 });
        assert_eq!((geometry.inline_vector.x, geometry.crossline_vector.y), (10.0, 100.0));
        assert!(of("100,110", "240,210,-10", Some("11x4x9")).is_ok());
        for (inlines, crosslines, size) in [
            ("100", "1,5", None),
            ("100,100", "1,5", None),
            ("100,110,3", "1,5", None),
            ("100,110,-1", "1,5", None),
            ("100,a", "1,5", None),
            ("-2147483648,2147483647,2147483648", "1,5", None),
            ("100,110", "1,5", Some("11x4x9")),
        ] {
            assert!(of(inlines, crosslines, size).is_err(), "{inlines} {crosslines}");
        }
    }
}
