//! Strays of an event are laid on the reflection that lies on the plane of their neighbours, or on that plane.

use super::grid::Grid;
use crate::cuts::Cut;
use crate::event::Support;
use crate::reflections::Reflections;
use interp::Extremum;

/// Traces around a stray that tell where the event lies there, least share of them, and how far from their plane most of
/// them may lie, samples.
const MENDING: isize = 3;
const LEAST_AROUND: f32 = 0.4;
const FLAT: f32 = 1.5;
/// Distance from the plane of its neighbours within which a stray goes to a reflection, samples.
const MENDED: f32 = 2.0;
/// Distance of most neighbours from their plane up to which a stray lies on it where nothing reflects, samples.
const EVEN: f32 = 0.75;
/// Rounds of mending: what was mended tells of what lies next to it.
pub(super) const ROUNDS: usize = 4;

/// Where a stray belongs: on the reflection of its trace that lies on the plane of what is kept around it on the same side of
/// every fault, or on that plane itself where its neighbours lie close to it; `None`: nothing tells.
pub(super) fn mended(
    grid: &Grid<'_>,
    stray: usize,
    is_kept: impl Fn(usize) -> bool,
    kind: Option<Extremum>,
    reflections: &Reflections,
    cuts: &[Cut],
) -> Option<(f32, Support)> {
    let trace = grid.trace(stray);
    let mut around: Vec<[f32; 3]> = Vec::new();
    for (i, j) in (-MENDING..=MENDING).flat_map(|i| (-MENDING..=MENDING).map(move |j| (i, j))) {
        let at = [trace[0].checked_add_signed(i), trace[1].checked_add_signed(j)];
        let [Some(x), Some(y)] = at else { continue };
        if x >= grid.count[0] || y >= grid.count[1] || [x, y] == trace {
            continue;
        }
        let own = grid.on([x, y]).filter(|&n| is_kept(n)).map(|n| grid.nodes[n].z);
        let own = own.filter(|&z| !cuts.iter().any(|cut| cut.separates(trace, z, [x, y], z)));
        around.extend(own.map(|z| [i as f32, j as f32, z]));
    }
    let side = (2 * MENDING + 1) as f32;
    if (around.len() as f32) < LEAST_AROUND * side * side {
        return None;
    }
    // The plane z = a + b i + c j by least squares, once more without what lies far from it.
    let (mut z, mut spread) = (0.0, 0.0);
    for _ in 0..2 {
        let [a, b, c] = plane(&around)?;
        let off = |[i, j, at]: &[f32; 3]| (at - a - b * i - c * j).abs();
        let mut all: Vec<f32> = around.iter().map(off).collect();
        all.sort_by(f32::total_cmp);
        if all[all.len() / 2] > FLAT {
            return None;
        }
        around.retain(|place| off(place) <= 3.0 * FLAT);
        (z, spread) = (a, all[all.len() / 2]);
    }
    let found = reflections.nearest(trace, z, kind, MENDED).map(|found| (found.z, Support::Snapped));
    found.or_else(|| (spread <= EVEN).then_some((z, Support::Between)))
}

/// The plane through places, least squares; `None` where they lie on one line.
fn plane(places: &[[f32; 3]]) -> Option<[f32; 3]> {
    let count = places.len() as f32;
    let sum = |of: &dyn Fn(&[f32; 3]) -> f32| places.iter().map(of).sum::<f32>() / count;
    let [i, j, z] = [0, 1, 2].map(|n| sum(&|place| place[n]));
    let product = |a: usize, b: usize| {
        let mean = [i, j, z];
        sum(&|place| (place[a] - mean[a]) * (place[b] - mean[b]))
    };
    let (ii, ij, jj, iz, jz) = (product(0, 0), product(0, 1), product(1, 1), product(0, 2), product(1, 2));
    let determinant = ii * jj - ij * ij;
    if determinant < 1e-3 {
        return None;
    }
    let (b, c) = ((iz * jj - jz * ij) / determinant, (jz * ii - iz * ij) / determinant);
    Some([z - b * i - c * j, b, c])
}
