//! Which of two horizons is above the other, and whether they cross.
//!
//! The horizons are compared at the traces of the survey. A horizon may have several depths at one trace (at a reverse
//! fault); the shallowest are compared with the shallowest and the deepest with the deepest, because the order holds
//! within each fault block but not between blocks. Fault blocks are not known here, so next to a fault two horizons may
//! seem to cross when they do not. A small share of such traces is tolerated; the structural model, which knows the
//! blocks, decides.

use crate::error::ProjectError;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use survey::{Contact, Horizon, NodeGrid, SurveyGeometry};

/// Share of the common traces that may seem to cross.
const TOLERATED_SHARE: f64 = 0.02;
/// Depth by which the horizons must cross at a trace for the trace to count, samples.
const TOLERANCE_SAMPLES: f32 = 1.0;
/// Points through which a plane is laid.
const NEAREST: usize = 6;
/// Most points that are compared with planes.
const MOST_POINTS: usize = 4096;
/// Least cosine of a plane's dip at which it counts: flat beds are overturned less often than steep ones.
const FLAT_ENOUGH: f64 = 0.7;
/// Determinant of the points' spread over the square of its trace below which they lie in a row.
const IN_A_ROW: f64 = 1e-3;
/// How clearly a horizon lies above another at least, of 1.
const UNCLEAR: f64 = 0.1;
/// Largest number of traces that are compared along each axis.
const TRACES_ENOUGH: usize = 256;

/// Shallowest and deepest value of a horizon at a trace, and the trace.
struct Depths {
    trace: [usize; 2],
    shallow: f32,
    deep: f32,
}

/// How clearly `a` lies above `b`: 1 where it does everywhere, −1 where it lies below. Maps are compared at their common
/// traces, or else by their mean depth. Where one of them is no height field, or both are scattered points whose maps
/// cross, scattered points are compared with planes through those around them, or else topmost places are: the highest
/// limb of a fold is the right way up.
pub(crate) fn lean(a: &Horizon, b: &Horizon, geometry: &SurveyGeometry) -> f64 {
    if a.any_shape().is_some() || b.any_shape().is_some() {
        return lean_of_shapes(a, b, geometry);
    }
    let (mut above, mut below, mut difference) = (0usize, 0usize, 0.0f64);
    for (a, b) in common_traces(a, b, geometry) {
        let by = f64::from(a.shallow + a.deep - b.shallow - b.deep);
        difference += by;
        above += usize::from(by < 0.0);
        below += usize::from(by > 0.0);
    }
    let (common, lesser) = (above + below, above.min(below));
    if lesser as f64 > TOLERATED_SHARE * common as f64
        && a.surface.is_some()
        && b.surface.is_some()
        && let Some(lean) = lean_of_planes(a, b, geometry)
    {
        return lean;
    }
    let clearly = if common > 0 { (1.0 - 2.0 * lesser as f64 / common as f64).max(UNCLEAR) } else { UNCLEAR };
    let is_above = if common > 0 { difference < 0.0 } else { mean(a) < mean(b) };
    if is_above { clearly } else { -clearly }
}

/// The place of a horizon among `others`, youngest first: where most of them, by how clearly they do, lie on their side.
/// Bodies have none: their contacts say that they cut what is there.
pub(crate) fn place_among(
    horizon: &Horizon,
    others: &[Horizon],
    contacts: &[Contact],
    geometry: &SurveyGeometry,
) -> usize {
    let is_body = |n: usize| contacts[n].is_intrusive() && others[n].any_shape().is_some();
    let lean = |n: usize| if is_body(n) { 0.0 } else { lean(horizon, &others[n], geometry) };
    let leans: Vec<f64> = (0..others.len()).into_par_iter().map(lean).collect();
    // From one place to the next, the horizon between them changes sides.
    let (mut best, mut most, mut sum) = (0, 0.0, 0.0);
    for (n, lean) in leans.into_iter().enumerate() {
        sum -= lean;
        if sum > most {
            (best, most) = (n + 1, sum);
        }
    }
    best
}

/// How clearly scattered points of `a` lie above those of `b`, told where beds are flat enough to be the right way up more
/// often than not, by distances of points from planes through the nearest points of the other horizon. None where too few
/// lie so, or there are so many that their topmost places tell.
fn lean_of_planes(a: &Horizon, b: &Horizon, geometry: &SurveyGeometry) -> Option<f64> {
    let metric = geometry.metric_from_voxel();
    let places = |horizon: &Horizon| -> Option<Vec<DVec3>> {
        let surface = horizon.surface.as_ref()?;
        let is_few = surface.triangles.is_empty() && (NEAREST..MOST_POINTS).contains(&surface.vertices.len());
        let place = |world: &DVec3| metric * geometry.voxel_from_world(*world);
        is_few.then(|| surface.vertices.iter().map(place).collect())
    };
    let (a, b) = (places(a)?, places(b)?);
    let over = |places: &[DVec3], others: &[DVec3]| -> Vec<f64> {
        places.par_iter().filter_map(|p| below_plane(*p, others)).collect()
    };
    let mut below = over(&a, &b);
    below.extend(over(&b, &a).into_iter().map(|distance| -distance));
    let above = below.iter().filter(|distance| **distance < 0.0).count();
    (below.len() >= NEAREST).then(|| 2.0 * above as f64 / below.len() as f64 - 1.0)
}

/// How far a place lies below the plane through the nearest points, along its normal; none where that plane is steep, or the
/// points lie in a row.
fn below_plane(place: DVec3, points: &[DVec3]) -> Option<f64> {
    let mut nearest: Vec<DVec3> = points.to_vec();
    nearest.select_nth_unstable_by(NEAREST - 1, |p, q| {
        p.distance_squared(place).total_cmp(&q.distance_squared(place)).then(p.z.total_cmp(&q.z))
    });
    let nearest = &nearest[..NEAREST];
    let centre = nearest.iter().sum::<DVec3>() / NEAREST as f64;
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    let mut z = DVec2::ZERO;
    for p in nearest.iter().map(|p| p - centre) {
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
        z += p.truncate() * p.z;
    }
    let determinant = xx * yy - xy * xy;
    if determinant < IN_A_ROW * (xx + yy) * (xx + yy) {
        return None;
    }
    let slope = DVec2::new(z.x * yy - z.y * xy, z.y * xx - z.x * xy) / determinant;
    let upright = (1.0 + slope.length_squared()).sqrt().recip();
    let from = place - centre;
    (upright >= FLAT_ENOUGH).then(|| (from.z - slope.dot(from.truncate())) * upright)
}

/// Cells along each side of the map in which topmost places are compared.
const CELLS: usize = 8;

/// Whether `a` lies above `b` where beds are the right way up.
pub(crate) fn is_topmost(a: &Horizon, b: &Horizon, geometry: &SurveyGeometry) -> bool {
    lean_of_shapes(a, b, geometry) > 0.0
}

/// How clearly `a` lies above `b` where beds are the right way up: by planes through scattered points, else by the topmost
/// places of both on the map.
fn lean_of_shapes(a: &Horizon, b: &Horizon, geometry: &SurveyGeometry) -> f64 {
    if let Some(lean) = lean_of_planes(a, b, geometry) {
        return lean;
    }
    let (tops_a, tops_b) = (tops(a, geometry), tops(b, geometry));
    let common = || tops_a.iter().zip(&tops_b).filter(|(a, b)| a.is_finite() && b.is_finite());
    let count = common().count();
    if count == 0 {
        return if lowest(&tops_a) < lowest(&tops_b) { UNCLEAR } else { -UNCLEAR };
    }
    let difference: f64 = common().map(|(a, b)| a - b).sum();
    let lesser = common().filter(|(a, b)| (*a - *b) * difference < 0.0).count();
    let clearly = (1.0 - 2.0 * lesser as f64 / count as f64).max(UNCLEAR);
    if difference < 0.0 { clearly } else { -clearly }
}

fn lowest(tops: &[f64]) -> f64 {
    tops.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The topmost place in each cell of the map, voxel z: of the points that a horizon was given by, where it has any, for
/// the map between them may join limbs of a fold.
fn tops(horizon: &Horizon, geometry: &SurveyGeometry) -> Vec<f64> {
    let corners = horizon.surface.iter().flat_map(|surface| surface.vertices.iter().copied());
    let sheets = if horizon.surface.is_some() { &[] } else { horizon.sheets.as_slice() };
    let nodes = sheets.iter().flat_map(|sheet| {
        let nv = sheet.grid.count[1];
        let known = sheet.depth.iter().enumerate().filter(|(_, depth)| depth.is_finite());
        known.map(move |(n, depth)| {
            sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64)).extend(f64::from(*depth))
        })
    });
    let [nx, ny, _] = geometry.size();
    let mut tops = vec![f64::INFINITY; CELLS * CELLS];
    for p in corners.chain(nodes).map(|place| geometry.voxel_from_world(place)) {
        let cell = |c: f64, count: usize| ((c / count as f64 * CELLS as f64).max(0.0) as usize).min(CELLS - 1);
        let top = &mut tops[cell(p.x, nx) * CELLS + cell(p.y, ny)];
        *top = top.min(p.z);
    }
    tops
}

fn mean(horizon: &Horizon) -> f64 {
    let depths = || horizon.sheets.iter().flat_map(|sheet| &sheet.depth).filter(|depth| depth.is_finite());
    depths().map(|depth| f64::from(*depth)).sum::<f64>() / depths().count().max(1) as f64
}

/// Refuses two horizons of which the younger lies below the older.
///
/// # Errors
/// [`ProjectError::Crossing`] with the place and the amount.
pub(crate) fn check(younger: &Horizon, older: &Horizon, geometry: &SurveyGeometry) -> Result<(), ProjectError> {
    let tolerance = TOLERANCE_SAMPLES * geometry.vertical.interval as f32;
    let (mut common, mut crossing) = (0usize, 0usize);
    let (mut worst, mut place) = (0.0f32, [0usize; 2]);
    for (young, old) in common_traces(younger, older, geometry) {
        common += 1;
        let by = (young.shallow - old.shallow).min(young.deep - old.deep);
        if by > tolerance {
            crossing += 1;
            if by > worst {
                (worst, place) = (by, young.trace);
            }
        }
    }
    if crossing as f64 <= TOLERATED_SHARE * common as f64 {
        return Ok(());
    }
    let lines = geometry.lines_from_voxel(DVec2::new(place[0] as f64, place[1] as f64));
    Err(ProjectError::Crossing {
        younger: younger.name.clone(),
        older: older.name.clone(),
        share: crossing as f64 / common as f64,
        worst,
        unit: geometry.vertical.unit.symbol(),
        lines: lines.to_array(),
    })
}

/// The depths of both horizons at the traces where both have some.
fn common_traces<'a>(
    a: &'a Horizon,
    b: &'a Horizon,
    geometry: &'a SurveyGeometry,
) -> impl Iterator<Item = (Depths, Depths)> + 'a {
    let grid = NodeGrid::of_survey(geometry);
    let steps = grid.count.map(|count| count.div_ceil(TRACES_ENOUGH).max(1));
    let traces = (0..grid.count[0]).step_by(steps[0]);
    let traces = traces.flat_map(move |x| (0..grid.count[1]).step_by(steps[1]).map(move |y| [x, y]));
    // Most horizons have a node at each trace, which is read as it is: a place is looked up ten times as slowly.
    let [own_a, own_b] = [a, b].map(|horizon| horizon.sheets.iter().all(|sheet| sheet.grid == grid));
    traces.filter_map(move |trace| Some((depths(a, own_a, &grid, trace)?, depths(b, own_b, &grid, trace)?)))
}

fn depths(horizon: &Horizon, has_nodes: bool, grid: &NodeGrid, trace: [usize; 2]) -> Option<Depths> {
    let [x, y] = trace;
    let world = grid.world_at(DVec2::new(x as f64, y as f64));
    let values = horizon.sheets.iter().map(|sheet| match has_nodes {
        true => sheet.depth[x * grid.count[1] + y],
        false => sheet.depth_at_node(sheet.grid.node_at(world)),
    });
    let (shallow, deep) = values
        .filter(|depth| depth.is_finite())
        .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), depth| (low.min(depth), high.max(depth)));
    (shallow <= deep).then_some(Depths { trace, shallow, deep })
}

#[cfg(test)]
mod tests;
