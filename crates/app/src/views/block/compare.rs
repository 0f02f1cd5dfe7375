//! Compared pictures: where each lies, which part of it is visible, and what divides them.

use crate::state::{Compare, Panel, Session};
use crate::widgets::theme;
use eframe::egui::{Align2, Color32, FontId, Rect, Stroke, Ui, Vec2, pos2, vec2};

/// Below this ratio of width to height a view is too narrow for two blocks side by side.
const NARROW: f32 = 1.4;

/// How pictures are compared; while interpreting there is only one.
pub fn compare(session: &Session) -> Compare {
    if session.view.panel == Panel::Interpret { Compare::Blend } else { session.view.compare }
}

/// The rectangles of the compared pictures. Blocks are wider than high, so in a narrow view two of them lie one above
/// the other.
pub(crate) fn panes(compare: Compare, rect: Rect) -> Vec<Rect> {
    match compare {
        Compare::SideBySide => {
            let (first, second) = if is_narrow(rect) {
                rect.split_top_bottom_at_fraction(0.5)
            } else {
                rect.split_left_right_at_fraction(0.5)
            };
            vec![first, second]
        }
        Compare::Blend => vec![rect],
        Compare::Wipe => vec![rect, rect],
    }
}

fn is_narrow(rect: Rect) -> bool {
    rect.width() < NARROW * rect.height()
}

/// The part of a pane in which its picture is visible.
pub fn clip(compare: Compare, index: usize, rect: Rect, wipe: f32) -> Rect {
    let wipe_x = rect.left() + rect.width() * wipe;
    match (compare, index) {
        (Compare::Wipe, 0) => Rect::from_min_max(rect.min, pos2(wipe_x, rect.max.y)),
        (Compare::Wipe, _) => Rect::from_min_max(pos2(wipe_x, rect.min.y), rect.max),
        _ => rect,
    }
}

/// Paints the dividing line and the captions of compared pictures.
pub(crate) fn rule(ui: &Ui, compare: Compare, whole: Rect, wipe: f32) {
    let painter = ui.painter_at(whole);
    let thin = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    let (at, align) = match compare {
        Compare::Blend => return,
        Compare::SideBySide if is_narrow(whole) => {
            painter.hline(whole.x_range(), whole.center().y, thin);
            ([whole.min, whole.left_center()].map(|at| at + vec2(12.0, 10.0)), [Align2::LEFT_TOP; 2])
        }
        _ => {
            let accent = theme::accent(ui.visuals());
            let is_wipe = compare == Compare::Wipe;
            let x = if is_wipe { whole.left() + whole.width() * wipe } else { whole.center().x };
            painter.vline(x, whole.y_range(), if is_wipe { Stroke::new(2.0, accent) } else { thin });
            if is_wipe {
                painter.circle_filled(pos2(x, whole.center().y), 8.0, accent);
            }
            let top = pos2(x, whole.top() + 10.0);
            ([top - vec2(12.0, 0.0), top + vec2(12.0, 0.0)], [Align2::RIGHT_TOP, Align2::LEFT_TOP])
        }
    };
    for ((at, align), text) in at.into_iter().zip(align).zip(["illustrated", "raw"]) {
        // Pictures lie on light paper in either theme.
        painter.text(at, align, text, FontId::proportional(13.0), Color32::from_gray(0x20));
    }
}

/// The largest rectangle with a picture's aspect ratio, centred in another: a picture drawn before the view was resized
/// keeps its shape.
pub(super) fn fitted(rect: Rect, shape: Vec2) -> Rect {
    let scale = (rect.width() / shape.x).min(rect.height() / shape.y);
    let is_same = (rect.width() / rect.height() / (shape.x / shape.y) - 1.0).abs() < 0.03;
    if is_same { rect } else { Rect::from_center_size(rect.center(), shape * scale) }
}
