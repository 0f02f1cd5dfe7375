//! The window while scenes are presented: it fills the screen and shows nothing but them.

use super::Window;
use crate::state::{Action, Notice, Place};
use crate::views::present::THUMBNAIL;
use crate::work::{Event, Rocks, compute};
use eframe::egui::{Ui, ViewportCommand};
use page::list::POINTS_PER_INCH;
use project::pictures::{Device, Painter};
use render::{Background, Scene};

impl Window {
    /// Shows the scene that is presented; whether one is.
    pub(super) fn presented(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) -> bool {
        let at = self.state.presented.as_ref().map(|(at, _)| *at).filter(|_| self.state.session.is_some());
        if self.is_full != at.is_some() {
            self.is_full = at.is_some();
            ui.ctx().send_viewport_cmd(ViewportCommand::Fullscreen(self.is_full));
        }
        let (Some(at), Some(session)) = (at, &self.state.session) else { return false };
        let rocks = self.views.rocks.as_ref();
        let (views, data) = ((&mut self.views.block, &self.views.overlay), (rocks, &self.work.drawing));
        self.views.presentation.show(ui, session, at, views, data, actions);
        if let Some(rocks) = self.views.rocks.clone()
            && self.views.presentation.asks(session)
        {
            self.draw_thumbnails(rocks);
        }
        true
    }

    /// Draws a small picture of each scene.
    fn draw_thumbnails(&self, rocks: Rocks) {
        let Some(session) = &self.state.session else { return };
        let (root, scenes) = (session.root.clone(), session.document.scenes.clone());
        self.work.background("Drawing the scenes", Place::Block, move |progress, outbox| {
            let told = |error| Notice::failure(Place::Block, &error);
            let mut painter = Painter::new(Device::Auto, progress).map_err(told)?;
            for entry in scenes {
                let scene =
                    Scene { size_px: THUMBNAIL, samples: 2, background: Background::Transparent, ..entry.scene };
                if !rocks.holds_media(&scene.media) {
                    continue;
                }
                let image = compute(|| painter.picture(&scene, &rocks, POINTS_PER_INCH, progress)).map_err(told)?;
                outbox.send(Event::Thumbnail { root: root.clone(), name: entry.name, image });
            }
            Ok(())
        });
    }
}
