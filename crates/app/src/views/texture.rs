//! Pictures from the workers as textures on the screen.

use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};
use image::RgbaImage;

/// Converts the pixels to egui's image type.
pub fn pixels(image: &RgbaImage) -> ColorImage {
    ColorImage::from_rgba_unmultiplied([image.width() as usize, image.height() as usize], image)
}

/// Replaces the previous picture by this one.
pub fn keep(texture: &mut Option<TextureHandle>, ctx: &Context, name: &str, pixels: ColorImage) {
    match texture {
        Some(texture) => texture.set(pixels, TextureOptions::LINEAR),
        none => *none = Some(ctx.load_texture(name, pixels, TextureOptions::LINEAR)),
    }
}
