//! Found faults as proposals, beside those that offset horizons give.

use crate::cuts::{Across, Cut};
use crate::find::FoundFault;
use glam::{DVec2, DVec3};
use interp::faults::Proposal;
use survey::{SurveyGeometry, TriangleMesh};

/// Lines along the fault and samples between nodes of a mesh.
const MESH: [usize; 2] = [4, 6];
/// Median throw, samples, below which a proposal is minor.
const LEAST_THROW: f64 = 1.0;
/// Margin of the throw below which a proposal is minor: another throw would fit nearly as well.
const LEAST_MARGIN: f32 = 0.03;

/// Proposals of found faults, largest first and minor ones last.
pub fn proposals(found: &[FoundFault], geometry: &SurveyGeometry) -> Vec<Proposal> {
    let mut all: Vec<Proposal> = found.iter().filter_map(|fault| proposal(fault, geometry)).collect();
    all.sort_by(|a, b| a.is_minor.cmp(&b.is_minor).then(b.offset_m2.total_cmp(&a.offset_m2)));
    for (n, proposal) in all.iter_mut().enumerate() {
        proposal.id = n as u32 + 1;
        proposal.name = format!("Fault {}", proposal.id);
    }
    all
}

/// Steps from 0 to the last of `count`, which is always there.
fn steps(count: usize, step: usize) -> Vec<usize> {
    let mut all: Vec<usize> = (0..count).step_by(step).collect();
    if all.last().is_some_and(|last| last + 1 < count) {
        all.push(count - 1);
    }
    all
}

/// Voxel position of a node of a cut.
fn node(cut: &Cut, line: usize, z: usize) -> Option<DVec3> {
    let place = f64::from(cut.place[line * cut.size[1] + z]);
    let at = match cut.across {
        Across::Inlines => DVec3::new(place, line as f64, z as f64),
        Across::Crosslines => DVec3::new(line as f64, place, z as f64),
    };
    place.is_finite().then_some(at)
}

fn mesh(cut: &Cut, geometry: &SurveyGeometry) -> TriangleMesh {
    let (lines, depths) = (steps(cut.size[0], MESH[0]), steps(cut.size[1], MESH[1]));
    let mut mesh = TriangleMesh::default();
    let mut index = vec![None; lines.len() * depths.len()];
    for (a, &line) in lines.iter().enumerate() {
        for (b, &z) in depths.iter().enumerate() {
            index[a * depths.len() + b] = node(cut, line, z).map(|voxel| {
                mesh.vertices.push(geometry.world_from_voxel(voxel));
                mesh.vertices.len() as u32 - 1
            });
        }
    }
    for a in 1..lines.len() {
        for b in 1..depths.len() {
            let at = |a: usize, b: usize| index[a * depths.len() + b];
            let corners = [at(a - 1, b - 1), at(a, b - 1), at(a, b), at(a - 1, b)];
            let there: Vec<u32> = corners.into_iter().flatten().collect();
            if let [p, q, r, ..] = there[..] {
                mesh.triangles.push([p, q, r]);
                if let [p, _, r, s] = there[..] {
                    mesh.triangles.push([p, r, s]);
                }
            }
        }
    }
    mesh
}

fn proposal(fault: &FoundFault, geometry: &SurveyGeometry) -> Option<Proposal> {
    let cut = &fault.cut;
    let metric = geometry.metric_from_voxel();
    let places: Vec<DVec3> = (0..cut.size[0])
        .flat_map(|line| (0..cut.size[1]).map(move |z| (line, z)))
        .filter_map(|(line, z)| node(cut, line, z))
        .collect();
    let [low, high] = places.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(p.z), b.max(p.z)]);
    // The depth closest to the middle at which it is somewhere.
    let off_middle = |p: &DVec3| (p.z - 0.5 * (low + high)).abs();
    let middle = places.iter().min_by(|p, q| off_middle(p).total_cmp(&off_middle(q)))?.z;
    let along = |p: &DVec3| if cut.across == Across::Inlines { p.y } else { p.x };
    let at_middle: Vec<DVec3> = places.iter().copied().filter(|p| p.z == middle).collect();
    let first = *at_middle.iter().min_by(|p, q| along(p).total_cmp(&along(q)))?;
    let last = *at_middle.iter().max_by(|p, q| along(p).total_cmp(&along(q)))?;
    let mesh = mesh(cut, geometry);
    let normal = mean_normal(&mesh, geometry, metric);
    let dip = normal.truncate().length().atan2(normal.z.abs()).to_degrees();
    let [a, b] = [first, last].map(|p| geometry.world_from_voxel(p).truncate());
    let strike = (b - a).normalize_or_zero();
    let towards_upper = downwards(cut);
    let (mut throws, sum) = throws(fault);
    throws.sort_by(f64::total_cmp);
    let percentile = |of: usize| throws.get(throws.len() * of / 100).copied().unwrap_or(0.0);
    let [median, most] = [percentile(50), percentile(95)];
    let length_m = (metric * (last - first)).truncate().length();
    let margin = fault.throw.as_ref().map_or(0.0, |throw| throw.margin);
    Some(Proposal {
        id: 0,
        name: String::new(),
        mesh,
        strike_deg: strike.x.atan2(strike.y).to_degrees().rem_euclid(180.0),
        dip_deg: dip,
        // The hanging wall is the side towards which the fault dips.
        reverse: (sum > 0.0) != towards_upper,
        throw: [median, most].map(|throw| throw * geometry.vertical.interval),
        ends: [first, last].map(|p| geometry.lines_from_voxel(DVec2::new(p.x, p.y)).to_array()),
        depth: [low, high].map(|z| geometry.vertical.value_at(z)),
        horizons: Vec::new(),
        support: fault.ends,
        misfit_m: 0.0,
        offset_m2: median * geometry.sample_m() * length_m,
        is_minor: median < LEAST_THROW || margin < LEAST_MARGIN,
        semblance: None,
    })
}

/// The mean normal of a mesh in metric space.
fn mean_normal(mesh: &TriangleMesh, geometry: &SurveyGeometry, metric: glam::DMat3) -> DVec3 {
    let at = |n: u32| metric * geometry.voxel_from_world(mesh.vertices[n as usize]);
    mesh.triangles.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a))).sum()
}

/// Whether a fault goes towards higher indices across with depth.
fn downwards(cut: &Cut) -> bool {
    let nz = cut.size[1];
    let steps = cut.place.chunks(nz).flat_map(|row| row.windows(2)).map(|pair| pair[1] - pair[0]);
    steps.filter(|step| step.is_finite()).sum::<f32>() > 0.0
}

/// The sizes of a fault's throw at its nodes, samples, and their signed sum.
fn throws(fault: &FoundFault) -> (Vec<f64>, f64) {
    let Some(throw) = &fault.throw else { return (Vec::new(), 0.0) };
    let nz = fault.cut.size[1];
    let there = fault.cut.place.iter().enumerate().filter(|(_, place)| place.is_finite());
    let all: Vec<f64> = there.map(|(n, _)| f64::from(throw.at(n / nz, (n % nz) as f32))).collect();
    let sum = all.iter().sum();
    (all.into_iter().map(f64::abs).collect(), sum)
}
