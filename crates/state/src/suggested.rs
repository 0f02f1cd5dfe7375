//! The fault stick that is suggested on a section from those on its neighbours: between two of them, or beyond the last.

use glam::DVec3;

/// How far from a section its own sticks lie at most, lines.
const OWN: f64 = 2.5;
/// How far away the nearest stick may be, lines.
const REACH: f64 = 60.0;
/// Points of a suggested stick at most.
const MOST_POINTS: usize = 9;

/// A suggested stick.
#[derive(Debug, Clone, PartialEq)]
pub struct Stick {
    /// The axis across its section: 0 for an inline, 1 for a crossline, 2 for a slice.
    pub axis: usize,
    /// Its points, voxels.
    pub points: Vec<DVec3>,
}

/// A stick that lies on one section.
struct Known<'a> {
    points: &'a [DVec3],
    at: f64,
}

/// The stick that `known` ones (voxels) suggest on the section across whose axis the last of them was drawn. Between two
/// neighbours it lies between them, by the distance to each; beyond the last it goes on as the last two do, no farther than
/// they are apart; of one alone it is a copy.
///
/// ```
/// use glam::DVec3;
///
/// let stick = |x: f64, y: f64| vec![DVec3::new(x, y, 0.0), DVec3::new(x, y + 10.0, 40.0)];
/// let suggested = state::suggested::stick(&[stick(10.0, 5.0), stick(20.0, 7.0)], [15.0, 0.0, 0.0], [64, 64, 64]).unwrap();
/// assert_eq!((suggested.axis, suggested.points), (0, stick(15.0, 6.0)));
/// ```
pub fn stick(known: &[Vec<DVec3>], slices: [f64; 3], size: [usize; 3]) -> Option<Stick> {
    let last = known.iter().rev().find(|stick| stick.len() > 1)?;
    let axis = axis_of(last);
    let at = slices[axis];
    let mut on_axis: Vec<Known> = known
        .iter()
        .filter(|stick| stick.len() > 1 && axis_of(stick) == axis)
        .map(|points| Known { points, at: points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64 })
        .collect();
    on_axis.sort_by(|a, b| a.at.total_cmp(&b.at));
    let nearest = on_axis.iter().map(|stick| (stick.at - at).abs()).min_by(f64::total_cmp)?;
    if nearest <= OWN || nearest > REACH {
        return None;
    }
    let beyond = on_axis.partition_point(|stick| stick.at < at);
    let pair = match (beyond.checked_sub(1), on_axis.len()) {
        (_, 1) => [0, 0],
        (None, _) => [0, 1],
        (Some(before), count) if before + 1 == count => [before, before - 1],
        (Some(before), _) => [before, before + 1],
    };
    let [near, far] = pair.map(|n| &on_axis[n]);
    let step = far.at - near.at;
    // Beyond the last one: negative, and no more than one step.
    let share = if step.abs() > OWN { ((at - near.at) / step).clamp(-1.0, 1.0) } else { 0.0 };
    let count = near.points.len().max(far.points.len()).min(MOST_POINTS);
    let is_turned = (ends(near.points)).dot(ends(far.points)) < 0.0;
    let most = DVec3::from_array(size.map(|count| count.saturating_sub(1) as f64));
    let points = (0..count).map(|n| {
        let t = n as f64 / (count - 1) as f64;
        let there = along(far.points, if is_turned { 1.0 - t } else { t });
        let mut point = along(near.points, t).lerp(there, share);
        point[axis] = at;
        point.clamp(DVec3::ZERO, most)
    });
    Some(Stick { axis, points: points.collect() })
}

/// The axis along which the points of a stick differ least.
fn axis_of(stick: &[DVec3]) -> usize {
    let low = stick.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = stick.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let spread = (high - low).to_array();
    (0..3).min_by(|&a, &b| spread[a].total_cmp(&spread[b])).unwrap_or(0)
}

fn ends(stick: &[DVec3]) -> DVec3 {
    stick[stick.len() - 1] - stick[0]
}

/// The point of a line at a share of its length.
fn along(line: &[DVec3], share: f64) -> DVec3 {
    let length: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let mut left = share * length;
    for pair in line.windows(2) {
        let piece = pair[0].distance(pair[1]);
        if left <= piece && piece > 0.0 {
            return pair[0].lerp(pair[1], left / piece);
        }
        left -= piece;
    }
    line[line.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 3] = [100, 100, 100];

    fn line(x: f64, top: f64) -> Vec<DVec3> {
        vec![DVec3::new(x, top, 10.0), DVec3::new(x, top + 5.0, 30.0), DVec3::new(x, top + 10.0, 50.0)]
    }

    #[test]
    fn a_stick_is_suggested_between_beyond_and_beside_others() {
        let at = |known: &[Vec<DVec3>], x: f64| stick(known, [x, 0.0, 0.0], SIZE);
        let two = [line(20.0, 40.0), line(30.0, 44.0)];
        assert_eq!(at(&two, 25.0).unwrap().points, line(25.0, 42.0));
        // Beyond the last they go on, no farther than they are apart.
        assert_eq!(at(&two, 35.0).unwrap().points, line(35.0, 46.0));
        assert_eq!(at(&two, 55.0).unwrap().points, line(55.0, 48.0));
        assert_eq!(at(&two, 10.0).unwrap().points, line(10.0, 36.0));
        // One alone is copied; it may have been drawn upwards.
        assert_eq!(at(&two[..1], 26.0).unwrap().points, line(26.0, 40.0));
        let upwards = [two[0].clone(), two[1].iter().rev().copied().collect()];
        assert_eq!(at(&upwards, 25.0).unwrap().points, line(25.0, 42.0));
    }

    #[test]
    fn nothing_is_suggested_on_a_stick_far_away_or_without_any() {
        let at = |x: f64| stick(&[line(20.0, 40.0)], [x, 0.0, 0.0], SIZE);
        assert!(at(21.0).is_none() && at(90.0).is_none() && at(40.0).is_some());
        assert!(stick(&[], [0.0; 3], SIZE).is_none());
        assert!(stick(&[vec![DVec3::ONE]], [9.0; 3], SIZE).is_none());
        // On crosslines, and within the survey.
        let low = [DVec3::new(95.0, 20.0, 10.0), DVec3::new(99.0, 20.0, 50.0)].to_vec();
        let more = [DVec3::new(91.0, 10.0, 10.0), DVec3::new(95.0, 10.0, 50.0)].to_vec();
        let suggested = stick(&[more, low], [50.0, 30.0, 0.0], SIZE).unwrap();
        assert_eq!(suggested.axis, 1);
        assert!(suggested.points.iter().all(|p| p.y == 30.0 && p.x <= 99.0), "{suggested:?}");
    }
}
