//! Maps of horizons and thicknesses, drawn on a thread for the latest wish.

use super::wishes::{Wished, Wishes};
use super::{Event, Interpreted, Outbox, Rocks};
use figure::map::{HorizonMap, MapSource, Mapped};
use std::sync::{Arc, PoisonError};
use survey::SurveyGeometry;

/// What a map is made from.
#[derive(Clone)]
pub enum MapData {
    /// The model.
    Rocks(Rocks),
    /// The horizons as they were picked, without a model.
    Interpreted(Arc<Interpreted>, Box<SurveyGeometry>),
}

/// A map to be seen.
#[derive(Clone)]
pub struct MapWish {
    /// Of what.
    pub mapped: Mapped,
    /// What it is made from.
    pub data: MapData,
}

/// The thread that maps, and the wish it works on next.
pub struct Maps {
    wishes: Wishes<Option<MapWish>>,
}

impl Maps {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        let told = outbox.clone();
        Self {
            wishes: Wishes::start("the map", &told, move |wished: &Wished<Option<MapWish>>| {
                while let Some(wish) = wished.next(Option::take) {
                    if let Some(map) = draw(&wish) {
                        outbox.send(Event::Mapped(map));
                    }
                }
            }),
        }
    }

    /// Maps this next.
    pub fn map(&self, wish: MapWish) {
        self.wishes.change(|next| *next = Some(wish));
    }
}

/// Maps what is wished; `None` when there is nothing of it.
fn draw(wish: &MapWish) -> Option<HorizonMap> {
    match &wish.data {
        MapData::Rocks(rocks) => {
            let loaded = rocks.read().unwrap_or_else(PoisonError::into_inner);
            HorizonMap::new(&loaded.geometry, MapSource::Model(&loaded.rock.as_ref()?.model), wish.mapped)
        }
        MapData::Interpreted(shown, geometry) => {
            HorizonMap::new(geometry, MapSource::Sheets(&shown.horizons_seen()), wish.mapped)
        }
    }
}
