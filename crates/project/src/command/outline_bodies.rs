//! Outlines of isolated bodies: what reflects strongly and ends within the survey on all sides.

use super::{Effect, Noun, ProjectError};
use crate::content;
use crate::document::{HorizonEntry, Id, Origin};
use crate::folder::Draft;
use crate::interpretation::times::Times;
use ::time::Body;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use survey::{Contact, Horizon, Progress, SurveyGeometry, TriangleMesh};

/// Adds the outlines of the isolated bodies that are found along geologic time as closed horizons, which cut all others.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutlineBodies {
    /// What each is called, before its number.
    pub name: String,
    /// How many at most, the strongest first.
    pub most: usize,
}

impl OutlineBodies {
    pub(super) fn execute(&self, draft: &mut Draft, progress: &Progress) -> Result<Effect, ProjectError> {
        let geometry = draft.document.frame()?.clone();
        let found = isolated(&*Times::load(draft.facts(), progress)?, self.most, &geometry);
        for (n, (_, mesh)) in found.iter().enumerate() {
            let name = format!("{} {}", self.name, n + 1);
            draft.document.check_new_name(Noun::Horizon, &name)?;
            let horizon = Horizon::of_surface(name.clone(), mesh.clone());
            let hash = content::hash_horizon(&horizon);
            let (file, new) = draft.generation("horizons", &name, "zarr")?;
            store::write_horizon(&new, &horizon, progress)?;
            let entry = HorizonEntry {
                id: Id::default(),
                name,
                contact: Contact::Intrusive,
                file,
                hash,
                origin: Origin::Outlined,
                assembly: None,
                colour: None,
                gap_m: None,
                refined: Vec::new(),
            };
            // Below all that it cuts: the layer that it closes is its own.
            let oldest = draft.document.horizons.len();
            draft.document.insert_horizon(oldest, entry);
        }
        Ok(Effect::Changed { summary: format!("{} isolated bodies outlined", found.len()) })
    }
}

/// The strongest isolated bodies that can be part of a model, with their outlines.
pub(crate) fn isolated(times: &Times, most: usize, geometry: &SurveyGeometry) -> Vec<(Body, TriangleMesh)> {
    let found = times.reflections.bodies(&times.amplitudes).into_iter();
    let outlined = found.map(|body| {
        let mesh = outline(&body, geometry);
        (body, mesh)
    });
    let fits = |(_, mesh): &(Body, TriangleMesh)| {
        let horizon = Horizon::of_surface("body", mesh.clone());
        model::is_closed(&horizon, geometry) && model::check_surface(&horizon, Contact::Intrusive, geometry).is_ok()
    };
    outlined.filter(fits).take(most).collect()
}

/// Where a trace of a body's map lies, in voxels; a trace beside it may lie outside of the survey.
type Place = [i64; 2];

/// The corners of the two triangles of a cell of four traces.
const CELL: [[Place; 3]; 2] = [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]];

/// The closed outline of a body: its top and its base, which meet in the traces around it.
fn outline(body: &Body, geometry: &SurveyGeometry) -> TriangleMesh {
    let columns: BTreeMap<Place, [f32; 2]> =
        body.columns.iter().map(|column| (column.trace.map(|at| at as i64), [column.top, column.base])).collect();
    let near = |[x, y]: Place| (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
    let mut rim: BTreeMap<Place, f32> = BTreeMap::new();
    for place in columns.keys().flat_map(|place| near(*place)).filter(|place| !columns.contains_key(place)) {
        rim.entry(place).or_insert_with(|| {
            let middles: Vec<f32> =
                near(place).filter_map(|near| columns.get(&near)).map(|[top, base]| 0.5 * (top + base)).collect();
            middles.iter().sum::<f32>() / middles.len() as f32
        });
    }
    let mut mesh = TriangleMesh::default();
    let mut vertex = |[x, y]: Place, z: f32| {
        mesh.vertices.push(geometry.world_from_voxel(DVec3::new(x as f64, y as f64, f64::from(z))));
        (mesh.vertices.len() - 1) as u32
    };
    // The vertices of each trace, at the top and at the base.
    let mut numbers: BTreeMap<Place, [u32; 2]> = BTreeMap::new();
    numbers.extend(columns.iter().map(|(place, sides)| (*place, sides.map(|z| vertex(*place, z)))));
    numbers.extend(rim.iter().map(|(place, z)| (*place, [vertex(*place, *z); 2])));
    for [x, y] in numbers.keys() {
        for corners in CELL.map(|cell| cell.map(|[dx, dy]| [x + dx, y + dy])) {
            if !corners.iter().any(|corner| columns.contains_key(corner)) {
                continue;
            }
            let [Some(a), Some(b), Some(c)] = corners.map(|corner| numbers.get(&corner)) else { continue };
            mesh.triangles.extend([[a[0], b[0], c[0]], [a[1], c[1], b[1]]]);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::time::Column;
    use survey::VerticalUnit;

    #[test]
    fn an_outline_is_closed_and_has_the_volume_of_its_columns() {
        let geometry = SurveyGeometry::regular([40, 30, 60], 25.0, 4.0, VerticalUnit::Metres);
        let thickness = |x: usize, y: usize| {
            let square = (x as f32 - 20.0).powi(2) / 144.0 + (y as f32 - 14.0).powi(2) / 64.0;
            12.0 * (1.0 - square)
        };
        let traces = (0..40).flat_map(|x| (0..30).map(move |y| (x, y))).filter(|(x, y)| thickness(*x, *y) > 0.0);
        let columns: Vec<Column> = traces
            .map(|(x, y)| Column { trace: [x, y], top: 30.0 - thickness(x, y), base: 30.0 + 0.1 * x as f32 })
            .collect();
        let expected: f32 = columns.iter().map(|column| column.base - column.top).sum();
        let body = Body { columns, strength: 4.0 };
        let mesh = outline(&body, &geometry);
        let horizon = Horizon::of_surface("body", mesh.clone());
        assert!(model::is_closed(&horizon, &geometry));
        model::check_surface(&horizon, Contact::Intrusive, &geometry).unwrap();
        // The volume by the divergence theorem, in voxels.
        let volume: f64 = (0..mesh.triangles.len())
            .map(|n| mesh.corners(n).map(|corner| geometry.voxel_from_world(corner)))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        assert!((volume.abs() / f64::from(expected) - 1.0).abs() < 0.03, "{volume} {expected}");
    }
}
