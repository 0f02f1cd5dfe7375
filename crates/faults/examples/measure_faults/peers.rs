//! What other published methods find, implemented here anew, at several thresholds each.
//!
//! Each gives an attribute at every third sample, is thinned to where that is greatest across the fault, and what is left
//! above a threshold is joined to its 26 neighbours. Parts of at least [`LEAST`] places are surfaces.

use crate::Found;
use attribute::likelihood::ROW;
use attribute::{DipSettings, Likelihood, SemblanceSettings, dip, likelihood, semblance, slopes};
use rayon::prelude::*;
use std::time::Instant;
use survey::{Progress, SurveyGeometry, Volume};

/// Places of the smallest surface: a place stands for three samples of a trace.
const LEAST: usize = 400;
/// What of a part lies above.
const THRESHOLDS: [f32; 5] = [0.3, 0.45, 0.6, 0.75, 0.9];

/// An attribute at every row, `[inline][crossline][row]`.
struct Rows {
    size: [usize; 3],
    value: Vec<f32>,
}

impl Rows {
    fn neighbours(&self, n: usize) -> impl Iterator<Item = usize> {
        let [nx, ny, rows] = self.size.map(|n| n as isize);
        let (x, y, r) =
            ((n / self.size[2] / self.size[1]) as isize, (n / self.size[2]) as isize % ny, n as isize % rows);
        (0..27).filter_map(move |k| {
            let (i, j, q) = (x + k / 9 - 1, y + k / 3 % 3 - 1, r + k % 3 - 1);
            let is_inside = (0..nx).contains(&i) && (0..ny).contains(&j) && (0..rows).contains(&q);
            is_inside.then_some(((i * ny + j) * rows + q) as usize)
        })
    }

    /// The value between four traces; 0 outside.
    fn at(&self, x: f32, y: f32, row: isize) -> f32 {
        let [nx, ny, rows] = self.size;
        let is_inside = x >= 0.0 && y >= 0.0 && x < (nx - 1) as f32 && y < (ny - 1) as f32;
        if !is_inside || !(0..rows as isize).contains(&row) {
            return 0.0;
        }
        let (i, j) = (x as usize, y as usize);
        let (s, t) = (x - i as f32, y - j as f32);
        let of = |i: usize, j: usize| self.value[(i * ny + j) * rows + row as usize];
        (of(i, j) * (1.0 - t) + of(i, j + 1) * t) * (1.0 - s) + (of(i + 1, j) * (1.0 - t) + of(i + 1, j + 1) * t) * s
    }

    /// What is greatest across `direction`, 0 elsewhere; where no direction is known, across either axis.
    fn thinned(&self, direction: impl Fn(usize) -> Option<[f32; 2]> + Sync) -> Self {
        let [_, ny, rows] = self.size;
        let value = (0..self.value.len()).into_par_iter().map(|n| {
            let (x, y, r) = ((n / rows / ny) as f32, (n / rows % ny) as f32, (n % rows) as isize);
            let here = self.value[n];
            let is_ridge = |[i, j]: [f32; 2]| here > self.at(x - i, y - j, r) && here >= self.at(x + i, y + j, r);
            let is_thin = direction(n).map_or_else(|| is_ridge([1.0, 0.0]) || is_ridge([0.0, 1.0]), is_ridge);
            if is_thin { here } else { 0.0 }
        });
        Self { size: self.size, value: value.collect() }
    }

    /// The joined parts above a threshold.
    fn parts(&self, threshold: f32) -> Vec<Vec<usize>> {
        let mut is_free: Vec<bool> = self.value.iter().map(|value| *value >= threshold).collect();
        let mut parts = Vec::new();
        for start in 0..is_free.len() {
            if !std::mem::take(&mut is_free[start]) {
                continue;
            }
            let (mut part, mut next) = (vec![start], 0);
            while next < part.len() {
                for near in self.neighbours(part[next]) {
                    if std::mem::take(&mut is_free[near]) {
                        part.push(near);
                    }
                }
                next += 1;
            }
            if part.len() >= LEAST {
                parts.push(part);
            }
        }
        parts
    }

    fn found<'a>(&self, threshold: f32) -> Found<'a> {
        let [nx, ny, rows] = self.size;
        let parts = self.parts(threshold);
        let place = |n: &usize| [(n / rows / ny) as f32, (n / rows % ny) as f32, (n % rows * ROW) as f32];
        let surfaces: Vec<Vec<[f32; 3]>> = parts.iter().map(|part| part.iter().map(place).collect()).collect();
        let mut near = vec![false; self.value.len()];
        for n in parts.into_iter().flatten() {
            let (x, y) = ((n / rows / ny) as isize, (n / rows % ny) as isize);
            for (i, j) in
                (-2isize..=2).flat_map(|i| (-2isize..=2).map(move |j| (i, j))).filter(|(i, j)| i * i + j * j <= 4)
            {
                if (0..nx as isize).contains(&(x + i)) && (0..ny as isize).contains(&(y + j)) {
                    near[((x + i) as usize * ny + (y + j) as usize) * rows + n % rows] = true;
                }
            }
        }
        let is_near = move |[x, y, z]: [f32; 3]| {
            let (x, y) = (x.round().clamp(0.0, (nx - 1) as f32), y.round().clamp(0.0, (ny - 1) as f32));
            let row = (z / ROW as f32).round().min((rows - 1) as f32);
            near[(x as usize * ny + y as usize) * rows + row as usize]
        };
        Found { is_near: Box::new(is_near), surfaces }
    }
}

/// One minus the semblance along dips, as dip-steered similarity is thinned in interpretation programs.
fn by_semblance(volume: &Volume<f32>) -> Rows {
    let quiet = Progress::silent();
    let dips = dip(volume, &DipSettings::default(), &quiet).unwrap();
    let settings = SemblanceSettings { half_width: 1, half_window: 8 };
    let found = semblance(volume, &dips, &settings, &quiet).unwrap();
    let [nx, ny, nz] = volume.size();
    let rows = nz.div_ceil(ROW);
    let of = |n: usize| 1.0 - found.at(n / rows / ny, n / rows % ny, (n % rows * ROW).min(nz - 1));
    let raw = Rows { size: [nx, ny, rows], value: (0..nx * ny * rows).map(of).collect() };
    // To the range of the others: its greatest values are 1.
    let mut sorted = raw.value.clone();
    sorted.sort_unstable_by(f32::total_cmp);
    let most = sorted[sorted.len() * 99 / 100].max(1e-6);
    Rows { size: raw.size, value: raw.value.into_iter().map(|value| (value / most).min(1.0)).collect() }
}

/// Half the votes' window along strike, in steps of two traces, down, in rows, and across, in traces.
const WINDOW: [usize; 3] = [8, 8, 5];
/// Least likelihood of a seed, and the traces and rows between seeds.
const SEEDS: (f32, isize) = (0.3, 3);

/// Optimal surface voting (Wu and Fomel, Geophysics 83(5), 2018): from seeds on ridges the surface of the greatest sum of
/// likelihood is found in a window, and gives each of its places the mean likelihood along it.
fn by_votes(found: &Likelihood, rows: &Rows, thin: &Rows) -> Rows {
    let [nx, ny, nr] = rows.size;
    let mut order: Vec<usize> = (0..thin.value.len()).filter(|&n| thin.value[n] >= SEEDS.0).collect();
    order.sort_unstable_by(|&a, &b| thin.value[b].total_cmp(&thin.value[a]).then(a.cmp(&b)));
    let mut is_taken = vec![false; thin.value.len()];
    let mut seeds = Vec::new();
    for n in order {
        if is_taken[n] {
            continue;
        }
        seeds.push(n);
        let (x, y, r) = ((n / nr / ny) as isize, (n / nr % ny) as isize, (n % nr) as isize);
        let near = |at: isize, last: usize| (at - SEEDS.1).max(0)..=(at + SEEDS.1).min(last as isize - 1);
        for i in near(x, nx) {
            for j in near(y, ny) {
                for q in near(r, nr) {
                    is_taken[((i as usize) * ny + j as usize) * nr + q as usize] = true;
                }
            }
        }
    }
    let votes: Vec<Vec<(usize, f32)>> = seeds.par_iter().map(|&n| vote(found, rows, n)).collect();
    let mut value = vec![0.0f32; rows.value.len()];
    for (n, vote) in votes.into_iter().flatten() {
        value[n] += vote;
    }
    let mut sorted: Vec<f32> = value.iter().copied().filter(|value| *value > 0.0).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let most = sorted.get(sorted.len() * 95 / 100).copied().unwrap_or(1.0);
    Rows { size: rows.size, value: value.into_iter().map(|value| (value / most).min(1.0)).collect() }
}

/// The places of the best surface through a seed, and the weight of their votes.
fn vote(found: &Likelihood, rows: &Rows, seed: usize) -> Vec<(usize, f32)> {
    let [nx, ny, nr] = rows.size;
    let (x, y, r) = ((seed / nr / ny) as f32, (seed / nr % ny) as f32, (seed % nr) as isize);
    let plane = found.plane(seed);
    let [us, rs, hs] = WINDOW.map(|half| 2 * half + 1);
    let place = |u: usize, q: usize, h: usize| {
        let along = 2.0 * (u as f32 - WINDOW[0] as f32);
        let down = q as isize - WINDOW[1] as isize;
        let across = h as f32 - WINDOW[2] as f32 + plane.run * (down * ROW as isize) as f32;
        let at = |axis: usize| along * plane.along[axis] + across * plane.across[axis];
        (x + at(0), y + at(1), r + down)
    };
    let index = |u: usize, q: usize, h: usize| (u * rs + q) * hs + h;
    let mut cost = vec![0.0f32; us * rs * hs];
    for (u, q, h) in (0..us).flat_map(|u| (0..rs).flat_map(move |q| (0..hs).map(move |h| (u, q, h)))) {
        let (x, y, row) = place(u, q, h);
        let is_seed = u == WINDOW[0] && q == WINDOW[1];
        cost[index(u, q, h)] = if is_seed && h != WINDOW[2] { 1e3 } else { 1.0 - rows.at(x, y, row) };
    }
    // The least sum of costs through each place along strike, then down the rows.
    let cost = through(&cost, us, |u, k| index(u, k / hs, k % hs), rs * hs, hs);
    let cost = through(&cost, rs, |q, k| index(k / hs, q, k % hs), us * hs, hs);
    let mut places = Vec::new();
    for u in 0..us {
        let line = |q: usize, h: usize| cost[index(u, q, h)];
        // A path that changes by one trace a row at most.
        let mut sums = vec![vec![0.0f32; hs]; rs];
        for q in 0..rs {
            for h in 0..hs {
                let before = if q == 0 { 0.0 } else { least(&sums[q - 1], h).0 };
                sums[q][h] = line(q, h) + before;
            }
        }
        let mut h = (0..hs).min_by(|&a, &b| sums[rs - 1][a].total_cmp(&sums[rs - 1][b])).unwrap_or(0);
        for q in (0..rs).rev() {
            places.push(place(u, q, h));
            if q > 0 {
                h = least(&sums[q - 1], h).1;
            }
        }
    }
    let mean = places.iter().map(|&(x, y, row)| rows.at(x, y, row)).sum::<f32>() / places.len() as f32;
    let on_trace = |(x, y, row): (f32, f32, isize)| {
        let (x, y) = (x.round() as isize, y.round() as isize);
        let is_inside =
            (0..nx as isize).contains(&x) && (0..ny as isize).contains(&y) && (0..nr as isize).contains(&row);
        is_inside.then(|| ((x as usize * ny + y as usize) * nr + row as usize, mean))
    };
    places.into_iter().filter_map(on_trace).collect()
}

/// The least of a height and its neighbours, and where.
fn least(sums: &[f32], h: usize) -> (f32, usize) {
    let near = h.saturating_sub(1)..=(h + 1).min(sums.len() - 1);
    near.map(|g| (sums[g], g)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, h))
}

/// Costs of the best paths through every place along one axis, mean of the steps.
fn through(cost: &[f32], steps: usize, index: impl Fn(usize, usize) -> usize, others: usize, hs: usize) -> Vec<f32> {
    let mut out = vec![0.0f32; cost.len()];
    for first in (0..others).step_by(hs) {
        let line = |s: usize, h: usize| cost[index(s, first + h)];
        let pass = |order: &mut dyn Iterator<Item = usize>| {
            let mut sums = vec![vec![0.0f32; hs]; steps];
            let mut before: Option<usize> = None;
            for s in order {
                for h in 0..hs {
                    sums[s][h] = line(s, h) + before.map_or(0.0, |b| least(&sums[b], h).0);
                }
                before = Some(s);
            }
            sums
        };
        let (forth, back) = (pass(&mut (0..steps)), pass(&mut (0..steps).rev()));
        for s in 0..steps {
            for h in 0..hs {
                out[index(s, first + h)] = (forth[s][h] + back[s][h] - line(s, h)) / steps as f32;
            }
        }
    }
    out
}

/// Thinned semblance, thinned fault likelihood (Hale, Geophysics 78(2), 2013) and surface voting, at each threshold.
pub(crate) fn peers<'a>(volume: &Volume<f32>, geometry: &SurveyGeometry) -> Vec<(String, Found<'a>)> {
    let quiet = Progress::silent();
    let mut all = Vec::new();
    let mut add = |method: &str, seconds: f64, thin: &Rows| {
        for threshold in THRESHOLDS {
            all.push((format!("{method} from {threshold} ({seconds:.1} s)"), thin.found(threshold)));
        }
    };
    let start = Instant::now();
    let thin = by_semblance(volume).thinned(|_| None);
    add("semblance", start.elapsed().as_secs_f64(), &thin);
    let start = Instant::now();
    let found = likelihood(volume, &slopes(volume, &quiet).unwrap(), geometry, &quiet).unwrap();
    let rows = Rows { size: found.size, value: found.value.clone() };
    let across = |n: usize| Some(found.plane(n).across);
    let thin = rows.thinned(across);
    add("likelihood", start.elapsed().as_secs_f64(), &thin);
    let votes = by_votes(&found, &rows, &thin).thinned(across);
    add("votes", start.elapsed().as_secs_f64(), &votes);
    all
}
