//! One file for each kind of event, and the table of kinds that the text's reader asks.

mod beds;
mod dominoes;
mod dyke;
mod erosion;
mod fault;
mod fold;
mod metamorphism;
mod pluton;
mod salt;
mod sea;
mod sheet;
mod terrain;
mod tilt;
mod uplift;
mod volcano;

pub use beds::{Bed, Beds, Facies};
pub use dominoes::Dominoes;
pub use dyke::Dyke;
pub use erosion::Erosion;
pub use fault::Fault;
pub use fold::Fold;
pub use metamorphism::Metamorphism;
pub use pluton::Body;
pub use salt::Salt;
pub use sea::Sea;
pub use sheet::{IntrusiveSheet, SheetKind};
pub use terrain::Terrain;
pub use tilt::Tilt;
pub use uplift::Uplift;
pub use volcano::Volcano;

pub(crate) use volcano::InVolcano;

use crate::context::Context;
use crate::deformation::Deformation;
use crate::error::HistoryError;
use crate::fields::Fields;

/// What an event does.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each is documented at its type")]
pub enum Act {
    Beds(Beds),
    Tilt(Tilt),
    Uplift(Uplift),
    Fold(Fold),
    Fault(Fault),
    Dominoes(Dominoes),
    Erosion(Erosion),
    Dyke(Dyke),
    Sheet(IntrusiveSheet),
    Body(Body),
    Volcano(Volcano),
    Salt(Salt),
    Metamorphism(Metamorphism),
    Terrain(Terrain),
    Sea(Sea),
}

/// A kind of event: its word in the text, and the reader of its keys.
pub(crate) struct Kind {
    pub word: &'static str,
    /// What it is called in errors.
    pub called: &'static str,
    pub read: fn(&Fields<'_>, &Context<'_>) -> Result<Vec<Act>, HistoryError>,
}

/// The table of kinds.
pub(crate) const KINDS: [Kind; 17] = [
    kind("beds", "beds", |f, c| Ok(vec![Act::Beds(Beds::read(f, c)?)])),
    kind("tilt", "a tilt", |f, c| Ok(vec![Act::Tilt(Tilt::read(f, c)?)])),
    kind("uplift", "an uplift", |f, _| Ok(vec![Act::Uplift(Uplift::read(f)?)])),
    kind("fold", "a fold", |f, c| Ok(vec![Act::Fold(Fold::read(f, c)?)])),
    kind("fault", "a fault", fault::read_with_growth),
    kind("dominoes", "a set of dominoes", |f, c| Ok(vec![Act::Dominoes(Dominoes::read(f, c)?)])),
    kind("erosion", "an erosion", |f, c| Ok(vec![Act::Erosion(Erosion::read(f, c)?)])),
    kind("dyke", "a dyke", |f, c| Ok(vec![Act::Dyke(Dyke::read(f, c)?)])),
    kind("sill", "a sill", |f, c| Ok(vec![Act::Sheet(IntrusiveSheet::read(f, c, SheetKind::Sill)?)])),
    kind("laccolith", "a laccolith", |f, c| Ok(vec![Act::Sheet(IntrusiveSheet::read(f, c, SheetKind::Laccolith)?)])),
    kind("pluton", "a pluton", |f, c| Ok(vec![Act::Body(Body::read_pluton(f, c)?)])),
    kind("pipe", "a pipe", |f, c| Ok(vec![Act::Body(Body::read_pipe(f, c)?)])),
    kind("volcano", "a volcano", |f, c| Ok(vec![Act::Volcano(Volcano::read(f, c)?)])),
    kind("salt", "salt", |f, c| Ok(vec![Act::Salt(Salt::read(f, c)?)])),
    kind("metamorphism", "a metamorphism", |f, c| Ok(vec![Act::Metamorphism(Metamorphism::read(f, c)?)])),
    kind("terrain", "terrain", |f, c| Ok(vec![Act::Terrain(Terrain::read(f, c)?)])),
    kind("sea", "a sea", |f, _| Ok(vec![Act::Sea(Sea::read(f)?)])),
];

const fn kind(
    word: &'static str,
    called: &'static str,
    read: fn(&Fields<'_>, &Context<'_>) -> Result<Vec<Act>, HistoryError>,
) -> Kind {
    Kind { word, called, read }
}

impl Act {
    /// The map of an act that moves rock.
    pub fn deformation(&self) -> Option<&dyn Deformation> {
        match self {
            Self::Tilt(act) => Some(act),
            Self::Uplift(act) => Some(act),
            Self::Fold(act) => Some(act),
            Self::Fault(act) => Some(act),
            Self::Dominoes(act) => Some(act),
            Self::Dyke(act) => Some(act),
            Self::Sheet(act) => Some(act),
            Self::Salt(act) => Some(act),
            Self::Beds(_)
            | Self::Erosion(_)
            | Self::Body(_)
            | Self::Volcano(_)
            | Self::Metamorphism(_)
            | Self::Terrain(_)
            | Self::Sea(_) => None,
        }
    }

    /// The act when a share of it, 0 … 1, has happened.
    pub fn progressed(&self, share: f64) -> Self {
        match self {
            Self::Beds(act) => Self::Beds(act.progressed(share)),
            Self::Tilt(act) => Self::Tilt(act.progressed(share)),
            Self::Uplift(act) => Self::Uplift(act.progressed(share)),
            Self::Fold(act) => Self::Fold(act.progressed(share)),
            Self::Fault(act) => Self::Fault(act.progressed(share)),
            Self::Dominoes(act) => Self::Dominoes(act.progressed(share)),
            Self::Erosion(act) => Self::Erosion(act.progressed(share)),
            Self::Dyke(act) => Self::Dyke(act.progressed(share)),
            Self::Sheet(act) => Self::Sheet(act.progressed(share)),
            Self::Body(act) => Self::Body(act.progressed(share)),
            Self::Volcano(act) => Self::Volcano(act.progressed(share)),
            Self::Salt(act) => Self::Salt(act.progressed(share)),
            Self::Metamorphism(act) => Self::Metamorphism(act.progressed(share)),
            Self::Terrain(act) => Self::Terrain(act.progressed(share)),
            Self::Sea(act) => Self::Sea(*act),
        }
    }

    /// The name that the text gives to it.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Fault(act) => act.name.as_deref(),
            Self::Erosion(act) => act.name.as_deref(),
            Self::Dyke(act) => act.name.as_deref(),
            Self::Sheet(act) => act.name.as_deref(),
            Self::Body(act) => act.name.as_deref(),
            Self::Volcano(act) => act.name.as_deref(),
            Self::Salt(act) => act.name.as_deref(),
            _ => None,
        }
    }
}
