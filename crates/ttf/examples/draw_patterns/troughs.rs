//! Trough cross-bedding: scoops that cut one another, each filled parallel to its floor (FGDC 603, 609, 632, 643).

use crate::tile::{DOT, Dice, Point, THIN, Tile, pebble};

/// Side of the tiles.
const SIDE: f32 = 90.0;

/// The scoops of a tile, the youngest last.
struct Troughs {
    /// Centre of the rim, half width, depth.
    scoops: Vec<(Point, f32, f32)>,
}

impl Troughs {
    fn new(dice: &mut Dice) -> Self {
        let mut scoops: Vec<(Point, f32, f32)> = Vec::new();
        for row in 0..7 {
            for column in 0..2 {
                // Each row is shifted by 3/7 of the distance between troughs, so seven rows close the tile.
                let x = column as f32 * 45.0 + row as f32 * 135.0 / 7.0 + dice.jitter(5.0);
                let y = SIDE - (row as f32 + 0.5) * SIDE / 7.0 + dice.jitter(1.5);
                scoops.push(([x, y], dice.between(38.0, 44.5), dice.between(17.0, 21.0)));
            }
        }
        Self { scoops }
    }

    /// Height of a scoop's floor at `x`; none beside it.
    fn floor(&self, index: usize, x: f32) -> Option<f32> {
        let (centre, half, depth) = self.scoops[index];
        let mut dx = x - centre[0];
        dx -= (dx / SIDE).round() * SIDE;
        let t = dx / half;
        (t.abs() < 1.0).then(|| centre[1] + depth * (1.0 - t * t))
    }

    /// Whether a point of a scoop was removed by younger ones, which took all that lay above their floors. The stack
    /// repeats upwards: the troughs of the tile above are younger than all of this one.
    fn is_cut(&self, index: usize, point: Point, margin: f32) -> bool {
        (0..self.scoops.len()).any(|other| {
            (0..=1).filter(|lap| other + lap * self.scoops.len() > index).any(|lap| {
                let lift = lap as f32 * SIDE;
                self.floor(other, point[0]).is_some_and(|y| point[1] < y - lift + margin)
            })
        })
    }

    /// The line `lift` above a scoop's floor, as a thin stroke where it is not cut.
    fn line(&self, tile: &mut Tile, index: usize, lift: f32) {
        let (centre, half, _) = self.scoops[index];
        let mut run: Vec<Point> = Vec::new();
        for step in 0..=120 {
            let x = centre[0] - half * 0.999 + half * 1.998 * step as f32 / 120.0;
            let point = self.floor(index, x).map(|y| [x, y - lift]);
            match point.filter(|point| !self.is_cut(index, *point, 0.0) && point[1] > centre[1] - 3.0) {
                Some(point) => run.push(point),
                None => draw_run(tile, &mut run),
            }
        }
        draw_run(tile, &mut run);
    }

    /// Walks along the line `lift` above a scoop's floor from `start` beyond its left end, in steps of `step`, and
    /// calls `each` with every point that is not cut within `margin`.
    fn walk(&self, index: usize, lift: f32, start: f32, step: f32, margin: f32, mut each: impl FnMut(Point)) {
        let (centre, half, _) = self.scoops[index];
        let mut x = centre[0] - half + start;
        while x < centre[0] + half {
            let point = self.floor(index, x).map(|y| [x, y - lift]);
            if let Some(point) = point.filter(|point| !self.is_cut(index, *point, margin) && point[1] > centre[1] - 3.0)
            {
                each(point);
            }
            let slope = (x - centre[0]) / half * 1.2;
            x += step / (1.0 + slope * slope).sqrt();
        }
    }
}

fn draw_run(tile: &mut Tile, run: &mut Vec<Point>) {
    if run.len() > 3 {
        let sparse: Vec<Point> = run
            .iter()
            .copied()
            .enumerate()
            .filter(|(i, _)| i % 4 == 0 || *i == run.len() - 1)
            .map(|(_, p)| p)
            .collect();
        tile.curve(&sparse, 0.5);
    }
    run.clear();
}

/// 609: dotted foresets.
pub(crate) fn sandstone_crossbedded() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(6093));
    let troughs = Troughs::new(&mut dice);
    for index in 0..troughs.scoops.len() {
        troughs.line(&mut tile, index, 0.0);
        for layer in 1..9 {
            let start = dice.between(0.0, 1.5);
            troughs.walk(index, layer as f32 * 2.7, start, 2.1, 1.3, |point| tile.dot(point, DOT));
        }
    }
    tile
}

/// 603: foresets of grains and of pebbles in turn.
pub(crate) fn conglomerate_crossbedded() -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(6032));
    let troughs = Troughs::new(&mut dice);
    for index in 0..troughs.scoops.len() {
        troughs.line(&mut tile, index, 0.0);
        for layer in 1..8 {
            let (lift, start) = (layer as f32 * 3.0, dice.between(0.0, 2.0));
            if layer % 2 == 1 {
                troughs.walk(index, lift, start, 4.3, 1.9, |point| {
                    let (radius, tilt) = (dice.between(1.1, 1.6), dice.jitter(0.4));
                    tile.blob(&pebble(&mut dice, point, radius, 0.75, tilt), THIN);
                });
            } else {
                troughs.walk(index, lift, start, 2.1, 1.3, |point| tile.dot(point, DOT));
            }
        }
    }
    tile
}

/// Foresets as courses of bricks; `lean` is how far a joint's top lies to the right of the upright one's.
fn bricks(seed: u64, course: f32, brick: f32, lean: f32) -> Tile {
    let (mut tile, mut dice) = (Tile::new(SIDE), Dice::new(seed));
    let troughs = Troughs::new(&mut dice);
    for index in 0..troughs.scoops.len() {
        let (centre, half, depth) = troughs.scoops[index];
        for layer in 0..6 {
            let lift = layer as f32 * course;
            troughs.line(&mut tile, index, lift);
            let start = if layer % 2 == 0 { 0.0 } else { brick * 0.5 } + dice.between(0.0, brick * 0.2);
            troughs.walk(index, lift, start, brick, 0.0, |foot| {
                // The joint stands on the course: along the normal of the floor to the next one.
                let slope = -2.0 * depth * (foot[0] - centre[0]) / (half * half);
                let x = foot[0] + slope * course / (1.0 + slope * slope) + lean;
                let head = troughs.floor(index, x).map(|y| [x, y - lift - course]);
                if let Some(head) = head.filter(|head| !troughs.is_cut(index, *head, 0.0)) {
                    tile.line(foot, head, 0.5);
                }
            });
        }
    }
    tile
}

/// 632: foresets of bricks.
pub(crate) fn limestone_crossbedded() -> Tile {
    bricks(6321, 3.9, 8.0, 0.0)
}

/// 643: foresets of leaning bricks.
pub(crate) fn dolostone_crossbedded() -> Tile {
    bricks(6437, 4.6, 10.5, 2.4)
}
