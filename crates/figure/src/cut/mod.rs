//! Sections as data: a raster of amplitudes or candidates, and the lines of horizons and faults over it.
//!
//! The raster has one pixel a sample; lines are in its coordinates (s, t), voxels from the section's first
//! sample: s to the right, t down. An inline runs along crosslines, a crossline along inlines, a slice has
//! inlines to the right and crosslines down. A fence runs along a line of straight legs; s counts voxels
//! along it.

mod fence;
mod kind;
mod pixels;
pub mod traces;

pub(crate) use fence::station_of;
pub use fence::{FenceCut, legs, length_m, place, stations};
pub use kind::{SectionKind, value_at};

use glam::{DVec2, DVec3};
use image::RgbaImage;
use model::section::{LineKind, LineQuality, Section, SectionPlane};
use render::{FaceData, Inputs, VoxelBox};
use ttf::RawColour;

/// What sections are cut from. Cheap to copy.
#[derive(Clone, Copy)]
pub struct SectionSource<'a> {
    /// Geometry, model, volumes and candidates, as renderers take them.
    pub data: Inputs<'a>,
    /// The volume that is shown, and its colours.
    pub raw: Option<&'a RawColour>,
}

/// A line of a horizon or a fault on a section.
#[derive(Debug, Clone, PartialEq)]
pub struct CutLine {
    /// Horizon or fault, by its index.
    pub kind: LineKind,
    /// How sure it is.
    pub quality: LineQuality,
    /// (s, t) from the section's corner.
    pub points: Vec<DVec2>,
}

/// A section along the lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionCut {
    /// Along what.
    pub kind: SectionKind,
    /// Where, voxel.
    pub at: f64,
    /// A pixel a sample, s to the right, t down.
    pub image: RgbaImage,
    /// Horizons and faults.
    pub lines: Vec<CutLine>,
}

impl SectionCut {
    /// Cuts a section over the whole survey; `show` says what of the candidates lies over the amplitudes.
    ///
    /// ```
    /// use figure::cut::{SectionCut, SectionKind, SectionSource};
    /// use render::{FaceData, Inputs, NamedVolume};
    /// use survey::{SurveyGeometry, VerticalUnit, Volume};
    /// use ttf::{ColourMap, RawColour, RgbaFunction};
    ///
    /// // Amplitude 1 throughout, white at 1.
    /// let geometry = SurveyGeometry::regular([4, 5, 6], 25.0, 4.0, VerticalUnit::Milliseconds);
    /// let volume = Volume::filled([4, 5, 6], 1.0f32);
    /// let volumes = [NamedVolume::whole("seismic", &volume)];
    /// let raw = RawColour::new("seismic", RgbaFunction::over(ColourMap::Grey, [1.0, 2.0]));
    /// let source = SectionSource { data: Inputs::raw(&geometry, &volumes), raw: Some(&raw) };
    /// let inline = SectionCut::new(&source, SectionKind::Inline, 2.0, FaceData::Rock);
    /// assert_eq!(inline.image.dimensions(), (5, 6));
    /// assert!(inline.image.pixels().all(|pixel| pixel.0 == [255; 4]));
    /// ```
    pub fn new(source: &SectionSource, kind: SectionKind, at: f64, show: FaceData) -> Self {
        let plane = kind.plane(at, source.data.geometry.size());
        let [width, height] = plane.extent.map(|extent| extent.round() as u32 + 1);
        let (origin, s_axis, t_axis) = (plane.origin.as_vec3(), plane.s_axis.as_vec3(), plane.t_axis.as_vec3());
        let image = pixels::raster(source, [width, height], show, |s, t| origin + s_axis * s + t_axis * t);
        Self { kind, at, image, lines: lines_of(source, &plane) }
    }
}

/// Where horizons and faults of the model meet a plane: what was interpreted, not what merely bounds it.
fn lines_of(source: &SectionSource, plane: &SectionPlane) -> Vec<CutLine> {
    let Some(model) = source.data.model else { return Vec::new() };
    let section = Section::new(model, plane);
    let is_interpreted = |kind: LineKind| !matches!(kind, LineKind::Frame | LineKind::Fault { real: false, .. });
    let lines = section.lines.into_iter().filter(|line| is_interpreted(line.kind));
    lines.map(|line| CutLine { kind: line.kind, quality: line.quality, points: line.points }).collect()
}

/// The last voxel of a survey of this size.
fn last_voxel(size: [usize; 3]) -> DVec3 {
    VoxelBox::of_size(size).high()
}
