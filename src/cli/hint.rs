//! What to do next about an error, in the words of the command line.

use project::ProjectError;
use std::error::Error;

/// What to do next about an error, or about what caused it; none where that cannot be said in general.
pub(super) fn of(error: &(dyn Error + 'static)) -> Option<String> {
    let own = error.downcast_ref::<ProjectError>().and_then(words).map(str::to_owned);
    own.or_else(|| of(error.source()?))
}

/// What to do next on the command line, where that can be said in general.
fn words(error: &ProjectError) -> Option<&'static str> {
    Some(match error {
        ProjectError::NotFound { .. } => {
            "check the path, or make a project with `petroglyph import SURVEY.sgy PROJECT` or `petroglyph create`"
        }
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
            "free some space (derived/ may be deleted, `petroglyph prune` forgets undone data), then try again; nothing was changed"
        }
        ProjectError::Duplicate { .. } => "choose another --name, or rename or remove the present one first",
        ProjectError::Unknown { .. } => "check the spelling; names are listed by `petroglyph info PROJECT`",
        ProjectError::PickOutside { .. } => {
            "give INLINE,CROSSLINE,Z as line numbers and in the project's vertical unit"
        }
        ProjectError::NoCandidate { .. } => "pick there, or extract with another --extrema or a larger --max-distance",
        ProjectError::NotAssembled { .. } => "choose another --horizon; picks make horizons of their own",
        ProjectError::NothingLeft { .. } => "`petroglyph horizon remove` takes a horizon away",
        ProjectError::AlreadyPicked { .. } => "pick elsewhere, or climb higher with --up",
        ProjectError::NotPicked { .. } => "`petroglyph horizon show` lists the picks and their places",
        ProjectError::SeveralHorizons { .. } => "make the picks of each horizon in a step of their own",
        ProjectError::UnknownPick { .. } => "`petroglyph horizon show PROJECT NAME` lists the picks with their numbers",
        ProjectError::AtLeaf { .. } => {
            "take the leaf out with `petroglyph pick --remove`, or extract with smaller leaves"
        }
        ProjectError::OutdatedPicks { .. } => {
            "`petroglyph horizon replay` makes them again, or extract with the former settings"
        }
        ProjectError::UnfitPicks { .. } => "`petroglyph horizon replay --drop-unfit` takes them out; then pick anew",
        ProjectError::ShortStick { .. } => "write a stick as --stick IL,XL,Z IL,XL,Z …",
        ProjectError::FlatSticks { .. } => "draw sticks beside one another, along the fault's dip",
        ProjectError::NotDrawn { .. } => "choose another --name",
        ProjectError::NoEvidence => "assemble or import horizons first",
        ProjectError::NoProposals | ProjectError::OutdatedProposals => "run `petroglyph fault propose PROJECT`",
        ProjectError::UnknownProposal { .. } => "`petroglyph fault propose PROJECT` lists them",
        ProjectError::NoGeometry => "import a volume, or create the project with --bounds and --size",
        ProjectError::BadName { .. } => "use letters, digits, blanks, - and _",
        ProjectError::NothingToUndo | ProjectError::NothingToRedo => "`petroglyph info PROJECT` shows the history",
        ProjectError::Cancelled(_) => "nothing was changed",
        ProjectError::NotExtracted => "run `petroglyph extract PROJECT` first",
        ProjectError::NoVolume => "import one with `petroglyph import SURVEY.sgy PROJECT`",
        ProjectError::OtherLattice { .. } => {
            "extract from a volume on the project's lattice, or import this one into a project of its own"
        }
        ProjectError::Geometry(_) => "check the header bytes and bounds the geometry is made from",
        ProjectError::Style(_) => "`petroglyph patterns OUT.png` draws every pattern with its name",
        ProjectError::Scene(_) => {
            "`petroglyph scene show` prints a scene; `petroglyph render --help` lists what can be set"
        }
        ProjectError::Placement { .. } => {
            "import it into a project of its own, or check its header bytes with `petroglyph info FILE`"
        }
        ProjectError::SeveralInFile { .. } => "choose one with --select NAME",
        ProjectError::Crossing { .. } => {
            "check unit, sign and picks there, put it elsewhere with --above or --below, or say --contact erosional, onlap or intrusive"
        }
        ProjectError::CircularTruncation { .. } => "take one of these truncations away",
        ProjectError::NotATruth { .. } => "give the folder that `petroglyph synth` wrote",
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
        ProjectError::Figure(_) => {
            "`petroglyph render --help` lists what a figure can show; `petroglyph info PROJECT` its lines and horizons"
        }
    })
}
