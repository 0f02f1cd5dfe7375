//! Horizons shown by the leaves of their surface trees (P-horiz 5.2). Voxel space; linear colours.

use super::medium::{FieldMedium, Zone};
use super::samples::NO_DATA_BELOW;
use super::shell::{SOFT, shell_cover};
use super::table::extinction;
use super::{Colouring, PickedHorizon};
use crate::error::RenderError;
use crate::inputs::CandidateVolume;
use crate::leaves::{BORDER_TONE, leaf_colour};
use glam::Vec3;
use ttf::{RgbaFunction, linear_from_srgb};

/// How a horizon is drawn.
pub struct FieldHorizon<'a> {
    /// Linear colour.
    pub colour: Vec3,
    /// Extinction inside.
    pub extinction: f32,
    /// Half of its thickness, voxels.
    pub thickness: f32,
    /// Emission, as a factor on its colour.
    pub emission: f32,
    /// Whether its leaves differ in colour.
    pub by_leaf: bool,
    /// The volume that is painted on it.
    pub paint: Option<FieldMedium<'a>>,
}

/// The horizons that are shown by their leaves.
pub struct FieldHorizons<'a> {
    /// The distances to candidates, and their leaves.
    pub candidates: CandidateVolume<'a>,
    /// Number of the horizon by leaf id, counted from 1; 0 stands for none.
    pub styles: Vec<u8>,
    /// The horizons.
    pub horizons: Vec<FieldHorizon<'a>>,
}

/// A horizon at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizonAt {
    /// Fraction of the point that it covers.
    pub cover: f32,
    /// Distance to the nearest horizon that is shown, voxels; large if there is none.
    pub distance: f32,
    /// Its extinction.
    pub extinction: f32,
    /// Its colour.
    pub colour: Vec3,
    /// Emission, as a factor on the colour.
    pub emission: f32,
}

impl Default for HorizonAt {
    fn default() -> Self {
        Self { cover: 0.0, distance: 1e9, extinction: 0.0, colour: Vec3::ZERO, emission: 0.0 }
    }
}

/// Horizons in a brick.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearHorizon {
    pub shows: bool,
    pub distance: f32,
}

impl<'a> FieldHorizons<'a> {
    /// The horizons of a scene; `resolve` prepares a volume that is painted on one.
    ///
    /// # Errors
    /// Candidates whose lists do not match their size, and everything that `resolve` refuses.
    pub fn new(
        shown: &[PickedHorizon],
        candidates: CandidateVolume<'a>,
        mut resolve: impl FnMut(&str, &RgbaFunction, Zone) -> Result<FieldMedium<'a>, RenderError>,
    ) -> Result<Self, RenderError> {
        candidates.validate()?;
        let mut styles = vec![0u8; candidates.leaf.iter().copied().max().unwrap_or(0) as usize + 1];
        let mut horizons = Vec::new();
        for (n, horizon) in shown.iter().enumerate() {
            if horizon.leaves.is_empty() {
                styles[1..].fill(n as u8 + 1);
            }
            for &leaf in &horizon.leaves {
                if let Some(style) = styles.get_mut(leaf as usize).filter(|_| leaf != 0) {
                    *style = n as u8 + 1;
                }
            }
            let paint = horizon.paint.as_ref();
            let paint = paint.map(|p| resolve(&p.volume, &p.function, Zone::Surroundings)).transpose()?;
            horizons.push(FieldHorizon {
                colour: Vec3::from_array(horizon.colour.to_unit().map(linear_from_srgb)),
                extinction: extinction(horizon.opacity),
                thickness: horizon.thickness,
                emission: horizon.emission,
                by_leaf: horizon.colouring == Colouring::ByLeaf,
                paint,
            });
        }
        Ok(Self { candidates, styles, horizons })
    }

    /// The horizon at a point: the distance is interpolated trilinearly, the leaf is that of the nearest
    /// sample.
    pub fn at(&self, p: Vec3) -> HorizonAt {
        let leaf = self.candidates.leaf_at(p);
        let style = self.styles[leaf as usize];
        if style == 0 {
            return HorizonAt::default();
        }
        let horizon = &self.horizons[usize::from(style) - 1];
        let distance = self.candidates.distance_at(p);
        let cover = shell_cover(horizon.thickness, distance);
        let mut colour = horizon.colour;
        if horizon.by_leaf {
            let group = self.candidates.group(leaf);
            if group == 0 {
                return HorizonAt::default();
            }
            let tone = if cover > 0.0 && self.candidates.is_border(p) { BORDER_TONE } else { 1.0 };
            colour = Vec3::from_array((leaf_colour(group) * tone).to_array().map(linear_from_srgb));
        }
        if let Some(paint) = &horizon.paint
            && cover > 0.0
        {
            let value = paint.sample(p);
            if value > NO_DATA_BELOW {
                let [r, g, b, _] = paint.table.entries[paint.table.index(value)];
                colour = Vec3::new(r, g, b);
            }
        }
        HorizonAt { cover, distance, extinction: horizon.extinction, colour, emission: horizon.emission }
    }

    pub(super) fn nearest(&self, low: Vec3, high: Vec3) -> NearHorizon {
        let c = &self.candidates;
        let from = low.to_array().map(|v| v as usize);
        let mut near = NearHorizon { shows: false, distance: 1e9 };
        for x in from[0]..=(high.x as usize).min(c.size[0] - 1) {
            for y in from[1]..=(high.y as usize).min(c.size[1] - 1) {
                let start = (x * c.size[1] + y) * c.size[2];
                for n in start + from[2]..=start + (high.z as usize).min(c.size[2] - 1) {
                    let style = self.styles[c.leaf[n] as usize];
                    if style != 0 {
                        let distance = f32::from(c.distance[n]) * c.voxels_per_step;
                        near.distance = near.distance.min(distance);
                        // Between samples, the interpolated distance may be smaller than at all of them, but
                        // by less than a voxel.
                        near.shows |= distance <= self.horizons[usize::from(style) - 1].thickness + 1.0 + SOFT;
                    }
                }
            }
        }
        near
    }
}
