//! What the block shows while interpreting: the view's own scene in raw colours, or seen through in the occlusion slicer (P-horiz 6).

use super::picking::Look;
use super::{Panel, Session};
use crate::scene::{SeeThrough, Technique};
use render::{FaceData, Scene, Scope};

/// Values up to this share of the volume's clip are clear in the white function: what is left are the strong reflections.
const CLEAR_BELOW: f32 = 0.35;

/// The scene that the block view draws.
pub fn scene(session: &Session) -> Scene {
    let view = &session.view;
    let mut scene = view.scene.clone();
    if view.panel != Panel::Interpret {
        return scene;
    }
    scene.blend = 1.0;
    scene.ground = None;
    scene.media = render::Media::default();
    scene.face_data = view.picking.show;
    if view.picking.look == Look::SeeThrough {
        scene.face_data = FaceData::Rock;
        let see = SeeThrough {
            technique: Some(Technique::Occlusion),
            medium: None,
            clear_below: CLEAR_BELOW,
            horizons: Vec::new(),
            scope: Scope::Everywhere,
        };
        // A project without a volume shows its faces.
        if see.change(&mut scene, &session.document).is_err() {
            scene.media = render::Media::default();
        }
    }
    scene
}
