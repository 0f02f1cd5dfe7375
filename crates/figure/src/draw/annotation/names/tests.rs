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

/// A layer that thickens towards a face's edge, as far as that edge and beyond it: the name keeps half an em from it.
#[test]
fn a_name_keeps_off_the_edges_of_its_face() {
    let name = Text::new(DVec2::ZERO, "Lower sandstone");
    let room = LabelRoom::new(Rect::sized(DVec2::ZERO, DVec2::new(300.0, 200.0)));
    let bend = |x: f64| 100.0 - 40.0 * (x / 300.0 * std::f64::consts::PI).cos();
    for edge in [300.0, 150.0] {
        let mut piece = piece(|x| bend(x) - 2.0 - 0.06 * x, |x| bend(x) + 2.0 + 0.06 * x);
        let corners = [[0.0, 0.0], [edge, 0.0], [edge, 200.0], [0.0, 200.0]].map(DVec2::from_array);
        piece.seen = vec![corners.to_vec()];
        piece.lines.iter_mut().flatten().for_each(|place| place.is_seen = place.at.x < edge);
        let (text, _) = piece.named(&name, &room).unwrap();
        let letters = text.straight();
        let last = letters.iter().flat_map(|letter| letter.corners()).map(|p| p.x).fold(0.0, f64::max);
        assert!(last < edge - 0.4 * text.size, "{last} of {edge}");
    }
}
