//! Names of many thin layers, one below the other to the right of a block: in the order of the layers where they reach
//! the block's right edge, as near to them as they can stand, so that no two leaders cross.

use super::faces::led;
use super::room::{self, LabelRoom};
use crate::style::LEAST_TEXT_PT;
use glam::DVec2;
use page::list::{Across, Group, Ink, Text, Upright, width_of};
use ttf::Colour;

/// Between the block's edge and the names, points, where all stand beside their layers, and most.
const GAP_PT: [f64; 2] = [16.0, 34.0];
/// How much of the way that the outermost names are moved up and down is added: no leader is steep.
const SLOPE: f64 = 0.4;
/// What may be added to find room: the first distance at which most names are free.
const WIDER_PT: [f64; 3] = [0.0, 6.0, 14.0];
/// From one name to the next, as a share of their size.
const LINE: f64 = 1.25;
/// So many names more than stand beside their layers' ends are listed: they spread above and below.
const SPREAD: f64 = 16.0;
/// Radius of the dot at the end of a leader, points, and most as a share of the layer's thickness.
const DOT: (f64, f64) = (0.8, 0.3);

/// Room that names take to the right of a block of many layers whose right edge is so long, points; none where the
/// names of most layers have room along them.
pub(super) fn margin<'a>(names: impl ExactSizeIterator<Item = &'a str>, edge_pt: f64) -> f64 {
    let count = names.len();
    let is_thin = edge_pt < LINE * LEAST_TEXT_PT * names.len() as f64;
    let longest = names.map(|name| width_of(name, LEAST_TEXT_PT)).fold(0.0, f64::max);
    if is_thin { gap(count, edge_pt) + longest + 4.0 } else { 0.0 }
}

/// Between an edge and so many names beside it, points.
fn gap(count: usize, edge_pt: f64) -> f64 {
    let moved = 0.5 * (LINE * LEAST_TEXT_PT * count as f64 - edge_pt);
    (SLOPE * moved).clamp(GAP_PT[0], GAP_PT[1])
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
    // Names go no lower than the lowest layer where their leaders would cross the numbers of an axis.
    let lowest = [bottom - 0.5 * line, (last.at.y + 0.5 * line).min(bottom - 0.5 * line)];
    let text = |end: &LayerEnd, x: f64, y: f64| {
        let text = Text::new(DVec2::new(x, y), end.name.clone()).sized(LEAST_TEXT_PT);
        text.anchored(Across::Start, Upright::Middle).haloed(0.8, Ink::glass(Colour::WHITE, 0.9))
    };
    let free = |wider: f64, lowest: f64, room: &LabelRoom| -> Vec<(&LayerEnd, Text)> {
        let heights = apart(&wanted, line, [top + 0.5 * line, lowest]);
        let x = edge + gap(named.len(), last.at.y - first.at.y) + wider;
        let texts = named.iter().zip(heights).map(|(end, y)| (*end, text(end, x, y)));
        let is_free = |(end, text): &(&LayerEnd, Text)| {
            room.is_clear(end.at, foot(text)) && room::outlines(text).all(|outline| room.is_area_free(&outline))
        };
        texts.filter(is_free).collect()
    };
    let columns = lowest.into_iter().flat_map(|lowest| WIDER_PT.map(|wider| free(wider, lowest, room)));
    let Some(column) = columns.reduce(|best, other| if other.len() > best.len() { other } else { best }) else {
        return Vec::new();
    };
    let mut groups = Vec::new();
    for (end, text) in column {
        room.take(&text);
        let foot = foot(&text);
        room.take_area(&[end.at, foot]);
        groups.push(led([end.at, foot], DOT.0.min(DOT.1 * end.thick), &end.name, text));
    }
    groups
}

/// Where the leader of a name ends.
fn foot(text: &Text) -> DVec2 {
    text.at - DVec2::new(2.0, 0.0)
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
mod tests;
