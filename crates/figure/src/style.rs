//! Sizes and colours that all figures share, so that they look like figures of one book.
//!
//! Type is 7 to 11 points, lines are 0.4 to 1.6 points, ink is a warm black, and what merely frames is grey.

pub use page::style::{INK, LEAST_TEXT_PT, TEXT_PT};
use ttf::Colour;

/// Font size of titles, points.
pub(crate) const TITLE_PT: f64 = 9.5;
/// Font size of numbers along axes, points.
pub const NUMBER_PT: f64 = 7.0;

/// Numbers along axes and captions.
pub(crate) const QUIET_INK: Colour = Colour::new(0x57, 0x51, 0x4a);
/// Thin frames and rules between panels.
pub(crate) const RULE_INK: Colour = Colour::new(0x8c, 0x86, 0x7e);
/// Where other sections run: ochre, as rock paintings have it.
pub(crate) const ACCENT: Colour = Colour::new(0xa4, 0x4a, 0x1c);
/// Proposed faults.
pub const PROPOSAL: Colour = Colour::new(0xb0, 0x1e, 0x1e);
/// Where a section has no data.
pub(crate) const NO_DATA: Colour = Colour::new(0xdc, 0xdc, 0xda);

/// Width of frames and ticks, points.
pub(crate) const FRAME_PT: f64 = 0.5;
/// Length of ticks, points.
pub(crate) const TICK_PT: f64 = 2.6;
/// Width of horizons on sections, points.
pub(crate) const HORIZON_PT: f64 = 1.2;
/// Width of faults on sections, points: the heaviest lines of a figure.
pub(crate) const FAULT_PT: f64 = 1.45;
/// How much wider the light rim under a line is, points.
pub(crate) const RIM_PT: f64 = 1.2;
/// Opacity of that rim.
pub(crate) const RIM_OPACITY: f32 = 0.6;

/// Colours that horizons get in turn, wherever they are drawn: told apart by most eyes, and on grey.
pub const HORIZON_COLOURS: [Colour; 8] = [
    Colour::new(0xd5, 0x5e, 0x00),
    Colour::new(0x00, 0x72, 0xb2),
    Colour::new(0x00, 0x9e, 0x73),
    Colour::new(0xcc, 0x79, 0xa7),
    Colour::new(0xe6, 0x9f, 0x00),
    Colour::new(0x56, 0xb4, 0xe9),
    Colour::new(0x8c, 0x51, 0x0a),
    Colour::new(0x54, 0x27, 0x88),
];

/// The colour of a horizon: its own, or else that of its place in the order of age.
pub fn horizon_colour(own: Option<Colour>, index: usize) -> Colour {
    own.unwrap_or(HORIZON_COLOURS[index % HORIZON_COLOURS.len()])
}
