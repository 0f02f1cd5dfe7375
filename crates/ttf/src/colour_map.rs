//! Named colour maps, as stops on [0, 1].
//!
//! The three classical seismic maps and grey are our own stops in the field's manner. `CoolWarm` is computed
//! from the closed formula of K. Moreland, "Diverging Color Maps for Scientific Visualization" (2009):
//! colours in Msh, the polar form of CIELAB (M = |Lab|, s = angle from the L axis, h = hue), interpolated
//! through an unsaturated middle of M = 88 with the hue turned by `spin = s·√(M² − Mₛ²)/(Mₛ·sin s)`. `Strata`
//! is ours: its lightness rises evenly in Oklab (B. Ottosson, 2020) from a dark blue through green to a light
//! sand, so that it can be read in greyscale.
//!
//! Centre diverging maps on zero with [`crate::RgbaFunction::centred`]; otherwise their middle has no
//! meaning.

use serde::{Deserialize, Serialize};

use crate::Colour;
use crate::colour::{linear_from_srgb, srgb_from_linear};

/// Stops of the computed maps: the error between stops stays far below 1/255.
const COMPUTED_STOPS: usize = 33;

/// A named colour map.
///
/// ```
/// use ttf::{Colour, ColourMap};
/// let stops = ColourMap::Grey.stops();
/// assert_eq!(stops, [(0.0, Colour::WHITE), (1.0, Colour::BLACK)]);
/// assert_eq!(ColourMap::from_name("grey"), Some(ColourMap::Grey));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ColourMap {
    /// Dark red, orange, white, blue, black: the customary look of seismic sections.
    Seismics,
    /// Cyan, blue, grey, brown, red, yellow: strong events stand out from a grey middle.
    PetrelLike,
    /// Red, white, black.
    RedWhiteBlack,
    /// White to black: positive amplitudes dark, as on paper sections.
    Grey,
    /// Blue, light grey, red: Moreland's smooth diverging map.
    CoolWarm,
    /// Dark blue, green, sand: perceptually even, for attributes without a natural zero.
    Strata,
}

impl ColourMap {
    /// All maps.
    pub const ALL: [Self; 6] =
        [Self::Seismics, Self::PetrelLike, Self::RedWhiteBlack, Self::Grey, Self::CoolWarm, Self::Strata];

    /// The name by which files and commands refer to the map.
    pub fn name(self) -> &'static str {
        match self {
            Self::Seismics => "seismics",
            Self::PetrelLike => "petrel-like",
            Self::RedWhiteBlack => "red-white-black",
            Self::Grey => "grey",
            Self::CoolWarm => "cool-warm",
            Self::Strata => "strata",
        }
    }

    /// The map of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|map| map.name() == name)
    }

    /// Positions in [0, 1] with their colours. The first is at 0, the last at 1.
    pub fn stops(self) -> Vec<(f32, Colour)> {
        let listed: &[(f32, u32)] = match self {
            Self::Seismics => &[
                (0.0, 0x8c_0a14),
                (0.09, 0xe0_3c1c),
                (0.26, 0xf4_bd3e),
                (0.5, 0xf5_f4f0),
                (0.74, 0x7a_8fbc),
                (0.89, 0x2f_3f78),
                (1.0, 0x0a_0c20),
            ],
            Self::PetrelLike => &[
                (0.0, 0x98_f4fa),
                (0.32, 0x0c_14b6),
                (0.41, 0x54_5660),
                (0.5, 0xd0_d0ce),
                (0.59, 0x6c_4c1c),
                (0.68, 0xb8_1410),
                (1.0, 0xfa_f42a),
            ],
            Self::RedWhiteBlack => &[(0.0, 0xc8_161c), (0.5, 0xff_ffff), (1.0, 0x10_1010)],
            Self::Grey => &[(0.0, 0xff_ffff), (1.0, 0x00_0000)],
            Self::CoolWarm => return computed(moreland_cool_warm),
            Self::Strata => return computed(strata),
        };
        listed
            .iter()
            .map(|&(at, hex)| {
                let [_, red, green, blue] = hex.to_be_bytes();
                (at, Colour::new(red, green, blue))
            })
            .collect()
    }
}

fn computed(map: fn(f32) -> [f32; 3]) -> Vec<(f32, Colour)> {
    (0..COMPUTED_STOPS)
        .map(|index| {
            let at = index as f32 / (COMPUTED_STOPS - 1) as f32;
            (at, Colour::from_unit(map(at)))
        })
        .collect()
}

/// The diverging map between the customary cool blue and warm red.
fn moreland_cool_warm(t: f32) -> [f32; 3] {
    const MIDDLE: f32 = 88.0;
    let cool = msh_from_srgb([0.230, 0.299, 0.754]);
    let warm = msh_from_srgb([0.706, 0.016, 0.150]);
    // Both ends are saturated and differ in hue by more than 60 degrees, so the unsaturated middle is always
    // inserted. Each half interpolates between one end and that middle, at the hue to which the end spins.
    let (end, fraction) = if t <= 0.5 { (cool, 1.0 - 2.0 * t) } else { (warm, 2.0 * t - 1.0) };
    let [m, s, h] = end;
    let spin = s * (MIDDLE * MIDDLE - m * m).max(0.0).sqrt() / (m * s.sin());
    let middle_hue = if h > -std::f32::consts::FRAC_PI_3 { h + spin } else { h - spin };
    let mix = |at_middle: f32, at_end: f32| at_middle + (at_end - at_middle) * fraction;
    srgb_from_msh([mix(MIDDLE, m), mix(0.0, s), mix(middle_hue, h)])
}

/// White of sRGB (D65), XYZ.
const WHITE_XYZ: [f32; 3] = [0.950_47, 1.0, 1.088_83];

fn msh_from_srgb(srgb: [f32; 3]) -> [f32; 3] {
    let [r, g, b] = srgb.map(linear_from_srgb);
    let xyz = [
        0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b,
        0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b,
        0.019_333_9 * r + 0.119_192 * g + 0.950_304_1 * b,
    ];
    let f = |ratio: f32| {
        if ratio > 0.008_856 { ratio.cbrt() } else { 7.787 * ratio + 16.0 / 116.0 }
    };
    let [fx, fy, fz] = std::array::from_fn(|axis| f(xyz[axis] / WHITE_XYZ[axis]));
    let [l, a, b] = [116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)];
    let m = (l * l + a * a + b * b).sqrt();
    [m, (l / m).acos(), b.atan2(a)]
}

fn srgb_from_msh([m, s, h]: [f32; 3]) -> [f32; 3] {
    let [l, a, b] = [m * s.cos(), m * s.sin() * h.cos(), m * s.sin() * h.sin()];
    let fy = (l + 16.0) / 116.0;
    let inverse = |f: f32| {
        if f > 0.206_893 { f * f * f } else { (f - 16.0 / 116.0) / 7.787 }
    };
    let [fx, fz] = [fy + a / 500.0, fy - b / 200.0];
    let [x, y, z] = [inverse(fx) * WHITE_XYZ[0], inverse(fy) * WHITE_XYZ[1], inverse(fz) * WHITE_XYZ[2]];
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
    .map(|channel| srgb_from_linear(channel.max(0.0)))
}

/// Our sequential map in Oklch: L from 0.28 to 0.94, hue from 262 to 88 degrees, chroma an arch that stays
/// inside sRGB.
fn strata(t: f32) -> [f32; 3] {
    let lightness = 0.28 + 0.66 * t;
    let chroma = 0.06 + 0.28 * t * t * (1.0 - t);
    let hue = (262.0 - 174.0 * t).to_radians();
    srgb_from_oklab([lightness, chroma * hue.cos(), chroma * hue.sin()])
}

fn srgb_from_oklab([l, a, b]: [f32; 3]) -> [f32; 3] {
    let cube = |value: f32| value * value * value;
    let long = cube(l + 0.396_337_78 * a + 0.215_803_76 * b);
    let medium = cube(l - 0.105_561_346 * a - 0.063_854_17 * b);
    let short = cube(l - 0.089_484_18 * a - 1.291_485_5 * b);
    [
        4.076_741_7 * long - 3.307_711_6 * medium + 0.230_969_93 * short,
        -1.268_438 * long + 2.609_757_4 * medium - 0.341_319_4 * short,
        -0.004_196_086_3 * long - 0.703_418_6 * medium + 1.707_614_7 * short,
    ]
    .map(|channel| srgb_from_linear(channel.max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_spans_the_unit_range_and_finds_itself_by_name() {
        for map in ColourMap::ALL {
            let stops = map.stops();
            assert_eq!(stops[0].0, 0.0);
            assert_eq!(stops[stops.len() - 1].0, 1.0);
            assert!(stops.windows(2).all(|pair| pair[0].0 < pair[1].0));
            assert_eq!(ColourMap::from_name(map.name()), Some(map));
        }
        assert_eq!(ColourMap::from_name("rainbow"), None);
    }

    #[test]
    fn diverging_maps_are_nearly_neutral_in_the_middle() {
        for map in ColourMap::ALL.into_iter().filter(|map| !matches!(map, ColourMap::Grey | ColourMap::Strata)) {
            let stops = map.stops();
            let (_, middle) = stops.iter().find(|(at, _)| *at == 0.5).expect("a stop at zero");
            let [high, low] = [middle.rgb.iter().max(), middle.rgb.iter().min()];
            assert!(high.unwrap() - low.unwrap() <= 5, "{}: {middle}", map.name());
        }
    }

    #[test]
    fn cool_warm_has_the_published_ends_and_middle() {
        let stops = ColourMap::CoolWarm.stops();
        let near = |found: Colour, expected: [u8; 3]| found.rgb.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
        assert!(near(stops[0].1, [59, 76, 192]), "{}", stops[0].1);
        assert!(near(stops[16].1, [221, 221, 221]), "{}", stops[16].1);
        assert!(near(stops[32].1, [180, 4, 38]), "{}", stops[32].1);
    }

    #[test]
    fn strata_brightens_evenly_and_stays_inside_srgb() {
        let stops = ColourMap::Strata.stops();
        let lightness: Vec<f32> = stops.iter().map(|(_, c)| 116.0 * c.luminance().cbrt() - 16.0).collect();
        let steps: Vec<f32> = lightness.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mean = steps.iter().sum::<f32>() / steps.len() as f32;
        assert!(steps.iter().all(|step| (step / mean - 1.0).abs() < 0.35), "{steps:?}");
        for step in 0..=100 {
            let rgb = strata(step as f32 / 100.0);
            assert!(rgb.iter().all(|channel| (0.0..=1.0).contains(channel) && *channel > 0.0), "{step}: {rgb:?}");
        }
    }
}
