//! Shares that are shown and typed in percent.

use eframe::egui::{DragValue, Slider};
use std::ops::RangeInclusive;

/// The part of a hundred that the text means, with or without its sign.
fn share(text: &str) -> Option<f64> {
    text.trim().trim_end_matches('%').trim().parse::<f64>().ok().map(|percent| percent / 100.0)
}

fn shown(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// A share from 0 to 1 to drag or type.
pub fn drag(share_of: &mut f32) -> DragValue<'_> {
    DragValue::new(share_of).speed(0.01).range(0.0..=1.0).custom_formatter(|value, _| shown(value)).custom_parser(share)
}

/// A share from 0 to 1 as a slider.
pub(crate) fn slider(share_of: &mut f32) -> Slider<'_> {
    slider_to(share_of, 1.0)
}

/// A share from 0 to `most` as a slider.
pub(crate) fn slider_to(share_of: &mut f32, most: f32) -> Slider<'_> {
    slider_within(share_of, 0.0..=most)
}

/// A share within a range as a slider.
pub(crate) fn slider_within(share_of: &mut f32, range: RangeInclusive<f32>) -> Slider<'_> {
    Slider::new(share_of, range).custom_formatter(|value, _| shown(value)).custom_parser(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_is_read_back() {
        for value in [0.0, 0.07, 0.5, 1.0] {
            assert_eq!(share(&shown(value)), Some(value));
        }
        assert_eq!((share("35"), share(" 35% "), share("half")), (Some(0.35), Some(0.35), None));
    }
}
