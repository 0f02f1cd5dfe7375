//! The media of a scene at any point: extinction, colour, emission.
//!
//! Voxel space; extinction per unit of length ([`Field::unit_m`] metres of display space), colours linear.

use super::bricks::{BrickContent, Bricks, LayerLooks, LayerMap, MIXED};
use super::isosurface::{Depths, FieldIsosurface, Scalar};
use super::lit::Lit;
use super::medium::{FieldMedium, Place, SOFT};
use super::prepared::Preparations;
use super::table::{NO_DATA_BELOW, Table, extinction};
use super::{Colouring, EmptySpace, Faces, Media, Phong, Scope, Shading, white_ramp};
use crate::camera::View;
use crate::error::{NO_CANDIDATES, NO_DEPTHS, RenderError};
use crate::inputs::{Candidates, Inputs};
use crate::leaves::{BORDER_TONE, leaf_colour};
use glam::{Mat3, Vec3};
use model::StructuralModel;
use ttf::{TtfTables, linear_from_srgb};

/// What is at a point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Matter {
    /// Extinction per unit of length; 0 = nothing.
    pub extinction: f32,
    /// Linear colour, lit by Phong's model if the scene asks.
    pub colour: Vec3,
    /// Linear light given off.
    pub emission: Vec3,
}

/// A horizon's looks.
pub struct FieldHorizon<'a> {
    /// Linear colour.
    pub colour: Vec3,
    /// Extinction inside.
    pub extinction: f32,
    /// Half of its thickness, voxels.
    pub thickness: f32,
    /// Factor on its colour for the light it gives off.
    pub emission: f32,
    /// Whether its leaves are told apart by colour.
    pub by_leaf: bool,
    /// What is painted on it.
    pub paint: Option<FieldMedium<'a>>,
}

/// The horizons shown by their leaves.
pub struct FieldHorizons<'a> {
    /// Distances and ids.
    pub candidates: Candidates<'a>,
    /// Number of the horizon by leaf id, from 1; 0 = none.
    pub styles: Vec<u8>,
    /// The horizons.
    pub horizons: Vec<FieldHorizon<'a>>,
}

/// The media of a scene, resolved.
pub struct Field<'a> {
    /// Those of the surroundings first.
    pub media: Vec<FieldMedium<'a>>,
    /// Horizons by their leaves.
    pub horizons: Option<FieldHorizons<'a>>,
    /// Surfaces of one value.
    pub isosurfaces: Vec<FieldIsosurface<'a>>,
    /// Space that shows nothing.
    pub bricks: Bricks,
    /// How the media are lit.
    pub shading: Shading,
    /// Which faces stop rays.
    pub faces: Faces,
    /// Where media are shown.
    pub scope: Scope,
    /// Distance that counts as near a horizon, voxels.
    pub reach: f32,
    /// Samples per unit of length.
    pub samples_per_unit: f32,
    /// Unit of length, m of display space.
    pub unit_m: f32,
    /// Linear part of voxel → display.
    pub display_from_voxel: Mat3,
    /// Voxel covector → display covector.
    pub display_normal_from_voxel: Mat3,
    /// Direction to the light in display space, unit.
    pub light: Vec3,
    model: Option<&'a StructuralModel>,
    depths: Option<Depths<'a>>,
}

impl<'a> Field<'a> {
    /// The media of a scene; `None` when it has none.
    ///
    /// # Errors
    /// Functions that cannot be evaluated; horizons without candidates.
    pub fn new(
        media: &Media,
        inputs: &Inputs<'a>,
        tables: &TtfTables,
        view: &View,
        ground_is_shown: bool,
        kept: &mut Preparations,
    ) -> Result<Option<Self>, RenderError> {
        if media.is_empty() {
            return Ok(None);
        }
        let mut resolve = |name: &str, function: &ttf::RgbaFunction, place: Place| {
            function.validate(&format!("the medium `{name}`"))?;
            let volume = *inputs.volumes.iter().find(|v| v.name == name).ok_or_else(|| RenderError::UnknownVolume {
                name: name.to_owned(),
                present: inputs.volumes.iter().map(|v| v.name.to_owned()).collect(),
            })?;
            let prepared = kept.of(inputs.version, &volume);
            Ok::<_, RenderError>(FieldMedium::new(volume, prepared, Table::new(function), place))
        };
        let model = inputs.model;
        let mut resolved = Vec::new();
        let places = [(&media.surroundings, Place::Surroundings), (&media.cut_outs, Place::CutOut)];
        for (medium, place) in places.into_iter().flat_map(|(list, place)| list.iter().map(move |m| (m, place))) {
            let mut made = resolve(&medium.volume, &medium.function, place)?;
            made.layers = LayerLooks::new(medium, tables, model, ground_is_shown);
            resolved.push(made);
        }
        let depths = match (inputs.model, inputs.param) {
            (Some(model), Some(param)) => Some(Depths { model, param }),
            _ => None,
        };
        let mut isosurfaces = Vec::new();
        for surface in &media.isosurfaces {
            let medium = match &surface.of {
                Scalar::Volume(name) => Some(resolve(name, &white_ramp(1.0, 0.0), Place::Surroundings)?),
                Scalar::Depth if depths.is_none() => return Err(NO_DEPTHS),
                Scalar::Depth => None,
            };
            isosurfaces.push(FieldIsosurface::new(surface, medium));
        }
        let horizons = match (media.horizons.is_empty(), inputs.candidates) {
            (true, _) => None,
            (false, None) => {
                return Err(NO_CANDIDATES);
            }
            (false, Some(candidates)) => {
                candidates.validate()?;
                let mut styles = vec![0u8; candidates.leaf.iter().copied().max().unwrap_or(0) as usize + 1];
                let mut list = Vec::new();
                for (n, horizon) in media.horizons.iter().enumerate() {
                    if horizon.leaves.is_empty() {
                        styles[1..].fill(n as u8 + 1);
                    }
                    for &leaf in &horizon.leaves {
                        if let Some(style) = styles.get_mut(leaf as usize).filter(|_| leaf != 0) {
                            *style = n as u8 + 1;
                        }
                    }
                    let paint = horizon.paint.as_ref();
                    let paint = paint.map(|p| resolve(&p.volume, &p.function, Place::Surroundings)).transpose()?;
                    list.push(FieldHorizon {
                        colour: Vec3::from_array(horizon.colour.to_unit().map(linear_from_srgb)),
                        extinction: extinction(horizon.opacity),
                        thickness: horizon.thickness,
                        emission: horizon.emission,
                        by_leaf: horizon.colouring == Colouring::ByLeaf,
                        paint,
                    });
                }
                Some(FieldHorizons { candidates, styles, horizons: list })
            }
        };
        let display_from_voxel = view.display_from_voxel();
        let light = match media.shading {
            Shading::Phong(Phong { light, .. }) => view.display_direction(Vec3::from_array(light).as_dvec3()).as_vec3(),
            _ => Vec3::Z,
        };
        let mut field = Self {
            media: resolved,
            horizons,
            isosurfaces,
            bricks: Bricks { size: [1; 3], words: vec![0] },
            shading: media.shading,
            faces: media.faces,
            scope: media.scope,
            reach: media.reach,
            samples_per_unit: media.samples_per_voxel,
            unit_m: display_from_voxel.determinant().abs().cbrt() as f32,
            display_from_voxel: display_from_voxel.as_mat3(),
            display_normal_from_voxel: display_from_voxel.inverse().transpose().as_mat3(),
            light,
            model,
            depths,
        };
        field.bricks = field.fill_bricks(inputs.geometry.size(), media.empty_space);
        Ok(Some(field))
    }

    /// The one medium, where there is nothing else to see and nothing to ask but its function.
    pub fn alone(&self) -> Option<&FieldMedium<'a>> {
        let [medium] = &self.media[..] else { return None };
        let alone = self.horizons.is_none() && self.isosurfaces.is_empty() && medium.layers.is_none();
        alone.then_some(medium)
    }

    fn fill_bricks(&self, samples: [usize; 3], empty_space: EmptySpace) -> Bricks {
        let layered = self.media.iter().any(|m| m.layers.is_some())
            || self.isosurfaces.iter().any(|surface| surface.medium.is_none());
        let map = self.model.filter(|_| layered).map(LayerMap::new);
        Bricks::new(samples, |brick| {
            let layer = map.as_ref().map_or(MIXED, |map| map.layer(brick));
            let [low, high] = Bricks::corners(brick);
            let near = self.horizons.as_ref().map(|h| h.nearest(low, high));
            let shows = |place: Place| {
                empty_space == EmptySpace::Sampled
                    || near.is_some_and(|near| near.shows)
                    || self.isosurfaces.iter().any(|surface| surface.shows(low, high, layer))
                    || (self.scope != Scope::NearHorizons || near.is_some_and(|near| near.distance <= self.reach + 1.0))
                        && self.media.iter().any(|m| m.place == place && m.shows(low, high, layer))
            };
            BrickContent { shows: [shows(Place::Surroundings), shows(Place::CutOut)], layer }
        })
    }

    /// What is at a point of a place, in a brick with this word. `towards` points to the viewer, unit, in display space.
    #[inline(always)]
    pub fn at(&self, p: Vec3, place: Place, word: u32, towards: Vec3) -> Matter {
        if self.media.len() == 1 && self.horizons.is_none() && self.isosurfaces.is_empty() {
            let medium = &self.media[0];
            return if medium.place == place { self.of_medium(medium, p, word, towards) } else { Matter::default() };
        }
        self.mixed(p, place, word, towards)
    }

    #[inline(always)]
    fn of_medium(&self, medium: &FieldMedium, p: Vec3, word: u32, towards: Vec3) -> Matter {
        let value = medium.sample(p);
        if value < NO_DATA_BELOW {
            return Matter::default();
        }
        let [r, g, b, mut extinction] = medium.table.entries[medium.table.index(value)];
        if extinction <= 0.0 {
            return Matter::default();
        }
        let mut colour = Vec3::new(r, g, b);
        if let Some(looks) = &medium.layers {
            let [r, g, b, opacity] = self.layer_entry(looks, p, word);
            if looks.colours {
                colour = Vec3::new(r, g, b);
            }
            extinction = thinned(extinction, opacity);
        }
        if let Shading::Phong(phong) = self.shading
            && extinction > 0.0
        {
            colour = self.lit(phong, medium.gradient(p), colour, towards);
        }
        Matter { extinction, colour, emission: Vec3::ZERO }
    }

    /// The looks of the layer at a place: known for the brick, or asked of the model.
    fn layer_entry(&self, looks: &LayerLooks, p: Vec3, word: u32) -> [f32; 4] {
        let hint = (word >> 16 & 255) as u8;
        let layer = match (hint, self.model) {
            (MIXED, Some(model)) => usize::from(model.region_at(p).layer),
            (hint, _) => usize::from(hint),
        };
        looks.entries.get(layer).copied().unwrap_or_default()
    }

    /// Several media and horizons at one place.
    fn mixed(&self, p: Vec3, place: Place, word: u32, towards: Vec3) -> Matter {
        let horizon = self.horizons.as_ref().map(|h| h.at(p)).unwrap_or_default();
        let mut rest = 1.0 - horizon.cover;
        let in_scope = match self.scope {
            Scope::Everywhere => true,
            Scope::NearHorizons => horizon.distance <= self.reach,
            Scope::AwayFromHorizons => horizon.distance > self.reach,
        };
        let mut sum = Matter::default();
        for surface in &self.isosurfaces {
            let (cover, gradient) = surface.at(p, self.depths);
            if cover > 0.0 {
                let colour = match self.shading {
                    Shading::Phong(phong) => self.lit(phong, gradient, surface.colour, towards),
                    _ => surface.colour,
                };
                let kappa = surface.extinction * cover;
                sum.extinction += kappa;
                sum.colour += colour * kappa;
                rest *= 1.0 - cover;
            }
        }
        if rest > 0.0 && in_scope {
            for medium in self.media.iter().filter(|m| m.place == place) {
                let one = self.of_medium(medium, p, word, towards);
                sum.extinction += one.extinction * rest;
                sum.colour += one.colour * (one.extinction * rest);
            }
        }
        if horizon.cover > 0.0 {
            let kappa = horizon.extinction * horizon.cover;
            sum.extinction += kappa;
            sum.colour += horizon.colour * kappa;
            sum.emission += horizon.colour * (horizon.emission * kappa);
        }
        if sum.extinction > 0.0 {
            sum.colour /= sum.extinction;
            sum.emission /= sum.extinction;
        }
        sum
    }

    /// A colour under Phong's light.
    fn lit(&self, phong: Phong, gradient: Vec3, colour: Vec3, towards: Vec3) -> Vec3 {
        Lit::new(phong, self.light, towards).on(self.display_normal_from_voxel * gradient, colour)
    }
}

/// The extinction whose opacity is that of `kappa` times a factor.
fn thinned(kappa: f32, opacity: f32) -> f32 {
    match opacity {
        1.0 => kappa,
        0.0 => 0.0,
        opacity => extinction((1.0 - (-kappa).exp()) * opacity),
    }
}

/// A horizon's part at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizonAt {
    /// Share of the place it takes.
    pub cover: f32,
    /// Distance to the nearest horizon shown, voxels; large where there is none.
    pub distance: f32,
    /// Its extinction.
    pub extinction: f32,
    /// Its colour.
    pub colour: Vec3,
    /// Factor for the light it gives off.
    pub emission: f32,
}

impl Default for HorizonAt {
    fn default() -> Self {
        Self { cover: 0.0, distance: 1e9, extinction: 0.0, colour: Vec3::ZERO, emission: 0.0 }
    }
}

/// What a brick has of horizons.
#[derive(Debug, Clone, Copy)]
struct Near {
    shows: bool,
    distance: f32,
}

impl FieldHorizons<'_> {
    /// The horizon at a point: distance by trilinear interpolation, leaf by the nearest sample.
    pub fn at(&self, p: Vec3) -> HorizonAt {
        let leaf = self.candidates.leaf_at(p);
        let style = self.styles.get(leaf as usize).copied().unwrap_or(0);
        if style == 0 {
            return HorizonAt::default();
        }
        let horizon = &self.horizons[usize::from(style) - 1];
        let distance = self.candidates.distance_at(p);
        let cover = ((horizon.thickness - distance) / (2.0 * SOFT) + 0.5).clamp(0.0, 1.0);
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

    fn nearest(&self, low: Vec3, high: Vec3) -> Near {
        let c = &self.candidates;
        let from = low.to_array().map(|v| v as usize);
        let mut near = Near { shows: false, distance: 1e9 };
        for x in from[0]..=(high.x as usize).min(c.size[0] - 1) {
            for y in from[1]..=(high.y as usize).min(c.size[1] - 1) {
                let start = (x * c.size[1] + y) * c.size[2];
                for n in start + from[2]..=start + (high.z as usize).min(c.size[2] - 1) {
                    let style = self.styles[c.leaf[n] as usize];
                    if style != 0 {
                        let distance = f32::from(c.distance[n]) * c.voxels_per_step;
                        near.distance = near.distance.min(distance);
                        // Between samples the interpolated distance is less than at all of them by less than a voxel.
                        near.shows |= distance <= self.horizons[usize::from(style) - 1].thickness + 1.0 + SOFT;
                    }
                }
            }
        }
        near
    }
}
