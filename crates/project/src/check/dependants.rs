//! What is made of a data file, or shows it: what is lost while it is damaged.

use super::objects::Entry;
use crate::document::{Document, HorizonEntry};

/// What of a state depends on one of its data files.
pub(super) fn of(document: &Document, entry: &Entry) -> Vec<String> {
    match entry {
        Entry::Volume(entry) => of_volume(document, &entry.name, entry.geometry.is_none()),
        Entry::Horizon(entry) => of_horizon(document, entry),
        Entry::Fault(entry) => of_fault(document, &entry.name),
        Entry::Well(_) => Vec::new(),
        Entry::Texture(entry) => of_texture(document, &entry.name),
        Entry::Parameterization(_) => vec!["every picture of layers".to_owned()],
    }
}

fn of_volume(document: &Document, name: &str, is_on_the_lattice: bool) -> Vec<String> {
    let mut found = Vec::new();
    if document.extraction.as_ref().is_some_and(|extraction| extraction.volume == name) {
        found.push("the next extraction of horizon candidates".to_owned());
    }
    let raw = document.style.raw.as_ref().map(|raw| raw.volume.as_str());
    let is_first = document.volumes.first().is_some_and(|first| first.name == name);
    let is_raw = raw == Some(name) || (raw.is_none() && is_first && is_on_the_lattice);
    if is_raw {
        found.push("every picture of raw data".to_owned());
    }
    if document.style.scalars.iter().any(|scalar| scalar.volume == name) {
        found.push("textures by its values".to_owned());
    }
    let shows = |scene: &render::Scene| {
        let shows_raw = scene.raw.as_ref().map_or(is_raw && scene.blend > 0.0, |raw| raw.volume == name);
        shows_raw || scene.media.volumes().any(|shown| shown == name)
    };
    let scenes = document.scenes.iter().filter(|entry| shows(&entry.scene));
    found.extend(scenes.map(|entry| format!("scene \"{}\"", entry.name)));
    found
}

fn of_horizon(document: &Document, entry: &HorizonEntry) -> Vec<String> {
    let mut found = Vec::new();
    let layers = document.layers();
    if let Some(position) = document.horizons.iter().position(|other| other.name == entry.name) {
        let beside = layers.iter().skip(position).take(2);
        found.extend(beside.map(|layer| format!("layer \"{layer}\"")));
    }
    match entry.assembly.as_ref().map(|log| log.picks.len()) {
        None | Some(0) => {}
        Some(1) => found.push("1 pick".to_owned()),
        Some(count) => found.push(format!("{count} picks")),
    }
    match entry.assembly.as_ref().map(|log| log.drawn.len()) {
        None | Some(0) => {}
        Some(1) => found.push("1 part drawn or tracked".to_owned()),
        Some(count) => found.push(format!("{count} parts drawn or tracked")),
    }
    if document.fault_proposals.is_some() {
        found.push("the proposed faults".to_owned());
    }
    let shows = |scene: &render::Scene| {
        scene.media.horizons.iter().any(|horizon| horizon.name.as_deref() == Some(entry.name.as_str()))
    };
    let scenes = document.scenes.iter().filter(|scene| shows(&scene.scene));
    found.extend(scenes.map(|scene| format!("scene \"{}\"", scene.name)));
    found
}

fn of_fault(document: &Document, name: &str) -> Vec<String> {
    let ending = document.faults.iter().filter(|fault| fault.truncated_by.as_deref() == Some(name));
    let mut found: Vec<String> = ending.map(|fault| format!("fault \"{}\", which ends at it", fault.name)).collect();
    if !document.horizons.is_empty() {
        found.push("the fault blocks of every layer".to_owned());
    }
    found
}

fn of_texture(document: &Document, name: &str) -> Vec<String> {
    let styles = &document.style.layers.styles;
    let layers = styles.iter().filter(|style| style.intervals.iter().any(|interval| interval.texture == name));
    let mut found: Vec<String> = layers.map(|style| format!("layer \"{}\"", style.layer)).collect();
    let scalars = &document.style.scalars;
    let volumes = scalars.iter().filter(|scalar| scalar.intervals.iter().any(|interval| interval.texture == name));
    found.extend(volumes.map(|scalar| format!("textures by the values of \"{}\"", scalar.volume)));
    found
}
