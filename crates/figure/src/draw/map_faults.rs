//! Faults on a map: the lines at which they cut the horizon off, with a name for each fault.
//!
//! A name stands in the longest of its fault's lines and follows it, where the line is straightest and no other fault
//! passes; where it is too short or too bent, beside it with a leader. Space: points of the page.

use super::annotation::{LabelRoom, leader, outlines, turning};
use super::map_lines::Measured;
use crate::convex::meet;
use crate::map::FaultCut;
use crate::style::{FAULT_PT, INK, NUMBER_PT};
use glam::DVec2;
use page::Rect;
use page::list::{Group, GroupKind, Ink, Item, Path, PathItem, Stroke, Text};
use ttf::Colour;

/// Dashes of faults that are covered, points.
const COVERED: [f64; 2] = [3.5, 2.0];
/// A name's rim, points.
const RIM_PT: f64 = 1.4;
/// Room before and behind a name in its line, points.
const ENDS_PT: f64 = 6.0;
/// Distance between places that are tried, points.
const STEP_PT: f64 = 4.0;
/// Half the length over which a line is smoothed under a name: lines are found cell by cell, points.
const SMOOTH_PT: f64 = 8.0;
/// Where along its line a leader may end, the best place first.
const FEET: [f64; 5] = [0.5, 0.3, 0.7, 0.15, 0.85];

/// A line of a fault on the page, and whether it is covered.
type PageLine = (Vec<DVec2>, bool);

/// The lines of faults within the map's outline, covered ones dashed, and the names among what is drawn.
pub(super) fn faults_drawn(
    cuts: &[FaultCut],
    page: &impl Fn(DVec2) -> DVec2,
    within: Rect,
    outline: &[DVec2],
) -> (Vec<Item>, Vec<Text>) {
    let faults: Vec<&[FaultCut]> = cuts.chunk_by(|a, b| a.fault == b.fault).collect();
    let lines: Vec<Vec<PageLine>> = faults
        .iter()
        .map(|cuts| cuts.iter().map(|cut| (cut.line.iter().map(|at| page(*at)).collect(), cut.is_covered)).collect())
        .collect();
    let longest: Vec<Measured> = lines.iter().map(|lines| longest(lines)).collect();
    let sides = |lines: &[PageLine]| -> Vec<[DVec2; 2]> {
        lines.iter().flat_map(|(line, _)| line.windows(2).map(|pair| [pair[0], pair[1]])).collect()
    };
    let sides: Vec<Vec<[DVec2; 2]>> = lines.iter().map(|lines| sides(lines)).collect();
    let mut room = LabelRoom::new(within);
    let mut named: Vec<Option<Group>> = Vec::new();
    for (n, cuts) in faults.iter().enumerate() {
        let others = || sides.iter().enumerate().filter(|(other, _)| *other != n).flat_map(|(_, sides)| sides);
        let text = in_line(&longest[n], &cuts[0].name, |text| {
            let is_crossed = |area: &Vec<DVec2>| others().any(|side| meet(side, area));
            room.is_free(text) && !outlines(text).any(|area| is_crossed(&area))
        });
        text.iter().for_each(|text| room.take(text));
        named.push(text.map(|text| Group::new(GroupKind::Part, "name").with([text.into()])));
    }
    sides.iter().flatten().for_each(|[from, to]| room.take_line(*from, *to));
    for (n, cuts) in faults.iter().enumerate() {
        let feet = FEET.map(|share| longest[n].at(share * longest[n].length()));
        named[n] = named[n].take().or_else(|| leader(&feet, &cuts[0].name, &[], &mut room));
    }
    let stroke = Stroke::new(FAULT_PT, INK).round();
    let dashed = Stroke { dashes: COVERED.to_vec(), ..Stroke::new(0.6 * FAULT_PT, INK).round() };
    let drawn = |lines: &[PageLine], is_dashed: bool| {
        let mut path = Path::default();
        lines.iter().filter(|(_, is_covered)| *is_covered == is_dashed).for_each(|(line, _)| path.add_line(line));
        PathItem::stroked(path, if is_dashed { dashed.clone() } else { stroke.clone() }).into()
    };
    let texts = |group: &Option<Group>| -> Vec<Text> {
        let texts = group.iter().flat_map(|group| &group.items).filter_map(|item| match item {
            Item::Text(text) => Some(text.clone()),
            _ => None,
        });
        texts.collect()
    };
    let names = named.iter().flat_map(texts).collect();
    let mut items = Vec::new();
    for ((cuts, lines), name) in faults.iter().zip(&lines).zip(named) {
        let strokes = [false, true].map(|is_dashed| drawn(lines, is_dashed));
        let strokes = Group::new(GroupKind::Part, "lines").clipped(Path::polygon(outline)).with(strokes);
        let group = Group::new(GroupKind::Fault, &cuts[0].name).with([strokes.into()]).with(name.map(Item::from));
        items.push(group.into());
    }
    (items, names)
}

/// The longest of a fault's lines, one that is not covered where there is one.
fn longest(lines: &[PageLine]) -> Measured {
    let measured = lines.iter().map(|(line, is_covered)| (!is_covered, Measured::of(line.clone())));
    let longest = measured.max_by(|(seen, a), (other, b)| seen.cmp(other).then(a.length().total_cmp(&b.length())));
    longest.map_or_else(|| Measured::of(Vec::new()), |(_, line)| line)
}

/// A name bent along its line, where that turns least; `None` where there is no room or letters would turn too much.
fn in_line(line: &Measured, name: &str, is_free: impl Fn(&Text) -> bool) -> Option<Text> {
    let text = Text::new(DVec2::ZERO, name).sized(NUMBER_PT).inked(INK);
    let text = text.haloed(RIM_PT, Ink::glass(Colour::WHITE, 0.9));
    let need = text.width() + 2.0 * ENDS_PT;
    let steps = ((line.length() - need) / STEP_PT).floor() as i64;
    let placed = |n: i64| {
        let from = n as f64 * STEP_PT;
        // Letters stand on the mean of the line around them.
        let mut curve: Vec<DVec2> = (0..=need.ceil() as i64).map(|at| mean_of(line, from + at as f64)).collect();
        let way = *curve.last()? - curve[0];
        if way.x < 0.0 {
            curve.reverse();
        }
        let length: f64 = curve.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let bent = text.clone().along(&curve, 0.5 * length);
        turning(&bent).filter(|_| is_free(&bent)).map(|turn| (bent, turn))
    };
    (0..=steps).filter_map(placed).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(text, _)| text)
}

/// The mean of a line around a distance along it.
fn mean_of(line: &Measured, at: f64) -> DVec2 {
    let reach = SMOOTH_PT.min(at).min(line.length() - at).max(0.0);
    (-4..=4).map(|n| line.at(at + reach * f64::from(n) / 4.0)).sum::<DVec2>() / 9.0
}

#[cfg(test)]
mod tests;
