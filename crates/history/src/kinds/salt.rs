//! Salt that rises: `kind = "salt"`.
//!
//! The salt comes out of a bed between two depths. What lies above the bed moves up by R(x, y), what lies below stays, and
//! the bed between them swells or is drawn out in proportion.
//!
//! ```text
//! pillow: R = H cos²(π r / 2)        diapir: R = U exp(−(d/w)²) − S exp(−((d − 2.2 w) / w)²)
//! ```
//!
//! A diapir is a stem that widens to a head; d is the distance from the stem, 0 within it: beside it beds are dragged up,
//! and farther away they sink into a ring, the minibasin.

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
    /// Depths of the top and the base of the bed that the salt comes from.
    source: [f64; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Diapir {
        stem: f64,
        head: f64,
        /// Depths of the top and of the widest part.
        top: f64,
        neck: f64,
        drag: f64,
        sink: f64,
        width: f64,
    },
    Pillow {
        half: DVec2,
        height: f64,
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
        let unfit = || fields.unfit("base", "the salt's `base` must lie deeper than its `top`");
        let (form, bed_m) = match shape {
            Shape::Diapir => {
                let top = fields.or("top", Within::Any, 0.15 * context.size.z)?;
                let head = fields.or("head", Within::Positive, 1.5 * radius)?.max(radius);
                let height = fields.or("head_height", Within::Positive, 0.25 * (base - top).max(1.0))?;
                let drag = fields.or("drag", Within::Any, 0.2 * (base - top))?;
                let width = fields.or("reach", Within::Positive, radius)?;
                let sink = fields.or("sink", Within::Any, 0.3 * drag)?;
                let bed_m = fields.or("source", Within::Positive, (2.0 * sink).max(0.2 * (base - top)))?;
                if sink >= 0.95 * bed_m || -drag >= 0.95 * bed_m {
                    let said = "beds cannot sink farther than the bed of salt below them is thick; state a smaller `sink` \
                                or a thicker `source`";
                    return Err(fields.unfit("sink", said));
                }
                (Form::Diapir { stem: radius, head, top, neck: top + height, drag, sink, width }, bed_m)
            }
            Shape::Pillow => {
                let top = fields.number("top", Within::Any, "the depth of the top of the bed of salt in m")?;
                let height = fields.number("height", Within::Positive, "how far the pillow swells in m")?;
                let length = fields.or("length", Within::Positive, 2.0 * radius)?;
                (Form::Pillow { half: DVec2::new(radius, 0.5 * length), height }, base - top)
            }
        };
        let is_below = match form {
            Form::Diapir { top, .. } => base > top,
            Form::Pillow { .. } => bed_m > 0.0,
        };
        if is_below { Ok(Self { rock, name, at, form, source: [base - bed_m, base] }) } else { Err(unfit()) }
    }

    /// Whether it bulges below its roof and pierces nothing.
    pub(crate) fn is_pillow(&self) -> bool {
        matches!(self.form, Form::Pillow { .. })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        let base = self.source[1];
        let form = match self.form {
            Form::Diapir { stem, head, top, neck, drag, sink, width } => {
                let rise = |depth: f64| base - share * (base - depth);
                let (top, neck) = (rise(top), rise(neck));
                Form::Diapir { stem, head, top, neck, drag: drag * share, sink: sink * share, width }
            }
            Form::Pillow { half, height } => Form::Pillow { half, height: height * share },
        };
        Self { form, ..self.clone() }
    }

    /// Whether a place lies in the diapir: its share of the way up.
    pub(crate) fn within(&self, p: DVec3) -> Option<f64> {
        let Form::Diapir { stem, head, top, neck, .. } = self.form else { return None };
        let base = self.source[1];
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
        let ([top, base], rise) = (self.source, self.rise(p.truncate()));
        let swollen = (base - p.z) * (base - top) / (base - top + rise);
        p.with_z(if p.z <= top - rise {
            p.z + rise
        } else if p.z < base {
            base - swollen
        } else {
            p.z
        })
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        let ([top, base], rise) = (self.source, self.rise(q.truncate()));
        let swollen = (base - q.z) * (base - top + rise) / (base - top);
        q.with_z(if q.z <= top {
            q.z - rise
        } else if q.z < base {
            base - swollen
        } else {
            q.z
        })
    }
}
