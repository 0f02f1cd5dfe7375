//! The extrema of a brick and its halo, and arrays with a value for each of them.
//!
//! An extremum has two numbers: its *place* in the patch, by which the functions of [`crate::grow`] work, and its
//! *index* among all extrema of its kind in the survey, in the order of traces. Places and indices ascend together, so
//! whatever is decided by the lesser number is decided alike in any tiling. On disk a part of an array holds the values
//! of a brick's own extrema, in this order.

use super::Bricks;
use super::tiles::{Area, Halo};
use crate::error::InterpError;
use crate::extrema::Extrema;
use crate::grow::links::{BACK_X, BACK_Y, Links, NEXT_X, NEXT_Y, NONE};
use bytemuck::Pod;
use std::ops::{Index, Range};

/// The extrema of one kind in a brick and its halo.
pub(crate) struct Patch {
    /// Number of the kind among those that are followed.
    pub(crate) kind: usize,
    /// Number of the brick.
    pub(crate) brick: usize,
    /// The brick's own traces.
    pub(crate) own: Area,
    /// All traces of the patch.
    pub(crate) area: Area,
    /// The extrema, with the values that were asked for; their x and y count from the first of the area.
    pub(crate) extrema: Extrema,
    /// Index of the first extremum of each trace, `[x][y]`.
    firsts: Vec<u32>,
    offsets: Offsets,
}

/// What a stage needs of the extrema of a patch, beside how many there are on each trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Values {
    /// Nothing: labels and links are arrays of their own.
    None,
    /// z.
    Depths,
    /// z and the amplitude.
    All,
}

/// Index of the first extremum of each trace of the survey, of the inlines that a patch needs.
struct Offsets {
    /// Number of the first trace.
    from: usize,
    values: Vec<u32>,
}

impl Index<usize> for Offsets {
    type Output = u32;

    fn index(&self, trace: usize) -> &u32 {
        &self.values[trace - self.from]
    }
}

/// A link as it is stored: the number of the partner on its trace.
type Code = u16;

/// No partner.
const NO_PARTNER: Code = Code::MAX;

impl Bricks<'_> {
    /// The extrema of a brick and its halo.
    pub(crate) fn patch(&self, kind: usize, brick: usize, halo: Halo, values: Values) -> Result<Patch, InterpError> {
        let own = self.tiles.area(brick);
        let area = self.tiles.with_halo(&own, halo);
        let offsets = self.offsets(kind, &area)?;
        let ny = self.size[1];
        let (mut counts, mut firsts, mut reached) = (Vec::with_capacity(area.traces() + 1), Vec::new(), 0);
        counts.push(0);
        for x in area.x.clone() {
            for trace in x * ny + area.y.start..x * ny + area.y.end {
                firsts.push(offsets[trace]);
                reached += offsets[trace + 1] - offsets[trace];
                counts.push(reached);
            }
        }
        let size = [area.x.len(), area.y.len(), self.size[2]];
        let empty = Extrema { size, kind: self.kinds[kind], offsets: counts, z: Vec::new(), amplitude: Vec::new() };
        let mut patch = Patch { kind, brick, own, area, extrema: empty, firsts, offsets };
        if values != Values::None {
            patch.extrema.z = self.values("z", &patch)?;
        }
        if values == Values::All {
            patch.extrema.amplitude = self.values("amplitude", &patch)?;
        }
        Ok(patch)
    }

    /// The offsets of the bricks that an area meets, as far as its last inline.
    fn offsets(&self, kind: usize, area: &Area) -> Result<Offsets, InterpError> {
        let ny = self.size[1];
        let first = self.tiles.area(self.tiles.brick_of(area.x.start, area.y.start)).x.start;
        let mut values = vec![0; (area.x.end - first) * ny + 1];
        self.read_at(&self.name("offsets", kind), 0, first * ny, &mut values)?;
        Ok(Offsets { from: first * ny, values })
    }

    /// The values of an array for all extrema of a patch.
    pub(crate) fn values<T: Pod>(&self, array: &str, patch: &Patch) -> Result<Vec<T>, InterpError> {
        let (name, offsets, ny) = (self.name(array, patch.kind), &patch.offsets, self.size[1]);
        let mut values = vec![T::zeroed(); patch.extrema.len()];
        // Values before the row of each brick that is met, by brick.
        let mut before: Vec<(usize, Vec<u32>)> = Vec::new();
        let mut at = 0;
        for x in patch.area.x.clone() {
            let mut y = patch.area.y.start;
            while y < patch.area.y.end {
                let brick = self.tiles.brick_of(x, y);
                let area = self.tiles.area(brick);
                let end = area.y.end.min(patch.area.y.end);
                let (first, last) = (offsets[x * ny + y], offsets[x * ny + end]);
                if first < last {
                    let known = before.iter().position(|(known, _)| *known == brick).unwrap_or_else(|| {
                        let met = Area { x: area.x.start..area.x.end.min(patch.area.x.end), y: area.y.clone() };
                        before.push((brick, rows_before(&met, offsets, ny)));
                        before.len() - 1
                    });
                    let from = before[known].1[x - area.x.start] + first - offsets[x * ny + area.y.start];
                    let count = (last - first) as usize;
                    let out: &mut [u8] = bytemuck::cast_slice_mut(&mut values[at..at + count]);
                    let offset = u64::from(from) * size_of::<T>() as u64;
                    self.arrays.read(&name, brick, offset, out).map_err(InterpError::Arrays)?;
                    at += count;
                }
                y = end;
            }
        }
        Ok(values)
    }

    /// Stores the values of a brick's own extrema out of those of its patch.
    pub(crate) fn keep<T: Pod>(&self, array: &str, patch: &Patch, values: &[T]) -> Result<(), InterpError> {
        let mut own = Vec::with_capacity(values.len());
        patch.own_rows().for_each(|row| own.extend_from_slice(&values[row]));
        self.write(&self.name(array, patch.kind), patch.brick, &own)
    }

    /// Stores the links of a brick's own extrema to the next traces.
    pub(crate) fn keep_links(&self, patch: &Patch, links: &Links) -> Result<(), InterpError> {
        let mut codes = vec![[NO_PARTNER; 2]; patch.extrema.len()];
        let [nx, ny, _] = patch.extrema.size;
        for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
            for (axis, there) in [(x + 1, y), (x, y + 1)].into_iter().enumerate() {
                if there.0 == nx || there.1 == ny {
                    continue;
                }
                let first = patch.extrema.on_trace(there.0, there.1).start as u32;
                for v in patch.extrema.on_trace(x, y) {
                    let to = links.to[[NEXT_X, NEXT_Y][axis]][v];
                    if to != NONE {
                        codes[v][axis] = (to - first) as Code;
                    }
                }
            }
        }
        self.keep("links", patch, &codes)
    }

    /// The links of a patch, from the next traces back alone.
    pub(crate) fn links_back(&self, patch: &Patch) -> Result<Links, InterpError> {
        let mut links = self.links(patch)?;
        for next in [NEXT_X, NEXT_Y] {
            links.to[next] = Vec::new();
        }
        Ok(links)
    }

    /// The links of a patch.
    pub(crate) fn links(&self, patch: &Patch) -> Result<Links, InterpError> {
        let mut links = self.links_on(patch)?;
        for [next, back] in [[NEXT_X, BACK_X], [NEXT_Y, BACK_Y]] {
            let mut found = vec![NONE; links.to[next].len()];
            for (v, &to) in links.to[next].iter().enumerate().filter(|(_, to)| **to != NONE) {
                found[to as usize] = v as u32;
            }
            links.to[back] = found;
        }
        Ok(links)
    }

    /// The links of a patch to the next traces alone; nothing leads back.
    pub(crate) fn links_on(&self, patch: &Patch) -> Result<Links, InterpError> {
        let codes: Vec<[Code; 2]> = self.values("links", patch)?;
        let [nx, ny, _] = patch.extrema.size;
        let [mut next_x, mut next_y] = [(); 2].map(|()| vec![NONE; codes.len()]);
        for (axis, next) in [&mut next_x, &mut next_y].into_iter().enumerate() {
            let there = |x: usize, y: usize| [(x + 1, y), (x, y + 1)][axis];
            let begin = |x: usize, y: usize| (x < nx && y < ny).then(|| patch.extrema.on_trace(x, y).start as u32);
            for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
                let (x_there, y_there) = there(x, y);
                let Some(first) = begin(x_there, y_there) else { continue };
                let own = patch.extrema.on_trace(x, y);
                for (next, code) in next[own.clone()].iter_mut().zip(&codes[own]) {
                    if code[axis] != NO_PARTNER {
                        *next = first + u32::from(code[axis]);
                    }
                }
            }
        }
        Ok(Links { to: [next_x, Vec::new(), next_y, Vec::new()] })
    }
}

/// Count of values of a brick before each of its rows.
fn rows_before(area: &Area, offsets: &Offsets, ny: usize) -> Vec<u32> {
    let mut reached = 0;
    area.x
        .clone()
        .map(|x| {
            let before = reached;
            reached += offsets[x * ny + area.y.end] - offsets[x * ny + area.y.start];
            before
        })
        .collect()
}

impl Patch {
    /// The extrema, and the patch without them.
    pub(crate) fn split(self) -> (Extrema, Self) {
        let Extrema { size, kind, .. } = self.extrema;
        let empty = Extrema { size, kind, offsets: Vec::new(), z: Vec::new(), amplitude: Vec::new() };
        (self.extrema, Self { extrema: empty, ..self })
    }

    /// The patch with its extrema again.
    pub(crate) fn with(self, extrema: Extrema) -> Self {
        Self { extrema, ..self }
    }

    /// Places of the brick's own extrema, row by row.
    pub(crate) fn own_rows(&self) -> impl Iterator<Item = Range<usize>> {
        let ny = self.area.y.len();
        let [from, to] = [self.own.y.start, self.own.y.end].map(|y| y - self.area.y.start);
        let offsets = &self.extrema.offsets;
        self.own.x.clone().map(move |x| {
            let row = (x - self.area.x.start) * ny;
            offsets[row + from] as usize..offsets[row + to] as usize
        })
    }

    /// All traces: the trace `[x, y]` in the survey, its places, and the index of its first extremum.
    pub(crate) fn traces(&self) -> impl Iterator<Item = ([usize; 2], Range<usize>, u32)> {
        let ny = self.area.y.len();
        (0..self.area.traces()).map(move |n| {
            let at = [self.area.x.start + n / ny, self.area.y.start + n % ny];
            let places = self.extrema.offsets[n] as usize..self.extrema.offsets[n + 1] as usize;
            (at, places, self.firsts[n])
        })
    }

    /// The brick's own traces; see [`Patch::traces`].
    pub(crate) fn own_traces(&self) -> impl Iterator<Item = ([usize; 2], Range<usize>, u32)> {
        self.traces().filter(|([x, y], ..)| self.own.contains(*x, *y))
    }

    /// The brick's own extrema: the trace, the place and the index of each.
    pub(crate) fn own_extrema(&self) -> impl Iterator<Item = ([usize; 2], usize, u32)> {
        self.own_traces()
            .flat_map(|(at, places, first)| places.zip(first..).map(move |(place, index)| (at, place, index)))
    }

    /// The index of each extremum.
    pub(crate) fn indices(&self) -> Vec<u32> {
        self.traces().flat_map(|(_, places, first)| (first..).take(places.len())).collect()
    }

    /// Whether each extremum is the brick's own.
    pub(crate) fn is_own(&self) -> Vec<bool> {
        let mut own = vec![false; self.extrema.len()];
        self.own_rows().for_each(|row| own[row].fill(true));
        own
    }
}
