//! What a picture shows, as one declarative value. It is written to and read from TOML, and every part has a
//! default.
//!
//! A [`Scene`] does not say where data come from; [`crate::Inputs`] hold those. Positions are in voxels (x =
//! inline index, y = crossline index, z = sample index downwards), line widths and image sizes in pixels.

use crate::camera::{Camera, View};
use crate::error::SceneError;
use crate::leaves::FaceData;
use crate::media::{Faces, Media};
use crate::outline::Outlines;
use crate::visible::Solid;
use crate::wells::WellStyle;
use serde::{Deserialize, Serialize};
use survey::SurveyGeometry;
use survey::block::{CutShape, CutShapeError, MAX_BODIES, MAX_PLANES, VoxelBox};
use ttf::{Colour, Preset, RawColour};

/// Largest image side, pixels.
pub(crate) const MAX_SIDE_PX: u32 = 32_768;
/// Largest number of samples per pixel along one axis.
pub(crate) const MAX_SAMPLES: u32 = 16;
/// Largest number of cut-outs in a scene.
pub(crate) const MAX_CUT_OUTS: usize = 16;

/// A picture of a block.
///
/// ```
/// let scene: render::Scene = toml::from_str("size_px = [800, 600]\n[camera]\nelevation_deg = 40.0").unwrap();
/// assert_eq!((scene.size_px, scene.camera.elevation_deg), ([800, 600], 40.0));
/// assert_eq!(scene.exaggeration, 1.0);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Pixels across and down. Default 1600 × 1200.
    pub size_px: [u32; 2],
    /// Samples per pixel along each axis, averaged as sRGB-encoded values. Default 3, so 9 per pixel.
    pub samples: u32,
    /// Vertical exaggeration of the display. It does not change the parameterization. Default 1.
    pub exaggeration: f64,
    /// 0 = illustrative … 1 = raw (P-illus 4.3, 5.2). Default 0.
    pub blend: f32,
    /// Factor on every texture frequency (P-illus 4.2). Default 1.
    pub global_frequency: f32,
    /// What patterns are fixed to while one zooms. Default the rock.
    pub pattern_size: PatternSize,
    /// Whether this is one of many pictures between which one zooms: then patterns that are fixed to the paper dissolve
    /// from one size into the next. A single picture has the nearer size.
    #[serde(skip)]
    pub in_motion: bool,
    /// How flat coordinates are looked up. Default exact.
    pub lookup: Lookup,
    /// How colours are printed. Default as they are.
    #[serde(skip_serializing_if = "Preset::is_colour")]
    pub preset: Preset,
    /// Colour behind the block. Default white; [`Background::Transparent`] leaves the pixels empty.
    pub background: Background,
    /// Darkening of the side faces on the right, from 0 (unlit) to 0.5. Default 0.
    pub face_tone: f32,
    /// The part of the survey that is shown. Absent: all of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roaming_box: Option<VoxelBox>,
    /// The camera.
    pub camera: Camera,
    /// The ground as relief of the topmost horizon. Absent: the block has a flat top.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// Water over the ground, up to its level or the block's top; figures draw it. Absent: air.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub water: Option<Water>,
    /// The volume that is shown as raw data, and its colours. Absent: those of the transfer functions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raw: Option<RawColour>,
    /// Lines drawn over the faces.
    pub outlines: Outlines,
    /// Boxes cut out of the roaming box.
    pub cut_outs: Vec<VoxelBox>,
    /// Cut-outs of other shapes: fences, outlines, oblique planes.
    pub cut_shapes: Vec<CutShape>,
    /// What faces show. Default: the rock.
    pub face_data: FaceData,
    /// Level of the surface trees, counted up from the leaves, at which leaves are grouped for colouring. The
    /// caller groups the candidates accordingly ([`crate::CandidateVolume::groups`]). Default 0: each leaf by
    /// itself.
    pub tree_level: u32,
    /// How wells are drawn.
    pub wells: WellStyle,
    /// Wells that are not drawn, by name. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hidden_wells: Vec<String>,
    /// The media: volume rendering in the cut-outs and around them.
    pub media: Media,
    /// What is changed about the labels of figures that show it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<LabelChange>,
}

/// A translucent body of water between the ground and a level, or the top of the block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Water {
    /// Its colour. Default blue.
    pub colour: Colour,
    /// Its opacity, from 0 to 1. Default 0.3.
    pub opacity: f32,
    /// The sample at which its surface lies, where ground rises above it. Absent: the block's top.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
}

impl Default for Water {
    fn default() -> Self {
        Self { colour: Colour::new(0x3f, 0x8c, 0xc4), opacity: 0.3, level: None }
    }
}

/// What is changed about a label of a figure: where it stands and how it looks.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LabelChange {
    /// What it names: a layer, a fault, a well, a top as `WELL TOP`; or `legend`, `scale bar`, `axes`, `title` and so on.
    pub label: String,
    /// How far it is moved to the right and down, mm on paper. Default 0.
    #[serde(default)]
    pub moved_mm: [f64; 2],
    /// Size of its letters, points. Absent: as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_pt: Option<f64>,
    /// Colour of its letters. Absent: as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// Whether it is left out. Default not.
    #[serde(default)]
    pub is_hidden: bool,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            size_px: [1600, 1200],
            samples: 3,
            exaggeration: 1.0,
            blend: 0.0,
            global_frequency: 1.0,
            pattern_size: PatternSize::default(),
            in_motion: false,
            lookup: Lookup::Exact,
            preset: Preset::Colour,
            background: Background::Colour(Colour::WHITE),
            face_tone: 0.0,
            roaming_box: None,
            camera: Camera::default(),
            ground: None,
            water: None,
            raw: None,
            outlines: Outlines::default(),
            cut_outs: Vec::new(),
            cut_shapes: Vec::new(),
            face_data: FaceData::Rock,
            tree_level: 0,
            wells: WellStyle::default(),
            hidden_wells: Vec::new(),
            media: Media::default(),
            labels: Vec::new(),
        }
    }
}

/// How flat coordinates are looked up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lookup {
    /// The region comes from the interpretation itself and the coordinates from the grid of that region:
    /// crisp at any zoom.
    #[default]
    Exact,
    /// The paper's packed volume with extrapolated corners (P-illus 3.3, 3.4), kept as the baseline.
    Packed,
}

/// What is behind the block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Background {
    /// Nothing: alpha 0.
    Transparent,
    /// One colour.
    #[serde(untagged)]
    Colour(Colour),
}

impl Background {
    /// Straight RGBA in [0, 1], sRGB-encoded.
    pub fn rgba(self) -> [f32; 4] {
        match self {
            Self::Transparent => [0.0; 4],
            Self::Colour(colour) => {
                let [r, g, b] = colour.to_unit();
                [r, g, b, 1.0]
            }
        }
    }
}

/// The relief of the topmost horizon. Everything above it is air (P-illus 5).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Ground {
    /// Strength of the hill shading, which distinguishes slopes: 0 (none) … 1. Default 0.35, which is mild.
    pub hill_shade: f32,
    /// Bearing from which the light comes, degrees clockwise from north, relative to the camera: 0 = from
    /// behind the block. Default −45: from the upper left, as is usual for maps.
    pub light_deg: f32,
    /// Opacity of the relief. If it is below 1, the back faces of cut-outs and the media below the ground are
    /// visible through it, but not the inside of the rock. Default 1.
    pub opacity: f32,
}

impl Default for Ground {
    fn default() -> Self {
        Self { hill_shade: 0.35, light_deg: -45.0, opacity: 1.0 }
    }
}

impl Scene {
    /// The part of the survey that is shown.
    pub fn box_in(&self, geometry: &SurveyGeometry) -> VoxelBox {
        self.roaming_box.unwrap_or_else(|| VoxelBox::of_size(geometry.size()))
    }

    /// The camera, fitted to the block and the image. The scene must be valid.
    pub fn view(&self, geometry: &SurveyGeometry) -> View {
        View::new(&self.camera, geometry, &self.box_in(geometry), self.exaggeration, self.size_px)
    }

    /// The same with its own colours as its preset prints them. Those of the layers follow from the transfer functions.
    #[must_use]
    pub fn printed(mut self) -> Self {
        let preset = self.preset;
        let outlines = &mut self.outlines;
        for stroke in [&mut outlines.edges, &mut outlines.horizons, &mut outlines.faults] {
            stroke.colour = preset.line(stroke.colour);
        }
        for colour in [&mut self.wells.colour, &mut self.wells.top_colour] {
            *colour = preset.line(*colour);
        }
        self.raw = self.raw.map(|raw| raw.printed(preset));
        if preset == Preset::BlackAndWhite {
            // Paper has no tone.
            self.face_tone = 0.0;
        }
        self
    }

    /// Whether the edges at the back of the block are drawn behind the media: if the whole box is rendered as
    /// a volume.
    pub(crate) fn has_back_edges(&self) -> bool {
        self.media.faces == Faces::None && self.outlines.edges.width_px > 0.0
    }

    /// Whether a well of this name is not drawn.
    pub fn hides_well(&self, name: &str) -> bool {
        self.hidden_wells.iter().any(|hidden| hidden == name)
    }

    /// Whether anything is cut out.
    pub fn has_cut_outs(&self) -> bool {
        !self.cut_outs.is_empty() || !self.cut_shapes.is_empty()
    }

    /// The roaming box less what is cut out. A shape that cannot be drawn ([`Scene::validate`]) is left out.
    pub fn solid(&self, geometry: &SurveyGeometry) -> Solid {
        let roaming_box = self.box_in(geometry);
        let boxes: Vec<VoxelBox> = self.cut_outs.iter().filter_map(|cut| cut.intersection(&roaming_box)).collect();
        let metric = geometry.metric_from_voxel();
        let voxel_m = [metric.x_axis.length(), metric.y_axis.length()];
        let shapes = self.cut_shapes.iter().enumerate();
        let shapes = shapes.flat_map(|(n, shape)| shape.bodies(&roaming_box, voxel_m, n).unwrap_or_default());
        let mut solid = Solid::of_boxes(&roaming_box, &boxes);
        solid.cut_outs.extend(shapes);
        solid
    }

    /// Checks that the scene can be drawn.
    ///
    /// # Errors
    /// The first [`SceneError`] found.
    pub fn validate(&self, geometry: &SurveyGeometry) -> Result<(), SceneError> {
        let [width, height] = self.size_px;
        if [width, height].iter().any(|side| !(1..=MAX_SIDE_PX).contains(side)) {
            return Err(SceneError::ImageSize { width, height, limit: MAX_SIDE_PX });
        }
        let number = SceneError::check_range;
        number("the number of samples per pixel", f64::from(self.samples), 1.0, f64::from(MAX_SAMPLES))?;
        number("the vertical exaggeration", self.exaggeration, 1e-3, 1e3)?;
        number("the blend", f64::from(self.blend), 0.0, 1.0)?;
        number("the global frequency", f64::from(self.global_frequency), 1e-4, 1e4)?;
        number("the face tone", f64::from(self.face_tone), 0.0, 0.5)?;
        if let Some(ground) = self.ground {
            number("the hill shading", f64::from(ground.hill_shade), 0.0, 1.0)?;
            number("the ground's opacity", f64::from(ground.opacity), 0.0, 1.0)?;
            number("the light's bearing", f64::from(ground.light_deg), -3600.0, 3600.0)?;
        }
        if let Some(water) = self.water {
            number("the water's opacity", f64::from(water.opacity), 0.0, 1.0)?;
        }
        for label in &self.labels {
            let [right, down] = label.moved_mm;
            number("the way that a label is moved, mm", right.hypot(down), 0.0, 1e4)?;
            number("the size of a label's letters", label.size_pt.unwrap_or(8.0), 1.0, 200.0)?;
        }
        self.camera.validate()?;
        self.outlines.validate()?;
        self.media.validate()?;
        self.wells.validate()?;
        self.validate_boxes(geometry)
    }

    fn validate_boxes(&self, geometry: &SurveyGeometry) -> Result<(), SceneError> {
        let roaming_box = self.box_in(geometry);
        let [min, max] = [roaming_box.min, roaming_box.max];
        if !roaming_box.is_solid() {
            return Err(SceneError::EmptyBox { what: "the roaming box".into(), min, max });
        }
        let last = VoxelBox::of_size(geometry.size()).max;
        if (0..3).any(|axis| min[axis] < 0.0 || max[axis] > last[axis]) {
            return Err(SceneError::OutsideSurvey { min, max, last });
        }
        if self.cut_outs.len() > MAX_CUT_OUTS {
            return Err(SceneError::TooManyCutOuts { found: self.cut_outs.len(), limit: MAX_CUT_OUTS });
        }
        for (index, cut) in self.cut_outs.iter().enumerate() {
            if !cut.is_solid() {
                return Err(SceneError::EmptyBox {
                    what: format!("cut-out {}", index + 1),
                    min: cut.min,
                    max: cut.max,
                });
            }
            if cut.intersection(&roaming_box).is_none() {
                return Err(SceneError::CutOutOutside {
                    index: index + 1,
                    min: cut.min,
                    max: cut.max,
                    box_min: min,
                    box_max: max,
                });
            }
        }
        for (n, shape) in self.cut_shapes.iter().enumerate() {
            let refused = |error: CutShapeError| SceneError::CutShape { index: n + 1, reason: error.to_string() };
            shape.validate(&roaming_box).map_err(refused)?;
        }
        let bodies = self.solid(geometry).cut_outs;
        let planes = bodies.iter().map(|body| body.planes.len()).sum::<usize>();
        if bodies.len() > MAX_BODIES || planes > MAX_PLANES {
            return Err(SceneError::CutShape {
                index: self.cut_shapes.len(),
                reason: format!(
                    "all cut-outs together have {} parts of {planes} planes, more than the {MAX_BODIES} of {MAX_PLANES} \
                     that fit; use fewer points or smaller curves",
                    bodies.len()
                ),
            });
        }
        Ok(())
    }
}

/// What a pattern is fixed to while one zooms.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PatternSize {
    /// To the rock: a pattern grows with the block.
    #[default]
    Rock,
    /// To the paper: a pattern keeps the size that it has where the whole survey fits the picture.
    Paper,
}
