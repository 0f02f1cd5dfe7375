//! A tree of boxes over triangles that finds the closest one: halved at the median along the longest side, four triangles
//! to a leaf.

use glam::DVec3;

/// Triangles in a leaf at most.
const LEAF: usize = 4;

/// A box around the triangles `start..end` of the order; its halves follow at `children` if it is no leaf.
#[derive(Debug, Clone, Copy)]
struct BoxNode {
    low: DVec3,
    high: DVec3,
    start: u32,
    end: u32,
    /// The second child; the first is the next node. 0: a leaf.
    second: u32,
}

impl BoxNode {
    fn distance_squared(&self, p: DVec3) -> f64 {
        (self.low - p).max(p - self.high).max(DVec3::ZERO).length_squared()
    }
}

/// The tree.
pub(super) struct Tree {
    nodes: Vec<BoxNode>,
    order: Vec<u32>,
}

impl Tree {
    /// The tree of triangles, at least one.
    pub(super) fn of(corners: &[[DVec3; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..corners.len() as u32).collect() };
        let middles: Vec<DVec3> = corners.iter().map(|[a, b, c]| (*a + *b + *c) / 3.0).collect();
        tree.add(corners, &middles, 0, corners.len());
        tree
    }

    fn add(&mut self, corners: &[[DVec3; 3]], middles: &[DVec3], start: usize, end: usize) {
        let of = &self.order[start..end];
        let all = of.iter().flat_map(|&n| corners[n as usize]);
        let bounds = |points: &mut dyn Iterator<Item = DVec3>| {
            points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
        };
        let (low, high) = bounds(&mut all.into_iter());
        let at = self.nodes.len();
        self.nodes.push(BoxNode { low, high, start: start as u32, end: end as u32, second: 0 });
        if end - start <= LEAF {
            return;
        }
        let (low, high) = bounds(&mut self.order[start..end].iter().map(|&n| middles[n as usize]));
        let size = high - low;
        let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
        let middle = start + (end - start) / 2;
        self.order[start..end].select_nth_unstable_by(middle - start, |&a, &b| {
            middles[a as usize][axis].total_cmp(&middles[b as usize][axis]).then(a.cmp(&b))
        });
        self.add(corners, middles, start, middle);
        self.nodes[at].second = self.nodes.len() as u32;
        self.add(corners, middles, middle, end);
    }

    /// The triangle with the least `distance_squared` from `p`, of those that are as close the lowest; `guess` is any
    /// triangle, best a close one.
    pub(super) fn closest(&self, p: DVec3, guess: usize, distance_squared: impl Fn(usize) -> f64) -> usize {
        let (mut best, mut least) = (guess, distance_squared(guess));
        let mut open = [0u32; 64];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let at = open[count] as usize;
            let node = self.nodes[at];
            if node.distance_squared(p) > least {
                continue;
            }
            if node.second == 0 {
                for &n in &self.order[node.start as usize..node.end as usize] {
                    let found = distance_squared(n as usize);
                    if found < least || (found == least && (n as usize) < best) {
                        (best, least) = (n as usize, found);
                    }
                }
                continue;
            }
            let (first, second) = (at as u32 + 1, node.second);
            let [a, b] = [first, second].map(|n| self.nodes[n as usize].distance_squared(p));
            // The nearer one is looked at first.
            let (near, far) = if a <= b { (first, second) } else { (second, first) };
            open[count] = far;
            open[count + 1] = near;
            count += 2;
        }
        best
    }

    /// Calls `found` with every triangle whose box meets the box from `low` to `high`.
    pub(super) fn within(&self, low: DVec3, high: DVec3, mut found: impl FnMut(usize)) {
        let mut open = vec![0u32];
        while let Some(at) = open.pop() {
            let node = self.nodes[at as usize];
            if node.low.cmpgt(high).any() || node.high.cmplt(low).any() {
                continue;
            }
            if node.second == 0 {
                self.order[node.start as usize..node.end as usize].iter().for_each(|&n| found(n as usize));
            } else {
                open.extend([at + 1, node.second]);
            }
        }
    }
}
