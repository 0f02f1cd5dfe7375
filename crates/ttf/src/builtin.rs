//! The drawings and the catalogue that are compiled into the program.

/// The catalogue's text.
pub(crate) const CATALOGUE: &str = include_str!("../../../textures/catalogue.toml");

macro_rules! drawings {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../textures/", $name, ".svg")))),*]
    };
}

/// Names and SVG sources of all drawings in `textures/`.
pub(crate) const DRAWINGS: &[(&str, &str)] = drawings!["plain",];
