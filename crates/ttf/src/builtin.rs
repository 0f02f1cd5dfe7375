//! The drawings and the catalogue that are compiled into the program.

/// The catalogue's text.
pub(crate) const CATALOGUE: &str = include_str!("../../../textures/catalogue.toml");

macro_rules! drawings {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../textures/", $name, ".svg")))),*]
    };
}

/// Names and SVG sources of all drawings in `textures/`.
pub(crate) const DRAWINGS: &[(&str, &str)] = drawings![
    "conglomerate",
    "gravel",
    "breccia",
    "breccia-packed",
    "sand",
    "sandstone-bedded",
    "sandstone-crossbedded",
    "sandstone-crossbedded-planar",
    "sandstone-rippled",
    "sandstone-shaly",
    "siltstone",
    "shale-sandy",
    "shale",
    "marl",
    "carbonaceous-shale",
    "oil-shale",
    "chalk",
    "limestone",
    "limestone-oolitic",
    "limestone-sandy",
    "limestone-shaly",
    "limestone-cherty",
    "limestone-dolomitic",
    "dolostone",
    "chert",
    "peat",
    "coal",
    "gypsum",
    "salt",
    "sandstone-shale",
    "limestone-shale",
    "till",
    "slate",
    "schist",
    "gneiss",
    "serpentinite",
    "tuff",
    "volcanic-breccia",
    "basalt",
    "granite-crosses",
    "granite",
    "porphyry",
    "water",
    "plain",
];
