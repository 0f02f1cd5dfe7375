//! Sheets of surfaces with one depth at each place: one for each fault block, exact up to the block's faults and past them.
//!
//! Within a block every surface is the place where an answer of the history changes along a vertical line, taken on the
//! block's sides of all younger faults wherever the line is. So the sheet of a block does not end at its faults: it goes on
//! as the rock would, and nothing has to be extrapolated from nodes. Nodes outside of the block, and those that were worn
//! away since, are marked as extrapolated.

use super::{AT_TOP_M, FaultBlocks, Node, Surface};
use crate::kinds::Act;
use crate::place::Sides;
use crate::stage::{Known, Stage};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashMap;
use survey::{NodeGrid, Quality, Sheet};

/// Places at which the sides of blocks are asked, along each axis.
const ASKED: [usize; 3] = [48, 48, 40];
/// Halvings of a step of [`STEP`] of the block's height: less than a tenth of a millimetre.
const HALVINGS: usize = 22;
/// The first step away from where a surface is expected, as a share of the block's height.
const STEP: f64 = 1.0 / 64.0;
/// Nodes beyond each side of the block up to which sheets go: as far as a model of a lattice of [`super::CELLS`] cells
/// continues what it is given.
const BEYOND: usize = 16;
/// How far above and below the block a surface is followed, in heights of the block.
const FOLLOWED: [f64; 2] = [-0.95, 1.95];

/// The sides of the blocks of a model.
pub(super) struct BlockSides {
    /// Of each block, those that its places have, with how many there are.
    found: Vec<HashMap<Sides, usize>>,
}

impl BlockSides {
    /// Those of most places of a block, of act `from` and all later ones.
    fn since(&self, from: usize, block: usize) -> Sides {
        let mut counts: HashMap<Sides, usize> = HashMap::new();
        for (sides, count) in &self.found[block] {
            let mut younger = *sides;
            younger.0[..from].fill(0);
            *counts.entry(younger).or_default() += count;
        }
        let most = counts.into_iter().max_by_key(|(sides, count)| (*count, *sides));
        most.map_or_else(Sides::default, |(sides, _)| sides)
    }
}

/// The grid with some more nodes on each side.
fn widened(grid: &NodeGrid) -> NodeGrid {
    NodeGrid {
        origin: grid.world_at(DVec2::splat(-(BEYOND as f64))),
        count: grid.count.map(|count| count + 2 * BEYOND),
        ..*grid
    }
}

impl Stage<'_> {
    /// The sides on which the places of each block lie.
    pub(super) fn block_sides(&self, blocks: &FaultBlocks<'_>) -> BlockSides {
        let [nx, ny, nz] = ASKED;
        let size = self.history().size();
        let asked = (0..nx * ny * nz).into_par_iter().map(|n| {
            let node = DVec3::new((n / (ny * nz)) as f64, (n / nz % ny) as f64, (n % nz) as f64);
            let p = (node + 0.5) / DVec3::new(nx as f64, ny as f64, nz as f64) * size;
            (usize::from((blocks.at)(p)), self.sides_since(0, p))
        });
        let mut found = vec![HashMap::new(); blocks.count];
        for (block, sides) in asked.collect::<Vec<_>>() {
            if let Some(of_block) = found.get_mut(block) {
                *of_block.entry(sides).or_default() += 1;
            }
        }
        BlockSides { found }
    }

    /// The act before which all that lies below a surface was there; later ones move it.
    fn made(&self, surface: Surface) -> usize {
        match surface {
            Surface::Ground => 0,
            Surface::Top(unit) | Surface::CutBase(unit) | Surface::Body(unit) | Surface::Baked(unit) => {
                self.history().units()[unit].act
            }
            Surface::Base(act) => act,
        }
    }

    /// Whether a place lies below a surface, or would without later erosion, on the sides of a block.
    fn is_below(&self, surface: Surface, sides: &Sides, p: DVec3) -> bool {
        let made = self.made(surface);
        let laid = || self.before(made, sides, p);
        match (surface, &self.acts()[made]) {
            (Surface::Top(unit), Act::Beds(beds)) => {
                let (q, bed) = (laid(), self.history().units()[unit].bed.unwrap_or(0));
                q.z > beds.top_of(bed, q.truncate())
            }
            (Surface::CutBase(unit), Act::Beds(beds)) => {
                let (q, bed) = (laid(), self.history().units()[unit].bed.unwrap_or(0));
                q.z > beds.top_of(bed, q.truncate()) + beds.beds[bed].thickness_at(q.truncate())
            }
            (Surface::Base(act), _) => match act.checked_sub(1) {
                Some(older) => self.is_rock_after(older, laid(), &Known { sides: *sides, from: 0 }),
                None => false,
            },
            _ => self.is_rock_after(self.acts().len() - 1, p, &Known { sides: *sides, from: 0 }),
        }
    }

    /// The depth of a surface on a vertical line, nearest to where it is expected.
    fn depth_of(&self, surface: Surface, sides: &Sides, map: DVec2, expected: f64) -> Option<f64> {
        let height = self.history().size().z;
        let is_below = |z: f64| self.is_below(surface, sides, map.extend(z));
        let [highest, deepest] = FOLLOWED.map(|share| share * height);
        let from = expected.clamp(highest, deepest);
        let starts_below = is_below(from);
        let (mut near, mut step) = (from, if starts_below { -STEP } else { STEP } * height);
        let mut far = loop {
            let next = (near + step).clamp(highest, deepest);
            if next == near {
                return None;
            }
            if is_below(next) != starts_below {
                break next;
            }
            (near, step) = (next, 1.5 * step);
        };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if is_below(middle) == starts_below { near = middle } else { far = middle }
        }
        // To a millimetre: what is level is exactly so in all blocks, and lies on the block's top if it is meant to.
        Some((500.0 * (near + far)).round() / 1000.0)
    }

    /// The sheets of surfaces, `[surface][block]`; `columns` have what vertical lines of the grid met.
    pub(super) fn sheets(
        &self,
        surfaces: &[Surface],
        grid: &NodeGrid,
        columns: &[Vec<Node>],
        blocks: &FaultBlocks<'_>,
    ) -> Vec<Vec<Sheet>> {
        let known = self.block_sides(blocks);
        let of_block = |block: usize| -> Vec<Sheet> {
            let mut made: Vec<Sheet> = Vec::new();
            for &surface in surfaces {
                // Of tops only what divides their own bed counts; the ground is what all faults made of it.
                let since = match surface {
                    Surface::Base(_) | Surface::Ground => 0,
                    _ => self.made(surface) + 1,
                };
                let mut sheet = self.sheet(surface, block, &known.since(since, block), grid, columns);
                sheet.block = (blocks.count > 1).then_some(block as u16);
                // Where two surfaces are one, they have the same nodes.
                for (n, depth) in sheet.depth.iter_mut().enumerate() {
                    let same = |other: &f32| (other - *depth).abs() < AT_TOP_M as f32;
                    *depth = made.iter().map(|sheet| sheet.depth[n]).find(same).unwrap_or(*depth);
                }
                made.push(sheet);
            }
            made
        };
        let made: Vec<Vec<Sheet>> = (0..blocks.count).into_par_iter().map(of_block).collect();
        let mut sheets = vec![Vec::new(); surfaces.len()];
        for (surface, sheet) in made.into_iter().flat_map(|of_block| of_block.into_iter().enumerate()) {
            sheets[surface].push(sheet);
        }
        sheets
    }

    fn sheet(&self, surface: Surface, block: usize, sides: &Sides, grid: &NodeGrid, columns: &[Vec<Node>]) -> Sheet {
        let (wide, [_, inner]) = (widened(grid), grid.count);
        let [nu, nv] = wide.count;
        let mut depths = vec![f64::NAN; nu * nv];
        let mut quality = vec![Quality::Extrapolated; nu * nv];
        // What the vertical line through a node met, if it lies over the block.
        let column = |u: usize, v: usize| {
            let (u, v) = (u.checked_sub(BEYOND)?, v.checked_sub(BEYOND)?);
            if v < inner { columns.get(u * inner + v) } else { None }
        };
        let mut of_row = 0.5 * self.history().size().z;
        for u in 0..nu {
            let mut expected = of_row;
            for v in 0..nv {
                let n = u * nv + v;
                let nodes = column(u, v).map_or(&[][..], Vec::as_slice);
                let met = nodes.iter().find(|node| node.surface == surface && node.block == block);
                let from = met.map_or(expected, |node| node.depth);
                let map = wide.world_at(DVec2::new(u as f64, v as f64));
                let Some(depth) = self.depth_of(surface, sides, map, from) else {
                    quality[n] = Quality::Hole;
                    continue;
                };
                if met.is_some_and(|node| (node.depth - depth).abs() < AT_TOP_M) {
                    quality[n] = Quality::Picked;
                }
                (depths[n], expected) = (depth, depth);
                if v == 0 {
                    of_row = depth;
                }
            }
        }
        Sheet { block: None, grid: wide, depth: depths.into_iter().map(|depth| depth as f32).collect(), quality }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::History;

    /// A fault with a cover laid on its scarp: the sheets of both walls go on past it as if it were not there.
    #[test]
    fn sheets_go_on_past_faults_as_the_rock_of_their_block() {
        let text = "size = [2000, 1000, 1000]
            [[events]]
            kind = \"beds\"
            beds = [{ rock = \"granite\", thickness = 500, name = \"Granite\" },
                { rock = \"shale\", thickness = 300, name = \"Shale\" }]
            [[events]]
            kind = \"tilt\"
            dip = 5
            direction = 90
            [[events]]
            kind = \"fault\"
            at = [1000, 500, 0]
            throw = 200
            [[events]]
            kind = \"erosion\"
            depth = 100
            [[events]]
            kind = \"beds\"
            beds = [{ rock = \"siltstone\", thickness = 100, name = \"Fill\" }]";
        let history = History::from_toml(text).unwrap();
        let stage = history.last_stage();
        let hanging = |p: DVec3| (p.x - 1000.0) > p.z / 60f64.to_radians().tan();
        let at = |p: DVec3| u16::from(hanging(p));
        let made = stage.interpretation(&FaultBlocks { count: 2, at: &at });
        let top = made.horizons.iter().find(|horizon| horizon.name == "Top Granite").unwrap();
        assert_eq!(top.sheets.iter().map(|sheet| sheet.block).collect::<Vec<_>>(), [Some(0), Some(1)]);
        let slope = 5f64.to_radians().tan();
        let [across, along] = [5f64.to_radians().cos().recip() * 300.0, 200.0 / 60f64.to_radians().tan()];
        let mut past = 0;
        for (block, sheet) in top.sheets.iter().enumerate() {
            for (n, depth) in sheet.depth.iter().enumerate() {
                let map =
                    sheet.grid.world_at(DVec2::new((n / sheet.grid.count[1]) as f64, (n % sheet.grid.count[1]) as f64));
                let foot = across + slope * (map.x - 1000.0);
                let closed = if block == 0 { foot } else { foot - slope * along + 200.0 };
                assert!((f64::from(*depth) - closed).abs() < 1e-3, "{block} {map}: {depth} {closed}");
                past += usize::from(usize::from(at(map.extend(closed))) != block);
                // What is marked as met is in its own block.
                let is_met = sheet.quality[n] == Quality::Picked;
                assert!(!is_met || usize::from(at(map.extend(closed))) == block);
            }
        }
        assert!(past > 1000, "{past}");
    }
}
