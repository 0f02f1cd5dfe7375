//! What a project holds as files for other programs: volumes as SEG-Y, horizons and faults in any format that can be read,
//! and values along horizons and the points of horizon candidates as tables.
//!
//! Deliberately absent: any change of a project; pictures, pages and models, which `pictures` and `review` make.

pub mod candidates;
pub mod surface;
mod values;
pub mod volume;
