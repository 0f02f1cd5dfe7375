//! What the operating system, its shells and the processor give: to computations on volumes larger than caches, pages
//! and sometimes memory, and to people.
//!
//! - files that may be anything: [`mod@file`] reads ordinary ones of a stated size and makes sure that what was written is
//!   on the disk, [`positional`] reads bytes at a place;
//! - memory: how much there is, whether something fits, and how much of what was freed is kept for what comes next
//!   ([`memory`]); volumes in huge pages ([`huge_pages`]);
//! - loops compiled for wide registers too: [`wide`];
//! - lines that people paste into a shell: [`command_line`].
//!
//! Deliberately absent: anything about surveys.

pub mod command_line;
pub mod file;
pub mod huge_pages;
pub mod memory;
pub mod positional;
pub mod wide;
