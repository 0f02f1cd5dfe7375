//! Names and rocks of the layers between surfaces.

use super::{Node, Surface};
use crate::kinds::Act;
use crate::stage::Stage;

/// Layers, youngest first.
#[derive(Default)]
pub(super) struct Layers {
    pub names: Vec<String>,
    /// `None` for air.
    pub rocks: Vec<Option<String>>,
}

impl Stage<'_> {
    /// The layers between surfaces.
    pub(super) fn layers(&self, surfaces: &[Surface], columns: &[Vec<Node>]) -> Layers {
        let is_ground = |node: &Node| node.surface == Surface::Ground;
        let has_air = columns.iter().any(|column| column.iter().any(is_ground));
        let Layers { mut names, mut rocks } = Layers::default();
        for n in 0..=surfaces.len() {
            let above = n.checked_sub(1).map(|n| surfaces[n]);
            let is_bed = |surface: &&Surface| !matches!(surface, Surface::Body(_) | Surface::Baked(_));
            let below = surfaces[n..].iter().find(is_bed).copied();
            let unit = match (above, below) {
                (None, _) if has_air => None,
                (Some(Surface::Body(unit) | Surface::Baked(unit)), _) => Some(unit),
                _ => self.between(above, below),
            };
            let Some(unit) = unit.map(|unit| &self.history().units()[unit]) else {
                names.push("Air".to_owned());
                rocks.push(None);
                continue;
            };
            // Above the top of the youngest bed there is hardly anything; it looks like the bed.
            let name = if names.contains(&unit.name) { format!("Above {}", unit.name) } else { unit.name.clone() };
            let is_body = matches!(above, Some(Surface::Body(_) | Surface::Baked(_)));
            let is_its_top =
                |below: Surface| matches!(below, Surface::Top(top) if self.history().units()[top] == *unit);
            let is_upper = !is_body && below.is_some_and(is_its_top);
            let name = if is_upper && name == unit.name { format!("Above {}", unit.name) } else { name };
            let name = if names.contains(&name) { format!("{name} {n}") } else { name };
            names.push(name);
            rocks.push(Some(unit.rock.clone()));
        }
        Layers { names, rocks }
    }

    /// The unit between two surfaces that follow one another.
    fn between(&self, above: Option<Surface>, below: Option<Surface>) -> Option<usize> {
        let units = self.history().units();
        let next = |unit: usize| {
            let (act, bed) = (units[unit].act, units[unit].bed?);
            self.bed_unit(act, bed + 1)
        };
        match (above, below) {
            (Some(Surface::Top(unit)), _) => Some(unit),
            (_, Some(Surface::Top(unit))) => Some(next(unit).or_else(|| self.laid_on(unit)).unwrap_or(unit)),
            (_, Some(Surface::CutBase(unit))) => Some(unit),
            (_, Some(Surface::Base(act))) => self.bed_unit(act, 0),
            // Below the last surface: what is oldest there.
            (Some(Surface::CutBase(unit)), None) => {
                units[unit].bed.and_then(|bed| bed.checked_sub(1)).and_then(|bed| self.bed_unit(units[unit].act, bed))
            }
            (Some(Surface::Base(act)), None) => {
                let older = self.acts()[..act].iter().enumerate().rev();
                let beds = older.filter_map(|(n, act)| matches!(act, Act::Beds(_)).then_some(n));
                beds.filter_map(|act| self.youngest_of(act)).next()
            }
            _ => self.bed_unit(0, 0),
        }
    }

    /// The lowest bed of the next later event of beds, if some of it is there although its top is not.
    fn laid_on(&self, unit: usize) -> Option<usize> {
        let made = self.history().units()[unit].act;
        let mut later = self.acts().iter().enumerate().skip(made + 1);
        let act = later.find_map(|(n, act)| matches!(act, Act::Beds(_)).then_some(n))?;
        let lowest = self.bed_unit(act, 0)?;
        self.units_seen()[lowest].then_some(lowest)
    }

    fn youngest_of(&self, act: usize) -> Option<usize> {
        self.history().units().iter().rposition(|unit| unit.act == act && unit.bed.is_some())
    }
}
