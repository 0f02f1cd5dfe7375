//! Presets of a picture: in colour, in black and white, in shades of grey.
//!
//! In shades of grey every colour becomes the grey of its luminance. In black and white layers are their patterns in
//! black on white, and lines and letters are black; what is measured (raw data, volume rendering, relief) stays in
//! shades of grey, since it has no patterns to be told by.

use serde::{Deserialize, Serialize};

use crate::{Colour, ColourMap, LayerStyle, RgbaFunction, srgb_from_linear};

/// The grey value of the library's ink, which becomes black in black and white.
const INK: f32 = 0.13;
/// In black and white, lines of at most this grey value are black, lighter ones white.
const LINE: f32 = 0.85;
/// The same for areas.
const AREA: f32 = 0.5;

/// How the colours of a picture are printed.
///
/// ```
/// use ttf::{Colour, Preset};
/// let red = Colour::new(200, 30, 30);
/// assert_eq!(Preset::Colour.line(red), red);
/// assert_eq!(Preset::BlackAndWhite.line(red), Colour::BLACK);
/// let [r, g, b] = Preset::Greyscale.line(red).rgb;
/// assert!(r == g && g == b && r > 60 && r < 120);
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// As it was chosen.
    #[default]
    Colour,
    /// Black patterns on white.
    BlackAndWhite,
    /// Shades of grey.
    Greyscale,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Colour, Self::BlackAndWhite, Self::Greyscale];

    /// Its name in files and options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Colour => "colour",
            Self::BlackAndWhite => "black-and-white",
            Self::Greyscale => "greyscale",
        }
    }

    /// Whether colours are left as they are.
    pub fn is_colour(&self) -> bool {
        *self == Self::Colour
    }

    /// A layer's style.
    #[must_use]
    pub fn layer(self, style: &LayerStyle) -> LayerStyle {
        let mut style = style.clone();
        match self {
            Self::Colour => {}
            Self::BlackAndWhite => {
                style.colour = Colour::WHITE;
                style.ink = style.ink.map(|_| Colour::BLACK);
                style.intervals.iter_mut().for_each(|interval| interval.colour = None);
            }
            Self::Greyscale => {
                let own = style.intervals.iter_mut().filter_map(|interval| interval.colour.as_mut());
                for colour in own.chain(style.ink.as_mut()).chain([&mut style.colour]) {
                    *colour = grey(*colour);
                }
            }
        }
        style
    }

    /// The function of measured values: without colours it runs from white to black over the same values, since the
    /// greys of a diverging map would show both ends alike.
    #[must_use]
    pub fn measured(self, function: &RgbaFunction) -> RgbaFunction {
        if self.is_colour() {
            return function.clone();
        }
        let [low, high] = function.domain;
        let mut stops = RgbaFunction::centred(ColourMap::Grey, 1.0).stops;
        for stop in &mut stops {
            stop.opacity = function.evaluate(low + (high - low) * stop.at)[3];
        }
        RgbaFunction { stops, ..function.clone() }
    }

    /// A line's or a letter's colour.
    #[must_use]
    pub fn line(self, colour: Colour) -> Colour {
        self.shade(colour, LINE)
    }

    /// An area's colour.
    #[must_use]
    pub fn area(self, colour: Colour) -> Colour {
        self.shade(colour, AREA)
    }

    fn shade(self, colour: Colour, black_up_to: f32) -> Colour {
        match self {
            Self::Colour => colour,
            Self::Greyscale => grey(colour),
            Self::BlackAndWhite if grey_value(colour) <= black_up_to => Colour::BLACK,
            Self::BlackAndWhite => Colour::WHITE,
        }
    }

    /// A pixel of a picture, whose alpha is kept.
    #[must_use]
    pub fn pixel(self, [red, green, blue, alpha]: [u8; 4]) -> [u8; 4] {
        let value = || grey_value(Colour::new(red, green, blue));
        let value = match self {
            Self::Colour => return [red, green, blue, alpha],
            Self::Greyscale => value(),
            Self::BlackAndWhite => (value() - INK) / (1.0 - INK),
        };
        let [shade, ..] = Colour::from_unit([value; 3]).rgb;
        [shade, shade, shade, alpha]
    }
}

/// The sRGB-encoded value of the grey that is as light as a colour.
fn grey_value(colour: Colour) -> f32 {
    srgb_from_linear(colour.luminance())
}

fn grey(colour: Colour) -> Colour {
    Colour::from_unit([grey_value(colour); 3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grey_is_as_light_as_its_colour_and_stays_as_it_is() {
        for colour in [Colour::new(200, 30, 30), Colour::new(10, 200, 90), Colour::new(0, 0, 255)] {
            let made = Preset::Greyscale.area(colour);
            assert!((made.luminance() - colour.luminance()).abs() < 0.01, "{colour} {made}");
            assert_eq!(Preset::Greyscale.area(made), made);
            let [r, g, b] = colour.rgb;
            assert_eq!(Preset::Greyscale.pixel([r, g, b, 77])[..3], made.rgb);
            assert_eq!(Preset::Greyscale.pixel([r, g, b, 77])[3], 77);
        }
    }

    #[test]
    fn black_and_white_leaves_a_layer_its_pattern_alone() {
        let mut style = LayerStyle::textured("Chalk", Colour::new(90, 20, 20), "chalk");
        style.ink = Some(Colour::new(200, 0, 0));
        style.intervals[0].colour = Some(Colour::new(3, 4, 5));
        let drawn = Preset::BlackAndWhite.layer(&style);
        assert_eq!((drawn.colour, drawn.ink), (Colour::WHITE, Some(Colour::BLACK)));
        assert_eq!((drawn.texture_at(0.5), drawn.intervals[0].colour), (Some("chalk"), None));
        // The library's ink becomes black, paper stays white.
        assert_eq!(Preset::BlackAndWhite.pixel([0x23, 0x1f, 0x1b, 255])[0], 0);
        assert_eq!(Preset::BlackAndWhite.pixel([255; 4]), [255; 4]);
    }

    #[test]
    fn measured_values_run_from_white_to_black_with_their_opacity() {
        let mut function = RgbaFunction::centred(ColourMap::Seismics, 2.0);
        function.stops.last_mut().unwrap().opacity = 0.25;
        let made = Preset::Greyscale.measured(&function);
        assert_eq!(made.domain, function.domain);
        assert!(made.evaluate(-2.0)[0] > 0.95 && made.evaluate(2.0)[0] < 0.05);
        assert!((made.evaluate(2.0)[3] - 0.25).abs() < 1e-6);
        assert_eq!(Preset::Colour.measured(&function), function);
    }
}
