//! Hubs that mean the same event become one: of the same kind, of nearly the same time, and nowhere over one another
//! inside a block.

use crate::hubs::Hubs;
use crate::links::Links;
use rayon::prelude::*;

/// A group of hubs that is growing.
struct HubGroup {
    /// Mean time, and how many vertices it is of.
    time: f64,
    count: usize,
    /// The places that it covers: trace and part of the trace between faults, ascending.
    places: Vec<u64>,
}

/// Count of places in common of two ascending lists, at most `enough`.
fn common(a: &[u64], b: &[u64], enough: usize) -> usize {
    let (short, long) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    let mut found = 0;
    let mut from = 0;
    for place in short {
        from += long[from..].partition_point(|other| other < place);
        if long.get(from) == Some(place) {
            found += 1;
            if found >= enough {
                break;
            }
        }
    }
    found
}

/// Share of the smaller of two hubs that may lie over the other.
const OVERLAP: f64 = 0.02;

/// Joins hubs whose times differ by less than `tolerance` samples; returns how many are left. `times` are those of the
/// vertices.
pub(crate) fn merge(hubs: &mut Hubs, links: &Links, times: &[f32], tolerance: f64) -> usize {
    let means = hubs.means(times);
    let places = places(hubs, links);
    let mut order: Vec<usize> = (0..hubs.len()).collect();
    order.sort_by_key(|&hub| (std::cmp::Reverse(hubs.of_hub(hub).len()), hub));
    let mut groups: Vec<HubGroup> = Vec::new();
    // Groups by kind and whole samples of time.
    let mut shelves: std::collections::BTreeMap<(interp::Extremum, i64), Vec<usize>> =
        std::collections::BTreeMap::new();
    let mut group_of = vec![0u32; hubs.len()];
    for hub in order {
        let own: Vec<u64> = hubs.of_hub(hub).iter().map(|&v| places[v as usize]).collect();
        let (kind, time) = (hubs.kind[hub], f64::from(means[hub]));
        let shelf = time.floor() as i64;
        let reach = tolerance.ceil() as i64;
        let mut near: Vec<usize> = (shelf - reach..=shelf + reach)
            .filter_map(|shelf| shelves.get(&(kind, shelf)))
            .flatten()
            .copied()
            .collect();
        near.retain(|&group| (groups[group].time - time).abs() < tolerance);
        near.sort_by(|&a, &b| (groups[a].time - time).abs().total_cmp(&(groups[b].time - time).abs()).then(a.cmp(&b)));
        let fits = |&&group: &&usize| {
            let most = (OVERLAP * own.len().min(groups[group].places.len()) as f64) as usize + 1;
            common(&own, &groups[group].places, most) < most
        };
        match near.iter().find(fits) {
            Some(&group) => {
                let into = &mut groups[group];
                let sum = into.time * into.count as f64 + time * own.len() as f64;
                into.count += own.len();
                into.time = sum / into.count as f64;
                into.places.extend(own);
                // Two ascending runs: the stable sort merges them in one pass.
                into.places.sort();
                group_of[hub] = group as u32;
            }
            None => {
                group_of[hub] = groups.len() as u32;
                shelves.entry((kind, shelf)).or_default().push(groups.len());
                groups.push(HubGroup { time, count: own.len(), places: own });
            }
        }
    }
    hubs.relabel(&group_of);
    groups.len()
}

/// Trace and part of the trace of every vertex.
fn places(hubs: &Hubs, links: &Links) -> Vec<u64> {
    let [_, ny, nz] = hubs.size;
    let mut places = vec![0; hubs.z.len()];
    hubs.split_inlines(&mut places).into_par_iter().enumerate().for_each(|(x, places)| {
        let mut places = places.iter_mut();
        for trace in x * ny..(x + 1) * ny {
            let (mut part, mut at) = (0u64, 0usize);
            for (v, place) in hubs.on_trace(trace).zip(&mut places) {
                while at < (hubs.z[v] as usize).min(nz - 1) {
                    part += u64::from(links.is_cut_below(trace * nz + at));
                    at += 1;
                }
                *place = (trace as u64) << 8 | part.min(255);
            }
        }
    });
    places
}
