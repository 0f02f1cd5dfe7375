//! Lines of the interpretation on sections: dashes where filled, sticks of neighbouring sections.

use super::*;

#[test]
fn what_was_filled_is_dashed_and_the_rest_is_not() {
    let (size, z) = ([3, 8], vec![5.0; 24]);
    let mut quality = vec![Quality::Tracked; 24];
    (0..3).for_each(|x| quality[x * 8 + 3..x * 8 + 6].fill(Quality::Filled));
    let sheet = TraceSheet { block: 0, z: &z, quality: &quality };
    let horizon = PickedSheets { name: "Top", colour: Colour::BLACK, sheets: vec![sheet], holes: Vec::new() };
    let shown = DrawnInterpretation { horizons: vec![horizon], ..DrawnInterpretation::default() };
    let lines = OverlayLines::new(&shown, size, SeenOn::Section(SectionKind::Inline, 1.0));
    let ends = |lines: &[Line]| lines.iter().map(|l| [l[0].x, l[l.len() - 1].x]).collect::<Vec<_>>();
    assert_eq!(ends(&lines.horizons[0].lines), [[0.0, 2.0], [6.0, 7.0]]);
    assert_eq!(ends(&lines.filled[0].lines), [[2.0, 6.0]]);
    let group = &lines.drawn(|st| st)[1];
    let is_dashed = |item: &page::list::Item| matches!(item, page::list::Item::Path(path) if path.stroke.as_ref().is_some_and(|s| !s.dashes.is_empty()));
    assert!(!is_dashed(&group.items[0]) && is_dashed(&group.items[1]));
}

#[test]
fn sticks_of_neighbouring_sections_are_light_and_far_ones_are_not_drawn() {
    let stick = |inline: f64| {
        let places = vec![DVec3::new(inline, 2.0, 3.0), DVec3::new(inline, 4.0, 9.0)];
        crate::interpretation::Stick { places, colour: Colour::new(200, 0, 0) }
    };
    let shown = DrawnInterpretation { sticks: [10.0, 18.0, 60.0].map(stick).into(), ..Default::default() };
    let on = SeenOn::Section(SectionKind::Inline, 10.0);
    let (own, beside) = (sticks(&shown, on, |st| st), ghosts(&shown, on, |st| st));
    assert_eq!((own.len(), beside.len()), (1, 1));
    let opacity = |group: &Group| match &group.items[0] {
        page::list::Item::Path(path) => path.stroke.as_ref().unwrap().ink.opacity,
        _ => panic!("a stick is a path"),
    };
    assert_eq!(opacity(&own[0]), 1.0);
    assert!((0.2..0.6).contains(&opacity(&beside[0])), "{}", opacity(&beside[0]));
    // On a crossline the sticks run across: none lies along it.
    let across = SeenOn::Section(SectionKind::Crossline, 200.0);
    assert!(ghosts(&shown, across, |st| st).is_empty());
}
