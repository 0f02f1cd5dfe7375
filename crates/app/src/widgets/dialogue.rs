//! A dialogue in the middle of the window.

use eframe::egui::{Context, CornerRadius, Frame, Id, Margin, Modal, ModalResponse, Ui, Vec2};

/// Shows a dialogue; nothing behind it answers.
pub fn show<T>(ctx: &Context, name: &str, content: impl FnOnce(&mut Ui) -> T) -> ModalResponse<T> {
    let id = Id::unique(name);
    let frame = Frame::popup(&ctx.global_style()).inner_margin(Margin::same(20)).corner_radius(CornerRadius::same(10));
    let shown = Modal::new(id).frame(frame).show(ctx, content);
    // A frame is laid out around the size of the one before, and without an event none would follow.
    let size = shown.response.rect.size();
    let before = ctx.data_mut(|data| std::mem::replace(data.get_temp_mut_or(id.with("size"), Vec2::ZERO), size));
    if before != size {
        ctx.request_repaint();
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Pos2, RawInput, Rect};

    #[test]
    fn a_dialogue_that_grows_asks_for_a_frame_in_which_it_is_in_the_middle() {
        let ctx = Context::default();
        let height = 100.0;
        let frame = |height: f32| {
            let mut shown = Rect::NOTHING;
            let screen = Rect::from_min_size(Pos2::ZERO, Vec2::new(800.0, 600.0));
            let input = RawInput { screen_rect: Some(screen), ..RawInput::default() };
            let mut output = ctx.run_ui(input, |ui| {
                shown = show(ui.ctx(), "growing", |ui| ui.set_min_size(Vec2::new(300.0, height))).response.rect;
            });
            // Nothing is painted here.
            output.textures_delta.clear();
            shown
        };
        let is_in_the_middle = |shown: Rect| (shown.center() - Pos2::new(400.0, 300.0)).length() < 1.0;
        // It is faded in over some frames.
        for _ in 0..30 {
            frame(height);
        }
        assert!(is_in_the_middle(frame(height)));
        assert!(!ctx.has_requested_repaint());
        frame(300.0);
        assert!(ctx.has_requested_repaint());
        assert!(is_in_the_middle(frame(300.0)));
    }
}
