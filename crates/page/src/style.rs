//! Letters as they are unless a page says otherwise: their size and ink.

use ttf::Colour;

/// Font size of text, points.
pub const TEXT_PT: f64 = 8.0;
/// No text is smaller on paper, whatever the page's size, points: what has no room is shortened or left out.
pub const LEAST_TEXT_PT: f64 = 7.0;
/// Letters and the lines that belong to them: a warm black.
pub const INK: Colour = Colour::new(0x23, 0x1f, 0x1b);
