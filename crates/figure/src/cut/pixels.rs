//! The raster of a section: amplitudes, and candidates over them.

use super::SectionSource;
use crate::style::NO_DATA;
use glam::Vec3;
use image::{Rgba, RgbaImage};
use rayon::prelude::*;
use render::{CandidateVolume, FaceData, leaves};

/// Colours that a value's range is divided into.
const COLOURS: usize = 1024;

/// Amplitudes, or candidates over them, at the places of a raster's pixels; grey where there are no data.
pub(super) fn raster(
    source: &SectionSource,
    size: [u32; 2],
    show: FaceData,
    place: impl Fn(f32, f32) -> Vec3 + Sync,
) -> RgbaImage {
    let [r, g, b] = NO_DATA.rgb;
    let mut image = RgbaImage::from_pixel(size[0], size[1], Rgba([r, g, b, 255]));
    let colour = raw_colour(source);
    let candidates = source.data.candidates.filter(|_| show.shows_candidates());
    image.par_chunks_mut(4 * size[0].max(1) as usize).enumerate().for_each(|(t, row)| {
        for (s, pixel) in row.chunks_exact_mut(4).enumerate() {
            let point = place(s as f32, t as f32);
            if let Some(found) = colour(point) {
                pixel.copy_from_slice(&found);
            }
            if let Some(candidates) = &candidates {
                lay_candidates(pixel, candidates, point, show);
            }
        }
    });
    image
}

/// The colour of the raw data at a place; none where there are no data.
fn raw_colour<'a>(source: &'a SectionSource) -> impl Fn(Vec3) -> Option<[u8; 4]> + Sync + 'a {
    let volumes = source.data.volumes;
    let found = source.raw.and_then(|raw| Some((raw, volumes.iter().find(|volume| volume.name == raw.volume)?)));
    let baked = found.map(|(raw, volume)| {
        let [low, high] = raw.function.domain;
        let scale = (COLOURS - 1) as f32 / (high - low).max(f32::MIN_POSITIVE);
        (volume, raw.function.bake(COLOURS), low, scale)
    });
    move |point| {
        let (volume, colours, low, scale) = baked.as_ref()?;
        let value = volume.sample(point);
        let colour = colours[((value - low) * scale).clamp(0.0, (COLOURS - 1) as f32) as usize];
        (!value.is_nan()).then(|| [colour[0], colour[1], colour[2], 1.0].map(|c| (c * 255.0 + 0.5) as u8))
    }
}

/// A leaf in its colour over the raw data, or the distance in its place.
fn lay_candidates(pixel: &mut [u8], candidates: &CandidateVolume, point: Vec3, show: FaceData) {
    let distance = candidates.distance_at(point);
    let byte = |channel: f32| (channel * 255.0 + 0.5) as u8;
    if show == FaceData::Distance {
        let tone = byte(leaves::distance_tone(distance));
        pixel.copy_from_slice(&[tone, tone, tone, 255]);
        return;
    }
    let group = candidates.group(candidates.leaf_at(point));
    let cover = leaves::cover(distance);
    if group != 0 && cover > 0.0 {
        let colour = leaves::leaf_colour(group).to_array().map(byte);
        for (channel, leaf) in pixel.iter_mut().zip(colour) {
            let below = f32::from(*channel);
            *channel = (below + (f32::from(leaf) - below) * cover + 0.5) as u8;
        }
    }
}
