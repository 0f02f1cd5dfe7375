//! Disjoint sets whose representative is the smallest member, so that labels do not depend on the order of
//! unions.

/// Disjoint sets over 0 … n − 1.
///
/// ```
/// let mut sets = candidates::UnionFind::new(4);
/// sets.union(3, 1);
/// assert_eq!((sets.find(3), sets.find(2)), (1, 2));
/// ```
pub struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    /// Every member alone.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The smallest member of the set of `member`.
    #[inline]
    pub fn find(&mut self, member: u32) -> u32 {
        let mut at = member;
        loop {
            let up = self.parent[at as usize];
            if up == at {
                return at;
            }
            // Path halving.
            let further = self.parent[up as usize];
            self.parent[at as usize] = further;
            at = further;
        }
    }

    /// Joins two sets; the representative of the union.
    #[inline]
    pub fn union(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.find(a), self.find(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high as usize] = low;
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_member_represents() {
        let mut sets = UnionFind::new(6);
        sets.union(5, 3);
        sets.union(4, 5);
        assert_eq!((sets.find(4), sets.find(2)), (3, 2));
        sets.union(4, 1);
        assert_eq!(sets.find(3), 1);
    }
}
