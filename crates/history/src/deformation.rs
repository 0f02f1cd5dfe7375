//! What every event that moves rock can do.

use glam::DVec3;

/// An invertible map of the block, in closed form or by a monotone solve in one dimension.
///
/// Positions are m east, north and down from the block's south-west corner at depth 0. A fault divides rock into sides;
/// on each, the map is smooth and defined everywhere, so that surfaces can be continued past the fault. Rock moves along a
/// fault, so that a place has one side before and after.
pub trait Deformation {
    /// Metres, about, from the surface on which the event divides rock, positive in the hanging wall; `None` where it
    /// divides nothing.
    fn offset(&self, _p: DVec3) -> Option<f64> {
        None
    }

    /// The side on which a place lies: 1 in the hanging wall, 0 elsewhere.
    fn side(&self, p: DVec3) -> i8 {
        i8::from(self.offset(p).is_some_and(|offset| offset > 0.0))
    }

    /// The side on which rock lies that was at `q` before.
    fn side_before(&self, q: DVec3) -> i8 {
        self.side(q)
    }

    /// Where the rock at `p` was before the event, as rock of one side.
    fn undo(&self, p: DVec3, side: i8) -> DVec3;

    /// Where rock that was at `q` before is after the event, as rock of one side.
    fn apply(&self, q: DVec3, side: i8) -> DVec3;
}
