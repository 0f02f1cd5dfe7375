//! What to do next about an error, in the words of the window.

use project::ProjectError;
use std::error::Error;

/// What to do next about an error, or about what caused it; none where that cannot be said in general.
pub fn of(error: &(dyn Error + 'static)) -> Option<String> {
    let own = error.downcast_ref::<ProjectError>().and_then(words).map(str::to_owned);
    own.or_else(|| of(error.source()?))
}

/// What to do next in the window, where that can be said in general.
fn words(error: &ProjectError) -> Option<&'static str> {
    Some(match error {
        ProjectError::NotFound { .. } => "check the path, or begin a new project from SEG-Y",
        ProjectError::NotAProject { .. } => "give the folder that holds project.toml, usually NAME.petro",
        ProjectError::Exists { .. } => "choose another name, or move the old project away first",
        ProjectError::Newer { .. } => "update Petroglyph, or ask for the project to be saved by the older version",
        ProjectError::Malformed { .. } => "undo the last edit by hand, or copy the last good state from history/",
        ProjectError::Locked { .. } => "wait until the other command has finished, then try again; nothing was changed",
        ProjectError::Link { .. } => {
            "if you trust where the project comes from, put a copy of the file or folder in the link's place; nothing was changed"
        }
        ProjectError::ReadOnly { .. } => "copy the project to a folder you may write to; nothing was changed",
        ProjectError::DiskFull { .. } => {
            "free some space (the project's folder derived may be deleted), then try again; nothing was changed"
        }
        ProjectError::Duplicate { .. } => "choose another name, or rename or remove the present one first",
        ProjectError::Unknown { .. } => "check the spelling, and whether it was renamed or removed meanwhile",
        ProjectError::PickOutside { .. } => "click inside the survey",
        ProjectError::NoCandidate { .. } => {
            "click there, or extract again and follow other extrema or with a larger reach (How)"
        }
        ProjectError::NotAssembled { .. } => {
            "choose another horizon, or begin one (New horizon): picks make horizons of their own"
        }
        ProjectError::NothingLeft { .. } => "Remove takes a horizon away",
        ProjectError::AlreadyPicked { .. } => "pick elsewhere, or climb higher first",
        ProjectError::NotPicked { .. } => "the picks and their places are listed under the horizon's name",
        ProjectError::SeveralHorizons { .. } => "make the picks of each horizon in a step of their own",
        ProjectError::UnknownPick { .. } => "the picks with their numbers are listed under the horizon's name",
        ProjectError::AtLeaf { .. } => {
            "take the leaf out with Alt and a click, or extract again with smaller leaves (How)"
        }
        ProjectError::OutdatedPicks { .. } => "choose the horizon and Pick again, or extract with the former settings",
        ProjectError::UnfitPicks { .. } => {
            "Pick again what fits leaves them out; where none fits, pick anew in another horizon"
        }
        ProjectError::ShortStick { .. } => "end a stick after its second place or later",
        ProjectError::FlatSticks { .. } => "draw sticks beside one another, along the fault's dip",
        ProjectError::NotDrawn { .. } => "choose another fault",
        ProjectError::NoEvidence => "assemble or import horizons first",
        ProjectError::NoProposals | ProjectError::OutdatedProposals => "look for faults again",
        ProjectError::UnknownProposal { .. } => "look for faults again",
        ProjectError::NoGeometry => "add a volume first",
        ProjectError::BadName { .. } => "use letters, digits, blanks, - and _",
        ProjectError::NothingToUndo | ProjectError::NothingToRedo => {
            "another window or command may have changed the project's history"
        }
        ProjectError::Cancelled(_) => "nothing was changed",
        ProjectError::NotExtracted => "extract candidates first",
        ProjectError::NoVolume => "add a volume first",
        ProjectError::OtherLattice { .. } => {
            "extract from a volume on the project's lattice, or import this one into a project of its own"
        }
        ProjectError::Geometry(_) => "check the header bytes and bounds the geometry is made from",
        ProjectError::Style(_) => "choose another pattern for the layer, or go back to its default style",
        ProjectError::Scene(_) => "show the whole survey without cut-outs, or another scene",
        ProjectError::Placement { .. } => "begin a project of its own with it, or check its header bytes",
        ProjectError::SeveralInFile { .. } => "choose one of those listed",
        ProjectError::Crossing { .. } => {
            "check unit, sign and picks there, or choose another contact: erosional, onlap or intrusive"
        }
        ProjectError::CircularTruncation { .. } => "take one of these truncations away",
        ProjectError::NotATruth { .. } => "give the folder of a synthetic survey",
        // These say what to do in their own words, or by what can be stated about the file.
        ProjectError::Io { .. }
        | ProjectError::Segy(_)
        | ProjectError::Format(_)
        | ProjectError::Well(_)
        | ProjectError::Store(_)
        | ProjectError::Synth(_)
        | ProjectError::Assembly(_)
        | ProjectError::Attribute(_)
        | ProjectError::Model(_)
        | ProjectError::Param(_)
        | ProjectError::Interp(_)
        | ProjectError::Render(_) => return None,
        ProjectError::Figure(_) => "make the page larger, or show less on it",
    })
}
