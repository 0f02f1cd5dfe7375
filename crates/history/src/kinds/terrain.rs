//! The ground, carved out of what is there: `kind = "terrain"`.
//!
//! Each column of the map loses as much rock as its share of the work of water can take away, hard rock less than soft:
//!
//! ```text
//! ∫ R(z) dz = E(x, y)   from the highest rock down        E = depth (1 + hills · waves + valleys)
//! ```
//!
//! R is 1 for rock of middling hardness. Since the integral grows with depth, each column has one answer; hard beds stand
//! as scarps and ridges. The ground is kept on a lattice of its own, and is bilinear between its nodes.

use crate::context::Context;
use crate::error::HistoryError;
use crate::fields::{Fields, Within};
use crate::frame::Frame;
use crate::noise::Waves;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// What carves the ground, and the ground once it is carved.
#[derive(Debug, Clone, PartialEq)]
pub struct Terrain {
    /// How deep rock of middling hardness is taken away in the mean, m.
    pub depth_m: f64,
    hills_m: f64,
    valley_m: f64,
    valleys: f64,
    /// How much resistance counts, 0 … 1.
    resistance: f64,
    waves: Waves,
    bends: Waves,
    frame: Frame,
    size: DVec3,
    share: f64,
    ground: Option<Ground>,
}

/// Depths of the ground on a lattice over the block.
#[derive(Debug, Clone, PartialEq)]
struct Ground {
    count: [usize; 2],
    step: DVec2,
    depths: Vec<f64>,
}

impl Ground {
    fn depth_at(&self, map: DVec2) -> f64 {
        let at =
            (map / self.step).clamp(DVec2::ZERO, DVec2::new(self.count[0] as f64 - 1.0, self.count[1] as f64 - 1.0));
        let index = |value: f64, count: usize| (value as usize).min(count - 2);
        let (x, y) = (index(at.x, self.count[0]), index(at.y, self.count[1]));
        let (u, v) = (at.x - x as f64, at.y - y as f64);
        let node = |x: usize, y: usize| self.depths[x * self.count[1] + y];
        let low = node(x, y) + (node(x, y + 1) - node(x, y)) * v;
        low + (node(x + 1, y) + (node(x + 1, y + 1) - node(x + 1, y)) * v - low) * u
    }
}

impl Terrain {
    pub(crate) fn read(fields: &Fields<'_>, context: &Context<'_>) -> Result<Self, HistoryError> {
        let depth_m = fields.number("depth", Within::NotNegative, "how deep rock is worn away in the mean, in m")?;
        let hills_m = fields.or("hills", Within::NotNegative, 0.4 * depth_m)?;
        let valley_m = fields.or("valleys", Within::NotNegative, 0.0)?;
        let spacing = fields.or("spacing", Within::Positive, 0.5 * context.longest())?;
        let direction = fields.or("direction", Within::Between(-360.0, 360.0), 0.0)?;
        let resistance = fields.or("resistance", Within::Between(0.0, 1.0), 0.6)?;
        let seed = fields.count("seed", 1_000_000, 1)? as u64;
        Ok(Self {
            depth_m,
            hills_m,
            valley_m,
            valleys: spacing,
            resistance,
            waves: Waves::new(seed, 0.5 * context.longest()),
            bends: Waves::new(seed.wrapping_add(77), 0.4 * context.longest()),
            frame: Frame::new(context.centre(), direction),
            size: context.size,
            share: 1.0,
            ground: None,
        })
    }

    pub(crate) fn progressed(&self, share: f64) -> Self {
        Self { share, ground: None, ..self.clone() }
    }

    /// How much rock of middling hardness a column loses, m.
    fn work(&self, map: DVec2) -> f64 {
        let local = self.frame.local(map.extend(0.0));
        let across = local.x + 0.25 * self.valleys * self.bends.at(map);
        // Valleys are narrow, and the land between them broad.
        let valley = (0.5 + 0.5 * (TAU * across / self.valleys).cos()).powi(6);
        (self.share * (self.depth_m - self.hills_m * self.waves.at(map) + self.valley_m * valley)).max(0.0)
    }

    /// Carves the ground on a lattice of so many nodes along the longer edge; `rock_at` gives the hardness of rock at a
    /// place, 1 for middling, and none for air.
    pub(crate) fn carved(&self, nodes: usize, rock_at: impl Fn(DVec3) -> Option<f64> + Sync) -> Self {
        use rayon::prelude::*;
        let longest = self.size.x.max(self.size.y);
        let nodes = |edge: f64| ((nodes as f64 - 1.0) * edge / longest).round().max(8.0) as usize + 1;
        let count = [nodes(self.size.x), nodes(self.size.y)];
        let step = self.size.truncate() / DVec2::new(count[0] as f64 - 1.0, count[1] as f64 - 1.0);
        let depth = |n: usize| {
            let map = DVec2::new((n / count[1]) as f64, (n % count[1]) as f64) * step;
            self.column(map, &rock_at)
        };
        let depths = (0..count[0] * count[1]).into_par_iter().map(depth).collect();
        Self { ground: Some(Ground { count, step, depths }), ..self.clone() }
    }

    /// Depth of the ground in a column: rock is taken away from the top down until the work is done.
    fn column(&self, map: DVec2, rock_at: &impl Fn(DVec3) -> Option<f64>) -> f64 {
        const STEPS: usize = 150;
        let step = self.size.z / STEPS as f64;
        let at = |z: f64| rock_at(map.extend(z));
        let cost = |hardness: Option<f64>| hardness.map_or(0.0, |hardness| hardness.powf(self.resistance));
        let mut left = self.work(map);
        let (mut top, mut rock) = (0.0, at(0.0));
        for n in 1..=STEPS {
            let end = n as f64 * step;
            let below = at(end);
            // Where the rock changes within the step, its boundary.
            let (mut low, mut high) = (top, end);
            while rock != below && high - low > 1e-3 {
                let middle = 0.5 * (low + high);
                if at(middle) == rock { low = middle } else { high = middle }
            }
            for (rock, from, to) in [(rock, top, high), (below, high, end)] {
                let rate = cost(rock);
                if rate > 0.0 && rate * (to - from) >= left {
                    return from + left / rate;
                }
                left -= rate * (to - from);
            }
            (top, rock) = (end, below);
        }
        self.size.z
    }

    /// Whether rock at a place is gone.
    pub(crate) fn takes(&self, p: DVec3) -> bool {
        self.ground.as_ref().is_some_and(|ground| p.z < ground.depth_at(p.truncate()))
    }
}
