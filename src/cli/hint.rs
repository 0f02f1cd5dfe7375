//! What to do next about an error, in the words of the command line.

use files::FormatError;
use param::ParamError;
use project::ProjectError;
use project::error::FaultEditError;
use std::error::Error;
use std::io::ErrorKind;
use std::path::Path;
use system::command_line::CommandLine;
use ttf::TtfError;

/// What to do next about an error, or about what caused it; `None` where no general advice is possible.
pub(super) fn of(error: &(dyn Error + 'static), project: &Path) -> Option<String> {
    let own = error.downcast_ref::<ProjectError>();
    let own = own.and_then(|error| with_line(error, project).or_else(|| words(error).map(str::to_owned)));
    own.or_else(|| of(error.source()?, project))
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

/// What to do next, where that is a line to give on the project.
fn with_line(error: &ProjectError, project: &Path) -> Option<String> {
    let line = |command| CommandLine::new(command).value(project);
    Some(match error {
        ProjectError::Malformed { .. } => format!(
            "undo the last edit by hand, or ask `{}`: it says what is damaged and what can be restored",
            line("check")
        ),
        ProjectError::Unsound { .. } => {
            format!("`{}` says all that is wrong with it; after that it can be changed as it is", line("check"))
        }
        ProjectError::DiskFull { .. } => format!(
            "free some space (derived/ may be deleted, `{}` deletes the history), then try again; nothing was changed",
            line("prune")
        ),
        ProjectError::Unknown { .. } => {
            format!("check the spelling; names are listed by `{}`", line("info"))
        }
        ProjectError::NotClimbable { pick } => {
            let unpick = line("horizon unpick").value(pick.to_string());
            format!("take it out with `{unpick}`, and draw or track it again")
        }
        ProjectError::NothingLeft { horizon } => format!("`{}` removes it", line("horizon remove").value(horizon)),
        ProjectError::NotPicked { horizon, .. } => {
            format!("`{}` lists the picks and their places", line("horizon show").value(horizon))
        }
        ProjectError::UnknownPick { .. } => {
            format!("`{}` lists the picks with their numbers", line("horizon show").value("NAME"))
        }
        ProjectError::OutdatedPicks { horizon, .. } => {
            let replay = line("horizon replay").value(horizon);
            format!("make them again with `{replay}`, or extract with the former settings")
        }
        ProjectError::UnfitPicks { horizon, .. } => {
            let replay = line("horizon replay").value(horizon).flag("--drop-unfit");
            format!("remove them with `{replay}`, then pick again")
        }
        ProjectError::NoPickFits { horizon } => {
            let (show, remove) = (line("horizon show").value(horizon), line("horizon remove").value(horizon));
            format!(
                "note its picks (`{show}`), remove it (`{remove}`) and pick it again, or extract with the former \
                 settings; the others are made again by naming them"
            )
        }
        ProjectError::NoProposals | ProjectError::OutdatedProposals => format!("run `{}`", line("fault propose")),
        ProjectError::UnknownProposal { .. } => format!("`{}` lists them", line("fault propose")),
        ProjectError::NothingToUndo | ProjectError::NothingToRedo => format!("`{}` shows the history", line("info")),
        ProjectError::NoTime => format!("run `{}` first", line("time")),
        ProjectError::NotExtracted => format!("run `{}` first", line("extract")),
        ProjectError::NoVolume => {
            let import = CommandLine::new("import").value("SURVEY.sgy").value(project);
            format!("import one with `{import}`")
        }
        ProjectError::Param(ParamError::OtherLayers { .. } | ParamError::NoValues { .. }) => {
            format!("`{}` computes them here", line("parameterize").flag("--computed"))
        }
        ProjectError::Figure(_) => format!(
            "`petroglyph render --help` lists what a figure can show; `{}` its lines and horizons",
            line("info")
        ),
        _ => return None,
    })
}

/// What to do next on the command line, where general advice is possible.
fn words(error: &ProjectError) -> Option<&'static str> {
    Some(match error {
        ProjectError::NotFound { .. } => {
            "check the path, or make a project with `petroglyph import SURVEY.sgy PROJECT` or `petroglyph create`"
        }
        ProjectError::Duplicate { .. } => "choose another --name, or rename or remove the present one first",
        ProjectError::PickOutside { .. } => {
            "give INLINE,CROSSLINE,Z as line numbers and in the project's vertical unit"
        }
        ProjectError::NoCandidate { .. } => "pick there, or extract with another --extrema or a larger --max-distance",
        ProjectError::NotAssembled { .. } => {
            "choose another --horizon: only horizons that were made from picks take picks"
        }
        ProjectError::ShortLine => "write a line as --line IL,XL,Z IL,XL,Z …",
        ProjectError::NothingTracked { .. } => {
            "start on a strong peak or trough, or draw lines with `petroglyph horizon draw`"
        }
        ProjectError::AlreadyPicked { .. } => "pick elsewhere, or climb higher with --up",
        ProjectError::AtLeaf { .. } => {
            "remove the leaf with `petroglyph pick --remove`, or extract with smaller leaves"
        }
        ProjectError::ShortStick { .. } => "write a stick as --stick IL,XL,Z IL,XL,Z …",
        ProjectError::NotDrawn { .. } => "choose another --name, or give it sticks with `petroglyph fault sticks`",
        ProjectError::FaultEdit(FaultEditError::HasSticks { .. }) => "move their points with `petroglyph fault move`",
        ProjectError::FaultEdit(FaultEditError::CutBeside { .. }) => "give a place on the fault, between its ends",
        ProjectError::FaultEdit(FaultEditError::FewFaults) => {
            "name them one after the other: `petroglyph fault merge PROJECT F1 F2`"
        }
        ProjectError::FaultEdit(FaultEditError::SideBySide { .. }) => {
            "leave them as they are; where one is wrong, cut it with `petroglyph fault cut` and merge the part that goes on"
        }
        ProjectError::NoGeometry => "import a volume, or create the project with --bounds and --size",
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
        ProjectError::NotATruth { .. } => "give the folder that `petroglyph synth` wrote",
        _ => return error.advice(),
    })
}
