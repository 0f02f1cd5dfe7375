//! Volumes of sections: hidden, and a second one over the first, by labels.

use super::command::{applied, choose};
use super::driven::{Driven, click, open, state, wait};
use egui_kittest::kittest::Queryable;
use project::command::{AttributeKind, Command, ComputeAttribute, Remove};
use project::error::Noun;
use ttf::ColourMap;

fn settled(harness: &mut Driven) {
    wait(harness, "all is drawn", |harness| harness.state().as_ref().unwrap().is_settled());
    assert!(state(harness).notices.iter().all(|notice| !notice.failed), "{:?}", state(harness).notices);
}

fn envelope() -> Command {
    Command::Attribute(ComputeAttribute {
        kind: AttributeKind::Envelope,
        name: "strength".into(),
        volume: None,
        dip: Default::default(),
        semblance: Default::default(),
        memory_bytes: None,
    })
}

#[test]
fn a_second_volume_lies_over_the_sections_and_volumes_are_hidden() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(folder.path());
    applied(&mut harness, &envelope());
    click(&mut harness, "Sections");
    click(&mut harness, "Data");
    settled(&mut harness);
    let over = |harness: &Driven| state(harness).session.as_ref().unwrap().view.volumes.over.clone();
    click(&mut harness, "Show volume strength");
    settled(&mut harness);
    assert_eq!(over(&harness).unwrap().volume, "strength");
    // Each section says what it shows.
    wait(&mut harness, "titles", |harness| harness.query_all_by_label("strength over seismic, 50 %").count() == 3);
    choose(&mut harness, "Colours of strength", "grey");
    settled(&mut harness);
    assert_eq!(over(&harness).unwrap().map, ColourMap::Grey);
    click(&mut harness, "Show volume seismic");
    settled(&mut harness);
    assert_eq!(harness.query_all_by_label("strength, 50 %").count(), 3);
    click(&mut harness, "Show volume strength");
    settled(&mut harness);
    assert_eq!(harness.query_all_by_label("seismic is hidden").count(), 3);
    click(&mut harness, "Show volume seismic");
    click(&mut harness, "Show volume strength");
    settled(&mut harness);
    // What is gone is not shown any longer.
    applied(&mut harness, &Command::Remove(Remove { noun: Noun::Volume, name: "strength".into() }));
    settled(&mut harness);
    assert_eq!(over(&harness), None);
}
