//! Patterns that keep their size on paper while one zooms.
//!
//! On paper a brick is as large in a close-up as in an overview. So the frequency of every pattern follows the scale of
//! the picture in steps of a quarter of an octave: between two steps the pattern is fixed to the rock, and in the
//! middle of each interval it is dissolved into the one of the next step, so that nothing pops while one zooms. A picture
//! that stands alone has the nearer of the two, because strokes of two sizes over one another are pale. Elements on a
//! square centimetre of the picture then vary by less than a factor of 1.5 over any range of scales.

use crate::camera::{Camera, View};
use crate::scene::{PatternSize, Scene};
use survey::SurveyGeometry;

/// Half the width of the dissolve between two steps, in steps.
const DISSOLVE: f64 = 0.15;

/// The frequencies at which patterns are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frequencies {
    /// Factor on every frequency.
    pub factor: f32,
    /// Share of the pattern that is [`ttf::FINER`] times as dense, 0 to 1.
    pub finer_share: f32,
}

impl Frequencies {
    /// Those of a scene that `view` shows.
    pub fn of(scene: &Scene, geometry: &SurveyGeometry, view: &View) -> Self {
        match scene.pattern_size {
            PatternSize::Rock => Self { factor: scene.global_frequency, finer_share: 0.0 },
            PatternSize::Paper => {
                let camera = Camera { zoom: 1.0, target: None, pan: [0.0; 2], ..scene.camera };
                let whole = Scene { camera, roaming_box: None, ..scene.clone() }.view(geometry);
                let magnified = view.pixels_per_metre() / whole.pixels_per_metre();
                let dissolved = Self::at(magnified);
                let Self { factor, finer_share } = if scene.in_motion { dissolved } else { dissolved.alone() };
                Self { factor: factor * scene.global_frequency, finer_share }
            }
        }
    }

    /// Those at a magnification.
    fn at(magnified: f64) -> Self {
        let finer = f64::from(ttf::FINER);
        let steps = magnified.log(finer);
        // The last digit of a logarithm must not decide on the picture of the whole survey.
        let whole = (steps + 1e-9).floor();
        let share = ((steps - whole - 0.5 + DISSOLVE) / (2.0 * DISSOLVE)).clamp(0.0, 1.0);
        let smooth = share * share * (3.0 - 2.0 * share);
        Self { factor: finer.powf(whole) as f32, finer_share: smooth as f32 }
    }

    /// The frequency of which more is seen, alone.
    fn alone(self) -> Self {
        let factor = self.factor * if self.finer_share > 0.5 { ttf::FINER } else { 1.0 };
        Self { factor, finer_share: 0.0 }
    }

    /// The one frequency nearest to both, for paths, which cannot be dissolved.
    pub fn nearest(globals: &ttf::TtfGlobals) -> f32 {
        Self { factor: globals.global_frequency, finer_share: globals.finer_share }.alone().factor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_on_paper_hardly_vary_over_a_factor_of_64() {
        let densities = (0..=6000).map(|n| {
            let magnified = 64f64.powf(f64::from(n) / 6000.0);
            let Frequencies { factor, finer_share } = Frequencies::at(magnified);
            // Elements on an area, of each of the two patterns, counted by how much of each is seen.
            let of = |factor: f64| (factor / magnified).powi(2);
            let (coarse, finer) = (of(f64::from(factor)), of(f64::from(factor * ttf::FINER)));
            let alone = of(f64::from(Frequencies::at(magnified).alone().factor));
            [alone, coarse + f64::from(finer_share) * (finer - coarse)]
        });
        let (least, most) =
            densities.flatten().fold((f64::MAX, 0.0f64), |(least, most), d| (least.min(d), most.max(d)));
        assert!(most / least < 1.5, "{}", most / least);
    }

    #[test]
    fn nothing_pops_and_the_whole_survey_stays_as_it_is() {
        assert_eq!(Frequencies::at(1.0), Frequencies { factor: 1.0, finer_share: 0.0 });
        let mut last = Frequencies::at(1.0);
        for n in 1..=20_000 {
            let next = Frequencies::at(64f64.powf(f64::from(n) / 20_000.0));
            // Either the share changes a little, or all of the finer pattern becomes the coarser of the next step.
            let changed = if next.factor == last.factor {
                next.finer_share - last.finer_share
            } else {
                1.0 - last.finer_share + next.finer_share
            };
            assert!((0.0..0.01).contains(&changed), "{last:?} {next:?}");
            last = next;
        }
    }
}
