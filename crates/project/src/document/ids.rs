//! Ids, and how references follow what they mean.
//!
//! `project.toml` refers to a thing by its id, which never changes; its name stands in its own entry alone, so that a
//! rename changes one line. In memory the same places hold names, which commands, figures and the window speak of:
//! [`Document::from_text`] resolves ids, and [`Document::to_text`] writes them. A reference that a person typed as a
//! name is understood, too, and becomes an id when the project is next saved.
//!
//! A layer has no entry. It is called after the horizon at its base, so that it keeps its style whatever is put in or
//! taken out above it.
//!
//! Whoever changes which things there are, or their names, does so through [`Document::by_ids`].

use super::Document;
use super::references::{
    HORIZON, LAYER, Reference, ReferenceHolder, ReferenceKind, ReferenceVisitor, TEXTURE, VOLUME, WELL, visit_scene,
};
use crate::error::Noun;
use render::Scene;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// What identifies an entry in its project. Nothing: it gets one when it is first written or referred to.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Id(String);

impl Id {
    /// Whether there is none yet.
    pub fn is_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Its letters.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A thing of the project.
#[derive(Debug, Clone)]
struct NamedThing {
    noun: Noun,
    id: String,
    name: String,
}

/// All things that can be referred to.
#[derive(Debug, Clone, Default)]
struct NameIndex(Vec<NamedThing>);

/// Most blanks in a name, which has at most 80 characters.
const MOST_BLANKS: usize = 40;

/// What a reference is translated from; it becomes the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CalledBy {
    Id,
    Name,
}

impl NameIndex {
    /// What the thing is called the other way that `text` refers to.
    fn other(&self, from: CalledBy, nouns: &[Noun], text: &str) -> Option<&str> {
        nouns.iter().find_map(|noun| {
            let mut things = self.0.iter().filter(|named| named.noun == *noun).map(|named| match from {
                CalledBy::Id => (&named.id, &named.name),
                CalledBy::Name => (&named.name, &named.id),
            });
            things.find(|(said, _)| *said == text).map(|(_, other)| other.as_str())
        })
    }

    /// The words of a label with the things in them called the other way: a name alone, a well and its top, or what a
    /// panel is called, which may have horizons in it, and a label on it.
    fn words(&self, from: CalledBy, nouns: &[Noun], words: &str) -> Option<String> {
        if let Some(alone) = self.name_or_top(from, nouns, words) {
            return Some(alone);
        }
        let (panel, label) = words.split_once(": ")?;
        let title = self.between_blanks(from, panel);
        let own = self.name_or_top(from, nouns, label);
        (title != panel || own.is_some()).then(|| format!("{title}: {}", own.as_deref().unwrap_or(label)))
    }

    fn name_or_top(&self, from: CalledBy, nouns: &[Noun], words: &str) -> Option<String> {
        if let Some(other) = self.other(from, nouns, words) {
            return Some(other.to_owned());
        }
        let mut blanks = words.match_indices(' ').take(MOST_BLANKS).filter(|_| nouns.contains(&Noun::Well));
        blanks.find_map(|(at, _)| Some(format!("{}{}", self.other(from, WELL, &words[..at])?, &words[at..])))
    }

    /// A title with the horizons in it called the other way: the longest that stand between two blanks.
    fn between_blanks(&self, from: CalledBy, title: &str) -> String {
        let (mut said, mut rest) = (String::new(), title);
        while let Some(blank) = rest.find(' ') {
            let (before, after) = rest.split_at(blank + 1);
            said += before;
            let blanks = after.match_indices(' ').take(MOST_BLANKS);
            let found = blanks.filter_map(|(end, _)| Some((end, self.other(from, HORIZON, &after[..end])?))).last();
            let (end, other) = found.unwrap_or((0, ""));
            said += other;
            rest = &after[end..];
        }
        said + rest
    }

    fn translated(&self, from: CalledBy, place: Reference<'_>, text: &str) -> Option<String> {
        match place.kind {
            ReferenceKind::Words => self.words(from, place.nouns, text),
            ReferenceKind::Name | ReferenceKind::Record => self.other(from, place.nouns, text).map(str::to_owned),
        }
    }
}

impl Document {
    /// The entries of one kind that have ids, with their names; none of the kinds that have none.
    fn entries_mut(&mut self, noun: Noun) -> Vec<(&mut Id, &mut String)> {
        match noun {
            Noun::Volume => self.volumes.iter_mut().map(|entry| (&mut entry.id, &mut entry.name)).collect(),
            Noun::Horizon => self.horizons.iter_mut().map(|entry| (&mut entry.id, &mut entry.name)).collect(),
            Noun::Fault => self.faults.iter_mut().map(|entry| (&mut entry.id, &mut entry.name)).collect(),
            Noun::Well => self.wells.iter_mut().map(|entry| (&mut entry.id, &mut entry.name)).collect(),
            Noun::Texture => self.textures.iter_mut().map(|entry| (&mut entry.id, &mut entry.name)).collect(),
            Noun::Scene => self.scenes.iter_mut().map(|entry| (&mut entry.id, &mut entry.name)).collect(),
            Noun::Layer | Noun::Parameterization | Noun::Note | Noun::Figure => Vec::new(),
        }
    }

    /// Gives the entry at a place in its list another name.
    pub(crate) fn name_entry(&mut self, noun: Noun, place: usize, name: &str) {
        if let Some((_, of_entry)) = self.entries_mut(noun).into_iter().nth(place) {
            name.clone_into(of_entry);
        }
    }

    /// All things with their ids. An entry gets one if it has none, or one that an entry before it has.
    fn index(&mut self) -> NameIndex {
        let mut all = Vec::new();
        let mut last = self.last_id;
        for noun in Noun::ALL {
            let mut taken = BTreeSet::new();
            for (id, name) in self.entries_mut(noun) {
                while id.is_none() || !taken.insert(id.0.clone()) {
                    last += 1;
                    *id = Id(format!("{noun}-{last}"));
                }
                all.push(NamedThing { noun, id: id.0.clone(), name: name.clone() });
            }
        }
        self.last_id = last;
        let bases = self.horizons.iter().map(|entry| format!("layer-above-{}", entry.id.0));
        let layers = bases.chain(["layer-lowest".to_owned()]).zip(self.layers());
        all.extend(layers.map(|(id, name)| NamedThing { noun: Noun::Layer, id, name }));
        NameIndex(all)
    }

    fn translate(&mut self, from: CalledBy) {
        let index = self.index();
        self.visit_references(&mut |place, text| {
            if let Some(other) = index.translated(from, place, text) {
                *text = other;
            }
            true
        });
    }

    /// The same state with ids in place of names: what `project.toml` says.
    pub(super) fn with_ids(&self) -> Self {
        let mut document = self.clone();
        document.translate(CalledBy::Name);
        document
    }

    /// Resolves the ids that `project.toml` says.
    pub(super) fn resolve_ids(&mut self) {
        self.translate(CalledBy::Id);
    }

    /// Makes a change after which other things exist, or have other names: references follow what they mean. Those to
    /// what is gone are dropped with what hangs on them; returns what held them.
    pub(crate) fn by_ids<T>(&mut self, change: impl FnOnce(&mut Self) -> T) -> (T, Vec<String>) {
        let before = self.index();
        self.translate(CalledBy::Name);
        let done = change(self);
        let after = self.index();
        let mut lost: Vec<String> = Vec::new();
        self.visit_references(&mut |place, text| {
            if let Some(name) = after.translated(CalledBy::Id, place, text) {
                *text = name;
                return true;
            }
            let is_gone =
                place.kind != ReferenceKind::Record && before.other(CalledBy::Id, place.nouns, text).is_some();
            if let Some(name) = before.translated(CalledBy::Id, place, text) {
                *text = name;
            }
            if is_gone && let Some(holder) = before.said(place.holder).filter(|holder| !lost.contains(holder)) {
                lost.push(holder);
            }
            !is_gone
        });
        (done, lost)
    }

    /// The references to what the project does not have, each with what holds it; `is_pattern` knows the patterns of the
    /// library, which have no entries.
    pub(crate) fn dangling(&self, is_pattern: impl Fn(&str) -> bool) -> Vec<String> {
        let mut document = self.clone();
        let index = document.index();
        let mut found = Vec::new();
        document.visit_references(&mut |place, name| {
            let is_known = place.kind != ReferenceKind::Name
                || index.other(CalledBy::Name, place.nouns, name).is_some()
                // One stick alone makes no fault.
                || place.holder == ReferenceHolder::Sticks
                || (place.nouns == TEXTURE && is_pattern(name));
            if !is_known {
                let nouns: Vec<String> = place.nouns.iter().map(ToString::to_string).collect();
                found.push(format!("{}: there is no {} \"{name}\"", place.holder, nouns.join(" or ")));
            }
            true
        });
        found
    }

    /// Puts the id of a thing of this kind in place of its name.
    pub(crate) fn ids_of_names(&self) -> impl Fn(Noun, &mut String) + use<> {
        self.called(CalledBy::Name)
    }

    /// Puts the name of a thing of this kind in place of its id.
    pub(crate) fn names_of_ids(&self) -> impl Fn(Noun, &mut String) + use<> {
        self.called(CalledBy::Id)
    }

    fn called(&self, from: CalledBy) -> impl Fn(Noun, &mut String) + use<> {
        let index = self.clone().index();
        move |noun, text| {
            if let Some(other) = index.other(from, &[noun], text) {
                *text = other.to_owned();
            }
        }
    }

    /// The names that things have in a later state.
    pub fn renamed_in(&self, later: &Self) -> Renamed {
        let [before, after] = [self, later].map(|document| document.clone().index());
        Renamed { before, after }
    }
}

impl NameIndex {
    /// A holder in words, in which ids are called by their names. The sticks of a fault go with it, which is no loss.
    fn said(&self, holder: ReferenceHolder<'_>) -> Option<String> {
        let name = |nouns, text| self.other(CalledBy::Id, nouns, text).unwrap_or(text);
        match holder {
            ReferenceHolder::Sticks => None,
            ReferenceHolder::Layer(layer) => Some(ReferenceHolder::Layer(name(LAYER, layer)).to_string()),
            ReferenceHolder::Scalars(volume) => Some(ReferenceHolder::Scalars(name(VOLUME, volume)).to_string()),
            holder => Some(holder.to_string()),
        }
    }
}

/// What things are called in two states.
#[derive(Debug, Clone, Default)]
pub struct Renamed {
    before: NameIndex,
    after: NameIndex,
}

impl Renamed {
    /// Lets a name follow the thing that has it in the earlier state.
    pub fn follow(&self, noun: Noun, name: &mut String) {
        let id = self.before.other(CalledBy::Name, &[noun], name);
        if let Some(now) = id.and_then(|id| self.after.other(CalledBy::Id, &[noun], id)) {
            now.clone_into(name);
        }
    }

    /// Lets a scene follow.
    pub fn follow_in(&self, scene: &mut Scene) {
        let mut visit = |place: Reference<'_>, text: &mut String| {
            let ids = self.before.translated(CalledBy::Name, place, text);
            if let Some(now) = ids.and_then(|ids| self.after.translated(CalledBy::Id, place, &ids)) {
                *text = now;
            }
            true
        };
        visit_scene(scene, &mut ReferenceVisitor { visit: &mut visit, holder: ReferenceHolder::Style });
    }
}

#[cfg(test)]
mod tests;
