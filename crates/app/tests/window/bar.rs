//! The toolbar, in windows of several widths.

use crate::command::act;
use crate::driven::{driven, project, state, wait};
use eframe::egui::vec2;
use egui_kittest::kittest::Queryable;

#[test]
fn the_parts_of_the_toolbar_keep_apart_at_four_widths() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("a_survey_with_a_name_that_is_longer_than_most_2026_int16.petro");
    std::fs::rename(project(folder.path()), &root).unwrap();
    let mut harness = driven(folder.path(), Some(root));
    wait(&mut harness, "the project is open", |harness| state(harness).session.is_some());
    // The longest number beside the slider.
    let scene = render::Scene { blend: 1.0, ..state(&harness).session.as_ref().unwrap().view.scene.clone() };
    act(&mut harness, state::Action::Show(Box::new(scene)));
    for (width, is_folded) in [(860.0, true), (1024.0, true), (1280.0, false), (1920.0, false)] {
        harness.set_size(vec2(width, 600.0));
        harness.run_steps(3);
        assert_eq!(harness.query_by_label("Compare").is_some(), is_folded, "{width}");
        let last = if is_folded { "Compare" } else { "Wipe" };
        let order = ["Project", "Undo", "Redo", "Sections", "Map", "Fence", last, "Export…", "Copy", "?"];
        let rects = order.map(|label| harness.get_by_label(label).rect());
        for (pair, names) in rects.windows(2).zip(order.windows(2)) {
            assert!(pair[0].right() <= pair[1].left(), "{} and {} at {width}: {pair:?}", names[0], names[1]);
        }
        assert!(rects.iter().all(|rect| rect.right() <= width), "{width}: {rects:?}");
        // Where there is no room for it, it is in the menu.
        let share: Vec<_> = harness.query_all_by_label("Share…").map(|node| node.rect()).collect();
        assert_eq!(share.len(), usize::from(width > 1000.0), "{width}");
        for rect in share {
            assert!(rects[6].right() <= rect.left() && rect.right() <= rects[7].left(), "{width}: {rect:?}");
        }
        if !is_folded {
            let number = harness.get_all_by_label("to raw").map(|node| node.rect().right()).fold(0.0, f32::max);
            let next = harness.get_by_label("Share…").rect().left();
            assert!(number <= next, "the slider lies under Share at {width}: {number} {next}");
        }
    }
}
