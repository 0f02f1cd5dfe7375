//! The media of a scene, evaluated at any point: extinction, colour and emission.
//!
//! Voxel space; extinction per unit of length ([`MediaField::unit_m`] metres of display space), colours
//! linear.

use super::bricks::{BrickContent, Bricks, LayerAppearance, LayerMap, MIXED};
use super::horizons::FieldHorizons;
use super::isosurface::{FieldIsosurface, StratigraphicDepth};
use super::medium::{FieldMedium, Zone};
use super::phong::Lit;
use super::preparation::Preparations;
use super::samples::NO_DATA_BELOW;
use super::table::{FunctionTable, extinction};
use super::{EmptySpace, Faces, IsosurfaceSource, Media, Phong, Scope, Shading, white_ramp};
use crate::camera::View;
use crate::error::RenderError;
use crate::inputs::{Inputs, NamedVolume};
use glam::{Mat3, Vec3};
use model::{Region, StructuralModel};
use ttf::TtfTables;

/// The optical properties of a point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Matter {
    /// Extinction per unit of length; 0: the point is transparent.
    pub extinction: f32,
    /// Linear colour, shaded by Phong's model if the scene asks for it.
    pub colour: Vec3,
    /// Linear emitted light.
    pub emission: Vec3,
}

/// The media of a scene, with names resolved.
pub struct MediaField<'a> {
    /// The media; those of the surroundings first.
    pub media: Vec<FieldMedium<'a>>,
    /// Horizons shown by their leaves.
    pub horizons: Option<FieldHorizons<'a>>,
    /// Isosurfaces.
    pub isosurfaces: Vec<FieldIsosurface<'a>>,
    /// Bricks for empty-space skipping.
    pub bricks: Bricks,
    /// The shading.
    pub shading: Shading,
    /// Which faces stop rays.
    pub faces: Faces,
    /// Where media are visible.
    pub scope: Scope,
    /// Distance that counts as near a horizon, voxels.
    pub reach: f32,
    /// Samples per unit of length.
    pub samples_per_unit: f32,
    /// Unit of length, m of display space.
    pub unit_m: f32,
    /// Linear map from voxel to display space.
    pub display_from_voxel: Mat3,
    /// Map from voxel covectors to display covectors.
    pub display_normal_from_voxel: Mat3,
    /// Direction to the light in display space, unit.
    pub light: Vec3,
    model: Option<&'a StructuralModel>,
    depths: Option<StratigraphicDepth<'a>>,
}

impl<'a> MediaField<'a> {
    /// The media of a scene; `None` if it has none.
    ///
    /// # Errors
    /// Functions that cannot be evaluated; unknown volumes; horizons without candidates; surfaces of k'
    /// without an interpretation.
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
        let mut resolve = |name: &str, function: &ttf::RgbaFunction, zone: Zone| {
            function.validate(&format!("the medium `{name}`"))?;
            let volume = NamedVolume::find(inputs.volumes, name)?;
            if volume.volume.whole().is_none() {
                return Err(RenderError::ONLY_A_PART);
            }
            let prepared = kept.of(inputs.data_key, &volume);
            Ok::<_, RenderError>(FieldMedium::new(volume, prepared, FunctionTable::new(function), zone))
        };
        let model = inputs.model;
        let mut resolved = Vec::new();
        let zones = [(&media.surroundings, Zone::Surroundings), (&media.cut_outs, Zone::CutOut)];
        for (medium, zone) in zones.into_iter().flat_map(|(list, zone)| list.iter().map(move |m| (m, zone))) {
            let mut made = resolve(&medium.volume, &medium.function, zone)?;
            made.layers = LayerAppearance::new(medium, tables, model, ground_is_shown);
            resolved.push(made);
        }
        let depths = match (inputs.model, inputs.param) {
            (Some(model), Some(param)) => Some(StratigraphicDepth { model, param }),
            _ => None,
        };
        let isosurfaces = media.isosurfaces.iter().map(|surface| {
            let medium = match &surface.of {
                IsosurfaceSource::Volume(name) => Some(resolve(name, &white_ramp(1.0, 0.0), Zone::Surroundings)?),
                IsosurfaceSource::Depth if depths.is_none() => return Err(RenderError::NO_DEPTHS),
                IsosurfaceSource::Depth => None,
            };
            Ok(FieldIsosurface::new(surface, medium))
        });
        let isosurfaces = isosurfaces.collect::<Result<_, _>>()?;
        let horizons = match (media.horizons.is_empty(), inputs.candidates) {
            (true, _) => None,
            (false, None) => return Err(RenderError::NO_CANDIDATES),
            (false, Some(candidates)) => Some(FieldHorizons::new(&media.horizons, candidates, &mut resolve)?),
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

    /// The single medium, if the scene has no horizons, isosurfaces or further media, and layers do not
    /// change that medium.
    pub(crate) fn only_medium(&self) -> Option<&FieldMedium<'a>> {
        let [medium] = &self.media[..] else { return None };
        let only = self.horizons.is_none() && self.isosurfaces.is_empty() && medium.layers.is_none();
        only.then_some(medium)
    }

    fn fill_bricks(&self, samples: [usize; 3], empty_space: EmptySpace) -> Bricks {
        let layered = self.media.iter().any(|m| m.layers.is_some())
            || self.isosurfaces.iter().any(|surface| surface.medium.is_none());
        let map = self.model.filter(|_| layered).map(LayerMap::new);
        Bricks::new(samples, |brick| {
            let layer = map.as_ref().map_or(MIXED, |map| map.layer(brick));
            let [low, high] = Bricks::corners(brick);
            let near = self.horizons.as_ref().map(|h| h.nearest(low, high));
            let shows = |zone: Zone| {
                empty_space == EmptySpace::Sampled
                    || near.is_some_and(|near| near.shows)
                    || self.isosurfaces.iter().any(|surface| surface.shows(low, high, layer))
                    || (self.scope != Scope::NearHorizons || near.is_some_and(|near| near.distance <= self.reach + 1.0))
                        && self.media.iter().any(|m| m.zone == zone && m.shows(low, high, layer))
            };
            BrickContent { shows: [shows(Zone::Surroundings), shows(Zone::CutOut)], layer }
        })
    }

    /// The optical properties of a point in a zone, in a brick with this word. `towards` is the unit
    /// direction to the viewer in display space.
    #[inline(always)]
    pub fn at(&self, p: Vec3, zone: Zone, word: u32, towards: Vec3) -> Matter {
        if self.media.len() == 1 && self.horizons.is_none() && self.isosurfaces.is_empty() {
            let medium = &self.media[0];
            return if medium.zone == zone { self.of_medium(medium, p, word, towards) } else { Matter::default() };
        }
        self.mixed(p, zone, word, towards)
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
        if let Some(appearance) = &medium.layers {
            let [r, g, b, opacity] = self.layer_entry(appearance, p, word);
            if appearance.colours {
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

    /// The appearance of the layer at a point. The layer is known for the brick, or looked up in the model; of a layer
    /// that is divided by depth, k there tells which part it is.
    fn layer_entry(&self, appearance: &LayerAppearance, p: Vec3, word: u32) -> [f32; 4] {
        let hint = (word >> 16 & 255) as u8;
        let layer = match (hint, self.model) {
            (MIXED, Some(model)) => usize::from(model.region_at(p).layer),
            (hint, _) => usize::from(hint),
        };
        let entry = *appearance.entries.get(layer).expect("every layer of the model has an appearance");
        let Some(StratigraphicDepth { model, param }) = self.depths.filter(|_| !appearance.shades[layer].is_empty())
        else {
            return entry;
        };
        let region = Region { layer: layer as u16, block: model.block_at(p) };
        let [r, g, b] = appearance.colour(layer, param.lookup_in(model, p, region).0.k);
        [r, g, b, entry[3]]
    }

    /// Several media, horizons and isosurfaces at a point.
    fn mixed(&self, p: Vec3, zone: Zone, word: u32, towards: Vec3) -> Matter {
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
            for medium in self.media.iter().filter(|m| m.zone == zone) {
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

    /// A colour shaded by Phong's model.
    fn lit(&self, phong: Phong, gradient: Vec3, colour: Vec3, towards: Vec3) -> Vec3 {
        Lit::new(phong, self.light, towards).on(self.display_normal_from_voxel * gradient, colour)
    }
}

/// The extinction whose opacity is that of `kappa` multiplied by a factor.
fn thinned(kappa: f32, opacity: f32) -> f32 {
    match opacity {
        1.0 => kappa,
        0.0 => 0.0,
        opacity => extinction((1.0 - (-kappa).exp()) * opacity),
    }
}
