//! The sheets of one region, and the field k between them.
//!
//! # Distance ratio (P-illus 3.1)
//!
//! ```text
//! k = d_b / (d_b + d_t)         ∇k = (d_t ∇d_b − d_b ∇d_t) / (d_b + d_t)²
//! ```
//!
//! ∇d is the metric unit normal of the sheet at the closest point, towards the layer. It is analytic, and
//! stable where d vanishes. Isocurves are followed with k itself as the parameter, dp/dk = ∇k/|∇k|², so that
//! a curve arrives at k = 0.5 by construction.
//!
//! # Parallel
//!
//! k = d/T from the bottom, or 1 − d/T from the top, with the layer's reference thickness T in metres. The
//! curves along ∇k are the normals of the sheet, and their foot is known. The normals of a curved sheet meet
//! on its concave side, so no surface at half height is crossed by all of them; therefore (i, j) are those of
//! the *foot*.
//!
//! # Spaces
//! Positions are voxels relative to the [`ColumnFrame`] of a column (its integer x, y and the height of the
//! bottom sheet there).

use crate::closest::Foot;
use crate::metric::Metric;
use crate::surface::{BicubicSheet, ColumnFrame};
use glam::Vec3;

/// Two sheets of one layer in one fault block, and the definition of k between them.
pub(crate) struct Layer {
    /// Where k = 0. In a layer that is open below, the top sheet lowered by the reference thickness.
    pub bottom: BicubicSheet,
    /// Where k = 1 for the distance ratio; otherwise the sheet at the reference thickness.
    pub top: BicubicSheet,
    /// How k is measured.
    pub kind: LayerKind,
    /// The metric of lengths and angles.
    pub metric: Metric,
}

/// How k is measured in a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LayerKind {
    /// Ratio of the distances to both sheets.
    Ratio,
    /// Distance from the bottom sheet over the thickness (scaled metric).
    AboveBottom(f32),
    /// 1 − distance from the top sheet over the thickness (scaled metric).
    BelowTop(f32),
    /// The fraction of the height; i, j are those of the column.
    Vertical,
}

/// The feet of a point on both sheets of its layer.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Feet {
    /// On the bottom sheet.
    pub bottom: Foot,
    /// On the top sheet.
    pub top: Foot,
}

/// The distance ratio at a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RatioSample {
    /// k.
    pub k: f32,
    /// dp/dk along the isocurve, voxels per unit of k; zero where ∇k is near 0.
    pub velocity: Vec3,
}

impl Layer {
    /// The frame of a column. Relative height 0 is on the bottom sheet.
    pub(crate) fn frame(&self, column: [i32; 2]) -> ColumnFrame {
        ColumnFrame { column, z: self.bottom.node(column[0], column[1]) }
    }

    /// Voxels between the sheets in a column; negative where they cross.
    pub(crate) fn thickness(&self, column: [i32; 2]) -> f32 {
        self.bottom.node(column[0], column[1]) - self.top.node(column[0], column[1])
    }

    /// Moves both feet to `p` and evaluates the distance ratio there.
    #[inline]
    pub(crate) fn follow(&self, frame: ColumnFrame, p: Vec3, feet: &mut Feet) -> RatioSample {
        feet.bottom.follow(&self.bottom, &self.metric, frame, p);
        feet.top.follow(&self.top, &self.metric, frame, p);
        self.ratio(feet)
    }

    /// The distance ratio at the point that the feet belong to.
    #[inline]
    pub(crate) fn ratio(&self, feet: &Feet) -> RatioSample {
        let (db, dt) = (feet.bottom.distance, feet.top.distance);
        let sum = db + dt;
        let towards_bottom = feet.bottom.upward_normal(&self.metric);
        let towards_top = feet.top.upward_normal(&self.metric);
        // The distance to the top increases downwards, hence the plus.
        let gradient = (towards_bottom * dt + towards_top * db) * (1.0 / (sum * sum));
        let squared = self.metric.length_squared(gradient);
        let velocity = if squared * sum * sum > 1e-4 { gradient * (1.0 / squared) } else { Vec3::ZERO };
        RatioSample { k: db / sum, velocity }
    }
}
