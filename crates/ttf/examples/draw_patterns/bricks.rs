//! Limestones, dolostones and their beds among shale (FGDC 628–648, 673–680).

use crate::chemical::{NODULES, Wall, dashes};
use crate::tile::{DOT, Dice, LINE, Point, THIN, Tile, shell};

/// How far the joints of dolostone lean to each side.
const LEAN: f32 = 1.9;

/// An upright joint.
fn upright(tile: &mut Tile, foot: Point, height: f32) {
    tile.line(foot, [foot[0], foot[1] - height], LINE);
}

/// A leaning joint.
fn leaning(tile: &mut Tile, foot: Point, height: f32) {
    tile.line([foot[0] - LEAN, foot[1]], [foot[0] + LEAN, foot[1] - height], LINE);
}

/// A short stroke through `centre`.
fn chip(tile: &mut Tile, centre: Point, half: f32, turn: f32) {
    let (sin, cos) = turn.sin_cos();
    tile.line([centre[0] - half * cos, centre[1] - half * sin], [centre[0] + half * cos, centre[1] + half * sin], THIN);
}

/// 628: bricks with broken grains, leaning to one side and the other.
pub(crate) fn limestone_clastic() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(628));
    let mut turns = Dice::new(6281);
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        upright(tile, foot, height);
        for grain in 0..3 {
            let side = if (index + grain) % 2 == 0 { 1.0 } else { -1.0 };
            let centre = [foot[0] + 3.4 + grain as f32 * 4.1, foot[1] - height * 0.5 + turns.jitter(0.5)];
            chip(tile, centre, 1.15, side * turns.between(0.5, 0.85));
        }
    });
    tile
}

/// 629: bricks with broken grains and shells.
pub(crate) fn limestone_fossiliferous() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(629));
    let mut turns = Dice::new(6291);
    Wall { courses: 8, bricks: 3, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        upright(tile, foot, height);
        let y = foot[1] - height * 0.5;
        let place = if index % 2 == 0 { 6.2 } else { 13.6 };
        tile.polygon(&shell([foot[0] + place, y], 2.7, if index % 3 == 0 { -1.0 } else { 1.0 }), THIN);
        for grain in 0..2 {
            let x = foot[0] + if index % 2 == 0 { 11.8 + grain as f32 * 4.0 } else { 3.2 + grain as f32 * 4.0 };
            let side = if (index + grain) % 2 == 0 { 1.0 } else { -1.0 };
            chip(tile, [x, y + turns.jitter(0.7)], 1.15, side * turns.between(0.5, 0.85));
        }
    });
    tile
}

/// 630: courses that swell and pinch, with joints where they are thinnest.
pub(crate) fn limestone_nodular() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(630));
    let (courses, bricks) = (10, 5);
    let (height, step) = (tile.side / courses as f32, tile.side / bricks as f32);
    let lines: Vec<(f32, f32)> = (0..courses)
        .map(|course| (course as f32 * height, if course % 2 == 0 { 1.05 } else { -1.05 } * dice.between(0.9, 1.1)))
        .collect();
    let level = |(y, size): (f32, f32), x: f32| y + size * (std::f32::consts::TAU * x / step).sin();
    for (course, &line) in lines.iter().enumerate() {
        let points: Vec<Point> = (-2..=82).map(|part| part as f32 * 0.75).map(|x| [x, level(line, x)]).collect();
        tile.curve(&points, LINE);
        let above = if course == 0 { (lines[courses - 1].0 - 60.0, lines[courses - 1].1) } else { lines[course - 1] };
        // An even line is up where the one above it is down, a quarter of a wave to the left.
        let pinch = if course % 2 == 0 { 0.75 } else { 0.25 };
        for brick in 0..bricks {
            let x = (brick as f32 + pinch) * step;
            tile.line([x, level(line, x)], [x, level(above, x)], LINE);
        }
    }
    tile
}

/// 637: bricks, with a dash and with three grains of silt in turn.
pub(crate) fn limestone_silty() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(637));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        upright(tile, foot, height);
        silt(tile, [foot[0] + 7.5, foot[1] - height * 0.5], (index + index / 8) % 2 == 0);
    });
    tile
}

/// A dash, or three grains in a row.
fn silt(tile: &mut Tile, centre: Point, is_dash: bool) {
    if is_dash {
        tile.line([centre[0] - 3.2, centre[1]], [centre[0] + 3.2, centre[1]], THIN);
    } else {
        (-1..=1).for_each(|grain| tile.dot([centre[0] + grain as f32 * 2.2, centre[1]], DOT));
    }
}

/// 644: leaning bricks with ooids.
pub(crate) fn dolostone_oolitic() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(644));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        leaning(tile, foot, height);
        for ooid in 0..2 {
            let wave = [0.35, -0.3, 0.15, -0.45][(index + ooid) % 4];
            tile.ellipse([foot[0] + 5.2 + ooid as f32 * 4.6, foot[1] - height * 0.5 + wave], [1.15, 1.15], THIN);
        }
    });
    tile
}

/// 645: leaning bricks with sand grains.
pub(crate) fn dolostone_sandy() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(645));
    let mut joints: Vec<(Point, f32)> = Vec::new();
    Wall { courses: 8, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, _| {
        leaning(tile, foot, height);
        joints.extend((0..=6).map(|part| {
            let share = part as f32 / 6.0;
            ([foot[0] + LEAN * (2.0 * share - 1.0), foot[1] - height * share], 0.3)
        }));
    });
    for point in tile.scatter(&mut dice, 3.1, &joints, 1.4) {
        if (1.5..6.0).contains(&(point[1] % 7.5)) {
            tile.dot(point, DOT);
        }
    }
    tile
}

/// 646: leaning bricks, with a dash and with three grains of silt in turn.
pub(crate) fn dolostone_silty() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6462));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        leaning(tile, foot, height);
        silt(tile, [foot[0] + 7.5, foot[1] - height * 0.5], (index + index / 8) % 2 == 0);
    });
    tile
}

/// 647: leaning bricks with a clay stroke in each.
pub(crate) fn dolostone_shaly() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6471));
    Wall { courses: 8, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        leaning(tile, foot, height);
        let y = foot[1] - height * if index % 2 == 0 { 0.4 } else { 0.6 };
        tile.line([foot[0] + 4.0, y], [foot[0] + 11.0, y], THIN);
    });
    tile
}

/// 648: leaning bricks with black nodules of chert.
pub(crate) fn dolostone_cherty() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6481));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        leaning(tile, foot, height);
        if NODULES[9 - index / 4].contains(&(index % 4)) {
            tile.filled_ellipse([foot[0] + 7.5, foot[1] - height * 0.5], [3.0, 1.25]);
        }
    });
    tile
}

/// A bed of bricks from `top` down, without the line at its base.
fn brick_bed(tile: &mut Tile, dice: &mut Dice, top: f32, courses: usize, height: f32, bricks: usize) {
    let step = tile.side / bricks as f32;
    for course in 0..courses {
        let y = top + course as f32 * height;
        tile.line([-2.0, y], [62.0, y], LINE);
        for brick in 0..bricks {
            let x = (brick as f32 + 0.5 * (course % 2) as f32 + 0.25) * step + top + dice.jitter(step * 0.04);
            tile.line([x, y], [x, y + height], LINE);
        }
    }
    let base = top + courses as f32 * height;
    tile.line([-2.0, base], [62.0, base], LINE);
}

/// Rows of dashes below `top`; `tick` stands on every second one.
fn shale_bed(tile: &mut Tile, dice: &mut Dice, top: f32, rows: usize, gap: f32, has_ticks: bool) {
    for row in 0..rows {
        let y = top + (row + 1) as f32 * gap;
        let shift = [0.0, 5.5, 2.0, 7.5, 4.0][row % 5] + top + dice.jitter(0.5);
        for dash in 0..6 {
            let x = dash as f32 * 10.0 + shift;
            tile.line([x, y], [x + 6.6, y], THIN);
            if has_ticks && (dash + row) % 2 == 0 {
                tile.line([x + 3.3, y], [x + 3.3, y - gap * 0.72], THIN);
            }
        }
    }
}

/// 673: shale with thin beds of limestone.
pub(crate) fn shale_limestone() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(673));
    for bed in 0..2 {
        let top = bed as f32 * 30.0;
        brick_bed(&mut tile, &mut dice, top, 2, 4.5, 4);
        shale_bed(&mut tile, &mut dice, top + 9.0, 6, 3.0, false);
    }
    tile
}

/// 679: limestone with thin beds of shale.
pub(crate) fn limestone_shale_partings() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(679));
    for bed in 0..2 {
        let top = bed as f32 * 30.0;
        brick_bed(&mut tile, &mut dice, top, 4, 5.3, 4);
        shale_bed(&mut tile, &mut dice, top + 21.2, 2, 2.95, false);
    }
    tile
}

/// 680: beds of limestone and of marl.
pub(crate) fn limestone_marl() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(680));
    for bed in 0..3 {
        let top = bed as f32 * 20.0;
        brick_bed(&mut tile, &mut dice, top, 2, 4.6, 4);
        shale_bed(&mut tile, &mut dice, top + 9.2, 3, 2.75, true);
    }
    tile
}

/// 622: dashes, every second one with a leaning joint.
pub(crate) fn shale_dolomitic() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(622));
    dashes(&mut tile, &mut dice, 15, 5, 0.72, |tile, index, at, length| {
        if index % 2 == 0 {
            let x = at[0] + length * 0.42;
            tile.line([x, at[1]], [x + 1.7, at[1] - 2.6], THIN);
        }
    });
    tile
}

/// 621: rows of dashes with open lenses of chert.
pub(crate) fn shale_cherty() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(621));
    dashes(&mut tile, &mut dice, 15, 5, 0.44, |tile, index, at, length| {
        if (index % 5 + index / 5) % 3 == 0 {
            tile.ellipse([at[0] + length + 3.3, at[1]], [2.2, 0.95], THIN);
        }
    });
    tile
}
