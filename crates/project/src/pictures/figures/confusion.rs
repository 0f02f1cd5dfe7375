//! Layers of a picture that are neighbours and cannot be told apart, by name.

use crate::error::ProjectError;
use crate::pictures::load::Rock;
use render::{FaceData, Faces, Scene};
use serde::Serialize;
use ttf::{Confusion, LayerStyle, TextureLibrary, Vision};

/// Two layers that are neighbours and cannot be told apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NamedConfusion {
    /// Their names, the younger first.
    pub layers: [String; 2],
    /// The layer to change, where a change was found that is enough.
    pub change: Option<String>,
    /// Under what, and the change.
    pub confusion: Confusion,
}

/// The layers that touch in the block or follow one another in the column and cannot be told apart by a colour-blind
/// reader, in greyscale or photocopied; none where the scene shows no patterns. `layers` are the styles of all, youngest
/// first.
///
/// # Errors
/// The patterns of the project cannot be read.
pub fn confusions(
    rock: Option<&Rock>,
    layers: &[LayerStyle],
    library: &TextureLibrary,
    scene: &Scene,
) -> Result<Vec<NamedConfusion>, ProjectError> {
    let is_illustrated = scene.blend < 1.0 && scene.face_data == FaceData::Rock && scene.media.faces != Faces::None;
    let Some(rock) = rock.filter(|_| is_illustrated) else { return Ok(Vec::new()) };
    let found = ttf::confusions(layers, &rock.neighbours(scene), scene.preset, library)?;
    let name = |position: usize| layers[position].layer.clone();
    let named = found.into_iter().map(|confusion| NamedConfusion {
        layers: confusion.layers.map(name),
        change: confusion.remedy.as_ref().map(|remedy| name(remedy.layer)),
        confusion,
    });
    Ok(named.collect())
}

impl std::fmt::Display for NamedConfusion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [upper, lower] = &self.layers;
        write!(f, "{upper} and {lower} are neighbours and cannot be told apart ")?;
        match &self.confusion.under[..] {
            under if under.len() == Vision::ALL.len() => f.write_str("by any reader or in any print"),
            under => f.write_str(&under.iter().map(|vision| vision.phrase()).collect::<Vec<_>>().join(", ")),
        }
    }
}
