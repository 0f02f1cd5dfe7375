//! From what failed below to an error of a project.

use super::ProjectError;
use std::io;
use std::path::Path;
use system::file::FileAction;

impl From<::time::TimeError> for ProjectError {
    fn from(error: ::time::TimeError) -> Self {
        match error {
            ::time::TimeError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            other => Self::Time(other),
        }
    }
}

impl From<restore::RestoreError> for ProjectError {
    fn from(error: restore::RestoreError) -> Self {
        match error {
            restore::RestoreError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            restore::RestoreError::Model(error) => Self::Model(error),
            other => Self::Restore(other),
        }
    }
}

impl From<interp::InterpError> for ProjectError {
    fn from(error: interp::InterpError) -> Self {
        use interp::InterpError::{Arrays, Cancelled, Sink, Source};
        match error {
            Cancelled(cancelled) => Self::Cancelled(cancelled),
            Sink(error) | Arrays(error) | Source(error) => {
                error.downcast().map_or_else(|error| Self::Interp(Sink(error)), |own| Self::Store(*own))
            }
            other => Self::Interp(other),
        }
    }
}

impl ProjectError {
    /// A place that lies outside of a survey.
    pub(crate) fn outside(at: [f64; 3], geometry: &survey::SurveyGeometry) -> Self {
        Self::PickOutside {
            at,
            inlines: [geometry.inlines.first, geometry.inlines.last()],
            crosslines: [geometry.crosslines.first, geometry.crosslines.last()],
            vertical: [geometry.vertical.first, geometry.vertical.last()],
        }
    }

    /// Whether data that were to be read may be whole: they could not be looked at now, or not by this program. Where it is
    /// told from damage, that is not advised against which is none.
    pub(crate) fn says_nothing(&self) -> bool {
        match self {
            Self::Store(error) => error.says_nothing(),
            Self::Memory(_) | Self::Newer { .. } => true,
            _ => std::iter::successors(std::error::Error::source(self), |error| error.source())
                .filter_map(|error| error.downcast_ref::<io::Error>())
                .any(system::file::says_nothing),
        }
    }

    /// Turns a failure of the file system into an error that the user can act on.
    pub fn io(action: FileAction, path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Self::DiskFull { path },
            io::ErrorKind::ReadOnlyFilesystem | io::ErrorKind::PermissionDenied if action != FileAction::Read => {
                Self::ReadOnly { path }
            }
            _ => Self::Io { action, path, source },
        }
    }
}

impl From<figure::FigureError> for ProjectError {
    fn from(error: figure::FigureError) -> Self {
        match error {
            figure::FigureError::Render(error) => Self::Render(error),
            figure::FigureError::Pattern(error) => Self::Style(error),
            other => Self::Figure(other),
        }
    }
}

impl From<page::PageError> for ProjectError {
    fn from(error: page::PageError) -> Self {
        Self::Figure(error.into())
    }
}
