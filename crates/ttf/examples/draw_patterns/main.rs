//! Draws the built-in lithology patterns: `cargo run -p ttf --example draw_patterns textures`.
//!
//! Numbers and names follow section 37 of the FGDC Digital Cartographic Standard (FGDC-STD-013-2006); the
//! geometry is our own. Each pattern is a tile of ink ([`tile::Tile`]) that wraps around, at printed size in
//! points. Its random numbers start from a fixed seed, so every run writes the same bytes.

mod bricks;
mod chemical;
mod clastic;
mod crystalline;
mod folds;
mod igneous;
mod signs;
mod tile;
mod troughs;

use std::path::PathBuf;

use tile::Tile;

/// Draws a pattern.
type Draw = fn() -> Tile;

/// File name without extension, and the drawing.
const PATTERNS: &[(&str, Draw)] = &[
    ("conglomerate", clastic::conglomerate),
    ("gravel", clastic::gravel),
    ("conglomerate-crossbedded", troughs::conglomerate_crossbedded),
    ("breccia", clastic::breccia),
    ("breccia-packed", clastic::breccia_packed),
    ("sand", clastic::sand),
    ("sandstone-bedded", clastic::sandstone_bedded),
    ("sandstone-crossbedded", troughs::sandstone_crossbedded),
    ("sandstone-crossbedded-planar", clastic::sandstone_crossbedded_planar),
    ("sandstone-rippled", clastic::sandstone_rippled),
    ("sandstone-shaly", clastic::sandstone_shaly),
    ("sandstone-calcareous", signs::sandstone_calcareous),
    ("sandstone-dolomitic", signs::sandstone_dolomitic),
    ("siltstone", clastic::siltstone),
    ("siltstone-calcareous", signs::siltstone_calcareous),
    ("siltstone-dolomitic", signs::siltstone_dolomitic),
    ("shale-sandy", chemical::shale_sandy),
    ("shale", chemical::shale),
    ("shale-cherty", bricks::shale_cherty),
    ("shale-dolomitic", bricks::shale_dolomitic),
    ("marl", chemical::marl),
    ("carbonaceous-shale", chemical::shale_carbonaceous),
    ("oil-shale", chemical::oil_shale),
    ("chalk", chemical::chalk),
    ("limestone", chemical::limestone),
    ("limestone-clastic", bricks::limestone_clastic),
    ("limestone-fossiliferous", bricks::limestone_fossiliferous),
    ("limestone-nodular", bricks::limestone_nodular),
    ("limestone-crossbedded", troughs::limestone_crossbedded),
    ("limestone-oolitic", chemical::limestone_oolitic),
    ("limestone-sandy", chemical::limestone_sandy),
    ("limestone-silty", bricks::limestone_silty),
    ("limestone-shaly", chemical::limestone_shaly),
    ("limestone-cherty", chemical::limestone_cherty),
    ("limestone-dolomitic", chemical::limestone_dolomitic),
    ("dolostone", chemical::dolostone),
    ("dolostone-crossbedded", troughs::dolostone_crossbedded),
    ("dolostone-oolitic", bricks::dolostone_oolitic),
    ("dolostone-sandy", bricks::dolostone_sandy),
    ("dolostone-silty", bricks::dolostone_silty),
    ("dolostone-shaly", bricks::dolostone_shaly),
    ("dolostone-cherty", bricks::dolostone_cherty),
    ("chert", chemical::chert),
    ("chert-fossiliferous", signs::chert_fossiliferous),
    ("fossiliferous", signs::fossiliferous),
    ("diatomite", signs::diatomite),
    ("graywacke", signs::graywacke),
    ("peat", chemical::peat),
    ("coal", chemical::coal),
    ("coal-bony", signs::coal_bony),
    ("underclay", signs::underclay),
    ("flint-clay", signs::flint_clay),
    ("bentonite", signs::bentonite),
    ("glauconite", signs::glauconite),
    ("limonite", signs::limonite),
    ("siderite", signs::siderite),
    ("phosphorite", signs::phosphorite),
    ("gypsum", chemical::gypsum),
    ("salt", chemical::salt),
    ("sandstone-siltstone", signs::sandstone_siltstone),
    ("sandstone-shale", clastic::sandstone_shale),
    ("sandstone-shale-rippled", signs::sandstone_shale_rippled),
    ("shale-limestone-beds", bricks::shale_limestone),
    ("limestone-shale", chemical::limestone_shale),
    ("limestone-shale-partings", bricks::limestone_shale_partings),
    ("limestone-marl", bricks::limestone_marl),
    ("till", clastic::till),
    ("loess", signs::loess),
    ("quartzite", folds::quartzite),
    ("slate", crystalline::slate),
    ("granite-schistose", folds::granite_schistose),
    ("schist", crystalline::schist),
    ("schist-contorted", folds::schist_contorted),
    ("schist-gneiss", folds::schist_gneiss),
    ("gneiss", crystalline::gneiss),
    ("gneiss-contorted", folds::gneiss_contorted),
    ("serpentinite", crystalline::serpentinite),
    ("tuff", crystalline::tuff),
    ("tuff-crystal", igneous::tuff_crystal),
    ("tuff-devitrified", igneous::tuff_devitrified),
    ("volcanic-breccia", crystalline::volcanic_breccia),
    ("agglomerate", igneous::agglomerate),
    ("zeolitic", igneous::zeolitic),
    ("basalt", crystalline::basalt),
    ("granite-crosses", crystalline::granite_crosses),
    ("granite", crystalline::granite),
    ("banded-igneous", igneous::banded),
    ("igneous", igneous::igneous),
    ("rhyolite", igneous::rhyolite),
    ("dacite", igneous::dacite),
    ("andesite", igneous::andesite),
    ("diorite", igneous::diorite),
    ("syenite", igneous::syenite),
    ("gabbro", igneous::gabbro),
    ("peridotite", igneous::peridotite),
    ("porphyry", crystalline::porphyry),
    ("vitrophyre", igneous::vitrophyre),
    ("quartz", igneous::quartz),
    ("ore", signs::ore),
    ("water", chemical::water),
    ("plain", || Tile::new(60.0)),
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
