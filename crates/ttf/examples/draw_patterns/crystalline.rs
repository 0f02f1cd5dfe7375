//! Metamorphic, volcanic and plutonic rocks (FGDC 703–730).

use crate::tile::{Dice, LINE, Point, THIN, Tile, shard, staggered};

/// 703: steep cleavage in close broken lines, crossed by faint bedding.
pub(crate) fn slate() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(703));
    // The cleavage leans 60 points to the right over 120 down: twelve lines, each two tiles long, close the
    // tile.
    for index in 0..12 {
        let x = index as f32 * 2.5;
        let mut y = dice.between(0.0, 120.0);
        let end = y + 120.0;
        let mut piece = index * 2;
        while y < end - 7.0 {
            let length = dice.between(9.0, 18.0).min(end - y - 2.0);
            let lean = |y: f32| x + y * 0.5;
            tile.line([lean(y), y], [lean(y + length), y + length], if piece % 5 == 0 { 1.0 } else { 0.5 });
            y += length + dice.between(1.8, 2.6);
            piece += 1;
        }
    }
    tile
}

/// 705: flakes of mica along the foliation, bent and feathered, every fifth one heavy.
pub(crate) fn schist() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(705));
    let mut flake = 0;
    for row in 0..22 {
        let base = (row as f32 + 0.5) * 60.0 / 22.0;
        let mut x = dice.between(0.0, 60.0);
        let end = x + 60.0;
        while x < end - 4.0 {
            let length = dice.between(5.0, 9.5).min(end - x - 1.2);
            let fold = |x: f32| 1.1 * (std::f32::consts::TAU * (x / 20.0 + base / 60.0)).sin();
            let bend = dice.jitter(0.45);
            let points: Vec<Point> = (0..=6)
                .map(|step| {
                    let along = step as f32 / 6.0;
                    let at = x + length * along;
                    [at, base + fold(at) + bend * (std::f32::consts::PI * along).sin() + (0.5 - along) * 0.9]
                })
                .collect();
            tile.curve(&points, if (flake + row) % 5 == 0 { 0.95 } else { 0.5 });
            flake += 1;
            x += length + dice.between(1.0, 1.8);
        }
    }
    tile
}

/// 708: pairs of wavy bands with flecks between them.
pub(crate) fn gneiss() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(708));
    let mut taken: Vec<(Point, f32)> = Vec::new();
    let bands = [(4.0, 3), (17.0, 2), (26.0, 4), (41.5, 2), (51.0, 3)];
    for (top, lines) in bands {
        let phases = [dice.turn(), dice.turn()];
        let wave = |x: f32| {
            let turn = std::f32::consts::TAU * x / 60.0;
            1.5 * (2.0 * turn + phases[0]).sin() + 0.7 * (3.0 * turn + phases[1]).sin()
        };
        for line in 0..lines {
            let drop = line as f32 * 1.75;
            let swell = 1.0 - 0.12 * line as f32;
            let points: Vec<Point> =
                (-3..=43).map(|step| step as f32 * 1.5).map(|x| [x, top + drop + wave(x) * swell]).collect();
            tile.curve(&points, if line == 0 { 0.9 } else { THIN });
            taken.extend(points.iter().map(|&point| (point, 0.6)));
        }
    }
    for point in tile.scatter(&mut dice, 4.0, &taken, 1.6) {
        let (sin, cos) = dice.jitter(0.45).sin_cos();
        tile.line([point[0] - 1.4 * cos, point[1] - 1.4 * sin], [point[0] + 1.4 * cos, point[1] + 1.4 * sin], THIN);
    }
    tile
}

/// 710: bundles of three curled fibres, one beside the other.
pub(crate) fn serpentinite() -> Tile {
    let mut tile = Tile::new(60.0);
    let fibres: [&[Point]; 3] = [
        &[[-0.2, -2.4], [-1.2, -1.2], [-1.0, 0.5]],
        &[[0.8, -2.3], [-0.1, -1.2], [0.3, 0.0], [0.7, 1.1], [-0.1, 2.2]],
        &[[1.1, -0.6], [1.6, 0.8], [0.9, 2.4]],
    ];
    for [x, y] in staggered(60.0, 12, 6) {
        for fibre in fibres {
            tile.curve(&fibre.iter().map(|[dx, dy]| [x + dx, y + dy]).collect::<Vec<Point>>(), 0.45);
        }
    }
    tile
}

/// 711: chips of glass: rows of forks that stand and hang in turn.
pub(crate) fn tuff() -> Tile {
    let mut tile = Tile::new(60.0);
    for (n, [x, y]) in staggered(60.0, 8, 8).enumerate() {
        let up = if n / 8 % 2 == 0 { 1.0 } else { -1.0 };
        tile.polyline(&[[x - 1.5, y - 1.9 * up], [x, y + 0.4 * up], [x + 1.5, y - 1.9 * up]], LINE);
        tile.line([x, y + 0.4 * up], [x, y + 2.1 * up], LINE);
    }
    tile
}

/// 714: blocks in a tuff.
pub(crate) fn volcanic_breccia() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(714));
    let mut radii: Vec<f32> = (0..9).map(|_| dice.between(4.0, 5.6)).collect();
    radii.extend((0..7).map(|_| dice.between(2.4, 3.2)));
    let blocks = tile.pack(&mut dice, &radii, 2.2);
    for &(centre, radius) in &blocks {
        let outline = shard(&mut dice, centre, radius);
        tile.polygon(&outline, 0.8);
    }
    for point in tile.scatter(&mut dice, 4.0, &blocks, 1.5) {
        let turn = dice.jitter(0.5);
        let arm = |angle: f32| [point[0] + 1.5 * (turn + angle).sin(), point[1] - 1.5 * (turn + angle).cos()];
        tile.polyline(&[arm(-0.65), [point[0], point[1] + 0.5], arm(0.65)], 0.5);
    }
    tile
}

/// 717: flows with columns, each flow with its own joints between uneven contacts.
pub(crate) fn basalt() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(717));
    let contacts: Vec<(f32, f32)> = [0.0, 13.0, 31.0, 44.0].iter().map(|&y| (y, dice.turn())).collect();
    let height = |(y, phase): (f32, f32), x: f32| {
        let turn = std::f32::consts::TAU * x / 60.0;
        y + 0.8 * (2.0 * turn + phase).sin() + 0.5 * (5.0 * turn + 2.0 * phase).sin()
    };
    for (index, &contact) in contacts.iter().enumerate() {
        let points: Vec<Point> = (-3..=43).map(|step| step as f32 * 1.5).map(|x| [x, height(contact, x)]).collect();
        tile.curve(&points, 0.95);
        let next = contacts.get(index + 1).copied().unwrap_or((contacts[0].0 + 60.0, contacts[0].1));
        let mut x = dice.between(0.0, 60.0);
        let end = x + 60.0;
        while x < end - 1.4 {
            let (top, base) = (height(contact, x), height(next, x));
            let reach = top + (base - top) * if dice.between(0.0, 1.0) < 0.3 { dice.between(0.35, 0.7) } else { 1.0 };
            let middle = [x + dice.jitter(0.22), (top + reach) * 0.5];
            tile.curve(&[[x, top], middle, [x + dice.jitter(0.15), reach]], 0.5);
            x += dice.between(1.9, 3.3);
        }
    }
    tile
}

/// 719: short strokes in all directions: interlocking crystals.
pub(crate) fn granite() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(719));
    for point in tile.scatter(&mut dice, 3.9, &[], 0.0) {
        let (sin, cos) = dice.between(0.0, std::f32::consts::PI).sin_cos();
        let half = dice.between(1.15, 1.6);
        tile.line([point[0] - half * cos, point[1] - half * sin], [point[0] + half * cos, point[1] + half * sin], LINE);
    }
    tile
}

/// 718: granite, second pattern: crosses turned at random among dots.
pub(crate) fn granite_crosses() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(718));
    let points = tile.scatter(&mut dice, 6.4, &[], 0.0);
    let taken: Vec<(Point, f32)> = points.iter().map(|&point| (point, 1.9)).collect();
    for point in points {
        let turn = dice.between(0.0, 1.57);
        for quarter in [turn, turn + std::f32::consts::FRAC_PI_2] {
            let (sin, cos) = quarter.sin_cos();
            tile.line([point[0] - 2.0 * cos, point[1] - 2.0 * sin], [point[0] + 2.0 * cos, point[1] + 2.0 * sin], LINE);
        }
    }
    for point in tile.scatter(&mut dice, 4.2, &taken, 1.2) {
        tile.dot(point, 0.42);
    }
    tile
}

/// 730: large crystals in a fine matrix.
pub(crate) fn porphyry() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(729));
    let crystals: Vec<(Point, f32)> =
        tile.scatter(&mut dice, 10.5, &[], 0.0).into_iter().map(|point| (point, 3.2)).collect();
    for &(point, _) in &crystals {
        let (sin, cos) = dice.between(0.0, std::f32::consts::PI).sin_cos();
        let (long, wide) = (dice.between(2.6, 3.3), dice.between(1.2, 1.7));
        let corner = |a: f32, b: f32| {
            let (x, y) = (a * long, b * wide);
            [point[0] + x * cos - y * sin, point[1] + x * sin + y * cos]
        };
        tile.polygon(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], LINE);
    }
    for point in tile.scatter(&mut dice, 3.7, &crystals, 1.4) {
        let (sin, cos) = dice.between(0.0, std::f32::consts::PI).sin_cos();
        tile.line([point[0] - 0.75 * cos, point[1] - 0.75 * sin], [point[0] + 0.75 * cos, point[1] + 0.75 * sin], 0.5);
    }
    tile
}
