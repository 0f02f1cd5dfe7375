//! Dykes: `kind = "dyke"`.
//!
//! A dyke opens a crack: its walls move apart by its thickness, half to each side, and what lay on the plane lies on its
//! two walls. A dyke with an `extent` is a lens that ends on all sides and takes the place of rock. A swarm has several,
//! `spacing` apart along `array`; where this is oblique to the strike, they stand en échelon.

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::Frame;
use glam::{DVec2, DVec3};

/// One or several parallel dykes.
#[derive(Debug, Clone, PartialEq)]
pub struct Dyke {
    /// Its rock.
    pub rock: String,
    /// Name, as stated.
    pub name: Option<String>,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Through the middle of the dykes, along strike.
    frame: Frame,
    /// Unit vectors down the dip and across, to the right of the strike, in (u, v, depth).
    down: DVec3,
    across: DVec3,
    /// Middle of each dyke, as (off the plane, along strike).
    middles: Vec<DVec2>,
    /// Half axes along strike and down the dip.
    half: Option<DVec2>,
}

impl Dyke {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let rock = context.rock_or(fields, "rock", "basalt")?;
        let name = fields.maybe_text("name")?;
        let strike = fields.or("strike", Within::Between(-360.0, 360.0), 0.0)?;
        let dip = fields.or("dip", Within::Between(20.0, 90.0), 90.0)?;
        let thickness_m = fields.number("thickness", Within::Positive, "the distance of its walls in m")?;
        context.fits(fields, "thickness", thickness_m)?;
        let half = fields.pair("extent", Within::Positive)?.map(|extent| 0.5 * extent);
        let count = fields.count("count", 100, 1)?.max(1);
        let spacing = fields.or("spacing", Within::Positive, 8.0 * thickness_m)?;
        let array = fields.or("array", Within::Between(-360.0, 360.0), strike + 90.0)?;
        let frame = Frame::new(fields.place("at", context.centre())?, strike);
        let (sin, cos) = if dip == 90.0 { (1.0, 0.0) } else { dip.to_radians().sin_cos() };
        let (down, across) = (DVec3::new(cos, 0.0, sin), DVec3::new(sin, 0.0, -cos));
        let (array_sin, array_cos) = (array - strike).to_radians().sin_cos();
        let middle = |n: usize| {
            let along = (n as f64 - 0.5 * (count as f64 - 1.0)) * spacing;
            DVec2::new(along * array_sin * sin, along * array_cos)
        };
        let middles: Vec<DVec2> = (0..count).map(middle).collect();
        let is_crowded = middles.windows(2).any(|pair| (pair[1].x - pair[0].x).abs() < thickness_m);
        if half.is_none() && is_crowded {
            let said = "the dykes of the swarm lie in one another; state a larger `spacing` or another `array`";
            return Err(fields.unfit("spacing", said));
        }
        Ok(Self { rock, name, thickness_m, frame, down, across, middles, half })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { thickness_m: self.thickness_m * share, ..self.clone() }
    }

    /// Distance from the middle of the swarm's plane.
    fn off(&self, p: DVec3) -> (DVec3, f64) {
        let local = self.frame.local(p);
        (local, local.dot(self.across))
    }

    /// How many dykes there are, and the half axes of each if it ends within the block.
    pub(crate) fn outlines(&self) -> (usize, Option<DVec2>) {
        (self.middles.len(), self.half)
    }

    /// A place on the wall of a dyke, m along strike and down the dip from its middle; `sign` is 1 for its right wall and
    /// −1 for its left one.
    pub(crate) fn wall(&self, dyke: usize, on: DVec2, sign: f64) -> DVec3 {
        let r = self.half.map_or(0.0, |half| (on / half).length_squared());
        let off = self.middles[dyke].x + sign * 0.5 * self.thickness_m * (1.0 - r).max(0.0).sqrt();
        self.frame.place(self.across * off + DVec3::Y * (self.middles[dyke].y + on.x) + self.down * on.y)
    }

    /// Where in a dyke a place lies: 0 at its left wall, 1 at its right one.
    pub(crate) fn within(&self, p: DVec3) -> Option<f64> {
        let (local, off) = self.off(p);
        let inside = |middle: &DVec2| {
            let r = self
                .half
                .map_or(0.0, |half| (DVec2::new(local.y - middle.y, local.dot(self.down)) / half).length_squared());
            let thickness = self.thickness_m * (1.0 - r).max(0.0).sqrt();
            let from = off - middle.x + 0.5 * thickness;
            (thickness > 0.0 && from >= 0.0 && from <= thickness).then(|| from / thickness)
        };
        self.middles.iter().find_map(inside)
    }
}

impl Deformation for Dyke {
    fn undo(&self, p: DVec3, _: i8) -> DVec3 {
        if self.half.is_some() {
            return p;
        }
        let (_, off) = self.off(p);
        let opened: f64 = self
            .middles
            .iter()
            .map(|middle| (off - middle.x).clamp(-0.5 * self.thickness_m, 0.5 * self.thickness_m))
            .sum();
        p - self.frame.direction(self.across * opened)
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        if self.half.is_some() || self.thickness_m == 0.0 {
            return q;
        }
        let (_, off) = self.off(q);
        let count = self.middles.len() as f64;
        let mut middles: Vec<f64> = self.middles.iter().map(|middle| middle.x).collect();
        middles.sort_unstable_by(f64::total_cmp);
        // Before it opened, dyke n lay where those left and right of it had not yet moved it.
        let before = |n: usize| middles[n] - 0.5 * self.thickness_m * (2.0 * n as f64 + 1.0 - count);
        let passed = (0..middles.len()).filter(|&n| off > before(n)).count() as f64;
        q + self.frame.direction(self.across * (0.5 * self.thickness_m * (2.0 * passed - count)))
    }
}
