//! From links to labelled surfaces: closed cells, morphological opening by the least width, connected
//! windows.
//!
//! A cell is closed when stepping along x then y arrives at the same extremum as y then x. With the least
//! front width w, a *window* is a block of (w − 1)² closed cells, i.e. of w × w traces. The union of all
//! windows is the morphological opening of the surface by that width. Two windows shifted by one trace are
//! connected. So a neck narrower than w traces does not connect, just as in the paper a border narrower than
//! w ends. Components are numbered by their first window. A vertex belongs to the component with the most
//! windows among those that cover it (ties: the first).

use super::links::{BACK_X, BACK_Y, Links, NEXT_X, NEXT_Y, NONE};
use super::union_find::UnionFind;
use crate::extrema::Extrema;
use rayon::prelude::*;
use std::cmp::Reverse;
use survey::{Cancelled, Progress};

/// Count of extrema that one thread handles at a time.
const GRAIN: usize = 1 << 14;

/// Whether the cell that begins at each extremum is closed and none of its four links is broken.
pub(crate) fn open_cells(links: &Links, broken: &[[bool; 2]]) -> Vec<bool> {
    let is_open = |a: u32| {
        links.closed(a).is_some_and(|[a, b, c, _]| {
            !(broken[a as usize][0] | broken[a as usize][1] | broken[b as usize][1] | broken[c as usize][0])
        })
    };
    (0..broken.len() as u32).into_par_iter().with_min_len(GRAIN).map(is_open).collect()
}

/// The component of each extremum (the index of its first window), or [`NONE`]. `open` is the result of
/// [`open_cells`].
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn label(
    extrema: &Extrema,
    links: &Links,
    open: &[bool],
    min_front_width: usize,
    progress: &Progress,
) -> Result<Vec<u32>, Cancelled> {
    let cells = min_front_width - 1;
    let windows = windows(extrema, links, open, cells);
    progress.check()?;
    let mut sets = UnionFind::new(extrema.len());
    for v in 0..extrema.len() as u32 {
        if !windows[v as usize] {
            continue;
        }
        for direction in [NEXT_X, NEXT_Y] {
            let next = links.to[direction][v as usize];
            if next != NONE && windows[next as usize] {
                sets.union(v, next);
            }
        }
    }
    let mut set_of = vec![NONE; extrema.len()];
    let mut count = vec![0u32; extrema.len()];
    for v in 0..extrema.len() as u32 {
        if windows[v as usize] {
            let set = sets.find(v);
            set_of[v as usize] = set;
            count[set as usize] += 1;
        }
    }
    drop((windows, sets));
    progress.check()?;
    // Ranks instead of sets, from 1: more windows rank higher, among equals the first.
    let mut sets: Vec<u32> = (0..extrema.len() as u32).filter(|&set| count[set as usize] > 0).collect();
    sets.par_sort_unstable_by_key(|&set| (count[set as usize], Reverse(set)));
    let mut rank = count;
    for (n, &set) in sets.iter().enumerate() {
        rank[set as usize] = n as u32 + 1;
    }
    let mut labels = set_of;
    labels.par_iter_mut().with_min_len(GRAIN).for_each(|label| {
        *label = if *label == NONE { 0 } else { rank[*label as usize] };
    });
    carry(extrema, links, &mut labels, rank, cells);
    progress.check()?;
    labels.par_iter_mut().with_min_len(GRAIN).for_each(|label| {
        *label = if *label == 0 { NONE } else { sets[*label as usize - 1] };
    });
    Ok(labels)
}

/// Whether each extremum is the first corner of a complete window: `cells` cells along y, each the first of
/// `cells` cells along x.
pub(crate) fn windows(extrema: &Extrema, links: &Links, open: &[bool], cells: usize) -> Vec<bool> {
    // Runs of open cells along x from this one on, counted up to `cells`. An open cell has its links.
    let most = u16::try_from(cells).unwrap_or(u16::MAX);
    let mut runs = vec![0u16; extrema.len()];
    for x in (0..extrema.size[0]).rev() {
        let line = extrema.on_inline(x);
        let (these, after) = runs[line.start..].split_at_mut(line.len());
        these.par_iter_mut().with_min_len(GRAIN).enumerate().for_each(|(n, run)| {
            let v = line.start + n;
            if open[v] {
                *run = (1 + after[links.to[NEXT_X][v] as usize - line.end]).min(most);
            }
        });
    }
    // The same along y, over cells whose runs along x are complete.
    extrema.split_inlines(&mut runs).into_par_iter().enumerate().for_each(|(x, line)| {
        let first = extrema.on_inline(x).start;
        for n in (0..line.len()).rev() {
            line[n] =
                if line[n] < most { 0 } else { (1 + line[links.to[NEXT_Y][first + n] as usize - first]).min(most) };
        }
    });
    runs.into_iter().map(|run| run == most).collect()
}

/// Gives every extremum the greatest rank of the windows that cover it, i.e. of those up to `cells` traces
/// behind it along y and then along x.
///
/// A chain of links back to the first corner of a window stays within the window, where every path leads to
/// the same corner, so one axis can be done after the other. `scratch` is as long as `ranks`.
pub(crate) fn carry(extrema: &Extrema, links: &Links, ranks: &mut Vec<u32>, mut scratch: Vec<u32>, cells: usize) {
    let greatest = |rank: u32, back: u32, from: &[u32], start: usize| {
        if back == NONE { rank } else { rank.max(from[back as usize - start]) }
    };
    for _ in 0..cells.min(extrema.size[0]) {
        scratch.par_iter_mut().with_min_len(GRAIN).enumerate().for_each(|(v, out)| {
            *out = greatest(ranks[v], links.to[BACK_X][v], ranks, 0);
        });
        std::mem::swap(ranks, &mut scratch);
    }
    extrema.split_inlines(ranks).into_par_iter().enumerate().for_each(|(x, line)| {
        let first = extrema.on_inline(x).start;
        for _ in 0..cells.min(extrema.size[1]) {
            // In descending order, so that in each round no rank moves by more than one trace.
            for n in (0..line.len()).rev() {
                line[n] = greatest(line[n], links.to[BACK_Y][first + n], line, first);
            }
        }
    });
}
