//! Tuffs, agglomerate and the igneous rocks of one sign (FGDC 712–732).

use std::f32::consts::{FRAC_PI_4, PI, TAU};

use crate::clastic::radii;
use crate::tile::{Dice, LINE, Point, THIN, Tile, hatch, polar, staggered};

/// A point given along and across a direction, seen from `centre`.
fn turned(centre: Point, turn: f32, along: f32, across: f32) -> Point {
    let (sin, cos) = turn.sin_cos();
    [centre[0] + along * cos - across * sin, centre[1] + along * sin + across * cos]
}

/// A stroke through `centre`, `half` long to each side.
fn stroke(tile: &mut Tile, centre: Point, turn: f32, half: f32, width: f32) {
    tile.line(turned(centre, turn, -half, 0.0), turned(centre, turn, half, 0.0), width);
}

/// Dots between signs of the given radius.
fn dots_between(tile: &mut Tile, dice: &mut Dice, signs: &[Point], radius: f32, gap: f32) {
    let taken: Vec<(Point, f32)> = signs.iter().map(|&point| (point, radius)).collect();
    for point in tile.scatter(dice, gap, &taken, 1.2) {
        tile.dot(point, 0.42);
    }
}

/// 712: leaning crosses in rows.
pub(crate) fn tuff_crystal() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(712));
    for [x, y] in staggered(60.0, 8, 6) {
        let centre = [x + dice.jitter(0.5), y + dice.jitter(0.5)];
        for turn in [1.05, -1.05] {
            stroke(&mut tile, centre, turn, 2.1, LINE);
        }
    }
    tile
}

/// 713: long lying crosses.
pub(crate) fn tuff_devitrified() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(713));
    for [x, y] in staggered(60.0, 10, 5) {
        let x = x + dice.jitter(0.5);
        tile.line([x - 3.6, y], [x + 3.6, y], THIN);
        tile.line([x, y - 1.5], [x, y + 1.5], THIN);
    }
    tile
}

/// 715: blocks of many corners, some of them layered, in a dotted ground.
pub(crate) fn agglomerate() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(7153));
    let sizes = radii(&mut dice, &[(12, 5.2), (18, 3.4), (34, 2.1)]);
    let blocks = tile.pack(&mut dice, &sizes, 0.25);
    for (index, &(centre, radius)) in blocks.iter().enumerate() {
        let corners = if radius > 3.0 { 7 } else { 5 };
        let start = dice.turn();
        let outline: Vec<Point> = (0..corners)
            .map(|corner| {
                let angle = start + TAU * corner as f32 / corners as f32 + dice.jitter(0.3);
                polar(centre, radius * dice.between(0.7, 1.0), angle, 0.85)
            })
            .collect();
        tile.polygon(&outline, LINE);
        if index < 12 && index % 2 == 0 {
            hatch(&mut tile, &outline, dice.turn(), 1.5, 0.0, 0.45);
        }
    }
    for point in tile.scatter(&mut dice, 3.2, &blocks, 0.5) {
        tile.dot(point, 0.45);
    }
    tile
}

/// 716: the letter z, for zeolites.
pub(crate) fn zeolitic() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(716));
    for [x, y] in staggered(60.0, 8, 5) {
        let (x, y) = (x + dice.jitter(0.5), y + dice.jitter(0.4));
        tile.polyline(&[[x - 1.7, y - 2.0], [x + 1.7, y - 2.0], [x - 1.7, y + 2.0], [x + 1.7, y + 2.0]], LINE);
    }
    tile
}

/// 720: bands of blocks ruled one way and the other, between open bands.
pub(crate) fn banded() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(7201));
    let edge = |y: f32, phase: f32, x: f32| {
        let turn = TAU * x / 60.0;
        y + 1.3 * (turn + phase).sin() + 0.6 * (2.0 * turn + 2.0 * phase).sin()
    };
    for (top, base, phase) in [(2.0, 13.0, 0.4), (22.0, 30.0, 2.6), (40.0, 53.0, 4.4)] {
        for (y, shift) in [(top, phase), (base, phase + 0.5)] {
            let points: Vec<Point> = (-3..=43).map(|part| part as f32 * 1.5).map(|x| [x, edge(y, shift, x)]).collect();
            tile.curve(&points, LINE);
        }
        let count = 10;
        let joints: Vec<[f32; 2]> = (0..count)
            .map(|joint| {
                let x = joint as f32 * 60.0 / count as f32 + dice.jitter(0.9);
                [x + dice.jitter(1.4), x + dice.jitter(1.4)]
            })
            .collect();
        for joint in 0..count {
            let left = joints[joint];
            let right = joints[(joint + 1) % count].map(|x| if joint + 1 == count { x + 60.0 } else { x });
            let along = |from: f32, to: f32, y: f32, shift: f32| {
                (0..=6).map(move |part| from + (to - from) * part as f32 / 6.0).map(move |x| [x, edge(y, shift, x)])
            };
            let outline: Vec<Point> =
                along(left[0], right[0], top, phase).chain(along(right[1], left[1], base, phase + 0.5)).collect();
            tile.line(outline[0], outline[13], THIN);
            let lean = (base - top).atan2(left[1] - left[0]);
            let angle = if joint % 2 == 0 { lean } else { dice.jitter(0.25) };
            hatch(&mut tile, &outline, angle, 1.75, 0.0, 0.45);
        }
    }
    tile
}

/// 721: small upright crosses.
pub(crate) fn igneous() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(721));
    for [x, y] in staggered(60.0, 14, 7) {
        let centre = [x + dice.jitter(0.3), y + dice.jitter(0.3)];
        stroke(&mut tile, centre, 0.0, 1.35, THIN);
        stroke(&mut tile, centre, PI * 0.5, 1.35, THIN);
    }
    tile
}

/// A small v that opens towards `turn`.
fn wedge(tile: &mut Tile, centre: Point, turn: f32, arm: f32, width: f32) {
    let ends =
        [-0.5, 0.5].map(|angle: f32| [centre[0] + arm * (turn + angle).cos(), centre[1] + arm * (turn + angle).sin()]);
    tile.polyline(&[ends[0], centre, ends[1]], width);
}

/// 722: fine strokes and small v's in all directions.
pub(crate) fn rhyolite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(7222));
    for (index, point) in tile.scatter(&mut dice, 3.3, &[], 0.0).into_iter().enumerate() {
        let turn = dice.turn();
        if index % 4 == 0 {
            wedge(&mut tile, turned(point, turn, -0.9, 0.0), turn, 2.0, 0.5);
        } else {
            stroke(&mut tile, point, turn, 0.85, 0.5);
        }
    }
    tile
}

/// 723: small v's in all directions among dots.
pub(crate) fn dacite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(723));
    let signs = tile.scatter(&mut dice, 6.6, &[], 0.0);
    for &point in &signs {
        let turn = dice.turn();
        wedge(&mut tile, turned(point, turn, -1.1, 0.0), turn, 2.4, THIN);
    }
    dots_between(&mut tile, &mut dice, &signs, 1.6, 2.9);
    tile
}

/// 724: small v's in all directions.
pub(crate) fn andesite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(7241));
    for point in tile.scatter(&mut dice, 5.6, &[], 0.0) {
        let turn = dice.turn();
        wedge(&mut tile, turned(point, turn, -1.3, 0.0), turn, 2.9, LINE);
    }
    tile
}

/// 725: leaning crosses among dots.
pub(crate) fn diorite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(725));
    let signs: Vec<Point> = staggered(60.0, 10, 6).collect();
    for &centre in &signs {
        stroke(&mut tile, centre, FRAC_PI_4, 1.5, THIN);
        stroke(&mut tile, centre, -FRAC_PI_4, 1.5, THIN);
    }
    dots_between(&mut tile, &mut dice, &signs, 1.5, 2.6);
    tile
}

/// 726: needles with a short bar across, in all directions.
pub(crate) fn syenite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(726));
    for point in tile.scatter(&mut dice, 5.9, &[], 0.0) {
        let turn = dice.between(0.0, PI);
        stroke(&mut tile, point, turn, 2.5, LINE);
        stroke(&mut tile, point, turn + PI * 0.5, 0.95, LINE);
    }
    tile
}

/// 727: pairs of strokes in all directions among dots.
pub(crate) fn gabbro() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(727));
    let signs = tile.scatter(&mut dice, 6.6, &[], 0.0);
    for &point in &signs {
        let turn = dice.between(0.0, PI);
        for across in [-0.75, 0.75] {
            let (from, to) = (turned(point, turn, -1.8, across), turned(point, turn, 1.8, across));
            tile.line(from, to, LINE);
        }
    }
    dots_between(&mut tile, &mut dice, &signs, 2.0, 2.9);
    tile
}

/// 728: slanting needles with two short bars across, in rows.
pub(crate) fn peridotite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(728));
    for [x, y] in staggered(60.0, 8, 6) {
        let centre = [x + dice.jitter(0.3), y + dice.jitter(0.3)];
        stroke(&mut tile, centre, -FRAC_PI_4, 2.9, LINE);
        for along in [-0.85, 0.85] {
            stroke(&mut tile, turned(centre, -FRAC_PI_4, along, 0.0), FRAC_PI_4, 1.25, THIN);
        }
    }
    tile
}

/// 731: upright v's in rows.
pub(crate) fn vitrophyre() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(731));
    for [x, y] in staggered(60.0, 8, 6) {
        let (x, y) = (x + dice.jitter(0.4), y + dice.jitter(0.4));
        tile.polyline(&[[x - 1.5, y - 2.2], [x, y + 2.0], [x + 1.5, y - 2.2]], LINE);
    }
    tile
}

/// 732: wavy strokes in all directions.
pub(crate) fn quartz() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(732));
    for centre in tile.scatter(&mut dice, 6.4, &[], 0.0) {
        let (turn, phase) = (dice.turn(), dice.turn());
        let points: Vec<Point> = (0..=16)
            .map(|part| {
                let along = (part as f32 / 8.0 - 1.0) * 3.4;
                turned(centre, turn, along, 0.5 * (along * 1.75 + phase).sin())
            })
            .collect();
        tile.curve(&points, LINE);
    }
    tile
}
