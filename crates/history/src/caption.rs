//! Events in the field's plain words, as captions of a series say them: "Folding: wavelength 1800 m, amplitude 120 m".

use crate::history::{History, Unit};
use crate::kinds::{Act, Beds, Dyke, Erosion, Fault, Fold, Salt, SheetKind, Tilt};

/// Rock that no water or wind lays down: under the beds of an event it is what they lie on.
const CRYSTALLINE: [&str; 14] = [
    "granite",
    "gneiss",
    "schist",
    "gabbro",
    "diorite",
    "granodiorite",
    "syenite",
    "peridotite",
    "dolerite",
    "amphibolite",
    "quartzite",
    "slate",
    "marble",
    "migmatite",
];
/// Rock that flows or falls from a volcano.
const ERUPTED: [&str; 6] = ["basalt", "andesite", "rhyolite", "tuff", "dacite", "trachyte"];
/// Of more beds than these the oldest and the youngest are named.
const MOST_NAMED: usize = 6;
/// Directions within so many degrees of a point of the compass are called by it.
const NEAR_POINT_DEG: f64 = 3.0;
/// The points of the compass, clockwise.
const POINTS: [&str; 8] = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

impl History {
    /// What an event does, in words; `event` counts from 0.
    ///
    /// ```
    /// let history = history::History::from_toml(
    ///     "size = [4000, 3000, 1500]
    ///      events = [ { kind = \"beds\", beds = [ { rock = \"shale\", thickness = 300 }, { rock = \"chalk\", thickness = 200 } ] },
    ///                 { kind = \"fault\", slip = 200 } ]",
    /// )?;
    /// assert_eq!(history.caption(0), "Deposition of Shale, Chalk");
    /// assert_eq!(history.caption(1), "Normal fault F1, throw 173 m");
    /// # Ok::<(), history::HistoryError>(())
    /// ```
    pub fn caption(&self, event: usize) -> String {
        let Some(found) = self.events().get(event) else { return String::new() };
        let first: usize = self.events()[..event].iter().map(|event| event.acts.len()).sum();
        let unit = |name: Option<&str>, rock: &str, what: &str| match name {
            Some(name) => format!("{what} {name}"),
            None => format!("{what} of {rock}"),
        };
        match &found.acts[..] {
            [Act::Beds(_)] => self.deposition(first),
            [Act::Tilt(tilt)] => tilting(tilt),
            [Act::Uplift(uplift)] if uplift.amount_m < 0.0 => format!("Subsidence by {}", metres(uplift.amount_m)),
            [Act::Uplift(uplift)] => format!("Uplift by {}", metres(uplift.amount_m)),
            [Act::Fold(fold)] => folding(fold),
            [Act::Fault(fault)] => capital(&faulting(fault)),
            [Act::Fault(fault), rest @ ..] => self.growth(fault, rest, first),
            [Act::Dominoes(set)] => format!("Domino faults, blocks turned by {}", degrees(set.rotation_deg)),
            [Act::Erosion(erosion)] => eroding(erosion),
            [Act::Dyke(dyke)] => intruding(dyke),
            [Act::Sheet(sheet)] => {
                let kind = if sheet.kind == SheetKind::Sill { "sill" } else { "laccolith" };
                let what = unit(sheet.name.as_deref(), &sheet.rock, &article(sheet.name.as_deref(), kind));
                format!("Intrusion of {what}, {} thick", metres(sheet.thickness_m))
            }
            [Act::Body(body)] => {
                let what = unit(body.name.as_deref(), &body.rock, &article(body.name.as_deref(), found.kind));
                let baked =
                    body.aureole.as_ref().map_or(String::new(), |(_, rock)| format!(", its rim baked to {rock}"));
                format!("Intrusion of {what}{baked}")
            }
            [Act::Volcano(volcano)] => match &volcano.name {
                Some(name) => format!("Eruption of {name}"),
                None => format!("Eruption of a volcano of {} and {}", volcano.rock, volcano.ash),
            },
            [Act::Salt(salt)] => rising(salt),
            [Act::Metamorphism(change)] => format!("Metamorphism to {} below {}", change.rock, metres(change.below_m)),
            [Act::Terrain(_)] => "Erosion to hills and valleys".to_owned(),
            [Act::Sea(sea)] if sea.level_m == 0.0 => "Flooding by the sea".to_owned(),
            [Act::Sea(sea)] => format!("Sea level at a depth of {}", signed_metres(sea.level_m)),
            _ => capital(found.kind),
        }
    }

    fn units_of(&self, act: usize) -> impl Iterator<Item = &Unit> {
        self.units().iter().filter(move |unit| unit.act == act)
    }

    /// The names of the beds of acts, oldest first.
    fn listed(names: &[&str]) -> String {
        match names {
            [first, .., last] if names.len() > MOST_NAMED => format!("{first} … {last}"),
            few => few.join(", "),
        }
    }

    fn deposition(&self, act: usize) -> String {
        let mut units: Vec<&Unit> = self.units_of(act).collect();
        let is_one_of = |unit: &Unit, rocks: &[&str]| rocks.iter().any(|rock| unit.rock.eq_ignore_ascii_case(rock));
        let crystalline = units.iter().take_while(|unit| is_one_of(unit, &CRYSTALLINE)).count();
        let above = units.split_off(crystalline);
        let names = |units: &[&Unit]| Self::listed(&units.iter().map(|unit| unit.name.as_str()).collect::<Vec<_>>());
        let verb = if above.iter().all(|unit| is_one_of(unit, &ERUPTED)) { "Eruption" } else { "Deposition" };
        match (&units[..], &above[..]) {
            (below, []) => names(below),
            ([], above) => format!("{verb} of {}", names(above)),
            (below, above) => format!("{verb} of {} on {}", names(above), names(below)),
        }
    }

    /// A fault that moves while beds are laid down: its acts are steps of the fault, of subsidence and beds.
    fn growth(&self, fault: &Fault, rest: &[Act], first: usize) -> String {
        let steps = 1 + rest.iter().filter(|act| matches!(act, Act::Fault(_))).count();
        let throw = fault.progressed(f64::from(steps as u32)).throw_m();
        let is_beds = |act: &Act| matches!(act, Act::Beds(Beds { .. }));
        let beds = rest.iter().enumerate().filter(|(_, act)| is_beds(act)).map(|(n, _)| first + 1 + n);
        let names: Vec<&str> = beds.flat_map(|act| self.units_of(act)).map(|unit| unit.name.as_str()).collect();
        let name = fault.name.as_deref().unwrap_or_default();
        let kind = format!("{}fault {name}", if fault.shape_word() == "listric" { "listric " } else { "" });
        format!("Growth along {}, throw {}: {}", kind.trim_end(), metres(throw), Self::listed(&names))
    }
}

fn tilting(tilt: &Tilt) -> String {
    let (dip, direction) = match tilt.dip_deg < 0.0 {
        true => (-tilt.dip_deg, tilt.direction_deg + 180.0),
        false => (tilt.dip_deg, tilt.direction_deg),
    };
    format!("Tilting by {} towards {}", degrees(dip), bearing(direction))
}

fn folding(fold: &Fold) -> String {
    let size = match fold.shape_word() {
        "dome" if fold.amplitude_m < 0.0 => {
            return format!("Basin, {} wide and {} deep", metres(fold.wavelength_m), metres(fold.amplitude_m));
        }
        "dome" => return format!("Dome, {} wide and {} high", metres(fold.wavelength_m), metres(fold.amplitude_m)),
        "monocline" => format!("Monocline, a step of {}", metres(fold.amplitude_m)),
        shape => {
            let what = if shape == "sine" { "Folding".to_owned() } else { capital(&format!("{shape} folding")) };
            format!("{what}: wavelength {}, amplitude {}", metres(fold.wavelength_m), metres(fold.amplitude_m))
        }
    };
    match fold.plunge_deg {
        0.0 => size,
        plunge if plunge < 0.0 => {
            format!("{size}, plunging {} towards {}", degrees(plunge), bearing(fold.axis_deg + 180.0))
        }
        plunge => format!("{size}, plunging {} towards {}", degrees(plunge), bearing(fold.axis_deg)),
    }
}

/// "listric normal fault F1, throw 173 m".
fn faulting(fault: &Fault) -> String {
    /// Reverse faults that dip less are thrusts.
    const THRUST_DEG: f64 = 45.0;
    let name = fault.name.as_ref().map_or(String::new(), |name| format!(" {name}"));
    let throw = format!("throw {}", metres(fault.throw_m()));
    let sideways = if fault.dextral_m > 0.0 { "dextral" } else { "sinistral" };
    let kind = match (fault.slip_m, fault.shape_word()) {
        (slip, "ramp") if slip < 0.0 => "thrust over a ramp",
        (slip, _) if slip < 0.0 && fault.dip_deg < THRUST_DEG => "thrust",
        (slip, _) if slip < 0.0 => "reverse fault",
        (_, "listric") => "listric normal fault",
        _ => "normal fault",
    };
    match (fault.slip_m == 0.0, fault.dextral_m == 0.0) {
        (true, _) => format!("{sideways} strike-slip fault{name}, offset {}", metres(fault.dextral_m)),
        (false, true) if fault.shape_word() == "ramp" => format!("{kind}{name}, slip {}", metres(fault.slip_m)),
        (false, true) => format!("{kind}{name}, {throw}"),
        (false, false) => format!("{kind}{name}, {throw}, {sideways} offset {}", metres(fault.dextral_m)),
    }
}

fn eroding(erosion: &Erosion) -> String {
    let name = erosion.name.as_ref().map_or(String::new(), |name| format!(" ({name})"));
    format!("Erosion to {}{name}", signed_metres(erosion.depth_m))
}

fn intruding(dyke: &Dyke) -> String {
    let (count, _) = dyke.outlines();
    let thick = metres(dyke.thickness_m);
    match (&dyke.name, count) {
        (Some(name), _) => format!("Intrusion of {name}, {thick} thick"),
        (None, 1) => format!("Intrusion of a dyke of {}, {thick} thick", dyke.rock),
        (None, count) => format!("Intrusion of {count} dykes of {}, each {thick} thick", dyke.rock),
    }
}

fn rising(salt: &Salt) -> String {
    let what = if salt.is_pillow() { "Growth of a salt pillow" } else { "Rise of a salt diapir" };
    salt.name.as_ref().map_or_else(|| what.to_owned(), |name| format!("{what}, {name}"))
}

/// "a dyke" where it has no name, "dyke" before its name.
fn article(name: Option<&str>, what: &str) -> String {
    if name.is_some() { what.to_owned() } else { format!("a {what}") }
}

/// A length without its sign, to the metre, and to a tenth below ten.
fn metres(length: f64) -> String {
    signed_metres(length.abs())
}

fn signed_metres(length: f64) -> String {
    let step = if length.abs() < 10.0 { 10.0 } else { 1.0 };
    let rounded = (length * step).round() / step + 0.0;
    format!("{rounded} m")
}

fn degrees(angle: f64) -> String {
    format!("{}°", (angle.abs() * 10.0).round() / 10.0)
}

/// A point of the compass, or degrees from north.
fn bearing(direction: f64) -> String {
    let direction = direction.rem_euclid(360.0);
    let nearest = (direction / 45.0).round();
    if (direction - 45.0 * nearest).abs() <= NEAR_POINT_DEG {
        return POINTS[nearest as usize % POINTS.len()].to_owned();
    }
    format!("{:03.0}°", direction)
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}", letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_are_said_in_plain_words() {
        let said = |events: &str| {
            let text = format!(
                "size = [4000, 3000, 1500]\nevents = [ {{ kind = \"beds\", beds = [\n\
                 {{ rock = \"granite\", thickness = 600, name = \"Basement\" }},\n\
                 {{ rock = \"salt\", thickness = 200, name = \"Salt\" }},\n\
                 {{ rock = \"shale\", thickness = 500, name = \"Shale\" }} ] }},\n{events} ]"
            );
            let history = History::from_toml(&text).unwrap_or_else(|error| panic!("{events}: {error}"));
            (0..history.events().len()).map(|n| history.caption(n)).collect::<Vec<_>>()
        };
        let cases = [
            ("{ kind = \"tilt\", dip = 12, direction = 90 }", "Tilting by 12° towards east"),
            ("{ kind = \"tilt\", dip = -12, direction = 75 }", "Tilting by 12° towards 255°"),
            ("{ kind = \"uplift\", amount = -80 }", "Subsidence by 80 m"),
            (
                "{ kind = \"fold\", wavelength = 1800, amplitude = 120, plunge = 10, axis = 45 }",
                "Folding: wavelength 1800 m, amplitude 120 m, plunging 10° towards north-east",
            ),
            (
                "{ kind = \"fold\", shape = \"basin\", wavelength = 1800, amplitude = 120 }",
                "Basin, 1800 m wide and 120 m deep",
            ),
            ("{ kind = \"fault\", name = \"F7\", slip = 200 }", "Normal fault F7, throw 173 m"),
            ("{ kind = \"fault\", slip = -200, dip = 30 }", "Thrust F1, throw 100 m"),
            ("{ kind = \"fault\", dip = 90, dextral = 700 }", "Dextral strike-slip fault F1, offset 700 m"),
            ("{ kind = \"erosion\", depth = 200, name = \"Angular\" }", "Erosion to 200 m (Angular)"),
            (
                "{ kind = \"dyke\", thickness = 30, count = 3, spacing = 300 }",
                "Intrusion of 3 dykes of basalt, each 30 m thick",
            ),
            ("{ kind = \"laccolith\", thickness = 150 }", "Intrusion of a laccolith of granite, 150 m thick"),
            (
                "{ kind = \"pluton\", radius = 400, aureole = 100 }",
                "Intrusion of a pluton of granite, its rim baked to hornfels",
            ),
        ];
        for (event, wanted) in cases {
            assert_eq!(said(event), ["Deposition of Salt, Shale on Basement", wanted]);
        }
        let grown = "{ kind = \"fault\", shape = \"listric\", throw = 200, growth = [ { rock = \"marl\" }, { rock = \"chalk\" } ] }";
        assert_eq!(said(grown)[1], "Growth along listric fault F1, throw 200 m: Marl, Chalk");
    }
}
