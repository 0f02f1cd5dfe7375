//! At most 256 colours for an image: median cut (Heckbert, "Color Image Quantization for Frame Buffer Display", SIGGRAPH
//! 1982) on colours of five bits a channel, where the box with the largest spread times number of pixels is cut next.
//! The colour of a box is the mean of its pixels.

use image::RgbaImage;

/// Bits of a channel by which pixels are told apart.
const BITS: u32 = 5;
/// Number of such colours.
const BINS: usize = 1 << (3 * BITS);

/// Colours, and which of them each pixel has.
pub struct Paletted {
    /// The colours.
    pub colours: Vec<[u8; 3]>,
    /// The index of the clear pixels' entry, if there are such pixels: the one after the last colour.
    pub clear: Option<u8>,
    /// An index for each pixel, row by row.
    pub indices: Vec<u8>,
}

/// Pixels of nearly one colour.
#[derive(Clone, Copy, Default)]
struct Bin {
    count: u64,
    sums: [u64; 3],
}

impl Bin {
    fn mean(&self, channel: usize) -> f64 {
        self.sums[channel] as f64 / self.count.max(1) as f64
    }

    fn join(&mut self, other: &Self) {
        self.count += other.count;
        (0..3).for_each(|channel| self.sums[channel] += other.sums[channel]);
    }
}

fn bin_of(rgba: [u8; 4]) -> usize {
    rgba[..3].iter().fold(0, |bin, channel| bin << BITS | usize::from(channel >> (8 - BITS)))
}

/// Whether a pixel is shown at all: a GIF knows nothing between clear and opaque.
fn is_clear(rgba: [u8; 4]) -> bool {
    rgba[3] < 128
}

/// Reduces an image to at most 256 colours, clear among them.
pub fn reduced(image: &RgbaImage) -> Paletted {
    let mut bins = vec![Bin::default(); BINS];
    let mut has_clear = false;
    for pixel in image.pixels() {
        if is_clear(pixel.0) {
            has_clear = true;
            continue;
        }
        let bin = &mut bins[bin_of(pixel.0)];
        bin.count += 1;
        (0..3).for_each(|channel| bin.sums[channel] += u64::from(pixel.0[channel]));
    }
    let used: Vec<usize> = (0..BINS).filter(|bin| bins[*bin].count > 0).collect();
    let boxes = cut(used, &bins, if has_clear { 255 } else { 256 });
    let mut entry_of = vec![0_u8; BINS];
    let mut colours = Vec::new();
    for (entry, members) in boxes.iter().enumerate() {
        let mut all = Bin::default();
        for &member in members {
            all.join(&bins[member]);
            entry_of[member] = entry as u8;
        }
        colours.push([0, 1, 2].map(|channel| all.mean(channel).round() as u8));
    }
    let clear = has_clear.then_some(colours.len() as u8);
    let index = |rgba: [u8; 4]| clear.filter(|_| is_clear(rgba)).unwrap_or_else(|| entry_of[bin_of(rgba)]);
    Paletted { indices: image.pixels().map(|pixel| index(pixel.0)).collect(), colours, clear }
}

/// Cuts bins into at most `most` boxes.
fn cut(used: Vec<usize>, bins: &[Bin], most: usize) -> Vec<Vec<usize>> {
    if used.is_empty() {
        return Vec::new();
    }
    let first = spread(&used, bins);
    let mut boxes = vec![(used, first)];
    while boxes.len() < most {
        let by_weight = |n: &usize, m: &usize| boxes[*n].1.weight.total_cmp(&boxes[*m].1.weight);
        let Some(next) = (0..boxes.len()).filter(|n| boxes[*n].0.len() > 1).max_by(by_weight) else { break };
        let (mut members, wide) = boxes.swap_remove(next);
        members.sort_by(|a, b| bins[*a].mean(wide.channel).total_cmp(&bins[*b].mean(wide.channel)));
        let half = members.iter().map(|bin| bins[*bin].count).sum::<u64>() / 2;
        let mut passed = 0;
        let middle = members.iter().position(|bin| {
            passed += bins[*bin].count;
            passed > half
        });
        // Each side keeps a colour.
        let right = members.split_off(middle.unwrap_or(0).clamp(1, members.len() - 1));
        for part in [members, right] {
            let wide = spread(&part, bins);
            boxes.push((part, wide));
        }
    }
    boxes.into_iter().map(|(members, _)| members).collect()
}

/// How far apart the colours of a box are.
struct Spread {
    /// The channel in which they are farthest apart.
    channel: usize,
    /// By how much, times the root of the number of pixels: few pixels that differ much count as many that differ
    /// little.
    weight: f64,
}

fn spread(members: &[usize], bins: &[Bin]) -> Spread {
    let range = |channel: usize| {
        let means = members.iter().map(|bin| bins[*bin].mean(channel));
        let (low, high) = means.fold((f64::MAX, f64::MIN), |(low, high), mean| (low.min(mean), high.max(mean)));
        high - low
    };
    let ranges = [0, 1, 2].map(range);
    let channel = (0..3).max_by(|a, b| ranges[*a].total_cmp(&ranges[*b])).unwrap_or(0);
    let count: u64 = members.iter().map(|bin| bins[*bin].count).sum();
    Spread { channel, weight: ranges[channel] * (count as f64).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn few_colours_are_kept_exactly() {
        let colours = [[10, 20, 30], [200, 10, 10], [250, 250, 250], [12, 90, 33]];
        let image = RgbaImage::from_fn(8, 8, |x, y| {
            let [r, g, b] = colours[(x + y) as usize % 4];
            Rgba([r, g, b, 255])
        });
        let found = reduced(&image);
        assert_eq!((found.colours.len(), found.clear), (4, None));
        for (index, pixel) in found.indices.iter().zip(image.pixels()) {
            assert_eq!(found.colours[usize::from(*index)], pixel.0[..3]);
        }
    }

    #[test]
    fn many_colours_become_256_near_ones_with_clear_pixels_apart() {
        let image = RgbaImage::from_fn(256, 256, |x, y| {
            Rgba([x as u8, y as u8, ((x * y) >> 8) as u8, if x == 0 { 0 } else { 255 }])
        });
        let found = reduced(&image);
        assert_eq!((found.colours.len(), found.clear), (255, Some(255)));
        let mut sum = 0_u64;
        for (index, pixel) in found.indices.iter().zip(image.pixels()) {
            assert_eq!(*index == 255, pixel.0[3] == 0);
            if *index < 255 {
                let colour = found.colours[usize::from(*index)];
                sum += (0..3).map(|c| u64::from(colour[c].abs_diff(pixel.0[c]))).sum::<u64>();
            }
        }
        let mean = sum as f64 / (3.0 * 255.0 * 256.0);
        assert!(mean < 9.0, "{mean}");
    }

    #[test]
    fn an_image_without_a_pixel_to_show_has_no_colours() {
        let found = reduced(&RgbaImage::new(3, 3));
        assert_eq!((found.colours.len(), found.clear, found.indices), (0, Some(0), vec![0; 9]));
    }
}
