//! Surfaces as shells: the fraction of a point that a surface at some distance covers. Lengths are in voxels.

/// Half of the width over which the edge of a shell fades, voxels.
pub(crate) const SOFT: f32 = 0.25;

/// Fraction of a point that a shell of half thickness `thickness` covers at this distance from its surface.
#[inline(always)]
pub(crate) fn shell_cover(thickness: f32, distance: f32) -> f32 {
    ((thickness - distance) / (2.0 * SOFT) + 0.5).clamp(0.0, 1.0)
}
