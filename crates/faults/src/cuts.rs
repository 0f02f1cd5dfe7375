//! Cuts: surfaces on which beds end, while no throw that is looked for makes their two sides match. Faults of great throw
//! are such, and those whose two sides are of different rock.

use crate::FaultSurface;
use crate::grow::followed;
use crate::ridges::Ridge;
use crate::seeds::joined;
use crate::sheet::{Sheet, WIDTH};
use crate::sides::Sides;
use crate::throws::{likeness, offsets};
use attribute::likelihood::ROW;

/// Least likelihood of a ridge from which a cut grows, and the fewest of them.
const SEED: f32 = 0.6;
const FEWEST: usize = 60;
/// Least mean likelihood of a cut, and least share of its cells that have a ridge.
const LIKELY: f32 = 0.5;
const COVERED: f32 = 0.6;
/// Least area, traces times samples.
const AREA: f32 = 800.0;
/// Least likeness of beds beside a cut, and how much of it is lost on the cut: where beds beside match no better than those on
/// it, ridges are noise, polygons or stripes of the acquisition, whatever their likelihood.
const BEDDED: f32 = 0.3;
const LOST: f32 = 0.2;
/// Traces off a fault within which its ridges are its own.
const OFF: f32 = 3.0;

/// The cuts along ridges that belong to none of the `faults`, the largest first.
pub(crate) fn cuts(sides: Sides<'_>, ridges: &[Ridge], faults: &[FaultSurface], greatest: i32) -> Vec<FaultSurface> {
    let is_on = |sheet: &Sheet, at: [f32; 3]| {
        let [u, height] = sheet.frame.place(at);
        sheet.is_there(u, at[2]) && (sheet.height_at(u, at[2]) - height).abs() <= OFF
    };
    let mut is_free: Vec<bool> =
        ridges.iter().map(|ridge| !faults.iter().any(|fault| is_on(&fault.sheet, ridge.at))).collect();
    let strong: Vec<usize> = (0..ridges.len()).filter(|&n| is_free[n] && ridges[n].likelihood >= SEED).collect();
    let mut found = Vec::new();
    for group in joined(strong.len(), |n| &ridges[strong[n]], |_, _, _| true, FEWEST) {
        let group: Vec<usize> = group.into_iter().map(|n| strong[n]).filter(|&n| is_free[n]).collect();
        if group.len() < FEWEST {
            continue;
        }
        let Some((sheet, members)) = followed(ridges, &is_free, group) else { continue };
        members.iter().for_each(|&n| is_free[n] = false);
        let mean = members.iter().map(|&n| ridges[n].likelihood).sum::<f32>() / members.len().max(1) as f32;
        let covered = members.len() as f32 * WIDTH * ROW as f32 / sheet.area().max(1.0);
        if sheet.area() < AREA || mean < LIKELY || covered < COVERED {
            continue;
        }
        let [straight, before, after] = likeness(sides, &sheet);
        let beside = before.min(after);
        if beside >= BEDDED && beside - straight >= LOST {
            let mut offsets = offsets(sides, &sheet, greatest);
            offsets.summarize(&sheet);
            found.push(FaultSurface { sheet, offsets, evidence: 0.0 });
        }
    }
    found.sort_by(|a, b| b.sheet.area().total_cmp(&a.sheet.area()));
    found
}
