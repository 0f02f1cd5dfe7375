//! A vertical section of a history as a picture: `section FILE OUT.png [--map] [--at SHARE] [--stage PROGRESS]`.
//!
//! West to east through the middle of the block, or the map of its ground. One colour for each rock, with thin lines at
//! fifths of each bed so that one sees how the beds run.

use glam::DVec3;
use history::{History, Place};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| args.iter().position(|arg| arg == name).and_then(|n| args.get(n + 1)).cloned();
    let [file, out] = [0, 1].map(|n| args.get(n).cloned().unwrap_or_default());
    let history = History::from_toml(&std::fs::read_to_string(&file)?)?;
    history.notes().iter().for_each(|note| eprintln!("{note}"));
    let progress = option("--stage").map_or(Ok(history.events().len() as f64), |text| text.parse())?;
    let share: f64 = option("--at").map_or(Ok(0.5), |text| text.parse())?;
    let is_map = args.iter().any(|arg| arg == "--map");
    let stage = history.stage(progress);
    let size = history.size();
    let width = 1200u32;
    let height = (f64::from(width) * if is_map { size.y } else { size.z } / size.x) as u32;
    let picture = image::RgbImage::from_fn(width, height, |x, y| {
        let (u, v) = ((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
        let p = if is_map {
            let map = DVec3::new(u * size.x, (1.0 - v) * size.y, 0.0);
            map.with_z(stage.ground(map.truncate()).unwrap_or(0.0) + 0.01)
        } else {
            DVec3::new(u * size.x, share * size.y, v * size.z)
        };
        image::Rgb(colour(&history, &stage.place(p)))
    });
    picture.save(&out)?;
    Ok(())
}

fn colour(history: &History, place: &Place) -> [u8; 3] {
    let rock = match place {
        Place::Air => return [255; 3],
        Place::Water => return [196, 224, 240],
        Place::Rock(rock) => rock,
    };
    let unit = &history.units()[place.seen().unwrap_or(rock.unit)];
    let known: [(&str, [u8; 3]); 14] = [
        ("sandstone", [240, 214, 130]),
        ("shale", [140, 140, 128]),
        ("limestone", [120, 176, 214]),
        ("granite", [226, 150, 140]),
        ("marl", [168, 196, 150]),
        ("chalk", [222, 232, 214]),
        ("basalt", [74, 84, 74]),
        ("salt", [236, 190, 220]),
        ("dolerite", [84, 96, 84]),
        ("conglomerate", [214, 160, 90]),
        ("dolostone", [130, 140, 200]),
        ("hornfels", [150, 100, 120]),
        ("gneiss", [206, 170, 180]),
        ("siltstone", [190, 180, 150]),
    ];
    let found = known.iter().find(|(word, _)| unit.rock.contains(word));
    let base = found.map_or_else(
        || {
            let hash = unit.name.bytes().fold(7u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
            [120 + (hash % 110) as u8, 120 + (hash / 7 % 110) as u8, 120 + (hash / 77 % 110) as u8]
        },
        |(_, colour)| *colour,
    );
    let is_line = unit.bed.is_some() && (rock.ijk.z * 5.0).rem_euclid(1.0) < 0.1;
    base.map(|channel| if is_line { (f64::from(channel) * 0.82) as u8 } else { channel })
}
