//! Numbers and paths, written short: hundredths of a point, relative from step to step.

use crate::list::{Path, Segment};
use glam::DVec2;

/// A number to a hundredth.
pub(super) fn number(value: f64) -> String {
    let mut text = String::new();
    push(&mut text, whole(value), 2);
    text
}

/// A number to so many decimals.
pub(super) fn decimals(value: f64, places: usize) -> String {
    let mut text = String::new();
    push(&mut text, (value * 10f64.powi(places as i32)).round() as i64, places);
    text
}

/// In hundredths.
fn whole(value: f64) -> i64 {
    (value * 100.0).round() as i64
}

/// Writes an integer with its last `places` digits behind the point, without zeros at the end.
fn push(text: &mut String, value: i64, places: usize) {
    let scale = 10i64.pow(places as u32);
    let (sign, size) = (if value < 0 { "-" } else { "" }, value.unsigned_abs());
    let (before, behind) = (size / scale as u64, size % scale as u64);
    text.push_str(sign);
    if before > 0 || behind == 0 {
        text.push_str(&before.to_string());
    }
    if behind > 0 {
        let digits = format!("{behind:0places$}");
        text.push('.');
        text.push_str(digits.trim_end_matches('0'));
    }
}

/// The steps of a path as SVG writes them.
pub(super) fn steps(path: &Path) -> String {
    let mut writer = Steps::default();
    path.segments.iter().for_each(|segment| writer.add(segment));
    writer.text
}

/// A path being written; places are hundredths, so that relative steps add up exactly.
#[derive(Default)]
struct Steps {
    text: String,
    at: [i64; 2],
    begin: [i64; 2],
    /// The last letter, which need not be repeated.
    letter: Option<char>,
}

impl Steps {
    fn add(&mut self, segment: &Segment) {
        let place = |p: DVec2| [whole(p.x), whole(p.y)];
        match *segment {
            Segment::Move(p) => {
                let to = place(p);
                let is_first = self.letter.is_none();
                let from = if is_first { [0; 2] } else { self.at };
                self.letter(if is_first { 'M' } else { 'm' });
                self.pair([to[0] - from[0], to[1] - from[1]], true);
                (self.at, self.begin) = (to, to);
            }
            Segment::Line(p) => {
                let to = place(p);
                let step = [to[0] - self.at[0], to[1] - self.at[1]];
                match step {
                    // A line of no length with round ends is a dot.
                    [0, 0] if matches!(self.letter, Some('M' | 'm')) => self.single('h', 0),
                    [0, 0] => {}
                    [x, 0] => self.single('h', x),
                    [0, y] => self.single('v', y),
                    _ => {
                        let again = self.letter == Some('l');
                        self.letter('l');
                        self.pair(step, !again);
                    }
                }
                self.at = to;
            }
            Segment::Cubic(a, b, c) => {
                let again = self.letter == Some('c');
                self.letter('c');
                for (n, p) in [a, b, c].into_iter().enumerate() {
                    let to = place(p);
                    self.pair([to[0] - self.at[0], to[1] - self.at[1]], n == 0 && !again);
                }
                self.at = place(c);
            }
            Segment::Close => {
                self.text.push('z');
                self.letter = Some('z');
                self.at = self.begin;
            }
        }
    }

    fn letter(&mut self, letter: char) {
        if self.letter != Some(letter) || letter == 'm' {
            self.text.push(letter);
            self.letter = Some(letter);
        }
    }

    fn single(&mut self, letter: char, value: i64) {
        let again = self.letter == Some(letter);
        self.letter(letter);
        self.value(value, !again);
    }

    fn pair(&mut self, [x, y]: [i64; 2], is_first: bool) {
        self.value(x, is_first);
        self.value(y, false);
    }

    /// A sign parts a number from the one before; else a blank does.
    fn value(&mut self, value: i64, is_first: bool) {
        if !is_first && value >= 0 {
            self.text.push(' ');
        }
        push(&mut self.text, value, 2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in
            [(0.0, "0"), (1.0, "1"), (-0.5, "-.5"), (12.345, "12.35"), (-0.001, "0"), (100.1, "100.1"), (0.07, ".07")]
        {
            assert_eq!(number(value), text);
        }
        assert_eq!(decimals(0.25, 3), ".25");
    }

    #[test]
    fn steps_add_up_without_drift() {
        let third = DVec2::new(1.0 / 3.0, 0.1);
        let mut path = Path::line(&(0..1000).map(|n| third * f64::from(n)).collect::<Vec<_>>());
        path.segments.push(Segment::Close);
        let text = steps(&path);
        let body = text.trim_start_matches('M').trim_end_matches('z').replace('l', " ").replace('-', " -");
        let numbers: Vec<f64> = body.split_whitespace().map(|n| n.parse().unwrap()).collect();
        let sum: f64 = numbers.iter().step_by(2).sum();
        assert!((sum - 333.0).abs() < 0.006, "{sum}");
    }
}
