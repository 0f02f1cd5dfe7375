//! Paints egui's output into an image on the processor, so that panels can be looked at without a display.
//!
//! It follows egui's own shaders: colours are sRGB with premultiplied alpha and are blended as encoded,
//! result = source + (1 − α) · below, where the source is the vertex colour times the texture. A pixel belongs to a triangle when its
//! centre lies inside the triangle or on its upper or left side, so that neighbouring triangles share no pixel. Space:
//! pixels, y down.

use eframe::egui::epaint::{ClippedPrimitive, Mesh, Primitive, Vertex};
use eframe::egui::{ColorImage, ImageData, TextureId, TexturesDelta};
use image::RgbaImage;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Rows that a thread paints at a time.
const BAND: usize = 32;

/// The textures that the meshes refer to.
#[derive(Default)]
pub struct Raster {
    textures: HashMap<TextureId, Arc<ColorImage>>,
}

impl Raster {
    /// Takes over new and changed textures, and drops those that egui has freed.
    pub fn receive(&mut self, delta: &mut TexturesDelta) {
        for (id, changes) in delta.set.drain() {
            for change in changes {
                let ImageData::Color(image) = change.image;
                match (change.pos, self.textures.get_mut(&id)) {
                    (Some(at), Some(whole)) => patch(Arc::make_mut(whole), &image, at),
                    _ => drop(self.textures.insert(id, image)),
                }
            }
        }
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    /// Paints over `image`.
    pub fn paint(&self, primitives: &[ClippedPrimitive], pixels_per_point: f32, image: &mut RgbaImage) {
        let width = image.width() as usize;
        if width == 0 {
            return;
        }
        image.par_chunks_mut(width * 4 * BAND).enumerate().for_each(|(band, pixels)| {
            let mut band = Band { pixels, width, top: band * BAND };
            for ClippedPrimitive { clip_rect, primitive } in primitives {
                let Primitive::Mesh(mesh) = primitive else { continue };
                let Some(texture) = self.textures.get(&mesh.texture_id) else { continue };
                let [low, high] = [clip_rect.min, clip_rect.max].map(|at| at.to_vec2() * pixels_per_point);
                let clip = [low.x, low.y, high.x, high.y].map(|side| side.round().max(0.0) as usize);
                band.paint(mesh, texture, pixels_per_point, clip);
            }
        });
    }
}

/// Replaces a part of a texture.
fn patch(whole: &mut ColorImage, part: &ColorImage, [x, y]: [usize; 2]) {
    let [width, height] = part.size;
    for row in 0..height {
        let to = (y + row) * whole.size[0] + x;
        whole.pixels[to..to + width].copy_from_slice(&part.pixels[row * width..(row + 1) * width]);
    }
}

/// A band of rows of the image.
struct Band<'a> {
    pixels: &'a mut [u8],
    width: usize,
    top: usize,
}

impl Band<'_> {
    /// Paints the part of a mesh that lies in these rows and within `clip` (left, top, right, bottom).
    fn paint(&mut self, mesh: &Mesh, texture: &ColorImage, pixels_per_point: f32, clip: [usize; 4]) {
        let rows = clip[1].max(self.top)..clip[3].min(self.top + self.pixels.len() / (4 * self.width));
        let columns = clip[0]..clip[2].min(self.width);
        for corners in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|n| mesh.vertices[corners[n] as usize]);
            let Some(triangle) = Triangle::of(corners, pixels_per_point) else { continue };
            for y in triangle.span(1, &rows) {
                for x in triangle.span(0, &columns) {
                    if let Some(weights) = triangle.weights([x as f64 + 0.5, y as f64 + 0.5]) {
                        let at = ((y - self.top) * self.width + x) * 4;
                        blend(&mut self.pixels[at..at + 4], triangle.colour(weights, texture));
                    }
                }
            }
        }
    }
}

fn blend(pixel: &mut [u8], source: [f32; 4]) {
    for (channel, source_channel) in pixel.iter_mut().zip(source) {
        let sum = source_channel + f32::from(*channel) * (1.0 - source[3] / 255.0);
        *channel = (sum + 0.5).clamp(0.0, 255.0) as u8;
    }
}

/// A triangle whose corners run clockwise on the screen.
struct Triangle {
    corners: [Vertex; 3],
    places: [[f64; 2]; 3],
    area: f64,
}

impl Triangle {
    fn of(mut corners: [Vertex; 3], pixels_per_point: f32) -> Option<Self> {
        let place = |corner: &Vertex| [corner.pos.x, corner.pos.y].map(|side| f64::from(side * pixels_per_point));
        let mut places = corners.each_ref().map(place);
        let area = edge(places[0], places[1], places[2]);
        if area < 0.0 {
            corners.swap(1, 2);
            places.swap(1, 2);
        }
        (area != 0.0 && area.is_finite()).then_some(Self { corners, places, area: area.abs() })
    }

    /// The pixels along an axis whose centres may lie inside.
    fn span(&self, axis: usize, range: &Range<usize>) -> Range<usize> {
        let sides = self.places.map(|place| place[axis] - 0.5);
        let low = sides.into_iter().fold(f64::INFINITY, f64::min).ceil().max(range.start as f64);
        let high = sides.into_iter().fold(f64::NEG_INFINITY, f64::max).floor() + 1.0;
        low as usize..high.clamp(0.0, range.end as f64) as usize
    }

    /// The barycentric weights of a point, if it lies inside.
    fn weights(&self, at: [f64; 2]) -> Option<[f32; 3]> {
        let mut weights = [0.0; 3];
        for (n, weight) in weights.iter_mut().enumerate() {
            let (from, to) = (self.places[(n + 1) % 3], self.places[(n + 2) % 3]);
            let off = edge(from, to, at);
            // Clockwise with y down: upper sides run to the right, left sides run upwards.
            let is_own = to[1] < from[1] || to[1] == from[1] && to[0] > from[0];
            if off < 0.0 || off == 0.0 && !is_own {
                return None;
            }
            *weight = (off / self.area) as f32;
        }
        Some(weights)
    }

    /// Premultiplied colour, 0 to 255.
    fn colour(&self, weights: [f32; 3], texture: &ColorImage) -> [f32; 4] {
        let mut uv = [0.0; 2];
        let mut colour = [0.0; 4];
        for (corner, weight) in self.corners.iter().zip(weights) {
            uv[0] += corner.uv.x * weight;
            uv[1] += corner.uv.y * weight;
            for (sum, channel) in colour.iter_mut().zip(corner.color.to_array()) {
                *sum += f32::from(channel) * weight;
            }
        }
        let texel = sample(texture, uv);
        [0, 1, 2, 3].map(|channel| colour[channel] * texel[channel] / 255.0)
    }
}

/// Twice the area of a triangle, positive where it runs clockwise on the screen.
fn edge(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A sample of a texture, interpolated between its pixels; beyond its edge the edge is repeated.
fn sample(texture: &ColorImage, uv: [f32; 2]) -> [f32; 4] {
    let [width, height] = texture.size;
    let split = |share: f32, count: usize| {
        let at = (share * count as f32 - 0.5).clamp(0.0, (count - 1) as f32);
        (at as usize, (at as usize + 1).min(count - 1), at.fract())
    };
    let ((x0, x1, s), (y0, y1, t)) = (split(uv[0], width), split(uv[1], height));
    let texel = |x: usize, y: usize| texture.pixels[y * width + x].to_array().map(f32::from);
    let corners = [texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1)];
    let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
    [0, 1, 2, 3].map(|channel| (0..4).map(|n| corners[n][channel] * weights[n]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Color32, Pos2, Rect, pos2};
    use image::Rgba;

    /// A raster whose only texture is one white pixel.
    fn white() -> Raster {
        let pixel = ColorImage::new([1, 1], vec![Color32::WHITE]);
        Raster { textures: HashMap::from([(TextureId::default(), Arc::new(pixel))]) }
    }

    fn paint(mesh: Mesh, clip_rect: Rect) -> RgbaImage {
        let mut image = RgbaImage::from_pixel(8, 8, Rgba([0, 0, 0, 255]));
        white().paint(&[ClippedPrimitive { clip_rect, primitive: Primitive::Mesh(mesh) }], 1.0, &mut image);
        image
    }

    fn count(image: &RgbaImage, red: u8) -> usize {
        image.pixels().filter(|pixel| pixel.0[0] == red).count()
    }

    #[test]
    fn triangles_that_share_a_side_share_no_pixel() {
        let half = Color32::from_rgba_premultiplied(100, 100, 100, 128);
        // Two halves of a square whose sides pass through pixel centres, with opposite orientations.
        let corners = [pos2(0.5, 0.5), pos2(6.5, 0.5), pos2(6.5, 6.5), pos2(0.5, 6.5)];
        let mut mesh = Mesh::default();
        corners.iter().for_each(|at| mesh.colored_vertex(*at, half));
        mesh.indices = vec![0, 1, 2, 0, 3, 2];
        let image = paint(mesh, Rect::EVERYTHING);
        // Centres on the upper and left sides belong to it, those on the others do not.
        assert_eq!((count(&image, 100), count(&image, 0)), (36, 28));
    }

    #[test]
    fn what_lies_outside_the_clip_is_not_painted() {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(Rect::from_min_max(Pos2::ZERO, pos2(8.0, 8.0)), Color32::WHITE);
        let image = paint(mesh, Rect::from_min_max(pos2(2.0, 3.0), pos2(5.0, 5.0)));
        assert_eq!(count(&image, 255), 6);
        assert_eq!(image.get_pixel(2, 3).0, [255; 4]);
    }

    #[test]
    fn textures_are_interpolated_and_patched() {
        let mut texture = ColorImage::new([2, 1], vec![Color32::BLACK, Color32::BLACK]);
        patch(&mut texture, &ColorImage::new([1, 1], vec![Color32::WHITE]), [1, 0]);
        assert_eq!(sample(&texture, [0.5, 0.5])[0], 127.5);
        assert_eq!((sample(&texture, [0.0, 0.5])[0], sample(&texture, [1.0, 0.5])[0]), (0.0, 255.0));
    }
}
