//! A block as glTF 2.0 in one binary file, for slides and 3D programs.
//!
//! Metres; X east, Y up, Z south, from the middle of the block. The root node is scaled along Y by the vertical
//! exaggeration, which its name and its `extras` state, so that what lies below it has true heights. Faces carry their
//! picture with the lines of horizons and faults in it; programs that know material variants can switch to raw data.

mod file;
mod ink;

use crate::make::{ReviewSettings, make};
use crate::model::{Cover, Model, Surface};
use crate::page;
use crate::picture::{drawing, jpeg};
use crate::size::SizeEstimate;
use file::{Covered, GlbFile};
use glam::DVec3;
use image::RgbImage;
use ink::inked;
use project::Project;
use project::error::ProjectError;
use project::folder::refuse_inside_project;
use project::pictures::scene;
use serde_json::{Value, json};
use std::path::Path;
use survey::Progress;

/// Limits of the triangles of a model.
pub const TRIANGLES: [usize; 2] = [1000, 5_000_000];
/// Triangles of a model unless stated: what Office takes.
pub const OFFICE_TRIANGLES: usize = 100_000;
/// Opacity of horizons and faults, which lie within the block.
const SURFACE_OPACITY: f32 = 1.0;
/// How far triangles of horizons may be from them where the triangles suffice, samples.
const LEAST_ERROR: f64 = 0.4;
/// Sides of the tube of a well.
const SIDES: usize = 8;
/// Most points of a well's path.
const WELL_POINTS: usize = 60;
/// Times that triangles are counted again.
const ATTEMPTS: usize = 4;

/// A model that was written.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct WrittenModel {
    /// Its bytes.
    pub bytes: u64,
    /// Its triangles.
    pub triangles: usize,
    /// Its nodes.
    pub nodes: usize,
    /// World X, Y (m) and vertical value of the model's origin.
    pub origin: [f64; 3],
    /// Vertical exaggeration.
    pub exaggeration: f64,
    /// Largest distance between triangles of horizons and faults and what they stand for, m.
    pub deviation_m: f64,
    /// The distance within which 99 % of the places of each of them are, m.
    pub usual_deviation_m: f64,
}

/// A model that is made and not yet written.
pub struct Prepared {
    /// What is in it.
    pub model: Model,
    /// What is said of it.
    pub facts: WrittenModel,
    bytes: Vec<u8>,
    /// Bytes of the pictures of faces.
    pictures: usize,
}

impl Prepared {
    /// About how large its file is, with faces of other densities.
    pub fn estimate(&self) -> SizeEstimate {
        SizeEstimate::new(self.bytes.len(), self.pictures)
    }
}

/// Writes the block of the first of the settings' scenes (or of the project) with at most so many triangles; completely or
/// not at all.
///
/// # Errors
/// As [`prepare`]; the file lies inside a project or cannot be written.
pub fn export(
    project: &Project,
    settings: &ReviewSettings,
    triangles: usize,
    path: &Path,
    progress: &Progress,
) -> Result<WrittenModel, ProjectError> {
    refuse_inside_project(path)?;
    let prepared = prepare(project, settings, triangles, progress)?;
    progress.check()?;
    store::replace_file(path, &prepared.bytes)?;
    Ok(prepared.facts)
}

/// Makes the model of the first of the settings' scenes (or of the project) with at most so many triangles.
///
/// # Errors
/// There is nothing to show, data are damaged, the triangles are too few for the block, or the user cancelled.
pub fn prepare(
    project: &Project,
    settings: &ReviewSettings,
    triangles: usize,
    progress: &Progress,
) -> Result<Prepared, ProjectError> {
    let document = project.document();
    let scenes = match (settings.scenes.first(), document.scenes.first()) {
        (Some(name), _) => vec![name.clone()],
        (None, Some(first)) => vec![first.name.clone()],
        (None, None) => Vec::new(),
    };
    if let Some(name) = scenes.first() {
        scene::choose(document, Some(name))?;
    }
    let (horizons, faults) = (document.horizons.len().max(1) as f64, document.faults.len() as f64);
    let (mut share, mut least) = (1.0, 0);
    for _ in 0..ATTEMPTS {
        let budget = share * triangles as f64;
        let fault_budget = if faults > 0.0 { 0.15 * budget } else { 0.0 };
        let settings = ReviewSettings {
            scenes: scenes.clone(),
            sections: 0,
            has_whole: false,
            ground_cells: (0.25 * budget).sqrt().clamp(8.0, 512.0) as usize,
            surface_nodes: ((0.25 * budget / horizons / 2.0).sqrt() as usize).clamp(4, 512),
            surface_error: LEAST_ERROR / share,
            surface_triangles: (fault_budget / faults.max(1.0)).max(64.0) as usize,
            ..settings.clone()
        };
        let model = make(project, &settings, progress)?;
        let (bytes, pictures, facts) = encoded(&model)?;
        if facts.triangles <= triangles {
            return Ok(Prepared { model, facts, bytes, pictures });
        }
        least = facts.triangles;
        share *= 0.9 * triangles as f64 / facts.triangles as f64;
    }
    let [found, limit] = [least, triangles].map(|count| format!("{count} triangles"));
    Err(ProjectError::OverBudget { what: "the model", found, limit })
}

/// From voxels to the metres of the model, without exaggeration.
struct Frame {
    metric: glam::DMat3,
    centre: DVec3,
}

impl Frame {
    fn place(&self, voxel: DVec3) -> DVec3 {
        let metres = self.metric * (voxel - self.centre);
        DVec3::new(metres.x, -metres.z, -metres.y)
    }

    fn places(&self, voxels: &[DVec3]) -> Vec<DVec3> {
        voxels.iter().map(|p| self.place(*p)).collect()
    }
}

/// The bytes of a model's first scene, and how many of them are pictures.
fn encoded(model: &Model) -> Result<(Vec<u8>, usize, WrittenModel), ProjectError> {
    let scene = &model.scenes[0];
    let block = scene.scene.box_in(&model.geometry);
    let frame = Frame { metric: model.geometry.metric_from_voxel(), centre: block.centre() };
    let mut file = GlbFile::default();
    let (mut triangles, mut pictures) = (0, 0);
    let has_raw = model.raw.is_some() && model.covers.iter().any(|cover| cover.illustrated.is_some());
    let mut faces = Vec::new();
    for face in &scene.cut.faces {
        let cover = &model.covers[face.cover];
        let raw = model.raw.as_ref().map(|raw| raw_picture(cover, &page::map(&raw.function)));
        let (mime, bytes) = match &cover.illustrated {
            Some(image) if cover.is_smooth => ("image/jpeg", jpeg(&inked(image, cover, scene))?),
            Some(image) => ("image/png", drawing(&inked(image, cover, scene))?),
            None => ("image/jpeg", jpeg(raw.as_ref().unwrap_or(&cover.data))?),
        };
        // Raw values lie on nodes, at any density.
        pictures += cover.illustrated.as_ref().map_or(0, |_| bytes.len());
        let shown = file.picture(&face.name, mime, &bytes);
        let material = file.material(&face.name, [1.0; 4], Some(shown));
        let variant = match raw.filter(|_| has_raw) {
            Some(raw) => {
                let name = format!("{}, raw", face.name);
                let picture = file.picture(&name, "image/jpeg", &jpeg(&raw)?);
                Some(file.material(&name, [1.0; 4], Some(picture)))
            }
            None => None,
        };
        let plane = &cover.rectangle;
        let share = |p: &DVec3, axis: DVec3, extent: f64| {
            (axis.dot(*p - plane.origin) / (axis.length_squared() * extent)).clamp(0.0, 1.0) as f32
        };
        let uv = |p| [share(p, plane.s_axis, plane.extent[0]), share(p, plane.t_axis, plane.extent[1])];
        let covered = Covered {
            points: &frame.places(&face.mesh.points),
            triangles: &face.mesh.triangles,
            uv: face.mesh.points.iter().map(uv).collect(),
            material,
            raw: variant,
        };
        triangles += face.mesh.triangles.len();
        faces.extend(file.mesh(&face.name, &covered, &Value::Null));
    }
    let mut groups: Vec<usize> = file.group("Block", &faces).into_iter().collect();
    let (mut deviation_m, mut usual_deviation_m) = (0.0f64, 0.0f64);
    for (title, surfaces) in [("Horizons", &model.horizons), ("Faults", &model.faults)] {
        let mut nodes = Vec::new();
        for surface in surfaces {
            let shown = surface.shown(scene.scene.ground.is_some());
            triangles += shown.len();
            deviation_m = deviation_m.max(surface.deviation_m);
            usual_deviation_m = usual_deviation_m.max(surface.usual_deviation_m);
            nodes.extend(add_surface(&mut file, (surface, shown), &frame));
        }
        groups.extend(file.group(title, &nodes));
    }
    let mut nodes = Vec::new();
    for well in &model.wells {
        let radius = 0.0018 * (model.geometry.metric_from_voxel() * block.extent()).length();
        let [r, g, b] = scene.scene.wells.colour.to_unit().map(ttf::linear_from_srgb);
        let material = file.material(&well.name, [r, g, b, 1.0], None);
        let step = (well.path.len() / WELL_POINTS).max(1);
        let mut path: Vec<DVec3> = well.path.iter().step_by(step).map(|p| frame.place(*p)).collect();
        path.extend(well.path.last().map(|p| frame.place(*p)));
        let (points, tube) = tube(&path, radius);
        triangles += tube.len();
        let tops: Vec<Value> =
            well.tops.iter().map(|(name, at)| json!({ "name": name, "at": frame.place(*at).to_array() })).collect();
        let covered = Covered { points: &points, triangles: &tube, uv: Vec::new(), material, raw: None };
        nodes.extend(file.mesh(&well.name, &covered, &json!({ "tops": tops })));
    }
    groups.extend(file.group("Wells", &nodes));
    let exaggeration = scene.scene.exaggeration;
    let origin = model.geometry.world_from_voxel(frame.centre).to_array();
    let extras = json!({
        "verticalExaggeration": exaggeration,
        "units": "m",
        "axes": "X east, Y up, Z south",
        "origin": { "x": origin[0], "y": origin[1], "vertical": origin[2], "unit": model.geometry.vertical.unit.symbol() },
        "velocity_m_s": model.geometry.velocity_m_s,
        "warning": model.warning,
        "provenance": model.provenance,
    });
    let warning = model.warning.as_ref().map_or_else(String::new, |_| ", uninterpreted".to_owned());
    let root = format!("{} (vertical exaggeration {exaggeration}{warning})", model.title);
    let nodes = file.node_count() + 1;
    let bytes = file.finish(&root, &groups, exaggeration, &extras, has_raw);
    let written = WrittenModel {
        bytes: bytes.len() as u64,
        triangles,
        nodes,
        origin,
        exaggeration,
        deviation_m,
        usual_deviation_m,
    };
    Ok((bytes, pictures, written))
}

fn add_surface(file: &mut GlbFile, (surface, triangles): (&Surface, &[[u32; 3]]), frame: &Frame) -> Option<usize> {
    let [r, g, b] = surface.colour.to_unit().map(ttf::linear_from_srgb);
    let material = file.material(&surface.name, [r, g, b, SURFACE_OPACITY], None);
    let points = frame.places(&surface.mesh.points);
    let covered = Covered { points: &points, triangles, uv: Vec::new(), material, raw: None };
    let extras = json!({ "pickedShare": surface.picked_share, "deviation_m": surface.deviation_m });
    file.mesh(&surface.name, &covered, &extras)
}

/// The raw values of a face in their colours.
fn raw_picture(cover: &Cover, map: &[u8]) -> RgbImage {
    let colour = |value: u8| {
        let at = usize::from(value) * 4;
        if value == 0 { [220, 220, 218] } else { [map[at], map[at + 1], map[at + 2]] }
    };
    RgbImage::from_fn(cover.data.width(), cover.data.height(), |x, y| {
        image::Rgb(colour(cover.data.get_pixel(x, y).0[0]))
    })
}

/// A tube along a path.
fn tube(path: &[DVec3], radius: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for (n, p) in path.iter().enumerate() {
        let along = (path[(n + 1).min(path.len() - 1)] - path[n.saturating_sub(1)]).normalize_or(DVec3::Y);
        let (u, v) = along.any_orthonormal_pair();
        for side in 0..SIDES {
            let (sin, cos) = (std::f64::consts::TAU * side as f64 / SIDES as f64).sin_cos();
            points.push(*p + (u * cos + v * sin) * radius);
        }
        if n > 0 {
            for side in 0..SIDES {
                let next = (side + 1) % SIDES;
                let at = |ring: usize, side: usize| (ring * SIDES + side) as u32;
                triangles.push([at(n - 1, side), at(n - 1, next), at(n, next)]);
                triangles.push([at(n - 1, side), at(n, next), at(n, side)]);
            }
        }
    }
    (points, triangles)
}
