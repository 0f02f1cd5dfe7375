//! Shales, carbonates, chert, coal, evaporites (FGDC 620–668, 677).

use crate::tile::{Dice, LINE, Point, THIN, Tile, nodule, shard};

/// Rows of dashes, each row shifted against the one before. `each` is called with the left end and the length
/// of every dash.
pub(crate) fn dashes(
    tile: &mut Tile,
    dice: &mut Dice,
    rows: usize,
    per_row: usize,
    share: f32,
    mut each: impl FnMut(&mut Tile, usize, Point, f32),
) {
    let (height, step) = (tile.side / rows as f32, tile.side / per_row as f32);
    for row in 0..rows {
        let y = (row as f32 + 0.5) * height;
        let shift = step * ([0.0, 0.55, 0.2, 0.75, 0.4][row % 5]) + dice.jitter(step * 0.05);
        for column in 0..per_row {
            let length = step * share * dice.between(0.92, 1.08);
            let x = column as f32 * step + shift + dice.jitter(step * 0.04);
            tile.line([x, y], [x + length, y], THIN);
            each(tile, row * per_row + column, [x, y], length);
        }
    }
}

/// 620: short dashes, the plainest of shales.
pub(crate) fn shale() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(620));
    dashes(&mut tile, &mut dice, 20, 6, 0.66, |_, _, _, _| {});
    tile
}

/// 619: shale with rows of dots.
pub(crate) fn shale_sandy() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(619));
    dashes(&mut tile, &mut dice, 15, 4, 0.58, |tile, _, at, length| {
        tile.dot([at[0] + length + 3.1, at[1]], 0.42);
    });
    tile
}

/// 623: shale with the short joints of limestone.
pub(crate) fn marl() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(623));
    dashes(&mut tile, &mut dice, 15, 5, 0.72, |tile, index, at, length| {
        if index % 2 == 0 {
            let x = at[0] + length * 0.5;
            tile.line([x, at[1]], [x, at[1] - 2.6], THIN);
        }
    });
    tile
}

/// 624: fine bedding planes close together, some of them broken.
pub(crate) fn shale_carbonaceous() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(624));
    for row in 0..24 {
        let y = row as f32 * 2.5 + 1.25;
        if row % 3 == 2 {
            let start = dice.between(0.0, 60.0);
            for part in 0..3 {
                let x = start + part as f32 * 20.0;
                tile.line([x, y], [x + dice.between(12.0, 17.0), y], 1.15);
            }
        } else {
            tile.line([-1.0, y], [61.0, y], 0.45);
        }
    }
    tile
}

/// 625: lens-shaped bands of different thickness, as kerogen lies in shale.
pub(crate) fn oil_shale() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6252));
    let mut y = 2.0;
    let mut band = 0;
    while y < 59.0 {
        let thickness = [0.5, 1.9, 0.6, 0.5, 1.2, 0.5, 2.5, 0.6, 1.0, 0.5][band % 10];
        if thickness < 1.0 {
            tile.line([-1.0, y], [61.0, y], thickness);
        } else {
            let start = dice.between(0.0, 60.0);
            for half in 0..2 {
                let length = dice.between(24.5, 28.0);
                lens(&mut tile, [start + half as f32 * 30.0 + length * 0.5, y], [length * 0.5, thickness * 0.5]);
            }
        }
        y += thickness * 0.5 + 2.1 + [0.3, 0.0, 0.6][band % 3];
        band += 1;
    }
    tile
}

/// A flat filled body with pointed ends.
pub(crate) fn lens(tile: &mut Tile, centre: Point, radii: [f32; 2]) {
    let arc = |sign: f32| {
        (0..=24).map(move |step| {
            let t = step as f32 / 12.0 - 1.0;
            let swell = (1.0 - t * t).powf(0.7);
            [centre[0] + sign * t * radii[0], centre[1] - sign * swell * radii[1]]
        })
    };
    let outline: Vec<Point> = arc(1.0).chain(arc(-1.0).skip(1).take(23)).collect();
    tile.filled_polygon(&outline);
}

/// Courses of bricks. `joint` draws a head joint: it is called with the foot, the height and the course of
/// each.
pub(crate) struct Wall {
    pub courses: usize,
    pub bricks: usize,
    pub width: f32,
}

impl Wall {
    pub(crate) fn draw(&self, tile: &mut Tile, dice: &mut Dice, mut joint: impl FnMut(&mut Tile, Point, f32, usize)) {
        let (height, step) = (tile.side / self.courses as f32, tile.side / self.bricks as f32);
        for course in 0..self.courses {
            let base = (course + 1) as f32 * height;
            tile.line([-2.0, base], [tile.side + 2.0, base], self.width);
            for brick in 0..self.bricks {
                let x = (brick as f32 + 0.5 * (course % 2) as f32 + 0.25) * step + dice.jitter(step * 0.035);
                joint(tile, [x, base], height, course * self.bricks + brick);
            }
        }
    }
}

/// 627: bricks.
pub(crate) fn limestone() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(627));
    Wall { courses: 10, bricks: 5, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, _| {
        tile.line(foot, [foot[0], foot[1] - height], LINE);
    });
    tile
}

/// 642: leaning bricks.
pub(crate) fn dolostone() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(642));
    Wall { courses: 10, bricks: 5, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, _| {
        tile.line([foot[0] - 1.9, foot[1]], [foot[0] + 1.9, foot[1] - height], LINE);
    });
    tile
}

/// 641: upright and leaning joints alternate.
pub(crate) fn limestone_dolomitic() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(641));
    Wall { courses: 10, bricks: 5, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        let lean = if (index / 5).is_multiple_of(2) { 0.0 } else { 1.9 };
        tile.line([foot[0] - lean, foot[1]], [foot[0] + lean, foot[1] - height], LINE);
    });
    tile
}

/// 635: bricks with ooids.
pub(crate) fn limestone_oolitic() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(635));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        tile.line(foot, [foot[0], foot[1] - height], LINE);
        for ooid in 1..=3 {
            let wave = [0.5, -0.4, 0.2, -0.6][(index + ooid) % 4];
            tile.ellipse([foot[0] + ooid as f32 * 3.75, foot[1] - height * 0.5 + wave], [1.05, 1.05], THIN);
        }
    });
    tile
}

/// 636: bricks with sand grains.
pub(crate) fn limestone_sandy() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(636));
    let mut joints: Vec<(Point, f32)> = Vec::new();
    Wall { courses: 8, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, _| {
        tile.line(foot, [foot[0], foot[1] - height], LINE);
        joints.extend((0..=6).map(|part| ([foot[0], foot[1] - height * part as f32 / 6.0], 0.3)));
    });
    for point in tile.scatter(&mut dice, 3.1, &joints, 1.4) {
        let in_course = point[1] % 7.5;
        if in_course > 1.5 && in_course < 6.0 {
            tile.dot(point, 0.45);
        }
    }
    tile
}

/// 638: bricks with a clay stroke in each second one.
pub(crate) fn limestone_shaly() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(638));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, _| {
        tile.line(foot, [foot[0], foot[1] - height], LINE);
        let y = foot[1] - height * 0.5;
        tile.line([foot[0] + 4.0, y], [foot[0] + 11.0, y], THIN);
    });
    tile
}

/// The bricks of each course of [`limestone_cherty`] that hold a nodule; no two lie above each other.
pub(crate) const NODULES: [&[usize]; 10] = [&[0, 2], &[3], &[1], &[0, 2], &[3], &[2], &[0, 1], &[3], &[0, 2], &[1]];

/// 639: bricks with black nodules of chert.
pub(crate) fn limestone_cherty() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(639));
    Wall { courses: 10, bricks: 4, width: LINE }.draw(&mut tile, &mut dice, |tile, foot, height, index| {
        tile.line(foot, [foot[0], foot[1] - height], LINE);
        if NODULES[index / 4].contains(&(index % 4)) {
            tile.filled_ellipse([foot[0] + 7.5, foot[1] - height * 0.5], [3.0, 1.25]);
        }
    });
    tile
}

/// 626: soft chalk: fragments of bedding planes and joints with much white between.
pub(crate) fn chalk() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(626));
    for course in 0..10 {
        let y = course as f32 * 6.0 + 3.0;
        let shift = [0.0, 9.0, 4.0, 13.0, 6.5][course % 5] + dice.jitter(0.6);
        for part in 0..3 {
            let x = part as f32 * 20.0 + shift;
            let length = dice.between(10.5, 13.0);
            tile.line([x, y], [x + length, y], THIN);
            let joint = x + length * dice.between(0.4, 0.6);
            let up = if (course + part) % 2 == 0 { -3.4 } else { 3.4 };
            tile.line([joint, y], [joint, y + up], THIN);
        }
    }
    tile
}

/// 649: beds of chert, swelling and pinching.
pub(crate) fn chert() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(649));
    for course in 0..10 {
        let y = course as f32 * 6.0 + 3.0;
        for body in 0..4 {
            let x = (body as f32 + 0.5 * (course % 2) as f32) * 15.0 + dice.jitter(0.5);
            let half = dice.between(6.4, 7.1);
            let rise = dice.between(2.1, 2.45);
            tile.blob(&nodule([x, y], [half, rise]), LINE);
        }
    }
    tile
}

/// 658: black, except for thin partings and cleats.
pub(crate) fn coal() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(658));
    let tops = [0.0, 6.5, 9.5, 17.0, 21.0, 30.0, 33.5, 41.0, 48.5, 52.0, 60.0];
    for band in tops.windows(2) {
        let count = 3;
        let shift = dice.between(0.0, 20.0);
        let cleats: Vec<(f32, f32)> =
            (0..count).map(|cleat| (cleat as f32 * 20.0 + shift + dice.jitter(5.0), dice.jitter(1.1))).collect();
        for (index, &(left, left_lean)) in cleats.iter().enumerate() {
            let (right, right_lean) =
                if index + 1 < count { cleats[index + 1] } else { (cleats[0].0 + 60.0, cleats[0].1) };
            let (high, low) = (band[0] + 0.2, band[1] - 0.2);
            let wave = [dice.jitter(0.15), dice.jitter(0.15)];
            let third = (right - left) / 3.0;
            tile.filled_polygon(&[
                [left + 0.2, high],
                [left + third, high + wave[0]],
                [right - third, high + wave[1]],
                [right - 0.2, high],
                [right - 0.2 + right_lean, low],
                [right - third, low + wave[1]],
                [left + third, low + wave[0]],
                [left + 0.2 + left_lean, low],
            ]);
        }
    }
    tile
}

/// 667: oblique ruling, every third line broken.
pub(crate) fn gypsum() -> Tile {
    let mut tile = Tile::new(60.0);
    for index in 0..20 {
        let x = index as f32 * 3.0;
        if index % 2 == 0 {
            tile.line([x - 2.0, -2.0], [x + 62.0, 62.0], 0.5);
        } else {
            for part in 0..4 {
                let start = part as f32 * 15.0 + (index / 2 % 3) as f32 * 5.0;
                tile.line([x + start, start], [x + start + 9.0, start + 9.0], 0.5);
            }
        }
    }
    tile
}

/// 668: upright crosses in staggered rows: the cubes of halite.
pub(crate) fn salt() -> Tile {
    let mut tile = Tile::new(60.0);
    for row in 0..10 {
        for column in 0..5 {
            let x = (column as f32 + 0.5 * (row % 2) as f32 + 0.25) * 12.0;
            let y = (row as f32 + 0.5) * 6.0;
            tile.line([x - 2.3, y], [x + 2.3, y], LINE);
            tile.line([x, y - 2.3], [x, y + 2.3], LINE);
        }
    }
    tile
}

/// 677: courses of bricks and beds of shale alternate.
pub(crate) fn limestone_shale() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(677));
    for bed in 0..4 {
        let top = bed as f32 * 15.0;
        let base = top + 7.5;
        tile.line([-2.0, top], [62.0, top], LINE);
        tile.line([-2.0, base], [62.0, base], LINE);
        for brick in 0..4 {
            let x = (brick as f32 + 0.5 * (bed % 2) as f32 + 0.25) * 15.0 + dice.jitter(0.6);
            tile.line([x, top], [x, base], LINE);
        }
        for row in 0..2 {
            let y = base + 2.5 + row as f32 * 2.5;
            let shift = row as f32 * 5.0 + bed as f32 * 2.3 + dice.jitter(0.5);
            for column in 0..6 {
                let x = column as f32 * 10.0 + shift;
                tile.line([x, y], [x + 6.8, y], THIN);
            }
        }
    }
    tile
}

/// Water: a few long ripples.
pub(crate) fn water() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(11));
    for row in 0..8 {
        let y = row as f32 * 7.5 + 3.75;
        let shift = [0.0, 17.0, 8.0, 25.0][row % 4] + dice.jitter(1.5);
        for part in 0..2 {
            let length = dice.between(15.0, 21.0);
            let start = part as f32 * 30.0 + shift;
            let points: Vec<Point> = (0..=24)
                .map(|step| {
                    let along = step as f32 / 24.0;
                    let fade = (std::f32::consts::PI * along).sin().max(0.0).sqrt();
                    [start + along * length, y + 0.8 * fade * (std::f32::consts::TAU * along * length / 7.0).sin()]
                })
                .collect();
            tile.curve(&points, 0.5);
        }
    }
    tile
}

/// 657: peat: leaning strokes all over, with short flat ones and lumps of wood.
pub(crate) fn peat() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(657));
    for n in 0..15 {
        let x = 4.0 * n as f32;
        tile.line([x, 60.0], [x + 60.0, 0.0], 0.4);
    }
    let lumps: Vec<Point> = tile.scatter(&mut dice, 10.0, &[], 0.0);
    for &centre in &lumps {
        let radius = dice.between(2.0, 3.4);
        let outline = shard(&mut dice, centre, radius);
        tile.filled_polygon(&outline);
    }
    let taken: Vec<(Point, f32)> = lumps.iter().map(|&lump| (lump, 2.6)).collect();
    for [x, y] in tile.scatter(&mut dice, 7.0, &taken, 2.0) {
        let half = dice.between(1.8, 4.2);
        tile.line([x - half, y], [x + half, y], 0.5);
    }
    tile
}
