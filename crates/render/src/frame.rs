//! A scene and its inputs, checked and resolved: what both renderers start from.

use crate::camera::View;
use crate::error::RenderError;
use crate::inputs::{Inputs, NamedVolume};
use crate::scene::Scene;
use crate::visible::Solid;
use glam::Vec3;
use ttf::RawColour;

/// Everything a picture needs, with names resolved.
pub(crate) struct Frame<'a> {
    pub scene: &'a Scene,
    pub view: View,
    pub solid: Solid,
    pub raw: Option<(&'a RawColour, NamedVolume<'a>)>,
}

impl<'a> Frame<'a> {
    /// Checks the scene against the inputs.
    pub fn new(scene: &'a Scene, inputs: &Inputs<'a>) -> Result<Self, RenderError> {
        scene.validate(inputs.geometry)?;
        let raw = match &scene.raw {
            None => None,
            Some(raw) => {
                raw.function.validate(&format!("the colours of `{}`", raw.volume))?;
                Some((raw, find(inputs.volumes, &raw.volume)?))
            }
        };
        Ok(Self {
            scene,
            view: scene.view(inputs.geometry),
            solid: Solid::new(&scene.box_in(inputs.geometry), &scene.cuts_in(inputs.geometry)),
            raw,
        })
    }

    /// Straight RGBA of the raw data at a voxel position.
    pub fn raw_at(&self, p: Vec3) -> [f32; 4] {
        let Some((raw, volume)) = &self.raw else { return [0.5, 0.5, 0.5, 1.0] };
        let value = volume.sample(p);
        match raw.no_data {
            Some(colour) if value.is_nan() => {
                let [r, g, b] = colour.to_unit();
                [r, g, b, 1.0]
            }
            _ => raw.function.evaluate(value),
        }
    }
}

/// The volume of that name.
fn find<'a>(volumes: &'a [NamedVolume<'a>], name: &str) -> Result<NamedVolume<'a>, RenderError> {
    volumes.iter().find(|v| v.name == name).copied().ok_or_else(|| RenderError::UnknownVolume {
        name: name.to_owned(),
        present: volumes.iter().map(|v| v.name.to_owned()).collect(),
    })
}
