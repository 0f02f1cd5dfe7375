//! Arguments for reviews and their notes.

use super::DrawingArgs;
use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(in crate::cli) struct ReviewArgs {
    /// Project folder
    pub(in crate::cli) project: PathBuf,
    /// Page to write, such as north.html
    pub(in crate::cli) out: PathBuf,
    /// Scene to show; repeat it for several [default: all scenes of the project, or the default view]
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) scene: Vec<String>,
    /// Texels along the longest side of the block
    #[arg(long, value_name = "TEXELS", default_value_t = review::DENSITY)]
    pub(in crate::cli) density: f64,
    /// Inlines, crosslines and slices to step through, of each so many; 0 for none
    #[arg(long, value_name = "N", default_value_t = review::SECTIONS)]
    pub(in crate::cli) sections: usize,
    /// Largest size of the page in MB; pictures of faces get coarser until it fits
    #[arg(long, value_name = "MB", default_value_t = review::html::SIZE_MB)]
    pub(in crate::cli) size_limit: f64,
    #[command(flatten)]
    pub(in crate::cli) drawing: DrawingArgs,
}

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum NoteAction {
    /// List the notes with their numbers
    #[command(after_help = "Example:\n  petroglyph note list north.petro")]
    List {
        /// Project folder
        project: PathBuf,
    },
    /// Write a note on a place
    #[command(
        after_help = "Example:\n  petroglyph note add north.petro --at 1250,1302,948 \"Gas chimney?\" --scene corner"
    )]
    Add {
        /// Project folder
        project: PathBuf,
        /// Text of the note
        text: String,
        /// The place: inline, crossline, vertical value
        #[arg(long, value_name = "IL,XL,Z", allow_hyphen_values = true)]
        at: String,
        /// Show it in this scene alone
        #[arg(long, value_name = "NAME")]
        scene: Option<String>,
    },
    /// Remove a note
    #[command(after_help = "Example:\n  petroglyph note remove north.petro 2")]
    Remove {
        /// Project folder
        project: PathBuf,
        /// Number of the note, as `note list` shows it
        number: usize,
    },
}
