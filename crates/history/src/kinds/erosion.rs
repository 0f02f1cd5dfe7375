//! Everything above a surface is gone: `kind = "erosion"`.
//!
//! The surface is level at `depth`, or dips through the block's centre at that depth; `roughness` adds waves of that height
//! out of a seed.

use crate::context::Context;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::Frame;
use crate::noise::Waves;
use glam::{DVec2, DVec3};

/// A surface down to which rock is taken away.
#[derive(Debug, Clone, PartialEq)]
pub struct Erosion {
    /// Name of the surface, as stated.
    pub name: Option<String>,
    /// Depth at the block's centre, m.
    pub depth_m: f64,
    frame: Frame,
    /// Tangent of its dip.
    slope: f64,
    rough: Option<(f64, Waves)>,
    /// How far above its place the surface still is, m.
    raised_m: f64,
    /// How far it comes down.
    reach_m: f64,
}

impl Erosion {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let name = fields.maybe_text("name")?;
        let depth_m = fields.number("depth", Within::Any, "the depth in m above which everything is gone")?;
        let dip = fields.or("dip", Within::Between(0.0, 60.0), 0.0)?;
        let direction = fields.or("direction", Within::Between(-360.0, 360.0), 90.0)?;
        let height = fields.or("roughness", Within::NotNegative, 0.0)?;
        let wavelength = fields.or("wavelength", Within::Positive, 0.4 * context.longest())?;
        let seed = fields.count("seed", 1_000_000, 1)? as u64;
        let rough = (height > 0.0).then(|| (height, Waves::new(seed, wavelength)));
        let frame = Frame::new(context.centre(), direction);
        let reach_m = context.size.z + depth_m.max(0.0);
        Ok(Self { name, depth_m, frame, slope: dip.to_radians().tan(), rough, raised_m: 0.0, reach_m })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { raised_m: (1.0 - share) * self.reach_m, ..self.clone() }
    }

    /// Depth of the surface at a place of the map.
    pub(crate) fn depth_at(&self, map: DVec2) -> f64 {
        let rough = self.rough.as_ref().map_or(0.0, |(height, waves)| height * waves.at(map));
        self.depth_m + self.slope * self.frame.local(map.extend(0.0)).y - rough - self.raised_m
    }

    /// Whether rock at a place is gone.
    pub(crate) fn takes(&self, p: DVec3) -> bool {
        p.z < self.depth_at(p.truncate())
    }
}
