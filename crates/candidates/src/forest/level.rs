//! Nodes at a level of the trees, by which leaves are coloured (P-horiz, figure 3).
//!
//! The *height* of a node is the largest count of steps from it down to a leaf. At level L a leaf belongs to
//! its highest ancestor of height L or less: at level 0 to itself, and above the height of the highest tree
//! every surface is one node. At every level, the nodes are disjoint and cover everything.

use super::Forest;

impl Forest {
    /// For each leaf id the number, counted from 1, of the node to which the leaf belongs at a level. The
    /// first entry stands for "no leaf" and is 0.
    pub fn nodes_at_level(&self, level: u32) -> Vec<u32> {
        let mut height = vec![0u32; self.nodes.len()];
        // Nodes stand before their children.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            if let Some(parent) = node.parent {
                height[parent as usize] = height[parent as usize].max(height[index] + 1);
            }
        }
        let node_of = |leaf: &u32| {
            let within = self.climb(*leaf).take_while(|&node| height[node as usize] <= level).last();
            within.expect("a leaf has height 0, and no level is lower") + 1
        };
        std::iter::once(0).chain(self.leaves.iter().map(node_of)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: u32 = u32::MAX;

    /// Two trees: ((a b) c) and d.
    fn forest() -> Forest {
        let nodes = vec![
            [NONE, 1, 4, 0, 0, 6],
            [0, 2, 3, 0, 0, 4],
            [1, NONE, NONE, 0, 0, 2],
            [1, NONE, NONE, 0, 2, 4],
            [0, NONE, NONE, 0, 4, 6],
            [NONE, NONE, NONE, 1, 6, 9],
        ];
        Forest::of_nodes(nodes).unwrap()
    }

    #[test]
    fn levels_widen_from_leaves_to_surfaces() {
        let forest = forest();
        assert_eq!(forest.nodes_at_level(0), [0, 3, 4, 5, 6]);
        assert_eq!(forest.nodes_at_level(1), [0, 2, 2, 5, 6]);
        assert_eq!(forest.nodes_at_level(2), [0, 1, 1, 1, 6]);
        assert_eq!(forest.nodes_at_level(9), forest.nodes_at_level(2));
    }

    #[test]
    fn rows_that_contradict_each_other_are_refused() {
        assert!(Forest::of_nodes(vec![[NONE, 1, 2, 0, 0, 6], [0, NONE, NONE, 0, 0, 2]]).is_err());
        assert!(Forest::of_nodes(vec![[NONE, NONE, NONE, 0, 1, 2]]).is_err());
    }
}
