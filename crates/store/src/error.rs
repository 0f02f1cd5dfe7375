//! Errors of the store, with the path and what the user can do.

use std::io;
use std::path::{Path, PathBuf};
use survey::geometry::GeometryError;
use survey::progress::Cancelled;
use system::file::FileAction;
use system::memory::NotEnough;

/// Why something could not be stored or read back.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// No space left, or a quota is used up.
    #[error("the disk is full: {} could not be written; free some space or choose another disk (what was there \
             before is unchanged)", path.display())]
    DiskFull {
        /// What was being written.
        path: PathBuf,
    },
    /// The folder or file cannot be written to.
    #[error("{} cannot be written: the folder is read-only or belongs to someone else; choose another folder \
             or change its permissions", path.display())]
    ReadOnly {
        /// What was being written.
        path: PathBuf,
    },
    /// There is nothing at the path.
    #[error("{} does not exist; check the name, or import the data again", path.display())]
    Missing {
        /// What was looked for.
        path: PathBuf,
    },
    /// Writing the volume was interrupted.
    #[error("{} was not written to its end; run the same import again to finish it", path.display())]
    Unfinished {
        /// The folder.
        path: PathBuf,
    },
    /// A Zarr group has no such array.
    #[error("{} has no array {array:?}; it was not written by this program or is incomplete: import the data again", path.display())]
    MissingArray {
        /// The group.
        path: PathBuf,
        /// The array looked for.
        array: String,
    },
    /// The stored object is of another kind.
    #[error("{} is not {expected}: {reason}", path.display())]
    WrongKind {
        /// The group or file.
        path: PathBuf,
        /// What was expected, with its article.
        expected: &'static str,
        /// What it is instead.
        reason: String,
    },
    /// Written by a newer version.
    #[error("{} has format version {found}, this program knows up to {known}; use a newer program", path.display())]
    NewerVersion {
        /// The group or file.
        path: PathBuf,
        /// Its version.
        found: u64,
        /// The newest known one.
        known: u64,
    },
    /// Numbers of another type than asked for.
    #[error("array {array:?} of {} holds {found}, not {expected}", path.display())]
    WrongType {
        /// The group.
        path: PathBuf,
        /// The array.
        array: String,
        /// Type asked for.
        expected: &'static str,
        /// Type found.
        found: String,
    },
    /// A linked array whose bricks are not stored as this program stores them.
    #[error("array {array:?} of {} has other chunks than a linked volume may have (uncompressed bricks in shards, as \
             this program writes them); import the volume instead", path.display())]
    OtherChunks {
        /// The group.
        path: PathBuf,
        /// The array.
        array: String,
    },
    /// Object storage does not answer, or not with what was asked for.
    #[error("{url} could not be read: {reason}")]
    Remote {
        /// The object.
        url: String,
        /// What is wrong, and what to do.
        reason: String,
    },
    /// Object storage does not take what was to be written.
    #[error("{url} could not be written: {reason}")]
    RemoteWrite {
        /// The object, or the volume.
        url: String,
        /// What is wrong, and what to do.
        reason: String,
    },
    /// The program was built without object storage.
    #[error("{url} lies in object storage, which this program was built without; build it with `--features remote`")]
    WithoutRemote {
        /// The volume.
        url: String,
    },
    /// A linked volume is no longer what was linked.
    #[error("{url} has changed since it was linked; remove the volume from the project and link it again")]
    RemoteChanged {
        /// The volume.
        url: String,
    },
    /// Data that is cut off, altered or missing.
    #[error("array {array:?} of {} is damaged ({reason}); import the data again, or delete it if it is derived", path.display())]
    Damaged {
        /// The group.
        path: PathBuf,
        /// The array.
        array: String,
        /// What does not fit.
        reason: String,
    },
    /// What is to be read does not fit into memory.
    #[error("{} is larger than memory: {source}", path.display())]
    Memory {
        /// The array.
        path: PathBuf,
        /// How much it would take.
        source: NotEnough,
    },
    /// Facts that no survey has.
    #[error("{} has a geometry that cannot be used: {source}; import the data again", path.display())]
    Geometry {
        /// The group.
        path: PathBuf,
        /// What is wrong with it.
        source: GeometryError,
    },
    /// A box that is not inside the array.
    #[error("the box from {start:?} of size {size:?} is not inside the array {array:?} of {}, which has {shape:?}", path.display())]
    OutOfBounds {
        /// The group.
        path: PathBuf,
        /// The array.
        array: String,
        /// First element asked for.
        start: Vec<usize>,
        /// Elements asked for.
        size: Vec<usize>,
        /// Number of elements.
        shape: Vec<usize>,
    },
    /// Parts that do not fit together.
    #[error("{what} has {found} values where {expected} are needed")]
    SizeMismatch {
        /// Which part.
        what: &'static str,
        /// Values needed.
        expected: usize,
        /// Values given.
        found: usize,
    },
    /// Any other failure of the file system.
    #[error("{} could not be {action}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was being done with it.
        action: FileAction,
        /// The system's reason.
        source: io::Error,
    },
    /// A folder whose path is no text, which the array library takes no path from.
    #[error("{} is a path that is no UTF-8, at which arrays are neither read nor written; rename the folder", path.display())]
    NoText {
        /// The group.
        path: PathBuf,
    },
    /// The array library refused what it was asked to do.
    #[error("{} could not be {action}: {reason}", path.display())]
    Array {
        /// The group.
        path: PathBuf,
        /// What was being done with it.
        action: FileAction,
        /// The library's reason.
        reason: String,
    },
    /// The source of the samples failed.
    #[error("the samples for {} could not be supplied", path.display())]
    Source {
        /// What was being written.
        path: PathBuf,
        /// The supplier's reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Stopped by the user.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl StoreError {
    /// Something that is not what was expected.
    pub(crate) fn wrong_kind(path: &Path, expected: &'static str, reason: impl Into<String>) -> Self {
        Self::WrongKind { path: path.to_owned(), expected, reason: reason.into() }
    }

    /// An array or a group that the library refused.
    pub(crate) fn array(group: &Path, action: FileAction, reason: impl Into<String>) -> Self {
        Self::Array { path: group.to_owned(), action, reason: reason.into() }
    }

    /// An array of a group whose content does not fit.
    pub(crate) fn damaged(group: &Path, array: &str, reason: impl Into<String>) -> Self {
        Self::Damaged { path: group.to_owned(), array: array.to_owned(), reason: reason.into() }
    }

    /// Whether data that were to be read may be whole: they could not be looked at now, or not by this program.
    pub fn says_nothing(&self) -> bool {
        match self {
            Self::Io { source, .. } => system::file::says_nothing(source),
            Self::NoText { .. }
            | Self::Memory { .. }
            | Self::NewerVersion { .. }
            | Self::Remote { .. }
            | Self::WithoutRemote { .. } => true,
            _ => false,
        }
    }

    /// A failure of the file system while `path` was being read, written or flushed.
    pub fn io(action: FileAction, path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Self::DiskFull { path },
            io::ErrorKind::ReadOnlyFilesystem => Self::ReadOnly { path },
            io::ErrorKind::PermissionDenied if action == FileAction::Written => Self::ReadOnly { path },
            io::ErrorKind::NotFound if action == FileAction::Read => Self::Missing { path },
            _ => Self::Io { path, action, source },
        }
    }
}
