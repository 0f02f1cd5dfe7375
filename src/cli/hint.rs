//! What to do next about an error, in the words of the command line.

use files::FormatError;
use param::ParamError;
use project::ProjectError;
use std::error::Error;
use std::io::ErrorKind;
use ttf::TtfError;

/// What to do next about an error, or about what caused it; `None` where no general advice is possible.
pub(super) fn of(error: &(dyn Error + 'static)) -> Option<String> {
    let own = error.downcast_ref::<ProjectError>().and_then(words).map(str::to_owned);
    own.or_else(|| of(error.source()?))
}

/// What to do next about an answer of the file system.
pub(super) fn of_files(error: &(dyn Error + 'static)) -> Option<&'static str> {
    Some(match error.downcast_ref::<std::io::Error>()?.kind() {
        ErrorKind::NotFound => "check the path: there is no such file or folder",
        ErrorKind::PermissionDenied => "choose a place where you may read and write, or change its permissions",
        ErrorKind::ReadOnlyFilesystem => "choose a place that can be written",
        ErrorKind::StorageFull => "free some space there, then try again",
        ErrorKind::IsADirectory => "give a file, not a folder",
        ErrorKind::NotADirectory => "check the path: a part of it is a file, not a folder",
        _ => return None,
    })
}

/// What to do next on the command line, where general advice is possible.
fn words(error: &ProjectError) -> Option<&'static str> {
    Some(match error {
        ProjectError::NotFound { .. } => {
            "check the path, or make a project with `petroglyph import SURVEY.sgy PROJECT` or `petroglyph create`"
        }
        ProjectError::Malformed { .. } => {
            "undo the last edit by hand, or ask `petroglyph check PROJECT`: it says what is damaged and what can be restored"
        }
        ProjectError::Unsound { .. } => {
            "`petroglyph check PROJECT` says all that is wrong with it; after that it can be changed as it is"
        }
        ProjectError::DiskFull { .. } => {
            "free some space (derived/ may be deleted, `petroglyph prune` deletes the history), then try again; nothing was changed"
        }
        ProjectError::Duplicate { .. } => "choose another --name, or rename or remove the present one first",
        ProjectError::Unknown { .. } => "check the spelling; names are listed by `petroglyph info PROJECT`",
        ProjectError::PickOutside { .. } => {
            "give INLINE,CROSSLINE,Z as line numbers and in the project's vertical unit"
        }
        ProjectError::NoCandidate { .. } => "pick there, or extract with another --extrema or a larger --max-distance",
        ProjectError::NotAssembled { .. } => {
            "choose another --horizon: only horizons that were made from picks take picks"
        }
        ProjectError::NotClimbable { .. } => "take it out with `petroglyph horizon unpick`, and draw or track it again",
        ProjectError::ShortLine => "write a line as --line IL,XL,Z IL,XL,Z …",
        ProjectError::NothingTracked { .. } => {
            "start on a strong peak or trough, or draw lines with `petroglyph horizon draw`"
        }
        ProjectError::NothingLeft { .. } => "`petroglyph horizon remove` removes a horizon",
        ProjectError::AlreadyPicked { .. } => "pick elsewhere, or climb higher with --up",
        ProjectError::NotPicked { .. } => "`petroglyph horizon show` lists the picks and their places",
        ProjectError::UnknownPick { .. } => "`petroglyph horizon show PROJECT NAME` lists the picks with their numbers",
        ProjectError::AtLeaf { .. } => {
            "remove the leaf with `petroglyph pick --remove`, or extract with smaller leaves"
        }
        ProjectError::OutdatedPicks { .. } => {
            "make them again with `petroglyph horizon replay`, or extract with the former settings"
        }
        ProjectError::UnfitPicks { .. } => "remove them with `petroglyph horizon replay --drop-unfit`, then pick again",
        ProjectError::NoPickFits { .. } => {
            "note its picks (`petroglyph horizon show PROJECT NAME`), remove it (`petroglyph horizon remove PROJECT NAME`) and pick it again, or extract with the former settings; the others are made again by naming them"
        }
        ProjectError::ShortStick { .. } => "write a stick as --stick IL,XL,Z IL,XL,Z …",
        ProjectError::NotDrawn { .. } => "choose another --name",
        ProjectError::NoProposals | ProjectError::OutdatedProposals => "run `petroglyph fault propose PROJECT`",
        ProjectError::UnknownProposal { .. } => "`petroglyph fault propose PROJECT` lists them",
        ProjectError::NoGeometry => "import a volume, or create the project with --bounds and --size",
        ProjectError::NothingToUndo | ProjectError::NothingToRedo => "`petroglyph info PROJECT` shows the history",
        ProjectError::NoTime => "run `petroglyph time PROJECT` first",
        ProjectError::NotExtracted => "run `petroglyph extract PROJECT` first",
        ProjectError::NoVolume => "import one with `petroglyph import SURVEY.sgy PROJECT`",
        ProjectError::Style(TtfError::UnknownRock { .. } | TtfError::UnknownAge { .. }) => return error.advice(),
        ProjectError::Style(_) => "`petroglyph patterns OUT.png` draws every pattern with its name",
        ProjectError::Scene(_) => {
            "`petroglyph scene show` prints a scene; `petroglyph render --help` lists what can be set"
        }
        ProjectError::Placement { .. } => {
            "import it into a new project, or check its header bytes with `petroglyph info FILE`"
        }
        ProjectError::SeveralInFile { .. } => "choose one with --select NAME",
        ProjectError::Format(FormatError::NoSuchName { .. }) => "choose one of them with --select NAME",
        ProjectError::Crossing { .. } => {
            "check unit, sign and picks there, put it elsewhere with --above or --below, or state --contact erosional, onlap or intrusive"
        }
        ProjectError::Param(ParamError::OtherLayers { .. } | ParamError::NoValues { .. }) => {
            "`petroglyph parameterize PROJECT --computed` computes them here"
        }
        ProjectError::NotATruth { .. } => "give the folder that `petroglyph synth` wrote",
        ProjectError::Figure(_) => {
            "`petroglyph render --help` lists what a figure can show; `petroglyph info PROJECT` its lines and horizons"
        }
        _ => return error.advice(),
    })
}
