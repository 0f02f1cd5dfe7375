//! Reviews that leave the program: a page with the block in 3D for any browser ([`html`]), and a model for slides
//! ([`glb`]).
//!
//! Both walk one neutral [`Model`]: faces with a picture of their illustration and the raw values behind it, horizons and
//! faults as decimated triangles, wells, scenes, sections, notes. Pictures of faces are shaded by `render::cover`, point
//! by point as in a drawn picture, so a browser shows at any blend what `petroglyph render` draws.
//!
//! | module | holds |
//! |---|---|
//! | [`make()`] | from a project to a model |
//! | [`Model`] | the model |
//! | [`html`] | the page; its viewer is built from `viewer/` and kept in `viewer/dist` |
//! | [`glb`] | glTF 2.0 in one binary file |
//! | [`preview`] | a picture of the model's own triangles, for the window |
//!
//! Deliberately absent: any shading, any change of a project.

mod block;
mod covers;
pub mod glb;
mod ground;
pub mod html;
mod make;
mod model;
mod page;
mod picture;
mod polygon;
pub mod preview;
mod share;
mod size;
mod surfaces;

pub use make::{DENSITIES, DENSITY, MOST_SECTIONS, ReviewSettings, SECTIONS, make};
pub use model::{
    Block, Cover, Face, Layer, LineKind, Mesh, Model, Note, RawScale, SceneModel, SectionPlace, Stack, Surface,
    WellPath,
};
pub use share::ShareKind;
pub use size::SizeEstimate;
