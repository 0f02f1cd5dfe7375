//! Found surfaces as proposed faults, beside those that offset horizons give.

use crate::FaultSurface;
use crate::grow::closed;
use crate::sheet::{Sheet, WIDTH};
use attribute::likelihood::ROW;
use glam::{DVec2, DVec3};
use interp::faults::Proposal;
use survey::{SurveyGeometry, TriangleMesh};

/// Cells between the nodes of a mesh.
const MESH: usize = 2;

/// Proposals of the surfaces that are faults or may be, by their evidence; what only may be one is minor and comes last, and
/// so do cuts ([`crate::find_with_cuts`]).
pub fn proposals(found: &[FaultSurface], cuts: &[FaultSurface], geometry: &SurveyGeometry) -> Vec<Proposal> {
    let offered = found.iter().filter(|fault| fault.is_possible());
    let cut =
        |cut: &FaultSurface| Proposal { is_cut: true, throw: [0.0; 2], reverse: false, ..proposal(cut, geometry) };
    let mut all: Vec<Proposal> = offered.map(|fault| proposal(fault, geometry)).chain(cuts.iter().map(cut)).collect();
    all.sort_by(|a, b| a.is_minor.cmp(&b.is_minor).then(b.area_m2.total_cmp(&a.area_m2)));
    all
}

/// The middle of a cell in voxels.
fn voxel(sheet: &Sheet, n: usize) -> DVec3 {
    let [x, y, z] = sheet.voxel(n).map(f64::from);
    DVec3::new(x, y, z)
}

/// Steps from the first to the last of `count`, which is always there.
fn steps(count: usize) -> Vec<usize> {
    let mut all: Vec<usize> = (0..count).step_by(MESH).collect();
    if all.last().is_some_and(|last| last + 1 < count) {
        all.push(count - 1);
    }
    all
}

/// Its triangles. Where it tells of no throw in its midst it is a fault all the same: such gaps are closed.
fn mesh(sheet: &Sheet, geometry: &SurveyGeometry) -> TriangleMesh {
    let there = closed(&sheet.there, sheet.cells);
    let (columns, rows) = (steps(sheet.cells[0]), steps(sheet.cells[1]));
    let mut mesh = TriangleMesh::default();
    let mut index = vec![None; columns.len() * rows.len()];
    for (a, &column) in columns.iter().enumerate() {
        for (b, &row) in rows.iter().enumerate() {
            let n = column * sheet.cells[1] + row;
            if there[n] {
                index[a * rows.len() + b] = Some(mesh.vertices.len() as u32);
                mesh.vertices.push(geometry.world_from_voxel(voxel(sheet, n)));
            }
        }
    }
    for a in 1..columns.len() {
        for b in 1..rows.len() {
            let at = |a: usize, b: usize| index[a * rows.len() + b];
            let corners = [at(a - 1, b - 1), at(a, b - 1), at(a, b), at(a - 1, b)];
            match corners.into_iter().flatten().collect::<Vec<u32>>()[..] {
                [p, q, r, s] => mesh.triangles.extend([[p, q, r], [p, r, s]]),
                [p, q, r] => mesh.triangles.push([p, q, r]),
                _ => {}
            }
        }
    }
    mesh
}

fn proposal(fault: &FaultSurface, geometry: &SurveyGeometry) -> Proposal {
    let (sheet, offsets) = (&fault.sheet, &fault.offsets);
    let metric = geometry.metric_from_voxel();
    let cells: Vec<usize> = (0..sheet.there.len()).filter(|&n| sheet.there[n]).collect();
    let places: Vec<DVec3> = cells.iter().map(|&n| voxel(sheet, n)).collect();
    let depth = |of: fn(f64, f64) -> f64, from: f64| places.iter().map(|p| p.z).fold(from, of);
    let [low, high] = [depth(f64::min, f64::INFINITY), depth(f64::max, f64::NEG_INFINITY)];
    // The row closest to the middle at which it is somewhere.
    let off_middle = |p: &&DVec3| (p.z - 0.5 * (low + high)).abs();
    let middle = places.iter().min_by(|p, q| off_middle(p).total_cmp(&off_middle(q))).map_or(0.0, |p| p.z);
    let along = |p: &DVec3| sheet.frame.place([p.x as f32, p.y as f32, 0.0])[0];
    let mut at_middle: Vec<DVec3> = places.iter().copied().filter(|p| p.z == middle).collect();
    at_middle.sort_by(|p, q| along(p).total_cmp(&along(q)));
    let [first, last] = [at_middle.first(), at_middle.last()].map(|p| p.copied().unwrap_or_default());
    let mesh = mesh(sheet, geometry);
    let at = |n: u32| metric * geometry.voxel_from_world(mesh.vertices[n as usize]);
    let normal: DVec3 = mesh.triangles.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a))).sum();
    let [a, b] = [first, last].map(|p| geometry.world_from_voxel(p).truncate());
    let strike = (b - a).normalize_or_zero();
    let mut throws: Vec<f64> =
        cells.iter().filter_map(|&n| offsets.cells[n]).map(|cell| f64::from(cell.throw.abs())).collect();
    throws.sort_by(f64::total_cmp);
    let percentile = |of: usize| throws.get(throws.len() * of / 100).copied().unwrap_or(0.0);
    let [median, most] = [percentile(50), percentile(95)];
    let length_m = (metric * (last - first)).truncate().length();
    let across = metric * DVec3::new(f64::from(sheet.frame.along[0]), f64::from(sheet.frame.along[1]), 0.0);
    let cell_m2 = across.length() * f64::from(WIDTH) * geometry.sample_m() * ROW as f64;
    Proposal {
        id: 0,
        name: String::new(),
        mesh,
        strike_deg: strike.x.atan2(strike.y).to_degrees().rem_euclid(180.0),
        dip_deg: normal.truncate().length().atan2(normal.z.abs()).to_degrees(),
        reverse: fault.is_reverse(),
        throw: [median, most].map(|throw| throw * geometry.vertical.interval),
        ends: [first, last].map(|p| geometry.lines_from_voxel(DVec2::new(p.x, p.y)).to_array()),
        depth: [low, high].map(|z| geometry.vertical.value_at(z)),
        horizons: Vec::new(),
        support: cells.len(),
        misfit_m: 0.0,
        offset_m2: median * geometry.sample_m() * length_m,
        area_m2: cells.len() as f64 * cell_m2,
        evidence: Some(fault.evidence),
        is_minor: !fault.is_accepted(),
        is_cut: false,
        semblance: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Frame;
    use survey::VerticalUnit;

    #[test]
    fn a_surface_has_no_hole_where_it_tells_of_no_throw() {
        let geometry = SurveyGeometry::regular([64, 64, 64], 25.0, 10.0, VerticalUnit::Metres);
        let frame = Frame { origin: [20.0, 10.0], along: [0.0, 1.0], across: [-1.0, 0.0] };
        let cells = [17, 13];
        let whole = Sheet { frame, low: [0, 2], cells, height: vec![0.5; 17 * 13], there: vec![true; 17 * 13] };
        let mut holed = whole.clone();
        for (a, b) in (4..13).flat_map(|a| (3..10).map(move |b| (a, b))) {
            holed.there[a * cells[1] + b] = false;
        }
        let triangles = |sheet: &Sheet| mesh(sheet, &geometry).triangles.len();
        assert_eq!((triangles(&whole), triangles(&holed)), (8 * 6 * 2, 8 * 6 * 2));
    }
}
