//! Names of faults on maps: along a bent line, or beside one that is too short.

use super::*;

const OUTLINE: [[f64; 2]; 4] = [[0.0, 0.0], [400.0, 0.0], [400.0, 300.0], [0.0, 300.0]];

fn cut(fault: usize, name: &str, places: usize, at: impl Fn(f64) -> DVec2) -> FaultCut {
    let line = (0..places).map(|n| at(n as f64 * 4.0)).collect();
    FaultCut { fault, name: name.into(), line, is_covered: false }
}

fn named(cuts: &[FaultCut]) -> Vec<Text> {
    let within = Rect::new(DVec2::ZERO, DVec2::new(400.0, 300.0));
    faults_drawn(cuts, &|at| at, within, &OUTLINE.map(DVec2::from_array)).1
}

#[test]
fn a_name_follows_a_bent_fault() {
    // An arc of a quarter of a circle, whose radius is twice the length of the name: no run of it is straight.
    let middle = DVec2::new(100.0, 280.0);
    let arc = cut(0, "Western boundary fault", 60, |s| middle + 150.0 * DVec2::from_angle((s - 240.0) / 150.0));
    let names = named(&[arc]);
    assert_eq!(names.len(), 1);
    let letters = names[0].straight();
    assert!(letters.len() > 15);
    for letter in &letters {
        let [a, b, c, d] = letter.corners();
        let off = (0.25 * (a + b + c + d)).distance(middle) - 150.0;
        assert!(off.abs() < 1.5, "{} stands {off} points beside the fault", letter.text);
    }
    let turns: Vec<f64> = letters.iter().map(|letter| letter.turn_deg).collect();
    assert!(turns[turns.len() - 1] - turns[0] > 15.0, "{turns:?}");
}

#[test]
fn a_name_without_room_in_its_line_stands_beside_it_and_off_other_faults() {
    let short = cut(0, "Graben, south-east wall", 9, |s| DVec2::new(200.0 + 0.6 * s, 150.0 + 0.8 * s));
    let long = cut(1, "Master fault", 60, |s| DVec2::new(100.0 + s, 140.0));
    let names = named(&[short, long.clone()]);
    assert_eq!(names.len(), 2, "{names:?}");
    let beside = names.iter().find(|text| text.text.starts_with("Graben")).unwrap();
    assert!(beside.letters.is_empty() && beside.turn_deg == 0.0);
    let corners = beside.corners();
    assert!(!long.line.windows(2).any(|side| meet(side, &corners)), "{corners:?}");
    assert!(corners.iter().all(|corner| corner.distance(DVec2::new(210.0, 165.0)) < 140.0), "{corners:?}");
}
