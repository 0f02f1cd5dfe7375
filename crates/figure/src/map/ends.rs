//! Contours up to the faults that they end at.
//!
//! A cell that a fault passes through has no contour, so that one ends up to a cell short of the fault's line. Its end is
//! led on straight, the way that it came, to the line where the horizon ends; an end without such a line near it stays.

use super::{Contour, FaultCut};
use glam::DVec2;

/// How far an end is led on, traces: across a cell, and a little.
const REACH: f64 = 1.6;
/// Length of a contour that tells which way it came, traces: single cells jitter.
const WAY: f64 = 2.0;

/// Leads the ends of contours on to the lines of faults; covered lines lie below what is seen.
pub(super) fn lead_to_faults(contours: &mut [Contour], faults: &[FaultCut]) {
    let seen = faults.iter().filter(|cut| !cut.is_covered);
    let walls: Vec<[DVec2; 2]> = seen.flat_map(|cut| cut.line.windows(2).map(|pair| [pair[0], pair[1]])).collect();
    for contour in contours.iter_mut().filter(|contour| contour.line.first() != contour.line.last()) {
        let first = led_on(contour.line.iter().copied(), &walls);
        let last = led_on(contour.line.iter().rev().copied(), &walls);
        contour.line.splice(0..0, first);
        contour.line.extend(last);
    }
}

/// Where a line that begins with its end meets the nearest wall, led on from there.
fn led_on(mut line: impl Iterator<Item = DVec2>, walls: &[[DVec2; 2]]) -> Option<DVec2> {
    let end = line.next()?;
    let mut before = end;
    for place in line {
        before = place;
        if place.distance(end) >= WAY {
            break;
        }
    }
    let step = REACH * (end - before).try_normalize()?;
    let share = |[a, b]: &[DVec2; 2]| {
        let wall = *b - *a;
        let area = step.perp_dot(wall);
        let [along, within] = [(*a - end).perp_dot(wall) / area, (*a - end).perp_dot(step) / area];
        ((0.0..=1.0).contains(&along) && (0.0..=1.0).contains(&within)).then_some(along)
    };
    let nearest = walls.iter().filter_map(share).reduce(f64::min)?;
    Some(end + nearest * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contour(line: &[[f64; 2]]) -> Contour {
        let line = line.iter().copied().map(DVec2::from_array).collect();
        Contour { line, value: 100.0, is_index: false }
    }

    fn cut(line: &[[f64; 2]], is_covered: bool) -> FaultCut {
        let line = line.iter().copied().map(DVec2::from_array).collect();
        FaultCut { fault: 0, name: "Fault".into(), line, is_covered }
    }

    #[test]
    fn ends_reach_the_nearest_line_of_a_fault_that_is_seen() {
        // The two lines of a normal fault, and one that is covered in front of them.
        let faults = [
            cut(&[[6.0, -9.0], [6.0, 9.0]], false),
            cut(&[[6.5, -9.0], [6.5, 9.0]], false),
            cut(&[[5.6, -9.0], [5.6, 9.0]], true),
        ];
        let mut contours = [
            contour(&[[0.0, 1.0], [2.0, 1.5], [5.0, 2.25]]),
            contour(&[[7.0, 1.0], [9.0, 1.0]]),
            contour(&[[0.0, 0.0], [4.0, 0.0]]),
            contour(&[[5.0, 0.0], [5.0, 9.0]]),
        ];
        lead_to_faults(&mut contours, &faults);
        assert_eq!(contours[0].line.len(), 4);
        assert!(contours[0].line[3].distance(DVec2::new(6.0, 2.5)) < 1e-9, "{:?}", contours[0].line);
        assert!(contours[1].line.len() == 3 && contours[1].line[0].distance(DVec2::new(6.5, 1.0)) < 1e-9);
        // Two traces away, and along the fault.
        assert_eq!([contours[2].line.len(), contours[3].line.len()], [2, 2]);
    }

    #[test]
    fn contours_that_go_around_and_single_places_stay() {
        let faults = [cut(&[[1.5, -9.0], [1.5, 9.0]], false)];
        let ring = contour(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]]);
        let mut contours = [ring.clone(), contour(&[[1.0, 1.0], [1.0, 1.0]])];
        lead_to_faults(&mut contours, &faults);
        assert_eq!(contours[0], ring);
        assert_eq!(contours[1].line.len(), 2);
    }
}
