//! Layers of a project: their names, and how their styles persist when the horizons change.
//!
//! A layer is called after the horizon at its base ([`super::ids`]). So a horizon put into a layer splits it: the part
//! that keeps the old base keeps the name and the style, the part above the new horizon starts without them. Removing a
//! horizon joins two layers into one, which keeps the name and the style of the lower one.

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

    /// The text of the geological history that may say what i, j and k are, and how many of its events have happened (absent:
    /// all). None where anyone has stated how the beds of a layer lie.
    pub(crate) fn history_of_coordinates(&self) -> Option<(&str, Option<f64>)> {
        let text = self.geological_history.as_deref().filter(|_| self.k.is_empty())?;
        Some((text, self.history_until))
    }

    /// Puts a horizon at `position` (0 = youngest). It gets a colour of its own unless it has one, and the others keep
    /// those in which they were drawn until now.
    pub(crate) fn insert_horizon(&mut self, position: usize, mut entry: HorizonEntry) {
        if entry.own_colour().is_none() {
            entry.colour = Some(self.next_colour());
        }
        for (index, other) in self.horizons.iter_mut().enumerate() {
            if other.own_colour().is_none() {
                other.colour = Some(horizon_colour(None, index));
            }
        }
        self.by_ids(|document| document.put_in(position, entry, String::new()));
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

    /// Puts a horizon in, and the name of the layer above it if layers have names.
    fn put_in(&mut self, position: usize, entry: HorizonEntry, layer: String) {
        self.horizons.insert(position, entry);
        if !self.layer_names.is_empty() {
            self.layer_names.insert(position, layer);
        }
    }

    /// Takes a horizon out with the name of the layer above it.
    pub(crate) fn take_out(&mut self, position: usize) -> (HorizonEntry, String) {
        let has_names = !self.layer_names.is_empty();
        let layer = if has_names { self.layer_names.remove(position) } else { String::new() };
        (self.horizons.remove(position), layer)
    }

    /// Puts `entry` in place of the horizon at `old`, at another position; the layer above comes along.
    pub(crate) fn move_horizon(&mut self, old: usize, position: usize, entry: HorizonEntry) {
        self.by_ids(|document| {
            let (before, layer) = document.take_out(old);
            document.put_in(position, HorizonEntry { id: before.id, ..entry }, layer);
        });
    }

    /// Renames a layer.
    ///
    /// # Errors
    /// The name cannot be used or is taken by another layer.
    pub(crate) fn name_layer(&mut self, position: usize, name: &str) -> Result<(), ProjectError> {
        let layers = self.layers();
        if layers[position] != name {
            if layers[position].to_lowercase() != name.to_lowercase() {
                self.check_new_name(Noun::Layer, name)?;
            }
            self.by_ids(|document| {
                document.layer_names.resize(layers.len(), String::new());
                name.clone_into(&mut document.layer_names[position]);
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
