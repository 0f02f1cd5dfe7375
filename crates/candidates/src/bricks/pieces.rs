//! Stages that join pieces of one surface: `pieces`, `joined` ([`crate::grow::merge`]).
//!
//! What decides is counted brick by brick: the boundary of each two pieces, and of each piece the traces that it lies on
//! and its strength, which is a sum of integers. The sums of all bricks are those of the whole survey.

use super::Bricks;
use super::patch::{Patch, Values};
use super::tiles::Halo;
use crate::error::InterpError;
use crate::grow::links::NONE;
use crate::grow::merge::{Boundary, LEAST_LINKS, Piece, Pieces, TracePair, TraceSet, summed};
use std::collections::{BTreeMap, HashMap};
use survey::Progress;

/// A piece in a brick: label, first extremum, the two halves of its strength, count of extrema, count of words of traces.
type Share = [u32; 6];

impl Bricks<'_> {
    /// Labels of a patch after both floods.
    fn labelled(&self, patch: &Patch) -> Result<Vec<u32>, InterpError> {
        self.values("label", patch)
    }

    /// Labels of a patch after pieces were joined.
    pub(crate) fn joined_labels(&self, patch: &Patch) -> Result<Vec<u32>, InterpError> {
        let mut labels = self.labelled(patch)?;
        let joined: Vec<[u32; 2]> = self.read(&self.name("joined", patch.kind), 0)?;
        for label in labels.iter_mut().filter(|label| **label != NONE) {
            if let Ok(at) = joined.binary_search_by_key(label, |pair| pair[0]) {
                *label = joined[at][1];
            }
        }
        Ok(labels)
    }

    /// The pieces of a brick, and their boundaries.
    pub(crate) fn pieces(&self, brick: usize) -> Result<(), InterpError> {
        if self.settings.grow.join_share > 1.0 {
            return Ok(());
        }
        let ny = self.size[1];
        for kind in 0..self.kinds.len() {
            let patch = self.patch(kind, brick, Halo::behind(1), Values::All)?;
            let labels = self.labelled(&patch)?;
            let mut pieces: BTreeMap<u32, (u32, Piece)> = BTreeMap::new();
            for ([x, y], v, index) in patch.own_extrema().filter(|&(_, v, _)| labels[v] != NONE) {
                let (_, piece) = pieces.entry(labels[v]).or_insert_with(|| (index, Piece::default()));
                piece.add((x * ny + y) as u32, patch.extrema.amplitude[v]);
            }
            let (mut shares, mut words): (Vec<Share>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
            for (label, (first, Piece { traces, strength: [sum, count] })) in pieces {
                let halves = [sum as u64 as u32, (sum as u64 >> 32) as u32];
                shares.push([label, first, halves[0], halves[1], count as u32, traces.words.len() as u32]);
                words.extend(traces.words.iter().map(|&(word, bits)| [word, bits as u32, (bits >> 32) as u32]));
            }
            self.write(&self.name("pieces", kind), brick, &shares)?;
            self.write(&self.name("piece-traces", kind), brick, &words)?;
            self.write(&self.name("boundaries", kind), brick, &self.boundaries(&patch, &labels)?)?;
        }
        Ok(())
    }

    /// Boundaries of pieces that end on a brick's own traces and those that begin on the next: two labels, the lesser
    /// first, links that join them, and places against it.
    fn boundaries(&self, patch: &Patch, labels: &[u32]) -> Result<Vec<[u32; 4]>, InterpError> {
        let (links, broken) = (self.links(patch)?, self.broken(patch)?);
        let evidence: Vec<[u8; 2]> = self.values("evidence", patch)?;
        let mut found = Vec::new();
        let [nx, ny, _] = patch.extrema.size;
        let places = |x: usize, y: usize| patch.extrema.on_trace(x, y);
        for ([x, y], own, _) in patch.own_traces() {
            let [x, y] = [x - patch.area.x.start, y - patch.area.y.start];
            for (axis, there) in [(0, (x + 1 < nx).then_some((x + 1, y))), (1, (y + 1 < ny).then_some((x, y + 1)))] {
                if let Some((x, y)) = there {
                    let (extrema, links, broken, evidence) =
                        (&patch.extrema, &links, broken.as_slice(), evidence.as_slice());
                    let pair = TracePair { extrema, links, broken, evidence, piece: labels, axis };
                    pair.meet(own.clone(), places(x, y), &mut found);
                }
            }
            if found.len() > 1 << 20 {
                found = summed(found);
            }
        }
        Ok(summed(found).into_iter().map(|([a, b], Boundary { joined, against })| [a, b, joined, against]).collect())
    }

    /// Joins pieces over the whole survey: the label of each piece, and that of the surface that it belongs to.
    pub(crate) fn joined(&self, progress: &Progress) -> Result<(), InterpError> {
        self.each_kind(|kind| {
            let joined = if self.settings.grow.join_share > 1.0 { Vec::new() } else { self.join(kind, progress)? };
            self.write(&self.name("joined", kind), 0, &joined)
        })
    }

    fn join(&self, kind: usize, progress: &Progress) -> Result<Vec<[u32; 2]>, InterpError> {
        let mut boundaries: BTreeMap<[u32; 2], Boundary> = BTreeMap::new();
        let mut links: HashMap<u32, u32> = HashMap::new();
        let mut first: HashMap<u32, u32> = HashMap::new();
        for brick in 0..self.tiles.count() {
            for [a, b, joined, against] in self.read::<[u32; 4]>(&self.name("boundaries", kind), brick)? {
                boundaries.entry([a, b]).or_default().add(Boundary { joined, against });
                [a, b].iter().for_each(|label| *links.entry(*label).or_default() += joined);
            }
            for [label, index, ..] in self.read::<Share>(&self.name("pieces", kind), brick)? {
                let first = first.entry(label).or_insert(index);
                *first = index.min(*first);
            }
        }
        // Pieces are numbered in the order of their first extrema.
        let mut order: Vec<[u32; 2]> = first.into_iter().map(|(label, index)| [index, label]).collect();
        order.sort_unstable();
        let number: HashMap<u32, u32> = order.iter().zip(0..).map(|(&[_, label], n)| (label, n)).collect();
        let mut pieces = vec![Piece::default(); order.len()];
        for brick in 0..self.tiles.count() {
            let words: Vec<[u32; 3]> = self.read(&self.name("piece-traces", kind), brick)?;
            let mut reached = 0;
            for [label, _, low, high, count, length] in self.read::<Share>(&self.name("pieces", kind), brick)? {
                let own = &words[reached..reached + length as usize];
                reached += length as usize;
                let piece = &mut pieces[number[&label] as usize];
                piece.strength[0] += (u64::from(low) | u64::from(high) << 32) as i64;
                piece.strength[1] += i64::from(count);
                // A piece with too few links is never joined, so its traces are not asked for.
                if links.get(&label).is_some_and(|&links| links >= LEAST_LINKS) {
                    let words = own.iter().map(|&[word, low, high]| (word, u64::from(low) | u64::from(high) << 32));
                    piece.traces = piece.traces.united(&TraceSet { words: words.collect() });
                }
            }
        }
        let mut pieces = Pieces::of_pieces(pieces);
        let pair = |[a, b]: [u32; 2]| {
            let [a, b] = [number[&a], number[&b]];
            [a.min(b), a.max(b)]
        };
        pieces.meet(boundaries.into_iter().map(|(labels, boundary)| (pair(labels), boundary)).collect());
        pieces.join_all(self.settings.grow.join_share, progress)?;
        let roots = pieces.roots();
        let mut joined: Vec<[u32; 2]> =
            order.iter().zip(&roots).map(|(&[_, label], &root)| [label, order[root as usize][1]]).collect();
        joined.retain(|[label, surface]| label != surface);
        joined.sort_unstable();
        Ok(joined)
    }
}
