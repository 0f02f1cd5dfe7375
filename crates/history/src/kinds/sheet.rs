//! Sills and laccoliths: `kind = "sill"`, `kind = "laccolith"`.
//!
//! Magma spreads on a level or dipping floor and lifts what lies above it by its thickness:
//!
//! ```text
//! sill: t = T (1 − r⁸)        laccolith: t = T (1 − r²)²        r the distance from `at` in radii, 0 beyond 1
//! z = z′ − t(x, y) above the floor, z = z′ below it
//! ```

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::Frame;
use glam::{DVec2, DVec3};

/// What a sheet is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SheetKind {
    /// As thick nearly to its rim.
    Sill,
    /// Thickest in its middle.
    Laccolith,
}

/// A sheet of magma that lifts its roof.
#[derive(Debug, Clone, PartialEq)]
pub struct IntrusiveSheet {
    /// What it is like.
    pub kind: SheetKind,
    /// Its rock.
    pub rock: String,
    /// Name, as stated.
    pub name: Option<String>,
    /// Greatest thickness, m.
    pub thickness_m: f64,
    /// Middle of its floor, along the direction of its dip.
    frame: Frame,
    slope: f64,
    /// Radii, or as far as the block goes.
    radius: Option<f64>,
}

impl IntrusiveSheet {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>, kind: SheetKind) -> Result<Self, HistoryError> {
        let usual = if kind == SheetKind::Sill { "dolerite" } else { "granite" };
        let rock = context.rock_or(fields, "rock", usual)?;
        let name = fields.maybe_text("name")?;
        let thickness_m = fields.number("thickness", Within::Positive, "its greatest thickness in m")?;
        let depth = fields.maybe("depth", Within::Any)?;
        let at = fields.place("at", context.centre().with_z(depth.unwrap_or(0.5 * context.size.z)))?;
        let at = depth.map_or(at, |depth| at.with_z(depth));
        let radius = fields.maybe("radius", Within::Positive)?;
        let radius = if kind == SheetKind::Laccolith { radius.or(Some(0.25 * context.longest())) } else { radius };
        let slope = fields.or("dip", Within::Between(0.0, 60.0), 0.0)?.to_radians().tan();
        let frame = Frame::new(at, fields.or("direction", Within::Between(-360.0, 360.0), 90.0)?);
        Ok(Self { kind, rock, name, thickness_m, frame, slope, radius })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { thickness_m: self.thickness_m * share, ..self.clone() }
    }

    fn thickness(&self, map: DVec2) -> f64 {
        let r = self.radius.map_or(0.0, |radius| (map / radius).length());
        let share = match self.kind {
            SheetKind::Sill => 1.0 - r.powi(8),
            SheetKind::Laccolith => (1.0 - r * r).max(0.0).powi(2),
        };
        self.thickness_m * share.max(0.0)
    }

    /// Thickness at a place of the map, and height above the floor.
    fn above(&self, p: DVec3) -> (f64, f64) {
        let local = self.frame.local(p);
        (self.thickness(local.truncate()), self.slope * local.y - local.z)
    }

    /// Its radius, if it does not go on as far as the block.
    pub(crate) fn radius(&self) -> Option<f64> {
        self.radius
    }

    /// A place on its floor (0) or its roof (1), m from its middle.
    pub(crate) fn wall(&self, on: DVec2, height: f64) -> DVec3 {
        self.frame.place(on.extend(self.slope * on.y - height * self.thickness(on)))
    }

    /// Where in the sheet a place lies: 0 on its floor, 1 under its roof.
    pub(crate) fn within(&self, p: DVec3) -> Option<f64> {
        let (thickness, above) = self.above(p);
        (thickness > 0.0 && above >= 0.0 && above <= thickness).then(|| above / thickness)
    }
}

impl Deformation for IntrusiveSheet {
    fn undo(&self, p: DVec3, _: i8) -> DVec3 {
        let (thickness, above) = self.above(p);
        p + DVec3::Z * above.clamp(0.0, thickness)
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        let (thickness, above) = self.above(q);
        if above > 0.0 { q - DVec3::Z * thickness } else { q }
    }
}
