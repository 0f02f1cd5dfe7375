//! Sentences of version 1, each as the program of that version wrote it.

use super::*;
use crate::document::{Refinement, Uninterpreted};

/// The only entry of a document of version 1, as the present version has it.
fn migrated(kind: &str, path: &str, reading: &str, more: &str) -> Table {
    let text = format!(
        "version = 1\n[[{kind}]]\nname = \"it\"\nfile = \"{kind}/it.zarr\"\n{more}\n\
         [{kind}.source]\npath = \"{path}\"\nbytes = 7\nreading = \"{reading}\"\n"
    );
    let mut document: Table = toml::from_str(&text).unwrap();
    from_version_1(&mut document, Path::new("nowhere.petro")).unwrap();
    assert_eq!(document["version"].as_integer(), Some(2));
    let entry = document[kind][0].as_table().unwrap().clone();
    assert!(!entry.contains_key("source") && !entry.contains_key("seeds"), "{entry}");
    entry
}

fn origin(entry: &Table) -> Origin {
    Origin::deserialize(entry["origin"].clone()).unwrap()
}

fn of(kind: &str, path: &str, reading: &str) -> Origin {
    origin(&migrated(kind, path, reading, ""))
}

#[test]
fn volumes_say_how_they_came_to_be_and_what_they_measure() {
    let time = migrated("volumes", "volumes/seismic.zarr", "geologic time of the volume north", "");
    assert_eq!(origin(&time), Origin::GeologicTime { of: "north".into() });
    assert_eq!(time["quantity"].as_str(), Some("geologic time"));
    let envelope = of("volumes", "volumes/seismic.zarr", "envelope of the volume north");
    assert_eq!(envelope, Origin::Attribute { attribute: AttributeKind::Envelope, of: "north".into() });
    let linked = of("volumes", "s3://bucket/a.zarr", "linked: its bricks are read where they lie");
    assert_eq!(linked, Origin::Linked { url: "s3://bucket/a.zarr".into() });
    let imported = of("volumes", "a.sgy", "SEG-Y format code 5, vertical in m");
    let reading = "SEG-Y format code 5, vertical in m".to_owned();
    assert_eq!(imported, Origin::Imported { path: "a.sgy".into(), bytes: 7, reading });
}

#[test]
fn horizons_say_who_made_them_and_what_was_done_to_them_since() {
    let filled = migrated("horizons", "a.csv", "csv, vertical in m, positive down; holes filled; smoothed", "");
    let reading = "csv, vertical in m, positive down".to_owned();
    assert_eq!(origin(&filled), Origin::Imported { path: "a.csv".into(), bytes: 7, reading });
    let refined = Vec::<Refinement>::deserialize(filled["refined"].clone()).unwrap();
    assert_eq!(refined, [Refinement::Filled, Refinement::Smoothed]);
    let seeds = "seeds = [[101.0, 501.0, 30.5]]";
    let clicked =
        migrated("horizons", "volumes/time.zarr", "geologic time through inline 101, crossline 501, 30.5", seeds);
    assert_eq!(origin(&clicked), Origin::ByTime { seeds: vec![[101.0, 501.0, 30.5]], queries: Vec::new() });
    let level = of("horizons", "volumes/time.zarr", "geologic time 23.5");
    assert_eq!(level, Origin::Level { time: 23.5, chosen_by: Chooser::Program });
    let share = of("horizons", "Top to Base", "25.0 % of the thickness from Top to Base to Base");
    assert_eq!(share, Origin::Share { share: 0.25, between: ["Top to Base".into(), "Base".into()] });
    let log = |picks: &str| {
        origin(&migrated("horizons", "picks", "assembled by 1 pick", &format!("assembly = {{ picks = {picks} }}")))
    };
    assert_eq!((log("[1]"), log("[]")), (Origin::Picked, Origin::Drawn));
}

#[test]
fn faults_and_coordinates_of_layers_say_how_they_were_made() {
    assert_eq!(of("faults", "picks", "drawn with 4 sticks"), Origin::Drawn);
    let ends = of("faults", "proposal", "proposed from reflections that end at it");
    assert_eq!(ends, Origin::Proposed { horizons: Vec::new() });
    let offsets = of("faults", "proposal", "proposed from the offsets of Top, Base");
    assert_eq!(offsets, Origin::Proposed { horizons: vec!["Top".into(), "Base".into()] });
    let text = "version = 1\n[[volumes]]\nname = \"tau\"\nfile = \"volumes/time-2.zarr\"\n[parameterization]\n\
                [parameterization.source]\npath = \"volumes/time-2.zarr\"\nbytes = 7\nreading = \"k by geologic time at 4 x 4 x 4\"\n";
    let mut document: Table = toml::from_str(text).unwrap();
    from_version_1(&mut document, Path::new("nowhere.petro")).unwrap();
    let origin = Origin::deserialize(document["parameterization"]["origin"].clone()).unwrap();
    assert_eq!(origin, Origin::TimeFraction { of: "tau".into() });
}

#[test]
fn one_horizon_that_a_person_chose_is_an_interpretation() {
    let document = |readings: &[(&str, &str)]| {
        let geometry = survey::SurveyGeometry::regular([4, 4, 4], 25.0, 4.0, survey::VerticalUnit::Metres);
        let mut text =
            Document::empty(Some(geometry)).to_text(Path::new("")).unwrap().replace("version = 2", "version = 1");
        for (n, (reading, more)) in readings.iter().enumerate() {
            text += &format!(
                "\n[[horizons]]\nname = \"{n}\"\nfile = \"horizons/{n}.zarr\"\nhash = \"\"\n{more}\n\
                 [horizons.source]\npath = \"volumes/time.zarr\"\nbytes = 0\nreading = \"{reading}\"\n"
            );
        }
        Document::from_text(&text, Path::new("project.toml")).unwrap()
    };
    let (level, click) =
        (("geologic time 2", ""), ("geologic time through inline 1, crossline 1, 8", "seeds = [[1.0, 1.0, 8.0]]"));
    assert_eq!(document(&[]).uninterpreted(), Some(Uninterpreted::RawData));
    assert_eq!(document(&[level, level]).uninterpreted(), Some(Uninterpreted::ComputedLevels));
    assert_eq!(document(&[level, click]).uninterpreted(), None);
    assert_eq!(document(&[click]).uninterpreted(), None);
}
