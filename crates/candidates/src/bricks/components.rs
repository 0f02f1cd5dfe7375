//! Stages from cuts to labels: `windows`, `components`, `labels` ([`crate::grow::cells`]).
//!
//! A brick knows which of its extrema are windows, joins them among themselves, and names each part by its least window.
//! Where a link leads out of the brick to a window, that window is joined too, and named in the summary; its own brick
//! names it as well. So two parts that belong together name one window in common, and the merged parts are those of the
//! whole survey. The count of their windows, and then their least one, rank them.

use super::Bricks;
use super::patch::{Patch, Values};
use super::tiles::Halo;
use crate::error::InterpError;
use crate::grow::UnionFind;
use crate::grow::cells;
use crate::grow::links::{NEXT_X, NEXT_Y, NONE};
use std::cmp::Reverse;

/// A part of a surface after all bricks were merged: its name in its brick, its rank among all, and its label.
type Ranked = [u32; 3];

/// The greatest of some widths.
fn widest(widths: &[(&str, usize)]) -> usize {
    widths.iter().map(|(_, width)| *width).max().unwrap_or(0)
}

impl Bricks<'_> {
    /// The widths for which windows are searched, and the names of their arrays: surfaces, and their cores if those are
    /// wider.
    fn widths(&self) -> Vec<(&'static str, usize)> {
        let grow = &self.settings.grow;
        let mut widths = vec![("narrow", grow.min_front_width)];
        if self.has_cores() {
            widths.push(("core", grow.core_width));
        }
        widths
    }

    /// Whether surfaces are first connected over wider necks.
    pub(crate) fn has_cores(&self) -> bool {
        self.settings.grow.core_width > self.settings.grow.min_front_width
    }

    /// The parts of surfaces in a brick: for each extremum that is a window the least window of its part; the count of
    /// windows of each part; and windows at faces with the part that they are linked to.
    pub(crate) fn windows(&self, brick: usize) -> Result<(), InterpError> {
        let widths = self.widths();
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::behind(widest(&widths) + 2), Values::None)?;
            let links = self.links_on(&patch)?;
            let open = cells::open_cells(&links, &self.broken(&patch)?);
            let (own, indices) = (patch.is_own(), patch.indices());
            for &(name, width) in &widths {
                let windows = cells::windows(&patch.extrema, &links, &open, width - 1);
                let mut sets = UnionFind::new(patch.extrema.len());
                for v in (0..patch.extrema.len() as u32).filter(|&v| own[v as usize] && windows[v as usize]) {
                    for direction in [NEXT_X, NEXT_Y] {
                        let next = links.to[direction][v as usize];
                        if next != NONE && windows[next as usize] {
                            sets.union(v, next);
                        }
                    }
                }
                let mut parts = vec![NONE; indices.len()];
                let mut counts = vec![0u32; indices.len()];
                let mut faces: Vec<[u32; 2]> = Vec::new();
                // Links lead to greater indices, so the least window of a part is the brick's own.
                for ([x, y], places, first) in patch.traces() {
                    let is_own = patch.own.contains(x, y);
                    let is_face = is_own && (x == patch.own.x.start || y == patch.own.y.start);
                    for (v, index) in places.zip(first..).filter(|(v, _)| windows[*v]) {
                        let root = sets.find(v as u32) as usize;
                        if is_own {
                            parts[v] = indices[root];
                            counts[root] += 1;
                        }
                        if is_face || (!is_own && root != v) {
                            faces.push([index, indices[root]]);
                        }
                    }
                }
                let found: Vec<[u32; 2]> = indices
                    .iter()
                    .zip(&counts)
                    .filter(|(_, count)| **count > 0)
                    .map(|(&i, &count)| [i, count])
                    .collect();
                self.keep(&format!("{name}-part"), &patch, &parts)?;
                self.write(&self.name(&format!("{name}-counts"), kind), brick, &found)?;
                self.write(&self.name(&format!("{name}-faces"), kind), brick, &faces)?;
            }
        }
        Ok(())
    }

    /// Merges the parts of all bricks and ranks them.
    pub(crate) fn components(&self) -> Result<(), InterpError> {
        self.each_kind(|kind| {
            for (name, _) in self.widths() {
                let (mut parts, mut faces) = (Vec::new(), Vec::new());
                for brick in 0..self.tiles.count() {
                    parts.extend(self.read::<[u32; 2]>(&self.name(&format!("{name}-counts"), kind), brick)?);
                    faces.extend(self.read::<[u32; 2]>(&self.name(&format!("{name}-faces"), kind), brick)?);
                }
                self.write(&self.name(&format!("{name}-ranks"), kind), 0, &ranked(parts, faces))?;
            }
            Ok(())
        })
    }

    /// The label of each extremum: of the part with the most windows that cover it.
    pub(crate) fn labels(&self, brick: usize) -> Result<(), InterpError> {
        let widths = self.widths();
        for kind in 0..self.kinds.len() {
            let halo = Halo { before: [widest(&widths); 2], behind: [0; 2] };
            let patch = self.patch(kind, brick, halo, Values::None)?;
            let links = self.links_back(&patch)?;
            for &(name, width) in &widths {
                let ranks: Vec<Ranked> = self.read(&self.name(&format!("{name}-ranks"), kind), 0)?;
                let parts: Vec<u32> = self.values(&format!("{name}-part"), &patch)?;
                let rank_of = |part: u32| {
                    let found = ranks.binary_search_by_key(&part, |ranked| ranked[0]);
                    found.map_or(0, |at| ranks[at][1])
                };
                let mut found: Vec<u32> =
                    parts.into_iter().map(|part| if part == NONE { 0 } else { rank_of(part) }).collect();
                let scratch = vec![0; found.len()];
                cells::carry(&patch.extrema, &links, &mut found, scratch, width - 1);
                let mut labels = vec![NONE; ranks.len() + 1];
                ranks.iter().for_each(|&[_, rank, label]| labels[rank as usize] = label);
                let labels: Vec<u32> = found.into_iter().map(|rank| labels[rank as usize]).collect();
                self.keep(&format!("{name}-label"), &patch, &labels)?;
            }
        }
        Ok(())
    }

    /// The labels of a patch before any flood.
    pub(crate) fn unflooded(&self, name: &str, patch: &Patch) -> Result<Vec<u32>, InterpError> {
        self.values(&format!("{name}-label"), patch)
    }
}

/// Merges parts, each `[name, windows]`, of which two are one where faces, each `[window, part]`, name a window for both.
/// Sorted by name. Ranks count from 1; merged parts share theirs.
fn ranked(mut parts: Vec<[u32; 2]>, mut faces: Vec<[u32; 2]>) -> Vec<Ranked> {
    parts.sort_unstable();
    let names: Vec<u32> = parts.iter().map(|part| part[0]).collect();
    faces.sort_unstable();
    let place = |name: u32| names.binary_search(&name).ok().map(|at| at as u32);
    let mut sets = UnionFind::new(names.len());
    for pair in faces.windows(2).filter(|pair| pair[0][0] == pair[1][0]) {
        if let (Some(a), Some(b)) = (place(pair[0][1]), place(pair[1][1])) {
            sets.union(a, b);
        }
    }
    let mut counts = vec![0u32; names.len()];
    for [name, count] in parts {
        if let Some(at) = place(name) {
            counts[sets.find(at) as usize] += count;
        }
    }
    // More windows rank higher, among equals the first.
    let mut order: Vec<u32> = (0..names.len() as u32).filter(|&at| counts[at as usize] > 0).collect();
    order.sort_unstable_by_key(|&at| (counts[at as usize], Reverse(at)));
    let mut rank = vec![0u32; names.len()];
    order.iter().zip(1..).for_each(|(&at, place)| rank[at as usize] = place);
    let of = |at: usize, sets: &mut UnionFind| {
        let root = sets.find(at as u32) as usize;
        [names[at], rank[root], names[root]]
    };
    (0..names.len()).map(|at| of(at, &mut sets)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_name_a_window_in_common_are_one() {
        // 3 and 40 share the window 41; 90 shares 95 with 40; 7 is alone.
        let found = ranked(vec![[40, 5], [3, 2], [7, 6], [90, 1]], vec![[41, 3], [41, 40], [95, 90], [95, 40]]);
        assert_eq!(found, [[3, 2, 3], [7, 1, 7], [40, 2, 3], [90, 2, 3]]);
    }
}
