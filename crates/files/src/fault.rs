//! Makes a [`Fault`] from a surface as read: converts it, places it in the world, triangulates it and checks it against
//! the survey.
//!
//! Points with stick numbers are sticks, and so are points that come in runs of equal inline, or else crossline. A
//! surface is fitted to any other points.

use super::columns::is_inside;
use super::options::ImportOptions;
use super::placement::{self, voxel_xy};
use super::raw::{RawPoint, RawShape, RawSurface};
use super::report::{Gridding, ImportReport, Settled};
use super::vertical::VerticalRule;
use super::{Format, FormatError, SurfaceKind, plane_fit, sticks};
use glam::{DVec2, DVec3};
use indexmap::IndexMap;
use std::path::Path;
use survey::fault::Fault;
use survey::geometry::SurveyGeometry;
use survey::mesh::TriangleMesh;

/// Most nodes of a stick: each is compared with each of its neighbour.
const MAX_STICK_NODES: usize = 5000;

/// Makes the fault.
pub(super) fn build(
    file: &Path,
    name: String,
    format: Settled<Format>,
    mut raw: RawSurface,
    geometry: &SurveyGeometry,
    options: &ImportOptions,
) -> Result<(Fault, ImportReport), FormatError> {
    let rule = VerticalRule::settle(file, &raw.vertical, options, geometry.vertical.unit)?;
    let counts = rule.apply(&mut raw.shape);
    let metres = geometry.metres_per_vertical_unit();
    let mut notes = raw.notes;
    let warnings = raw.warnings;
    let none = |why: String| FormatError::NoSurface { file: file.to_path_buf(), name: name.clone(), why };
    let mut outside = 0;
    let (mesh, gridding) = match raw.shape {
        RawShape::Grid { .. } => return Err(none("a grid is read as a horizon, not as a fault".into())),
        RawShape::Mesh(mesh) => (clean(&mesh), Gridding::NativeMesh),
        RawShape::Points(mut points) => {
            points.retain(|p| p.z.is_finite());
            if points.is_empty() {
                return Err(none(format!("{} points, all without a vertical value", counts.values)));
            }
            let placed = placement::place(file, &name, &points, geometry, options.place_by)?;
            notes.extend(placed.note);
            outside = placed.outside;
            let world: Vec<DVec3> =
                placed.voxels.iter().zip(&points).map(|(v, p)| placement::world_xy(geometry, *v).extend(p.z)).collect();
            if let Some(groups) = stick_groups(&points) {
                let all = groups.len();
                let lines: Vec<Vec<DVec3>> =
                    groups.iter().map(|g| line(g, &points, &world)).filter(|l| l.len() >= 2).collect();
                if lines.len() < all {
                    notes.push(format!("{} sticks of a single node were left out", all - lines.len()));
                }
                if lines.len() < 2 {
                    return Err(none(format!(
                        "a surface needs two sticks of at least two nodes, found {}",
                        lines.len()
                    )));
                }
                if let Some(long) = lines.iter().map(Vec::len).find(|&nodes| nodes > MAX_STICK_NODES) {
                    return Err(none(format!("a stick has {long} nodes, more than {MAX_STICK_NODES}")));
                }
                (sticks::join(&lines, metres), Gridding::Sticks { sticks: lines.len() })
            } else {
                let (mesh, rms_m) = plane_fit::fit(&world, metres)
                    .ok_or_else(|| none(format!("{} points along a line span no surface", world.len())))?;
                (mesh, Gridding::PlaneFit { rms_m })
            }
        }
    };
    if mesh.triangles.is_empty() {
        return Err(none("no triangle has an area".into()));
    }
    let used = || mesh.triangles.iter().flatten().map(|&v| mesh.vertices[v as usize]);
    let [nx, ny, _] = geometry.size();
    let voxels = || used().map(|v| voxel_xy(geometry, v.truncate()));
    let low = voxels().fold(DVec2::INFINITY, DVec2::min);
    let high = voxels().fold(DVec2::NEG_INFINITY, DVec2::max);
    if high.x < -0.5 || high.y < -0.5 || low.x > nx as f64 - 0.5 || low.y > ny as f64 - 0.5 {
        return Err(placement::outside_by_world(file, &name, used().map(|v| v.truncate()), geometry));
    }
    if gridding == Gridding::NativeMesh {
        outside = mesh.vertices.iter().filter(|v| !is_inside(voxel_xy(geometry, v.truncate()), geometry)).count();
    }
    let values: Vec<f64> = used().map(|v| v.z).collect();
    rule.check(file, &name, &values, &geometry.vertical, SurfaceKind::Fault)?;
    let axis = &geometry.vertical;
    let outside_range = mesh.vertices.iter().filter(|v| v.z < axis.first || v.z > axis.last()).count();
    let report = ImportReport {
        file: file.to_path_buf(),
        kind: SurfaceKind::Fault,
        name: name.clone(),
        format,
        values: counts.values,
        nulls: counts.nulls,
        outside_survey: outside,
        outside_range,
        range_in_file: counts.range_in_file,
        range: counts.range,
        unit: axis.unit,
        assumptions: rule.assumptions(),
        z_unit: rule.unit,
        z_positive: rule.positive,
        z_factor: rule.factor,
        gridding,
        sheets: 1,
        multivalued: 0,
        notes,
        warnings,
        off_map: None,
        of_map: Vec::new(),
    };
    Ok((Fault::new(name, mesh), report))
}

/// The mesh without triangles that are degenerate or have a corner without a vertical value, and without
/// unused vertices; the order stays.
fn clean(mesh: &TriangleMesh) -> TriangleMesh {
    let has_area = |t: usize| {
        let [a, b, c] = mesh.corners(t);
        let area = (b - a).cross(c - a).length();
        area.is_finite() && area > 0.0
    };
    let kept: Vec<[u32; 3]> = (0..mesh.triangles.len()).filter(|&t| has_area(t)).map(|t| mesh.triangles[t]).collect();
    let mut index = vec![None; mesh.vertices.len()];
    kept.iter().flatten().for_each(|&v| index[v as usize] = Some(0));
    let mut out = TriangleMesh::default();
    for (slot, vertex) in index.iter_mut().zip(&mesh.vertices).filter(|(slot, _)| slot.is_some()) {
        *slot = Some(out.vertices.len() as u32);
        out.vertices.push(*vertex);
    }
    out.triangles = kept.into_iter().map(|t| t.map(|v| index[v as usize].unwrap_or(0))).collect();
    out
}

/// Indices of points, stick by stick; `None` if they are not sticks.
fn stick_groups(points: &[RawPoint]) -> Option<Vec<Vec<usize>>> {
    if points.iter().all(|p| p.stick.is_some()) {
        return Some(grouped(points, |p| p.stick));
    }
    [|p: &RawPoint| p.lines.map(|l| l.x), |p: &RawPoint| p.lines.map(|l| l.y)].into_iter().find_map(|line| {
        if !points.iter().all(|p| line(p).is_some()) {
            return None;
        }
        let groups = grouped(points, line);
        // When sticks are picked line by line, the points of a line follow one another in the file.
        let runs = 1 + points.windows(2).filter(|w| line(&w[0]) != line(&w[1])).count();
        (groups.len() >= 2 && runs == groups.len() && groups.iter().all(|g| g.len() >= 2)).then_some(groups)
    })
}

/// Points of equal key, in order of first appearance.
fn grouped(points: &[RawPoint], key: impl Fn(&RawPoint) -> Option<f64>) -> Vec<Vec<usize>> {
    let mut groups: IndexMap<u64, Vec<usize>> = IndexMap::new();
    for (n, p) in points.iter().enumerate() {
        groups.entry(key(p).unwrap_or(f64::NAN).to_bits()).or_default().push(n);
    }
    groups.into_values().collect()
}

/// The nodes of a stick in order, without repeated places.
fn line(group: &[usize], points: &[RawPoint], world: &[DVec3]) -> Vec<DVec3> {
    let mut order = group.to_vec();
    if order.iter().all(|&n| points[n].node.is_some()) {
        order.sort_by(|&a, &b| points[a].node.unwrap_or(0.0).total_cmp(&points[b].node.unwrap_or(0.0)).then(a.cmp(&b)));
    }
    let mut line: Vec<DVec3> = order.into_iter().map(|n| world[n]).collect();
    line.dedup_by(|a, b| a.distance(*b) < 1e-6);
    line
}
