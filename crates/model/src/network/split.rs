//! A fault that turns too far for one plane, cut into parts each of which lies over a plane of its own.
//!
//! Parts without a common edge come apart first. Then the triangles are divided by their normals, averaged over those
//! around: along the direction in which normals differ most, at the place that makes two groups (2-means). What no longer
//! hangs together is a part of its own. A part that still folds is divided again.
//!
//! Of two neighbours the smaller one ends at the larger one, where it lies on one side of it: beyond the seam each part is
//! continued, virtually, and one that ends at the other does not divide what lies behind.

use super::build::{self, Soup, smallest_eigenvector};
use super::facing;
use crate::report::ModelError;
use glam::{DMat3, DVec3};
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

/// Most parts into which a fault is cut.
pub const MOST_PARTS: usize = 8;
/// A part smaller than this share of the fault is given to a neighbour, or left out where it has none.
const SLIVER: f64 = 0.02;
/// Times that normals are averaged with those of their neighbours.
const AVERAGED: usize = 12;
/// Times that a triangle takes the side of most of its neighbours.
const TIDIED: usize = 4;
/// Share of a part's vertices that must lie on one side of the part at which it ends.
const ON_ONE_SIDE: f64 = 0.95;
/// Distance from a part within which vertices count for both sides, cells.
const ON_IT: f64 = 2.0;

/// A part of a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct FaultPart {
    /// Its surface, in world coordinates.
    pub mesh: TriangleMesh,
    /// The part at which it ends.
    pub ends_at: Option<usize>,
}

/// How far the surface of a fault lies off what was drawn, m, where that folds and was smoothed: nine tenths of it lie
/// nearer. `None` where it does not fold.
///
/// # Errors
/// [`ModelError`] for a fault without area, or one that no single surface fits.
pub fn fit_of(geometry: &SurveyGeometry, fault: &Fault) -> Result<Option<f64>, ModelError> {
    build::drawn(geometry, fault).map(|(built, _)| built.off_m)
}

/// Cuts a fault into parts that each have a surface, the largest first; one that has a surface is its only part.
///
/// # Errors
/// [`ModelError`] for a fault without area, or one that cannot be cut into a few parts.
pub fn split(geometry: &SurveyGeometry, fault: &Fault) -> Result<Vec<FaultPart>, ModelError> {
    let folded = match fit_of(geometry, fault) {
        Ok(_) => return Ok(vec![FaultPart { mesh: fault.mesh.clone(), ends_at: None }]),
        Err(error @ ModelError::FoldedFault { .. }) => error,
        Err(error) => return Err(error),
    };
    let soup = Soup::of(geometry, fault);
    let least = SLIVER * soup.area();
    let mut left = vec![(0..soup.triangles.len()).collect::<Vec<usize>>()];
    let mut parts: Vec<Vec<usize>> = Vec::new();
    while let Some(part) = left.pop() {
        let own = soup.only(&part);
        if fit_of(geometry, &Fault::new("", mesh_of(fault, &own))).is_ok() {
            parts.push(part);
        } else {
            let halves = divided(&own, least);
            if halves.len() < 2 || left.len() + parts.len() + halves.len() > MOST_PARTS {
                return Err(folded);
            }
            left.extend(halves.into_iter().map(|half| half.into_iter().map(|t| part[t]).collect::<Vec<usize>>()));
        }
    }
    let area = |part: &[usize]| part.iter().map(|&t| soup.normal(soup.triangles[t]).length()).sum::<f64>();
    parts.sort_by(|a, b| area(b).total_cmp(&area(a)).then(a[0].cmp(&b[0])));
    parts.iter_mut().for_each(|part| part.sort_unstable());
    let ends = ends(geometry, fault, &soup, &parts)?;
    let part =
        |(part, ends_at): (&Vec<usize>, Option<usize>)| FaultPart { mesh: mesh_of(fault, &soup.only(part)), ends_at };
    Ok(parts.iter().zip(ends).map(part).collect())
}

/// The triangles of a soup as a mesh without unused vertices.
fn mesh_of(fault: &Fault, soup: &Soup) -> TriangleMesh {
    let mut place = vec![u32::MAX; soup.points.len()];
    let mut mesh = TriangleMesh::default();
    let mut vertex = |v: usize| {
        if place[v] == u32::MAX {
            place[v] = mesh.vertices.len() as u32;
            mesh.vertices.push(fault.mesh.vertices[v]);
        }
        place[v]
    };
    let triangles = soup.triangles.iter().map(|t| t.map(&mut vertex)).collect();
    mesh.triangles = triangles;
    mesh
}

/// Divides triangles into parts that hang together; fewer than two where they cannot be divided.
fn divided(soup: &Soup, least: f64) -> Vec<Vec<usize>> {
    let beside = facing::neighbours(soup);
    let area = |part: &Vec<usize>| part.iter().map(|&t| soup.normal(soup.triangles[t]).length()).sum::<f64>();
    let mut apart = facing::connected(&beside, |_, _| true, |_, _| {});
    if apart.len() > 1 {
        apart.retain(|part| area(part) >= least);
        return apart;
    }
    let mut side = sides(soup, &beside);
    for _ in 0..TIDIED {
        let before = side.clone();
        for (t, side) in side.iter_mut().enumerate() {
            let others = beside[t].iter().filter(|&&n| before[n] != before[t]).count();
            *side ^= 2 * others > beside[t].len();
        }
    }
    // Slivers take the side of what is around them.
    let slivers = facing::connected(&beside, |a, b| side[a] == side[b], |_, _| {});
    slivers.iter().filter(|part| area(part) < least).flatten().for_each(|&t| side[t] = !side[t]);
    facing::connected(&beside, |a, b| side[a] == side[b], |_, _| {})
}

/// Of each triangle, in which of two groups its normal is.
fn sides(soup: &Soup, beside: &[Vec<usize>]) -> Vec<bool> {
    let mut normals = facing::oriented(soup);
    for _ in 0..AVERAGED {
        let before = normals.clone();
        for (t, n) in normals.iter_mut().enumerate() {
            *n += beside[t].iter().map(|&b| before[b]).sum::<DVec3>();
            *n /= 1.0 + beside[t].len() as f64;
        }
    }
    let weights: Vec<f64> = soup.triangles.iter().map(|&t| soup.normal(t).length()).collect();
    let units: Vec<DVec3> = normals.iter().map(|n| n.normalize_or_zero()).collect();
    let total: f64 = weights.iter().sum();
    let mean = units.iter().zip(&weights).map(|(n, w)| *n * *w).sum::<DVec3>() / total;
    let spread = units.iter().zip(&weights).fold(DMat3::ZERO, |sum, (n, w)| {
        let d = *n - mean;
        sum + DMat3::from_cols(d * d.x, d * d.y, d * d.z) * *w
    });
    let axis = smallest_eigenvector(spread * -1.0);
    let along: Vec<f64> = units.iter().map(|n| n.dot(axis)).collect();
    let mut limit = mean.dot(axis);
    for _ in 0..20 {
        let group = |above: bool| {
            let own = || along.iter().zip(&weights).filter(|(a, _)| (**a > limit) == above);
            let weight: f64 = own().map(|(_, w)| w).sum();
            own().map(|(a, w)| a * w).sum::<f64>() / weight.max(f64::MIN_POSITIVE)
        };
        limit = 0.5 * (group(true) + group(false));
    }
    along.iter().map(|a| *a > limit).collect()
}

/// At which larger part each part ends.
fn ends(
    geometry: &SurveyGeometry,
    fault: &Fault,
    soup: &Soup,
    parts: &[Vec<usize>],
) -> Result<Vec<Option<usize>>, ModelError> {
    let mut part_of = vec![usize::MAX; soup.triangles.len()];
    parts.iter().enumerate().for_each(|(k, part)| part.iter().for_each(|&t| part_of[t] = k));
    let beside = facing::neighbours(soup);
    let meets = |a: usize, b: usize| parts[a].iter().any(|&t| beside[t].iter().any(|&n| part_of[n] == b));
    let faults: Vec<Fault> = parts.iter().map(|part| Fault::new("", mesh_of(fault, &soup.only(part)))).collect();
    ends_of_parts(geometry, &faults, meets)
}

/// At which part before it each of the parts of a fault ends, of those that it meets.
///
/// # Errors
/// [`ModelError`] for a part that no single surface fits.
pub fn ends_of_parts(
    geometry: &SurveyGeometry,
    parts: &[Fault],
    meets: impl Fn(usize, usize) -> bool,
) -> Result<Vec<Option<usize>>, ModelError> {
    let built = parts.iter().map(|part| build::build(geometry, part)).collect::<Result<Vec<_>, _>>()?;
    // Share of a part on the positive side of another, of its vertices that lie clearly on one.
    let positive = |part: usize, of: usize| {
        let surface = &built[of].surface;
        let sides = built[part].vertices.iter().map(|v| surface.side(*v));
        let clear: Vec<f64> = sides.filter(|side| side.abs() > ON_IT * surface.spacing_m).collect();
        let above = clear.iter().filter(|side| **side > 0.0).count();
        if clear.is_empty() { 0.5 } else { above as f64 / clear.len() as f64 }
    };
    let mut ends: Vec<Option<usize>> = vec![None; parts.len()];
    for part in 1..parts.len() {
        let may_end_at = |&at: &usize| {
            let share = positive(part, at);
            // Where the other one does not exist, neither does what ends at it.
            let (mut below, mut up) = (at, ends[at]);
            let mut is_there = share.max(1.0 - share) >= ON_ONE_SIDE;
            while let Some(parent) = up {
                is_there &= (positive(below, parent) >= 0.5) == (positive(part, parent) >= 0.5);
                (below, up) = (parent, ends[parent]);
            }
            is_there
        };
        ends[part] = (0..part).filter(|&at| meets(part, at)).find(may_end_at);
    }
    Ok(ends)
}
