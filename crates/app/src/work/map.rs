//! Maps of depth and thickness, drawn by a latest-value worker.

use super::latest_value::{Inbox, LatestValueWorker};
use super::{Event, Interpreted, Outbox, Rocks};
use figure::map::{HorizonMap, MapSource, Mapped};
use std::sync::Arc;
use survey::SurveyGeometry;

/// The data that a map is made from.
#[derive(Clone)]
pub enum MapData {
    /// The model of the loaded data.
    Rocks(Rocks),
    /// The horizons as they were picked, without a model.
    Interpreted(Arc<Interpreted>, Box<SurveyGeometry>),
}

/// A request for a map.
#[derive(Clone)]
pub struct MapRequest {
    /// What it shows.
    pub mapped: Mapped,
    /// The data that it is made from.
    pub data: MapData,
}

/// The worker that draws maps.
pub struct Maps {
    worker: LatestValueWorker<Option<MapRequest>>,
}

impl Maps {
    /// Starts the worker.
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

    /// Draws this map next.
    pub fn map(&self, request: MapRequest) {
        self.worker.change(|next| *next = Some(request));
    }
}

/// Draws the requested map; `None` when there are no data for it.
fn draw(request: &MapRequest) -> Option<HorizonMap> {
    match &request.data {
        MapData::Rocks(rocks) => {
            HorizonMap::new(&rocks.geometry, MapSource::Model(&rocks.rock.as_ref()?.model), request.mapped)
        }
        MapData::Interpreted(shown, geometry) => {
            HorizonMap::new(geometry, MapSource::Sheets(&shown.horizons_seen()), request.mapped)
        }
    }
}
