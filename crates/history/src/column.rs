//! What lies along a vertical line, with exact boundaries.

use crate::place::{Place, Sides};
use crate::stage::Stage;
use glam::{DVec2, DVec3};

/// A stretch of a vertical line within one unit and block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Depths of its top and its base, m.
    pub depths: [f64; 2],
    /// What is just below its top.
    pub place: Place,
}

/// Steps of a vertical line; what is thinner than one and has the same above and below it may be missed.
const STEPS: usize = 160;

/// What tells one stretch from another.
fn key(place: &Place) -> (Option<usize>, Option<usize>, Sides, bool) {
    let rock = place.rock();
    (
        rock.map(|rock| rock.unit),
        rock.and_then(|rock| rock.altered),
        rock.map_or_else(Sides::default, |rock| rock.sides),
        matches!(place, Place::Water),
    )
}

impl Stage<'_> {
    /// The stretches along a vertical line of the block, from the top down; boundaries to a hundredth of a millimetre.
    pub fn column(&self, map: DVec2) -> Vec<Stretch> {
        let base = self.history().size().z;
        let at = |z: f64| self.place(map.extend(z));
        let step = base / STEPS as f64;
        let mut found: Vec<Stretch> = Vec::new();
        let (mut z, mut place) = (0.0, at(0.0));
        let mut top = 0.0;
        for n in 1..=STEPS {
            let end = n as f64 * step;
            let below = at(end);
            // Several boundaries may lie in one step.
            while key(&place) != key(&below) {
                let (mut low, mut high) = (z, end);
                while high - low > 1e-5 {
                    let middle = 0.5 * (low + high);
                    if key(&at(middle)) == key(&place) { low = middle } else { high = middle }
                }
                found.push(Stretch { depths: [top, high], place });
                (z, top, place) = (high, high, at(high));
            }
            z = end;
        }
        found.push(Stretch { depths: [top, base], place });
        found
    }

    /// Which units are seen anywhere on a lattice of vertical lines of the block.
    pub(crate) fn units_seen(&self) -> Vec<bool> {
        use rayon::prelude::*;
        const LINES: usize = 7;
        let (size, count) = (self.history().size(), self.history().units().len());
        let line = |n: usize| {
            let share = DVec2::new((n / LINES) as f64, (n % LINES) as f64) / (LINES - 1) as f64;
            let mut seen = vec![false; count];
            for stretch in self.column(share.clamp(DVec2::splat(1e-6), DVec2::splat(1.0 - 1e-6)) * size.truncate()) {
                if let Some(rock) = stretch.place.rock() {
                    seen[rock.unit] = true;
                }
            }
            seen
        };
        let either = |a: Vec<bool>, b: Vec<bool>| a.iter().zip(&b).map(|(a, b)| a | b).collect();
        (0..LINES * LINES).into_par_iter().map(line).reduce(|| vec![false; count], either)
    }

    /// A place of the block.
    pub fn is_inside(&self, p: DVec3) -> bool {
        p.cmpge(DVec3::ZERO).all() && p.cmple(self.history().size()).all()
    }
}
