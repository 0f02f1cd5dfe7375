//! Swatches on the screen: textures made from what the swatch thread has drawn.

use super::texture;
use crate::work::Swatches;
use eframe::egui::{Color32, CornerRadius, Rect, Stroke, StrokeKind, TextureHandle, TextureOptions, Ui, pos2};
use std::collections::HashMap;
use ttf::LayerStyle;

/// Pixels for each millimetre of a pattern's printed size: few enough that a whole tile is recognised in a swatch.
const PX_PER_MM: f32 = 3.2;
/// Largest number of textures that are kept, since patterns come and go while one browses.
const KEPT: usize = 400;

/// The textures.
#[derive(Default)]
pub struct Tiles {
    textures: HashMap<String, TextureHandle>,
}

impl Tiles {
    /// Paints a style into a rectangle, in its plain colour until the pattern is drawn.
    pub fn paint(&mut self, ui: &Ui, swatches: &Swatches, style: &LayerStyle, rect: Rect) {
        let scale = ui.pixels_per_point();
        let size_px = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
        let (key, image) = swatches.get(style, size_px, PX_PER_MM * scale);
        let painter = ui.painter();
        let [r, g, b] = style.colour.rgb;
        let radius = CornerRadius::same(3);
        painter.rect_filled(rect, radius, Color32::from_rgb(r, g, b));
        if let Some(image) = image {
            if self.textures.len() > KEPT {
                self.textures.clear();
            }
            let texture = self
                .textures
                .entry(key)
                .or_insert_with_key(|key| ui.ctx().load_texture(key, texture::pixels(&image), TextureOptions::LINEAR));
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture.id(), rect, uv, Color32::WHITE);
        }
        let line = Stroke::new(1.0, ui.visuals().text_color().gamma_multiply(0.5));
        painter.rect_stroke(rect, radius, line, StrokeKind::Inside);
    }
}
