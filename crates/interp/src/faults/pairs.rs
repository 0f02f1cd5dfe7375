//! Pairs of rims that face one another with an offset.

use super::ProposeSettings;
use super::edges::{HorizonRims, Rim};
use glam::Vec2;

/// Two rims of one horizon that face one another across a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pair {
    /// Index of the horizon.
    pub horizon: usize,
    /// The middle between them, a point on the fault, voxels.
    pub at: [f32; 3],
    /// Horizontal unit vector across the fault.
    pub across: Vec2,
    /// How much deeper the horizon is on the side that `across` points to, samples.
    pub throw: f32,
    /// Traces from the rim behind to the rim towards which `across` points, along `across`; negative where
    /// they overlap.
    pub heave: f32,
    /// Whether the horizon was tracked across the fault and only bends there.
    pub bend: bool,
}

/// Least cosine between the direction out of one rim and the reversed direction out of the other; 45° off is
/// still facing.
const FACING: f32 = 0.7;
/// Largest distance of two rims along the fault, traces.
const ALONG: f32 = 2.5;

/// The closest facing rim of each rim node, where the horizon is offset between them.
pub(super) fn facing(pieces: &HorizonRims, horizon: usize, settings: &ProposeSettings) -> Vec<Pair> {
    let [nx, ny] = pieces.size;
    // Rims by trace; a trace has several across a reverse fault.
    let mut order: Vec<u32> = (0..pieces.rims.len() as u32).collect();
    let trace = |n: u32| pieces.rims[n as usize].at[0] * ny + pieces.rims[n as usize].at[1];
    order.sort_by_key(|&n| (trace(n), n));
    let at_row = |x: usize, low: usize, high: usize| {
        let from = order.partition_point(|&n| trace(n) < x * ny + low);
        let to = order.partition_point(|&n| trace(n) <= x * ny + high);
        &order[from..to]
    };
    let reach = settings.reach;
    let mut found = Vec::new();
    for (n, rim) in pieces.rims.iter().enumerate() {
        let [x, y] = rim.at;
        let mut best: Option<(f32, &Rim)> = None;
        for i in x.saturating_sub(reach)..=(x + reach).min(nx - 1) {
            for &m in at_row(i, y.saturating_sub(reach), (y + reach).min(ny - 1)) {
                let other = &pieces.rims[m as usize];
                if m as usize == n || rim.out.dot(other.out) > -FACING {
                    continue;
                }
                let way = other.place() - rim.place();
                let across = (rim.out - other.out).normalize();
                let (off, along) = (way.dot(across), way.perp_dot(across).abs());
                let score = off.abs() + 2.0 * along;
                if off.abs() <= reach as f32 && along <= ALONG && best.is_none_or(|(least, _)| score < least) {
                    let offset = throw(rim, other);
                    // A fault is steeper than its horizons, so rims that are far apart must have a large
                    // offset.
                    if offset.abs() >= settings.min_throw {
                        best = Some((score, other));
                    }
                }
            }
        }
        if let Some((_, other)) = best {
            let across = (rim.out - other.out).normalize();
            let middle = 0.5 * (rim.place() + other.place());
            let z = 0.5 * (rim.z + other.z);
            found.push(Pair {
                horizon,
                at: [middle.x, middle.y, z],
                across,
                throw: throw(rim, other),
                heave: (other.place() - rim.place()).dot(across),
                bend: false,
            });
        }
    }
    found
}

/// How much deeper the plane of `other` is than that of `rim`, at their middle.
fn throw(rim: &Rim, other: &Rim) -> f32 {
    let middle = 0.5 * (rim.place() + other.place());
    other.z_at(middle) - rim.z_at(middle)
}
