//! Beds, k and undeformed places against the tests' own ways back.

use crate::oracle::{self, Draws, Event, bed_at, beds_text};
use history::{History, Place};

/// Compares a history of some events at random places with their ways back: the largest misfits of (i, j) in m and of k,
/// and the shares of places whose bed differs and which have rock.
fn compared(events: &[Event], places: usize, seed: u64, is_everywhere: bool) -> (f64, f64, f64, f64) {
    let text = beds_text() + &events.iter().map(|event| event.text.as_str()).collect::<String>();
    let history = History::from_toml(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let stage = history.last_stage();
    let mut draws = Draws(seed);
    let (mut apart, mut k_apart, mut wrong, mut rocks, mut asked) = (0f64, 0f64, 0, 0, 0);
    for _ in 0..places {
        let p = draws.place();
        let before = events.iter().rev().try_fold(p, |p, event| (event.back)(p));
        if before.is_none() && !is_everywhere {
            continue;
        }
        asked += 1;
        let expected = before.and_then(|q| bed_at(q.z).map(|(name, k)| (name, k, q)));
        let found = match stage.place(p) {
            Place::Rock(rock) => Some((history.units()[rock.unit].name.clone(), rock.ijk)),
            _ => None,
        };
        match (expected, found) {
            (None, None) => {}
            (Some((name, k, q)), Some((found, ijk))) if name == found => {
                rocks += 1;
                apart = apart.max((ijk.truncate() - q.truncate()).length());
                k_apart = k_apart.max((ijk.z - k).abs());
            }
            _ => wrong += 1,
        }
    }
    (apart, k_apart, f64::from(wrong) / f64::from(asked), f64::from(rocks) / f64::from(asked))
}

#[test]
fn every_event_alone_is_its_way_back() {
    type Maker = fn(&mut Draws) -> Event;
    let kinds: [(&str, Maker, usize, bool); 9] = [
        ("tilt", oracle::tilt, 100_000, true),
        ("fold", oracle::fold, 100_000, true),
        ("overturned fold", oracle::overturned_fold, 100_000, true),
        ("fault", oracle::fault, 100_000, true),
        ("erosion", oracle::erosion, 100_000, true),
        ("listric", oracle::listric, 100_000, true),
        ("tip", oracle::tipped, 100_000, true),
        // Thousands of steps to a place.
        ("ramp", oracle::ramp, 3_000, true),
        ("parallel", oracle::parallel_fold, 100_000, false),
    ];
    for (name, maker, places, is_everywhere) in kinds {
        // The slow ways back are gone once.
        for seed in 1..if ["ramp", "parallel"].contains(&name) { 2 } else { 3 } {
            let (apart, k, wrong, rocks) = compared(&[maker(&mut Draws(seed))], places, seed + 40, is_everywhere);
            let far = if name == "ramp" { 0.5 } else { 0.02 };
            assert!(wrong < 1e-4, "{name} {seed}: {wrong} of the beds differ");
            assert!(apart < far && k < 1e-3, "{name} {seed}: {apart} m, k {k}");
            assert!(rocks > 0.3, "{name} {seed}: {rocks}");
        }
    }
}

#[test]
fn chains_of_five_events_are_their_ways_back() {
    for chain in 0..60 {
        let mut draws = Draws(1000 + chain);
        let mut events = Vec::new();
        while events.len() < 5 {
            let kinds = [oracle::tilt, oracle::fold, oracle::fault, oracle::fault, oracle::listric, oracle::tipped];
            events.push(kinds[(draws.unit() * 6.0) as usize % 6](&mut draws));
            if events.len() == 3 && draws.unit() < 0.7 {
                events.push(oracle::erosion(&mut draws));
            }
        }
        let (apart, k, wrong, _) = compared(&events, 3_000, chain, true);
        assert!(wrong <= 4e-4 && apart < 0.05 && k < 1e-3, "chain {chain}: {wrong} {apart} {k}");
    }
}

/// The comparison must be able to fail.
#[test]
fn a_wrong_way_back_is_noticed() {
    let mut right = oracle::fault(&mut Draws(5));
    let back = right.back;
    right.back = Box::new(move |p| back(p).map(|q| q + glam::DVec3::Z));
    let (_, k, wrong, _) = compared(&[right], 20_000, 3, true);
    assert!(wrong > 1e-3 && k > 1e-3, "{wrong} {k}");
}

#[test]
fn every_map_comes_back() {
    let events = [
        "kind = \"fold\"\nwavelength = 1500\namplitude = 100\naxis = 30\nplunge = 20",
        "kind = \"fold\"\nwavelength = 1500\namplitude = 300\nshape = \"dome\"\nlength = 2500",
        "kind = \"fold\"\nwavelength = 900\namplitude = 90\nshape = \"chevron\"",
        "kind = \"fold\"\nwavelength = 1500\namplitude = 90\nshape = \"box\"\nstyle = \"parallel\"",
        "kind = \"fold\"\nwavelength = 2500\namplitude = 200\nshape = \"monocline\"\nstyle = \"parallel\"",
        "kind = \"dominoes\"\ndip = 65\nrotation = 20\nspacing = 700\nstrike = 15",
        "kind = \"fault\"\nshape = \"listric\"\nslip = 400\nshear = 60\nat = [1200, 1500, 0]",
        "kind = \"dyke\"\nthickness = 30\nstrike = 20\ncount = 4\nspacing = 300\ndip = 70",
        "kind = \"sill\"\nthickness = 60\ndepth = 500\ndip = 5",
        "kind = \"laccolith\"\nthickness = 300\ndepth = 500\nradius = 1200",
        "kind = \"salt\"\nradius = 400",
        "kind = \"salt\"\nshape = \"pillow\"\nradius = 900\ntop = 400\nbase = 700\nheight = 250",
        "kind = \"uplift\"\namount = 120",
    ];
    for event in events {
        let history = History::from_toml(&format!("{}[[events]]\n{event}\n", beds_text())).unwrap();
        let stage = history.last_stage();
        let mut draws = Draws(9);
        for _ in 0..5_000 {
            let q = draws.place();
            let (p, sides) = stage.after(0, q);
            let back = stage.before(0, &sides, p);
            assert!((back - q).length() < 1e-4, "{event}: {q} -> {p} -> {back}");
            // The sides that rock is given are those on which it lies.
            if let Place::Rock(rock) = stage.place(p)
                && history.units()[rock.unit].bed.is_some()
            {
                assert!((rock.ijk.truncate() - q.truncate()).length() < 1e-4, "{event}: {q} {:?}", rock.ijk);
            }
        }
    }
}

#[test]
fn gradients_are_those_of_the_coordinates() {
    let text = beds_text() + "[[events]]\nkind = \"tilt\"\ndip = 30\ndirection = 90\n";
    let history = History::from_toml(&text).unwrap();
    let stage = history.last_stage();
    let p = glam::DVec3::new(2100.0, 1400.0, 300.0);
    let Place::Rock(rock) = stage.place(p) else { panic!("no rock") };
    let gradient = stage.gradient(&rock, p);
    let thickness = [900.0, 200.0, 150.0, 250.0][rock.unit];
    let (sin, cos) = 30f64.to_radians().sin_cos();
    // Up, against depth: k grows along the normal of the beds by one in their thickness.
    assert!((gradient.row(2) - glam::DVec3::new(sin, 0.0, -cos) / thickness).length() < 1e-6, "{gradient}");
    assert!((gradient.row(1) - glam::DVec3::Y).length() < 1e-6);
}
