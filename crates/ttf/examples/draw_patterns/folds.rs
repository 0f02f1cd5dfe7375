//! Metamorphic rocks whose lines are bent or broken (FGDC 702–709).
//!
//! Straight rows are folded by shears, each along one axis by a wave of the other. A shear keeps areas and closes over
//! the tile's edges, and so does a chain of them: lines never cross, however tight the folds.

use std::f32::consts::{PI, TAU};

use crate::tile::{Dice, LINE, Point, THIN, Tile};

/// Side of the tiles.
const SIDE: f32 = 60.0;

/// Moves points along `axis` by `size`, in `waves` waves over the tile along the other axis.
struct Shear {
    axis: usize,
    size: f32,
    waves: f32,
    phase: f32,
}

fn folded(point: Point, shears: &[Shear]) -> Point {
    shears.iter().fold(point, |mut at, shear| {
        at[shear.axis] += shear.size * (TAU * shear.waves * at[1 - shear.axis] / SIDE + shear.phase).sin();
        at
    })
}

/// A row folded from `start` to `end`.
fn row(y: f32, start: f32, end: f32, shears: &[Shear]) -> Vec<Point> {
    let steps = ((end - start) / 0.9).ceil().max(2.0) as usize;
    (0..=steps).map(|step| folded([start + (end - start) * step as f32 / steps as f32, y], shears)).collect()
}

const TIGHT: [Shear; 3] = [
    Shear { axis: 1, size: 6.0, waves: 2.0, phase: 0.4 },
    Shear { axis: 0, size: 4.6, waves: 2.0, phase: 1.9 },
    Shear { axis: 1, size: 2.2, waves: 3.0, phase: 5.0 },
];

/// 706: folded foliation.
pub(crate) fn schist_contorted() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(706));
    for line in 0..18 {
        let y = (line as f32 + 0.5) * SIDE / 18.0;
        let mut x = dice.between(0.0, SIDE);
        let end = x + SIDE;
        let mut flake = line;
        while x < end - 6.0 {
            let length = dice.between(14.0, 26.0).min(end - x - 1.4);
            tile.curve(&row(y, x, x + length, &TIGHT), if flake % 4 == 0 { 0.85 } else { THIN });
            x += length + dice.between(1.4, 2.0);
            flake += 1;
        }
    }
    tile
}

/// 709: folded groups of bands with flecks between them.
pub(crate) fn gneiss_contorted() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(709));
    let mut taken: Vec<(Point, f32)> = Vec::new();
    for (top, lines) in [(2.0, 3), (16.0, 4), (32.0, 2), (44.0, 4)] {
        for line in 0..lines {
            let points = row(top + line as f32 * 1.9, -1.8, SIDE + 1.8, &TIGHT);
            tile.curve(&points, if line == 0 { 0.9 } else { THIN });
            taken.extend(points.iter().map(|&point| (point, 0.5)));
        }
    }
    flecks(&mut tile, &mut dice, 3.9, &taken, 3.1);
    tile
}

/// Short strokes in directions within `spread` of the horizontal.
fn flecks(tile: &mut Tile, dice: &mut Dice, gap: f32, taken: &[(Point, f32)], spread: f32) {
    for point in tile.scatter(dice, gap, taken, 1.6) {
        let (sin, cos) = dice.jitter(spread * 0.5).sin_cos();
        tile.line([point[0] - 1.3 * cos, point[1] - 1.3 * sin], [point[0] + 1.3 * cos, point[1] + 1.3 * sin], THIN);
    }
}

/// 707: groups of wavy bands, and flakes of schist between them.
pub(crate) fn schist_gneiss() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(707));
    let shears =
        [Shear { axis: 1, size: 1.3, waves: 2.0, phase: 0.0 }, Shear { axis: 1, size: 0.7, waves: 3.0, phase: 2.2 }];
    for bed in 0..3 {
        let top = bed as f32 * 20.0 + 1.5;
        for line in 0..4 {
            let width = if line == 0 || line == 3 { 0.9 } else { THIN };
            tile.curve(&row(top + line as f32 * 1.9, -1.8, SIDE + 1.8, &shears), width);
        }
        for line in 0..5 {
            let y = top + 8.2 + line as f32 * 2.4;
            let mut x = dice.between(0.0, SIDE);
            let end = x + SIDE;
            while x < end - 4.0 {
                let length = dice.between(5.0, 9.0).min(end - x - 1.3);
                let bend = dice.jitter(0.45);
                let points: Vec<Point> = row(y, x, x + length, &shears)
                    .into_iter()
                    .map(|[at, y]| {
                        let share = (at - x) / length;
                        [at, y + bend * (PI * share).sin() + (0.5 - share) * 0.9]
                    })
                    .collect();
                tile.curve(&points, 0.5);
                x += length + dice.between(1.2, 1.9);
            }
        }
    }
    tile
}

/// 704: wavy foliation with crystals between.
pub(crate) fn granite_schistose() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(704));
    let shears =
        [Shear { axis: 1, size: 2.3, waves: 2.0, phase: 0.8 }, Shear { axis: 0, size: 2.5, waves: 1.0, phase: 0.0 }];
    let mut taken: Vec<(Point, f32)> = Vec::new();
    for line in 0..7 {
        let points = row((line as f32 + 0.5) * SIDE / 7.0, -1.8, SIDE + 1.8, &shears);
        tile.curve(&points, LINE);
        taken.extend(points.iter().map(|&point| (point, 0.5)));
    }
    flecks(&mut tile, &mut dice, 3.5, &taken, PI);
    tile
}

/// 702: stipple with healed joints: arcs of close dots in all directions.
pub(crate) fn quartzite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(7021));
    let mut taken: Vec<(Point, f32)> = Vec::new();
    for centre in tile.scatter(&mut dice, 12.5, &[], 0.0) {
        let (turn, bend) = (dice.turn(), dice.jitter(1.6));
        let (sin, cos) = turn.sin_cos();
        for grain in -4..=4 {
            let along = grain as f32 * 1.45;
            let across = bend * (1.0 - (grain as f32 / 4.0).powi(2));
            let point = [centre[0] + along * cos - across * sin, centre[1] + along * sin + across * cos];
            tile.dot(point, 0.5);
            taken.push((point, 0.5));
        }
    }
    for point in tile.scatter(&mut dice, 2.9, &taken, 1.5) {
        tile.dot(point, 0.4);
    }
    tile
}
