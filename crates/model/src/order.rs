//! Keeps conformable horizons in order.
//!
//! It is an error when the picks of two horizons that must not cross do so by more than a tolerance. Where
//! continued parts cross, they are moved: a continued node to the picked one, two continued nodes to their
//! mean. Crossings within the tolerance are left in the sheets and resolved by the contact rules (the younger
//! horizon ends at the older).

use super::contacts::ContactRules;
use super::lattice::MarginLattice;
use super::network::FaultNetwork;
use super::report::{ModelError, ModelNote};
use super::settings::ModelSettings;
use super::sheets::ExtendedSheet;
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
    let mut notes = Vec::new();
    let blocks = sheets.first().map_or(0, Vec::len);
    for b in 0..blocks {
        let pairs: Vec<(usize, usize)> = (0..sheets.len())
            .flat_map(|h| (h + 1..sheets.len()).map(move |g| (h, g)))
            .filter(|&(h, g)| !rules.may_cross(h, g))
            .collect();
        // Where all horizons lie in order, no pair crosses.
        let is_mixed = |n: &usize| sheets.windows(2).any(|pair| pair[0][b].field.z[*n] > pair[1][b].field.z[*n]);
        let mixed: Vec<usize> = (0..lattice.len()).filter(is_mixed).collect();
        for &(h, g) in pairs.iter().filter(|_| !mixed.is_empty()) {
            check(geometry, lattice, names, sheets, (h, g), (b, &mixed), settings)?;
        }
        let mut clamped = vec![(0usize, 0.0f32); pairs.len()];
        for n in mixed {
            // Pulling one pair together can push it over a third; a few rounds settle it.
            for _ in 0..sheets.len() {
                let mut moved = false;
                for (pair, &(h, g)) in pairs.iter().enumerate() {
                    let (top, base) = (sheets[h][b].field.z[n], sheets[g][b].field.z[n]);
                    let fixed = (sheets[h][b].known[n], sheets[g][b].known[n]);
                    if top <= base || fixed == (true, true) {
                        continue;
                    }
                    let meet = match fixed {
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

/// An error when picks of `pair` cross in block `b`, at one of the nodes `mixed`.
fn check(
    geometry: &SurveyGeometry,
    lattice: MarginLattice,
    names: &[&str],
    sheets: &[Vec<ExtendedSheet>],
    pair: (usize, usize),
    (b, mixed): (usize, &[usize]),
    settings: &ModelSettings,
) -> Result<(), ModelError> {
    let (top, base) = (&sheets[pair.0][b], &sheets[pair.1][b]);
    let (mut nodes, mut worst, mut place) = (0, 0.0f32, 0);
    for &n in mixed {
        let crossing = top.field.z[n] - base.field.z[n];
        if top.known[n] && base.known[n] && crossing > settings.crossing_tolerance {
            nodes += 1;
            if crossing > worst {
                (worst, place) = (crossing, n);
            }
        }
    }
    if nodes <= settings.crossing_nodes {
        return Ok(());
    }
    let [x, y] = lattice.voxel(place).map(f64::from);
    Err(ModelError::CrossingHorizons {
        younger: names[pair.0].to_owned(),
        older: names[pair.1].to_owned(),
        block: b as u16,
        nodes,
        worst,
        lines: geometry.lines_from_voxel(glam::DVec2::new(x, y)).to_array(),
    })
}
