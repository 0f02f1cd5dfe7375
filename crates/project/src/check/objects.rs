//! The data files that states name, each with the states that need it.

use super::report::Cure;
use super::states::States;
use crate::document::{
    Document, FaultEntry, HorizonEntry, Origin, ParameterizationEntry, TextureEntry, VolumeEntry, WellEntry,
};
use crate::error::Noun;
use std::collections::BTreeMap;

/// An entry of a state that names a data file.
#[derive(Debug, Clone, Copy)]
pub(super) enum Entry<'a> {
    Volume(&'a VolumeEntry),
    Horizon(&'a HorizonEntry),
    Fault(&'a FaultEntry),
    Well(&'a WellEntry),
    Texture(&'a TextureEntry),
    Parameterization(&'a ParameterizationEntry),
}

impl<'a> Entry<'a> {
    pub(super) fn file(&self) -> &'a str {
        match self {
            Self::Volume(entry) => &entry.file,
            Self::Horizon(entry) => &entry.file,
            Self::Fault(entry) => &entry.file,
            Self::Well(entry) => &entry.file,
            Self::Texture(entry) => &entry.file,
            Self::Parameterization(entry) => &entry.file,
        }
    }

    pub(super) fn name(&self) -> &'a str {
        match self {
            Self::Volume(entry) => &entry.name,
            Self::Horizon(entry) => &entry.name,
            Self::Fault(entry) => &entry.name,
            Self::Well(entry) => &entry.name,
            Self::Texture(entry) => &entry.name,
            Self::Parameterization(entry) => &entry.name,
        }
    }

    pub(super) fn noun(&self) -> Noun {
        match self {
            Self::Volume(_) => Noun::Volume,
            Self::Horizon(_) => Noun::Horizon,
            Self::Fault(_) => Noun::Fault,
            Self::Well(_) => Noun::Well,
            Self::Texture(_) => Noun::Texture,
            Self::Parameterization(_) => Noun::Parameterization,
        }
    }

    /// The recorded hash; empty for tiles of older projects, whose recorded length stands in for it.
    fn hash(&self) -> &'a str {
        match self {
            Self::Volume(entry) => &entry.hash,
            Self::Horizon(entry) => &entry.hash,
            Self::Fault(entry) => &entry.hash,
            Self::Well(entry) => &entry.hash,
            Self::Texture(entry) => &entry.hash,
            Self::Parameterization(entry) => &entry.hash,
        }
    }

    fn origin(&self) -> &'a Origin {
        match self {
            Self::Volume(entry) => &entry.origin,
            Self::Horizon(entry) => &entry.origin,
            Self::Fault(entry) => &entry.origin,
            Self::Well(entry) => &entry.origin,
            Self::Texture(entry) => &entry.origin,
            Self::Parameterization(entry) => &entry.origin,
        }
    }

    /// How the data can be had again: from the file they came from, or the way they were made in the project.
    pub(super) fn way_back(&self) -> Cure {
        let (noun, name, origin) = (self.noun(), self.name().to_owned(), self.origin());
        match origin.file() {
            Some(path) => Cure::Import { noun, name, path: path.to_owned() },
            None => Cure::Remake { noun, name, from: origin.to_string() },
        }
    }
}

/// A data file.
#[derive(Debug)]
pub(super) struct Object<'a> {
    /// The entry of the newest state that names it.
    pub entry: Entry<'a>,
    /// That state.
    pub document: &'a Document,
    /// Whether the present state names it.
    pub is_present: bool,
    /// The steps of the history that name it, ascending.
    pub steps: Vec<u32>,
}

impl Object<'_> {
    /// Whether it is a folder, else a file.
    pub(super) fn is_folder(&self) -> bool {
        matches!(self.entry, Entry::Volume(_) | Entry::Horizon(_) | Entry::Parameterization(_))
    }
}

/// The entries of a state.
fn entries(document: &Document) -> impl Iterator<Item = Entry<'_>> {
    let volumes = document.volumes.iter().map(Entry::Volume);
    let horizons = document.horizons.iter().map(Entry::Horizon);
    let faults = document.faults.iter().map(Entry::Fault);
    let wells = document.wells.iter().map(Entry::Well);
    let textures = document.textures.iter().map(Entry::Texture);
    let maps = document.parameterization.iter().map(Entry::Parameterization);
    volumes.chain(horizons).chain(faults).chain(wells).chain(textures).chain(maps)
}

/// All data files of all states, each once for every hash that is recorded for it.
pub(super) fn of(states: &States) -> Vec<Object<'_>> {
    let mut found: BTreeMap<(&str, &str), Object<'_>> = BTreeMap::new();
    let present = states.present().map(|document| (None, document));
    let steps = states.documents().rev().map(|(number, document)| (Some(number), document));
    for (number, document) in present.into_iter().chain(steps) {
        for entry in entries(document) {
            let object = found.entry((entry.file(), entry.hash())).or_insert(Object {
                entry,
                document,
                is_present: false,
                steps: Vec::new(),
            });
            match number {
                None => object.is_present = true,
                Some(number) => object.steps.insert(0, number),
            }
        }
    }
    found.into_values().collect()
}
