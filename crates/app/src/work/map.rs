//! Maps of horizons and thicknesses, drawn on a thread for the latest request.

use super::latest_value::{Inbox, LatestValueWorker};
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

/// A map that is asked for.
#[derive(Clone)]
pub struct MapRequest {
    /// Of what.
    pub mapped: Mapped,
    /// What it is made from.
    pub data: MapData,
}

/// The thread that maps, and the request it works on next.
pub struct Maps {
    worker: LatestValueWorker<Option<MapRequest>>,
}

impl Maps {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        let told = outbox.clone();
        Self {
            worker: LatestValueWorker::start("the map", &told, move |inbox: &Inbox<Option<MapRequest>>| {
                while let Some(request) = inbox.next(Option::take) {
                    if let Some(map) = draw(&request) {
                        outbox.send(Event::Mapped(map));
                    }
                }
            }),
        }
    }

    /// Maps this next.
    pub fn map(&self, request: MapRequest) {
        self.worker.change(|next| *next = Some(request));
    }
}

/// Maps what is asked for; `None` when there is nothing of it.
fn draw(request: &MapRequest) -> Option<HorizonMap> {
    match &request.data {
        MapData::Rocks(rocks) => {
            let loaded = rocks.read().unwrap_or_else(PoisonError::into_inner);
            HorizonMap::new(&loaded.geometry, MapSource::Model(&loaded.rock.as_ref()?.model), request.mapped)
        }
        MapData::Interpreted(shown, geometry) => {
            HorizonMap::new(geometry, MapSource::Sheets(&shown.horizons_seen()), request.mapped)
        }
    }
}
