//! Names along layers: they follow the middle, and stand where there is room.

use super::*;
use page::Rect;

fn piece(upper: impl Fn(f64) -> f64, lower: impl Fn(f64) -> f64) -> LayerPiece {
    let xs: Vec<f64> = (0..=60).map(|n| 5.0 * f64::from(n)).collect();
    let ring: Vec<DVec2> = xs
        .iter()
        .map(|x| DVec2::new(*x, upper(*x)))
        .chain(xs.iter().rev().map(|x| DVec2::new(*x, lower(*x))))
        .collect();
    let page = [[0.0, 0.0], [300.0, 0.0], [300.0, 200.0], [0.0, 200.0]].map(DVec2::from_array);
    let runs = middle_lines(std::slice::from_ref(&ring), 300.0, &|st| st);
    LayerPiece::new(0, vec![ring], vec![page.to_vec()], &runs)
}

fn room() -> LabelRoom {
    LabelRoom::new(Rect::sized(DVec2::ZERO, DVec2::new(300.0, 200.0)))
}

#[test]
fn a_name_follows_the_middle_of_a_fold() {
    let bend = |x: f64| 100.0 + 25.0 * (x / 300.0 * std::f64::consts::TAU).sin();
    let fold = piece(|x| bend(x) - 12.0, |x| bend(x) + 12.0);
    let (text, _) = fold.named(&Text::new(DVec2::ZERO, "Nodular limestone"), &room()).unwrap();
    assert_eq!(text.size, SIZES_PT[0]);
    for letter in text.straight() {
        let middle = letter.corners().iter().sum::<DVec2>() / 4.0;
        assert!((middle.y - bend(middle.x)).abs() < 3.5, "{} at {middle}", letter.text);
    }
}

#[test]
fn a_layer_that_is_thinner_than_letters_takes_none_and_a_wedge_takes_them_where_it_is_thick() {
    let name = Text::new(DVec2::ZERO, "Marl");
    assert!(piece(|_| 100.0, |_| 106.0).named(&name, &room()).is_none());
    let wedge = piece(|_| 100.0, |x| 100.0 + 0.1 * x);
    let (text, _) = wedge.named(&name, &room()).unwrap();
    assert!(text.letters.iter().all(|letter| letter.at.x > 120.0));
    assert!(wedge.thickest().unwrap().0.x > 290.0);
}
