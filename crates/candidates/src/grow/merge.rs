//! Joins pieces of one surface by the evidence along their whole common boundary.
//!
//! The cuts at necks and planes leave more pieces than there are surfaces: noise breaks a surface anywhere, a
//! fault along its whole length. The boundary as a whole tells the two apart. Where a piece A ends between
//! two neighbouring traces and a piece B begins there, the place counts *for* joining them if an unbroken
//! link leads from one to the other. It counts *against* if the link is broken, or if there is none and B
//! begins within `FACING_REACH` samples. A link that was broken by a plane and itself has little evidence for
//! a break counts for neither, because planes are long and also cut reflectors that continue beside others
//! that end. Two pieces are joined when a large enough share of their boundary is for it, when they are
//! similar in amplitude, and when they do not lie over one another. A leak across a fault is a neck in a long
//! boundary along which the pieces face each other without a link.
//!
//! Pairs are joined in the order of their share (ties: more links, then lesser numbers). The boundaries of a
//! joined piece are the sums of those of its parts. The order follows from the extrema alone, so the result
//! is independent of threads, as in the rest of growing.

use super::links::{BACK_X, BACK_Y, Links, NEXT_X, NEXT_Y, NONE};
use crate::extrema::Extrema;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use survey::{Cancelled, Progress};

/// Largest difference in depth at which a piece that begins is a possible continuation of one that ends,
/// samples.
const FACING_REACH: f32 = 12.0;

/// Least count of links for joining two pieces.
pub(crate) const LEAST_LINKS: u32 = 6;

/// Traces that two joined pieces may both lie on, as a share of the smaller piece's; noise folds a rim over a
/// rim.
const TOLERATED_OVERLAP: f32 = 0.01;

/// Greatest evidence, in quarters, at which a break made by a plane is in doubt: four times what noise makes.
const DOUBTFUL: u8 = 16;

/// Greatest logarithm of the ratio of the pieces' mean amplitudes: a ratio of 1.6. A side lobe that continues
/// where a reflector ends is weaker.
const MOST_CONTRAST: f64 = 0.45;

/// The common boundary of two pieces: links for joining them, and places against it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Boundary {
    pub(crate) joined: u32,
    pub(crate) against: u32,
}

impl Boundary {
    fn share(self) -> f32 {
        self.joined as f32 / (self.joined + self.against).max(1) as f32
    }

    pub(crate) fn add(&mut self, other: Self) {
        self.joined += other.joined;
        self.against += other.against;
    }
}

/// A pair of pieces that could be joined, ordered by its share.
struct PiecePair {
    boundary: Boundary,
    pair: [u32; 2],
}

impl PiecePair {
    fn key(&self) -> (f32, u32, std::cmp::Reverse<[u32; 2]>) {
        (self.boundary.share(), self.boundary.joined, std::cmp::Reverse(self.pair))
    }
}

impl PartialEq for PiecePair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for PiecePair {}

impl PartialOrd for PiecePair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for PiecePair {
    fn cmp(&self, other: &Self) -> Ordering {
        let (a, b) = (self.key(), other.key());
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
    }
}

/// Joins labels whose boundary is for it with a share of at least `least_share`.
///
/// # Errors
/// [`Cancelled`] by the user.
pub(crate) fn merge(
    extrema: &Extrema,
    links: &Links,
    broken: &[[bool; 2]],
    evidence: &[[u8; 2]],
    labels: &mut [u32],
    least_share: f32,
    progress: &Progress,
) -> Result<(), Cancelled> {
    let mut pieces = Pieces::of(extrema, labels);
    pieces.meet(boundaries(extrema, links, broken, evidence, &pieces.piece));
    progress.check()?;
    pieces.join_all(least_share, progress)?;
    let roots = pieces.roots();
    labels.par_iter_mut().zip(&pieces.piece).for_each(|(label, piece)| {
        if *piece != NONE {
            *label = roots[*piece as usize];
        }
    });
    Ok(())
}

/// Parts of one in the fixed-point sums of [`Piece::strength`], so that sums do not depend on their order.
const PARTS: f64 = (1 << 20) as f64;

/// A piece while pieces are joined.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Piece {
    /// The traces that it lies on.
    pub(crate) traces: TraceSet,
    /// Sum of the logarithms of amplitude, in 2⁻²⁰, and their count.
    pub(crate) strength: [i64; 2],
}

impl Piece {
    /// Adds an extremum; traces are given in ascending order.
    pub(crate) fn add(&mut self, trace: u32, amplitude: f32) {
        self.strength[0] += (f64::from(amplitude.max(f32::MIN_POSITIVE).ln()) * PARTS).round() as i64;
        self.strength[1] += 1;
        self.traces.push(trace);
    }
}

/// The pieces of one kind of extremum.
#[derive(Default)]
pub(crate) struct Pieces {
    /// Piece of each extremum, or [`NONE`]; pieces are numbered in the order of their first extrema.
    piece: Vec<u32>,
    /// The piece that each piece was joined into; itself while it is separate.
    into: Vec<u32>,
    /// The pieces.
    pieces: Vec<Piece>,
    /// Boundaries of each piece, by neighbour.
    meets: Vec<HashMap<u32, Boundary>>,
}

fn root(into: &[u32], mut piece: u32) -> u32 {
    while into[piece as usize] != piece {
        piece = into[piece as usize];
    }
    piece
}

impl Pieces {
    fn of(extrema: &Extrema, labels: &[u32]) -> Self {
        let mut number = vec![NONE; labels.len()];
        let mut piece = vec![NONE; labels.len()];
        let mut pieces: Vec<Piece> = Vec::new();
        let [nx, ny, _] = extrema.size;
        for trace in 0..nx * ny {
            for v in extrema.on_trace(trace / ny, trace % ny) {
                let label = labels[v];
                if label == NONE {
                    continue;
                }
                let number = &mut number[label as usize];
                if *number == NONE {
                    *number = pieces.len() as u32;
                    pieces.push(Piece::default());
                }
                piece[v] = *number;
                pieces[*number as usize].add(trace as u32, extrema.amplitude[v]);
            }
        }
        Self { piece, ..Self::of_pieces(pieces) }
    }

    /// Pieces that are known, in the order of their first extrema, without boundaries.
    pub(crate) fn of_pieces(pieces: Vec<Piece>) -> Self {
        let into = (0..pieces.len() as u32).collect();
        let meets = vec![HashMap::new(); pieces.len()];
        Self { piece: Vec::new(), into, pieces, meets }
    }

    /// The piece that each was joined into.
    pub(crate) fn roots(&self) -> Vec<u32> {
        (0..self.into.len() as u32).map(|piece| root(&self.into, piece)).collect()
    }

    pub(crate) fn meet(&mut self, boundaries: Vec<([u32; 2], Boundary)>) {
        for ([a, b], boundary) in boundaries {
            self.meets[a as usize].entry(b).or_default().add(boundary);
            self.meets[b as usize].entry(a).or_default().add(boundary);
        }
    }

    /// Joins the pair of the greatest share as long as there is one that may be joined.
    pub(crate) fn join_all(&mut self, least_share: f32, progress: &Progress) -> Result<(), Cancelled> {
        let may = |boundary: &Boundary| boundary.joined >= LEAST_LINKS && boundary.share() >= least_share;
        let mut queue: BinaryHeap<PiecePair> = BinaryHeap::new();
        for (a, meets) in self.meets.iter().enumerate() {
            let a = a as u32;
            let later = meets.iter().filter(|&(&b, boundary)| a < b && may(boundary));
            queue.extend(later.map(|(&b, &boundary)| PiecePair { boundary, pair: [a, b] }));
        }
        while let Some(PiecePair { boundary, pair: [a, b] }) = queue.pop() {
            progress.check()?;
            // A pair that has changed since is in the queue again.
            if self.meets[a as usize].get(&b) != Some(&boundary) {
                continue;
            }
            let [few, many] = [a, b].map(|piece| &self.pieces[piece as usize].traces);
            let tolerated = (TOLERATED_OVERLAP * few.len().min(many.len()) as f32) as usize;
            if self.contrast(a, b) > MOST_CONTRAST || few.overlap(many) > tolerated {
                self.meets[a as usize].remove(&b);
                self.meets[b as usize].remove(&a);
                continue;
            }
            let (kept, gone) =
                if self.meets[a as usize].len() >= self.meets[b as usize].len() { (a, b) } else { (b, a) };
            self.join(kept, gone);
            for (&other, &boundary) in &self.meets[kept as usize] {
                if may(&boundary) {
                    queue.push(PiecePair { boundary, pair: [kept.min(other), kept.max(other)] });
                }
            }
        }
        Ok(())
    }

    /// Ratio of the mean amplitudes of two pieces, as a logarithm.
    fn contrast(&self, a: u32, b: u32) -> f64 {
        let mean = |piece: u32| {
            let [sum, count] = self.pieces[piece as usize].strength;
            sum as f64 / PARTS / count as f64
        };
        (mean(a) - mean(b)).abs()
    }

    fn join(&mut self, kept: u32, gone: u32) {
        self.into[gone as usize] = kept;
        let Piece { traces, strength: [sum, count] } = std::mem::take(&mut self.pieces[gone as usize]);
        let own = &mut self.pieces[kept as usize];
        own.strength = [own.strength[0] + sum, own.strength[1] + count];
        own.traces = own.traces.united(&traces);
        for (other, boundary) in std::mem::take(&mut self.meets[gone as usize]) {
            self.meets[other as usize].remove(&gone);
            if other != kept {
                self.meets[kept as usize].entry(other).or_default().add(boundary);
                let sum = self.meets[kept as usize][&other];
                self.meets[other as usize].insert(kept, sum);
            }
        }
    }
}

/// A set of traces: 64 traces in a row to a word, and only words that are not empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct TraceSet {
    /// Number of the word, and its bits; numbers ascend.
    pub(crate) words: Vec<(u32, u64)>,
}

impl TraceSet {
    /// Adds a trace that is not below those before it.
    fn push(&mut self, trace: u32) {
        let (word, bit) = (trace / 64, 1 << (trace % 64));
        match self.words.last_mut() {
            Some((last, bits)) if *last == word => *bits |= bit,
            _ => self.words.push((word, bit)),
        }
    }

    /// Count of traces.
    fn len(&self) -> usize {
        self.words.iter().map(|(_, bits)| bits.count_ones() as usize).sum()
    }

    /// Count of traces in both sets.
    fn overlap(&self, other: &Self) -> usize {
        let (few, mut many) = if self.words.len() <= other.words.len() {
            (&self.words, other.words.as_slice())
        } else {
            (&other.words, self.words.as_slice())
        };
        let mut count = 0;
        for (word, bits) in few {
            // It is most likely near the front: exponential search.
            let mut reach = 1;
            while reach < many.len() && many[reach].0 < *word {
                reach *= 2;
            }
            let end = (reach + 1).min(many.len());
            many = &many[many[..end].partition_point(|(other, _)| other < word)..];
            match many.first() {
                Some((other, there)) if other == word => count += (bits & there).count_ones() as usize,
                Some(_) => {}
                None => break,
            }
        }
        count
    }

    /// The union of two sets.
    pub(crate) fn united(&self, other: &Self) -> Self {
        let mut words = Vec::with_capacity(self.words.len().max(other.words.len()));
        let (mut a, mut b) = (self.words.iter().peekable(), other.words.iter().peekable());
        while let (Some(&&(x, here)), Some(&&(y, there))) = (a.peek(), b.peek()) {
            words.push((x.min(y), if x <= y { here } else { 0 } | if y <= x { there } else { 0 }));
            if x <= y {
                a.next();
            }
            if y <= x {
                b.next();
            }
        }
        words.extend(a);
        words.extend(b);
        Self { words }
    }
}

/// The boundaries of all pairs of pieces, by pair in ascending order.
fn boundaries(
    extrema: &Extrema,
    links: &Links,
    broken: &[[bool; 2]],
    evidence: &[[u8; 2]],
    piece: &[u32],
) -> Vec<([u32; 2], Boundary)> {
    let [nx, ny, _] = extrema.size;
    let mut all: Vec<([u32; 2], Boundary)> = (0..nx)
        .into_par_iter()
        .flat_map_iter(|x| {
            let mut found = Vec::new();
            for y in 0..ny {
                for (axis, there) in [(0, (x + 1 < nx).then_some((x + 1, y))), (1, (y + 1 < ny).then_some((x, y + 1)))]
                {
                    if let Some((x2, y2)) = there {
                        let place = TracePair { extrema, links, broken, evidence, piece, axis };
                        place.meet(extrema.on_trace(x, y), extrema.on_trace(x2, y2), &mut found);
                    }
                }
            }
            summed(found)
        })
        .collect();
    all.par_sort_unstable_by_key(|(pair, _)| *pair);
    summed_sorted(&all)
}

pub(crate) fn summed(mut found: Vec<([u32; 2], Boundary)>) -> Vec<([u32; 2], Boundary)> {
    found.sort_unstable_by_key(|(pair, _)| *pair);
    summed_sorted(&found)
}

fn summed_sorted(found: &[([u32; 2], Boundary)]) -> Vec<([u32; 2], Boundary)> {
    let sum = |same: &[([u32; 2], Boundary)]| {
        let mut sum = Boundary::default();
        same.iter().for_each(|(_, boundary)| sum.add(*boundary));
        (same[0].0, sum)
    };
    found.chunk_by(|a, b| a.0 == b.0).map(sum).collect()
}

/// Two neighbouring traces.
pub(crate) struct TracePair<'a> {
    pub(crate) extrema: &'a Extrema,
    pub(crate) links: &'a Links,
    pub(crate) broken: &'a [[bool; 2]],
    pub(crate) evidence: &'a [[u8; 2]],
    pub(crate) piece: &'a [u32],
    pub(crate) axis: usize,
}

impl TracePair<'_> {
    /// Adds the boundary between the pieces that end on one trace and those that begin on the next.
    pub(crate) fn meet(
        &self,
        from: std::ops::Range<usize>,
        to: std::ops::Range<usize>,
        found: &mut Vec<([u32; 2], Boundary)>,
    ) {
        let (next, back) = (&self.links.to[[NEXT_X, NEXT_Y][self.axis]], &self.links.to[[BACK_X, BACK_Y][self.axis]]);
        let Self { piece, extrema, .. } = *self;
        let goes_on = |link: u32, own: u32| link != NONE && piece[link as usize] == own;
        let mut first = to.start;
        for v in from {
            let a = piece[v];
            if a == NONE || goes_on(next[v], a) {
                continue;
            }
            let linked = next[v];
            let z = extrema.z[v];
            while first < to.end && extrema.z[first] < z - FACING_REACH {
                first += 1;
            }
            for w in first..to.end {
                if extrema.z[w] > z + FACING_REACH {
                    break;
                }
                let b = piece[w];
                if b == NONE || b == a || goes_on(back[w], b) {
                    continue;
                }
                let joined = w as u32 == linked && !self.broken[v][self.axis];
                if !joined && w as u32 == linked && self.evidence[v][self.axis] <= DOUBTFUL {
                    continue;
                }
                let boundary =
                    if joined { Boundary { joined: 1, against: 0 } } else { Boundary { joined: 0, against: 1 } };
                found.push(([a.min(b), a.max(b)], boundary));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(traces: impl IntoIterator<Item = u32>) -> TraceSet {
        let mut set = TraceSet::default();
        traces.into_iter().for_each(|trace| set.push(trace));
        set
    }

    #[test]
    fn sets_of_traces_unite_and_overlap() {
        assert_eq!(set([1, 4, 900]).united(&set([0, 4, 70])), set([0, 1, 4, 70, 900]));
        assert_eq!(set([1, 4, 900]).overlap(&set([0, 4, 900, 901])), 2);
        assert_eq!(set([1, 4, 200, 900]).overlap(&set([0, 1, 4, 900])), 3);
        assert_eq!(set([]).overlap(&set([1])), 0);
        assert_eq!(set([3, 3, 64]).len(), 2);
    }

    /// Pieces with these traces and boundaries.
    fn pieces(traces: &[std::ops::Range<u32>], amplitude: &[f32], meets: &[([u32; 2], [u32; 2])]) -> Pieces {
        let of = |(traces, amplitude): (&std::ops::Range<u32>, &f32)| {
            let mut piece = Piece::default();
            traces.clone().for_each(|trace| piece.add(trace, *amplitude));
            piece
        };
        let mut pieces = Pieces::of_pieces(traces.iter().zip(amplitude).map(of).collect());
        pieces.meet(meets.iter().map(|&(pair, [joined, against])| (pair, Boundary { joined, against })).collect());
        pieces
    }

    fn joined(mut pieces: Pieces, least_share: f32) -> Vec<u32> {
        pieces.join_all(least_share, &Progress::silent()).unwrap();
        pieces.roots()
    }

    #[test]
    fn a_boundary_for_it_joins_and_a_neck_or_a_few_links_do_not() {
        let traces = [0..100, 100..200, 200..300, 300..400];
        let meets = [([0, 1], [60, 10]), ([1, 2], [9, 90]), ([2, 3], [LEAST_LINKS - 1, 0])];
        let roots = joined(pieces(&traces, &[1.0; 4], &meets), 0.3);
        assert_eq!(roots[0], roots[1]);
        assert!(roots[1] != roots[2] && roots[2] != roots[3]);
    }

    #[test]
    fn the_sums_of_both_decide_what_is_joined_next() {
        // Neither alone would be enough: together 40 of 70.
        let traces = [0..100, 100..200, 200..300];
        let meets = [([0, 1], [50, 0]), ([0, 2], [5, 0]), ([1, 2], [35, 30])];
        let roots = joined(pieces(&traces, &[1.0; 3], &meets), 0.55);
        assert!(roots.iter().all(|&r| r == roots[0]));
    }

    #[test]
    fn what_lies_over_one_another_or_is_much_weaker_stays_apart() {
        let over = joined(pieces(&[0..100, 50..150], &[1.0; 2], &[([0, 1], [60, 0])]), 0.3);
        assert_ne!(over[0], over[1]);
        let lobe = joined(pieces(&[0..100, 100..200], &[1.0, 0.4], &[([0, 1], [60, 0])]), 0.3);
        assert_ne!(lobe[0], lobe[1]);
    }
}
