//! Draws the sheet of patterns for the documentation, at 110 dots an inch, and sets the tiles of the standard beside
//! ours where a folder of them is given:
//! `cargo run -p ttf --example pattern_sheet SHEET.png [TILES_FOLDER]`.
//!
//! The folder holds an SVG for each number of section 37 (`601.svg`), whose width and height are printed points.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;

use image::imageops::{FilterType, resize};
use ttf::{TextureLibrary, TileBeside, contact_sheet_beside};

/// Millimetres of a printed point.
const MM_OF_POINT: f32 = 25.4 / 72.0;

/// The number in an attribute of the root element, such as `width="54.125"`.
fn attribute(svg: &str, name: &str) -> Option<f32> {
    let root = &svg[svg.find("<svg")?..];
    let start = root.find(&format!(" {name}=\""))? + name.len() + 3;
    root[start..].split('"').next()?.trim_end_matches(|c: char| c.is_alphabetic()).parse().ok()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).map(PathBuf::from);
    let out = arguments.next().ok_or("give the picture to write")?;
    let folder = arguments.next();
    let library = TextureLibrary::builtin()?;
    let mut tiles = TextureLibrary::builtin()?;
    let mut beside: BTreeMap<u16, TileBeside> = BTreeMap::new();
    let numbers = library.patterns().filter_map(|pattern| pattern.fgdc);
    for (number, folder) in numbers.zip(folder.iter().cycle()) {
        let path = folder.join(format!("{number}.svg"));
        if !path.exists() {
            println!("the folder has no tile {number}");
            continue;
        }
        let svg = std::fs::read_to_string(&path)?;
        let index = tiles.add_user(&path)?;
        let size = ["width", "height"].map(|name| attribute(&svg, name).map(|points| points * MM_OF_POINT));
        let [Some(width), Some(height)] = size else {
            return Err(format!("{} does not say how large it is", path.display()).into());
        };
        beside.insert(number, (tiles.texture(index)?, [width, height]));
    }
    let sheet = contact_sheet_beside(&library, &beside)?;
    let half = resize(&sheet, sheet.width() / 2, sheet.height() / 2, FilterType::Triangle);
    image::DynamicImage::ImageRgba8(half).to_rgb8().save(&out)?;
    println!("{} of our patterns beside {} tiles in {}", library.len(), beside.len(), out.display());
    Ok(())
}
