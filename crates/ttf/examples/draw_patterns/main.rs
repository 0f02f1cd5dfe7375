//! Draws the built-in lithology patterns: `cargo run -p petroglyph-ttf --example draw_patterns textures`.
//!
//! Numbers and names follow section 37 of the FGDC Digital Cartographic Standard (FGDC-STD-013-2006); the
//! geometry is our own. Each pattern is a tile of ink ([`tile::Tile`]) that wraps around, at printed size in
//! points. Its random numbers start from a fixed seed, so every run writes the same bytes.

mod chemical;
mod clastic;
mod crystalline;
mod tile;

use std::path::PathBuf;

use tile::Tile;

/// Draws a pattern.
type Draw = fn() -> Tile;

/// File name without extension, and the drawing.
const PATTERNS: &[(&str, Draw)] = &[
    ("plain", || Tile::new(60.0)),
    ("conglomerate", clastic::conglomerate),
    ("gravel", clastic::gravel),
    ("breccia", clastic::breccia),
    ("breccia-packed", clastic::breccia_packed),
    ("sand", clastic::sand),
    ("sandstone-bedded", clastic::sandstone_bedded),
    ("sandstone-crossbedded", clastic::sandstone_crossbedded),
    ("sandstone-crossbedded-planar", clastic::sandstone_crossbedded_planar),
    ("sandstone-rippled", clastic::sandstone_rippled),
    ("sandstone-shaly", clastic::sandstone_shaly),
    ("siltstone", clastic::siltstone),
    ("shale-sandy", chemical::shale_sandy),
    ("shale", chemical::shale),
    ("marl", chemical::marl),
    ("carbonaceous-shale", chemical::shale_carbonaceous),
    ("oil-shale", chemical::oil_shale),
    ("chalk", chemical::chalk),
    ("limestone", chemical::limestone),
    ("limestone-oolitic", chemical::limestone_oolitic),
    ("limestone-sandy", chemical::limestone_sandy),
    ("limestone-shaly", chemical::limestone_shaly),
    ("limestone-cherty", chemical::limestone_cherty),
    ("limestone-dolomitic", chemical::limestone_dolomitic),
    ("dolostone", chemical::dolostone),
    ("chert", chemical::chert),
    ("peat", chemical::peat),
    ("coal", chemical::coal),
    ("gypsum", chemical::gypsum),
    ("salt", chemical::salt),
    ("sandstone-shale", clastic::sandstone_shale),
    ("limestone-shale", chemical::limestone_shale),
    ("till", clastic::till),
    ("slate", crystalline::slate),
    ("schist", crystalline::schist),
    ("gneiss", crystalline::gneiss),
    ("serpentinite", crystalline::serpentinite),
    ("tuff", crystalline::tuff),
    ("volcanic-breccia", crystalline::volcanic_breccia),
    ("basalt", crystalline::basalt),
    ("granite-crosses", crystalline::granite_crosses),
    ("granite", crystalline::granite),
    ("porphyry", crystalline::porphyry),
    ("water", chemical::water),
];

fn main() -> std::io::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "textures".to_owned()));
    std::fs::create_dir_all(&folder)?;
    for (name, draw) in PATTERNS {
        std::fs::write(folder.join(format!("{name}.svg")), draw().to_svg())?;
    }
    println!("{} patterns written to {}", PATTERNS.len(), folder.display());
    Ok(())
}
