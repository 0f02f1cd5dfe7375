//! A project in memory: its document, and the model that is made of it.

use model::{ModelSettings, StructuralModel};
use project::document::{Document, FaultEntry, HorizonEntry, Origin};
use survey::{Contact, Fault, Horizon, Progress};

/// Voxels that a model is built for; more would only take longer.
const MOST_VOXELS: usize = 20_000;

/// A project with two horizons and a fault.
pub fn document() -> Document {
    let mut document = Document::empty(Some(crate::survey()));
    let origin = || Origin::Imported { path: "a.csv".into(), bytes: 10, reading: "csv".into() };
    document.horizons = ["Top", "Base"]
        .map(|name| HorizonEntry {
            id: Default::default(),
            name: name.into(),
            contact: Contact::Conformable,
            file: format!("horizons/{name}.zarr"),
            hash: "00".into(),
            origin: origin(),
            assembly: None,
            colour: None,
            gap_m: None,
            refined: Vec::new(),
        })
        .into();
    document.faults = vec![FaultEntry {
        id: Default::default(),
        name: "F1".into(),
        truncated_by: None,
        grown_m: 0.0,
        file: "faults/F1.json".into(),
        hash: "00".into(),
        origin: origin(),
        colour: None,
    }];
    document
}

/// The model of a document, with data that stand for what it names; `None` for one without horizons, or too large to be built in a moment.
///
/// # Errors
/// Those of building.
pub fn model_of(document: &Document) -> Option<Result<StructuralModel, model::ModelError>> {
    let geometry = document.geometry.as_ref()?;
    let voxels = geometry.size().iter().try_fold(1usize, |product, &count| product.checked_mul(count))?;
    if voxels > MOST_VOXELS || document.horizons.is_empty() || document.horizons.len() + document.faults.len() > 6 {
        return None;
    }
    let (horizon, fault) = crate::interpretation(geometry);
    let step = geometry.vertical.interval as f32 * 3.0;
    let horizons: Vec<Horizon> = (0..document.horizons.len())
        .map(|n| {
            let mut own = Horizon { name: document.horizons[n].name.clone(), ..horizon.clone() };
            own.sheets[0].depth.iter_mut().for_each(|depth| *depth += n as f32 * step);
            own
        })
        .collect();
    let faults: Vec<Fault> = document
        .faults
        .iter()
        .map(|entry| Fault {
            name: entry.name.clone(),
            truncated_by: entry.truncated_by.clone(),
            grown_m: entry.grown_m,
            ..fault.clone()
        })
        .collect();
    let settings = ModelSettings::default();
    Some(StructuralModel::build(geometry, &document.stratigraphy(), &horizons, &faults, &settings, &Progress::silent()))
}

/// The model of [`document`].
///
/// # Errors
/// It cannot be built.
pub fn model(document: &Document) -> Result<StructuralModel, Box<dyn std::error::Error>> {
    Ok(model_of(document).ok_or("there is nothing to build a model of")??)
}
