//! The default view of a project, and the techniques of drawing.

use crate::document::Document;
use crate::error::{Noun, ProjectError};
use crate::styles;
use figure::style::horizon_colour;
use render::media::{Colouring, LayerOpacity, MediumColour, white_ramp};
use render::{
    Background, FaceData, Faces, Ground, Interleaved, Isosurface, IsosurfaceSource, Media, Medium, Occlusion, Outlines,
    Phong, PickedHorizon, Scene, Scope, Shading, Stroke,
};
use survey::Progress;
use ttf::{Colour, ColourMap, RgbaFunction, RgbaStop};

/// The scene of that name; without a name the project's first scene, otherwise the default view.
///
/// # Errors
/// There is no such scene, or no survey geometry to draw in.
pub fn choose(document: &Document, name: Option<&str>) -> Result<Scene, ProjectError> {
    match (name, document.scenes.first()) {
        (Some(name), _) => {
            let index = document.position(Noun::Scene, name)?;
            Ok(document.scenes[index].scene.clone())
        }
        (None, Some(first)) => Ok(first.scene.clone()),
        (None, None) => default_view(document),
    }
}

/// A three-quarter view with the nearest corner cut off, exaggerated so that flat surveys look like blocks, with the
/// topmost of several horizons as ground. Without a volume the view is illustrative, without horizons it shows raw
/// data.
///
/// # Errors
/// [`ProjectError::NoGeometry`].
pub fn default_view(document: &Document) -> Result<Scene, ProjectError> {
    let geometry = document.frame()?;
    let mut scene = Scene::default();
    let [inlines, crosslines, samples] = geometry.size().map(|count| count.saturating_sub(1).max(1) as f64);
    let width_m = (geometry.inline_vector.length() * inlines).max(geometry.crossline_vector.length() * crosslines);
    let height_m = geometry.sample_m() * samples;
    scene.exaggeration = whole_exaggeration(TARGET_HEIGHT * width_m / height_m);
    if document.horizons.is_empty() {
        scene.blend = 1.0;
    } else {
        // With a single horizon the layer above it is half of what there is to see.
        let has_ground = document.horizons.len() > 1 || document.restored.is_some();
        scene.ground = has_ground.then(Ground::default);
        let block = scene.box_in(geometry);
        let corner = scene.view(geometry).nearest_corner(&block);
        scene.cut_outs = vec![block.corner_cut(corner, CUT_SHARE)];
    }
    Ok(scene)
}

/// Fits a scene to what the project has: leaves are shown in the volume where no face shows them, and without a volume
/// nothing is blended, which is warned of.
///
/// # Errors
/// The scene shows nothing, or the project has no survey geometry.
pub fn prepare(document: &Document, scene: &mut Scene, progress: &Progress) -> Result<(), ProjectError> {
    leaves_in_volume(scene);
    if document.volumes.is_empty() && scene.blend > 0.0 {
        progress.warn("the project has no volume to blend with: the picture is fully illustrated");
        scene.blend = 0.0;
    }
    Ok(scene.validate(document.frame()?)?)
}

/// A scene in another project than the one that it was made for, such as a stage of a block's history: what shows
/// measured data is left out where there are none.
#[must_use]
pub fn of_what_is_there(document: &Document, scene: &Scene) -> Scene {
    if !document.volumes.is_empty() {
        return scene.clone();
    }
    let face_data = if scene.face_data.shows_candidates() { FaceData::Rock } else { scene.face_data };
    Scene { blend: 0.0, raw: None, media: Media::default(), face_data, ..scene.clone() }
}

/// A technique of drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Technique {
    /// Textured faces.
    Illustrate,
    /// Volume rendering, shaded by occlusion (P-horiz 5.1).
    Occlusion,
    /// Volume rendering, shaded by the gradients of the volume.
    Phong,
    /// Volume rendering without shading.
    Volume,
    /// Volume rendering, shaded in alternating stripes by gradients and by occlusion (P-horiz, figure 5).
    Interleaved,
}

/// The options of volume rendering, as far as they were given.
#[derive(Debug, Clone, PartialEq)]
pub struct VolumeRendering {
    /// The technique.
    pub technique: Option<Technique>,
    /// The volume.
    pub medium: Option<String>,
    /// Values up to this share of the volume's clip are transparent.
    pub clear_below: f32,
    /// Horizons shown in the volume.
    pub horizons: Vec<ShownHorizon>,
    /// Isosurfaces; with these and no volume named, the volume itself is not shown.
    pub isosurfaces: Vec<ShownIsosurface>,
    /// Where the volume is shown.
    pub scope: Scope,
}

/// A horizon of the interpretation, shown in a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownHorizon {
    /// Its name.
    pub name: String,
    /// Its colour; `None`: its own in the project.
    pub colour: Option<Colour>,
    /// Its opacity.
    pub opacity: f32,
    /// The light it gives off.
    pub emission: f32,
}

/// An isosurface of a volume or of k'.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownIsosurface {
    /// The source of the values.
    pub of: IsosurfaceSource,
    /// The value.
    pub value: f32,
    /// Its colour; `None`: the next default colour.
    pub colour: Option<Colour>,
    /// Its opacity.
    pub opacity: f32,
}

/// Default colours of isosurfaces.
const ISOSURFACE_COLOURS: [Colour; 3] =
    [Colour::new(0xd8, 0xb3, 0x65), Colour::new(0x5a, 0xb4, 0xac), Colour::new(0xc5, 0x7d, 0x8f)];

/// Background of volume rendering: white volumes need something darker behind them.
const BEHIND_VOLUMES: Colour = Colour::new(0x2c, 0x33, 0x3a);
/// Colour of the edges in front of that background.
const EDGES_OF_VOLUMES: Colour = Colour::new(0x9a, 0xa4, 0xad);

impl VolumeRendering {
    /// Applies the options to a scene.
    ///
    /// # Errors
    /// The project does not have this volume, or has none at all.
    pub fn change(&self, scene: &mut Scene, document: &Document) -> Result<(), ProjectError> {
        for shown in &self.horizons {
            let index = document.position(Noun::Horizon, &shown.name)?;
            let entry = &document.horizons[index];
            let own = entry.own_colour();
            let colour = horizon_colour(shown.colour.or(own), index);
            scene.media.horizons.push(PickedHorizon {
                name: Some(entry.name.clone()),
                opacity: shown.opacity,
                emission: shown.emission,
                ..PickedHorizon::of(Vec::new(), colour)
            });
        }
        for (n, shown) in self.isosurfaces.iter().enumerate() {
            if let IsosurfaceSource::Volume(name) = &shown.of {
                document.position(Noun::Volume, name)?;
            }
            scene.media.isosurfaces.push(Isosurface {
                of: shown.of.clone(),
                value: shown.value,
                colour: shown.colour.unwrap_or(ISOSURFACE_COLOURS[n % ISOSURFACE_COLOURS.len()]),
                opacity: shown.opacity,
                thickness: 1.0,
            });
        }
        if self.scope != Scope::Everywhere {
            scene.media.scope = self.scope;
        }
        let shading = match self.technique {
            Some(Technique::Occlusion) => Shading::Occlusion(Occlusion::default()),
            Some(Technique::Phong) => Shading::Phong(Phong::default()),
            Some(Technique::Volume) => Shading::Unshaded,
            Some(Technique::Interleaved) => Shading::Interleaved(Interleaved::default()),
            None | Some(Technique::Illustrate) => return self.fill_cut_outs(scene, document),
        };
        scene.media.shading = shading;
        scene.media.faces = Faces::None;
        scene.ground = None;
        if scene.background == Scene::default().background {
            scene.background = Background::Colour(BEHIND_VOLUMES);
            if scene.outlines.edges == Outlines::default().edges {
                scene.outlines.edges = Stroke { width_px: 1.4, colour: EDGES_OF_VOLUMES };
            }
        }
        let surfaces_alone = !scene.media.isosurfaces.is_empty() && self.medium.is_none();
        if self.medium.is_some() || scene.media.surroundings.is_empty() && !surfaces_alone {
            let raw = styles::raw_colour(document, self.medium.as_deref(), ColourMap::Grey, None)?;
            let [low, high] = raw.function.domain;
            let mut function = white_ramp(high, self.clear_below);
            if low >= 0.0 {
                function.domain = raw.function.domain;
            }
            let colour = MediumColour::Function;
            scene.media.surroundings =
                vec![Medium { volume: raw.volume, function, layers: LayerOpacity::Ignored, colour }];
        }
        Ok(())
    }

    /// Fills the cut-outs of an illustration with the volume in its raw colours; the larger its values, the more opaque
    /// it is.
    fn fill_cut_outs(&self, scene: &mut Scene, document: &Document) -> Result<(), ProjectError> {
        if self.technique == Some(Technique::Illustrate) {
            scene.media.faces = Faces::All;
        }
        // Surfaces of one colour have no shape without shading.
        let surfaces = !(self.horizons.is_empty() && self.isosurfaces.is_empty());
        if surfaces && scene.media.shading == Shading::Unshaded {
            scene.media.shading = Shading::Occlusion(Occlusion::default());
        }
        let Some(name) = &self.medium else { return Ok(()) };
        let mut raw = styles::raw_colour(document, Some(name), ColourMap::Seismics, None)?;
        if let Some(own) = document.style.raw.as_ref().filter(|own| own.volume == *name) {
            raw = own.clone();
        }
        let [low, high] = raw.function.domain;
        let clear = self.clear_below.max(0.0);
        let mut function = raw.function;
        function.stops = resampled(&function);
        for stop in &mut function.stops {
            let value = low + (high - low) * stop.at;
            let share = if low < 0.0 { value.abs() / high.max(-low) } else { stop.at };
            stop.opacity = ((share - clear) / (1.0 - clear)).clamp(0.0, 1.0);
        }
        let followed = document.style.layers.styles.iter().any(|style| style.opacity > 0.0);
        let layers = if followed { LayerOpacity::Followed } else { LayerOpacity::Ignored };
        scene.media.cut_outs = vec![Medium { volume: raw.volume, function, layers, colour: MediumColour::Function }];
        Ok(())
    }
}

/// If no face of rock shows leaves, the horizons shown in the volume are coloured by their leaves; without such
/// horizons all candidates are shown.
fn leaves_in_volume(scene: &mut Scene) {
    if scene.face_data != FaceData::Leaves || scene.media.faces != Faces::None {
        return;
    }
    let horizons = &mut scene.media.horizons;
    if horizons.is_empty() {
        horizons.push(PickedHorizon::of(Vec::new(), Colour::WHITE));
    }
    horizons.iter_mut().for_each(|horizon| horizon.colouring = Colouring::ByLeaf);
    scene.face_data = FaceData::Rock;
}

/// The stops of a function, with enough additional stops to change its opacity smoothly.
fn resampled(function: &RgbaFunction) -> Vec<RgbaStop> {
    const BETWEEN: usize = 32;
    let [low, high] = function.domain;
    let stop = |n: usize| {
        let at = n as f32 / BETWEEN as f32;
        let [r, g, b, opacity] = function.evaluate(low + (high - low) * at);
        let byte = |c: f32| (c * 255.0).round() as u8;
        RgbaStop { at, colour: Colour::new(byte(r), byte(g), byte(b)), opacity }
    };
    (0..=BETWEEN).map(stop).collect()
}

/// Ratio of the height of the drawn block to its longer side at which the exaggeration aims: a block, neither a tile
/// nor a tower.
const TARGET_HEIGHT: f64 = 0.45;
/// Shares of the block along inlines and crosslines that the default corner cut takes.
const CUT_SHARE: [f64; 2] = [0.45, 0.45];

/// The nearest round exaggeration: 1, 1.5, 2, 3, 4, 5, 8, 10 ..., never less than 1.
fn whole_exaggeration(wanted: f64) -> f64 {
    const STEPS: [f64; 10] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let decade = 10f64.powf(wanted.max(1.0).log10().floor());
    let ratio = wanted.max(1.0) / decade;
    let nearest = STEPS.into_iter().min_by(|a, b| (a / ratio).ln().abs().total_cmp(&(b / ratio).ln().abs()));
    decade * nearest.unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use survey::{SurveyGeometry, VerticalUnit};

    #[test]
    fn exaggerations_are_round() {
        for (wanted, said) in [(0.2, 1.0), (1.2, 1.0), (1.3, 1.5), (2.8, 3.0), (9.5, 10.0), (23.0, 25.0), (70.0, 80.0)]
        {
            assert_eq!(whole_exaggeration(wanted), said, "{wanted}");
        }
    }

    #[test]
    fn any_frame_has_a_valid_default_view() {
        for size in [[101, 101, 101], [2, 300, 2], [500, 3, 40]] {
            let geometry = SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds);
            let scene = default_view(&Document::empty(Some(geometry.clone()))).unwrap();
            scene.validate(&geometry).unwrap();
            assert_eq!(scene.blend, 1.0);
        }
        assert!(matches!(default_view(&Document::empty(None)), Err(ProjectError::NoGeometry)));
    }
}
