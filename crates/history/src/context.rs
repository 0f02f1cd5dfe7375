//! What the reader of an event knows of the block so far: its size, where its beds lie, and which names rocks have.

use crate::deformation::Deformation;
use crate::error::{HistoryError, Problem};
use crate::fields::Fields;
use glam::{DVec2, DVec3};

/// Says of a name whether a rock is called so, or which rocks have names like it.
pub type KnownRocks<'a> = &'a dyn Fn(&str) -> Result<(), Vec<String>>;

/// The block, as events are read one after another.
pub(crate) struct Context<'a> {
    /// East, north, depth, m.
    pub size: DVec3,
    /// Between which depths bounded beds lie after the events so far.
    pub zone: [f64; 2],
    /// Which names rocks have.
    rocks: KnownRocks<'a>,
    /// Where places on tops and bases of bounded beds lie after the events so far.
    marks: Vec<DVec3>,
}

/// Marks along each edge of the block.
const MARKS: u32 = 9;

impl<'a> Context<'a> {
    /// Before the first event.
    pub(crate) fn new(size: DVec3, rocks: KnownRocks<'a>) -> Self {
        Self { size, zone: [0.0, size.z], rocks, marks: Vec::new() }
    }

    /// What moves rock carries the beds along.
    pub(crate) fn moved(&mut self, map: &dyn Deformation) {
        self.marks.iter_mut().for_each(|mark| *mark = map.apply(*mark, map.side_before(*mark)));
        self.measure();
    }

    /// Beds are laid down; `between` gives the depths of their top and of their bounded base at a place of the map.
    pub(crate) fn laid(&mut self, between: impl Fn(DVec2) -> [f64; 2]) {
        for n in 0..MARKS * MARKS {
            let share = DVec2::new(f64::from(n / MARKS), f64::from(n % MARKS)) / f64::from(MARKS - 1);
            let map = share * self.size.truncate();
            self.marks.extend(between(map).map(|depth| map.extend(depth)));
        }
        self.measure();
    }

    fn measure(&mut self) {
        let depths = self.marks.iter().map(|mark| mark.z);
        let (top, base) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
        self.zone = if base > top { [top, base.min(self.size.z).max(top + 1.0)] } else { [0.0, self.size.z] };
    }
}

impl Context<'_> {
    /// The block's centre at depth 0.
    pub(crate) fn centre(&self) -> DVec3 {
        DVec3::new(0.5 * self.size.x, 0.5 * self.size.y, 0.0)
    }

    /// Half of the block's width along a unit vector.
    pub(crate) fn half_width(&self, along: DVec2) -> f64 {
        0.5 * (along.abs() * self.size.truncate()).element_sum()
    }

    /// The longest edge of the block, m.
    pub(crate) fn longest(&self) -> f64 {
        self.size.max_element()
    }

    /// A rock that is known.
    pub(crate) fn rock(
        &self,
        fields: &Fields<'_>,
        key: &'static str,
        meaning: &'static str,
    ) -> Result<String, HistoryError> {
        let rock = fields.text(key, meaning)?;
        self.known(fields, key, rock)
    }

    /// A rock that is known, with a default.
    pub(crate) fn rock_or(
        &self,
        fields: &Fields<'_>,
        key: &'static str,
        default: &str,
    ) -> Result<String, HistoryError> {
        let stated = fields.maybe_text(key)?;
        stated.map_or(Ok(default.to_owned()), |rock| self.known(fields, key, rock))
    }

    fn known(&self, fields: &Fields<'_>, key: &str, rock: String) -> Result<String, HistoryError> {
        match (self.rocks)(&rock) {
            Ok(()) => Ok(rock),
            Err(alike) => Err(fields.wrong(key, Problem::UnknownRock { found: rock, alike })),
        }
    }

    /// Refuses a slip that is larger than the block.
    pub(crate) fn fits(&self, fields: &Fields<'_>, key: &str, slip_m: f64) -> Result<(), HistoryError> {
        let block_m = self.longest();
        if slip_m.abs() < block_m {
            Ok(())
        } else {
            Err(fields.wrong(key, Problem::SlipBeyondBlock { slip_m, block_m }))
        }
    }
}
