//! Lines drawn over the faces: horizons and faults from exact sections of the model, and the edges of the
//! block.
//!
//! Lines are polylines in voxel space. Rays decide which parts of them are visible, and these are stroked
//! over the finished picture on the CPU, in the same way for both renderers.
//!
//! Widths are in pixels of an image whose smaller side has 1000 pixels, and scale with the image, so that a
//! figure looks the same at any resolution.

mod dash;
pub(crate) mod draw;
mod hidden;
mod relief;
pub(crate) mod solid;
mod stroke;
mod underlay;

use crate::error::SceneError;
use serde::{Deserialize, Serialize};
use ttf::Colour;

/// Smaller side of an image in which line widths are as stated, pixels.
pub const NOMINAL_SIDE_PX: f32 = 1000.0;

/// The lines that are drawn over the faces.
///
/// ```
/// let outlines = render::Outlines::default();
/// assert_eq!(outlines.faults.width_px, 3.0);
/// assert!(outlines.validate().is_ok());
/// assert_eq!(render::Outlines::none().edges.width_px, 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Outlines {
    /// Edges of the block and its cut-outs, and the edge of the ground on side faces. Default 2.2 px, near
    /// black.
    pub edges: Stroke,
    /// Horizons. Default 1.3 px, near black.
    pub horizons: Stroke,
    /// Faults within their interpreted extent. Default 3 px, near black.
    pub faults: Stroke,
    /// How horizons are drawn where they were not picked, but filled or extrapolated. Default solid.
    pub unpicked: Unpicked,
}

/// How horizons are drawn on the faces of the block where they were not picked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unpicked {
    /// As everywhere.
    #[default]
    Solid,
    /// Dashed where they were filled, with shorter dashes where they were extrapolated.
    Dashed,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stroke {
    /// Width in pixels at a nominal image side of 1000; 0: not drawn.
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
            unpicked: Unpicked::Solid,
        }
    }
}

/// How much heavier unconformities are drawn than other horizons.
const UNCONFORMITY: f32 = 1.7;

impl Outlines {
    /// How a horizon is drawn; erosional ones are heavier.
    pub fn of_horizon(&self, is_unconformity: bool) -> Stroke {
        let factor = if is_unconformity { UNCONFORMITY } else { 1.0 };
        Stroke { width_px: factor * self.horizons.width_px, ..self.horizons }
    }

    /// How a fault is drawn that may have a colour of its own.
    pub fn of_fault(&self, own: Option<Colour>) -> Stroke {
        Stroke { colour: own.unwrap_or(self.faults.colour), ..self.faults }
    }

    /// No lines at all.
    pub fn none() -> Self {
        let off = Stroke { width_px: 0.0, colour: INK };
        Self { edges: off, horizons: off, faults: off, unpicked: Unpicked::Solid }
    }

    /// Checks that the widths can be drawn.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self) -> Result<(), SceneError> {
        for (what, stroke) in [
            ("the width of edges", self.edges),
            ("the width of horizons", self.horizons),
            ("the width of faults", self.faults),
        ] {
            SceneError::check_range(what, f64::from(stroke.width_px), 0.0, 200.0)?;
        }
        Ok(())
    }
}
