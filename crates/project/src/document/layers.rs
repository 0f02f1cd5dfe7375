//! Layers of a project: their names, and how their styles persist when the horizons change.
//!
//! Styles belong to layers by name. A horizon put into a layer splits it: the part that keeps the old base
//! keeps the name and the style, the part above the new horizon starts without them. Removing a horizon joins
//! two layers into one, which keeps the name and the style of the lower one.

use super::{Document, HorizonEntry};
use crate::error::{Noun, ProjectError};
use figure::style::{HORIZON_COLOURS, horizon_colour};
use param::KDefinition;
use ttf::Colour;

impl Document {
    /// The layer names, youngest first.
    pub fn layers(&self) -> Vec<String> {
        self.stratigraphy().layer_names_bottom_up().into_iter().rev().collect()
    }

    /// The definition of k of each layer, deepest first: the one that was stated, or the one that its contacts call
    /// for.
    pub fn k_definitions(&self) -> Vec<KDefinition> {
        let stratigraphy = self.stratigraphy();
        let names = stratigraphy.layer_names_bottom_up();
        let by_contact = KDefinition::for_contacts(&stratigraphy);
        names.iter().zip(by_contact).map(|(name, usual)| self.k.get(name).copied().unwrap_or(usual)).collect()
    }

    /// Makes a change that keeps the number of layers, and moves the styles when the names of their layers change.
    pub fn keep_styles<E>(&mut self, change: impl FnOnce(&mut Self) -> Result<(), E>) -> Result<(), E> {
        let before = self.layers();
        change(self)?;
        let after = self.layers();
        self.rename_styles(before.iter().map(String::as_str).zip(after.iter().map(|name| Some(name.as_str()))));
        Ok(())
    }

    /// Puts a horizon at `position` (0 = youngest). It gets a colour of its own unless it has one, and the others keep
    /// those in which they were drawn until now.
    pub fn insert_horizon(&mut self, position: usize, mut entry: HorizonEntry) {
        if entry.own_colour().is_none() {
            entry.colour = Some(self.next_colour());
        }
        for (index, other) in self.horizons.iter_mut().enumerate() {
            if other.own_colour().is_none() {
                other.colour = Some(horizon_colour(None, index));
            }
        }
        self.split_layer(position, |document| document.horizons.insert(position, entry));
    }

    /// A colour for the next horizon: the first of those that the fewest horizons have.
    pub fn next_colour(&self) -> Colour {
        let taken = |colour: &Colour| {
            let shown =
                self.horizons.iter().enumerate().map(|(index, entry)| horizon_colour(entry.own_colour(), index));
            shown.filter(|shown| shown == colour).count()
        };
        HORIZON_COLOURS.into_iter().min_by_key(taken).unwrap_or(HORIZON_COLOURS[0])
    }

    /// Inserts the layer boundary of a horizon at `position` (0 = youngest); `insert` adds the horizon itself.
    fn split_layer(&mut self, position: usize, insert: impl FnOnce(&mut Self)) {
        let before = self.layers();
        insert(self);
        if !self.layer_names.is_empty() {
            self.layer_names.insert(position, String::new());
        }
        let after = self.layers();
        let now = |index: usize| Some(after[if index < position { index } else { index + 1 }].as_str());
        self.rename_styles(before.iter().enumerate().map(|(index, name)| (name.as_str(), now(index))));
    }

    /// Removes the layer boundary at `position`; `remove` removes the horizon itself.
    pub fn join_layers(&mut self, position: usize, remove: impl FnOnce(&mut Self)) {
        let before = self.layers();
        remove(self);
        if !self.layer_names.is_empty() {
            self.layer_names.remove(position);
        }
        let after = self.layers();
        let now = |index: usize| match index.cmp(&position) {
            std::cmp::Ordering::Less => Some(after[index].as_str()),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(after[index - 1].as_str()),
        };
        self.rename_styles(before.iter().enumerate().map(|(index, name)| (name.as_str(), now(index))));
    }

    /// Renames a layer.
    ///
    /// # Errors
    /// The name cannot be used or is taken by another layer.
    pub fn name_layer(&mut self, position: usize, name: &str) -> Result<(), ProjectError> {
        let before = self.layers();
        if before[position] == name {
            return Ok(());
        }
        self.check_new_name(Noun::Layer, name)?;
        self.keep_styles(|document| {
            document.layer_names.resize(before.len(), String::new());
            document.layer_names[position] = name.to_owned();
            Ok(())
        })
    }

    /// Moves styles and definitions of k from old to new layer names at once; those without a new name are dropped.
    fn rename_styles<'a>(&mut self, names: impl Iterator<Item = (&'a str, Option<&'a str>)>) {
        let names: Vec<_> = names.collect();
        let styles = std::mem::take(&mut self.style.layers.styles);
        self.style.layers.styles = styles
            .into_iter()
            .filter_map(|mut style| {
                let now = names.iter().find(|(before, _)| *before == style.layer).map(|(_, now)| *now)?;
                style.layer = now?.to_owned();
                Some(style)
            })
            .collect();
        let k = std::mem::take(&mut self.k);
        let now = |before: &str| names.iter().find(|(name, _)| *name == before)?.1.map(str::to_owned);
        self.k = k.into_iter().filter_map(|(name, k)| Some((now(&name)?, k))).collect();
    }
}

#[cfg(test)]
mod tests;
