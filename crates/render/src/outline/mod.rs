//! Lines drawn over the faces: horizons and faults from the exact sections of the model, and the block's own edges.
//!
//! Lines are polylines in voxel space, cut to what is seen by casting rays, and stroked over the finished picture on the CPU,
//! the same for both renderers.
//!
//! Widths are pixels of an image 1000 pixels wide or high (the smaller side) and scale with it, so that a figure looks the same at
//! any resolution.

mod draw;
mod hidden;
mod relief;
mod solid;
mod stroke;
mod underlay;

pub(crate) use draw::draw;
pub(crate) use solid::{FaceRect, face_rects};
pub(crate) use underlay::has_underlay;

use crate::error::SceneError;
use serde::{Deserialize, Serialize};
use ttf::Colour;

/// Image side at which line widths are as stated, pixels.
pub const NOMINAL_SIDE_PX: f32 = 1000.0;

/// Which lines are drawn over the faces, and how.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Outlines {
    /// Edges of the block and its cut-outs, and the rim of the ground. Default 2.2 px, near black.
    pub edges: Stroke,
    /// Horizons. Default 1.3 px, near black.
    pub horizons: Stroke,
    /// Faults, where they are real. Default 3 px, near black.
    pub faults: Stroke,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// Width, pixels at a nominal image side of 1000; 0 = not drawn.
    pub width_px: f32,
    /// Colour.
    pub colour: Colour,
}

/// Near black: full black looks harsh beside printed patterns.
const INK: Colour = Colour::new(0x1c, 0x1a, 0x19);

impl Default for Outlines {
    fn default() -> Self {
        Self {
            edges: Stroke { width_px: 2.2, colour: INK },
            horizons: Stroke { width_px: 1.3, colour: INK },
            faults: Stroke { width_px: 3.0, colour: INK },
        }
    }
}

impl Outlines {
    /// No lines at all.
    pub fn none() -> Self {
        let off = Stroke { width_px: 0.0, colour: INK };
        Self { edges: off, horizons: off, faults: off }
    }

    /// Refuses widths that cannot be drawn.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self) -> Result<(), SceneError> {
        for (what, stroke) in [
            ("the width of edges", self.edges),
            ("the width of horizons", self.horizons),
            ("the width of faults", self.faults),
        ] {
            let found = f64::from(stroke.width_px);
            if !(0.0..=200.0).contains(&found) {
                return Err(SceneError::OutOfRange { what, found, low: 0.0, high: 200.0 });
            }
        }
        Ok(())
    }
}
