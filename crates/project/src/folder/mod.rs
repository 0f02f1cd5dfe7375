//! A project as a folder on disk: the files of a state, the history of states, and drafts of new ones.
//!
//! Every read and write of a project's own files goes through here, and so does every deletion.

pub(crate) mod acquaintance;
mod draft;
mod handle;
pub(crate) mod history;
mod lock;
mod output;
pub(crate) mod state;
pub(crate) mod storage;

pub(crate) use draft::Draft;
pub use history::Step;
pub use lock::DEFAULT_WAIT;
pub use output::refuse_inside_project;
pub(crate) use storage::at_hand;
pub use storage::open_own;

pub(crate) use lock::{CREATING, Lock, forget_creation};
pub(crate) use storage::IMPORTING;
