//! What the block shows while interpreting: the view's own scene in raw colours, or volume rendering with occlusion
//! (P-horiz 6).

use super::picking::Look;
use super::{Panel, Session};
use project::pictures::scene::{Technique, VolumeRendering};
use render::{FaceData, Media, PickedHorizon, Scene, Scope};
use ttf::Colour;

/// Values up to this share of the volume's clip are transparent in the white function, so that only strong reflections
/// remain.
const CLEAR_BELOW: f32 = 0.35;
/// Half of a horizon's thickness in volume rendering, voxels.
const THICKNESS: f32 = 1.2;

/// The scene that the block view draws; `horizons` are those to show in it, by their colours and leaves, or `None`
/// while no candidates are in memory.
pub fn scene(session: &Session, horizons: Option<&[(Colour, Vec<u32>)]>) -> Scene {
    let view = &session.view;
    let mut scene = view.scene.clone();
    if view.panel != Panel::Interpret {
        return scene;
    }
    scene.blend = 1.0;
    scene.ground = None;
    scene.media = Media::default();
    scene.face_data = if horizons.is_some() { view.picking.show } else { FaceData::Rock };
    if view.picking.look == Look::VolumeRendering {
        scene.face_data = FaceData::Rock;
        let options = VolumeRendering {
            technique: Some(Technique::Occlusion),
            medium: None,
            clear_below: CLEAR_BELOW,
            isosurfaces: Vec::new(),
            horizons: Vec::new(),
            scope: Scope::Everywhere,
        };
        // A project without a volume shows its faces.
        if options.change(&mut scene, &session.document).is_err() {
            scene.media = Media::default();
            return scene;
        }
        let picked = horizons.into_iter().flatten().filter(|(_, leaves)| !leaves.is_empty());
        scene.media.horizons = picked
            .map(|(colour, leaves)| PickedHorizon {
                thickness: THICKNESS,
                ..PickedHorizon::of(leaves.clone(), *colour)
            })
            .collect();
    }
    scene
}
