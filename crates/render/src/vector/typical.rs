//! What holds in most of an area, and not in a few odd places of it: beside a spike of a horizon beds turn, so that another
//! mapping may lead there, and stretches tiles without bound.

use glam::DMat2;
use std::collections::BTreeMap;

/// The mapping that leads in the most cells; none where none leads in any.
pub(super) fn most_frequent(leading: &[Option<usize>]) -> Option<usize> {
    let mut counts = BTreeMap::new();
    leading.iter().flatten().for_each(|n| *counts.entry(*n).or_insert(0usize) += 1);
    counts.into_iter().max_by_key(|(_, count)| *count).map(|(n, _)| n)
}

/// Of the maps of many places the one whose sizes are most like the medians of all: its determinant, and the lengths of
/// its columns. A map that shears, as beside a spike of a horizon, may have the median of one of them alone. No map gives
/// zeros.
pub(super) fn typical(maps: &[DMat2]) -> DMat2 {
    let sizes = |map: &DMat2| {
        [map.determinant().abs(), map.x_axis.length(), map.y_axis.length()].map(|size| size.max(f64::MIN_POSITIVE).ln())
    };
    let medians = [0, 1, 2].map(|n: usize| {
        let mut all: Vec<f64> = maps.iter().map(|map| sizes(map)[n]).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    });
    let off = |map: &DMat2| sizes(map).iter().zip(medians).map(|(size, median)| (size - median).abs()).sum::<f64>();
    maps.iter().min_by(|a, b| off(a).total_cmp(&off(b))).copied().unwrap_or(DMat2::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mapping_that_leads_in_one_place_does_not_count() {
        let mut leading = vec![None, Some(0), Some(0), None, Some(0)];
        assert_eq!(most_frequent(&leading), Some(0));
        leading.insert(1, Some(2));
        assert_eq!(most_frequent(&leading), Some(0));
        assert_eq!(most_frequent(&[None; 3]), None);
    }

    #[test]
    fn a_map_that_shears_is_not_taken_for_typical() {
        // By determinant alone the sheared ones are in the middle.
        let plain = |scale: f64| DMat2::from_cols_array(&[10.0 * scale, 0.0, 0.0, 5.0]);
        let sheared = DMat2::from_cols_array(&[10.0, 400.0, 0.0, 5.0]);
        let maps = [plain(0.8), plain(0.9), sheared, sheared, sheared, plain(1.1), plain(1.2), plain(1.3)];
        let found = typical(&maps);
        assert!((8.0..=13.0).contains(&found.x_axis.length()), "{found}");
        assert_eq!(typical(&[]), DMat2::ZERO);
    }
}
