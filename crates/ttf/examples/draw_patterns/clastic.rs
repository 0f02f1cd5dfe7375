//! Gravel, breccia, sand, silt, till (FGDC 601–619, 670, 681).

use crate::tile::{DOT, Dice, LINE, Point, THIN, Tile, pebble, shard};

/// Radii in falling order, `count` of each class, with some variation.
pub(crate) fn radii(dice: &mut Dice, classes: &[(usize, f32)]) -> Vec<f32> {
    let mut radii = Vec::new();
    for &(count, radius) in classes {
        radii.extend((0..count).map(|_| radius * dice.between(0.88, 1.12)));
    }
    radii.sort_by(|a, b| b.total_cmp(a));
    radii
}

/// 601: pebbles of several sizes in a sandy matrix.
pub(crate) fn conglomerate() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(601));
    let sizes = radii(&mut dice, &[(5, 5.4), (9, 3.6), (14, 2.4), (20, 1.5)]);
    let discs = tile.pack(&mut dice, &sizes, 1.6);
    for &(centre, radius) in &discs {
        let (flat, tilt) = (dice.between(0.66, 0.85), dice.jitter(0.35));
        let outline = pebble(&mut dice, centre, radius, flat, tilt);
        tile.blob(&outline, LINE);
    }
    for point in tile.scatter(&mut dice, 3.0, &discs, 1.0) {
        tile.dot(point, DOT);
    }
    tile
}

/// 602: closely packed gravel.
pub(crate) fn gravel() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(6021));
    let sizes = radii(&mut dice, &[(16, 4.3), (30, 3.0), (50, 1.9), (90, 1.15)]);
    for (centre, radius) in tile.pack(&mut dice, &sizes, 0.55) {
        let (flat, tilt) = (dice.between(0.78, 0.95), dice.jitter(0.5));
        let outline = pebble(&mut dice, centre, radius, flat, tilt);
        tile.blob(&outline, THIN);
    }
    tile
}

/// 605: angular fragments in a fine matrix.
pub(crate) fn breccia() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(60513));
    let sizes = radii(&mut dice, &[(8, 4.9), (13, 3.3), (24, 1.9)]);
    let discs = tile.pack(&mut dice, &sizes, 0.9);
    for &(centre, radius) in &discs {
        let outline = shard(&mut dice, centre, radius);
        tile.polygon(&outline, LINE);
    }
    for point in tile.scatter(&mut dice, 3.6, &discs, 0.6) {
        tile.dot(point, 0.38);
    }
    tile
}

/// 606: fragments of all sizes that nearly fit together: the cells of a power diagram, shrunk.
pub(crate) fn breccia_packed() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(606));
    let sizes = radii(&mut dice, &[(9, 4.6), (22, 2.9), (45, 1.7), (60, 1.1)]);
    let seeds = tile.pack(&mut dice, &sizes, 0.0);
    for (index, &(seed, radius)) in seeds.iter().enumerate() {
        let mut cell: Vec<Point> = vec![[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
        for (other, &(neighbour, reach)) in seeds.iter().enumerate() {
            if other != index {
                let gap = dice.between(0.3, 1.1);
                cell = nearer_part(&cell, tile.offset(seed, neighbour), radius * radius - reach * reach, gap);
            }
        }
        let corners: Vec<Point> = cell.iter().map(|corner| [corner[0] + seed[0], corner[1] + seed[1]]).collect();
        let outline = drop_short_edges(&corners, 0.7);
        if outline.len() > 2 {
            tile.polygon(&outline, LINE);
        }
    }
    tile
}

/// The part of a convex cell around the origin that belongs to the origin and not to `neighbour` in the power
/// diagram (`power` = difference of the squared radii), less `gap`.
fn nearer_part(cell: &[Point], neighbour: Point, power: f32, gap: f32) -> Vec<Point> {
    let length = neighbour[0].hypot(neighbour[1]);
    let limit = (length * length + power) * 0.5 - gap * length;
    let inside = |point: Point| limit - (point[0] * neighbour[0] + point[1] * neighbour[1]);
    let mut kept = Vec::new();
    for (index, &from) in cell.iter().enumerate() {
        let to = cell[(index + 1) % cell.len()];
        let (a, b) = (inside(from), inside(to));
        if a >= 0.0 {
            kept.push(from);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            let share = a / (a - b);
            kept.push([from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share]);
        }
    }
    kept
}

fn drop_short_edges(corners: &[Point], shortest: f32) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for &corner in corners {
        if kept.last().is_none_or(|last| (corner[0] - last[0]).hypot(corner[1] - last[1]) >= shortest) {
            kept.push(corner);
        }
    }
    kept
}

/// 607: even stipple.
pub(crate) fn sand() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(607));
    for point in tile.scatter(&mut dice, 2.55, &[], 0.0) {
        tile.dot(point, DOT);
    }
    tile
}

/// Dots in a row, placed irregularly as by hand.
pub(crate) fn dotted_row(tile: &mut Tile, dice: &mut Dice, y: f32, count: usize, height: impl Fn(f32) -> f32) {
    let step = tile.side / count as f32;
    let start = dice.between(0.0, step);
    for index in 0..count {
        let x = start + index as f32 * step + dice.jitter(step * 0.12);
        tile.dot([x, y + height(x) + dice.jitter(0.12)], DOT);
    }
}

/// 608: stipple between close rows of dots, the bedding planes.
pub(crate) fn sandstone_bedded() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(608));
    let beds = [4.0, 12.5, 19.0, 29.0, 36.5, 47.0, 53.0];
    let mut row = Vec::new();
    for y in beds {
        dotted_row(&mut tile, &mut dice, y, 40, |_| 0.0);
        row.extend((0..60).map(|x| ([x as f32, y], 0.4)));
    }
    for point in tile.scatter(&mut dice, 3.1, &row, 1.5) {
        tile.dot(point, DOT);
    }
    tile
}

/// 610: planar sets, with foresets of dots that flatten towards the base of their set.
pub(crate) fn sandstone_crossbedded_planar() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(610));
    let bases = [(15.0, 15.0, 1.0), (33.0, 18.0, -1.0), (46.0, 13.0, 1.0), (60.0, 14.0, -1.0)];
    for (base, height, sense) in bases {
        tile.line([-2.0, base], [62.0, base], 0.5);
        let count = 10;
        for foreset in 0..count {
            let foot = foreset as f32 * 60.0 / count as f32 + dice.jitter(0.25);
            // Tangential: x grows with the square root of the height above the base.
            let length = 17.0;
            let mut along = 0.12_f32;
            while along < 1.0 {
                let lift = along * along * height;
                if lift > 1.1 && lift < height - 1.1 {
                    tile.dot([foot + sense * along * length, base - lift], DOT);
                }
                let slope = 2.0 * along * height / length;
                along += 1.75 / (length * (1.0 + slope * slope).sqrt());
            }
        }
    }
    tile
}

/// 611: rows of dots over ripples, each ripple steep on one side.
pub(crate) fn sandstone_rippled() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(611));
    for row in 0..13 {
        let y = (row as f32 + 0.5) * 60.0 / 13.0;
        let shift = row as f32 * 4.2 + dice.jitter(0.8);
        dotted_row(&mut tile, &mut dice, y, 36, |x| ripple((x + shift) / 12.0) * 1.05);
    }
    tile
}

/// A ripple of unit length: a gentle rise and a steeper fall, mean 0, size about 1.
pub(crate) fn ripple(x: f32) -> f32 {
    let angle = std::f32::consts::TAU * x;
    angle.sin() + 0.28 * (2.0 * angle).sin()
}

/// 612: stipple with short strokes of clay.
pub(crate) fn sandstone_shaly() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(612));
    let mut taken: Vec<(Point, f32)> = Vec::new();
    for row in 0..10 {
        let y = row as f32 * 6.0 + 3.0;
        for column in 0..3 {
            let x = column as f32 * 20.0 + [0.0, 12.0, 5.0, 16.5, 9.0][row % 5] + dice.jitter(1.0);
            let half = dice.between(3.1, 4.1);
            tile.line([x - half, y], [x + half, y], LINE);
            taken.extend((-4..=4).map(|step| ([x + half * step as f32 / 4.0, y], 0.3)));
        }
    }
    for point in tile.scatter(&mut dice, 3.0, &taken, 1.3) {
        tile.dot(point, DOT);
    }
    tile
}

/// 616: rows of a dash and three dots, staggered.
pub(crate) fn siltstone() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(616));
    for row in 0..15 {
        let y = row as f32 * 4.0 + 2.0;
        let shift = [0.0, 8.0, 3.5, 11.5, 6.0][row % 5] + dice.jitter(0.4);
        for column in 0..4 {
            let x = column as f32 * 15.0 + shift;
            tile.line([x, y], [x + 6.4, y], THIN);
            for dot in 0..3 {
                tile.dot([x + 8.6 + dot as f32 * 2.1, y], 0.42);
            }
        }
    }
    tile
}

/// Beds of stipple over beds of rows. `element` draws at the places of a row, which are shifted from row to row and from
/// bed to bed.
pub(crate) fn beds_under_stipple(seed: u64, columns: usize, mut element: impl FnMut(&mut Tile, Point)) -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(seed));
    let step = 60.0 / columns as f32;
    for bed in 0..3 {
        let top = bed as f32 * 20.0;
        tile.line([-1.0, top], [61.0, top], 0.5);
        tile.line([-1.0, top + 10.5], [61.0, top + 10.5], 0.5);
        for row in 0..3 {
            let y = top + 12.9 + row as f32 * 2.4;
            let shift = (row % 2) as f32 * 0.5 * step + bed as f32 * 0.2 * step + dice.jitter(0.6);
            (0..columns).for_each(|column| element(&mut tile, [column as f32 * step + shift, y]));
        }
    }
    let rows: Vec<(Point, f32)> = (0..3)
        .flat_map(|bed| (0..30).map(move |x| ([x as f32 * 2.0 + 1.0, bed as f32 * 20.0 + 15.25], 4.75)))
        .collect();
    for point in tile.scatter(&mut dice, 2.75, &rows, 1.1) {
        if (1.1..9.4).contains(&(point[1] % 20.0)) {
            tile.dot(point, DOT);
        }
    }
    tile
}

/// 670: beds of stipple and beds of shale alternate.
pub(crate) fn sandstone_shale() -> Tile {
    beds_under_stipple(670, 6, |tile, [x, y]| tile.line([x, y], [x + 7.0, y], THIN))
}

/// 681: stones of all sizes and short strokes, unsorted, in a dotted matrix.
pub(crate) fn till() -> Tile {
    let (mut tile, mut dice) = (Tile::new(60.0), Dice::new(681));
    let sizes = radii(&mut dice, &[(4, 3.9), (8, 2.5), (12, 1.35)]);
    let mut taken = tile.pack(&mut dice, &sizes, 3.4);
    for (index, &(centre, radius)) in taken.iter().enumerate() {
        let tilt = dice.jitter(1.5);
        let outline = if index % 3 == 1 {
            shard(&mut dice, centre, radius)
        } else {
            pebble(&mut dice, centre, radius, 0.7, tilt)
        };
        if index % 3 == 1 { tile.polygon(&outline, LINE) } else { tile.blob(&outline, LINE) }
    }
    for point in tile.scatter(&mut dice, 5.8, &taken, 2.6) {
        let (sin, cos) = dice.jitter(0.55).sin_cos();
        let half = dice.between(1.4, 2.2);
        tile.line([point[0] - half * cos, point[1] - half * sin], [point[0] + half * cos, point[1] + half * sin], THIN);
        taken.push((point, 1.8));
    }
    for point in tile.scatter(&mut dice, 3.2, &taken, 1.0) {
        tile.dot(point, 0.4);
    }
    tile
}
