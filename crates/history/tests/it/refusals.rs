//! What is wrong with a text is said with its line; no text makes the reader panic.

use crate::oracle::{Draws, beds_text};
use history::History;

/// The refusal of the beds with some events: its line, counted from the first of these, and its sentence.
fn refused(events: &str) -> (usize, String) {
    let error = History::from_toml(&(beds_text() + events)).expect_err(events);
    (error.line - beds_text().lines().count(), error.to_string())
}

#[test]
fn each_mistake_is_told_with_its_line_and_what_is_meant() {
    let cases = [
        ("[[events]]\nkind = \"fauld\"\n", 2, "did you mean fault"),
        ("[[events]]\nkind = \"fold\"\nwavelenght = 100\namplitude = 10\n", 1, "needs `wavelength`"),
        ("[[events]]\nkind = \"fold\"\nwavelength = 100\namplitude = 10\naxes = 3\n", 5, "did you mean axis"),
        ("[[events]]\nkind = \"tilt\"\ndip = \"steep\"\ndirection = 3\n", 3, "is a number, found the text"),
        ("[[events]]\nkind = \"tilt\"\ndip = 95\ndirection = 3\n", 3, "must lie between"),
        ("[[events]]\nkind = \"fault\"\nslip = 5000\n", 3, "larger than the block"),
        ("[[events]]\nkind = \"fault\"\ndextral = -4000\n", 3, "larger than the block"),
        ("[[events]]\nkind = \"fault\"\nslip = 10\nthrow = 5\n", 4, "state the same"),
        ("[[events]]\nkind = \"fault\"\nslip = 500\nextent = [600, 600]\n", 4, "too large for the fault's `extent`"),
        (
            "[[events]]\nkind = \"fold\"\nstyle = \"parallel\"\nwavelength = 500\namplitude = 120\n",
            3,
            "cross themselves",
        ),
        (
            "[[events]]\nkind = \"fault\"\nname = \"A\"\nslip = 9\n[[events]]\nkind = \"fault\"\nname = \"A\"\nslip = 9\n",
            5,
            "also the name",
        ),
        (
            "[[events]]\nkind = \"beds\"\nbeds = [{ rock = \"chalk\", thickness = 9, name = \"Lime\" }]\n",
            3,
            "also the name of the rock at line 4",
        ),
        ("[[events]]\nkind = \"beds\"\nbeds = [{ rock = \"chalk\", thickness = -9 }]\n", 3, "must be above 0"),
        (
            "[[events]]\nkind = \"beds\"\nbeds = [{ rock = \"chalk\", thickness = 9 }]\ntop = 1600\n",
            3,
            "nowhere in the block",
        ),
        ("[[events]]\nkind = \"erosion\"\ndepth = 1600\n", 1, "no rock is left"),
        ("[[events]]\nkind = \"erosion\"\ndepth = nan\n", 3, "must lie between"),
        ("[[events]]\nkind = \"erosion\n", 2, "TOML"),
        ("[[events]]\nkind = \"dominoes\"\nrotation = 55\nspacing = 500\n", 3, "faults would dip"),
    ];
    for (events, line, says) in cases {
        let (found, sentence) = refused(events);
        assert!(sentence.contains(says), "{events}\n{sentence}");
        assert_eq!(found, line, "{events}\n{sentence}");
    }
    let unknown = |name: &str| if name == "granite" { Ok(()) } else { Err(vec!["limestone".to_owned()]) };
    let error = History::with_rocks(&beds_text(), &unknown).unwrap_err();
    assert_eq!((error.line, error.to_string().contains("did you mean limestone?")), (4, true), "{error}");
    for (text, says) in [("", "needs `size`"), ("size = [1, 2, 3]", "needs events"), ("size = [1, 2, 0]\n", "1000000")]
    {
        let error = History::from_toml(text).unwrap_err();
        assert!(error.to_string().contains(says), "{error}");
    }
}

#[test]
fn beds_that_events_took_away_are_told_with_their_line() {
    let history = History::from_toml(&(beds_text() + "[[events]]\nkind = \"erosion\"\ndepth = 300\n")).unwrap();
    let notes = history.notes();
    assert_eq!(notes.len(), 1);
    assert!(notes[0].line == 4 && notes[0].to_string().contains("\"Sand\""), "{}", notes[0]);
}

#[test]
fn no_text_makes_the_reader_panic() {
    let text = beds_text()
        + "[[events]]\nkind = \"fault\"\nslip = 200\nshape = \"listric\"\n[[events]]\nkind = \"fold\"\nwavelength = 900\namplitude = 10\n";
    let mut draws = Draws(77);
    for _ in 0..400 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..1 + (draws.unit() * 4.0) as usize {
            let at = (draws.unit() * bytes.len() as f64) as usize % bytes.len();
            let new = b"0123456789.-[]{}=\"\nezn"[(draws.unit() * 22.0) as usize % 22];
            match (draws.unit() * 3.0) as usize {
                0 => bytes[at] = new,
                1 => bytes.insert(at, new),
                _ => drop(bytes.remove(at)),
            }
        }
        let _ = History::from_toml(&String::from_utf8_lossy(&bytes));
    }
}
