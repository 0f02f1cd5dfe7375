//! Sections along the lattice: amplitudes as a raster, horizons and faults as lines over it.
//!
//! The raster has one pixel a sample; lines are in its coordinates, voxel from the section's first sample: s to the right, t down. An
//! inline runs along crosslines, a crossline along inlines, a slice has inlines to the right and crosslines down.

use super::fence::{self, FenceWish};
use super::wishes::{Wished, Wishes};
use super::{Event, Outbox, Rocks};
use crate::state::SliceKind;
use glam::{DVec2, DVec3, Vec3};
use image::{Rgba, RgbaImage};
use model::section::{LineKind, LineQuality, Section, SectionPlane};
use project::picture::load::Loaded;
use render::leaves;
use render::{Candidates, FaceData, NamedVolume, VoxelBox};
use std::collections::HashMap;
use std::sync::PoisonError;

/// Where there are no data.
const NO_DATA: Rgba<u8> = Rgba([0xdc, 0xdc, 0xda, 0xff]);
/// Colours that a value's range is divided into.
const COLOURS: usize = 1024;

/// A section to be seen.
#[derive(Clone)]
pub struct SliceWish {
    /// Along what.
    pub kind: SliceKind,
    /// Where, voxel.
    pub at: f64,
    /// What it is cut from.
    pub rocks: Rocks,
    /// What it shows; amplitudes where there are no candidates in memory.
    pub show: FaceData,
}

/// A line of a section.
#[derive(Debug, Clone, PartialEq)]
pub struct SliceLine {
    /// Horizon or fault, by its index.
    pub kind: LineKind,
    /// How sure it is.
    pub quality: LineQuality,
    /// (s, t) from the section's corner.
    pub points: Vec<DVec2>,
}

/// A section.
pub struct SlicePicture {
    /// Along what.
    pub kind: SliceKind,
    /// Where, voxel.
    pub at: f64,
    /// A pixel a sample, s to the right, t down.
    pub image: RgbaImage,
    /// Horizons and faults.
    pub lines: Vec<SliceLine>,
}

/// What is to be cut: the latest of each kind.
#[derive(Default)]
struct Wanted {
    slices: HashMap<SliceKind, SliceWish>,
    fence: Option<FenceWish>,
}

/// What is cut next.
enum Next {
    Slice(SliceWish),
    Fence(FenceWish),
}

impl Wanted {
    fn take(&mut self) -> Option<Next> {
        let slice = SliceKind::ALL.into_iter().find_map(|kind| self.slices.remove(&kind));
        slice.map(Next::Slice).or_else(|| self.fence.take().map(Next::Fence))
    }
}

/// The thread that cuts, and the wishes it works on next.
pub struct Slices {
    wishes: Wishes<Wanted>,
}

impl Slices {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        Self {
            wishes: Wishes::start("sections", move |wished: &Wished<Wanted>| {
                while let Some(next) = wished.next(Wanted::take) {
                    outbox.send(match next {
                        Next::Slice(wish) => {
                            let loaded = wish.rocks.read().unwrap_or_else(PoisonError::into_inner);
                            Event::Sliced(cut(&loaded, wish.kind, wish.at, wish.show))
                        }
                        Next::Fence(wish) => {
                            let loaded = wish.rocks.read().unwrap_or_else(PoisonError::into_inner);
                            Event::Fenced(fence::cut(&loaded, &wish.corners, wish.show))
                        }
                    });
                }
            }),
        }
    }

    /// Cuts this next, instead of what was wished of its kind before.
    pub fn cut(&self, wish: SliceWish) {
        self.wishes.change(|wanted| drop(wanted.slices.insert(wish.kind, wish)));
    }

    /// Cuts this fence next, instead of another.
    pub fn cut_fence(&self, wish: FenceWish) {
        self.wishes.change(|wanted| wanted.fence = Some(wish));
    }
}

/// The plane of a section over the whole survey.
pub fn plane(kind: SliceKind, at: f64, size: [usize; 3]) -> SectionPlane {
    let high = VoxelBox::of_size(size).high();
    match kind {
        SliceKind::Inline => SectionPlane::inline(at, DVec3::ZERO, high),
        SliceKind::Crossline => SectionPlane::crossline(at, DVec3::ZERO, high),
        SliceKind::Slice => SectionPlane::slice(at, DVec3::ZERO, high),
    }
}

/// Cuts what is loaded.
pub fn cut(loaded: &Loaded, kind: SliceKind, at: f64, show: FaceData) -> SlicePicture {
    let plane = plane(kind, at, loaded.geometry.size());
    let [width, height] = plane.extent.map(|extent| extent.round() as u32 + 1);
    let (origin, s_axis, t_axis) = (plane.origin.as_vec3(), plane.s_axis.as_vec3(), plane.t_axis.as_vec3());
    let image = raster(loaded, [width, height], show, |s, t| origin + s_axis * s + t_axis * t);
    SlicePicture { kind, at, image, lines: lines_of(loaded, &plane) }
}

/// Where horizons and faults meet a plane.
pub(super) fn lines_of(loaded: &Loaded, plane: &SectionPlane) -> Vec<SliceLine> {
    let Some(rock) = &loaded.rock else { return Vec::new() };
    let section = Section::new(&rock.model, plane);
    let is_interpreted = |kind: LineKind| !matches!(kind, LineKind::Frame | LineKind::Fault { real: false, .. });
    let lines = section.lines.into_iter().filter(|line| is_interpreted(line.kind));
    lines.map(|line| SliceLine { kind: line.kind, quality: line.quality, points: line.points }).collect()
}

/// Amplitudes, or candidates over them, at the places of a raster's pixels; grey where there are no data.
pub(super) fn raster(loaded: &Loaded, size: [u32; 2], show: FaceData, place: impl Fn(f32, f32) -> Vec3) -> RgbaImage {
    let mut image = RgbaImage::from_pixel(size[0], size[1], NO_DATA);
    let colour = raw_colour(loaded);
    let shown = loaded.candidates.as_ref().filter(|_| show != FaceData::Rock);
    let candidates = shown.map(|shown| shown.candidates());
    for (s, t, pixel) in image.enumerate_pixels_mut() {
        let point = place(s as f32, t as f32);
        if let Some(found) = colour(point) {
            *pixel = found;
        }
        if let Some(candidates) = &candidates {
            lay_candidates(pixel, candidates, point, show);
        }
    }
    image
}

/// The colour of the raw data at a place; none where there are no data.
fn raw_colour(loaded: &Loaded) -> impl Fn(Vec3) -> Option<Rgba<u8>> + '_ {
    let raw = loaded.raw.as_ref();
    let found = raw.and_then(|raw| Some((raw, loaded.volumes.iter().find(|volume| volume.name == raw.volume)?)));
    let baked = found.map(|(raw, volume)| {
        let [low, high] = raw.function.domain;
        let scale = (COLOURS - 1) as f32 / (high - low).max(f32::MIN_POSITIVE);
        let volume = NamedVolume { name: &volume.name, volume: &volume.volume, covers: volume.covers };
        (volume, raw.function.bake(COLOURS), low, scale)
    });
    move |point| {
        let (volume, colours, low, scale) = baked.as_ref()?;
        let value = volume.sample(point);
        let colour = colours[((value - low) * scale).clamp(0.0, (COLOURS - 1) as f32) as usize];
        (!value.is_nan()).then(|| Rgba([colour[0], colour[1], colour[2], 1.0].map(|c| (c * 255.0 + 0.5) as u8)))
    }
}

/// A leaf in its colour over the raw data, or the distance in its place.
fn lay_candidates(pixel: &mut Rgba<u8>, candidates: &Candidates, point: Vec3, show: FaceData) {
    let distance = candidates.distance_at(point);
    let byte = |channel: f32| (channel * 255.0 + 0.5) as u8;
    if show == FaceData::Distance {
        let tone = byte(leaves::distance_tone(distance));
        *pixel = Rgba([tone, tone, tone, 0xff]);
        return;
    }
    let group = candidates.group(candidates.leaf_at(point));
    let cover = leaves::cover(distance);
    if group != 0 && cover > 0.0 {
        let colour = leaves::leaf_colour(group).to_array().map(byte);
        for (channel, leaf) in colour.into_iter().enumerate() {
            let below = f32::from(pixel.0[channel]);
            pixel.0[channel] = (below + (f32::from(leaf) - below) * cover + 0.5) as u8;
        }
    }
}
