//! Histories against mappings of the tests' own, which share no line with the crate.

mod exact;
mod measures;
mod oracle;
mod refusals;
