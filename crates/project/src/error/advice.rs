//! What to do next about an error, where that does not depend on who shows it.

use super::{FaultEditError, ProjectError};
use files::FormatError;
use files::segy::SegyError;
use files::well::WellFileError;
use survey::Remedy;

impl ProjectError {
    /// What to do next, if the advice is the same wherever the error is shown. The other errors get advice from the
    /// program that shows them, or contain it themselves.
    pub fn advice(&self) -> Option<&'static str> {
        Some(match self {
            Self::NotAProject { .. } => "give the folder that holds project.toml, usually NAME.petro",
            Self::Exists { .. } => "choose another name, or move the old project away first",
            Self::Newer { .. } => "update Petroglyph, or ask for the project to be saved by the older version",
            Self::Malformed { .. } => "undo the last edit by hand, or copy the last good state from history/",
            Self::Locked { .. } => "wait until the other command has finished, then try again; nothing was changed",
            Self::InsideProject { .. } => "give a file outside of the project's folder",
            Self::OtherSize { .. } => "undo the last edit by hand, or import the data again",
            Self::OtherContent { .. } => {
                "the file was changed or damaged outside of Petroglyph: copy it back from a backup, or remove it from the project and import it again"
            }
            Self::Link { .. } => {
                "if you trust the origin of the project, replace the link by a copy of the file or folder; nothing was changed"
            }
            Self::NotFlushed { .. } => {
                "the disk or its connection may be failing: copy the project elsewhere, then look here again"
            }
            Self::ReadOnly { .. } => "copy the project to a folder you may write to; nothing was changed",
            Self::SeveralHorizons { .. } => "make the picks of each horizon in a separate step",
            Self::FaultEdit(FaultEditError::FlatSticks { .. }) => {
                "draw sticks next to one another, each along the dip of the fault"
            }
            Self::FaultEdit(FaultEditError::FaultElsewhere { .. }) => {
                "give at least some of it over the survey: check its coordinates"
            }
            Self::NoEvidence => "import a volume, or assemble or import horizons first",
            Self::BadName { .. } => "use letters, digits, blanks, - and _",
            Self::Cancelled(_) => "nothing was changed",
            Self::OtherLattice { .. } => {
                "extract from a volume on the project's lattice, or import this one into a new project"
            }
            Self::Geometry(_) => "check the header bytes or bounds from which the geometry is made",
            Self::CircularTruncation { .. } => "remove one of these truncations",
            Self::BadFigure { .. } => "correct it under [[figures]] in project.toml; nothing was written",
            Self::NoFigures => {
                "write them into project.toml: [[figures]], then file = \"block.pdf\", scene = \"corner\", legend = true"
            }
            Self::TimeUnknown { .. } => "point at a reflection",
            Self::NoIsochron { .. } => "point at a place inside the survey, or compute geologic time again",
            Self::StackCount { .. } => "ask for fewer, or remove horizons that you no longer need",
            Self::StackBetween => "name them with --between TOP BASE",
            Self::StackOrder { .. } => "name the upper horizon first, then a lower one of the same blocks",
            Self::NoLayers => "add one with `petroglyph horizon add`",
            Self::NoLevels => "it may be chaotic, constant or too small: pick horizons by hand",
            Self::OverBudget { .. } => {
                "allow more (--size-limit, --triangles), or show less: fewer scenes (--scene), sections (--sections) or cut-outs"
            }
            Self::BadNote(_) => {
                "list the notes and their numbers with `petroglyph note list`, and the survey's lines with `petroglyph info`"
            }
            Self::Stage(error) => return error.advice(),
            Self::BadGrowth { .. } => "state metres, 0 or more",
            // Contains its advice, or gets it from the program that shows it.
            _ => return None,
        })
    }

    /// What can be stated about a file so that the error does not occur again, if that is known.
    pub fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::Segy(error) => error.remedy(),
            Self::Format(error) => error.remedy(),
            Self::Well(error) => error.remedy(),
            _ => None,
        }
    }
}

/// What can be stated about a file to resolve an error, wherever in its chain of causes that is known.
pub fn remedy_of(error: &(dyn std::error::Error + 'static)) -> Option<Remedy> {
    std::iter::successors(Some(error), |error| error.source()).find_map(|error| {
        if let Some(error) = error.downcast_ref::<ProjectError>() {
            error.remedy()
        } else if let Some(error) = error.downcast_ref::<SegyError>() {
            error.remedy()
        } else if let Some(error) = error.downcast_ref::<FormatError>() {
            error.remedy()
        } else {
            error.downcast_ref::<WellFileError>()?.remedy()
        }
    })
}
