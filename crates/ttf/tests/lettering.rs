//! Lines in scripts that join, run from right to left, or are not in the embedded face, set in small given faces.

use std::collections::BTreeSet;

use ttf::subset::used;
use ttf::text::{Face, Faces, Line, TextCurve, is_known, measure_text, measured, outline_text, set};

/// "Limestone" in Arabic: two words; and with a figure.
const ARABIC: &str = "حجر جيري";
const HAN: &str = "石灰岩";

fn faces() -> Faces {
    let arabic = Face::parse(include_bytes!("fonts/arabic.ttf").to_vec(), 0).unwrap();
    let han = Face::parse(include_bytes!("fonts/han.otf").to_vec(), 0).unwrap();
    Faces::new(vec![arabic, han])
}

fn said<'a>(text: &'a str, line: &Line) -> Vec<&'a str> {
    line.glyphs.iter().map(|glyph| &text[glyph.said.clone()]).collect()
}

#[test]
fn arabic_is_seen_from_right_to_left_and_its_letters_join() {
    faces().scope(|| {
        let line = set(ARABIC);
        assert!(line.is_right_to_left && !line.is_plain);
        // Dots of letters may be glyphs of their own, which stand for nothing more.
        let seen: String = said(ARABIC, &line).into_iter().filter(|said| !said.is_empty()).collect();
        assert_eq!(seen, ARABIC.chars().rev().collect::<String>());
        // A letter alone has another form than between two letters.
        let alone: BTreeSet<u16> = set("ج").glyphs.iter().map(|glyph| glyph.id).collect();
        let within: BTreeSet<u16> = set("حجر").glyphs.iter().map(|glyph| glyph.id).collect();
        assert!(alone.iter().any(|glyph| !within.contains(glyph)));
        assert!(line.glyphs.iter().all(|glyph| glyph.id != 0));
        // Two letters that make one glyph stand for both.
        assert!(said("لا", &set("لا")).contains(&"لا"));
    });
}

#[test]
fn a_line_of_both_directions_keeps_words_and_figures_in_order() {
    faces().scope(|| {
        let text = format!("Top {ARABIC} 12 m");
        let line = set(&text);
        assert!(!line.is_right_to_left);
        let seen: String = said(&text, &line).concat();
        let arabic: String = ARABIC.chars().rev().collect();
        // The blank and the number behind the Arabic words belong to them.
        assert_eq!(seen, format!("Top 12 {arabic} m"));
        let text = format!("{ARABIC} 12");
        let line = set(&text);
        assert!(line.is_right_to_left);
        assert_eq!(said(&text, &line).concat(), format!("12 {arabic}"));
    });
}

#[test]
fn what_is_measured_stands_in_order_behind_a_name_of_any_script() {
    faces().scope(|| {
        let seen = |text: &str| said(text, &set(text)).concat().replace('\u{200e}', "");
        let arabic: String = ARABIC.chars().rev().collect();
        assert_eq!(seen(&measured(ARABIC, "97 m")), format!("97 m ,{arabic}"));
        assert_eq!(seen(&measured(&format!("Top {ARABIC}"), "97 m")), format!("Top {arabic}, 97 m"));
        assert_eq!(measured(HAN, "97 m"), format!("{HAN}, 97 m"));
        // The mark takes no room and is no box.
        assert!(is_known('\u{200e}'));
        let [with, without] = ["a\u{200e}b", "ab"].map(|text| measure_text(10.0, text).width_px);
        assert!((with - without).abs() < 1e-4, "{with} {without}");
    });
}

#[test]
fn chinese_is_drawn_from_cubic_curves_and_is_no_box() {
    let boxes = outline_text(10.0, HAN);
    assert!(!is_known('石'));
    faces().scope(|| {
        assert!(is_known('石') && !is_known('鐵'));
        let line = set(HAN);
        assert!(line.is_plain && line.glyphs.iter().all(|glyph| glyph.face == 2 && glyph.id != 0));
        let curves = outline_text(10.0, HAN);
        assert_ne!(curves, boxes);
        assert!(curves.iter().any(|curve| matches!(curve, TextCurve::Cubic(_))));
        assert!((measure_text(10.0, HAN).width_px - 30.0).abs() < 1e-3);
    });
}

/// What a file carries draws what the page was laid out with: by glyphs, and by its own rules.
#[test]
fn files_with_a_part_of_a_face_draw_the_same() {
    faces().scope(|| {
        let texts = [ARABIC, "لا السفلي", HAN, "Marl"];
        let uses = used(texts);
        assert_eq!(
            uses.iter().map(|used| (used.number, used.is_plain)).collect::<Vec<_>>(),
            [(0, true), (1, false), (2, true)]
        );
        let embedded = |number: usize| Face::parse(uses[number].file_to_set_text().unwrap().file, 0).unwrap();
        let carried = Faces::new(vec![embedded(1), embedded(2)]);
        for text in texts {
            let (whole, part) = (outline_text(1000.0, text), carried.scope(|| outline_text(1000.0, text)));
            let bounds = |curves: &[TextCurve]| {
                let places = || curves.iter().flat_map(|curve| curve.places());
                let low = places().fold([f32::MAX; 2], |a, p| [a[0].min(p[0]), a[1].min(p[1])]);
                let high = places().fold([f32::MIN; 2], |a, p| [a[0].max(p[0]), a[1].max(p[1])]);
                [low[0], low[1], high[0], high[1]]
            };
            let off = bounds(&whole).into_iter().zip(bounds(&part)).map(|(a, b)| (a - b).abs());
            // Control points of cubic curves reach a little beyond those of quadratic ones.
            assert!(off.fold(0.0, f32::max) < 25.0, "{text}: {:?} {:?}", bounds(&whole), bounds(&part));
            assert_eq!(carried.scope(|| said(text, &set(text)).concat()), said(text, &set(text)).concat());
        }
        let numbers = &uses[1].file().unwrap();
        assert!(numbers.file.len() < 8000 && numbers.advances.len() < 40);
    });
}

#[test]
fn marks_stand_on_their_letters() {
    // The embedded face has the whole letter; a letter and a mark are as wide as that.
    let (whole, parts) = (measure_text(10.0, "é"), measure_text(10.0, "e\u{301}"));
    assert!((whole.width_px - parts.width_px).abs() < 0.01);
    assert_eq!(set("e\u{301}\n\u{7}").glyphs.len(), set("é  ").glyphs.len());
}
