//! Beds that are laid down one on the other: `kind = "beds"`.
//!
//! Beds are stacked down from their common top: the base of a bed lies as deep as the thicknesses of it and of all
//! beds above it add up to, at each place of the map. The lowest bed goes on below its thickness, down to what was there
//! before. What lies higher than the beds' top is not covered, what lies deeper is filled: beds onlap it.
//!
//! ```text
//! base_n(x, y) = top + Σ_{m ≥ n} t_m(x, y)        k = (base_n − z) / t_n, 0 at the base of a bed and 1 at its top
//! ```
//!
//! | thickness | t(x, y) |
//! |---|---|
//! | even | T |
//! | `to` | from T to `to` along `direction`, over the block's width or `over` = [from, to] from its centre; a wedge for 0 |
//! | lens | T (1 − r²), r the distance from `at` in half widths |
//! | channel | T (1 − (d/w)²), d the distance from its axis, which may meander; it is cut into what lies below |

use crate::context::Context;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::Frame;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Beds of one event.
#[derive(Debug, Clone, PartialEq)]
pub struct Beds {
    /// Depth of their common top, m.
    pub top_m: f64,
    /// Oldest first.
    pub beds: Vec<Bed>,
    /// How much of them is there, 0 … 1: the upper part is laid down last.
    share: f64,
}

/// A bed.
#[derive(Debug, Clone, PartialEq)]
pub struct Bed {
    /// Its name, as stated; otherwise that of its rock.
    pub name: Option<String>,
    /// Its rock.
    pub rock: String,
    /// Its greatest thickness, m.
    pub thickness_m: f64,
    /// How its thickness changes over the map.
    thickness: Thickness,
    /// Where its rock is another one.
    pub facies: Option<Facies>,
    /// The line of the text.
    pub line: usize,
}

/// How a thickness changes over the map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Thickness {
    Even,
    /// From one thickness at v = `from` of the frame to another at v = `end`.
    Wedge {
        frame: Frame,
        from: f64,
        end: f64,
        from_m: f64,
        to_m: f64,
    },
    /// Half axes across and along the frame.
    Lens {
        frame: Frame,
        half: DVec2,
    },
    /// Along the frame.
    Channel {
        frame: Frame,
        half_width: f64,
        meander_m: f64,
        wavelength: f64,
    },
}

/// A change of rock within a bed, with teeth of one rock in the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Facies {
    /// The rock on the far side.
    pub rock: String,
    frame: Frame,
    /// Length of the teeth, m, and how many lie over one another.
    tooth_m: f64,
    teeth: f64,
}

/// A place within beds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct InBeds {
    /// Which bed, 0 = oldest.
    pub bed: usize,
    /// Whether its rock is that of the far side of a change of facies.
    pub is_far: bool,
    /// 0 at its base, 1 at its top.
    pub k: f64,
}

impl Facies {
    fn is_far(&self, p: DVec3, k: f64) -> bool {
        // A zigzag between 0 at whole numbers and 1 between them.
        let phase = (k * self.teeth).rem_euclid(1.0);
        let tooth = 1.0 - (2.0 * phase - 1.0).abs();
        self.frame.local(p).y > self.tooth_m * (tooth - 0.5)
    }
}

impl Bed {
    /// Thickness at a place of the map, m.
    pub(crate) fn thickness_at(&self, map: DVec2) -> f64 {
        let p = map.extend(0.0);
        match self.thickness {
            Thickness::Even => self.thickness_m,
            Thickness::Wedge { frame, from, end, from_m, to_m } => {
                let share = ((frame.local(p).y - from) / (end - from)).clamp(0.0, 1.0);
                from_m + (to_m - from_m) * share
            }
            Thickness::Lens { frame, half } => {
                let r = (frame.local(p).truncate() / half).length_squared();
                self.thickness_m * (1.0 - r).max(0.0)
            }
            Thickness::Channel { frame, half_width, meander_m, wavelength } => {
                let local = frame.local(p);
                let d = local.x - meander_m * (TAU * local.y / wavelength).sin();
                self.thickness_m * (1.0 - (d / half_width).powi(2)).max(0.0)
            }
        }
    }

    /// Whether it is cut into what lies below.
    pub(crate) fn is_cut(&self) -> bool {
        matches!(self.thickness, Thickness::Channel { .. })
    }
}

impl Beds {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let top_m = fields.or("top", Within::Any, 0.0)?;
        let tables = fields.tables("beds", "a bed")?;
        if tables.is_empty() {
            return Err(fields.unfit(
                "beds",
                "beds need `beds`, a list of the rocks from the oldest up, such as \
                 beds = [ { rock = \"shale\", thickness = 150, name = \"Shale\" } ]",
            ));
        }
        let beds = tables.iter().map(|table| bed(table, context)).collect::<Result<_, _>>()?;
        Ok(Self { top_m, beds, share: 1.0 })
    }

    /// A single bed that fills what is there, up to a depth; `usual` is its thickness unless it states one.
    pub(crate) fn of_growth(
        fields: &Fields<'_>,
        context: &Context<'_>,
        top_m: f64,
        usual: f64,
    ) -> Result<Self, HistoryError> {
        let bed = Bed {
            name: fields.maybe_text("name")?,
            rock: context.rock(fields, "rock", "the name of its rock")?,
            thickness_m: fields.or("thickness", Within::Positive, usual.max(1.0))?,
            thickness: Thickness::Even,
            facies: None,
            line: fields.line(),
        };
        fields.finish()?;
        Ok(Self { top_m, beds: vec![bed], share: 1.0 })
    }

    /// As much of them as is there after a share of the event.
    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { share, ..self.clone() }
    }

    /// Thickness of all of them at a place of the map, m.
    pub(crate) fn thickness_at(&self, map: DVec2) -> f64 {
        self.beds.iter().filter(|bed| !bed.is_cut()).map(|bed| bed.thickness_at(map)).sum()
    }

    /// Which bed is at a place, if the beds cover it where nothing else is.
    pub(crate) fn at(&self, p: DVec3) -> Option<InBeds> {
        let map = p.truncate();
        if p.z < self.top_m || self.share < 1.0 && p.z < self.top_m + (1.0 - self.share) * self.thickness_at(map) {
            return None;
        }
        let mut top = self.top_m;
        for (n, bed) in self.beds.iter().enumerate().rev() {
            let thickness = bed.thickness_at(map);
            if p.z < top + thickness || n == 0 {
                let k = self.k_below(n, top, thickness, p.z);
                let is_far = bed.facies.as_ref().is_some_and(|facies| facies.is_far(p, k));
                return Some(InBeds { bed: n, is_far, k });
            }
            if !bed.is_cut() {
                top += thickness;
            }
        }
        None
    }

    /// k of a depth in a bed whose top is known.
    fn k_below(&self, bed: usize, top: f64, thickness: f64, z: f64) -> f64 {
        // The fill of a channel is as level as its top. The lowest bed has a base even where it thins to nothing.
        let is_level = self.beds[bed].is_cut() || thickness <= 0.0;
        let thickness = if is_level { self.beds[bed].thickness_m } else { thickness };
        1.0 - (z - top) / thickness
    }

    /// Depth of the top of a bed at a place of the map.
    pub(crate) fn top_of(&self, bed: usize, map: DVec2) -> f64 {
        let above = self.beds[bed + 1..].iter().filter(|above| !above.is_cut());
        self.top_m + above.map(|above| above.thickness_at(map)).sum::<f64>()
    }

    /// k of a bed at any place, continued beyond the bed.
    pub(crate) fn k_of(&self, bed: usize, p: DVec3) -> f64 {
        let map = p.truncate();
        self.k_below(bed, self.top_of(bed, map), self.beds[bed].thickness_at(map), p.z)
    }

    /// Depths of the top of all beds and of the base that is bounded, the top of the lowest one. A bed alone has no base; it
    /// is as thick as it states.
    pub(crate) fn bounded_zone(&self, map: DVec2) -> [f64; 2] {
        let base = self.top_of(0, map);
        [self.top_m, if base > self.top_m { base } else { self.top_m + self.thickness_at(map) }]
    }
}

fn bed(fields: &Fields<'_>, context: &Context<'_>) -> Result<Bed, HistoryError> {
    let rock = context.rock(fields, "rock", "the name of its rock")?;
    let stated = fields.number("thickness", Within::Positive, "its thickness in m")?;
    let name = fields.maybe_text("name")?;
    let thickness = thickness(fields, context, stated)?;
    let thickness_m = match thickness {
        Thickness::Wedge { from_m, to_m, .. } => from_m.max(to_m),
        _ => stated,
    };
    let facies = match fields.has("into") {
        true => {
            let at = fields.place("boundary", context.centre())?;
            Some(Facies {
                rock: context.rock(fields, "into", "the rock on the far side")?,
                frame: Frame::new(at, fields.or("direction", Within::Any, 90.0)?),
                tooth_m: fields.or("tooth", Within::NotNegative, 0.0)?,
                teeth: fields.count("teeth", 100, 3)? as f64,
            })
        }
        false => None,
    };
    fields.finish()?;
    Ok(Bed { name, rock, thickness_m, thickness, facies, line: fields.line() })
}

/// Shapes of beds.
#[derive(Debug, Clone, Copy)]
enum Shape {
    Even,
    Lens,
    Channel,
}

fn thickness(fields: &Fields<'_>, context: &Context<'_>, stated: f64) -> Result<Thickness, HistoryError> {
    let words = [("even", Shape::Even), ("lens", Shape::Lens), ("channel", Shape::Channel)];
    let shape = fields.word("shape", &words)?;
    if let (Some(to_m), Shape::Even) = (fields.maybe("to", Within::NotNegative)?, shape) {
        let frame = Frame::new(context.centre(), fields.or("direction", Within::Any, 90.0)?);
        let half = context.half_width(frame.along);
        let over = fields.numbers("over", &[2], "[from, to], two distances from the centre in m")?;
        let over = over.unwrap_or_else(|| vec![-half, half]);
        if over[1] <= over[0] {
            return Err(
                fields.unfit("over", "`over` = [from, to] must grow: thickness changes from the first to the second")
            );
        }
        return Ok(Thickness::Wedge { frame, from: over[0], end: over[1], from_m: stated, to_m });
    }
    match shape {
        Shape::Even => Ok(Thickness::Even),
        Shape::Lens => {
            let frame = Frame::new(fields.place("at", context.centre())?, fields.or("axis", Within::Any, 0.0)?);
            let width = fields.number("width", Within::Positive, "the width of the lens in m")?;
            let length = fields.or("length", Within::Positive, width)?;
            Ok(Thickness::Lens { frame, half: 0.5 * DVec2::new(width, length) })
        }
        Shape::Channel => {
            let frame = Frame::new(fields.place("at", context.centre())?, fields.or("axis", Within::Any, 0.0)?);
            let width = fields.number("width", Within::Positive, "the width of the channel in m")?;
            Ok(Thickness::Channel {
                frame,
                half_width: 0.5 * width,
                meander_m: fields.or("meander", Within::NotNegative, 0.0)?,
                wavelength: fields.or("wavelength", Within::Positive, 8.0 * width)?,
            })
        }
    }
}
