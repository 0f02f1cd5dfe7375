//! Folds: `kind = "fold"`.
//!
//! **Similar** folds move rock along their axial planes by A f(c), c the distance of the axial plane through a place from
//! that of the crest, measured on the level:
//!
//! ```text
//! p = q + e A f(c)        c = u − z cot δ        e = (−cos δ, −sin δ) in (u, z), δ the dip of the axial planes
//! ```
//!
//! Upright, rock moves vertically. Inclined planes make folds asymmetric, then overturned; nearly level ones recumbent.
//! **Parallel** folds are in [`parallel`]. A plunge turns the folded block afterwards so that its hinges plunge to where the
//! axis points. A dome is a bump of elliptic outline, f = cos²(π r / 2).

mod parallel;
mod profile;

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::{HistoryError, Problem};
use crate::fields::{Fields, Within};
use crate::frame::{Frame, turned};
use glam::{DVec2, DVec3};
use parallel::Bend;
use profile::Profile;
use std::f64::consts::FRAC_PI_2;

/// A fold or a train of folds.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// From crest to crest, or the width of a dome, m.
    pub wavelength_m: f64,
    /// Half the height from trough to crest, or the height of a dome or the step of a monocline, m.
    pub amplitude_m: f64,
    /// Trend of the axis, degrees clockwise from north.
    pub axis_deg: f64,
    /// How steeply hinges plunge to where the axis points, degrees.
    pub plunge_deg: f64,
    /// Through the crest, along the axis.
    frame: Frame,
    form: Form,
}

/// How rock moves in a fold.
#[derive(Debug, Clone, PartialEq)]
enum Form {
    /// Along axial planes that dip by this angle, degrees.
    Similar { profile: Profile, axial_dip_deg: f64 },
    /// Flexural slip.
    Parallel { profile: Profile, zone: [f64; 2], bend: Bend },
    /// A bump; half axes across and along the axis.
    Dome { half: DVec2 },
}

/// Words for shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Line(Profile),
    Dome,
    Basin,
}

/// Words for styles.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Style {
    Similar,
    Parallel,
}

impl Fold {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let wavelength_m = fields.number("wavelength", Within::Positive, "the distance from crest to crest in m")?;
        let meaning = "half the height from trough to crest in m";
        let amplitude_m = fields.number("amplitude", Within::Any, meaning)?;
        let axis_deg = fields.or("axis", Within::Between(-360.0, 360.0), 0.0)?;
        let plunge_deg = fields.or("plunge", Within::Between(-80.0, 80.0), 0.0)?;
        let words = [("similar", Style::Similar), ("parallel", Style::Parallel)];
        let style = fields.word("style", &words)?;
        let words = [
            ("sine", Shape::Line(Profile::Sine)),
            ("chevron", Shape::Line(Profile::CHEVRON)),
            ("box", Shape::Line(Profile::BOX)),
            ("monocline", Shape::Line(Profile::Monocline)),
            ("dome", Shape::Dome),
            ("basin", Shape::Basin),
        ];
        let shape = fields.word("shape", &words)?;
        let axial_dip = fields.maybe("axial_dip", Within::Between(2.0, 178.0))?;
        let zone = fields.numbers("zone", &[2], "[top, base], two depths in m")?;
        let length = fields.maybe("length", Within::Positive)?;
        let middle = zone.as_ref().map_or(context.zone, |zone| [zone[0], zone[1]]);
        let is_parallel = style == Style::Parallel;
        let depth = if is_parallel { 0.5 * (middle[0] + middle[1]) } else { 0.0 };
        let at = fields.place("at", context.centre().with_z(depth))?;
        if let (Some(_), false) = (&zone, is_parallel) {
            return Err(fields.unfit("zone", "`zone` says which beds stay parallel: it needs style = \"parallel\""));
        }
        let frame = Frame::new(at, axis_deg);
        let mut sign = 1.0;
        let form = match (shape, style) {
            (Shape::Line(profile), Style::Similar) => {
                Form::Similar { profile, axial_dip_deg: axial_dip.unwrap_or(90.0) }
            }
            (Shape::Line(_), Style::Parallel) if axial_dip.is_some() => {
                let said = "parallel folds stand upright here; leave out `axial_dip`, or leave out `style`";
                return Err(fields.unfit("axial_dip", said));
            }
            (Shape::Line(profile), Style::Parallel) => {
                let zone = [middle[0] - at.z, middle[1] - at.z];
                let profile = fitting(fields, profile, wavelength_m, amplitude_m, zone)?;
                Form::Parallel { profile, zone, bend: Bend::new(profile, wavelength_m, amplitude_m, zone) }
            }
            (Shape::Dome | Shape::Basin, Style::Parallel) => {
                let said = "beds of a dome cannot all stay parallel and keep their lengths; leave out `style`";
                return Err(fields.unfit("style", said));
            }
            (Shape::Dome | Shape::Basin, Style::Similar) => {
                sign = if shape == Shape::Basin { -1.0 } else { 1.0 };
                Form::Dome { half: 0.5 * DVec2::new(wavelength_m, length.unwrap_or(wavelength_m)) }
            }
        };
        Ok(Self { wavelength_m, amplitude_m: sign * amplitude_m, axis_deg, plunge_deg, frame, form })
    }

    /// Its shape as the text says it; a basin is a dome of negative amplitude.
    pub(crate) fn shape_word(&self) -> &'static str {
        match &self.form {
            Form::Dome { .. } => "dome",
            Form::Similar { profile, .. } | Form::Parallel { profile, .. } => match profile {
                Profile::Sine => "sine",
                Profile::Chevron(_) => "chevron",
                Profile::Box(_) => "box",
                Profile::Monocline => "monocline",
            },
        }
    }

    /// The same fold when a share of it has been folded.
    pub(crate) fn progressed(&self, share: f64) -> Self {
        let amplitude_m = self.amplitude_m * share;
        let form = match &self.form {
            Form::Parallel { profile, zone, .. } => {
                let bend = Bend::new(*profile, self.wavelength_m, amplitude_m, *zone);
                Form::Parallel { profile: *profile, zone: *zone, bend }
            }
            other => other.clone(),
        };
        Self { amplitude_m, plunge_deg: self.plunge_deg * share, form, ..self.clone() }
    }

    fn plunged(&self, local: DVec3, deg: f64) -> DVec3 {
        if deg == 0.0 {
            return local;
        }
        let (v, z) = turned(local.y, local.z, deg.to_radians().sin_cos());
        DVec3::new(local.x, v, z)
    }

    /// Moves a place along the axial plane, one way or back.
    fn sheared(&self, local: DVec3, sign: f64) -> DVec3 {
        match &self.form {
            Form::Similar { profile, axial_dip_deg } => {
                let (sin, cos) = axial_dip_deg.to_radians().sin_cos();
                let cos = if cos.abs() < 1e-15 { 0.0 } else { cos };
                let by = sign * self.amplitude_m * profile.at(local.x - local.z * cos / sin, self.wavelength_m).value;
                local - DVec3::new(cos, 0.0, sin) * by
            }
            Form::Dome { half } => {
                let r = (local.truncate() / *half).length().min(1.0);
                local - DVec3::Z * (sign * self.amplitude_m * (FRAC_PI_2 * r).cos().powi(2))
            }
            Form::Parallel { bend, .. } => {
                let (u, z) = if sign > 0.0 { bend.apply(local.x, local.z) } else { bend.undo(local.x, local.z) };
                DVec3::new(u, local.y, z)
            }
        }
    }
}

/// The form with hinges round enough for the beds of the zone.
fn fitting(
    fields: &Fields<'_>,
    profile: Profile,
    wavelength: f64,
    amplitude: f64,
    zone: [f64; 2],
) -> Result<Profile, HistoryError> {
    let reach_m = zone[0].abs().max(zone[1].abs());
    let fits = |profile: &Profile| reach_m < 0.97 * Bend::radius(*profile, wavelength, amplitude);
    let found = std::iter::once(profile).chain(profile.rounder()).find(fits);
    found.ok_or_else(|| {
        let radius_m = Bend::radius(profile.rounder().pop().unwrap_or(profile), wavelength, amplitude);
        fields.wrong("style", Problem::TooTight { radius_m, reach_m })
    })
}

impl Deformation for Fold {
    fn undo(&self, p: DVec3, _: i8) -> DVec3 {
        let local = self.plunged(self.frame.local(p), -self.plunge_deg);
        self.frame.place(self.sheared(local, -1.0))
    }

    fn apply(&self, q: DVec3, _: i8) -> DVec3 {
        let local = self.sheared(self.frame.local(q), 1.0);
        self.frame.place(self.plunged(local, self.plunge_deg))
    }
}
