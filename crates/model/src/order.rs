//! Keeps conformable horizons in order.
//!
//! It is an error when the picks of two horizons that must not cross do so by more than a tolerance, at more than a few
//! nodes and a small share of those that both have. Where fewer cross, the contact rules resolve it (the younger horizon
//! ends at the older), and a note says so. Where continued parts cross, they are moved: a continued node to the picked one,
//! two continued nodes to their mean.

use super::contacts::ContactRules;
use super::lattice::MarginLattice;
use super::network::FaultNetwork;
use super::report::{ModelError, ModelNote};
use super::settings::ModelSettings;
use super::sheets::ExtendedSheet;
use rayon::prelude::*;
use survey::geometry::SurveyGeometry;

/// Checks the picks and moves continued nodes that cross, `[horizon][block]`. `faults` tells where a moved
/// node is inside its block.
pub(super) fn keep_order(
    geometry: &SurveyGeometry,
    lattice: MarginLattice,
    rules: &ContactRules,
    names: &[&str],
    sheets: &mut [Vec<ExtendedSheet>],
    settings: &ModelSettings,
    faults: &FaultNetwork,
) -> Result<Vec<ModelNote>, ModelError> {
    // What was stated past the end of the picks may be moved as what is continued here.
    let fixed: Vec<Vec<Vec<bool>>> =
        sheets.iter().map(|of| of.iter().map(|sheet| sheet.fixed.clone()).collect()).collect();
    let picked: Vec<Vec<Picks>> = sheets
        .iter()
        .zip(&fixed)
        .map(|(of, fixed)| of.iter().zip(fixed).map(|(sheet, fixed)| (&sheet.field.z[..], &fixed[..])).collect())
        .collect();
    let mut notes = check(geometry, lattice, rules, names, &picked, settings)?;
    let blocks = sheets.first().map_or(0, Vec::len);
    let pairs = pairs_in_order(rules, sheets.len());
    for b in 0..blocks {
        // Where all horizons lie in order, no pair crosses.
        let is_mixed = |n: &usize| sheets.windows(2).any(|pair| pair[0][b].field.z[*n] > pair[1][b].field.z[*n]);
        let mixed: Vec<usize> = (0..lattice.len()).filter(is_mixed).collect();
        let mut clamped = vec![(0usize, 0.0f32); pairs.len()];
        for n in mixed {
            // Pulling one pair together can push it over a third; a few rounds settle it.
            for _ in 0..sheets.len() {
                let mut moved = false;
                for (pair, &(h, g)) in pairs.iter().enumerate() {
                    let (top, base) = (sheets[h][b].field.z[n], sheets[g][b].field.z[n]);
                    let both = (fixed[h][b][n], fixed[g][b][n]);
                    if top <= base || both == (true, true) {
                        continue;
                    }
                    let meet = match both {
                        (true, false) => top,
                        (false, true) => base,
                        _ => 0.5 * (top + base),
                    };
                    sheets[h][b].field.z[n] = meet;
                    sheets[g][b].field.z[n] = meet;
                    moved = true;
                    if lattice.is_inside(n) && faults.holds(b as u16, lattice.place(n, meet)) {
                        clamped[pair].0 += 1;
                        clamped[pair].1 = clamped[pair].1.max(top - base);
                    }
                }
                if !moved {
                    break;
                }
            }
        }
        for (&(h, g), &(nodes, worst)) in pairs.iter().zip(&clamped) {
            if nodes > 0 {
                let (younger, older) = (names[h].to_owned(), names[g].to_owned());
                notes.push(ModelNote::Clamped { younger, older, block: b as u16, nodes, worst });
            }
        }
    }
    Ok(notes)
}

/// Heights on a lattice, and which of them are picks.
pub(super) type Picks<'a> = (&'a [f32], &'a [bool]);

/// Picks that cross at no more than this share of the nodes that both horizons have are resolved. It is the share that a
/// horizon may seem to cross another one when it is added.
const RESOLVED_SHARE: f64 = 0.02;

/// The pairs of horizons, younger and older, that may not cross.
fn pairs_in_order(rules: &ContactRules, count: usize) -> Vec<(usize, usize)> {
    let pairs = (0..count).flat_map(|h| (h + 1..count).map(move |g| (h, g)));
    pairs.filter(|&(h, g)| !rules.may_cross(h, g)).collect()
}

/// Where the picks of two horizons cross.
#[derive(Default)]
struct Crossing {
    nodes: usize,
    worst: f32,
    /// The node and the block of the worst.
    place: (usize, usize),
}

/// An error when picks, `[horizon][block]`, cross where they must not; notes of what the contact rules resolve.
pub(super) fn check(
    geometry: &SurveyGeometry,
    lattice: MarginLattice,
    rules: &ContactRules,
    names: &[&str],
    picks: &[Vec<Picks>],
    settings: &ModelSettings,
) -> Result<Vec<ModelNote>, ModelError> {
    // Where the picks of all horizons lie in order, no pair crosses.
    let is_mixed = |b: usize, n: usize| {
        let mut deepest = f32::NEG_INFINITY;
        picks.iter().map(|of| of[b]).filter(|(_, known)| known[n]).any(|(z, _)| {
            let is_above = z[n] < deepest;
            deepest = deepest.max(z[n]);
            is_above
        })
    };
    let blocks = picks.first().map_or(0, Vec::len);
    let mixed: Vec<Vec<usize>> =
        (0..blocks).into_par_iter().map(|b| (0..lattice.len()).filter(|&n| is_mixed(b, n)).collect()).collect();
    if mixed.iter().all(Vec::is_empty) {
        return Ok(Vec::new());
    }
    let crossing = |&(h, g): &(usize, usize)| {
        let mut found = Crossing::default();
        for (b, ((top, top_known), (base, base_known))) in picks[h].iter().zip(&picks[g]).enumerate() {
            for &n in &mixed[b] {
                let by = top[n] - base[n];
                if top_known[n] && base_known[n] && by > settings.crossing_tolerance {
                    found.nodes += 1;
                    if by > found.worst {
                        (found.worst, found.place) = (by, (n, b));
                    }
                }
            }
        }
        found
    };
    let common = |h: usize, g: usize| {
        let both =
            |(top, base): (&Picks, &Picks)| top.1.iter().zip(base.1).filter(|(top, base)| **top && **base).count();
        picks[h].iter().zip(&picks[g]).map(both).sum::<usize>()
    };
    let pairs = pairs_in_order(rules, picks.len());
    let found: Vec<Crossing> = pairs.par_iter().map(crossing).collect();
    let mut notes = Vec::new();
    for ((h, g), Crossing { nodes, worst, place: (node, block) }) in pairs.into_iter().zip(found) {
        if nodes <= settings.crossing_nodes {
            continue;
        }
        let [x, y] = lattice.voxel(node).map(f64::from);
        let lines = geometry.lines_from_voxel(glam::DVec2::new(x, y)).to_array();
        let (younger, older) = (names[h].to_owned(), names[g].to_owned());
        if nodes as f64 > RESOLVED_SHARE * common(h, g) as f64 {
            return Err(ModelError::CrossingHorizons { younger, older, block: block as u16, nodes, worst, lines });
        }
        notes.push(ModelNote::Crossed { younger, older, nodes, worst, lines });
    }
    Ok(notes)
}
