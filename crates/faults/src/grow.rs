//! Surfaces grown from seeds over all ridges that lie on them.

use crate::ridges::Ridge;
use crate::seeds::Seed;
use crate::sheet::{Frame, Sheet, WIDTH};
use crate::sides::Sides;
use crate::throws::{Offsets, offsets};
use attribute::likelihood::ROW;

/// Traces off the surface within which a ridge is its own.
const OFF: f32 = 1.8;
/// Cells beyond the surface in which it takes new ridges.
const REACH: i32 = 4;
/// Cosine of the greatest angle of strikes.
const STRIKES: f32 = 0.78;
/// Rounds of a stage, and most stages after the first.
const ROUNDS: usize = 4;
const STAGES: usize = 8;
/// Growth of a stage below which it ends, as a share.
const SETTLED: f32 = 0.03;
/// Cells over which holes are closed.
const CLOSE: usize = 3;

/// Grows the surface of a group of seeds over the ridges that are free, as far as its two sides tell of a throw; returns it
/// with its members.
pub(crate) fn grown(
    sides: Sides<'_>,
    ridges: &[Ridge],
    is_free: &[bool],
    seeds: &[Seed],
    group: &[usize],
    greatest: i32,
) -> Option<(Sheet, Offsets, Vec<usize>)> {
    let mut members: Vec<usize> = group.iter().map(|&n| seeds[n].ridge).filter(|&n| is_free[n]).collect();
    if 2 * members.len() < group.len() {
        return None;
    }
    let mut before = 0.0;
    for stage in 0.. {
        let (frame, found) = spread(ridges, is_free, members)?;
        let mut sheet = Sheet::through(frame, ridges, &found, CLOSE as i32 + 1);
        sheet.there = closed(&sheet.there, sheet.cells);
        sheet.there = largest(&sheet.there, sheet.cells);
        let mut offsets = offsets(sides, &sheet, greatest);
        sheet.there = offsets.told(&sheet);
        members = found;
        members.retain(|&n| {
            let [u, _] = frame.place(ridges[n].at);
            sheet.is_there(u, ridges[n].at[2])
        });
        let area = sheet.area();
        if stage == STAGES || (stage > 0 && area < before * (1.0 + SETTLED)) {
            offsets.summarize(&sheet);
            return (members.len() >= 12).then_some((sheet, offsets, members));
        }
        before = area;
    }
    None
}

/// Grows the surface of ridges over those that are free, whatever its two sides tell; returns it with its members.
pub(crate) fn followed(ridges: &[Ridge], is_free: &[bool], group: Vec<usize>) -> Option<(Sheet, Vec<usize>)> {
    let mut members: Vec<usize> = group.into_iter().filter(|&n| is_free[n]).collect();
    let mut before = 0.0;
    for stage in 0.. {
        let (frame, found) = spread(ridges, is_free, members)?;
        let mut sheet = Sheet::through(frame, ridges, &found, CLOSE as i32 + 1);
        sheet.there = closed(&sheet.there, sheet.cells);
        sheet.there = largest(&sheet.there, sheet.cells);
        members = found;
        members.retain(|&n| {
            let [u, _] = frame.place(ridges[n].at);
            sheet.is_there(u, ridges[n].at[2])
        });
        let area = sheet.area();
        if stage == STAGES || (stage > 0 && area < before * (1.0 + SETTLED)) {
            return Some((sheet, members));
        }
        before = area;
    }
    None
}

/// Spreads a surface over ridges for some rounds.
fn spread(ridges: &[Ridge], is_free: &[bool], mut members: Vec<usize>) -> Option<(Frame, Vec<usize>)> {
    let around = around(ridges, is_free, &members);
    for _ in 0..ROUNDS {
        if members.len() < 12 {
            return None;
        }
        let frame = Sheet::frame(ridges, &members);
        let sheet = Sheet::through(frame, ridges, &members, REACH + 1);
        let near = dilated(&sheet.there, sheet.cells, REACH as usize);
        let own = |n: usize| {
            let ridge = &ridges[n];
            let [u, height] = frame.place(ridge.at);
            let turn = ridge.plane.along[0] * frame.along[0] + ridge.plane.along[1] * frame.along[1];
            let cell = sheet.cell(u, ridge.at[2]).filter(|&cell| near[cell])?;
            (turn.abs() >= STRIKES && (height - sheet.height[cell]).abs() <= OFF).then_some(n)
        };
        members = around.iter().copied().filter_map(own).collect();
    }
    (members.len() >= 12).then(|| (Sheet::frame(ridges, &members), members))
}

/// The free ridges that a surface may take in some rounds: those as close to its members as it can spread.
fn around(ridges: &[Ridge], is_free: &[bool], members: &[usize]) -> Vec<usize> {
    let lines = (ROUNDS as i32 * REACH) as f32 * WIDTH + OFF;
    let samples = (ROUNDS as i32 * REACH) as f32 * ROW as f32;
    let reach = [lines, lines, samples];
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for at in members.iter().map(|&n| ridges[n].at) {
        for axis in 0..3 {
            low[axis] = low[axis].min(at[axis] - reach[axis]);
            high[axis] = high[axis].max(at[axis] + reach[axis]);
        }
    }
    let is_near = |n: &usize| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&ridges[*n].at[axis]));
    // Ridges lie in the order of their traces, each within half a trace of its own.
    let first = ridges.partition_point(|ridge| ridge.at[0] + 1.0 < low[0]);
    let last = ridges.partition_point(|ridge| ridge.at[0] - 1.0 <= high[0]);
    (first..last).filter(|&n| is_free[n]).filter(is_near).collect()
}

/// Cells within a square of set ones.
pub(crate) fn dilated(set: &[bool], cells: [usize; 2], reach: usize) -> Vec<bool> {
    let mut down = vec![false; set.len()];
    for (line, out) in set.chunks(cells[1]).zip(down.chunks_mut(cells[1])) {
        for n in (0..cells[1]).filter(|&n| line[n]) {
            out[n.saturating_sub(reach)..(n + reach + 1).min(cells[1])].fill(true);
        }
    }
    let mut all = vec![false; set.len()];
    for a in 0..cells[0] {
        for c in a.saturating_sub(reach)..(a + reach + 1).min(cells[0]) {
            for b in 0..cells[1] {
                all[a * cells[1] + b] |= down[c * cells[1] + b];
            }
        }
    }
    all
}

/// Closes gaps, and holes that are enclosed.
pub(crate) fn closed(set: &[bool], cells: [usize; 2]) -> Vec<bool> {
    let wide = dilated(set, cells, CLOSE);
    let outside: Vec<bool> = wide.iter().map(|set| !set).collect();
    let eroded = dilated(&outside, cells, CLOSE);
    let mut all: Vec<bool> = set.iter().zip(&eroded).map(|(set, out)| *set || !*out).collect();
    let open: Vec<bool> = all.iter().map(|set| !set).collect();
    // What is empty and not joined to the edge is a hole.
    let parts = parts(&open, cells);
    let mut at_edge = vec![false; set.len() + 1];
    for a in 0..cells[0] {
        for b in 0..cells[1] {
            if a == 0 || b == 0 || a + 1 == cells[0] || b + 1 == cells[1] {
                at_edge[parts[a * cells[1] + b]] = true;
            }
        }
    }
    for (set, part) in all.iter_mut().zip(&parts) {
        *set |= *part > 0 && !at_edge[*part];
    }
    all
}

/// The largest part of what is set.
pub(crate) fn largest(set: &[bool], cells: [usize; 2]) -> Vec<bool> {
    let parts = parts(set, cells);
    let mut counts = vec![0usize; set.len() + 1];
    parts.iter().filter(|part| **part > 0).for_each(|part| counts[*part] += 1);
    let best = (1..counts.len()).max_by_key(|&part| (counts[part], counts.len() - part)).unwrap_or(0);
    parts.iter().map(|part| *part == best && best > 0).collect()
}

/// Numbers of the joined parts of what is set, from 1; 0 where it is not.
fn parts(set: &[bool], cells: [usize; 2]) -> Vec<usize> {
    let mut part = vec![0; set.len()];
    let mut count = 0;
    for start in 0..set.len() {
        if !set[start] || part[start] > 0 {
            continue;
        }
        count += 1;
        let mut stack = vec![start];
        part[start] = count;
        while let Some(n) = stack.pop() {
            let (a, b) = (n / cells[1], n % cells[1]);
            let beside = [
                (a > 0).then(|| n - cells[1]),
                (a + 1 < cells[0]).then(|| n + cells[1]),
                (b > 0).then(|| n - 1),
                (b + 1 < cells[1]).then(|| n + 1),
            ];
            for m in beside.into_iter().flatten().filter(|&m| set[m]) {
                if part[m] == 0 {
                    part[m] = count;
                    stack.push(m);
                }
            }
        }
    }
    part
}
