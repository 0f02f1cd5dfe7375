//! What is seen: a file for each panel. Each draws the state and answers with actions.

pub mod bar;
pub mod block;
pub mod chooser;
pub mod controls;
pub mod data;
pub mod export;
pub mod functions;
pub mod import;
pub mod interpretation;
pub mod lasso;
pub mod layers;
pub mod map;
pub mod notices;
pub mod overlay;
pub mod patterns;
pub mod picking;
pub mod pointed;
pub mod sections;
pub mod shortcuts;
pub mod start;
pub mod status;
pub mod surfaces;
pub mod swatch;
pub mod tiles;
pub mod traces;
