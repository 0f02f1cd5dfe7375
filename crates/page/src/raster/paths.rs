//! Paths, strokes and colours as `tiny-skia` takes them.

use crate::list::{Cap, Ink, Path, Rule, Segment, Stroke};
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, StrokeDash};

/// A path in pixels; `None` of one that has no extent or is not finite.
pub(super) fn trace(path: &Path, scale: f64) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let px = |p: glam::DVec2| ((p.x * scale) as f32, (p.y * scale) as f32);
    for segment in &path.segments {
        match *segment {
            Segment::Move(p) => {
                let (x, y) = px(p);
                builder.move_to(x, y);
            }
            Segment::Line(p) => {
                let (x, y) = px(p);
                builder.line_to(x, y);
            }
            Segment::Cubic(a, b, c) => {
                let ((ax, ay), (bx, by), (cx, cy)) = (px(a), px(b), px(c));
                builder.cubic_to(ax, ay, bx, by, cx, cy);
            }
            Segment::Close => builder.close(),
        }
    }
    builder.finish()
}

pub(super) fn rule(rule: Rule) -> FillRule {
    match rule {
        Rule::NonZero => FillRule::Winding,
        Rule::EvenOdd => FillRule::EvenOdd,
    }
}

/// A stroke in pixels with its colour; `None` of one without a width.
pub(super) fn stroke(stroke: &Stroke, scale: f64) -> Option<(tiny_skia::Stroke, Paint<'static>)> {
    let width = (stroke.width * scale) as f32;
    if !(width > 0.0 && width.is_finite()) {
        return None;
    }
    let dashes: Vec<f32> = stroke.dashes.iter().map(|length| ((length * scale) as f32).max(1e-3)).collect();
    let line_cap = match stroke.cap {
        Cap::Butt => LineCap::Butt,
        Cap::Round => LineCap::Round,
    };
    let drawn = tiny_skia::Stroke {
        width,
        line_cap,
        line_join: LineJoin::Round,
        dash: if dashes.is_empty() { None } else { StrokeDash::new(dashes, 0.0) },
        ..tiny_skia::Stroke::default()
    };
    Some((drawn, paint(stroke.ink)))
}

pub(super) fn paint(ink: Ink) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(colour(ink));
    paint
}

pub(super) fn colour(ink: Ink) -> Color {
    let [r, g, b] = ink.colour.rgb;
    Color::from_rgba8(r, g, b, (ink.opacity.clamp(0.0, 1.0) * 255.0).round() as u8)
}
