//! Every kind of thing crossed with every place that can refer to it.

use super::*;
use crate::document::{
    AttributeKind, ExtractionEntry, FaultEntry, FaultSticks, FigureEntry, HorizonEntry, NoteEntry, Origin, SceneEntry,
    TextureEntry, VolumeEntry, WellEntry,
};
use render::media::white_ramp;
use std::collections::HashSet;
use std::mem::discriminant;
use std::path::Path;
use survey::{Contact, SurveyGeometry, VerticalUnit};
use ttf::{LayerStyle, RawColour};

const PATH: &str = "project.toml";

/// What each kind is called here; no other text has these words in it.
const NAMES: [(Noun, &str); 7] = [
    (Noun::Volume, "QVolume"),
    (Noun::Horizon, "Q Horizon"),
    (Noun::Fault, "QFault"),
    (Noun::Well, "Q Well"),
    (Noun::Layer, "Q Layer"),
    (Noun::Texture, "qtexture"),
    (Noun::Scene, "QScene"),
];

fn origin() -> Origin {
    Origin::Imported { path: "a".into(), bytes: 1, reading: "csv".into() }
}

fn horizon(name: &str, file: &str) -> HorizonEntry {
    HorizonEntry {
        id: Id::default(),
        name: name.into(),
        contact: Contact::default(),
        file: format!("horizons/{file}.zarr"),
        hash: file.into(),
        origin: origin(),
        assembly: None,
        colour: None,
        refined: Vec::new(),
        gap_m: None,
    }
}

fn fault(name: &str, file: &str, by: Option<&str>) -> FaultEntry {
    FaultEntry {
        id: Id::default(),
        name: name.into(),
        truncated_by: by.map(Into::into),
        grown_m: 0.0,
        file: format!("faults/{file}.json"),
        hash: file.into(),
        origin: origin(),
        colour: None,
    }
}

/// A project in which every place that can refer to something does.
fn document() -> Document {
    let geometry = SurveyGeometry::regular([11, 21, 31], 25.0, 4.0, VerticalUnit::Metres);
    let mut document = Document::empty(Some(geometry));
    let volume = VolumeEntry {
        id: Id::default(),
        name: "QVolume".into(),
        file: "volumes/v.zarr".into(),
        hash: "v".into(),
        polarity: crate::document::Polarity::Normal,
        clip: 1.0,
        quantity: None,
        lowest: -1.0,
        origin: origin(),
        geometry: None,
    };
    document.volumes =
        vec![VolumeEntry { name: "other".into(), file: "volumes/o.zarr".into(), ..volume.clone() }, volume];
    document.volumes[0].origin = Origin::Attribute { attribute: AttributeKind::Envelope, of: "QVolume".into() };
    document.extraction = Some(ExtractionEntry { key: "k".into(), volume: "QVolume".into() });
    document.horizons = vec![horizon("Top", "t"), horizon("Q Horizon", "h"), horizon("Base", "b")];
    document.horizons[2].origin = Origin::Share { share: 0.5, between: ["Top".into(), "Q Horizon".into()] };
    document.layer_names = vec![String::new(), String::new(), "Q Layer".into(), String::new()];
    document.faults = vec![fault("QFault", "f", None), fault("branch", "g", Some("QFault"))];
    let file = "wells/w.json".to_owned();
    let id = Id::default();
    document.wells =
        vec![WellEntry { id, name: "Q Well".into(), file, hash: "w".into(), colour: None, origin: origin() }];
    document.sticks = vec![FaultSticks { fault: "QFault".into(), sticks: Vec::new() }];
    document.textures = vec![TextureEntry {
        id: Id::default(),
        name: "qtexture".into(),
        file: "textures/x.png".into(),
        tile_mm: [1.0, 1.0],
        hash: "x".into(),
        origin: origin(),
    }];
    let raw = || RawColour::new("QVolume", white_ramp(1.0, 0.0));
    document.style.raw = Some(raw());
    document.style.layers.set(LayerStyle::textured("Q Layer", ttf::Colour::BLACK, "qtexture"));
    document.style.layers.set(LayerStyle::textured("above Top", ttf::Colour::BLACK, "qtexture"));
    document.style.scalars.push(
        toml::from_str("volume = 'QVolume'\nintervals = [{ range = [0.0, 1.0], texture = 'qtexture' }]").unwrap(),
    );
    document
        .style
        .scalars
        .push(toml::from_str("volume = 'other'\nintervals = [{ range = [0.0, 1.0], texture = 'qtexture' }]").unwrap());
    document.k.insert("Q Layer".into(), param::KDefinition::default());
    let ramp = white_ramp(1.0, 0.0);
    let scene: Scene = serde_json::from_value(serde_json::json!({
        "raw": raw(),
        "hidden_wells": ["Q Well"],
        "media": {
            "surroundings": [{ "volume": "QVolume", "function": ramp }],
            "cut_outs": [{ "volume": "QVolume", "function": ramp }],
            "isosurfaces": [{ "of": { "volume": "QVolume" }, "value": 0.5, "colour": "#000000" }],
            "horizons": [
                { "name": "Q Horizon", "colour": "#000000", "paint": { "volume": "QVolume", "function": ramp } },
            ],
        },
        "labels": [
            { "label": "QFault", "is_hidden": true },
            { "label": "Q Layer", "is_hidden": true },
            { "label": "Q Well", "is_hidden": true },
            { "label": "Q Well Top of all", "is_hidden": true },
            { "label": "legend", "is_hidden": true },
        ],
    }))
    .unwrap();
    document.scenes = ["first", "QScene"]
        .map(|name| SceneEntry { id: Id::default(), name: name.into(), scene: scene.clone() })
        .into();
    document.notes = vec![NoteEntry { text: "here".into(), at: [1.0, 1.0, 1.0], scene: Some("QScene".into()) }];
    let figure: FigureEntry = serde_json::from_value(serde_json::json!({
        "file": "page.pdf",
        "scene": "QScene",
        "hidden": ["Q Horizon", "QFault", "Q Well"],
        "labels": [{ "label": "Depth of Q Horizon (m): Q Well", "is_hidden": true }],
        "parts": [
            { "block": { "scene": scene } },
            { "section": { "kind": "inline", "at": 1.0 } },
            { "map": { "horizon": "Top", "thickness_to": "Q Horizon" } },
            { "map": { "horizon": "Q Horizon" } },
            { "correlation": { "wells": ["Q Well"], "datum": "Q Horizon" } },
        ],
    }))
    .unwrap();
    document.figures = vec![figure];
    document
}

/// The state with names, as text.
fn said(document: &Document) -> String {
    toml::to_string(document).unwrap()
}

fn count(text: &str, word: &str) -> usize {
    text.matches(word).count()
}

fn place(document: &Document, noun: Noun, name: &str) -> usize {
    document.position(noun, name).unwrap()
}

/// Renames the first of its kind in [`NAMES`].
fn rename(document: &mut Document, noun: Noun, name: &str, to: &str) {
    let at = place(document, noun, name);
    match noun {
        Noun::Layer => document.name_layer(at, to).unwrap(),
        _ => drop(document.by_ids(|document| document.name_entry(noun, at, to))),
    }
}

#[test]
fn every_kind_of_thing_is_referred_to_and_every_holder_refers() {
    let mut kinds: Vec<Noun> = Vec::new();
    let mut holders = HashSet::new();
    document().visit_references(&mut |place, name| {
        if name != "legend" && name != "Top" && name != "above Top" && name != "other" {
            assert!(NAMES.iter().any(|(noun, known)| place.nouns.contains(noun) && name.contains(known)), "{name}");
        }
        kinds.extend(place.nouns);
        // The lifetime of what it names does not matter to which of them it is.
        holders.insert(match place.holder {
            ReferenceHolder::Style => discriminant(&ReferenceHolder::Style),
            ReferenceHolder::Layer(_) => discriminant(&ReferenceHolder::Layer("")),
            ReferenceHolder::Scalars(_) => discriminant(&ReferenceHolder::Scalars("")),
            ReferenceHolder::Extraction => discriminant(&ReferenceHolder::Extraction),
            ReferenceHolder::Origin => discriminant(&ReferenceHolder::Origin),
            ReferenceHolder::Fault(_) => discriminant(&ReferenceHolder::Fault("")),
            ReferenceHolder::Sticks => discriminant(&ReferenceHolder::Sticks),
            ReferenceHolder::Scene(_) => discriminant(&ReferenceHolder::Scene("")),
            ReferenceHolder::Note(_) => discriminant(&ReferenceHolder::Note(0)),
            ReferenceHolder::Figure(_) => discriminant(&ReferenceHolder::Figure("")),
        });
        true
    });
    assert!(NAMES.iter().all(|(noun, _)| kinds.contains(noun)));
    assert_eq!(holders.len(), 10);
}

#[test]
fn after_a_rename_nothing_says_the_old_name_and_the_file_says_the_new_one_once() {
    for (noun, name) in NAMES {
        let mut document = document();
        document.resolve_ids();
        let before = count(&said(&document), name);
        assert!(before > 1, "nothing refers to the {noun}");
        let saved = document.to_text(Path::new(PATH)).unwrap();
        assert_eq!(count(&saved, name), 1, "{noun} in\n{saved}");
        rename(&mut document, noun, name, "Zzz new");
        assert_eq!(count(&said(&document), name), 0, "{noun} in\n{}", said(&document));
        assert_eq!(count(&said(&document), "Zzz new"), before, "{noun}");
        // One line changes in the file, and that is all.
        let renamed = document.to_text(Path::new(PATH)).unwrap();
        let changed = saved.lines().zip(renamed.lines()).filter(|(before, after)| before != after).count();
        assert_eq!((saved.lines().count(), changed), (renamed.lines().count(), 1), "{noun}");
        assert_eq!(Document::from_text(&renamed, Path::new(PATH)).unwrap(), document, "{noun}");
    }
}

#[test]
fn what_is_removed_is_named_nowhere_and_what_lost_it_is_said() {
    for (noun, name) in NAMES.into_iter().filter(|(noun, _)| *noun != Noun::Layer) {
        let mut document = document();
        document.resolve_ids();
        let at = place(&document, noun, name);
        let ((), lost) = document.by_ids(|document| match noun {
            Noun::Volume => drop(document.volumes.remove(at)),
            Noun::Horizon => drop(document.take_out(at)),
            Noun::Fault => drop(document.faults.remove(at)),
            Noun::Well => drop(document.wells.remove(at)),
            Noun::Texture => drop(document.textures.remove(at)),
            _ => drop(document.scenes.remove(at)),
        });
        // What candidates, a volume and a horizon were made of stays true when that is gone.
        let records = match noun {
            Noun::Volume => 2,
            Noun::Horizon => 1,
            _ => 0,
        };
        let text = said(&document).replace("Q Well Top of all", "").replace("Depth of Q Horizon (m): Q Well", "");
        assert_eq!(count(&text, name), records, "{noun} in\n{text}");
        assert!(!lost.is_empty(), "{noun}");
        assert!(document.dangling(|_| true).is_empty(), "{noun}: {:?}", document.dangling(|_| true));
        assert_eq!(
            document.to_text(Path::new(PATH)).and_then(|text| Document::from_text(&text, Path::new(PATH))).unwrap(),
            document
        );
    }
}

#[test]
fn what_nobody_has_is_told_with_who_refers_to_it() {
    let mut document = document();
    assert_eq!(document.dangling(|_| false), Vec::<String>::new());
    document.notes[0].scene = Some("gone".into());
    document.scenes[0].scene.hidden_wells.push("gone".into());
    let told = document.dangling(|_| true);
    assert_eq!(told, ["scene \"first\": there is no well \"gone\"", "note 1: there is no scene \"gone\""]);
}

#[test]
fn ids_are_given_once_and_a_copied_entry_gets_its_own() {
    let mut document = document();
    document.resolve_ids();
    let last = document.last_id;
    document.by_ids(|document| drop(document.wells.remove(0)));
    let first = document.horizons[0].clone();
    document.horizons.push(HorizonEntry { name: "copied".into(), ..first });
    document.layer_names.push(String::new());
    document.resolve_ids();
    assert_eq!(document.last_id, last + 1);
    assert_ne!(document.horizons[0].id, document.horizons[3].id);
}

#[test]
fn names_that_were_typed_into_the_file_are_understood() {
    let mut document = document();
    document.resolve_ids();
    let saved = document.to_text(Path::new(PATH)).unwrap();
    let typed =
        format!("{saved}\n[[figures]]\nfile = 'typed.png'\n[[figures.parts]]\nmap = {{ horizon = 'Q Horizon' }}\n");
    let read = Document::from_text(&typed, Path::new(PATH)).unwrap();
    assert_eq!(count(&read.to_text(Path::new(PATH)).unwrap(), "Q Horizon"), 1);
}

#[test]
fn a_later_state_is_followed_by_what_is_on_the_screen() {
    let mut before = document();
    before.resolve_ids();
    let mut after = before.clone();
    rename(&mut after, Noun::Fault, "QFault", "Main");
    rename(&mut after, Noun::Well, "Q Well", "A-1");
    let renamed = before.renamed_in(&after);
    let mut scene = before.scenes[0].scene.clone();
    renamed.follow_in(&mut scene);
    assert_eq!(scene, after.scenes[0].scene);
    let mut name = "QFault".to_owned();
    renamed.follow(Noun::Horizon, &mut name);
    assert_eq!(name, "QFault");
    renamed.follow(Noun::Fault, &mut name);
    assert_eq!(name, "Main");
}
