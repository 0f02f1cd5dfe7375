//! A page in black and white, or in shades of grey.

use super::{DisplayList, Ink, Item};
use std::sync::Arc;
use ttf::{Colour, Preset};

impl DisplayList {
    /// Changes all colours to those that a preset prints. Images become grey in both presets without colour, since what
    /// is measured has no pattern to be told by.
    pub fn print(&mut self, preset: Preset) {
        if preset.is_colour() {
            return;
        }
        let area = |ink: &mut Ink| ink.colour = preset.area(ink.colour);
        self.paper.iter_mut().for_each(area);
        print_items(&mut self.items, preset);
    }
}

fn print_items(items: &mut [Item], preset: Preset) {
    let area = |colour: &mut Colour| *colour = preset.area(*colour);
    let line = |colour: &mut Colour| *colour = preset.line(*colour);
    for item in items {
        match item {
            Item::Path(path) => {
                path.fill.iter_mut().for_each(|ink| area(&mut ink.colour));
                path.stroke.iter_mut().for_each(|stroke| line(&mut stroke.ink.colour));
            }
            Item::Text(text) => {
                line(&mut text.ink.colour);
                text.halo.iter_mut().for_each(|halo| line(&mut halo.ink.colour));
            }
            Item::Picture(picture) => {
                let pixels = Arc::make_mut(&mut picture.pixels);
                pixels.pixels_mut().for_each(|pixel| pixel.0 = Preset::Greyscale.pixel(pixel.0));
            }
            Item::Group(group) => print_items(&mut group.items, preset),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::{Group, GroupKind, Path, PathItem, Picture, Stroke, Text};
    use glam::DVec2;

    fn page() -> DisplayList {
        let mut page = DisplayList::new(DVec2::splat(10.0));
        let (red, pale) = (Colour::new(200, 30, 30), Colour::new(250, 220, 180));
        let mut text = Text::new(DVec2::ONE, "a");
        text.ink = red.into();
        let rect = Path::rect(page.bounds());
        let picture = image::RgbaImage::from_pixel(2, 2, image::Rgba([30, 90, 200, 128]));
        let inner = Group::new(GroupKind::Layer, "Chalk").with([
            PathItem::filled(rect.clone(), pale).into(),
            PathItem::stroked(rect, Stroke::new(1.0, red)).into(),
            text.into(),
            Picture::in_rect(picture, page.bounds()).into(),
        ]);
        page.items.push(inner.into());
        page
    }

    /// The colours of a page, without those of images.
    fn colours(page: &DisplayList) -> Vec<Colour> {
        let of = |item: &&Item| match item {
            Item::Path(path) => path.fill.or(path.stroke.as_ref().map(|stroke| stroke.ink)).map(|ink| ink.colour),
            Item::Text(text) => Some(text.ink.colour),
            _ => None,
        };
        page.leaves().iter().filter_map(of).collect()
    }

    #[test]
    fn lines_and_letters_are_black_and_areas_white_in_black_and_white() {
        let mut printed = page();
        printed.print(Preset::BlackAndWhite);
        assert_eq!(colours(&printed), [Colour::WHITE, Colour::BLACK, Colour::BLACK]);
    }

    #[test]
    fn every_colour_is_a_grey_in_greyscale_and_images_keep_their_opacity() {
        let mut printed = page();
        printed.print(Preset::Greyscale);
        assert!(
            colours(&printed).iter().all(|colour| colour.rgb[0] == colour.rgb[1] && colour.rgb[1] == colour.rgb[2])
        );
        let leaves = printed.leaves();
        let Some(Item::Picture(picture)) = leaves.last() else { panic!("the image is last") };
        let [r, g, b, alpha] = picture.pixels.get_pixel(0, 0).0;
        assert!(r == g && g == b && alpha == 128);
        let mut same = page();
        same.print(Preset::Colour);
        assert_eq!(same, page());
    }
}
