//! Marches a ray through the media: before, in and after cut-outs, to the face that stops it (P-illus 5.1,
//! figure 10).
//!
//! A stretch of optical length ℓ is divided into n = ⌈ℓ·samples⌉ equal steps, which are sampled in their
//! middles:
//!
//! ```text
//! C ← C + T·αᵢ·cᵢ      T ← T·(1 − αᵢ)      αᵢ = 1 − exp(−κᵢ·ℓ/n)
//! ```
//!
//! so a homogeneous medium absorbs exactly 1 − e^(−κℓ). Steps in empty bricks are skipped. A ray ends early
//! when its transmittance falls below `SPENT`. Voxel space; t in voxels along the ray.

use super::Faces;
use super::field::{Matter, MediaField};
use super::light::LightVolume;
use super::medium::Zone;
use super::preparation::BRICK;
use super::stretches::{Stretch, stretches};
use super::table::absorbed;
use crate::visible::{Ray, Solid};
use glam::Vec3;

/// Transmittance at which a ray ends (early ray termination).
pub(crate) const SPENT: f32 = 1.0e-3;

/// The result of a march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gathered {
    /// Linear colour, premultiplied.
    pub colour: Vec3,
    /// Fraction of the light from behind that arrives.
    pub transmittance: f32,
}

impl Default for Gathered {
    fn default() -> Self {
        Self { colour: Vec3::ZERO, transmittance: 1.0 }
    }
}

/// Integrates the media along a ray between two distances.
pub fn gather(
    field: &MediaField,
    light: Option<&LightVolume>,
    solid: &Solid,
    ray: &Ray,
    between: [f32; 2],
) -> Gathered {
    let mut gathered = Gathered::default();
    let along = field.display_from_voxel * ray.direction;
    let metres = along.length();
    let towards = -along / metres;
    stretches(solid, ray, between, |stretch| {
        let path = Path { field, light, ray, towards, units: metres / field.unit_m };
        // The inside of rock whose faces are drawn is not visible.
        if gathered.transmittance > SPENT && (stretch.zone == Zone::CutOut || field.faces != Faces::All) {
            path.through(stretch, &mut gathered, |_, _| true);
        }
    });
    gathered
}

/// What each step of a ray needs.
struct Path<'a> {
    field: &'a MediaField<'a>,
    light: Option<&'a LightVolume>,
    ray: &'a Ray,
    towards: Vec3,
    /// Units of length per voxel of t.
    units: f32,
}

impl Path<'_> {
    /// Marches through a stretch. `seen` receives the position and opacity of every visible step, and ends
    /// the march by returning `false`.
    fn through(&self, stretch: Stretch, gathered: &mut Gathered, mut seen: impl FnMut(f32, f32) -> bool) {
        let [from, to] = stretch.t;
        let length = (to - from) * self.units;
        let steps = (length * self.field.samples_per_unit).ceil().max(1.0);
        let (step_t, step) = ((to - from) / steps, length / steps);
        let steps = steps as u32;
        let shift = if stretch.zone == Zone::CutOut { 8 } else { 0 };
        let bricks = &self.field.bricks;
        let mut n = 0;
        while n < steps {
            let brick = bricks.at(self.ray.at(from + (n as f32 + 0.5) * step_t));
            let word = bricks.word(brick);
            let distance = (word >> shift & 255) as i32;
            let exit = exit_t(self.ray, brick, (distance - 1).max(0));
            // Clamped before the conversion to an integer, since the exit may be infinite.
            let next = ((exit - from) / step_t + 0.5).ceil().clamp((n + 1) as f32, steps as f32) as u32;
            if distance == 0 {
                for n in n..next {
                    let t = from + (n as f32 + 0.5) * step_t;
                    let p = self.ray.at(t);
                    let matter = self.field.at(p, stretch.zone, word, self.towards);
                    if matter.extinction > 0.0 {
                        let alpha = absorbed(matter.extinction * step);
                        gathered.colour += self.shaded(&matter, p) * (alpha * gathered.transmittance);
                        gathered.transmittance *= 1.0 - alpha;
                        if !seen(t, alpha) || gathered.transmittance <= SPENT {
                            return;
                        }
                    }
                }
            }
            n = next;
        }
    }

    /// The light that a point sends to the viewer.
    #[inline(always)]
    fn shaded(&self, matter: &Matter, p: Vec3) -> Vec3 {
        match self.light {
            Some(light) => matter.colour * light.at(p) + matter.emission,
            None => matter.colour + matter.emission,
        }
    }
}

/// Distance along the ray at which it leaves a brick that is grown by `around` bricks on every side.
#[inline(always)]
fn exit_t(ray: &Ray, brick: [i32; 3], around: i32) -> f32 {
    let mut exit = f32::MAX;
    for (axis, first) in brick.into_iter().enumerate() {
        let d = ray.direction[axis];
        if d.abs() > 1e-6 {
            let border = if d > 0.0 { first + 1 + around } else { first - around };
            exit = exit.min(((border * BRICK as i32) as f32 - ray.origin[axis]) / d);
        }
    }
    exit
}

/// The first visible point on a ray before `stop`: the distance along the ray, and the zone.
pub(crate) fn first_seen(field: &MediaField, solid: &Solid, ray: &Ray, stop: f32) -> Option<(f32, Zone)> {
    let along = field.display_from_voxel * ray.direction;
    let mut found = None;
    stretches(solid, ray, [f32::MIN, stop], |stretch| {
        let looked_into = stretch.zone == Zone::CutOut || field.faces != Faces::All;
        if found.is_none() && looked_into {
            let towards = -along.normalize_or_zero();
            let path = Path { field, light: None, ray, towards, units: along.length() / field.unit_m };
            path.through(stretch, &mut Gathered::default(), |t, alpha| {
                if alpha > 0.02 {
                    found = Some((t, stretch.zone));
                }
                found.is_none()
            });
        }
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brick_is_left_where_its_border_is() {
        let ray = Ray { origin: Vec3::new(1.0, 2.0, 30.0), direction: Vec3::new(0.6, 0.0, -0.8) };
        assert!((exit_t(&ray, [0, 0, 3], 0) - 6.0 / 0.8).abs() < 1e-5);
        assert!((exit_t(&ray, [0, 0, 3], 1) - 14.0 / 0.8).abs() < 1e-5);
    }
}
