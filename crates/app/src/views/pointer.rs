//! What is under the cursor: the first rock on the ray, and what is known of it.

use crate::state::camera;
use glam::{DVec2, DVec3, Vec3};
use project::pictures::LeafFacts;
use project::pictures::load::Loaded;
use render::Scene;
use render::visible::Ray;

/// Steps for each voxel of a ray in the search for the ground.
const GROUND_STEP: f32 = 0.5;

/// A place on the block.
#[derive(Debug, Clone, PartialEq)]
pub struct Pointed {
    /// Position, voxel.
    pub voxel: DVec3,
    /// The axis across the face; `None` on the ground.
    pub axis: Option<usize>,
    /// The layer, 0 = deepest.
    pub layer: Option<u16>,
    /// The value of the raw volume there.
    pub value: Option<f32>,
    /// The leaf of the candidates there.
    pub leaf: Option<LeafFacts>,
}

/// The first rock under a point of a picture of this size.
pub(crate) fn on_block(loaded: &Loaded, scene: &Scene, size: DVec2, at: DVec2) -> Option<Pointed> {
    let geometry = &loaded.geometry;
    let ray = Ray::from(camera::view(scene, geometry, size).ray(at));
    let solid = scene.solid(geometry);
    let air = scene.ground.and(loaded.rock.as_ref()).map(|rock| (rock, (rock.model.layer_count() - 1) as u16));
    let mut from = 0.0;
    while let Some(span) = solid.next_span(&ray, from) {
        let Some((rock, air)) = air else { return Some(at_voxel(loaded, span.entry.point, span.entry.plane.axis)) };
        let is_air = |t: f32| rock.model.region_at(ray.at(t)).layer == air;
        if !is_air(span.entry.t + 1e-3) {
            return Some(at_voxel(loaded, span.entry.point, span.entry.plane.axis));
        }
        let mut t = span.entry.t;
        while t < span.end {
            let next = (t + GROUND_STEP).min(span.end);
            if !is_air(next) {
                let (mut above, mut below) = (t, next);
                for _ in 0..12 {
                    let middle = 0.5 * (above + below);
                    if is_air(middle) { above = middle } else { below = middle }
                }
                return Some(at_voxel(loaded, ray.at(below), None));
            }
            t = next;
        }
        from = span.end + 1e-3;
    }
    None
}

/// What is known of a place.
pub(crate) fn at_voxel(loaded: &Loaded, voxel: Vec3, axis: Option<usize>) -> Pointed {
    let layer = loaded.rock.as_ref().map(|rock| rock.model.region_at(voxel).layer);
    let raw = loaded.raw.as_ref().and_then(|raw| loaded.volumes.iter().find(|volume| volume.name == raw.volume));
    let value = raw.map(|raw| raw.named().sample(voxel));
    let leaf = loaded.candidates.as_ref().and_then(|candidates| candidates.leaf_at(voxel));
    Pointed { voxel: voxel.as_dvec3(), axis, layer, value: value.filter(|value| !value.is_nan()), leaf }
}

/// The place in words: line numbers, time or depth with its unit, value, layer.
pub(crate) fn sentence(pointed: &Pointed, document: &project::document::Document) -> String {
    let Some(geometry) = &document.geometry else { return String::new() };
    let lines = geometry.lines_from_voxel(pointed.voxel.truncate());
    let z = geometry.vertical.value_at(pointed.voxel.z);
    let mut text =
        format!("inline {:.0}   crossline {:.0}   {:.1} {}", lines.x, lines.y, z, geometry.vertical.unit.symbol());
    if let Some(value) = pointed.value {
        text += &format!("   value {}", five_digits(value));
    }
    let names = document.stratigraphy().layer_names_bottom_up();
    if let Some(name) =
        pointed.layer.filter(|_| !document.horizons.is_empty()).and_then(|layer| names.get(usize::from(layer)))
    {
        text += &format!("   {name}");
    }
    text
}

/// What a click there selects while interpreting, and the horizon that has it already.
pub(crate) fn picked(pointed: &Pointed, has: impl Fn(u32) -> Option<String>) -> String {
    let Some(LeafFacts { leaf, triangles, levels }) = pointed.leaf else {
        return "no leaf is near".to_owned();
    };
    let plural = if levels == 1 { "" } else { "s" };
    let of = has(leaf).map_or_else(String::new, |horizon| format!(", part of {horizon}"));
    format!("a click selects leaf {leaf}: {triangles} triangles, {levels} level{plural} to climb{of}")
}

/// A number with five significant digits.
fn five_digits(value: f32) -> String {
    let power = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    match usize::try_from(4 - power) {
        Err(_) => format!("{value:.0}"),
        Ok(decimals) if decimals <= 8 => format!("{value:.decimals$}"),
        Ok(_) => format!("{value:.4e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_digits_that_tell() {
        let shown = [20762.605, -1855.0, 0.0, 0.031_25, -3.25e-9, 1.5e7].map(five_digits);
        assert_eq!(shown, ["20763", "-1855.0", "0.0000", "0.031250", "-3.2500e-9", "15000000"]);
    }
}
