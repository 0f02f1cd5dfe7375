//! Names of many thin layers, one below the other to the right of a block: in the order of the layers where they reach
//! the block's right edge, as near to them as they can stand, so that no two leaders cross.

use super::faces::led;
use super::room::{self, LabelRoom};
use crate::style::LEAST_TEXT_PT;
use glam::DVec2;
use page::list::{Across, Group, Ink, Text, Upright, width_of};
use ttf::Colour;

/// Between the block's edge and the names, points: the first distance at which most names are free.
const GAPS_PT: [f64; 3] = [16.0, 22.0, 30.0];
/// From one name to the next, as a share of their size.
const LINE: f64 = 1.25;
/// So many names more than stand beside their layers' ends are listed: they spread above and below.
const SPREAD: f64 = 16.0;
/// Radius of the dot at the end of a leader, points, and most as a share of the layer's thickness.
const DOT: (f64, f64) = (0.8, 0.3);

/// Room that names take to the right of a block of many layers whose right edge is so long, points; none where the
/// names of most layers have room along them.
pub(super) fn margin<'a>(names: impl ExactSizeIterator<Item = &'a str>, edge_pt: f64) -> f64 {
    let is_thin = edge_pt < LINE * LEAST_TEXT_PT * names.len() as f64;
    let longest = names.map(|name| width_of(name, LEAST_TEXT_PT)).fold(0.0, f64::max);
    if is_thin { GAPS_PT[0] + longest + 4.0 } else { 0.0 }
}

/// A layer where it reaches the right edge of the block.
#[derive(Debug, Clone)]
pub(super) struct LayerEnd {
    /// Its place on the page.
    pub at: DVec2,
    /// How thick it is there, points.
    pub thick: f64,
    /// Its name.
    pub name: String,
}

/// Places names beside their layers' ends; `edge` is where the block ends, x on the page. Where there are more layers
/// than lines the thickest of neighbours are named.
pub(super) fn placed(mut ends: Vec<LayerEnd>, edge: f64, room: &mut LabelRoom) -> Vec<Group> {
    ends.sort_by(|a, b| a.at.y.total_cmp(&b.at.y));
    let (Some(first), Some(last)) = (ends.first(), ends.last()) else { return Vec::new() };
    let line = LINE * LEAST_TEXT_PT;
    let [top, bottom] = room.heights();
    let lines = (((last.at.y - first.at.y) / line + SPREAD).min((bottom - top) / line - 1.0)).max(1.0) as usize;
    let named = thickest(&ends, lines);
    let wanted: Vec<f64> = named.iter().map(|end| end.at.y).collect();
    let heights = apart(&wanted, line, [top + 0.5 * line, bottom - 0.5 * line]);
    let text = |end: &LayerEnd, x: f64, y: f64| {
        let text = Text::new(DVec2::new(x, y), end.name.clone()).sized(LEAST_TEXT_PT);
        text.anchored(Across::Start, Upright::Middle).haloed(0.8, Ink::glass(Colour::WHITE, 0.9))
    };
    let free = |gap: f64, room: &LabelRoom| -> Vec<(&LayerEnd, Text)> {
        let texts = named.iter().zip(&heights).map(|(end, y)| (*end, text(end, edge + gap, *y)));
        texts.filter(|(_, text)| room::outlines(text).all(|outline| room.is_area_free(&outline))).collect()
    };
    let columns = GAPS_PT.map(|gap| free(gap, room));
    let Some(column) = columns.into_iter().reduce(|best, other| if other.len() > best.len() { other } else { best })
    else {
        return Vec::new();
    };
    let mut groups = Vec::new();
    for (end, text) in column {
        room.take(&text);
        let foot = text.at - DVec2::new(2.0, 0.0);
        room.take_area(&[end.at, foot]);
        groups.push(led([end.at, foot], DOT.0.min(DOT.1 * end.thick), &end.name, text));
    }
    groups
}

/// The thickest of each of so many runs of neighbours.
fn thickest(ends: &[LayerEnd], lines: usize) -> Vec<&LayerEnd> {
    let runs = lines.min(ends.len());
    let run = |n: usize| &ends[n * ends.len() / runs..(n + 1) * ends.len() / runs];
    let best = |n: usize| run(n).iter().max_by(|a, b| a.thick.total_cmp(&b.thick));
    (0..runs).filter_map(best).collect()
}

/// Places `least` apart or more, in their order and between two bounds, with the least squares of their distances to
/// where they are wanted. What is asked is y_n − n·least, which never falls: neighbours that do are pooled, and share
/// their mean (isotonic regression).
fn apart(wanted: &[f64], least: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (n, y) in wanted.iter().enumerate() {
        let mut pool = (y - n as f64 * least, 1usize);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| *mean > pool.0) {
            pools.pop();
            pool = ((mean * count as f64 + pool.0 * pool.1 as f64) / (count + pool.1) as f64, count + pool.1);
        }
        pools.push(pool);
    }
    let most = high - (wanted.len() as f64 - 1.0) * least;
    let means = pools.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    means.enumerate().map(|(n, mean)| mean.min(most).max(low) + n as f64 * least).collect()
}

#[cfg(test)]
#[path = "../../../tests/unit/column.rs"]
mod tests;
