//! Sections along the lattice: amplitudes as a raster, horizons and faults as lines over it.
//!
//! The raster has one pixel a sample; lines are in its coordinates, voxel from the section's first sample: s to the right, t down. An
//! inline runs along crosslines, a crossline along inlines, a slice has inlines to the right and crosslines down.

use super::fence::{self, FenceWish};
use super::{Event, Outbox, Rocks, spawn};
use crate::app::state::SliceKind;
use crate::pipeline::Loaded;
use glam::{DVec2, DVec3, Vec3};
use image::{Rgba, RgbaImage};
use render::leaves;
use render::{Candidates, FaceData, NamedVolume, VoxelBox};
use std::collections::HashMap;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use survey::section::{LineKind, LineQuality, Section, SectionPlane};

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

#[derive(Default)]
struct Slot {
    wishes: HashMap<SliceKind, SliceWish>,
    fence: Option<FenceWish>,
    ended: bool,
}

/// The thread that cuts, and the wishes it works on next: the latest of each kind.
pub struct Slices {
    shared: Arc<(Mutex<Slot>, Condvar)>,
}

impl Slices {
    /// Starts the thread.
    pub fn start(outbox: Outbox) -> Self {
        let shared = Arc::new((Mutex::new(Slot::default()), Condvar::new()));
        let mine = shared.clone();
        spawn("sections", move || work(&mine, &outbox));
        Self { shared }
    }

    /// Cuts this next, instead of what was wished of its kind before.
    pub fn cut(&self, wish: SliceWish) {
        self.change(|slot| drop(slot.wishes.insert(wish.kind, wish)));
    }

    /// Cuts this fence next, instead of another.
    pub fn cut_fence(&self, wish: FenceWish) {
        self.change(|slot| slot.fence = Some(wish));
    }

    fn change(&self, change: impl FnOnce(&mut Slot)) {
        change(&mut self.shared.0.lock().unwrap_or_else(PoisonError::into_inner));
        self.shared.1.notify_one();
    }
}

impl Drop for Slices {
    fn drop(&mut self) {
        self.change(|slot| slot.ended = true);
    }
}

/// What is cut next.
enum Next {
    Slice(SliceWish),
    Fence(FenceWish),
}

fn work(shared: &(Mutex<Slot>, Condvar), outbox: &Outbox) {
    loop {
        let wish = {
            let mut slot = shared.0.lock().unwrap_or_else(PoisonError::into_inner);
            loop {
                if slot.ended {
                    return;
                }
                let next = SliceKind::ALL.into_iter().find_map(|kind| slot.wishes.remove(&kind));
                if let Some(wish) = next {
                    break Next::Slice(wish);
                }
                if let Some(wish) = slot.fence.take() {
                    break Next::Fence(wish);
                }
                slot = shared.1.wait(slot).unwrap_or_else(PoisonError::into_inner);
            }
        };
        outbox.send(match wish {
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
    let mut image = RgbaImage::from_pixel(width, height, Rgba([0xdc, 0xdc, 0xda, 0xff]));
    let (origin, s_axis, t_axis) = (plane.origin.as_vec3(), plane.s_axis.as_vec3(), plane.t_axis.as_vec3());
    let colour = raw_colour(loaded);
    let shown = loaded.candidates.as_ref().filter(|_| show != FaceData::Rock);
    let candidates = shown.map(|shown| shown.candidates());
    for (s, t, pixel) in image.enumerate_pixels_mut() {
        let point: Vec3 = origin + s_axis * s as f32 + t_axis * t as f32;
        if let Some(found) = colour(point) {
            *pixel = found;
        }
        if let Some(candidates) = &candidates {
            lay_candidates(pixel, candidates, point, show);
        }
    }
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

/// The colour of the raw data at a place; none where there are no data.
pub(super) fn raw_colour(loaded: &Loaded) -> impl Fn(Vec3) -> Option<Rgba<u8>> + '_ {
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
pub(super) fn lay_candidates(pixel: &mut Rgba<u8>, candidates: &Candidates, point: Vec3, show: FaceData) {
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
