//! A tile as pixels: mip chain, average colour, filtered sampling.
//!
//! **Storage.** Level 0 is a square of [`TEXTURE_SIDE_PX`] texels a side. Each level is half as large as the
//! one before, down to 1 × 1: the mean of 2 × 2 texels, computed in f32 from the unrounded level before and
//! rounded once. Texels are RGBA8, sRGB-encoded and **premultiplied**, so that filtering ink on a transparent
//! ground never darkens its edge. **Row 0 is the bottom of the tile (v = 0), u runs right**: the rows of an
//! image file are reversed when it is read.
//!
//! **Sampling** (the WGSL twin follows the same steps; S = side of level 0 in texels, all f32):
//! 1. Footprint: A = S·∂(u, v)/∂x, B = S·∂(u, v)/∂y for one sample step on the image. With p = A.u² + B.u², q
//!    = A.u·A.v + B.u·B.v, r = A.v² + B.v²: λ± = (p + r)/2 ± √(((p − r)/2)² + q²); major = √λ₊, minor =
//!    √max(λ₋, 0).
//! 2. Level: lod = log2(max(minor, major/8, 1)), clamped to the last level.
//! 3. Taps: N = clamp(⌈major/2^lod − 0.01⌉, 1, 8), at (u, v) + ((n + ½)/N − ½)·(major/S)·e for n = 0 … N − 1,
//!    e the unit eigenvector of λ₊: (λ₊ − r, q) or (q, λ₊ − p), whichever is longer, (1, 0) if both vanish.
//!    Equal weights.
//! 4. Each tap is trilinear: levels ⌊lod⌋ and ⌊lod⌋ + 1 mixed by the fraction; in a level of side s the texel
//!    coordinate is fract(u)·s − ½, bilinear, with wrap-around.
//!
//! The taps divide the major axis of the footprint into boxes as wide as the minor axis, so a pattern on a
//! stretched parameterization is neither blurred across nor aliased along that axis.

/// Side of a texture at level 0 in texels. At 300 dpi a tile of 19 mm is printed with 224 pixels; twice that
/// allows zooming.
pub const TEXTURE_SIDE_PX: u32 = 512;

/// Largest number of taps along the major axis. Footprints up to 8 : 1 are filtered exactly; longer ones are
/// blurred across.
pub const MAX_TAPS: u32 = 8;

/// A tile with its mip chain.
///
/// ```
/// let library = ttf::TextureLibrary::builtin().unwrap();
/// let plain = library.texture(library.find("plain").unwrap()).unwrap();
/// assert_eq!(plain.side_px(), ttf::texture::TEXTURE_SIDE_PX);
/// // A tile without ink is transparent everywhere.
/// assert_eq!(plain.sample([0.3, 0.7], [0.0; 2], [0.0; 2]), [0.0; 4]);
/// assert_eq!(plain.average_over([0.25, 0.5, 1.0], None), [0.25, 0.5, 1.0]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    levels: Vec<Vec<[u8; 4]>>,
    mean: [f32; 4],
}

impl Texture {
    /// A texture from the premultiplied texels of level 0, bottom row first, each channel in [0, 1].
    ///
    /// # Panics
    /// If the count of texels is not the square of a power of two. Callers resample first.
    pub(crate) fn from_premultiplied(mut texels: Vec<[f32; 4]>) -> Self {
        let mut side = texels.len().isqrt();
        assert!(side.is_power_of_two() && side * side == texels.len(), "{} texels", texels.len());
        let mut levels = vec![quantize(&texels)];
        while side > 1 {
            texels = halve(&texels, side);
            side /= 2;
            levels.push(quantize(&texels));
        }
        Self { levels, mean: texels[0] }
    }

    /// Texels a side at level 0.
    pub fn side_px(&self) -> u32 {
        TEXTURE_SIDE_PX.min(1 << (self.levels.len() - 1))
    }

    /// The mip levels, largest first. Rows run bottom to top; texels are RGBA8, premultiplied.
    pub fn levels(&self) -> &[Vec<[u8; 4]>] {
        &self.levels
    }

    /// Mean of all texels, premultiplied.
    pub fn mean(&self) -> [f32; 4] {
        self.mean
    }

    /// The average colour of the tile on `background`; `ink` recolours it (see [`crate::LayerStyle::ink`]).
    pub fn average_over(&self, background: [f32; 3], ink: Option<[f32; 3]>) -> [f32; 3] {
        let [r, g, b, alpha] = self.mean;
        let top = ink.map_or([r, g, b], |ink| ink.map(|channel| channel * alpha));
        std::array::from_fn(|c| top[c] + background[c] * (1.0 - alpha))
    }

    /// The filtered texel at `uv` (tile units, wrapping), premultiplied. `duv_dx` and `duv_dy` are the
    /// changes of uv over one sample step to the right and down the image. The module documentation states
    /// the rule.
    pub fn sample(&self, uv: [f32; 2], duv_dx: [f32; 2], duv_dy: [f32; 2]) -> [f32; 4] {
        let side = self.side_px() as f32;
        let footprint = Footprint::new(side, duv_dx, duv_dy);
        let lod = footprint.lod.min((self.levels.len() - 1) as f32);
        let mut sum = [0.0; 4];
        for tap in 0..footprint.taps {
            let offset = (tap as f32 + 0.5) / footprint.taps as f32 - 0.5;
            let at = [uv[0] + offset * footprint.axis[0], uv[1] + offset * footprint.axis[1]];
            let texel = self.trilinear(at, lod);
            for channel in 0..4 {
                sum[channel] += texel[channel];
            }
        }
        sum.map(|channel| channel / (255 * footprint.taps) as f32)
    }

    fn trilinear(&self, uv: [f32; 2], lod: f32) -> [f32; 4] {
        let lower = floor(lod);
        let fraction = lod - lower as f32;
        let lower = lower as usize;
        let near = self.bilinear(uv, lower);
        let far = self.bilinear(uv, (lower + 1).min(self.levels.len() - 1));
        std::array::from_fn(|channel| near[channel] + (far[channel] - near[channel]) * fraction)
    }

    /// In units of 1/255: the caller divides once.
    fn bilinear(&self, uv: [f32; 2], level: usize) -> [f32; 4] {
        let texels = &self.levels[level];
        let side = (self.side_px() as usize) >> level;
        let place = |coordinate: f32| {
            let texel = (coordinate - floor(coordinate) as f32) * side as f32 - 0.5;
            let low = floor(texel);
            // The side is a power of two, so the mask wraps, from -1 to the last texel too.
            let index = low as usize & (side - 1);
            (index, (index + 1) & (side - 1), texel - low as f32)
        };
        let (x0, x1, fx) = place(uv[0]);
        let (y0, y1, fy) = place(uv[1]);
        let [a, b] = [texels[y0 * side + x0], texels[y0 * side + x1]];
        let [c, d] = [texels[y1 * side + x0], texels[y1 * side + x1]];
        std::array::from_fn(|channel| {
            let at = |texel: [u8; 4]| f32::from(texel[channel]);
            let bottom = at(a) + (at(b) - at(a)) * fx;
            let top = at(c) + (at(d) - at(c)) * fx;
            bottom + (top - bottom) * fy
        })
    }
}

/// The largest integer that is not above `x`. `f32::floor` is a library call on x86-64 without extensions.
fn floor(x: f32) -> i32 {
    let truncated = x as i32;
    truncated - i32::from(truncated as f32 > x)
}

/// Steps 1 to 3 of the sampling rule.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Footprint {
    /// Level of detail before the clamp to the last level.
    lod: f32,
    /// Number of taps.
    taps: u32,
    /// The major axis in tile units, at full length.
    axis: [f32; 2],
}

impl Footprint {
    fn new(side: f32, duv_dx: [f32; 2], duv_dy: [f32; 2]) -> Self {
        let a = duv_dx.map(|part| part * side);
        let b = duv_dy.map(|part| part * side);
        let p = a[0] * a[0] + b[0] * b[0];
        let q = a[0] * a[1] + b[0] * b[1];
        let r = a[1] * a[1] + b[1] * b[1];
        let half_sum = (p + r) * 0.5;
        let half_difference = (p - r) * 0.5;
        let root = (half_difference * half_difference + q * q).sqrt();
        let major_sq = half_sum + root;
        let major = major_sq.sqrt();
        let minor = (half_sum - root).max(0.0).sqrt();
        let width = minor.max(major / MAX_TAPS as f32).max(1.0);
        let taps = ((major / width - 0.01).ceil() as u32).clamp(1, MAX_TAPS);
        let first = [major_sq - r, q];
        let second = [q, major_sq - p];
        let length_sq = |v: [f32; 2]| v[0] * v[0] + v[1] * v[1];
        let longer = if length_sq(first) >= length_sq(second) { first } else { second };
        let length = length_sq(longer).sqrt();
        let axis = if length > 0.0 { longer.map(|part| part / length) } else { [1.0, 0.0] };
        Self { lod: width.log2(), taps, axis: axis.map(|part| part * major / side) }
    }
}

/// Each texel becomes the mean of a 2 × 2 box.
fn halve(texels: &[[f32; 4]], side: usize) -> Vec<[f32; 4]> {
    let half = side / 2;
    (0..half * half)
        .map(|index| {
            let corner = (index / half) * 2 * side + (index % half) * 2;
            let box_ = [corner, corner + 1, corner + side, corner + side + 1];
            std::array::from_fn(|channel| box_.iter().map(|&texel| texels[texel][channel]).sum::<f32>() * 0.25)
        })
        .collect()
}

fn quantize(texels: &[[f32; 4]]) -> Vec<[u8; 4]> {
    let byte = |channel: f32| (channel.clamp(0.0, 1.0) * 255.0).round() as u8;
    texels.iter().map(|texel| texel.map(byte)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: [f32; 2] = [0.0, 0.0];

    /// 8 × 8, red rises with u, green with v, blue a checker, opaque.
    fn ramps() -> Texture {
        let texel = |index: usize| {
            let (x, y) = (index % 8, index / 8);
            [x as f32 / 7.0, y as f32 / 7.0, ((x + y) % 2) as f32, 1.0]
        };
        Texture::from_premultiplied((0..64).map(texel).collect())
    }

    #[test]
    fn each_level_has_the_mean_of_the_one_before() {
        let texture = ramps();
        assert_eq!(texture.levels().len(), 4);
        for level in texture.levels() {
            for (channel, expected) in [0.5_f32, 0.5, 0.5, 1.0].into_iter().enumerate() {
                let mean =
                    level.iter().map(|texel| f32::from(texel[channel])).sum::<f32>() / (255.0 * level.len() as f32);
                assert!((mean - expected).abs() < 0.5 / 255.0 + 1e-6, "channel {channel}: {mean}");
            }
        }
    }

    #[test]
    fn a_checker_averages_to_its_mean_over_the_background() {
        let black_half = (0..16).map(|i| [0.0, 0.0, 0.0, ((i % 4 + i / 4) % 2) as f32]).collect();
        let texture = Texture::from_premultiplied(black_half);
        assert_eq!(texture.average_over([1.0, 0.5, 0.0], None), [0.5, 0.25, 0.0]);
        assert_eq!(texture.average_over([1.0, 0.5, 0.0], Some([0.0, 0.5, 1.0])), [0.5, 0.5, 0.5]);
    }

    #[test]
    fn texel_centres_are_exact_and_coordinates_wrap() {
        let texture = ramps();
        for (x, y) in [(0_usize, 0_usize), (3, 5), (7, 7)] {
            let uv = [(x as f32 + 0.5) / 8.0, (y as f32 + 0.5) / 8.0];
            let expected = texture.levels()[0][y * 8 + x].map(|byte| f32::from(byte) / 255.0);
            for shift in [[0.0, 0.0], [3.0, -2.0], [-1.0, 1.0]] {
                let found = texture.sample([uv[0] + shift[0], uv[1] + shift[1]], STILL, STILL);
                for channel in 0..4 {
                    assert!((found[channel] - expected[channel]).abs() < 1e-4);
                }
            }
        }
        // On the seam the last and the first column are mixed half and half.
        assert!((texture.sample([0.0, 0.5 / 8.0], STILL, STILL)[0] - 0.5).abs() < 1e-6);
    }

    #[test]
    fn a_footprint_of_the_whole_tile_is_the_mean() {
        let found = ramps().sample([0.3, 0.9], [1.0, 0.0], [0.0, 1.0]);
        assert!((found[0] - 0.5).abs() < 1.0 / 255.0 && (found[2] - 0.5).abs() < 1.0 / 255.0);
    }

    #[test]
    fn a_long_footprint_blurs_along_and_stays_sharp_across() {
        // Columns black and white, 64 wide; the footprint is long in v, narrow in u.
        let columns = (0..64 * 64).map(|i| [(i / 8 % 2) as f32, 0.0, 0.0, 1.0]).collect();
        let texture = Texture::from_premultiplied(columns);
        let at = |u: f32, du: [f32; 2], dv: [f32; 2]| texture.sample([u, 0.4], du, dv)[0];
        let long = [0.0, 8.0 / 64.0];
        assert!(at(4.0 / 64.0, [1.0 / 64.0, 0.0], long) < 0.01);
        assert!(at(12.0 / 64.0, [1.0 / 64.0, 0.0], long) > 0.99);
        // Turned by 90 degrees the same footprint spans black and white.
        let across = at(8.0 / 64.0, [0.0, 1.0 / 64.0], [8.0 / 64.0, 0.0]);
        assert!((across - 0.5).abs() < 0.02, "{across}");
    }

    #[test]
    fn the_footprint_finds_the_axes_of_a_turned_ellipse() {
        let (sin, cos) = 0.6_f32.sin_cos();
        let footprint =
            Footprint::new(64.0, [6.0 * cos / 64.0, 6.0 * sin / 64.0], [-2.0 * sin / 64.0, 2.0 * cos / 64.0]);
        assert_eq!(footprint.taps, 3);
        assert!((footprint.lod - 1.0).abs() < 1e-5);
        let length = footprint.axis[0].hypot(footprint.axis[1]) * 64.0;
        assert!((length - 6.0).abs() < 1e-4);
        assert!((footprint.axis[1] / footprint.axis[0] - 0.6_f32.tan()).abs() < 1e-4);
        let still = Footprint::new(64.0, STILL, STILL);
        assert_eq!((still.lod, still.taps), (0.0, 1));
    }
}
