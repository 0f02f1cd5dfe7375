//! Bodies that take the place of rock: `kind = "pluton"`, `kind = "pipe"`.
//!
//! A pluton is an ellipsoid with a wavy outline; within `aureole` of it rock is baked to `baked`. A pipe is a cone that
//! narrows downwards.
//!
//! ```text
//! pluton: |(p − at) / (r, r, h)| ≤ 1 + w, w waves of the direction        pipe: |map − at| ≤ r₀ + (r₁ − r₀) z / depth
//! ```

use crate::context::Context;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::noise::unit;
use glam::DVec3;
use std::f64::consts::TAU;

/// A body of igneous rock.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its rock.
    pub rock: String,
    /// Name, as stated.
    pub name: Option<String>,
    at: DVec3,
    form: Form,
    /// Width of the baked rim, m, and its rock.
    pub aureole: Option<(f64, String)>,
    /// How large it is already, 0 … 1.
    share: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    /// Half axes, waviness, phases of its waves.
    Ellipsoid { half: DVec3, waves: f64, phases: [f64; 4] },
    /// Radii at the depth of `at` and at the bottom, and the length between.
    Cone { top: f64, bottom: f64, length: f64 },
}

impl Body {
    pub(crate) fn read_pluton(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let rock = context.rock_or(fields, "rock", "granite")?;
        let name = fields.maybe_text("name")?;
        let radius = fields.number("radius", Within::Positive, "half of its width in m")?;
        let height = fields.or("height", Within::Positive, radius)?;
        let at = fields.place("at", context.centre().with_z(context.size.z))?;
        let waves = fields.or("roughness", Within::Between(0.0, 0.4), 0.08)?;
        let seed = fields.count("seed", 1_000_000, 1)? as u64;
        let phases = [0, 1, 2, 3].map(|n| TAU * unit(seed.wrapping_mul(4) + n));
        let form = Form::Ellipsoid { half: DVec3::new(radius, radius, height), waves, phases };
        Ok(Self { rock, name, at, form, aureole: aureole(fields, context)?, share: 1.0 })
    }

    pub(crate) fn read_pipe(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let rock = context.rock_or(fields, "rock", "breccia")?;
        let name = fields.maybe_text("name")?;
        let top = fields.number("radius", Within::Positive, "its radius at its top in m")?;
        let bottom = fields.or("base_radius", Within::NotNegative, 0.3 * top)?;
        let at = fields.place("at", context.centre())?;
        let length = fields.or("length", Within::Positive, (context.size.z - at.z).max(1.0))?;
        let form = Form::Cone { top, bottom, length };
        Ok(Self { rock, name, at, form, aureole: aureole(fields, context)?, share: 1.0 })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { share, ..self.clone() }
    }

    /// Distance from the outline in m, about; negative inside.
    fn off(&self, p: DVec3) -> f64 {
        let local = p - self.at;
        match self.form {
            Form::Ellipsoid { half, waves, phases } => {
                let half = half * self.share.max(1e-9);
                let r = local / half;
                let (turn, rise) = (r.y.atan2(r.x), r.z.atan2(r.truncate().length()));
                let level = rise.cos();
                let wave = (3.0 * turn + phases[0]).sin() * level * level
                    + 0.6 * (5.0 * turn + 2.0 * rise + phases[1]).sin() * level * level
                    + 0.7 * (4.0 * rise + phases[2]).sin()
                    + 0.4 * (7.0 * rise + phases[3]).cos() * level;
                (r.length() - 1.0 - waves * wave) * half.min_element()
            }
            Form::Cone { top, bottom, length } => {
                let radius = top + (bottom - top) * (local.z / length).clamp(0.0, 1.0);
                let beyond = (local.z - length * self.share.max(1e-9)).max(-local.z);
                (local.truncate().length() - radius * self.share).max(beyond)
            }
        }
    }

    /// Whether a place lies within the body: its share of the way up, 0 … 1.
    pub(crate) fn within(&self, p: DVec3) -> Option<f64> {
        let height = match self.form {
            Form::Ellipsoid { half, .. } => 0.5 - 0.5 * (p.z - self.at.z) / half.z,
            Form::Cone { length, .. } => 1.0 - (p.z - self.at.z) / length,
        };
        (self.share > 0.0 && self.off(p) <= 0.0).then_some(height)
    }

    /// The rock to which a place outside is baked.
    pub(crate) fn bakes(&self, p: DVec3) -> bool {
        self.share > 0.0 && self.aureole.as_ref().is_some_and(|(width, _)| self.off(p) <= width * self.share)
    }
}

fn aureole(fields: &Fields<'_>, context: &Context<'_>) -> Result<Option<(f64, String)>, HistoryError> {
    let width = fields.or("aureole", Within::NotNegative, 0.0)?;
    let rock = context.rock_or(fields, "baked", "hornfels")?;
    Ok((width > 0.0).then_some((width, rock)))
}
