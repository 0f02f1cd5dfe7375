//! Whether layers that touch can be told apart by a colour-blind reader, in greyscale, and photocopied, and what to
//! change where they cannot.
//!
//! A layer is looked at as it is printed at the contact: a patch of its pattern over its colour, 24 mm wide, in
//! dots of [`DOT_MM`]. The dots are seen in one of five ways ([`Vision`]) and become CIE L\*a\*b\* (1976, D65). Two
//! patches can be told apart if their mean colours differ by [`CLEAR`] (ΔE\*ab), or their patterns by [`CLEAR_GRAIN`]. The measure
//! of a pattern is how much neighbours of 0.25, 0.5, 1 and 2 mm differ in lightness, along the layer, across it and
//! along both diagonals (the root mean square in units of L\*): sixteen numbers, which depend on spacing, direction and
//! contrast, but not on where the tile begins. Patterns differ by the length of the difference of these numbers.
//!
//! Colour blindness is simulated by the matrices of Machado, Oliveira and Fernandes, "A Physiologically-based Model for
//! Simulation of Color Vision Deficiency" (IEEE TVCG 15(6), 2009), at severity 1, on linear light. A photocopy is white
//! where L\* is at least 50, and black elsewhere. Repeats that a layer states are left out of account: a pattern has the
//! size of its catalogue, so that the same pattern at two sizes does not count as two.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::{Colour, LayerStyle, Preset, TextureLibrary, TtfError, linear_from_srgb};

/// A difference of colours that is plain at a glance, in units of L\*a\*b\*: about four times what can just be seen side
/// by side.
const CLEAR: f32 = 10.0;

/// A difference of patterns that is plain at a glance. In black and white limestone and dolostone are 5.6 apart, marl
/// and dolomitic shale, which are alike but for a slant of short joints, 1.5.
const CLEAR_GRAIN: f32 = 4.0;

/// Side of a dot, mm: a hundred dots an inch, which a print shows and a reader sees.
const DOT_MM: f32 = 0.25;

/// Dots along a side of the patch.
const DOTS: usize = 96;

/// Sizes of neighbours that are compared, each twice the one before.
const SCALES: usize = 4;

/// Directions in which neighbours are compared.
const DIRECTIONS: usize = 4;

/// Changes of lightness that are tried to tell two layers apart, in units of L\*.
const STEPS: [f32; 8] = [-12.0, 12.0, -18.0, 18.0, -25.0, 25.0, -35.0, 35.0];

/// A way of seeing a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Vision {
    /// Without the cones for long waves: red looks dark.
    Protanopia,
    /// Without the cones for middle waves.
    Deuteranopia,
    /// Without the cones for short waves.
    Tritanopia,
    /// Printed in shades of grey.
    Greyscale,
    /// Copied in black and white.
    Photocopy,
}

impl Vision {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Protanopia, Self::Deuteranopia, Self::Tritanopia, Self::Greyscale, Self::Photocopy];

    /// When it is met, as a phrase.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::Protanopia => "with protanopia (blind to red)",
            Self::Deuteranopia => "with deuteranopia (blind to green)",
            Self::Tritanopia => "with tritanopia (blind to blue)",
            Self::Greyscale => "in greyscale",
            Self::Photocopy => "photocopied",
        }
    }

    /// What an sRGB-encoded colour looks like, as CIE L\*a\*b\*.
    ///
    /// ```
    /// use ttf::Vision;
    /// let [lightness, a, b] = Vision::Greyscale.lab([1.0, 1.0, 1.0]);
    /// assert!((lightness - 100.0).abs() < 0.01 && a.abs() < 0.01 && b.abs() < 0.01);
    /// assert_eq!(Vision::Photocopy.lab([0.2, 0.1, 0.0]), [0.0, 0.0, 0.0]);
    /// ```
    pub fn lab(self, rgb: [f32; 3]) -> [f32; 3] {
        let light = rgb.map(linear_from_srgb);
        let rows = match self {
            Self::Protanopia => [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
            Self::Deuteranopia => [
                [0.367_322, 0.860_646, -0.227_968],
                [0.280_085, 0.672_501, 0.047_413],
                [-0.011_820, 0.042_940, 0.968_881],
            ],
            Self::Tritanopia => [
                [1.255_528, -0.076_749, -0.178_779],
                [-0.078_411, 0.930_809, 0.147_602],
                [0.004_733, 0.691_367, 0.303_900],
            ],
            Self::Greyscale => return [lab_from_linear(light)[0], 0.0, 0.0],
            Self::Photocopy => return [if lab_from_linear(light)[0] >= 50.0 { 100.0 } else { 0.0 }, 0.0, 0.0],
        };
        lab_from_linear(rows.map(|row| dot(row, light).clamp(0.0, 1.0)))
    }
}

/// Two layers that touch and cannot be told apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Confusion {
    /// Their positions, youngest first.
    pub layers: [usize; 2],
    /// Under what.
    pub under: Vec<Vision>,
    /// A change after which the layer can be told from all that it touches, under everything; `None` if none of those
    /// tried is enough.
    pub remedy: Option<Restyling>,
}

/// A change of how a layer looks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Restyling {
    /// The layer: its position, youngest first.
    pub layer: usize,
    /// Its new colour.
    pub colour: Colour,
    /// Its new pattern; `None`: it keeps its own.
    pub pattern: Option<String>,
}

/// The pairs that cannot be told apart among those that touch. `styles` are those of all layers, youngest first, and a
/// pair holds two positions in them; `preset` is how the picture is printed. Of neighbours in the sequence the base of
/// the upper one is compared with the top of the lower one; of others, which touch at faults and unconformities, any
/// end of one with any end of the other.
///
/// ```
/// use ttf::{Colour, LayerStyle, Preset, TextureLibrary, confusions};
/// let library = TextureLibrary::builtin().unwrap();
/// let layer = |name, colour| LayerStyle::plain(name, colour);
/// let grey = layer("Grey", Colour::new(128, 128, 128));
/// let (white, black) = (layer("White", Colour::WHITE), layer("Black", Colour::BLACK));
/// let found = |styles: &[LayerStyle]| confusions(styles, &[[0, 1]], Preset::Colour, &library).unwrap().len();
/// assert_eq!((found(&[white, black]), found(&[grey.clone(), grey])), (0, 1));
/// ```
///
/// # Errors
/// A style names a texture that the library does not have.
pub fn confusions(
    styles: &[LayerStyle],
    touching: &[[usize; 2]],
    preset: Preset,
    library: &TextureLibrary,
) -> Result<Vec<Confusion>, TtfError> {
    let ends =
        styles.iter().map(|style| LayerEnds::of(&preset.layer(style), library)).collect::<Result<Vec<_>, _>>()?;
    let mut search = ChangeSearch { styles, touching, preset, library, ends, patterns: BTreeMap::new() };
    let mut found = Vec::new();
    for &layers in touching {
        let under = search.alike(layers, [&search.ends[layers[0]], &search.ends[layers[1]]]);
        if !under.is_empty() {
            let remedy = search.remedy(layers)?;
            found.push(Confusion { layers, under, remedy });
        }
    }
    Ok(found)
}

/// A search for changes that tell layers apart.
struct ChangeSearch<'a> {
    styles: &'a [LayerStyle],
    touching: &'a [[usize; 2]],
    preset: Preset,
    library: &'a TextureLibrary,
    ends: Vec<LayerEnds>,
    /// How the library's patterns look on their own colours, as far as they were tried.
    patterns: BTreeMap<String, LayerEnds>,
}

impl ChangeSearch<'_> {
    /// Under what two layers that look like this are alike.
    fn alike(&self, [upper, lower]: [usize; 2], [above, below]: [&LayerEnds; 2]) -> Vec<Vision> {
        if lower == upper + 1 {
            return above.base.alike(&below.top);
        }
        let pairs = [&above.top, &above.base].into_iter().flat_map(|a| [(a, &below.top), (a, &below.base)]);
        let mut under: Vec<Vision> = pairs.flat_map(|(a, b)| a.alike(b)).collect();
        under.sort_unstable();
        under.dedup();
        under
    }

    /// Whether a layer that looks like this can be told from all that it touches.
    fn is_clear(&self, layer: usize, look: &LayerEnds) -> bool {
        self.touching.iter().filter(|pair| pair.contains(&layer)).all(|&pair| {
            let seen = pair.map(|other| if other == layer { look } else { &self.ends[other] });
            self.alike(pair, seen).is_empty()
        })
    }

    /// The first change that is enough: of the lightness of one of the layers, then of its pattern for another of its
    /// family, then for any other.
    fn remedy(&mut self, layers: [usize; 2]) -> Result<Option<Restyling>, TtfError> {
        let lower_first = [layers[1], layers[0]];
        for step in STEPS {
            for layer in lower_first {
                let mut style = self.styles[layer].clone();
                style.colour = lightened(style.colour, step);
                if self.is_clear(layer, &LayerEnds::of(&self.preset.layer(&style), self.library)?) {
                    return Ok(Some(Restyling { layer, colour: style.colour, pattern: None }));
                }
            }
        }
        let family = |layer: usize| {
            let texture = self.styles[layer].intervals.first().map(|interval| interval.texture.as_str());
            texture.and_then(|name| self.library.find(name)).map(|index| self.library.pattern(index).family.clone())
        };
        let families = lower_first.map(family);
        for is_related in [true, false] {
            for (layer, family) in lower_first.into_iter().zip(&families) {
                for index in 0..self.library.len() {
                    let pattern = self.library.pattern(index);
                    // A pattern stands for a rock: water, nothing and the user's own tiles are no answer.
                    if pattern.fgdc.is_none() || (Some(&pattern.family) == family.as_ref()) != is_related {
                        continue;
                    }
                    let (name, colour) = (pattern.name.clone(), pattern.colour);
                    if !self.patterns.contains_key(&name) {
                        let style = LayerStyle::textured(&self.styles[layer].layer, colour, &name);
                        let look = LayerEnds::of(&self.preset.layer(&style), self.library)?;
                        self.patterns.insert(name.clone(), look);
                    }
                    if self.is_clear(layer, &self.patterns[&name]) {
                        return Ok(Some(Restyling { layer, colour, pattern: Some(name) }));
                    }
                }
            }
        }
        Ok(None)
    }
}

/// A colour lighter by `step` units of L\*, with its hue: the encoded channels move towards white or black.
fn lightened(colour: Colour, step: f32) -> Colour {
    let to = if step > 0.0 { 1.0 } else { 0.0 };
    let rgb = colour.to_unit();
    let lightness = |share: f32| {
        let mixed = rgb.map(|channel| channel + (to - channel) * share);
        (lab_from_linear(mixed.map(linear_from_srgb))[0], mixed)
    };
    let wanted = lightness(0.0).0 + step;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..20 {
        let middle = (low + high) * 0.5;
        if (lightness(middle).0 - wanted) * step.signum() < 0.0 { low = middle } else { high = middle }
    }
    Colour::from_unit(lightness(high).1)
}

/// How a layer looks at its top and at its base.
struct LayerEnds {
    top: PatchLook,
    base: PatchLook,
}

impl LayerEnds {
    fn of(style: &LayerStyle, library: &TextureLibrary) -> Result<Self, TtfError> {
        let base = PatchLook::of(style, 0.0, library)?;
        let top = if style.interval_at(0.0) == style.interval_at(1.0) {
            base.clone()
        } else {
            PatchLook::of(style, 1.0, library)?
        };
        Ok(Self { top, base })
    }
}

/// A dot of a patch.
struct Dot {
    /// The share of it that is ink.
    share: f32,
    /// What the ink looks like over the ground.
    ink: [f32; 3],
}

impl Dot {
    /// L\*a\*b\* of the dot. A copier sees lines that are finer than a dot: ink and ground are copied each by itself.
    fn seen(&self, ground: [f32; 3], vision: Vision) -> [f32; 3] {
        let mixed = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|c| a[c] + (b[c] - a[c]) * self.share);
        match vision {
            Vision::Photocopy => mixed(vision.lab(ground), vision.lab(self.ink)),
            _ => vision.lab(mixed(ground, self.ink)),
        }
    }
}

/// How a patch of a layer looks in each way of seeing.
#[derive(Debug, Clone, PartialEq)]
struct PatchLook {
    /// Mean L\*a\*b\*.
    mean: [[f32; 3]; Vision::ALL.len()],
    /// Differences of neighbours along the layer and across it, at each scale.
    grain: [[f32; DIRECTIONS * SCALES]; Vision::ALL.len()],
}

impl PatchLook {
    /// The layer at local `k`.
    fn of(style: &LayerStyle, k: f32, library: &TextureLibrary) -> Result<Self, TtfError> {
        let interval = style.interval_at(k);
        let ground = interval.and_then(|interval| interval.colour).unwrap_or(style.colour).to_unit();
        let texture = interval.map(|interval| {
            let index = library.index_of(&interval.texture, &format!("layer `{}`", style.layer))?;
            Ok((library.texture(index)?, library.pattern(index).tile_mm.map(|side| DOT_MM / side), interval.opacity))
        });
        let texture = texture.transpose()?;
        let dot = |n: usize| match &texture {
            None => Dot { share: 0.0, ink: ground },
            Some((texture, step, opacity)) => {
                let uv = [(n % DOTS) as f32 * step[0], (n / DOTS) as f32 * step[1]];
                let [r, g, b, share] = texture.sample(uv, [step[0], 0.0], [0.0, step[1]]);
                // Texels are premultiplied.
                let own = style.ink.map_or([r, g, b].map(|channel| channel / share.max(1e-4)), Colour::to_unit);
                Dot { share, ink: std::array::from_fn(|c| ground[c] + (own[c] - ground[c]) * opacity) }
            }
        };
        let dots: Vec<Dot> = (0..DOTS * DOTS).map(dot).collect();
        let seen = Vision::ALL.map(|vision| dots.iter().map(|dot| dot.seen(ground, vision)).collect::<Vec<_>>());
        let mean = seen
            .each_ref()
            .map(|labs| std::array::from_fn(|c| labs.iter().map(|lab| lab[c]).sum::<f32>() / labs.len() as f32));
        let grain = seen.map(|labs| grain(labs.iter().map(|lab| lab[0]).collect()));
        Ok(Self { mean, grain })
    }

    /// The ways of seeing in which this cannot be told from `other`.
    fn alike(&self, other: &Self) -> Vec<Vision> {
        let is_alike = |n: &usize| {
            distance(&self.mean[*n], &other.mean[*n]) < CLEAR
                && distance(&self.grain[*n], &other.grain[*n]) < CLEAR_GRAIN
        };
        (0..Vision::ALL.len()).filter(is_alike).map(|n| Vision::ALL[n]).collect()
    }
}

/// The root mean square difference of neighbours along rows, columns and both diagonals, for dots and for means of 2, 4
/// and 8 dots.
fn grain(mut lightness: Vec<f32>) -> [f32; DIRECTIONS * SCALES] {
    let mut found = [0.0; DIRECTIONS * SCALES];
    let mut side = DOTS;
    for scale in 0..SCALES {
        let at = |x: usize, y: usize| lightness[y * side + x];
        let mut sums = [0.0; DIRECTIONS];
        for y in 0..side - 1 {
            for x in 0..side - 1 {
                let (here, right, below) = (at(x, y), at(x + 1, y), at(x, y + 1));
                let differences = [right - here, below - here, at(x + 1, y + 1) - here, below - right];
                sums.iter_mut().zip(differences).for_each(|(sum, difference)| *sum += difference * difference);
            }
        }
        let count = ((side - 1) * (side - 1)) as f32;
        for (direction, sum) in sums.iter().enumerate() {
            found[DIRECTIONS * scale + direction] = (sum / count).sqrt();
        }
        let half = side / 2;
        let mean = |n: usize| {
            let (x, y) = (n % half * 2, n / half * 2);
            (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) * 0.25
        };
        lightness = (0..half * half).map(mean).collect();
        side = half;
    }
    found
}

fn distance(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt()
}

fn dot(row: [f32; 3], light: [f32; 3]) -> f32 {
    row[0] * light[0] + row[1] * light[1] + row[2] * light[2]
}

/// CIE L\*a\*b\* (1976) of linear sRGB light, with D65 as white.
fn lab_from_linear(light: [f32; 3]) -> [f32; 3] {
    let x = dot([0.412_456_4, 0.357_576_1, 0.180_437_5], light) / 0.950_47;
    let y = dot([0.212_672_9, 0.715_152_2, 0.072_175], light);
    let z = dot([0.019_333_9, 0.119_192, 0.950_304_1], light) / 1.088_83;
    let [fx, fy, fz] = [x, y, z].map(|t| {
        // 6/29 is where the cube root is continued by its tangent.
        let bend = 6.0 / 29.0_f32;
        if t > bend.powi(3) { t.cbrt() } else { t / (3.0 * bend * bend) + 4.0 / 29.0 }
    });
    [116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library() -> TextureLibrary {
        TextureLibrary::builtin().unwrap()
    }

    /// Under what two layers of one colour each are alike.
    fn alike(first: [u8; 3], second: [u8; 3]) -> Vec<Vision> {
        let styles = [first, second].map(|rgb| LayerStyle::plain("a", Colour { rgb }));
        let found = confusions(&styles, &[[0, 1]], Preset::Colour, &library()).unwrap();
        found.into_iter().flat_map(|confusion| confusion.under).collect()
    }

    #[test]
    fn known_confusions_are_found_and_only_those() {
        use Vision::{Deuteranopia, Greyscale, Photocopy, Protanopia, Tritanopia};
        // Orange and green, red and green, two greens: each pair is one colour to one kind of colour-blind reader and
        // plain to the others.
        for (vision, pair) in [
            (Deuteranopia, [[64, 182, 47], [234, 113, 58]]),
            (Protanopia, [[55, 123, 68], [239, 93, 76]]),
            (Tritanopia, [[59, 181, 69], [67, 183, 129]]),
        ] {
            let blind = [Protanopia, Deuteranopia, Tritanopia];
            let found: Vec<Vision> =
                alike(pair[0], pair[1]).into_iter().filter(|vision| blind.contains(vision)).collect();
            assert_eq!(found, [vision], "{pair:?}");
        }
        // Red and green of one lightness.
        assert!(alike([200, 60, 60], [0, 128, 60]).contains(&Greyscale));
        // Light colours copy as white.
        assert_eq!(alike([255, 230, 120], [120, 180, 255]), [Photocopy]);
        assert_eq!(alike([250, 250, 250], [20, 20, 20]), []);
    }

    #[test]
    fn patterns_tell_layers_apart_that_colours_do_not() {
        let library = library();
        let white = |pattern: &str| LayerStyle::textured(pattern, Colour::WHITE, pattern);
        let found = |first: &str, second: &str| {
            confusions(&[white(first), white(second)], &[[0, 1]], Preset::BlackAndWhite, &library).unwrap()
        };
        for [first, second] in [
            ["limestone", "shale"],
            ["limestone", "dolostone"],
            ["sand", "salt"],
            ["coal", "shale"],
            ["granite", "gneiss"],
            ["marl", "chalk"],
            ["siltstone", "shale"],
        ] {
            assert_eq!(found(first, second), [], "{first} {second}");
        }
        assert_eq!(found("sand", "sand")[0].under, Vision::ALL);
        assert_eq!(found("marl", "shale-dolomitic")[0].under, Vision::ALL);
    }

    #[test]
    fn the_fix_leaves_nothing_that_looks_alike() {
        let library = library();
        let colours = [[200, 190, 150], [203, 188, 152], [120, 160, 90], [170, 120, 90]];
        let patterns = ["sand", "sand", "shale", "shale"];
        let style = |n: usize| LayerStyle::textured("a", Colour { rgb: colours[n] }, patterns[n]);
        for preset in Preset::ALL {
            let mut styles: Vec<LayerStyle> = (0..4).map(style).collect();
            let touching = [[0, 1], [1, 2], [2, 3], [0, 3]];
            let mut found = confusions(&styles, &touching, preset, &library).unwrap();
            assert!(!found.is_empty());
            for _ in 0..4 {
                let Some(first) = found.first() else { break };
                let fix = first.remedy.clone().expect("a change that is enough");
                styles[fix.layer].colour = fix.colour;
                if let Some(pattern) = fix.pattern {
                    styles[fix.layer].intervals[0].texture = pattern;
                }
                found = confusions(&styles, &touching, preset, &library).unwrap();
            }
            assert_eq!(found, [], "{preset:?}");
        }
    }

    #[test]
    fn only_what_touches_is_compared() {
        let styles = [[9, 9, 9], [250, 250, 250], [9, 9, 9]].map(|rgb| LayerStyle::plain("a", Colour { rgb }));
        let found = |touching: &[[usize; 2]]| confusions(&styles, touching, Preset::Colour, &library()).unwrap();
        assert_eq!(found(&[[0, 1], [1, 2]]), []);
        assert_eq!(found(&[[0, 1], [1, 2], [0, 2]])[0].layers, [0, 2]);
    }

    #[test]
    fn lightness_is_that_of_the_standard() {
        // CIE L* of sRGB (119, 119, 119) is 50.03; red has L* 53.24, a* 80.09, b* 67.20.
        assert!((Vision::Greyscale.lab([119.0 / 255.0; 3])[0] - 50.03).abs() < 0.02);
        let [l, a, b] = lab_from_linear([1.0, 0.0, 0.0]);
        assert!((l - 53.24).abs() < 0.02 && (a - 80.09).abs() < 0.05 && (b - 67.20).abs() < 0.05, "{l} {a} {b}");
        for step in STEPS {
            let from = Colour::new(150, 120, 130);
            let lightness = |colour: Colour| Vision::Greyscale.lab(colour.to_unit())[0];
            assert!((lightness(lightened(from, step)) - lightness(from) - step).abs() < 0.6);
        }
    }
}
