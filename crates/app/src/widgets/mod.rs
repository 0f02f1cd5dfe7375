//! Parts of the window that know of no project.
//!
//! - `theme`: the look of the window;
//! - [`form`]: the rows of forms;
//! - `canvas`: paints groups of a `page::DisplayList` through egui;
//! - `event_order`: a click counts where it was made, and a notch of the wheel is a line;
//! - [`histogram`] and `opacity_curve`: the values of a volume, and an RGBA function drawn over them;
//! - `obstacle` and [`percent`]: controls that say why they do nothing, and shares shown in percent;
//! - [`dialogue`]: a dialogue in the middle of the window;
//! - [`keyboard`]: what Enter and Escape do in every dialogue and field, and names changed in place;
//! - [`page`]: a figure's page as it will be printed, on which labels are dragged;
//! - [`raster`]: paints what egui draws into an image, without a display.
//!
//! Deliberately absent: the state of the window, projects, files, threads.

pub(crate) mod canvas;
mod colour_well;
pub mod dialogue;
pub(crate) mod event_order;
pub mod form;
pub mod histogram;
pub mod keyboard;
pub(crate) mod obstacle;
pub(crate) mod opacity_curve;
pub mod page;
pub mod percent;
pub mod raster;
pub(crate) mod theme;

pub(crate) use colour_well::colour_well;
