//! Lines of horizons, faults and edges in the picture of a face: many programs that show models draw no lines.

use crate::model::{Cover, LineKind, SceneModel};
use glam::DVec2;
use image::{Rgb, RgbImage};

/// How far from the plane of a face a line still lies on it, voxels.
const ON_PLANE: f64 = 1e-3;
/// Texels that a line of one nominal pixel is wide, for each texel of the longer side.
const WIDTH_SHARE: f64 = 1.0 / 900.0;

/// The picture with the lines that lie on its face.
pub(super) fn inked(image: &RgbImage, cover: &Cover, scene: &SceneModel) -> RgbImage {
    let mut image = image.clone();
    let plane = &cover.rectangle;
    let size = DVec2::new(f64::from(image.width()), f64::from(image.height()));
    let normal = plane.s_axis.cross(plane.t_axis).normalize();
    let outlines = scene.scene.outlines;
    for (kind, ends) in &scene.cut.lines {
        let stroke = match kind {
            LineKind::Edge => outlines.edges,
            LineKind::Horizon { .. } => outlines.horizons,
            LineKind::Fault => outlines.faults,
        };
        if ends.iter().any(|p| normal.dot(*p - plane.origin).abs() > ON_PLANE) || stroke.width_px <= 0.0 {
            continue;
        }
        let place = |p: glam::DVec3| {
            let off = p - plane.origin;
            let share = |axis: glam::DVec3, extent: f64| axis.dot(off) / (axis.length_squared() * extent);
            DVec2::new(share(plane.s_axis, plane.extent[0]), share(plane.t_axis, plane.extent[1])) * size
        };
        let half = (0.5 * f64::from(stroke.width_px) * WIDTH_SHARE * size.max_element()).max(0.5);
        draw(&mut image, ends.map(place), half, stroke.colour.to_unit().map(|c| f64::from(c) * 255.0));
    }
    image
}

/// A straight line with soft sides.
fn draw(image: &mut RgbImage, [a, b]: [DVec2; 2], half: f64, ink: [f64; 3]) {
    let size = DVec2::new(f64::from(image.width()), f64::from(image.height()));
    let (low, high) = (a.min(b) - half - 1.0, a.max(b) + half + 1.0);
    let (low, high) = (low.clamp(DVec2::ZERO, size), high.clamp(DVec2::ZERO, size));
    let along = b - a;
    for y in low.y as u32..high.y.ceil() as u32 {
        for x in low.x as u32..high.x.ceil() as u32 {
            let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let share = ((p - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
            let cover = (half + 0.5 - (p - a - along * share).length()).clamp(0.0, 1.0);
            if cover > 0.0 && x < image.width() && y < image.height() {
                let Rgb(old) = *image.get_pixel(x, y);
                let mixed = |n: usize| (f64::from(old[n]) + (ink[n] - f64::from(old[n])) * cover).round() as u8;
                image.put_pixel(x, y, Rgb([mixed(0), mixed(1), mixed(2)]));
            }
        }
    }
}
