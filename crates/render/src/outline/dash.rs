//! Dashes along a line: what was filled or extrapolated is not drawn as if it had been picked.

use glam::DVec2;

/// The lengths of a dash and of the gap after it, pixels of an image whose smaller side has 1000 pixels.
pub(super) const APPROXIMATE: [f64; 2] = [12.0, 6.0];
/// The same of what is inferred.
pub(super) const INFERRED: [f64; 2] = [5.0, 5.5];

/// The dashes along a line that begins with a dash; `on` and `off` in the unit of its places.
pub(super) fn dashed(points: &[DVec2], [on, off]: [f64; 2]) -> Vec<Vec<DVec2>> {
    let mut dashes: Vec<Vec<DVec2>> = Vec::new();
    let (mut is_on, mut left) = (true, on);
    dashes.extend(points.first().map(|first| vec![*first]));
    for ends in points.windows(2) {
        let (mut from, to) = (ends[0], ends[1]);
        let mut length = from.distance(to);
        while length > left {
            from = from.lerp(to, left / length);
            length -= left;
            match (is_on, dashes.last_mut()) {
                (true, Some(dash)) => dash.push(from),
                _ => dashes.push(vec![from]),
            }
            is_on = !is_on;
            left = if is_on { on } else { off };
        }
        left -= length;
        if let (true, Some(dash)) = (is_on, dashes.last_mut()) {
            dash.push(to);
        }
    }
    dashes.retain(|dash| dash.len() > 1);
    dashes
}

#[cfg(test)]
mod tests;
