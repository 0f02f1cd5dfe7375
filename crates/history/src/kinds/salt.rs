//! Salt that rises: `kind = "salt"`.
//!
//! A **diapir** is a stem that widens to a head; beside it beds are dragged up, and farther away they sink into a ring, the
//! minibasin:
//!
//! ```text
//! z = z′ − U exp(−(d/w)²) + S exp(−((d − 2.2 w) / w)²)        d the distance from the stem, 0 within it
//! ```
//!
//! A **pillow** swells between two depths, `top` and `base` of the bed of salt: above the top beds are lifted by a bump
//! of height H, below the base by nothing, and between them in proportion.

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;

/// A diapir or a pillow.
#[derive(Debug, Clone, PartialEq)]
pub struct Salt {
    /// Its rock.
    pub rock: String,
    /// Name, as stated.
    pub name: Option<String>,
    at: DVec3,
    form: Form,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Diapir {
        stem: f64,
        head: f64,
        /// Depths of the top, of the widest part and of the bottom.
        top: f64,
        neck: f64,
        base: f64,
        drag: f64,
        sink: f64,
        width: f64,
    },
    Pillow {
        half: DVec2,
        height: f64,
        top: f64,
        base: f64,
    },
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    Diapir,
    Pillow,
}

impl Salt {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let rock = context.rock_or(fields, "rock", "rock salt")?;
        let name = fields.maybe_text("name")?;
        let shape = fields.word("shape", &[("diapir", Shape::Diapir), ("pillow", Shape::Pillow)])?;
        let at = fields.place("at", context.centre())?;
        let radius = fields.number("radius", Within::Positive, "the radius of its stem, or of the pillow, in m")?;
        let base = fields.or("base", Within::Any, context.size.z)?;
        let form = match shape {
            Shape::Diapir => {
                let top = fields.or("top", Within::Any, 0.15 * context.size.z)?;
                let head = fields.or("head", Within::Positive, 1.5 * radius)?;
                let neck = fields.or("head_height", Within::Positive, 0.25 * (base - top).max(1.0))?;
                let drag = fields.or("drag", Within::Any, 0.25 * (base - top))?;
                let width = fields.or("reach", Within::Positive, radius)?;
                let sink = fields.or("sink", Within::Any, 0.3 * drag)?;
                if base <= top {
                    return Err(fields.unfit("base", "the salt's `base` must lie deeper than its `top`"));
                }
                Form::Diapir { stem: radius, head: head.max(radius), top, neck: top + neck, base, drag, sink, width }
            }
            Shape::Pillow => {
                let top = fields.number("top", Within::Any, "the depth of the top of the bed of salt in m")?;
                let height = fields.number("height", Within::Positive, "how far the pillow swells in m")?;
                let length = fields.or("length", Within::Positive, 2.0 * radius)?;
                if base <= top {
                    return Err(fields.unfit("base", "the bed's `base` must lie deeper than its `top`"));
                }
                Form::Pillow { half: DVec2::new(radius, 0.5 * length), height, top, base }
            }
        };
        Ok(Self { rock, name, at, form })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        let form = match self.form {
            Form::Diapir { stem, head, top, neck, base, drag, sink, width } => {
                let rise = |depth: f64| base - share * (base - depth);
                let (top, neck) = (rise(top), rise(neck));
                Form::Diapir { stem, head, top, neck, base, drag: drag * share, sink: sink * share, width }
            }
            Form::Pillow { half, height, top, base } => Form::Pillow { half, height: height * share, top, base },
        };
        Self { form, ..self.clone() }
    }

    /// Whether a place lies in the diapir: its share of the way up.
    pub(crate) fn within(&self, p: DVec3) -> Option<f64> {
        let Form::Diapir { stem, head, top, neck, base, .. } = self.form else { return None };
        if p.z < top || p.z > base || base <= top {
            return None;
        }
        // The head is an ellipse round its widest part; below, the outline swings in to the stem and out again at the base.
        let radius = if p.z < neck {
            head * (1.0 - ((neck - p.z) / (neck - top)).powi(2)).max(0.0).sqrt()
        } else {
            let down = (p.z - neck) / (base - neck).max(1e-9);
            let swing = (FRAC_PI_2 * 2.0 * down).cos();
            stem + (head - stem) * if down < 0.5 { swing.max(0.0).powi(2) } else { 0.6 * (-swing).max(0.0).powi(4) }
        };
        ((p - self.at).truncate().length() <= radius).then(|| (base - p.z) / (base - top))
    }

    /// How far up beds are moved at a place of the map.
    fn rise(&self, map: DVec2) -> f64 {
        match self.form {
            Form::Diapir { stem, drag, sink, width, .. } => {
                let d = ((map - self.at.truncate()).length() - stem).max(0.0) / width;
                drag * (-d * d).exp() - sink * (-(d - 2.2).powi(2)).exp()
            }
            Form::Pillow { half, height, .. } => {
                let r = ((map - self.at.truncate()) / half).length().min(1.0);
                height * (FRAC_PI_2 * r).cos().powi(2)
            }
        }
    }
}

impl Deformation for Salt {
    fn undo(&self, p: DVec3, _: i8) -> DVec3 {
        let rise = self.rise(p.truncate());
        let z = match self.form {
            Form::Diapir { .. } => p.z + rise,
            Form::Pillow { top, base, .. } if p.z > top - rise => {
                if p.z >= base {
                    p.z
                } else {
                    base - (base - p.z) * (base - top) / (base - top + rise)
                }
            }
            Form::Pillow { .. } => p.z + rise,
        };
        p.with_z(z)
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        let rise = self.rise(q.truncate());
        let z = match self.form {
            Form::Pillow { top, base, .. } if q.z > top => {
                if q.z >= base {
                    q.z
                } else {
                    base - (base - q.z) * (base - top + rise) / (base - top)
                }
            }
            _ => q.z - rise,
        };
        q.with_z(z)
    }
}
