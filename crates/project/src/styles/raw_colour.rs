//! Default colours of raw data for a project's volumes.

use crate::document::Document;
use crate::error::{Noun, ProjectError};
use ttf::{ColourMap, RawColour, RgbaFunction, TransferFunctions};

/// A volume of the project in the colours of a map: over `range`, or centred on zero and clipped at the value that 99 %
/// of the samples do not exceed. Without a name it is the volume shown at present, otherwise the first.
///
/// # Errors
/// There is no such volume.
pub fn raw_colour(
    document: &Document,
    volume: Option<&str>,
    map: ColourMap,
    range: Option<[f32; 2]>,
) -> Result<RawColour, ProjectError> {
    let present = document.style.raw.as_ref().map(|raw| raw.volume.as_str());
    let first = document.volumes.first().map(|entry| entry.name.as_str());
    let name = volume.or(present).or(first).unwrap_or_default();
    let entry = &document.volumes[document.position(Noun::Volume, name)?];
    let function = match range {
        Some(domain) => RgbaFunction::over(map, domain),
        None if entry.lowest >= 0.0 => RgbaFunction::over(map, [entry.lowest, entry.clip]),
        None => RgbaFunction::centred(map, entry.clip),
    };
    Ok(RawColour::new(&entry.name, function))
}

/// The project's transfer functions, with colours for the first volume where none are set.
pub fn transfer_functions(document: &Document) -> TransferFunctions {
    let mut functions = document.style.functions();
    if functions.raw.is_none() {
        functions.raw = raw_colour(document, None, ColourMap::Seismics, None).ok();
    }
    functions.faults = document.faults.iter().map(|entry| entry.colour).collect();
    functions
}
