//! The views that fill the middle of the window, and their places.

use crate::state::{Layout, SectionKind};
use eframe::egui::Rect;

/// A view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutPane {
    /// The block.
    Block,
    /// A section.
    Section(SectionKind),
    /// The map.
    Map,
    /// The fence.
    Fence,
}

/// Gap between views, points.
const GAP: f32 = 3.0;

/// Two views stand side by side where the room is at least this many times as wide as high, otherwise one above the
/// other.
const BROAD: f32 = 1.2;

/// The views of a layout with their places in a rectangle.
pub fn parts(layout: Layout, whole: Rect) -> Vec<(LayoutPane, Rect)> {
    let two = |first: LayoutPane, second: LayoutPane| {
        let is_broad = whole.width() > BROAD * whole.height();
        let (a, b) =
            if is_broad { whole.split_left_right_at_fraction(0.42) } else { whole.split_top_bottom_at_fraction(0.42) };
        vec![(first, a.shrink(GAP)), (second, b.shrink(GAP))]
    };
    match layout {
        Layout::Block => vec![(LayoutPane::Block, whole)],
        Layout::Map => two(LayoutPane::Block, LayoutPane::Map),
        Layout::Fence => two(LayoutPane::Section(SectionKind::Slice), LayoutPane::Fence),
        Layout::Sections => {
            let (top, bottom) = whole.split_top_bottom_at_fraction(0.5);
            let rows = [
                (top, [LayoutPane::Block, LayoutPane::Section(SectionKind::Inline)]),
                (bottom, [LayoutPane::Section(SectionKind::Slice), LayoutPane::Section(SectionKind::Crossline)]),
            ];
            let quarters = rows.into_iter().flat_map(|(row, [first, second])| {
                let (left, right) = row.split_left_right_at_fraction(0.5);
                [(first, left.shrink(GAP)), (second, right.shrink(GAP))]
            });
            quarters.collect()
        }
    }
}
