//! Scale bars, and what a reader must know to read lengths.

use super::words::broken;
use crate::style::{INK, LEAST_TEXT_PT, NUMBER_PT, QUIET_INK, TEXT_PT};
use glam::DVec2;
use page::list::{Across, Group, GroupKind, Path, PathItem, Text, Upright, width_of};
use page::{Rect, list::Stroke};
use render::{Projection, Scene};
use survey::{SurveyGeometry, VerticalUnit};

/// Height of the strip that holds a scale bar, points.
pub(crate) const STRIP_PT: f64 = 24.0;
/// Part of the width that a bar may take.
const SHARE: f64 = 0.3;
/// Height of a bar, points.
const BAR_PT: f64 = 2.2;

/// Size of a caption's letters, and from one of its lines to the next, points.
const CAPTION_PT: f64 = TEXT_PT - 0.5;
const CAPTION_PITCH_PT: f64 = 9.5;

/// What exaggeration is called, and in little room.
const EXAGGERATION: [&str; 2] = ["vertical exaggeration", "V.E."];

/// The largest of 1, 2, 5 × 10ⁿ that is not larger.
pub(crate) fn round_length(longest: f64) -> f64 {
    let decade = 10f64.powf(longest.log10().floor());
    let lengths = [5.0, 2.0, 1.0].map(|factor| factor * decade);
    lengths.into_iter().find(|length| *length <= longest).unwrap_or(decade)
}

/// Longest upright bar, and the shortest that is drawn, points.
const UPRIGHT_PT: [f64; 2] = [26.0, 5.0];

/// A length in the unit that it is read in.
pub(crate) fn length_text(length_m: f64) -> String {
    if length_m >= 1000.0 { format!("{} km", length_m / 1000.0) } else { format!("{length_m} m") }
}

/// A bar of a round length at the left of a strip that is wide enough for its numbers, an upright one for depths or times,
/// and a caption beside them. `points_per_m` is the scale across on paper, and `down` the points of a unit of depth or
/// time with the unit's symbol; without them there is the caption alone.
pub fn drawn(strip: Rect, points_per_m: Option<f64>, down: Option<(f64, &str)>, caption: &str) -> Group {
    let mut group = Group::new(GroupKind::Annotation, "scale bar");
    let mut left = strip.min.x;
    let y = strip.min.y + 7.0;
    let longest_m = points_per_m.map(|scale| (SHARE * strip.width() / scale, scale));
    let bar = longest_m.filter(|(longest, _)| *longest > 0.0 && longest.is_finite()).map(|(longest_m, scale)| {
        let length_m = round_length(longest_m);
        // Under a short bar the number begins where the 0 has ended.
        (length_m, length_m * scale, (length_m * scale).max(8.0 + width_of(&length_text(length_m), NUMBER_PT)))
    });
    if let Some((length_m, length, room)) = bar.filter(|(.., room)| *room <= strip.width()) {
        // Two halves, one filled: the eye halves lengths by itself, and the bar prints on any ground.
        let bar = Rect::sized(DVec2::new(left, y - 0.5 * BAR_PT), DVec2::new(length, BAR_PT));
        group.push(PathItem::filled(Path::rect(bar), ttf::Colour::WHITE).outlined(Stroke::new(0.5, INK)));
        group.push(PathItem::filled(Path::rect(bar.split_across(0.5)[0]), INK));
        let at = |x: f64| DVec2::new(x, bar.max.y + 3.0);
        let number = |x: f64, text: String| Text::new(at(x), text).sized(NUMBER_PT).inked(INK);
        group.push(number(left, "0".into()).anchored(Across::Start, Upright::Top));
        let end = number(left + room, length_text(length_m));
        group.push(end.anchored(Across::End, Upright::Top));
        left += room + 14.0;
    }
    // What a reader must know comes before the second bar.
    let bar = down.and_then(|down| upright(DVec2::new(left, strip.min.y), strip, down));
    let is_said = |(_, text): &(Rect, Text)| {
        let room = strip.max.x - (text.at.x + text.width() + 14.0);
        caption_lines(caption, room).iter().all(|line| width_of(line, LEAST_TEXT_PT) <= room)
    };
    if let Some((bar, text)) = bar.filter(is_said) {
        left = text.at.x + text.width() + 14.0;
        group.push(PathItem::filled(Path::rect(bar), ttf::Colour::WHITE).outlined(Stroke::new(0.5, INK)));
        group.push(PathItem::filled(Path::rect(bar.split_down(0.5)[0]), INK));
        group.push(text);
    }
    if !caption.is_empty() {
        let room = strip.max.x - left;
        for (n, line) in caption_lines(caption, room).into_iter().enumerate() {
            let text = Text::new(DVec2::new(left, y + CAPTION_PITCH_PT * n as f64), line).sized(CAPTION_PT);
            let text = text.inked(QUIET_INK).anchored(Across::Start, Upright::Middle).fitted(room);
            if !text.text.is_empty() {
                group.push(text);
            }
        }
    }
    group
}

/// A caption in one line, or, where there is little room, in short words and two lines.
fn caption_lines(caption: &str, room: f64) -> Vec<String> {
    if width_of(caption, LEAST_TEXT_PT) <= room {
        return vec![caption.to_owned()];
    }
    broken(&caption.replacen(EXAGGERATION[0], EXAGGERATION[1], 1), LEAST_TEXT_PT, room, 2)
}

/// An upright bar of a round length in a strip, and its number.
fn upright(at: DVec2, strip: Rect, (points, symbol): (f64, &str)) -> Option<(Rect, Text)> {
    let longest = (strip.height() - 3.0).min(UPRIGHT_PT[0]) / points;
    let length = if longest > 0.0 && longest.is_finite() { round_length(longest) } else { return None };
    let bar = Rect::sized(at + DVec2::new(0.5, 1.5), DVec2::new(BAR_PT, length * points));
    let said = if symbol == "m" { length_text(length) } else { format!("{length} {symbol}") };
    let text = Text::new(DVec2::new(bar.max.x + 4.0, bar.centre().y), said).sized(NUMBER_PT).inked(INK);
    let text = text.anchored(Across::Start, Upright::Middle);
    (bar.height() >= UPRIGHT_PT[1] && text.bounds().max.x <= strip.max.x).then_some((bar, text))
}

/// "vertical exaggeration 2.5 at 2000 m/s": the velocity where time stands for depth.
pub fn exaggeration(factor: f64, geometry: &SurveyGeometry) -> String {
    let rounded = (factor * 100.0).round() / 100.0;
    let mut text = format!("{} {rounded}", EXAGGERATION[0]);
    if geometry.vertical.unit == VerticalUnit::Milliseconds {
        text += &format!(" at {} m/s", geometry.velocity_m_s);
    }
    text
}

/// What a reader must know to read lengths on a block.
pub(crate) fn block_caption(scene: &Scene, geometry: &SurveyGeometry) -> String {
    let mut text = exaggeration(scene.exaggeration, geometry);
    if matches!(scene.camera.projection, Projection::Perspective { .. }) {
        text += "; lengths hold in the middle of the block";
    }
    text
}

#[cfg(test)]
mod tests;
