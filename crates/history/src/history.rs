//! A history: the block's size, its events in order, and the units of rock that they make.

use crate::context::{Context, KnownRocks};
use crate::error::{HistoryError, Problem};
use crate::fields::{Fields, Text};
use crate::kinds::{Act, KINDS, Kind};
use crate::names::alike;
use crate::place::{MOST_ACTS, Place};
use crate::stage::Stage;
use glam::DVec3;
use toml::de::DeTable;

/// A block told as events.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    title: Option<String>,
    size: DVec3,
    events: Vec<Event>,
    units: Vec<Unit>,
    /// First unit of each act, over all events.
    first_units: Vec<usize>,
}

/// An event of the text.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Its kind, as the text calls it.
    pub kind: &'static str,
    /// Its line in the text, counted from 1.
    pub line: usize,
    /// What it does: one act, or for a growth fault several.
    pub acts: Vec<Act>,
}

/// Rock that an event makes: a bed, a body, or what rock becomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Its name: that of the text, or of its rock.
    pub name: String,
    /// Its rock.
    pub rock: String,
    /// The act that makes it, over all events.
    pub act: usize,
    /// Which bed of the act it is; `None` for bodies and for what rock becomes.
    pub bed: Option<usize>,
    /// Its line in the text.
    pub line: usize,
}

/// Which of the units of an act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum UnitOf {
    Bed { bed: usize, is_far: bool },
    Body,
    Ash,
    Altered,
}

impl History {
    /// Reads the text of a history. Any name of a rock is taken.
    ///
    /// # Errors
    /// What is wrong, with the line and what is meant.
    ///
    /// ```
    /// let wrong = history::History::from_toml("size = [4000, 3000, 1500]\n[[events]]\nkind = \"fauld\"").unwrap_err();
    /// assert_eq!((wrong.line, wrong.to_string().contains("did you mean fault")), (3, true));
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, HistoryError> {
        Self::with_rocks(text, &|_| Ok(()))
    }

    /// Reads the text of a history whose rocks must be known.
    ///
    /// # Errors
    /// What is wrong, with the line and what is meant.
    pub fn with_rocks(text: &str, rocks: KnownRocks<'_>) -> Result<Self, HistoryError> {
        let lines = Text(text);
        let table = DeTable::parse(text).map_err(|error| {
            let line = error.span().map_or(1, |span| lines.line(span.start));
            Problem::Syntax { said: error.message().to_owned() }.at(line)
        })?;
        let fields = Fields::new(lines, table.get_ref(), 0..0, "a history");
        let title = fields.maybe_text("title")?;
        let size = size(&fields)?;
        let tables = fields.tables("events", "an event")?;
        fields.finish()?;
        if tables.is_empty() {
            return Err(Problem::NoEvents.at(1));
        }
        let mut context = Context::new(size, rocks);
        let mut events = Vec::new();
        for mut table in tables {
            let kind = kind_of(&table)?;
            table.called(kind.called);
            if events.is_empty() && kind.word != "beds" {
                return Err(Problem::NoRock { found: kind.called }.at(table.line_of("kind")));
            }
            let acts = (kind.read)(&table, &context)?;
            table.finish()?;
            for act in &acts {
                match act {
                    Act::Beds(beds) => context.laid(|map| beds.bounded_zone(map)),
                    other => other.deformation().into_iter().for_each(|map| context.moved(map)),
                }
            }
            events.push(Event { kind: kind.word, line: table.line(), acts });
        }
        let found = events.iter().map(|event| event.acts.len()).sum();
        if found > MOST_ACTS {
            return Err(Problem::TooManyEvents { found, most: MOST_ACTS }.at(events[events.len() - 1].line));
        }
        let (units, first_units) = units(&events)?;
        let history = Self { title, size, events, units, first_units };
        history.name_faults()?.check()
    }

    /// What the block is called.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// The block's size: east, north, depth, m.
    pub fn size(&self) -> DVec3 {
        self.size
    }

    /// The events, oldest first.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// All units of rock, in the order of the events that make them.
    pub fn units(&self) -> &[Unit] {
        &self.units
    }

    /// The acts of all events, oldest first, with the lines of their events.
    pub fn acts(&self) -> impl Iterator<Item = (&Act, usize)> {
        self.events.iter().flat_map(|event| event.acts.iter().map(|act| (act, event.line)))
    }

    /// The block after `progress` events: 2.5 is after two of them and half of the third.
    pub fn stage(&self, progress: f64) -> Stage<'_> {
        Stage::new(self, progress)
    }

    /// The block after all events.
    pub fn last_stage(&self) -> Stage<'_> {
        self.stage(self.events.len() as f64)
    }

    /// What is at a place after `progress` events. Whoever asks for many places makes a [`History::stage`] once.
    pub fn place(&self, p: DVec3, progress: f64) -> Place {
        self.stage(progress).place(p)
    }

    pub(crate) fn unit_of(&self, act: usize, of: UnitOf) -> usize {
        let first = self.first_units[act];
        let units = &self.units[first..];
        match of {
            UnitOf::Bed { bed, is_far } => {
                let found = units.iter().position(|unit| unit.bed == Some(bed)).unwrap_or(0);
                first + found + usize::from(is_far)
            }
            UnitOf::Body => first,
            UnitOf::Ash => first + 1,
            UnitOf::Altered => {
                // The baked rim comes after the body; a metamorphism has nothing else.
                let is_own = |unit: &&Unit| unit.act == act;
                first + units.iter().take_while(is_own).count() - 1
            }
        }
    }

    /// Gives faults without a name the next free of F1, F2 …, and refuses two with one name.
    fn name_faults(mut self) -> Result<Self, HistoryError> {
        let stated: Vec<(String, usize)> = self
            .events
            .iter()
            .filter(|event| event.kind == "fault")
            .filter_map(|event| event.acts[0].name().map(|name| (name.to_owned(), event.line)))
            .collect();
        for (n, (name, line)) in stated.iter().enumerate() {
            if let Some((_, first)) = stated[..n].iter().find(|(other, _)| other == name) {
                return Err(Problem::SameName { name: name.clone(), other: "the fault", first: *first }.at(*line));
            }
        }
        let mut number = 0;
        for event in &mut self.events {
            let mut name = None;
            for act in &mut event.acts {
                let Act::Fault(fault) = act else { continue };
                if fault.name.is_none() {
                    let next = name.get_or_insert_with(|| {
                        loop {
                            number += 1;
                            let next = format!("F{number}");
                            if stated.iter().all(|(name, _)| *name != next) {
                                break next;
                            }
                        }
                    });
                    fault.name = Some(next.clone());
                }
            }
        }
        Ok(self)
    }

    /// Refuses beds that are nowhere at any stage, and blocks without rock.
    fn check(self) -> Result<Self, HistoryError> {
        let mut seen = vec![false; self.units.len()];
        for stage in (1..=self.events.len()).rev() {
            let made = Stage::sketch(&self, stage as f64);
            let found = made.units_seen();
            if stage == self.events.len() && found.iter().all(|is_seen| !is_seen) {
                let takes = |event: &&Event| ["erosion", "terrain"].contains(&event.kind);
                let event = self.events.iter().rev().find(takes).unwrap_or(&self.events[0]);
                let said = "no rock is left in the block after this event; state a smaller `depth`, or a deeper `size`";
                return Err(Problem::Unfit { said: said.to_owned() }.at(event.line));
            }
            seen.iter_mut().zip(found).for_each(|(seen, found)| *seen |= found);
            if self.units.iter().zip(&seen).all(|(unit, seen)| *seen || unit.bed.is_none()) {
                break;
            }
        }
        let missing = self.units.iter().zip(&seen).find(|(unit, seen)| !**seen && unit.bed.is_some());
        if let Some((unit, _)) = missing {
            let why = "it is too thin, lies deeper than the block, or what was there left no room for it; state another \
                       `thickness`, `top` or `size`";
            return Err(Problem::Vanished { name: unit.name.clone(), why: why.to_owned() }.at(unit.line));
        }
        Ok(self)
    }

    /// Beds that were there and are nowhere in the block in the end, with the line of each.
    pub fn notes(&self) -> Vec<HistoryError> {
        let seen = Stage::sketch(self, self.events.len() as f64).units_seen();
        let gone = self.units.iter().zip(seen).filter(|(unit, seen)| !seen && unit.bed.is_some());
        gone.map(|(unit, _)| {
            let why = "events after it have taken all of it away, so that its top is no horizon".to_owned();
            Problem::Vanished { name: unit.name.clone(), why }.at(unit.line)
        })
        .collect()
    }
}

fn size(fields: &Fields<'_>) -> Result<DVec3, HistoryError> {
    let wanted = "[east, north, depth] in m";
    let found = fields.numbers("size", &[3], wanted)?;
    let Some(found) = found else {
        let meaning = "[east, north, depth] in m";
        return Err(Problem::Missing { of: "a history".to_owned(), key: "size", meaning }.at(1));
    };
    if let Some(&wrong) = found.iter().find(|edge| !(1.0..=1e6).contains(*edge)) {
        let why = "must lie between 1 and 1000000 m".to_owned();
        return Err(fields.wrong("size", Problem::Range { key: "size".to_owned(), found: wrong, why }));
    }
    Ok(DVec3::new(found[0], found[1], found[2]))
}

/// The kind of an event.
fn kind_of(table: &Fields<'_>) -> Result<&'static Kind, HistoryError> {
    let found = table.text("kind", "what happens, such as \"beds\", \"fold\" or \"fault\"")?;
    KINDS.iter().find(|kind| kind.word == found).ok_or_else(|| {
        let known = || KINDS.iter().map(|kind| kind.word);
        let (alike, known) = (alike(&found, known()), known().map(str::to_owned).collect());
        table.wrong("kind", Problem::UnknownWord { what: "the kind of an event".to_owned(), found, alike, known })
    })
}

/// The units that each act makes, named; and the first of each act.
fn units(events: &[Event]) -> Result<(Vec<Unit>, Vec<usize>), HistoryError> {
    let (mut units, mut first_units): (Vec<Unit>, Vec<usize>) = (Vec::new(), Vec::new());
    let acts = events.iter().flat_map(|event| event.acts.iter().map(|act| (act, event.line)));
    for (n, (act, line)) in acts.enumerate() {
        first_units.push(units.len());
        let mut add = |name: Option<&str>, rock: &str, bed: Option<usize>, line: usize| {
            let name = match name {
                Some(name) => {
                    if let Some(other) = units.iter().find(|unit| unit.name == name) {
                        let (name, first) = (name.to_owned(), other.line);
                        return Err(Problem::SameName { name, other: "the rock", first }.at(line));
                    }
                    name.to_owned()
                }
                None => free_name(rock, &units),
            };
            units.push(Unit { name, rock: rock.to_owned(), act: n, bed, line });
            Ok(())
        };
        match act {
            Act::Beds(beds) => {
                for (m, bed) in beds.beds.iter().enumerate() {
                    add(bed.name.as_deref(), &bed.rock, Some(m), bed.line)?;
                    if let Some(facies) = &bed.facies {
                        add(None, &facies.rock, Some(m), bed.line)?;
                    }
                }
            }
            Act::Dyke(act) => add(act.name.as_deref(), &act.rock, None, line)?,
            Act::Sheet(act) => add(act.name.as_deref(), &act.rock, None, line)?,
            Act::Salt(act) => add(act.name.as_deref(), &act.rock, None, line)?,
            Act::Body(act) => {
                add(act.name.as_deref(), &act.rock, None, line)?;
                if let Some((_, baked)) = &act.aureole {
                    add(None, baked, None, line)?;
                }
            }
            Act::Volcano(act) => {
                add(act.name.as_deref(), &act.rock, None, line)?;
                add(None, &act.ash, None, line)?;
            }
            Act::Metamorphism(act) => add(None, &act.rock, None, line)?,
            _ => {}
        }
    }
    Ok((units, first_units))
}

/// The rock's name with a capital, and a number where it is taken.
fn free_name(rock: &str, taken: &[Unit]) -> String {
    let mut letters = rock.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let name = format!("{first}{}", letters.as_str());
    let is_free = |name: &str| taken.iter().all(|unit| unit.name != name);
    if is_free(&name) {
        return name;
    }
    let numbered = (2..).map(|n| format!("{name} {n}")).find(|name| is_free(name));
    numbered.unwrap_or(name)
}
