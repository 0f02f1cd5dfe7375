//! Sharing the block: what is shown of it in its dialogue, and the files.

use super::Window;
use crate::state::{Dialogue, Notice, Place, ShareForm};
use crate::work::{Event, share};
use eframe::egui::Context;
use state::Action;
use std::path::PathBuf;
use std::sync::Arc;

impl Window {
    /// Writes what is shared.
    pub(super) fn share(&self, form: ShareForm) {
        let Some(root) = self.state.session.as_ref().map(|session| session.root.clone()) else { return };
        self.work.background("Writing the file", Place::Dialogue, move |progress, outbox| {
            let told = share::write(&root, &form, progress);
            let told = told.map_err(|error| Notice::failure_with(Place::Dialogue, &error, &root))?;
            outbox.send(Event::Exported(PathBuf::from(form.path())));
            told.into_iter().for_each(|told| outbox.send(Event::Told(Notice::note(Place::Foot, told))));
            Ok(())
        });
    }

    /// Makes what is shared, to be looked at.
    fn look_at_share(&mut self, form: ShareForm) {
        let Some(root) = self.state.session.as_ref().map(|session| session.root.clone()) else { return };
        self.views.share.ask(&form);
        self.work.background("Making the preview", Place::Dialogue, move |progress, outbox| {
            let seen = share::preview(&root, &form, progress);
            let seen = seen.map_err(|error| Notice::failure_with(Place::Dialogue, &error, &root))?;
            outbox.send(Event::ShareSeen(Arc::new(seen)));
            Ok(())
        });
    }

    /// Shows the dialogue.
    pub(super) fn share_dialogue(&mut self, ctx: &Context, actions: &mut Vec<Action>) {
        let (Some(Dialogue::Share(form)), Some(session)) = (&self.state.dialogue, &self.state.session) else { return };
        let running = self.work.running.lines().into_iter().find(|line| line.place == Place::Dialogue);
        let sparse = self.views.rocks.as_ref().map_or_else(Vec::new, |loaded| loaded.sparse());
        let asks = self.views.share.show(ctx, &self.state, session, (form, &sparse), running.as_ref(), actions);
        if asks || (running.is_none() && self.views.share.is_outdated(form)) {
            self.look_at_share(form.clone());
        }
    }
}
