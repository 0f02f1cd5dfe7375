//! What to do next about an error, in the words of the window.

use files::FormatError;
use project::ProjectError;
use project::error::FaultEditError;
use std::error::Error;

/// What to do next about an error, or about what caused it; `None` where no general advice is possible.
pub(crate) fn of(error: &(dyn Error + 'static)) -> Option<String> {
    let own = error.downcast_ref::<ProjectError>().and_then(words).map(str::to_owned);
    own.or_else(|| of(error.source()?))
}

/// What to do next in the window, where general advice is possible.
fn words(error: &ProjectError) -> Option<&'static str> {
    Some(match error {
        ProjectError::NotFound { .. } => "check the path, or create a new project from SEG-Y",
        ProjectError::Malformed { .. } => {
            "undo the last edit by hand, or run `petroglyph check` on the project's folder: it says what is damaged and what can be restored"
        }
        ProjectError::Unsound { .. } => {
            "check the project: that says all that is wrong; after that it can be changed as it is"
        }
        ProjectError::DiskFull { .. } => {
            "free some space (the project's folder derived may be deleted), then try again; nothing was changed"
        }
        ProjectError::Duplicate { .. } => "choose another name, or rename or remove the present one first",
        ProjectError::Unknown { .. } => "check the spelling, and whether it was renamed or removed meanwhile",
        ProjectError::PickOutside { .. } => "click inside the survey",
        ProjectError::NoCandidate { .. } => {
            "click there, or extract again with other extrema or a larger maximum distance (Settings)"
        }
        ProjectError::NotAssembled { .. } => {
            "choose another horizon, or start one (New horizon): only horizons that were made from picks take picks"
        }
        ProjectError::NotClimbable { .. } => "take it out, and draw or track it again",
        ProjectError::ShortLine => "click at least two points along the reflection",
        ProjectError::NothingTracked { .. } => "click a strong peak or trough, or draw lines instead (Pointer: Draw)",
        ProjectError::NothingLeft { .. } => "to remove the horizon, use Remove beside its name",
        ProjectError::AlreadyPicked { .. } => "pick elsewhere, or climb higher first",
        ProjectError::NotPicked { .. } => "the picks and their places are listed under the horizon's name",
        ProjectError::UnknownPick { .. } => "the picks with their numbers are listed under the horizon's name",
        ProjectError::AtLeaf { .. } => {
            "remove the leaf with Alt and a click, or extract again with smaller leaves (Settings)"
        }
        ProjectError::OutdatedPicks { .. } => {
            "choose the horizon and use Pick again, or extract with the former settings"
        }
        ProjectError::UnfitPicks { .. } => "Pick again what fits leaves them out",
        ProjectError::NoPickFits { .. } => {
            "remove the horizon and pick it again (its picks are listed under its name), or extract with the former settings"
        }
        ProjectError::ShortStick { .. } => "click at least two points before you end a stick",
        ProjectError::NotDrawn { .. } => "choose another fault, or use Edit beside its name",
        ProjectError::FaultEdit(FaultEditError::HasSticks { .. }) => "drag their points while sticks are drawn (F)",
        ProjectError::FaultEdit(FaultEditError::CutBeside { .. }) => "click on the fault, between its ends",
        ProjectError::FaultEdit(FaultEditError::FewFaults) => "choose two faults: click one, and the other with Shift",
        ProjectError::FaultEdit(FaultEditError::SideBySide { .. }) => {
            "leave them as they are; where one is wrong, cut it and merge the part that goes on"
        }
        ProjectError::NoProposals | ProjectError::OutdatedProposals => "propose faults again",
        ProjectError::UnknownProposal { .. } => "propose faults again",
        ProjectError::NoGeometry => "add a volume first",
        ProjectError::NothingToUndo | ProjectError::NothingToRedo => {
            "another window or command may have changed the project's history"
        }
        ProjectError::NotExtracted => "extract candidates first",
        ProjectError::NoVolume => "add a volume first",
        ProjectError::Style(_) => "choose another pattern for the layer, or go back to its default style",
        ProjectError::Scene(_) => "show the whole survey without cut-outs, or another scene",
        ProjectError::Placement { .. } => "import it into a new project, or check its header bytes",
        ProjectError::SeveralInFile { .. } | ProjectError::Format(FormatError::NoSuchName { .. }) => {
            "choose one of the names that are listed"
        }
        ProjectError::Crossing { .. } => {
            "check unit, sign and picks there, or choose another contact: erosional, onlap or intrusive"
        }
        ProjectError::NotATruth { .. } => "give the folder of a synthetic survey",
        ProjectError::Figure(_) => "make the page larger, or show less on it",
        _ => return error.advice(),
    })
}
