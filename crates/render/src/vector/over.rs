//! The ground and wells over the areas of a block, as pixels: they are no paths.
//!
//! Rays go through the corners of pixels. Where those of a pixel meet nothing that lies over the areas, or all meet it in
//! much the same colour, that is the pixel; the others are averaged over `samples` × `samples` rays as in pictures. So the
//! ground costs about a ray a pixel, and faces are never shaded.

use crate::error::RenderError;
use crate::resolved_scene::ResolvedScene;
use crate::shade::over_rock;
use glam::{DVec2, Vec3};
use image::{Rgba, RgbaImage};
use rayon::prelude::*;
use survey::Progress;

/// Side of the square of pixels that one task draws.
const TILE: u32 = 16;
/// Corners of a pixel whose channels differ by no more than this have much the same colour, 1 = all.
const ALIKE: f32 = 6.0 / 255.0;

/// The ground and wells of a scene where they are seen, straight alpha, clear elsewhere; `None` if none is seen.
pub(super) fn over(resolved: &ResolvedScene, progress: &Progress) -> Result<Option<RgbaImage>, RenderError> {
    if resolved.relief.is_none() && resolved.tubes.is_none() {
        return Ok(None);
    }
    let [width, height] = resolved.scene.size_px;
    let across = width.div_ceil(TILE);
    let tiles = across * height.div_ceil(TILE);
    progress.begin("ground", u64::from(tiles));
    let drawn = |tile: u32| {
        let low = [tile % across * TILE, tile / across * TILE];
        let high = [(low[0] + TILE).min(width), (low[1] + TILE).min(height)];
        progress.step(1).map(|()| (low, high, pixels(resolved, low, high)))
    };
    let drawn = (0..tiles).into_par_iter().map(drawn).collect::<Result<Vec<_>, _>>()?;
    let mut image = RgbaImage::new(width, height);
    for ([left, top], [right, _], pixels) in drawn {
        for (n, pixel) in (0..).zip(pixels) {
            image.put_pixel(left + n % (right - left), top + n / (right - left), Rgba(pixel));
        }
    }
    Ok(Some(image).filter(|image| image.pixels().any(|pixel| pixel.0[3] > 0)))
}

/// The pixels of a rectangle, row by row.
fn pixels(resolved: &ResolvedScene, low: [u32; 2], high: [u32; 2]) -> Vec<[u8; 4]> {
    let columns = (high[0] - low[0] + 1) as usize;
    let ray = |x: f64, y: f64| resolved.view.ray(DVec2::new(x, y));
    let corners = (low[1]..=high[1]).flat_map(|y| (low[0]..=high[0]).map(move |x| [x, y]));
    let corners: Vec<_> = corners.map(|[x, y]| ray(f64::from(x), f64::from(y))).collect();
    let met = over_rock(resolved, &corners);
    let corners_of = |[x, y]: [u32; 2]| {
        let first = (y - low[1]) as usize * columns + (x - low[0]) as usize;
        [first, first + 1, first + columns, first + columns + 1].map(|n| met[n])
    };
    let all = || (low[1]..high[1]).flat_map(|y| (low[0]..high[0]).map(move |x| [x, y]));
    let samples = resolved.scene.samples;
    let within = |[x, y]: [u32; 2]| {
        (0..samples * samples).map(move |n| {
            let inside = DVec2::new(f64::from(n % samples), f64::from(n / samples)) + 0.5;
            ray(f64::from(x) + inside.x / f64::from(samples), f64::from(y) + inside.y / f64::from(samples))
        })
    };
    let mixed: Vec<[u32; 2]> = all().filter(|at| !are_alike(&corners_of(*at))).collect();
    let rays: Vec<_> = mixed.into_iter().flat_map(within).collect();
    let finer = over_rock(resolved, &rays);
    let mut finer = finer.chunks((samples * samples) as usize);
    let pixel = |at: [u32; 2]| match corners_of(at) {
        corners if are_alike(&corners) => average(&corners),
        _ => finer.next().map_or([0; 4], average),
    };
    all().map(pixel).collect()
}

fn are_alike(corners: &[Option<Vec3>; 4]) -> bool {
    let Some(colours) = corners.iter().copied().collect::<Option<Vec<Vec3>>>() else {
        return corners.iter().all(Option::is_none);
    };
    let low = colours.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let high = colours.iter().copied().reduce(Vec3::max).unwrap_or_default();
    (high - low).max_element() <= ALIKE
}

/// The mean colour of rays that met something, and their share.
fn average(met: &[Option<Vec3>]) -> [u8; 4] {
    let count = met.iter().flatten().count();
    let mean = met.iter().flatten().sum::<Vec3>() / count.max(1) as f32;
    let share = count as f32 / met.len().max(1) as f32;
    mean.extend(share).to_array().map(|channel| (channel.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
}
