//! Names in Arabic and Chinese on a page, in every kind of file.

use figure::list::{DisplayList, Ink, Text};
use figure::{pdf, raster, svg};
use glam::DVec2;
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
fn letters_that_join_are_not_bent() {
    let page = faces().scope(page);
    let texts = page.texts();
    assert_eq!(texts.iter().map(|text| text.letters.len()).collect::<Vec<_>>(), [0, 0, 2, 0]);
    assert!((texts[3].bounds().centre() - DVec2::new(40.0, 69.0)).length() < 6.0);
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
