//! Names in Arabic and Chinese on a page, in every kind of file.

use glam::DVec2;
use page::list::{DisplayList, Ink, Text};
use page::{pdf, raster, svg};
use ttf::text::{Face, Faces};

fn faces() -> Faces {
    let arabic = Face::parse(include_bytes!("../../ttf/tests/fonts/arabic.ttf").to_vec(), 0).unwrap();
    let han = Face::parse(include_bytes!("../../ttf/tests/fonts/han.otf").to_vec(), 0).unwrap();
    Faces::new(vec![arabic, han])
}

fn page() -> DisplayList {
    let mut page = DisplayList::new(DVec2::new(160.0, 80.0));
    page.items.push(Text::new(DVec2::new(10.0, 20.0), "حجر جيري").sized(14.0).into());
    page.items.push(Text::new(DVec2::new(10.0, 40.0), "石灰岩 <&>").sized(14.0).haloed(1.0, Ink::WHITE).into());
    let bend: Vec<DVec2> = (0..=20).map(|n| DVec2::new(8.0 * f64::from(n), 65.0 + f64::from(n % 7))).collect();
    page.items.push(Text::new(DVec2::ZERO, "砂层").sized(12.0).along(&bend, 120.0).into());
    page.items.push(Text::new(DVec2::ZERO, "طين").sized(12.0).along(&bend, 40.0).into());
    page
}

/// Shares of dark pixels in the rooms of the texts.
fn ink(page: &DisplayList) -> Vec<f64> {
    let pixels = raster(page, 288.0).unwrap();
    let share = |text: &&Text| {
        let bounds = text.bounds();
        let rows = (4.0 * bounds.min.y) as u32..(4.0 * bounds.max.y) as u32;
        let columns = (4.0 * bounds.min.x) as u32..(4.0 * bounds.max.x) as u32;
        let all = f64::from(rows.len() as u32) * f64::from(columns.len() as u32);
        let dark = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        dark.filter(|(x, y)| pixels.get_pixel(*x, *y).0[0] < 128).count() as f64 / all
    };
    page.texts().iter().map(share).collect()
}

#[test]
fn a_page_remembers_its_faces() {
    let (given, boxes) = (faces().scope(page), page());
    // Back ends take the faces of the page, not those of the thread.
    let (letters, missing) = (ink(&given), ink(&boxes));
    assert!(letters.iter().all(|share| *share > 0.03), "{letters:?}");
    assert_ne!(letters, missing);
    assert_eq!(raster(&given, 100.0).unwrap(), faces().scope(|| raster(&given, 100.0).unwrap()));
}

#[test]
fn joined_letters_stay_on_one_line_and_what_is_not_joined_follows_the_curve() {
    let straight = faces().scope(page);
    let texts = straight.texts();
    assert_eq!(texts.iter().map(|text| text.letters.len()).collect::<Vec<_>>(), [0, 0, 2, 0]);
    assert!((texts[3].bounds().centre() - DVec2::new(40.0, 69.0)).length() < 6.0);
    // A quarter of a circle, and a name of two words: its letters are joined up to the third and the seventh.
    let radius = 60.0;
    let middle = DVec2::new(80.0, 75.0);
    let arc: Vec<DVec2> =
        (0..=90).map(|deg| middle + radius * DVec2::from_angle(f64::from(deg - 135).to_radians())).collect();
    let bent = || Text::new(DVec2::ZERO, "حجر جيري").sized(14.0).along(&arc, radius * 45f64.to_radians());
    let name = faces().scope(bent);
    let pieces = faces().scope(|| name.straight());
    assert_eq!(pieces.iter().map(|piece| piece.text.as_str()).collect::<Vec<_>>(), ["حجر", " ", "جير", "ي"]);
    for piece in faces().scope(|| pieces.iter().map(Text::corners).collect::<Vec<_>>()) {
        let off = (piece.iter().sum::<DVec2>() / 4.0).distance(middle) - radius;
        assert!(off.abs() < 3.5, "{off}");
    }
    // Read from right to left: each word lies to the left of the one before, turned the more to the left.
    assert!(pieces.windows(2).all(|pair| pair[1].at.x < pair[0].at.x && pair[1].turn_deg < pair[0].turn_deg));
    // Shaped alone they are as wide as the whole.
    let width = faces().scope(|| pieces.iter().map(Text::width).sum::<f64>());
    assert!((width - faces().scope(|| name.width())).abs() < 1e-3);
    let drawn = faces().scope(|| {
        let mut page = DisplayList::new(DVec2::new(160.0, 80.0));
        page.items.push(bent().into());
        svg(&page, "t").unwrap()
    });
    assert!(
        drawn.contains("aria-label=\"حجر جيري\"") && drawn.matches("<text").count() == 3 && drawn.contains(">حجر<")
    );
}

#[test]
fn vectors_carry_the_faces_and_the_text_as_it_is_written() {
    let page = faces().scope(page);
    let drawn = svg(&page, "t").unwrap();
    assert_eq!(drawn.matches("@font-face").count(), 3);
    assert!(drawn.contains("'Noto Sans Arabic'") && drawn.contains("'Noto Sans CJK SC'"));
    assert!(drawn.contains("direction=\"rtl\" text-anchor=\"end\"") && drawn.contains(">حجر جيري<"));
    assert!(drawn.contains(">石灰岩 &lt;&amp;&gt;<"));
    let written = pdf(&page, "t").unwrap();
    let has = |what: &[u8]| written.windows(what.len()).any(|bytes| bytes == what);
    assert!(has(b"+NotoSansArabic") && has(b"+NotoSansCJKSC") && has(b"+Ubuntu-Light"));
    assert!(written.len() < 30_000, "{}", written.len());
}
