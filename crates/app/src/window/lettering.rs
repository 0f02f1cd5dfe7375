//! The faces of the window's own words: egui's, and after them those of the project's `fonts`, so that names in any script
//! are read in lists and fields as on figures.

use crate::state::Snapshot;
use eframe::egui::{FontData, FontDefinitions};
use project::pictures::figures::{FontFile, font_files};
use std::sync::Arc;

/// The faces for a project that was opened. Files that cannot be used are left out: figures say what is wrong with them.
pub(super) fn fonts(snapshot: &Snapshot) -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    for (number, FontFile { bytes, index }) in
        font_files(&snapshot.root, &snapshot.document.fonts).into_iter().enumerate()
    {
        let name = format!("of the project {number}");
        fonts.font_data.insert(name.clone(), Arc::new(FontData { index, ..FontData::from_owned(bytes) }));
        fonts.families.values_mut().for_each(|family| family.push(name.clone()));
    }
    fonts
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Context, FontFamily, FontId, RawInput};
    use project::Project;

    #[test]
    fn names_in_other_scripts_have_letters_in_the_window() {
        let at = tempfile::tempdir().unwrap();
        let root = at.path().join("p.petro");
        Project::create(&root, None).unwrap().publish().unwrap();
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../ttf/tests/fonts/arabic.ttf");
        std::fs::copy(file, root.join("arabic.ttf")).unwrap();
        let mut document = Project::open(&root).unwrap().document().clone();
        let arabic = |document: &project::document::Document| {
            let snapshot = Snapshot { root: root.clone(), document: document.clone(), history: Vec::new() };
            let ctx = Context::default();
            ctx.set_fonts(fonts(&snapshot));
            let mut has = false;
            let mut output = ctx.run_ui(RawInput::default(), |ui| {
                let id = FontId::new(14.0, FontFamily::Proportional);
                has = ui.ctx().fonts_mut(|fonts| fonts.has_glyphs(&id, "\u{627}\u{62c}"));
            });
            // Nothing is painted here.
            output.textures_delta.clear();
            has
        };
        assert!(!arabic(&document));
        document.fonts = vec!["arabic.ttf".to_owned(), "none.ttf".to_owned()];
        assert!(arabic(&document));
    }
}
