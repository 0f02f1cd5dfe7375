//! Which seed's time an event has where.
//!
//! A seed holds the part of its patch that lies along its level: that is one reflection, whatever τ says elsewhere. The
//! first seed also holds the other patches along its level in its fault block. From there claims spread over the traces.
//! Their distance is counted in traces; a step through a fault at the depth of the level counts [`THROUGH_FAULT`] of
//! them, so that a claim fills its fault block and goes round a tip. A later seed corrects the ones before it where it lies:
//! a patch on which it lies holds nothing within [`TAKEN`] traces of what the later seed holds, while a seed's own patch on
//! which no later one lies stays (`own_patches`). Of the other patches on the first seed's level none is held within as
//! many traces, and one is dropped as a whole where a later seed says that the event is another. A patch that nothing joins to the first seed's own, as beyond a fault that
//! nobody knows of, is held only where that one is closer than what a later seed holds. The level at a trace is the mean of
//! the seeds' times with weights 1/d⁸.
//!
//! Memory: 12 bytes a trace for each seed while it spreads, and 4 bytes afterwards.

use crate::cuts::Cut;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Traces that a step through a fault counts.
const THROUGH_FAULT: u32 = 1000;
/// Traces around what a later seed holds that it takes from those before it.
const TAKEN: u32 = 8;
/// Cost of a step along an axis; a diagonal one costs [`DIAGONAL`], nearly √2 as much.
const STEP: u32 = 5;
const DIAGONAL: u32 = 7;
/// Share of the traces of a patch on which a later seed must hold another so that it is dropped.
const DROPPED: f64 = 0.1;

/// What a seed holds, and how its time spreads.
pub(crate) struct Holding {
    /// τ of the seed.
    pub time: f32,
    /// The number of its patch.
    pub hub: Option<u32>,
    /// Trace of the seed (x·crosslines + y).
    pub trace: usize,
    /// Traces of its patch.
    pub patch: Vec<usize>,
    /// The other patches along its level.
    pub others: Vec<Along>,
    /// Fractional sample at which its level crosses each trace.
    pub depth: Vec<f32>,
}

/// A patch along the level of a seed.
pub(crate) struct Along {
    /// Its traces.
    pub traces: Vec<usize>,
    /// Whether patches join it to the seed's own, trace by trace.
    pub is_joined: bool,
}

/// The level at each trace (x·crosslines + y) of `count` inlines and crosslines, and the number of the seed that it has
/// most of.
pub(crate) fn levels(holdings: &[Holding], cuts: &[Cut], count: [usize; 2]) -> Vec<(f32, usize)> {
    let patches = own_patches(holdings, cuts, count);
    let mut distances: Vec<Vec<u32>> = Vec::with_capacity(holdings.len());
    for (holding, patch) in holdings.iter().zip(&patches).rev() {
        let is_left = |trace: &usize| distances.iter().all(|later| later[*trace] > TAKEN * STEP);
        let is_dropped = |Along { traces: patch, .. }: &Along| {
            let taken = patch.iter().filter(|trace| distances.iter().any(|later| later[**trace] == 0)).count();
            taken as f64 >= DROPPED * patch.len() as f64
        };
        let mut held = vec![holding.trace];
        // A later seed that lies on it takes from it what is around.
        let correcting = holdings.iter().skip(holdings.len() - distances.len()).map(|later| later.trace);
        let is_corrected = correcting.into_iter().any(|later| holding.patch.contains(&later));
        held.extend(patch.iter().copied().filter(|trace| !is_corrected || is_left(trace)));
        let mut distance = spread(&held, &holding.depth, cuts, count);
        if !holding.others.is_empty() {
            let kept = holding.others.iter().filter(|patch| !is_dropped(patch));
            let is_closest = |trace: usize| distances.iter().all(|later| distance[trace] <= later[trace]);
            let kept = kept.flat_map(|patch| {
                patch.traces.iter().copied().filter(move |trace| patch.is_joined || is_closest(*trace))
            });
            held.extend(kept.filter(|trace| distance[*trace] < THROUGH_FAULT * STEP).filter(is_left));
            distance = spread(&held, &holding.depth, cuts, count);
        }
        distances.push(distance);
    }
    distances.reverse();
    let level = |trace: usize| {
        let (mut sum, mut weights, mut most) = (0.0f64, 0.0f64, (0.0f64, 0));
        for (n, (Holding { time, .. }, distance)) in holdings.iter().zip(&distances).enumerate() {
            let traces = (f64::from(distance[trace]) / f64::from(STEP)).max(0.1);
            let weight = traces.powi(-8);
            sum += weight * f64::from(*time);
            weights += weight;
            most = if weight > most.0 { (weight, n) } else { most };
        }
        ((sum / weights) as f32, most.1)
    };
    (0..count[0] * count[1]).map(level).collect()
}

/// What each seed holds of its own patch. Where the patches of two seeds lie on one trace, one of them left the event. If
/// the later seed lies where the earlier one's patch does, that one is corrected there: it keeps what is closer to it, if
/// the later seed's patch in turn runs past it, and nothing otherwise. If it does not, the earlier patch stays, and the later
/// one, which is another reflection elsewhere, is held only where it is closer to its seed than the earlier patch is.
fn own_patches(holdings: &[Holding], cuts: &[Cut], count: [usize; 2]) -> Vec<Vec<usize>> {
    let on = |holding: &Holding| {
        let mut is_on = vec![false; count[0] * count[1]];
        holding.patch.iter().for_each(|trace| is_on[*trace] = true);
        is_on
    };
    let is_on: Vec<Vec<bool>> = holdings.iter().map(on).collect();
    let mut patches: Vec<Vec<usize>> = holdings.iter().map(|holding| holding.patch.clone()).collect();
    for (later, seed) in holdings.iter().enumerate() {
        for (earlier, first) in holdings[..later].iter().enumerate() {
            let shared = first.patch.iter().filter(|trace| is_on[later][**trace]).count();
            if shared == 0 || first.hub == seed.hub {
                continue;
            }
            let from = |seed: &Holding| spread(&[seed.trace], &seed.depth, cuts, count);
            let is_corrected = is_on[earlier][seed.trace];
            let runs_past = is_on[later][first.trace];
            match (is_corrected, runs_past) {
                (true, false) => patches[earlier].retain(|trace| !is_on[later][*trace]),
                (true, true) => {
                    let [a, b] = [first, seed].map(from);
                    patches[earlier].retain(|trace| !is_on[later][*trace] || a[*trace] <= b[*trace]);
                    patches[later].retain(|trace| !is_on[earlier][*trace] || a[*trace] > b[*trace]);
                }
                (false, _) => {
                    patches[later].retain(|trace| !is_on[earlier][*trace]);
                    if shared as f64 >= DROPPED * seed.patch.len() as f64 {
                        let (a, b) = (spread(&first.patch, &first.depth, cuts, count), from(seed));
                        patches[later].retain(|trace| a[*trace] > b[*trace]);
                    }
                }
            }
        }
    }
    patches
}

/// Least cost of the steps from what a seed holds to each trace (E. W. Dijkstra, Numerische Mathematik 1, 1959).
fn spread(held: &[usize], depth: &[f32], cuts: &[Cut], [nx, ny]: [usize; 2]) -> Vec<u32> {
    let mut cost = vec![u32::MAX; nx * ny];
    let mut open: BinaryHeap<Reverse<(u32, usize)>> = BinaryHeap::new();
    for &trace in held {
        cost[trace] = 0;
        open.push(Reverse((0, trace)));
    }
    while let Some(Reverse((here, trace))) = open.pop() {
        if here > cost[trace] {
            continue;
        }
        let (x, y) = (trace / ny, trace % ny);
        for i in x.saturating_sub(1)..(x + 2).min(nx) {
            for j in y.saturating_sub(1)..(y + 2).min(ny) {
                let other = i * ny + j;
                let plain = here + if i == x || j == y { STEP } else { DIAGONAL };
                if plain >= cost[other] {
                    continue;
                }
                let [za, zb] = [trace, other].map(|trace| depth[trace]);
                let through = cuts.iter().any(|cut| cut.separates([x, y], za, [i, j], zb));
                let there = plain + if through { THROUGH_FAULT * STEP } else { 0 };
                if there < cost[other] {
                    cost[other] = there;
                    open.push(Reverse((there, other)));
                }
            }
        }
    }
    cost
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cuts::Across;

    const COUNT: [usize; 2] = [40, 30];

    fn holding(time: f32, trace: usize, patch: Vec<usize>) -> Holding {
        Holding {
            time,
            hub: Some(trace as u32),
            trace,
            patch,
            others: Vec::new(),
            depth: vec![5.0; COUNT[0] * COUNT[1]],
        }
    }

    fn at(levels: &[(f32, usize)], x: usize, y: usize) -> f32 {
        levels[x * COUNT[1] + y].0
    }

    #[test]
    fn a_claim_fills_its_block_and_goes_round_a_tip() {
        // A fault between inlines 20 and 21 that ends at crossline 20.
        let cut = Cut::new(Across::Inlines, COUNT[1], 10, |y, _| if y < 20 { 20.5 } else { f32::NAN });
        let (left, right) = (2 * COUNT[1] + 2, 38 * COUNT[1] + 2);
        let found = levels(
            &[holding(1.0, left, Vec::new()), holding(2.0, right, Vec::new())],
            std::slice::from_ref(&cut),
            COUNT,
        );
        assert!((at(&found, 20, 2) - 1.0).abs() < 1e-3, "{}", at(&found, 20, 2));
        assert!((at(&found, 21, 2) - 2.0).abs() < 1e-3, "{}", at(&found, 21, 2));
        // Round the tip the left claim has 18 + 18 traces to go, and the right one 17.
        let only = spread(&[left], &holding(1.0, left, Vec::new()).depth, &[cut], COUNT);
        assert!(only[21 * COUNT[1] + 2] < 60 * STEP, "round the tip, not through the fault");
    }

    #[test]
    fn a_later_seed_takes_what_lies_around_it_and_leaves_the_rest() {
        let all: Vec<usize> = (0..COUNT[0] * COUNT[1]).collect();
        let second = 30 * COUNT[1] + 15;
        let found = levels(&[holding(1.0, 0, all), holding(2.0, second, Vec::new())], &[], COUNT);
        assert!((at(&found, 30, 15) - 2.0).abs() < 1e-6);
        assert!((at(&found, 33, 15) - 2.0).abs() < 0.1);
        assert!((at(&found, 30, 25) - 1.0).abs() < 1e-6, "the first seed's own patch keeps its time");
        assert!((at(&found, 3, 3) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_patch_on_which_no_later_seed_lies_stays_where_the_patch_of_a_later_one_runs_over_it() {
        // The second seed lies beyond the first one's patch, on a patch that runs over nearly the whole survey.
        let rows = |x: std::ops::Range<usize>| (x.start * COUNT[1]..x.end * COUNT[1]).collect::<Vec<usize>>();
        let found = levels(&[holding(1.0, 0, rows(0..25)), holding(2.0, 35 * COUNT[1] + 15, rows(6..40))], &[], COUNT);
        let mut right = (0..25).flat_map(|x| (0..30).map(move |y| (x, y)));
        assert!(right.all(|(x, y)| (at(&found, x, y) - 1.0).abs() < 1e-3), "what was right stays");
        assert!((at(&found, 35, 15) - 2.0).abs() < 1e-3 && (at(&found, 39, 2) - 2.0).abs() < 1e-3);
        // It does not stay where the second seed lies on it and its patch ends before the first.
        let found = levels(&[holding(1.0, 0, rows(0..40)), holding(2.0, 35 * COUNT[1] + 15, rows(20..40))], &[], COUNT);
        assert!((at(&found, 22, 5) - 2.0).abs() < 1e-3 && (at(&found, 5, 5) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_single_seed_has_its_time_everywhere() {
        let found = levels(&[holding(7.5, 0, Vec::new())], &[], COUNT);
        assert!(found.iter().all(|(level, _)| *level == 7.5));
    }

    #[test]
    fn a_later_seed_bends_what_nothing_joins_to_the_first_and_leaves_what_is_joined() {
        let row = |x: usize, y: std::ops::Range<usize>| y.map(move |y| x * COUNT[1] + y);
        let part = |x: std::ops::Range<usize>| x.flat_map(|x| row(x, 0..30)).collect::<Vec<usize>>();
        let click = |is_joined: bool| {
            // The first seed's own patch, one that goes on, and one on the far side of the place that is clicked.
            let on = [(11..24, true), (34..40, is_joined)];
            let others = on.map(|(x, is_joined)| Along { traces: part(x), is_joined }).into_iter().collect();
            let first = Holding { others, ..holding(1.0, 0, part(0..11)) };
            levels(&[first, holding(2.0, 27 * COUNT[1] + 15, Vec::new())], &[], COUNT)
        };
        let (apart, joined) = (click(false), click(true));
        assert!((at(&apart, 38, 15) - 2.0).abs() < 0.1, "{}", at(&apart, 38, 15));
        assert!((at(&joined, 38, 15) - 1.0).abs() < 1e-3, "{}", at(&joined, 38, 15));
        for (x, y) in (0..18).flat_map(|x| (0..30).map(move |y| (x, y))) {
            assert!((at(&apart, x, y) - 1.0).abs() < 1e-3, "what was right stays: {x} {y} {}", at(&apart, x, y));
        }
        assert_eq!((apart[15].1, apart[38 * COUNT[1] + 15].1), (0, 1));
    }

    #[test]
    fn a_patch_that_a_later_seed_contradicts_is_dropped_as_a_whole() {
        let row = |x: usize, y: std::ops::Range<usize>| y.map(move |y| x * COUNT[1] + y);
        let wrong: Vec<usize> = (25..40).flat_map(|x| row(x, 0..30)).collect();
        let right: Vec<usize> = (30..36).flat_map(|x| row(x, 10..20)).collect();
        let wrong = Along { traces: wrong, is_joined: true };
        let first = Holding { others: vec![wrong], ..holding(1.0, 0, (0..24).flat_map(|x| row(x, 0..30)).collect()) };
        let found = levels(&[first, holding(2.0, 33 * COUNT[1] + 15, right)], &[], COUNT);
        assert!((at(&found, 39, 15) - 2.0).abs() < 0.1, "{}", at(&found, 39, 15));
        assert!((at(&found, 20, 15) - 1.0).abs() < 1e-6);
    }
}
