//! What the window holds of the open project. Where a project is opened or closed, all of it is replaced.

use super::follow::Needs;
use crate::hold::Hold;
use crate::views::{
    block::BlockView, controls::Controls, data::Data, fence::FenceView, functions::Functions,
    interpretation::Interpretation, layers::Layers, map::MapView, overlay::Overlay, patterns::Patterns,
    picking::PickingPanel, pointer::Pointed, present::Presentation, sections::Sections, share::ShareView, tiles::Tiles,
    well::WellDialogue,
};
use crate::widgets::page::PagePreview;
use crate::work::{Rocks, Wanted};
use state::ExportForm;
use state::picking::Pick;

/// A selection and the horizon that it is for, with the number of the interpretation that it was requested for.
type Inbox = (Option<(Pick, Option<String>)>, u64);

/// The views of a project, with what was loaded and requested for them.
#[derive(Default)]
pub(super) struct ProjectViews {
    /// The lock that shows other windows that this one has the project open.
    pub(super) hold: Option<Hold>,
    pub(super) block: BlockView,
    pub(super) sections: Sections,
    pub(super) fence: FenceView,
    pub(super) map: MapView,
    pub(super) layers: Layers,
    pub(super) data: Data,
    pub(super) functions: Functions,
    pub(super) patterns: Patterns,
    pub(super) interpretation: Interpretation,
    pub(super) well: WellDialogue,
    pub(super) picking: PickingPanel,
    pub(super) overlay: Overlay,
    /// The revision of the project whose interpretation was requested last.
    pub(super) followed: Option<u64>,
    /// The selection that was requested last, and the interpretation that it was requested for.
    pub(super) selected: Option<Inbox>,
    pub(super) tiles: Tiles,
    pub(super) controls: Controls,
    pub(super) preview: PagePreview,
    /// What the page that is shown was laid out for.
    pub(super) previewed: Option<ExportForm>,
    pub(super) share: ShareView,
    pub(super) presentation: Presentation,
    pub(super) pointed: Option<Pointed>,
    pub(super) rocks: Option<Rocks>,
    pub(super) needs: Option<Needs>,
    pub(super) wanted: Option<Wanted>,
    /// The selection and the sticks when the view was last saved.
    pub(super) unsaved: Option<(Option<Pick>, usize, usize)>,
}
