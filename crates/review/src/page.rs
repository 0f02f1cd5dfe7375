//! What the viewer reads: the model as JSON, with pictures and numbers in base64.
//!
//! Corners and ends of lines are 16-bit shares of the box that they fill; paths of wells are 32-bit floats. Voxels
//! everywhere.

use crate::model::{Block, Cover, LineKind, Mesh, Model, SceneModel, Surface};
use crate::picture::{drawing, jpeg, png, shrunk};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use project::error::ProjectError;
use rayon::prelude::*;
use render::{Camera, Projection};
use serde_json::{Value, json};
use survey::SurveyGeometry;
use ttf::RgbaFunction;

/// A picture that is a part of the page.
pub(crate) fn data_uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:image/{kind};base64,{}", STANDARD.encode(bytes))
}

/// The model without the pictures of its faces, which come as files of PNG: those of the illustration, then the data.
pub(crate) fn page(model: &Model, illustrated: &[Option<String>], data: &[Vec<u8>]) -> Result<Value, ProjectError> {
    let covers: Vec<Value> = model
        .covers
        .iter()
        .enumerate()
        .map(|(n, cover)| self::cover(cover, illustrated[n].as_ref(), &data_uri("png", &data[n])))
        .collect();
    let mut layers = Vec::new();
    for layer in &model.layers {
        layers.push(json!({
            "name": layer.name, "rock": layer.rock, "age": layer.age, "colour": layer.colour.to_string(),
            "swatch": data_uri("png", &png(&layer.swatch)?), "seen": layer.is_seen,
        }));
    }
    let wells: Vec<Value> = model
        .wells
        .iter()
        .map(|well| {
            let tops: Vec<Value> =
                well.tops.iter().map(|(name, at)| json!({ "name": name, "at": at.to_array() })).collect();
            json!({ "name": well.name, "path": floats(well.path.iter()), "tops": tops })
        })
        .collect();
    let sections: Vec<Value> = model
        .sections
        .iter()
        .map(|stack| {
            let places: Vec<Value> = stack
                .places
                .iter()
                .map(|place| {
                    let mut value = lines(&place.lines);
                    value["at"] = place.at.into();
                    value["cover"] = place.cover.into();
                    value
                })
                .collect();
            json!({ "axis": stack.axis, "places": places })
        })
        .collect();
    let notes: Vec<Value> = model
        .notes
        .iter()
        .map(|note| json!({ "text": note.text, "at": note.at.to_array(), "scene": note.scene }))
        .collect();
    let mut blocks = Blocks::default();
    let scenes: Vec<Value> =
        model.scenes.iter().map(|scene| self::scene(scene, &model.geometry, &mut blocks)).collect();
    Ok(json!({
        "title": model.title,
        "provenance": model.provenance,
        "warning": model.warning,
        "unpicked": model.has_unpicked(),
        "geometry": geometry(&model.geometry),
        "raw": model.raw.as_ref().map(|raw| json!({
            "volume": raw.volume, "domain": raw.function.domain, "map": STANDARD.encode(map(&raw.function)),
            "noData": raw.no_data.map(|colour| colour.to_unit()),
        })),
        "layers": layers,
        "horizons": model.horizons.iter().map(surface).collect::<Vec<_>>(),
        "faults": model.faults.iter().map(surface).collect::<Vec<_>>(),
        "wells": wells,
        "covers": covers,
        "scenes": scenes,
        "blocks": blocks.made,
        "sections": sections,
        "notes": notes,
    }))
}

/// The illustrations of all faces as parts of the page, their sides multiplied.
///
/// # Errors
/// A picture has no pixels.
pub(crate) fn illustrations(covers: &[Cover], share: f64) -> Result<Vec<Option<String>>, ProjectError> {
    let one = |cover: &Cover| {
        let Some(image) = &cover.illustrated else { return Ok(None) };
        let small = (share < 1.0).then(|| shrunk(image, share));
        let image = small.as_ref().unwrap_or(image);
        Ok(Some(match cover.is_smooth {
            true => data_uri("jpeg", &jpeg(image)?),
            false => data_uri("png", &drawing(image)?),
        }))
    };
    covers.par_iter().map(one).collect()
}

/// The data of all faces as PNG.
///
/// # Errors
/// A picture has no pixels.
pub(crate) fn data(covers: &[Cover]) -> Result<Vec<Vec<u8>>, ProjectError> {
    covers.par_iter().map(|cover| png(&cover.data)).collect()
}

fn geometry(geometry: &SurveyGeometry) -> Value {
    let metric = geometry.metric_from_voxel();
    let line = |axis: &survey::LineAxis| json!({ "first": axis.first, "step": axis.step, "count": axis.count });
    let vertical = &geometry.vertical;
    json!({
        "metric": metric.to_cols_array(),
        "origin": geometry.origin.to_array(),
        "inlines": line(&geometry.inlines),
        "crosslines": line(&geometry.crosslines),
        "vertical": {
            "first": vertical.first, "interval": vertical.interval, "count": vertical.count,
            "unit": vertical.unit.symbol(), "metres": geometry.metres_per_vertical_unit(),
        },
    })
}

/// 256 colours over the domain: of byte 1 the first, of byte 255 the last; entry 0 repeats the first.
pub(crate) fn map(function: &RgbaFunction) -> Vec<u8> {
    let [low, high] = function.domain;
    let entry = |n: u32| {
        let share = (n.max(1) - 1) as f32 / 254.0;
        let [r, g, b, _] = function.evaluate(low + (high - low) * share);
        [r, g, b, 1.0].map(|c| (c * 255.0 + 0.5) as u8)
    };
    (0..256).flat_map(entry).collect()
}

fn cover(cover: &Cover, illustrated: Option<&String>, data: &str) -> Value {
    let plane = &cover.rectangle;
    let share = |axis: DVec3, extent: f64| (axis / (axis.length_squared() * extent)).to_array();
    json!({
        "origin": plane.origin.to_array(),
        "u": share(plane.s_axis, plane.extent[0]),
        "v": share(plane.t_axis, plane.extent[1]),
        "s": (plane.s_axis * plane.extent[0]).to_array(),
        "t": (plane.t_axis * plane.extent[1]).to_array(),
        "illustrated": illustrated,
        "data": data,
    })
}

fn scene(model: &SceneModel, geometry: &SurveyGeometry, blocks: &mut Blocks) -> Value {
    let scene = &model.scene;
    let block = scene.box_in(geometry);
    let Camera { elevation_deg, projection, target, zoom, pan, margin, .. } = scene.camera;
    let fov = match projection {
        Projection::Orthographic => None,
        Projection::Perspective { fov_deg } => Some(fov_deg),
    };
    let stroke = |stroke: render::Stroke| json!({ "width": stroke.width_px, "colour": stroke.colour.to_string() });
    json!({
        "name": model.name,
        "hasGround": scene.ground.is_some(),
        "camera": {
            "azimuth": scene.camera.azimuth_for(geometry, &block), "elevation": elevation_deg, "fov": fov,
            "target": target, "zoom": zoom, "pan": pan, "margin": margin,
        },
        "exaggeration": scene.exaggeration,
        "blend": scene.blend,
        "low": block.min,
        "high": block.max,
        "edges": stroke(scene.outlines.edges),
        "lines": stroke(scene.outlines.horizons),
        "faults": stroke(scene.outlines.faults),
        "background": scene.background.rgba(),
        "wells": {
            "radius": scene.wells.radius, "colour": scene.wells.colour.to_string(),
            "top": scene.wells.top_colour.to_string(),
        },
        "cuts": model.cuts,
        "variants": model.variants.iter().map(|block| blocks.index(block)).collect::<Vec<_>>(),
        "ground": model
            .ground
            .iter()
            .map(|(cuts, block)| json!({ "cuts": cuts, "block": blocks.index(block) }))
            .collect::<Vec<_>>(),
    })
}

/// The blocks of all scenes; scenes that differ by their cameras alone share them.
#[derive(Default)]
struct Blocks {
    made: Vec<Value>,
}

impl Blocks {
    fn index(&mut self, block: &Block) -> usize {
        let made = self::block(block);
        self.made.iter().position(|known| *known == made).unwrap_or_else(|| {
            self.made.push(made);
            self.made.len() - 1
        })
    }
}

fn block(block: &Block) -> Value {
    let faces: Vec<Value> = block
        .faces
        .iter()
        .map(|face| json!({ "cover": face.cover, "name": face.name, "mesh": mesh(&face.mesh) }))
        .collect();
    let mut value = lines(&block.lines);
    value["faces"] = faces.into();
    value
}

/// Lines by kind.
fn lines(lines: &[(LineKind, [DVec3; 2])]) -> Value {
    let of = |wanted: LineKind| {
        let pieces = lines.iter().filter(|(kind, _)| *kind == wanted);
        shares(&pieces.flat_map(|(_, ends)| *ends).collect::<Vec<_>>())
    };
    json!({
        "edges": of(LineKind::Edge),
        "horizons": of(LineKind::Horizon { is_picked: true }),
        "unpicked": of(LineKind::Horizon { is_picked: false }),
        "faults": of(LineKind::Fault),
    })
}

fn surface(surface: &Surface) -> Value {
    let unsure: Vec<u8> = surface.is_picked.iter().map(|picked| if *picked { 0 } else { 255 }).collect();
    json!({
        "name": surface.name, "colour": surface.colour.to_string(), "mesh": mesh(&surface.mesh),
        "unsure": unsure.contains(&255).then(|| STANDARD.encode(&unsure)),
        "below": surface.below, "picked": surface.picked_share, "deviation": surface.deviation_m,
    })
}

fn floats<'a>(points: impl Iterator<Item = &'a DVec3>) -> String {
    let bytes: Vec<u8> = points.flat_map(|p| p.as_vec3().to_array()).flat_map(f32::to_le_bytes).collect();
    STANDARD.encode(&bytes)
}

/// Points as 16-bit shares of their box.
fn shares(points: &[DVec3]) -> Value {
    let start = (DVec3::MAX, DVec3::MIN);
    let (low, high) = points.iter().fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
    let size = (high - low).max(DVec3::splat(1e-9));
    let share = |p: &DVec3| ((*p - low) / size * 65535.0).round().to_array().map(|c| c as u16);
    let bytes: Vec<u8> = points.iter().flat_map(share).flat_map(u16::to_le_bytes).collect();
    let [low, size] = if points.is_empty() { [DVec3::ZERO, DVec3::ONE] } else { [low, size] };
    json!({ "low": low.to_array(), "size": size.to_array(), "points": STANDARD.encode(&bytes) })
}

/// Corners as shares of their box, and indices of 16 or 32 bits.
fn mesh(mesh: &Mesh) -> Value {
    let is_small = mesh.points.len() <= 65536;
    let indices: Vec<u8> = match is_small {
        true => mesh.triangles.iter().flatten().flat_map(|n| (*n as u16).to_le_bytes()).collect(),
        false => mesh.triangles.iter().flatten().flat_map(|n| n.to_le_bytes()).collect(),
    };
    let mut value = shares(&mesh.points);
    value["indices"] = STANDARD.encode(&indices).into();
    value["bits"] = if is_small { 16 } else { 32 }.into();
    value
}
