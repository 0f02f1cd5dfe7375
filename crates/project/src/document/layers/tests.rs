//! Layers keep their styles, and horizons their colours, when horizons come and go.

use super::*;
use crate::document::{Id, Origin};
use survey::Contact;
use ttf::LayerStyle;

fn horizon(name: &str) -> HorizonEntry {
    HorizonEntry {
        id: Id::default(),
        name: name.into(),
        contact: Contact::default(),
        file: format!("horizons/{name}.zarr"),
        hash: String::new(),
        origin: Origin::Picked,
        assembly: None,
        colour: None,
        refined: Vec::new(),
        gap_m: None,
    }
}

fn styled() -> Document {
    let mut document = Document::empty(None);
    document.horizons = vec![horizon("A"), horizon("B")];
    for (index, layer) in document.layers().iter().enumerate() {
        document.style.layers.set(LayerStyle::plain(layer, Colour::new(index as u8, 0, 0)));
    }
    document
}

fn reds(document: &Document) -> Vec<Option<u8>> {
    document.layers().iter().map(|name| Some(document.style.layers.style(name)?.colour.rgb[0])).collect()
}

#[test]
fn the_part_with_the_old_base_keeps_the_style_and_joining_undoes_it() {
    let mut document = styled();
    let before = document.clone();
    document.insert_horizon(1, horizon("N"));
    assert_eq!(document.layers(), ["above A", "A - N", "N - B", "below B"]);
    assert_eq!(reds(&document), [Some(0), None, Some(1), Some(2)]);
    document.by_ids(|document| drop(document.take_out(1)));
    assert_eq!((document.layers(), &document.style), (before.layers(), &before.style));
}

#[test]
fn horizons_keep_their_colours_when_another_comes_between() {
    let mut document = styled();
    let shown = |document: &Document| {
        let all = document.horizons.iter().enumerate();
        all.map(|(index, entry)| horizon_colour(entry.own_colour(), index)).collect::<Vec<_>>()
    };
    let before = shown(&document);
    document.insert_horizon(0, horizon("N"));
    assert_eq!(shown(&document)[1..], before);
    assert!(!before.contains(&shown(&document)[0]));
    for number in 3..HORIZON_COLOURS.len() {
        document.insert_horizon(1, horizon(&format!("N{number}")));
    }
    let all = shown(&document);
    assert!(HORIZON_COLOURS.iter().all(|colour| all.contains(colour)));
    // All are taken once: it begins anew.
    assert_eq!(document.next_colour(), HORIZON_COLOURS[0]);
}

#[test]
fn names_and_styles_follow_a_renamed_horizon() {
    let mut document = styled();
    document.name_layer(1, "Chalk").unwrap();
    document.by_ids(|document| document.horizons[0].name = "Top".into());
    assert_eq!(document.layers(), ["above Top", "Chalk", "below B"]);
    assert_eq!(reds(&document), [Some(0), Some(1), Some(2)]);
    assert!(document.name_layer(2, "chalk").is_err());
    document.insert_horizon(0, horizon("Sea floor"));
    assert_eq!(document.layers(), ["above Sea floor", "Sea floor - Top", "Chalk", "below B"]);
}
