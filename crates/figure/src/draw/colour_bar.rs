//! The bar that says which value a colour of measured data stands for.

use crate::style::{INK, NUMBER_PT, QUIET_INK, TEXT_PT};
use glam::DVec2;
use image::{Rgba, RgbaImage};
use page::Rect;
use page::list::{Across, Group, GroupKind, Path, PathItem, Picture, Stroke, Text, Upright, width_of};
use ttf::RawColour;

/// Height of the strip that holds a bar, points.
pub(crate) const STRIP_PT: f64 = 26.0;
/// Length and height of the bar, points.
const BAR_PT: [f64; 2] = [110.0, 6.0];
/// Colours along the bar.
const STEPS: u32 = 256;
/// Between the name of the data and the bar, points.
const GAP_PT: f64 = 10.0;

/// The bar at the left of a strip, with what it shows before it and the ends of its range, and 0 between them, below.
pub(crate) fn drawn(strip: Rect, raw: &RawColour) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "colour bar");
    let title = Text::new(DVec2::new(strip.min.x, strip.min.y + 0.5 * BAR_PT[1] + 4.0), raw.volume.clone());
    let title = title.sized(TEXT_PT - 0.5).inked(QUIET_INK).anchored(Across::Start, Upright::Middle);
    let title = title.fitted(0.4 * strip.width());
    let left = strip.min.x + title.width() + GAP_PT;
    let [low, high] = raw.function.domain;
    let ends = [low, high].map(number);
    // Numbers stand below the ends, so they need half their width beside them.
    let beside = ends.iter().map(|end| 0.5 * width_of(end, NUMBER_PT)).fold(0.0, f64::max);
    let length = BAR_PT[0].min(strip.max.x - left - 2.0 * beside);
    if length < 4.0 * beside {
        return group;
    }
    let bar = Rect::sized(DVec2::new(left + beside, strip.min.y + 4.0), DVec2::new(length, BAR_PT[1]));
    let colours = raw.function.bake(STEPS as usize);
    let image = RgbaImage::from_fn(STEPS, 1, |x, _| {
        let [r, g, b, _] = colours[x as usize].map(|channel| (channel * 255.0 + 0.5) as u8);
        Rgba([r, g, b, 255])
    });
    group.push(title);
    group.push(Picture::in_rect(image, bar));
    group.push(PathItem::stroked(Path::rect(bar), Stroke::new(0.5, INK)));
    let mut below = |share: f64, text: String| {
        let at = DVec2::new(bar.min.x + share * bar.width(), bar.max.y + 3.0);
        group.push(Text::new(at, text).sized(NUMBER_PT).inked(INK).anchored(Across::Middle, Upright::Top));
    };
    let [start, end] = ends;
    let zero = f64::from(-low / (high - low));
    let free = 2.0 * beside + width_of("0", NUMBER_PT);
    below(0.0, start);
    if zero * bar.width() > free && (1.0 - zero) * bar.width() > free {
        below(zero, "0".into());
    }
    below(1.0, end);
    group
}

/// A value in three digits.
fn number(value: f32) -> String {
    let size = f64::from(value.abs());
    if size == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.2e}").replace('-', "−");
    }
    let digits = (2.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}").replace('-', "−");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use page::list::Item;
    use ttf::{ColourMap, RgbaFunction};

    #[test]
    fn the_bar_has_its_range_and_zero_below_it() {
        let raw = |domain: [f32; 2]| RawColour::new("seismic", RgbaFunction::over(ColourMap::Grey, domain));
        let said = |domain: [f32; 2]| -> Vec<String> {
            let strip = Rect::sized(DVec2::ZERO, DVec2::new(300.0, STRIP_PT));
            let group = drawn(strip, &raw(domain));
            let texts =
                group.items.into_iter().filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None });
            texts.inspect(|text| assert!(strip.contains(text.bounds().min))).map(|text| text.text).collect()
        };
        assert_eq!(said([-2500.0, 2500.0]), ["seismic", "−2500", "0", "2500"]);
        assert_eq!(said([0.25, 1.0]), ["seismic", "0.25", "1"]);
        let narrow = Rect::sized(DVec2::ZERO, DVec2::new(30.0, STRIP_PT));
        assert!(drawn(narrow, &raw([0.0, 1.0])).items.is_empty());
    }
}
