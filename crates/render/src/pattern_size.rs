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
    pub(crate) fn of(scene: &Scene, geometry: &SurveyGeometry, view: &View) -> Self {
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
    pub(crate) fn nearest(globals: &ttf::TtfGlobals) -> f32 {
        Self { factor: globals.global_frequency, finer_share: globals.finer_share }.alone().factor
    }
}

#[cfg(test)]
mod tests;
