//! Labels that stand elsewhere or look otherwise than they were placed, as a scene says ([`LabelChange`]).
//!
//! A change is made to the finished page, so whoever drags a label sees at once what will be printed. What marks a place
//! stays where it is: the sign of a well, the half-arrows of a fault, the foot of a leader.

use glam::DVec2;
use page::Rect;
use page::list::{DisplayList, Group, GroupKind, Item, POINTS_PER_MM, Path, Segment, Text};
pub use render::LabelChange;
use ttf::{Colour, Preset};

/// Between the name of a map, section or correlation panel and that of a label on it.
const OF_PANEL: &str = ": ";
/// The panel of a block, and the group in it of what is written on the block.
pub(crate) const BLOCK: &str = "block";
pub(crate) const ON_BLOCK: &str = "labels";

/// A label that can be moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Movable {
    /// What a [`LabelChange`] calls it.
    pub label: String,
    /// The room that it takes.
    pub bounds: Rect,
    /// Size in points and colour of its letters, those of the first words; `None` where it has none.
    pub letters: Option<(f64, Colour)>,
}

/// The labels of a page, in the order of drawing.
pub fn movable(list: &DisplayList) -> Vec<Movable> {
    list.faces.scope(|| found(list))
}

fn found(list: &DisplayList) -> Vec<Movable> {
    let mut found = Vec::new();
    for group in list.items.iter().filter_map(as_group) {
        match group.kind {
            GroupKind::Panel if group.name != BLOCK => {
                for part in group.items.iter().filter_map(as_group).filter(|part| is_explanation(part)) {
                    let label = format!("{}{OF_PANEL}{}", group.name, part.name);
                    let bounds = bounds_of(&part.items).into_iter().reduce(|a, b| a.around(b.min).around(b.max));
                    found.extend(bounds.map(|bounds| Movable { label, bounds, letters: letters_of(&part.items) }));
                }
            }
            GroupKind::Panel => {
                for part in group.items.iter().filter_map(as_group).filter(|part| is_written(part)) {
                    match part.name == ON_BLOCK {
                        true => part.items.iter().filter_map(as_group).for_each(|label| gather(label, &mut found)),
                        false => gather(part, &mut found),
                    }
                }
            }
            _ => gather(group, &mut found),
        }
    }
    found
}

/// A page with the labels of its panels and of itself changed, in the colours of a preset. The page must have been made
/// without changes.
pub fn changed(list: &DisplayList, changes: &[LabelChange], preset: Preset) -> DisplayList {
    let mut list = list.clone();
    list.faces.clone().scope(|| {
        for item in &mut list.items {
            if let Item::Group(panel) = item {
                change_panel(panel, changes);
            }
        }
        change(&mut list.items, changes);
    });
    list.print(preset);
    list
}

fn gather(group: &Group, found: &mut Vec<Movable>) {
    let places = match is_pinned(group) {
        true => group.items.iter().filter_map(as_text).map(Text::bounds).collect(),
        false => bounds_of(&group.items),
    };
    if let Some(bounds) = places.into_iter().reduce(|a, b| a.around(b.min).around(b.max)) {
        found.push(Movable { label: group.name.clone(), bounds, letters: letters_of(&group.items) });
    }
    if group.kind == GroupKind::Well {
        group.items.iter().filter_map(as_group).for_each(|top| gather(top, found));
    }
}

fn bounds_of(items: &[Item]) -> Vec<Rect> {
    let of = |item: &Item| match item {
        Item::Path(path) => path.path.bounds().into_iter().collect(),
        Item::Text(text) => vec![text.bounds()],
        Item::Picture(picture) => Path::polygon(&picture.corners()).bounds().into_iter().collect(),
        Item::Group(group) => match group.clip.as_ref().and_then(Path::bounds) {
            Some(clip) => vec![clip],
            None => bounds_of(&group.items),
        },
    };
    items.iter().flat_map(of).collect()
}

fn letters_of(items: &[Item]) -> Option<(f64, Colour)> {
    items.iter().find_map(|item| match item {
        Item::Text(text) => Some((text.size, text.ink.colour)),
        Item::Group(group) => letters_of(&group.items),
        _ => None,
    })
}

/// Makes changes to the labels of a panel: those of a block by their names, those of other panels by the panel's name
/// and theirs.
pub(crate) fn change_panel(panel: &mut Group, changes: &[LabelChange]) {
    if panel.kind != GroupKind::Panel {
        return;
    }
    if panel.name == BLOCK {
        return change(&mut panel.items, changes);
    }
    let own = |change: &LabelChange| {
        let label = change.label.strip_prefix(&panel.name)?.strip_prefix(OF_PANEL)?.to_owned();
        Some(LabelChange { label, ..change.clone() })
    };
    let own: Vec<LabelChange> = changes.iter().filter_map(own).collect();
    change(&mut panel.items, &own);
}

/// Makes changes to those of `items` that are labels: on the page all but its panels, in a panel all but its picture.
pub(crate) fn change(items: &mut Vec<Item>, changes: &[LabelChange]) {
    if changes.is_empty() {
        return;
    }
    let is_left = |item: &Item| {
        let hidden = |group: &Group| changes.iter().any(|change| change.is_hidden && change.label == group.name);
        !as_group(item).is_some_and(|group| is_label(group) && hidden(group))
    };
    items.retain(is_left);
    for item in items {
        let Item::Group(group) = item else { continue };
        if !is_label(group) {
            continue;
        }
        if group.name == ON_BLOCK || group.kind == GroupKind::Well {
            change(&mut group.items, changes);
        }
        let name = group.name.clone();
        for change in changes.iter().filter(|change| change.label == name) {
            apply(group, change);
        }
    }
}

fn apply(group: &mut Group, change: &LabelChange) {
    let by = DVec2::from_array(change.moved_mm) * POINTS_PER_MM;
    match is_pinned(group) {
        true => {
            for item in &mut group.items {
                match item {
                    Item::Text(text) => text.shift(by),
                    // The end at the name of a line to it.
                    Item::Path(path) => {
                        if let [Segment::Move(_), Segment::Line(end)] = &mut path.path.segments[..] {
                            *end += by;
                        }
                    }
                    _ => {}
                }
            }
        }
        false => shift(&mut group.items, by),
    }
    restyle(&mut group.items, change);
}

/// Whether a group on a page or in a panel is written on what it shows.
fn is_label(group: &Group) -> bool {
    !matches!(group.kind, GroupKind::Panel | GroupKind::Data)
}

/// Whether a group in a map, section or correlation panel explains it in words.
fn is_explanation(group: &Group) -> bool {
    let has_words = |item: &Item| as_text(item).is_some() || as_group(item).is_some_and(is_explanation);
    let is_label = !matches!(group.kind, GroupKind::Panel | GroupKind::Data | GroupKind::Part);
    is_label && group.items.iter().any(has_words)
}

/// Whether only the letters of a group move.
fn is_pinned(group: &Group) -> bool {
    matches!(group.kind, GroupKind::Well | GroupKind::Fault | GroupKind::Leader)
}

/// Whether a group in a block's panel is written on or beside the block.
fn is_written(group: &Group) -> bool {
    matches!(group.kind, GroupKind::Annotation | GroupKind::Leader)
}

fn as_group(item: &Item) -> Option<&Group> {
    match item {
        Item::Group(group) => Some(group),
        _ => None,
    }
}

fn as_text(item: &Item) -> Option<&Text> {
    match item {
        Item::Text(text) => Some(text),
        _ => None,
    }
}

fn shift(items: &mut [Item], by: DVec2) {
    for item in items {
        match item {
            Item::Path(path) => path.path.shift(by),
            Item::Text(text) => text.shift(by),
            Item::Picture(picture) => picture.corner += by,
            Item::Group(group) => {
                group.clip.iter_mut().for_each(|clip| clip.shift(by));
                shift(&mut group.items, by);
            }
        }
    }
}

fn restyle(items: &mut [Item], change: &LabelChange) {
    for item in items {
        match item {
            Item::Text(text) => {
                text.ink.colour = change.colour.unwrap_or(text.ink.colour);
                if let Some(size) = change.size_pt {
                    text.resize(size);
                }
            }
            Item::Group(group) => restyle(&mut group.items, change),
            _ => {}
        }
    }
}
