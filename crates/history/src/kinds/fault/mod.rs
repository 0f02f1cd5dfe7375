//! Faults: `kind = "fault"`.
//!
//! A fault dips to the right of its strike. With a positive slip its hanging wall moves down the dip (normal), with a
//! negative one up (reverse); `dextral` and `sinistral` move it along strike. The foot wall stays, except at a fault with a
//! tip, where both walls move by half. With `growth`, beds are laid down while it slips.

mod listric;
mod planar;
mod ramp;

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::{HistoryError, Problem};
use crate::fields::{Fields, Within};
use crate::frame::Frame;
use crate::kinds::{Act, Beds, Uplift};
use glam::{DVec2, DVec3};
use listric::Listric;
use planar::{Plane, Tip};
use ramp::Ramp;

/// A fault and its slip.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Its name, as stated.
    pub name: Option<String>,
    /// Direction of its strike, degrees clockwise from north.
    pub strike_deg: f64,
    /// Its dip, degrees; where it is steepest, if it bends.
    pub dip_deg: f64,
    /// Slip of the hanging wall down the dip, m; negative: up.
    pub slip_m: f64,
    /// Movement of the hanging wall to the right of who looks at it across the fault, m.
    pub dextral_m: f64,
    /// Through the place where it was stated to lie, along strike.
    frame: Frame,
    form: Form,
    surface: Surface,
}

/// What decides how its walls move.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Planar {
        tip: Option<Tip>,
    },
    /// Depth of the detachment below `at`, dip of the planes of shear.
    Listric {
        detachment: f64,
        shear_deg: f64,
    },
    /// Depths of the flats below `at`.
    Ramp {
        upper: Option<f64>,
        lower: Option<f64>,
    },
}

/// The surface with the slip.
#[derive(Debug, Clone, PartialEq)]
enum Surface {
    Planar(Plane),
    Listric(Listric),
    Ramp(Ramp),
}

/// Words for shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Planar,
    Listric,
    Ramp,
}

/// Runs a method of the surface, whatever its shape.
macro_rules! of_surface {
    ($surface:expr, $bound:ident => $call:expr) => {
        match $surface {
            Surface::Planar($bound) => $call,
            Surface::Listric($bound) => $call,
            Surface::Ramp($bound) => $call,
        }
    };
}

impl Fault {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let shape =
            fields.word("shape", &[("planar", Shape::Planar), ("listric", Shape::Listric), ("ramp", Shape::Ramp)])?;
        let name = fields.maybe_text("name")?;
        let at = fields.place("at", context.centre())?;
        let strike_deg = fields.or("strike", Within::Between(-360.0, 360.0), 0.0)?;
        let usual = if shape == Shape::Ramp { 25.0 } else { 60.0 };
        let dip_deg = fields.or("dip", Within::Between(1.0, 90.0), usual)?;
        let form = form(fields, context, shape, at, dip_deg)?;
        let dextral_m = match (fields.maybe("dextral", Within::Any)?, fields.maybe("sinistral", Within::Any)?) {
            (Some(_), Some(_)) => {
                return Err(fields.wrong("sinistral", Problem::Twice { one: "dextral", other: "sinistral" }));
            }
            (dextral, sinistral) => dextral.or(sinistral.map(|m| -m)).unwrap_or(0.0),
        };
        let (slip_m, key) = slip(fields, &form, dip_deg, dextral_m)?;
        context.fits(fields, key, slip_m)?;
        context.fits(fields, if fields.has("dextral") { "dextral" } else { "sinistral" }, dextral_m)?;
        let frame = Frame::new(at, strike_deg);
        let surface = form.surface(dip_deg, slip_m, dextral_m);
        if let Surface::Planar(plane) = &surface
            && !plane.is_gentle()
        {
            let said = "the slip is too large for the fault's `extent`: beds would fold over at its tip; its shorter axis \
                        must be more than 1.6 times the slip";
            return Err(fields.unfit("extent", said));
        }
        Ok(Self { name, strike_deg, dip_deg, slip_m, dextral_m, frame, form, surface })
    }

    /// The same fault when a share of its slip has happened.
    pub(crate) fn progressed(&self, share: f64) -> Self {
        let (slip_m, dextral_m) = (self.slip_m * share, self.dextral_m * share);
        Self { slip_m, dextral_m, surface: self.form.surface(self.dip_deg, slip_m, dextral_m), ..self.clone() }
    }

    /// Vertical separation that the slip gives beds at `at`, m; positive: the hanging wall is lower.
    pub fn throw_m(&self) -> f64 {
        let local = of_surface!(&self.surface, surface => surface.apply(DVec3::ZERO, true));
        let foot = of_surface!(&self.surface, surface => surface.apply(DVec3::ZERO, false));
        local.z - foot.z
    }

    /// Depths of its line in (u, depth) below `at`, across a block, and how it continues along strike.
    pub(crate) fn trace(&self, depths: [f64; 2], far: f64) -> Vec<DVec2> {
        match &self.surface {
            Surface::Planar(plane) => plane.trace(depths),
            Surface::Listric(listric) => listric.trace(-depths[0].min(0.0), far),
            Surface::Ramp(ramp) => ramp.trace(far),
        }
    }

    /// Half axes of its tip line along strike and down the dip, if it ends within the block.
    pub(crate) fn tip(&self) -> Option<DVec2> {
        match &self.surface {
            Surface::Planar(plane) => plane.tip().map(|tip| tip.half),
            _ => None,
        }
    }

    /// "planar", "listric" or "ramp", as the text says it.
    pub(crate) fn shape_word(&self) -> &'static str {
        match self.form {
            Form::Planar { .. } => "planar",
            Form::Listric { .. } => "listric",
            Form::Ramp { .. } => "ramp",
        }
    }

    /// Its coordinates across and along strike.
    pub(crate) fn frame(&self) -> &Frame {
        &self.frame
    }
}

impl Form {
    fn surface(&self, dip_deg: f64, slip_m: f64, dextral_m: f64) -> Surface {
        // Dextral moves the hanging wall, which lies to the right of strike, against strike.
        let along = -dextral_m;
        match *self {
            Self::Planar { tip } => Surface::Planar(Plane::new(dip_deg, slip_m, along, tip)),
            Self::Listric { detachment, shear_deg } => {
                Surface::Listric(Listric::new(dip_deg, detachment, shear_deg, slip_m, along))
            }
            Self::Ramp { upper, lower } => Surface::Ramp(Ramp::new(dip_deg, upper, lower, slip_m, along)),
        }
    }
}

fn form(
    fields: &Fields<'_>,
    context: &Context<'_>,
    shape: Shape,
    at: DVec3,
    dip_deg: f64,
) -> Result<Form, HistoryError> {
    let [extent, reach] = [fields.pair("extent", Within::Positive)?, fields.pair("reach", Within::Positive)?];
    let detachment = fields.maybe("detachment", Within::Any)?;
    let shear_deg = fields.or("shear", Within::Between(30.0, 90.0), 90.0)?;
    let flats = fields.numbers("flats", &[2], "[upper, lower], two depths in m")?;
    let only = |key: &'static str, of: &str| {
        Err(fields
            .unfit(key, format!("`{key}` belongs to a fault with shape = \"{of}\"; state this shape, or leave it out")))
    };
    match shape {
        Shape::Planar if detachment.is_some() => only("detachment", "listric"),
        Shape::Planar if flats.is_some() => only("flats", "ramp"),
        Shape::Listric | Shape::Ramp if extent.is_some() => only("extent", "planar"),
        Shape::Planar => {
            let tip = extent.map(|extent| Tip {
                half: 0.5 * extent,
                reach: reach.map_or(0.5 * extent.min_element(), |reach| reach.x),
            });
            Ok(Form::Planar { tip })
        }
        Shape::Listric => {
            let detachment = detachment.unwrap_or(context.size.z) - at.z;
            if detachment <= 0.0 || dip_deg == 90.0 {
                let said =
                    "a listric fault flattens downwards: its `detachment` lies deeper than `at`, and `dip` is below 90";
                return Err(fields.unfit("detachment", said));
            }
            Ok(Form::Listric { detachment, shear_deg })
        }
        Shape::Ramp => {
            let flats = flats.unwrap_or_else(|| vec![0.25 * context.size.z, 0.75 * context.size.z]);
            // Unless its place is stated, a ramp is seen in the middle of the block at half of its height.
            if flats[1] <= flats[0] || dip_deg >= 80.0 {
                return Err(
                    fields.unfit("flats", "`flats` = [upper, lower] must grow, and the ramp between them dip below 80")
                );
            }
            Ok(Form::Ramp { upper: Some(flats[0] - at.z), lower: Some(flats[1] - at.z) })
        }
    }
}

/// Slip down the dip and the key that states it.
fn slip(fields: &Fields<'_>, form: &Form, dip_deg: f64, dextral_m: f64) -> Result<(f64, &'static str), HistoryError> {
    match (fields.maybe("slip", Within::Any)?, fields.maybe("throw", Within::Any)?) {
        (Some(_), Some(_)) => Err(fields.wrong("throw", Problem::Twice { one: "slip", other: "throw" })),
        (Some(slip), None) => Ok((slip, "slip")),
        (None, Some(throw)) => {
            let slip = match form {
                Form::Listric { detachment, .. } if throw < *detachment => {
                    Listric::slip_of_throw(dip_deg, *detachment, throw)
                }
                Form::Listric { detachment, .. } => {
                    let said = format!(
                        "a throw of {throw:.0} m is more than the detachment allows, which lies {detachment:.0} m below"
                    );
                    return Err(fields.unfit("throw", said));
                }
                _ => throw / dip_deg.to_radians().sin(),
            };
            Ok((slip, "throw"))
        }
        (None, None) if dextral_m != 0.0 => Ok((0.0, "slip")),
        (None, None) => Ok((
            fields.number("slip", Within::Any, "how far its hanging wall moves down the dip in m (up: negative)")?,
            "slip",
        )),
    }
}

/// A fault, or with `growth` its slip in as many steps as there are beds: each is laid down when its share of the slip has
/// happened, up to the depth `top`. `subsidence` lowers the whole block meanwhile, so that the foot wall is covered too.
pub(crate) fn read_with_growth(fields: &Fields<'_>, context: &Context<'_>) -> Result<Vec<Act>, HistoryError> {
    let fault = Fault::read(fields, context)?;
    let sinks = fields.or("subsidence", Within::NotNegative, 0.0)?;
    let top_m = fields.or("top", Within::Any, 0.0)?;
    let tables = fields.tables("growth", "a growth bed")?;
    if tables.is_empty() {
        return Ok(vec![Act::Fault(fault)]);
    }
    let steps = tables.len() as f64;
    let each = (fault.throw_m().abs() + sinks) / steps;
    let mut acts = Vec::new();
    for (n, table) in tables.iter().enumerate() {
        // The fault goes down with the block: it lies where it is stated to lie when all has happened.
        let later = sinks * (steps - 1.0 - n as f64) / steps + sinks / steps;
        let mut part = fault.progressed(1.0 / steps);
        part.frame.at.z -= later;
        acts.push(Act::Fault(part));
        if sinks > 0.0 {
            acts.push(Act::Uplift(Uplift { amount_m: -sinks / steps }));
        }
        acts.push(Act::Beds(Beds::of_growth(table, context, top_m, each)?));
    }
    Ok(acts)
}

impl Deformation for Fault {
    fn offset(&self, p: DVec3) -> Option<f64> {
        let local = self.frame.local(p);
        Some(of_surface!(&self.surface, surface => surface.offset(local)))
    }

    fn undo(&self, p: DVec3, side: i8) -> DVec3 {
        let local = self.frame.local(p);
        self.frame.place(of_surface!(&self.surface, surface => surface.undo(local, side > 0)))
    }

    fn apply(&self, q: DVec3, side: i8) -> DVec3 {
        let local = self.frame.local(q);
        self.frame.place(of_surface!(&self.surface, surface => surface.apply(local, side > 0)))
    }
}
