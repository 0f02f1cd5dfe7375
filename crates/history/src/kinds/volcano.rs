//! A volcano: `kind = "volcano"`: lava and ash on the ground, and the pipe that fed them.
//!
//! Its cone stands on the depth of `at`: z = z₀ − H (1 − r/R)^1.4, with a crater of the pipe's radius; layers of lava lie
//! parallel to its flanks.

use crate::context::Context;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use glam::{DVec2, DVec3};

/// A cone and its pipe.
#[derive(Debug, Clone, PartialEq)]
pub struct Volcano {
    /// Its rock.
    pub rock: String,
    /// Rock of every second layer.
    pub ash: String,
    /// Name, as stated.
    pub name: Option<String>,
    at: DVec3,
    height_m: f64,
    radius_m: f64,
    pipe_m: f64,
    layers: f64,
    share: f64,
}

/// A place in a volcano.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum InVolcano {
    /// In the pipe, at this depth below the cone's foot, m.
    Pipe(f64),
    /// In the cone: in a layer of ash or of lava, at this share of its height.
    Cone { is_ash: bool, k: f64 },
}

impl Volcano {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let rock = context.rock_or(fields, "rock", "basalt")?;
        let ash = context.rock_or(fields, "ash", "tuff")?;
        let name = fields.maybe_text("name")?;
        let radius_m = fields.number("radius", Within::Positive, "the radius of its cone in m")?;
        let height_m = fields.or("height", Within::Positive, 0.4 * radius_m)?;
        let pipe_m = fields.or("pipe", Within::Positive, 0.06 * radius_m)?;
        let layers = fields.count("layers", 100, 6)?.max(1) as f64;
        let at = fields.place("at", context.centre())?;
        Ok(Self { rock, ash, name, at, height_m, radius_m, pipe_m, layers, share: 1.0 })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { share, ..self.clone() }
    }

    /// Height of the cone's flank at a distance from its axis, m.
    fn flank(&self, r: f64) -> f64 {
        let shape = |r: f64| (1.0 - r / self.radius_m).max(0.0).powf(1.4);
        // Within the crater the ground is as high as at half of its rim.
        let crater = 1.6 * self.pipe_m;
        let dip = if r < crater { 0.35 * (1.0 - r / crater) } else { 0.0 };
        self.height_m * (shape(r) - dip * shape(crater))
    }

    /// Where in it a place lies, if it does; `is_air` tells whether nothing was there before.
    pub(crate) fn within(&self, p: DVec3, is_air: bool) -> Option<InVolcano> {
        let local = p - self.at;
        let r = DVec2::new(local.x, local.y).length();
        if self.share <= 0.0 {
            return None;
        }
        if r < self.pipe_m && (!is_air || -local.z <= 0.6 * self.share * self.flank(0.0)) {
            return Some(InVolcano::Pipe(local.z));
        }
        // Layers are even shares of the height below the present flank.
        let share = -local.z / (self.share * self.flank(r)).max(1e-9);
        if !is_air || -local.z > self.share * self.flank(r) || r >= self.radius_m {
            return None;
        }
        let at = share.max(0.0) * self.layers;
        Some(InVolcano::Cone { is_ash: (at as usize) % 2 == 1, k: at.fract() })
    }
}
