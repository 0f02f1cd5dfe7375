//! Independent ways back through events, a few lines each, and the text of the same events.

use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// The block of all these tests, and its beds from the oldest up.
pub(crate) const SIZE: DVec3 = DVec3::new(4000.0, 3000.0, 1500.0);
pub(crate) const BEDS: [(&str, f64); 4] = [("Basement", 900.0), ("Lime", 200.0), ("Shale", 150.0), ("Sand", 250.0)];

/// The text of the block and its beds.
pub(crate) fn beds_text() -> String {
    let rocks = ["granite", "limestone", "shale", "sandstone"];
    let beds = BEDS.iter().zip(rocks);
    let beds: Vec<String> = beds
        .map(|((name, thickness), rock)| format!("{{ rock = \"{rock}\", thickness = {thickness}, name = \"{name}\" }}"))
        .collect();
    format!("size = [4000, 3000, 1500]\n[[events]]\nkind = \"beds\"\nbeds = [{}]\n", beds.join(", "))
}

/// The bed and k at an undeformed depth: `None` above the beds.
pub(crate) fn bed_at(z: f64) -> Option<(&'static str, f64)> {
    let mut top = 0.0;
    for (n, (name, thickness)) in BEDS.iter().enumerate().rev() {
        if z < 0.0 {
            return None;
        }
        if z < top + thickness || n == 0 {
            return Some((name, 1.0 - (z - top) / thickness));
        }
        top += thickness;
    }
    None
}

/// An event: its text, and what was at a place after it, seen from before; `None` for air.
pub(crate) struct Event {
    pub text: String,
    pub back: Box<dyn Fn(DVec3) -> Option<DVec3> + Sync>,
}

/// Numbers that are the same in each run.
pub(crate) struct Draws(pub u64);

impl Draws {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let x = (self.0 >> 33) ^ (self.0 >> 13);
        (x.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        (low + (high - low) * self.unit()).round()
    }

    pub(crate) fn place(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * SIZE
    }
}

fn compass(deg: f64) -> DVec3 {
    DVec3::new(deg.to_radians().sin(), deg.to_radians().cos(), 0.0)
}

fn centre() -> DVec3 {
    DVec3::new(2000.0, 1500.0, 0.0)
}

pub(crate) fn tilt(d: &mut Draws) -> Event {
    let (dip, direction) = (d.between(2.0, 35.0), d.between(0.0, 359.0));
    // Turns the direction of the dip down: about the level axis to the right of it, in coordinates with depth downwards.
    let turn = DQuat::from_axis_angle(compass(direction).cross(DVec3::Z).normalize(), dip.to_radians());
    let down = turn * compass(direction);
    let turn = if down.z > 0.0 { turn } else { turn.inverse() };
    Event {
        text: format!("[[events]]\nkind = \"tilt\"\ndip = {dip}\ndirection = {direction}\n"),
        back: Box::new(move |p| Some(centre() + turn.inverse() * (p - centre()))),
    }
}

pub(crate) fn fold(d: &mut Draws) -> Event {
    let (wavelength, amplitude, axis) = (d.between(800.0, 2500.0), d.between(30.0, 250.0), d.between(0.0, 180.0));
    let across = compass(axis + 90.0);
    Event {
        text: format!(
            "[[events]]\nkind = \"fold\"\nwavelength = {wavelength}\namplitude = {amplitude}\naxis = {axis}\n"
        ),
        back: Box::new(move |p| {
            let phase = TAU * (p - centre()).dot(across) / wavelength;
            Some(p + DVec3::Z * amplitude * phase.cos())
        }),
    }
}

pub(crate) fn overturned_fold(d: &mut Draws) -> Event {
    let (wavelength, amplitude, dip) = (d.between(900.0, 1500.0), d.between(300.0, 600.0), d.between(25.0, 60.0));
    let rad = f64::to_radians(dip);
    Event {
        text: format!(
            "[[events]]\nkind = \"fold\"\nwavelength = {wavelength}\namplitude = {amplitude}\naxial_dip = {dip}\n"
        ),
        // Along the axial plane through p up to the level, where the phase is measured.
        back: Box::new(move |p| {
            let on_level = p.x - 2000.0 - p.z / rad.tan();
            let by = amplitude * (TAU * on_level / wavelength).cos();
            Some(p + DVec3::new(by * rad.cos(), 0.0, by * rad.sin()))
        }),
    }
}

pub(crate) fn fault(d: &mut Draws) -> Event {
    let (strike, dip, slip) = (d.between(0.0, 359.0), d.between(25.0, 88.0), d.between(-350.0, 350.0));
    let (x, y, dextral) = (d.between(1200.0, 2800.0), d.between(900.0, 2100.0), d.between(-300.0, 300.0));
    let right = compass(strike + 90.0);
    let down = right * f64::to_radians(dip).cos() + DVec3::Z * f64::to_radians(dip).sin();
    // Up and to the right of the strike: into the hanging wall.
    let normal = right * f64::to_radians(dip).sin() - DVec3::Z * f64::to_radians(dip).cos();
    Event {
        text: format!(
            "[[events]]\nkind = \"fault\"\nat = [{x}, {y}, 0]\nstrike = {strike}\ndip = {dip}\nslip = {slip}\ndextral = {dextral}\n"
        ),
        back: Box::new(move |p| {
            let is_hanging = (p - DVec3::new(x, y, 0.0)).dot(normal) > 0.0;
            Some(if is_hanging { p - down * slip + compass(strike) * dextral } else { p })
        }),
    }
}

pub(crate) fn erosion(d: &mut Draws) -> Event {
    let depth = d.between(10.0, 200.0);
    Event {
        text: format!("[[events]]\nkind = \"erosion\"\ndepth = {depth}\n"),
        back: Box::new(move |p| (p.z >= depth).then_some(p)),
    }
}

pub(crate) fn listric(d: &mut Draws) -> Event {
    let (dip, slip) = (d.between(45.0, 75.0), d.between(100.0, 500.0));
    let steep = f64::to_radians(dip).tan();
    let depth = move |x: f64| if x < 0.0 { x * steep } else { 1400.0 * (1.0 - (-x * steep / 1400.0).exp()) };
    // Steps of a centimetre along the fault until the slip is reached: the heave.
    let (mut heave, mut length) = (0.0, 0.0);
    while length < slip {
        length += (depth(heave + 0.01) - depth(heave)).hypot(0.01);
        heave += 0.01;
    }
    Event {
        text: format!(
            "[[events]]\nkind = \"fault\"\nshape = \"listric\"\nat = [1500, 1500, 0]\ndip = {dip}\nslip = {slip}\ndetachment = 1400\n"
        ),
        back: Box::new(move |p| {
            let x = p.x - 1500.0;
            let is_hanging = p.z < depth(x);
            let raised = depth(x - heave) - depth(x);
            Some(if is_hanging { DVec3::new(p.x - heave, p.y, p.z + raised) } else { p })
        }),
    }
}

pub(crate) fn tipped(d: &mut Draws) -> Event {
    let (dip, slip) = (d.between(40.0, 80.0), d.between(50.0, 250.0));
    let (sin, cos) = f64::to_radians(dip).sin_cos();
    let (down, normal) = (DVec3::new(cos, 0.0, sin), DVec3::new(sin, 0.0, -cos));
    let at = DVec3::new(2000.0, 1500.0, 600.0);
    let slip_at = move |q: DVec3| {
        let o = q - at;
        let r2 = (o.y / 1000.0).powi(2) + (o.dot(down) / 600.0).powi(2);
        let half = if o.dot(normal) > 0.0 { 0.5 } else { -0.5 };
        half * slip * (1.0 - r2).max(0.0).powi(2) * (-(o.dot(normal) / 600.0).powi(2)).exp()
    };
    Event {
        text: format!(
            "[[events]]\nkind = \"fault\"\nat = [2000, 1500, 600]\ndip = {dip}\nslip = {slip}\nextent = [2000, 1200]\n"
        ),
        // The place before is that from which the slip leads here.
        back: Box::new(move |p| Some((0..60).fold(p, |q, _| p - down * slip_at(q)))),
    }
}

pub(crate) fn ramp(d: &mut Draws) -> Event {
    let (dip, slip) = (d.between(15.0, 30.0), d.between(300.0, 900.0));
    let tan = f64::to_radians(dip).tan();
    // Bends at the depths 300 and 1100 of a ramp through (2000, 700).
    let bends = [2000.0 - 400.0 / tan, 2000.0 + 400.0 / tan];
    let lean = (0.5 * f64::to_radians(dip)).tan();
    // Which of the flats or the ramp is below a place: bisectors lean back by half of the dip.
    let piece = move |p: DVec3| {
        let past = |x: f64, z: f64| p.x + (p.z - z) * lean > x;
        usize::from(past(bends[0], 300.0)) + usize::from(past(bends[1], 1100.0))
    };
    let height = move |p: DVec3| match piece(p) {
        0 => 300.0 - p.z,
        1 => 700.0 + (p.x - 2000.0) * tan - p.z,
        _ => 1100.0 - p.z,
    };
    Event {
        text: format!(
            "[[events]]\nkind = \"fault\"\nshape = \"ramp\"\nat = [2000, 1500, 700]\ndip = {dip}\nslip = -{slip}\nflats = [300, 1100]\n"
        ),
        // Small steps down along the fault, each in the direction of what is below.
        back: Box::new(move |p| {
            if height(p) <= 0.0 {
                return Some(p);
            }
            let rad = f64::to_radians(dip);
            let mut q = p;
            let steps = 1500;
            for _ in 0..steps {
                let way = if piece(q) == 1 { DVec3::new(rad.cos(), 0.0, rad.sin()) } else { DVec3::X };
                q += way * slip / f64::from(steps);
            }
            Some(q)
        }),
    }
}

pub(crate) fn parallel_fold(d: &mut Draws) -> Event {
    let (wavelength, amplitude) = (d.between(1500.0, 2500.0), d.between(40.0, 100.0));
    // Bounded beds lie from 0 to 600 m.
    let (middle, number) = (300.0, TAU / wavelength);
    let line = move |x: f64| -amplitude * (number * x).cos();
    let step = 0.05;
    let mut lengths = vec![0.0];
    for n in 0..80_000 {
        let x = f64::from(n) * step;
        lengths.push(lengths[n as usize] + (line(x + step) - line(x)).hypot(step));
    }
    let length = move |x: f64| {
        let (n, part) = ((x.abs() / step) as usize, (x.abs() / step).fract());
        x.signum() * (lengths[n] + part * (lengths[n + 1] - lengths[n]))
    };
    Event {
        text: format!(
            "[[events]]\nkind = \"fold\"\nstyle = \"parallel\"\nwavelength = {wavelength}\namplitude = {amplitude}\naxis = 0\n"
        ),
        // The nearest place of the line, by looking along it.
        back: Box::new(move |p| {
            let (u, z) = (p.x - 2000.0, p.z - middle);
            let far = |x: f64| (u - x).powi(2) + (z - line(x)).powi(2);
            let (mut low, mut high) = (u - 500.0, u + 500.0);
            for _ in 0..16 {
                let nearest = (0..=20)
                    .map(|n| low + (high - low) * f64::from(n) / 20.0)
                    .min_by(|a, b| far(*a).total_cmp(&far(*b)))
                    .unwrap();
                let reach = (high - low) / 10.0;
                (low, high) = (nearest - reach, nearest + reach);
            }
            let x = 0.5 * (low + high);
            let slope = amplitude * number * (number * x).sin();
            let n = far(x).sqrt() * (z - line(x)).signum();
            // Beyond the zone another rule holds, which is not the subject here.
            (n.abs() < 290.0).then(|| DVec3::new(2000.0 + length(x) - n * slope.atan(), p.y, middle + n))
        }),
    }
}
