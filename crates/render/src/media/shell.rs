//! Surfaces as shells: how much of a point a surface at some distance covers. Voxels.

/// Half of the border over which a shell fades, voxels.
pub const SOFT: f32 = 0.25;

/// Share of a point that a shell of half thickness `thickness` takes at this distance from its surface.
#[inline(always)]
pub fn shell_cover(thickness: f32, distance: f32) -> f32 {
    ((thickness - distance) / (2.0 * SOFT) + 0.5).clamp(0.0, 1.0)
}
