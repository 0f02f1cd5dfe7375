//! A page's title and caption: lines of words above and below everything else.

use crate::style::{INK, LEAST_TEXT_PT, QUIET_INK, TEXT_PT};
use glam::DVec2;
use page::Rect;
use page::list::{Across, Group, GroupKind, Text, Upright, width_of};

/// Size of a title, points.
const TITLE_PT: f64 = 11.0;
/// Size of the line of provenance, points.
const PROVENANCE_PT: f64 = LEAST_TEXT_PT;
/// From one line to the next, as a share of the size of the letters.
const LEADING: f64 = 1.35;
/// Most lines of a caption; what does not fit ends in "…".
const MOST_LINES: usize = 6;

/// A title at the top of a room, and the room that is left.
pub fn title(room: Rect, words: &str) -> (Group, Rect) {
    let text = Text::new(room.min, words).sized(TITLE_PT).inked(INK).anchored(Across::Start, Upright::Top);
    let group = Group::new(GroupKind::Annotation, "title").with([text.fitted(room.width()).into()]);
    (group, room.inside([0.0, TITLE_PT * (LEADING + 0.35), 0.0, 0.0]))
}

/// A caption at the foot of a room, broken into lines, and the room that is left.
pub fn caption(room: Rect, words: &str) -> (Group, Rect) {
    let lines = broken(words, TEXT_PT, room.width(), MOST_LINES);
    let pitch = TEXT_PT * LEADING;
    let top = room.max.y - pitch * lines.len() as f64;
    let mut group = Group::new(GroupKind::Annotation, "caption");
    for (n, line) in lines.into_iter().enumerate() {
        let at = DVec2::new(room.min.x, top + pitch * n as f64 + 0.3 * TEXT_PT);
        let text = Text::new(at, line).inked(INK).anchored(Across::Start, Upright::Top);
        group.push(text.fitted(room.width()));
    }
    (group, Rect::new(room.min, DVec2::new(room.max.x, top)))
}

/// A line in small letters at the foot of a room, and the room that is left.
pub fn provenance(room: Rect, words: &str) -> (Group, Rect) {
    let text = Text::new(DVec2::new(room.min.x, room.max.y - 0.25 * PROVENANCE_PT), words).sized(PROVENANCE_PT);
    let text = text.inked(QUIET_INK).anchored(Across::Start, Upright::Baseline);
    let group = Group::new(GroupKind::Annotation, "provenance").with([text.fitted(room.width()).into()]);
    (group, room.inside([0.0, 0.0, 0.0, PROVENANCE_PT * LEADING + 2.0]))
}

/// Words of a size in `most` lines that are no wider than `room`, as far as single words allow.
pub(crate) fn broken(words: &str, size: f64, room: f64, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split_whitespace() {
        // The last line takes what is left and is shortened where it is drawn.
        let is_last = lines.len() == most;
        let fits = |line: &String| is_last || width_of(&format!("{line} {word}"), size) <= room;
        match lines.last_mut().filter(|line| fits(line)) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use page::list::Item;

    #[test]
    fn lines_hold_all_words_and_stay_in_the_room() {
        let room = Rect::sized(DVec2::new(10.0, 20.0), DVec2::new(150.0, 200.0));
        let words = "Block of the basin, seen towards the north-west; the cut shows the folded limestone.";
        let (group, left) = caption(room, words);
        let lines: Vec<&Text> =
            group.items.iter().filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None }).collect();
        assert!(lines.len() > 2);
        assert_eq!(lines.iter().map(|line| line.text.as_str()).collect::<Vec<_>>().join(" "), words);
        for pair in lines.windows(2) {
            assert!(pair[0].bounds().max.y <= pair[1].bounds().min.y + 0.01);
        }
        let bounds = lines.iter().map(|line| line.bounds()).reduce(|a, b| a.around(b.min).around(b.max)).unwrap();
        assert!(bounds.min.y >= left.max.y && bounds.max.y <= room.max.y && bounds.max.x <= room.max.x + 1e-6);
        let (group, _) = caption(room, &words.repeat(20));
        assert_eq!(group.items.len(), MOST_LINES);
        let Some(Item::Text(last)) = group.items.last() else { panic!("no line") };
        assert!(last.text.ends_with('…') && last.width() <= room.width());
    }
}
