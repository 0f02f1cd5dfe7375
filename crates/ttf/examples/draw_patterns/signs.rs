//! Rocks that are known by a sign among stipple, dashes or nothing (FGDC 613–617, 651–671, 684).

use crate::chemical::lens;
use crate::clastic::{beds_under_stipple, dotted_row, radii, ripple};
use crate::tile::{DOT, Dice, LINE, Point, THIN, Tile, hatch, nodule, pebble, shell, staggered};

/// Stipple with short beds, each with a joint whose top lies `lean` to the right of its foot.
fn sandstone_with_joints(seed: u64, lean: f32) -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(seed));
    let mut taken: Vec<(Point, f32)> = Vec::new();
    for row in 0..10 {
        let y = row as f32 * 6.0 + 4.2;
        for column in 0..3 {
            let x = column as f32 * 20.0 + [0.0, 12.0, 5.0, 16.5, 9.0][row % 5] + dice.jitter(1.0);
            let half = dice.between(3.8, 4.8);
            tile.line([x - half, y], [x + half, y], LINE);
            let foot = x + [-1.6, 1.2, -0.4][(row + column) % 3];
            tile.line([foot, y], [foot + lean, y - 2.6], LINE);
            taken.extend((-4..=4).map(|step| ([x + half * step as f32 / 4.0, y], 0.3)));
            taken.extend((1..=3).map(|step| ([foot + lean * step as f32 / 3.0, y - 0.87 * step as f32], 0.3)));
        }
    }
    for point in tile.scatter(&mut dice, 3.0, &taken, 1.3) {
        tile.dot(point, DOT);
    }
    tile
}

/// 613: stipple with short beds that have an upright joint.
pub(crate) fn sandstone_calcareous() -> Tile {
    sandstone_with_joints(613, 0.0)
}

/// 614: stipple with short beds that have a leaning joint.
pub(crate) fn sandstone_dolomitic() -> Tile {
    sandstone_with_joints(614, 1.7)
}

/// Rows of a dash with a joint and three dots.
fn siltstone_with_joints(seed: u64, lean: f32) -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(seed));
    for row in 0..15 {
        let y = row as f32 * 4.0 + 3.2;
        let shift = [0.0, 8.0, 3.5, 11.5, 6.0][row % 5] + dice.jitter(0.4);
        for column in 0..4 {
            let x = column as f32 * 15.0 + shift;
            tile.line([x, y], [x + 6.4, y], THIN);
            let foot = x + [1.8, 3.4][(row + column) % 2] - lean * 0.4;
            tile.line([foot, y], [foot + lean, y - 2.3], THIN);
            for dot in 0..3 {
                tile.dot([x + 8.6 + dot as f32 * 2.1, y], 0.42);
            }
        }
    }
    tile
}

/// 617: siltstone with upright joints.
pub(crate) fn siltstone_calcareous() -> Tile {
    siltstone_with_joints(617, 0.0)
}

/// 618: siltstone with leaning joints.
pub(crate) fn siltstone_dolomitic() -> Tile {
    siltstone_with_joints(6181, 2.1)
}

/// 651: beds of chert with a shell in every second body.
pub(crate) fn chert_fossiliferous() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(651));
    for course in 0..8 {
        let y = course as f32 * 7.5 + 3.75;
        for body in 0..4 {
            let x = (body as f32 + 0.5 * (course % 2) as f32) * 15.0 + dice.jitter(0.5);
            let (half, rise) = (dice.between(6.5, 7.1), dice.between(2.8, 3.1));
            tile.blob(&nodule([x, y], [half, rise]), LINE);
            if (body + course / 2) % 2 == 0 {
                tile.polygon(&shell([x, y], 2.6, if (body + course) % 3 == 0 { -1.0 } else { 1.0 }), THIN);
            }
        }
    }
    tile
}

/// 652: shells, most of them with the hollow side down, as currents leave them.
pub(crate) fn fossiliferous() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6522));
    for (index, centre) in tile.scatter(&mut dice, 8.4, &[], 0.0).into_iter().enumerate() {
        let half = dice.between(2.2, 3.0);
        tile.polygon(&shell(centre, half, if index % 3 == 2 { -1.0 } else { 1.0 }), LINE);
    }
    tile
}

/// 653: diatoms: a ring between two pairs of short lines.
pub(crate) fn diatomite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(653));
    for [x, y] in staggered(60.0, 10, 4) {
        let (x, y) = (x + dice.jitter(1.2), y + dice.jitter(0.7));
        tile.ellipse([x, y], [1.35, 1.35], THIN);
        for side in [-1.0, 1.0] {
            for row in [-0.62, 0.62] {
                tile.line([x + side * 1.3, y + row], [x + side * 4.0, y + row], THIN);
            }
        }
    }
    tile
}

/// 654: close rows of grains, with long strokes of clay among them.
pub(crate) fn graywacke() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(654));
    for row in 0..18 {
        let y = (row as f32 + 0.5) * 60.0 / 18.0;
        let shift = [0.0, 17.0, 7.5, 24.0, 12.0, 3.0][row % 6] + dice.jitter(0.6);
        for part in 0..2 {
            let x = part as f32 * 30.0 + shift;
            let length = dice.between(8.5, 10.0);
            tile.line([x, y], [x + length, y], LINE);
            for grain in 0..8 {
                tile.dot([x + length + 2.1 + grain as f32 * 2.3 + dice.jitter(0.2), y + dice.jitter(0.12)], DOT);
            }
        }
    }
    tile
}

/// Lengths of the lenses of [`coal_bony`], row by row.
const LENSES: [f32; 3] = [21.0, 15.0, 18.5];

/// 659: coal with lenses of hatched rock. The black lies in bands between the middles of the lenses.
pub(crate) fn coal_bony() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6591));
    let rows: Vec<(f32, f32)> = (0..8).map(|row| (row as f32 * 7.5, row as f32 * 11.0 + dice.jitter(3.0))).collect();
    // Half the thickness of a row's lenses; a little less than nothing between them, so that bands overlap there.
    let swell = |row: usize, x: f32| {
        let row = row % rows.len();
        let shift = rows[row].1;
        let (length, step) = (LENSES[row % 3], 30.0);
        let along = (x - shift).rem_euclid(step) / length;
        if along < 1.0 { 2.75 * (std::f32::consts::PI * along).sin().powf(0.55) - 0.1 } else { -0.1 }
    };
    let xs: Vec<f32> = (0..=204).map(|step| -0.5 + step as f32 * 0.3).collect();
    for (row, &(top, _)) in rows.iter().enumerate() {
        let base = top + 7.5;
        let upper = xs.iter().map(|&x| [x, top + swell(row, x)]);
        let lower = xs.iter().rev().map(|&x| [x, base - swell(row + 1, x)]);
        tile.filled_polygon(&upper.chain(lower).collect::<Vec<_>>());
    }
    for (row, &(y, shift)) in rows.iter().enumerate() {
        for step in 0..2 {
            let length = LENSES[row % 3];
            let start = shift + step as f32 * 30.0;
            let mut along = 1.6;
            while along < length - 1.6 {
                let half = swell(row, start + along).max(0.0) * 0.8;
                tile.line([start + along - half * 0.5, y + half], [start + along + half * 0.5, y - half], 0.5);
                along += 2.1;
            }
        }
    }
    tile
}

/// 660: beds with roots below them.
pub(crate) fn underclay() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(660));
    for (bed, top) in [1.0, 14.0, 25.5, 42.0].into_iter().enumerate() {
        let depth: f32 = [9.0, 7.5, 12.0, 14.5][bed];
        tile.line([-2.0, top], [62.0, top], LINE);
        for root in 0..15 {
            let x = root as f32 * 4.0 + bed as f32 * 1.3 + dice.jitter(0.6);
            let length = depth * dice.between(0.65, 1.0);
            let phase = dice.turn();
            let at = |share: f32| {
                let wave = 0.55 * share.sqrt() * (length * share * 0.9 + phase).sin();
                [x + wave, top + length * share]
            };
            tile.curve(&(0..=8).map(|part| at(part as f32 / 8.0)).collect::<Vec<_>>(), THIN);
            if (root + bed) % 3 == 0 {
                let from = at(0.45);
                let side = if root % 2 == 0 { 1.3 } else { -1.3 };
                tile.curve(&[from, [from[0] + side * 0.7, from[1] + 1.0], [from[0] + side, from[1] + 2.4]], THIN);
            }
        }
    }
    tile
}

/// 661: crossed ruling.
pub(crate) fn flint_clay() -> Tile {
    let mut tile = Tile::new(60.0);
    for index in 0..15 {
        let x = index as f32 * 4.0;
        tile.line([x - 2.0, -2.0], [x + 62.0, 62.0], 0.5);
        tile.line([x + 2.0, -2.0], [x - 62.0, 62.0], 0.5);
    }
    tile
}

/// 662: a stroke that forks.
pub(crate) fn bentonite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(662));
    for [x, y] in staggered(60.0, 10, 4) {
        let (x, y) = (x + dice.jitter(1.3), y + dice.jitter(0.6));
        tile.line([x - 3.6, y], [x + 2.0, y], LINE);
        tile.polyline(&[[x + 3.4, y - 1.3], [x + 2.0, y], [x + 3.4, y + 1.3]], LINE);
    }
    tile
}

/// 663: a stroke like a bird in flight, for pellets of glauconite.
pub(crate) fn glauconite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(663));
    for [x, y] in staggered(60.0, 10, 4) {
        let (x, y) = (x + dice.jitter(1.3), y + dice.jitter(0.6));
        tile.curve(&[[x - 3.5, y + 0.5], [x - 2.4, y - 0.1], [x - 1.5, y - 1.2]], LINE);
        tile.curve(&[[x - 1.5, y - 1.2], [x - 0.3, y - 0.1], [x + 1.4, y + 0.45], [x + 3.6, y - 0.1]], LINE);
    }
    tile
}

/// 664: a square in a ring.
pub(crate) fn limonite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(664));
    for [x, y] in staggered(60.0, 8, 5) {
        let (x, y) = (x + dice.jitter(1.0), y + dice.jitter(0.8));
        tile.ellipse([x, y], [2.35, 2.35], THIN);
        let half = 0.85;
        tile.polygon(&[[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]], THIN);
    }
    tile
}

/// 665: a cross in a ring.
pub(crate) fn siderite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6652));
    for [x, y] in staggered(60.0, 8, 5) {
        let (x, y) = (x + dice.jitter(1.0), y + dice.jitter(0.8));
        tile.ellipse([x, y], [2.35, 2.35], THIN);
        tile.line([x - 2.35, y], [x + 2.35, y], THIN);
        tile.line([x, y - 2.35], [x, y + 2.35], THIN);
    }
    tile
}

/// 666: black nodules, some of them drawn out.
pub(crate) fn phosphorite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6661));
    for centre in tile.scatter(&mut dice, 7.2, &[], 0.0) {
        let (radius, flat, tilt) = (dice.between(1.5, 2.6), dice.between(0.42, 0.6), dice.jitter(0.2));
        tile.filled_blob(&pebble(&mut dice, centre, radius, flat, tilt));
    }
    tile
}

/// 669: beds of stipple and of siltstone in turn.
pub(crate) fn sandstone_siltstone() -> Tile {
    beds_under_stipple(669, 4, |tile, [x, y]| {
        tile.line([x, y], [x + 6.0, y], THIN);
        (0..3).for_each(|dot| tile.dot([x + 8.3 + dot as f32 * 2.2, y], 0.42));
    })
}

/// 671: rows of grains over ripples, and rows of clay that follow them.
pub(crate) fn sandstone_shale_rippled() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(671));
    for row in 0..15 {
        let y = (row as f32 + 0.5) * 4.0;
        let shift = (row / 3) as f32 * 4.8 + (row % 3) as f32 * 0.6;
        let height = |x: f32| ripple((x + shift) / 12.0) * 0.95;
        if row % 3 == 2 {
            for dash in 0..5 {
                // From trough to trough, over a crest.
                let x = dash as f32 * 12.0 - shift + 5.2 + dice.jitter(0.3);
                let points: Vec<Point> =
                    (0..=8).map(|part| x + part as f32 * 1.2).map(|x| [x, y + height(x)]).collect();
                tile.curve(&points, LINE);
            }
        } else {
            dotted_row(&mut tile, &mut dice, y, 30, height);
        }
    }
    tile
}

/// 684: upright wavy strokes, as loess stands in walls.
pub(crate) fn loess() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(684));
    for column in 0..18 {
        let x = (column as f32 + 0.5) * 60.0 / 18.0;
        let phase = dice.turn();
        let wave = |y: f32| x + 0.6 * (std::f32::consts::TAU * y / 15.0 + phase).sin();
        let mut y = dice.between(0.0, 60.0);
        let end = y + 60.0;
        while y < end - 4.0 {
            let length = dice.between(7.0, 12.0).min(end - y - 2.0);
            let points: Vec<Point> = (0..=6).map(|part| y + length * part as f32 / 6.0).map(|y| [wave(y), y]).collect();
            tile.curve(&points, LINE);
            y += length + dice.between(1.8, 2.6);
        }
    }
    tile
}

/// 733: bodies of crossed ruling, and black streaks.
pub(crate) fn ore() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(7332));
    let sizes = radii(&mut dice, &[(4, 9.0), (4, 5.5)]);
    let bodies = tile.pack(&mut dice, &sizes, 1.2);
    let mut taken = Vec::new();
    for &(centre, radius) in &bodies {
        let tilt = dice.jitter(0.25);
        let outline = pebble(&mut dice, centre, radius * 1.1, 0.62, tilt);
        tile.blob(&outline, LINE);
        for angle in [0.785, -0.785] {
            hatch(&mut tile, &outline, angle, 1.9, 0.0, 0.45);
        }
        taken.push((centre, radius));
    }
    for centre in tile.scatter(&mut dice, 7.0, &taken, 4.0) {
        lens(&mut tile, centre, [dice.between(2.6, 4.0), dice.between(0.55, 0.85)]);
    }
    tile
}
