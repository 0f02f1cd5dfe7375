//! Groups pairs into traces of faults on horizons, and traces into faults.

use super::pairs::Pair;
use super::{ProposeSettings, metres};
use crate::UnionFind;
use glam::{DMat3, DVec2, Vec2};

/// Largest distance between successive pairs of one trace, traces.
const STEP: f32 = 5.0;
/// Least cosine between the directions across of two such pairs.
const PARALLEL: f32 = 0.8;
/// Least share of the shorter trace that must lie over the other one for the two to belong to one fault.
const COMMON: f64 = 0.4;
/// Largest spread of the distances across between two traces of one fault, traces.
const SPREAD: f64 = 4.0;

/// Traces on one horizon that are farther apart than this (traces) belong to two faults.
const BESIDE: f32 = 6.0;

/// Whether two throws have one sign, and neither is much more than three times the other.
fn alike(a: &Pair, b: &Pair) -> bool {
    let same_way = if a.across.dot(b.across) >= 0.0 { 1.0 } else { -1.0 };
    let (s, t) = (a.throw, same_way * b.throw);
    s * t > 0.0 && s.abs() < 3.0 * t.abs() + 2.0 && t.abs() < 3.0 * s.abs() + 2.0
}

/// Groups the pairs of one horizon into traces, and drops those below the smallest length.
pub(super) fn along_strike(pairs: Vec<Pair>, settings: &ProposeSettings) -> Vec<Vec<Pair>> {
    let mut sets = UnionFind::new(pairs.len());
    let mut order: Vec<usize> = (0..pairs.len()).collect();
    order.sort_by(|&a, &b| pairs[a].at[0].total_cmp(&pairs[b].at[0]).then(a.cmp(&b)));
    for (k, &a) in order.iter().enumerate() {
        for &b in &order[k + 1..] {
            let way = place(&pairs[b]) - place(&pairs[a]);
            if way.x > STEP {
                break;
            }
            let parallel = pairs[a].across.dot(pairs[b].across).abs() >= PARALLEL;
            if way.length() <= STEP && parallel && alike(&pairs[a], &pairs[b]) {
                sets.union(a as u32, b as u32);
            }
        }
    }
    let long = |trace: &Vec<Pair>| {
        let across = mean_across(trace);
        let along: Vec<f32> = trace.iter().map(|pair| place(pair).dot(across.perp())).collect();
        let (low, high) = along.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)));
        high - low >= settings.min_length
    };
    groups(sets, pairs).into_iter().filter(long).collect()
}

/// Groups the traces of all horizons that lie on one steep surface. Returns the pairs of each fault, all with
/// `across` pointing to the same side.
pub(super) fn across_horizons(traces: Vec<Vec<Pair>>, metric: DMat3, settings: &ProposeSettings) -> Vec<Vec<Pair>> {
    // Nearest in depth first: a trace is matched most reliably with its neighbour above or below.
    let mut links: Vec<(f64, usize, usize)> = Vec::new();
    for a in 0..traces.len() {
        for b in a + 1..traces.len() {
            if let Some(depth_m) = one_fault(&traces[a], &traces[b], metric, settings) {
                links.push((depth_m, a, b));
            }
        }
    }
    links.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut sets = UnionFind::new(traces.len());
    for (_, a, b) in links {
        let mut of = |trace: usize| -> (u32, Vec<usize>) {
            let root = sets.find(trace as u32);
            (root, (0..traces.len()).filter(|&n| sets.find(n as u32) == root).collect())
        };
        let ((a, left), (b, right)) = (of(a), of(b));
        let apart = left.iter().any(|&l| right.iter().any(|&r| side_by_side(&traces[l], &traces[r])));
        if a != b && !apart {
            sets.union(a, b);
        }
    }
    groups(sets, traces)
        .into_iter()
        .map(|traces| {
            let mut pairs: Vec<Pair> = traces.concat();
            let across = mean_across(&pairs);
            for pair in &mut pairs {
                if pair.across.dot(across) < 0.0 {
                    (pair.across, pair.throw) = (-pair.across, -pair.throw);
                }
            }
            pairs
        })
        .collect()
}

/// Whether two traces run beside one another on one horizon, so that they belong to two faults.
fn side_by_side(a: &[Pair], b: &[Pair]) -> bool {
    a.iter().any(|p| {
        b.iter().any(|q| {
            let way = place(q) - place(p);
            p.horizon == q.horizon && way.perp_dot(p.across).abs() <= STEP && way.dot(p.across).abs() > BESIDE
        })
    })
}

/// The mean distance in depth (m) of two traces that lie one above the other on a steep surface, or one
/// behind the other on one horizon; `None` for other traces.
fn one_fault(a: &[Pair], b: &[Pair], metric: DMat3, settings: &ProposeSettings) -> Option<f64> {
    let (shorter, longer) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    let bin_m = 0.5 * (metric.x_axis.length() + metric.y_axis.length());
    let least_run = 1.0 / settings.min_dip_deg.to_radians().tan();
    let mut offsets = Vec::new();
    let mut depth_m = 0.0;
    for pair in shorter {
        // The pair of the longer trace straight across from this one.
        let across = pair.across;
        let opposite = longer.iter().filter(|other| {
            (place(other) - place(pair)).perp_dot(across).abs() <= STEP && other.across.dot(across).abs() >= PARALLEL
        });
        let off = |other: &&Pair| (place(other) - place(pair)).dot(across).abs();
        if let Some(other) = opposite.min_by(|a, b| off(a).total_cmp(&off(b))).filter(|other| alike(pair, other)) {
            let flip = if across.dot(mean_across(shorter)) >= 0.0 { 1.0 } else { -1.0 };
            offsets.push(f64::from(flip * (place(other) - place(pair)).dot(across)));
            depth_m += f64::from(other.at[2] - pair.at[2]).abs() * metric.z_axis.z;
        }
    }
    if (offsets.len() as f64) < COMMON * shorter.len() as f64 || offsets.len() < 3 {
        return None;
    }
    depth_m /= offsets.len() as f64;
    offsets.sort_by(f64::total_cmp);
    let at = |share: f64| offsets[((offsets.len() - 1) as f64 * share) as usize];
    let steep = at(0.5).abs() * bin_m <= least_run * depth_m + 3.0 * bin_m;
    (steep && at(0.85) - at(0.15) <= SPREAD + 0.15 * depth_m / bin_m).then_some(depth_m)
}

/// The mean direction across, up to its sign: the main axis of all directions, by averaging doubled angles.
fn mean_across(pairs: &[Pair]) -> Vec2 {
    let doubled: Vec2 = pairs.iter().map(|pair| pair.across.rotate(pair.across)).sum();
    Vec2::from_angle(0.5 * doubled.to_angle())
}

fn place(pair: &Pair) -> Vec2 {
    Vec2::new(pair.at[0], pair.at[1])
}

/// The horizontal metric direction across: the normal of the metric image of the strike.
pub(super) fn across_m(pairs: &[Pair], metric: DMat3) -> DVec2 {
    let strike = mean_across(pairs).perp();
    let along = metres(metric, [strike.x, strike.y, 0.0]).truncate().normalize();
    let across = along.perp();
    let towards = mean_across(pairs);
    let towards = metres(metric, [towards.x, towards.y, 0.0]).truncate();
    if across.dot(towards) < 0.0 { -across } else { across }
}

/// The members of each set; sets are ordered by their first member.
fn groups<T>(mut sets: UnionFind, members: Vec<T>) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = members.iter().map(|_| Vec::new()).collect();
    for (n, member) in members.into_iter().enumerate() {
        groups[sets.find(n as u32) as usize].push(member);
    }
    groups.into_iter().filter(|group| !group.is_empty()).collect()
}
