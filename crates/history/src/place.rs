//! What is at a place of the block.

use glam::DVec3;

/// Most acts of a history: events, and the steps of growth faults.
pub const MOST_ACTS: usize = 96;

/// On which side of each act that divides rock a place lies, as far back as its rock goes; 0 for others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Sides(pub [i8; MOST_ACTS]);

impl Default for Sides {
    fn default() -> Self {
        Self([0; MOST_ACTS])
    }
}

/// What is at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    /// Nothing.
    Air,
    /// The sea.
    Water,
    /// Rock.
    Rock(Rock),
}

/// Rock at a place, and where it was when it was made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rock {
    /// Which of [`crate::History::units`] it belongs to.
    pub unit: usize,
    /// The unit whose rock it has become since, by baking or metamorphism.
    pub altered: Option<usize>,
    /// The act that made it.
    pub act: usize,
    /// i and j: m east and north where it was made. k: 0 at the base of its bed, 1 at its top; below 0 in the lowest bed,
    /// where it goes on below its thickness.
    pub ijk: DVec3,
    /// Its block: the sides of faults that are younger than it.
    pub sides: Sides,
}

impl Place {
    /// The rock, if there is some.
    pub fn rock(&self) -> Option<&Rock> {
        match self {
            Self::Rock(rock) => Some(rock),
            Self::Air | Self::Water => None,
        }
    }

    /// The unit that is seen: what rock has become, or what it is.
    pub fn seen(&self) -> Option<usize> {
        self.rock().map(|rock| rock.altered.unwrap_or(rock.unit))
    }
}
