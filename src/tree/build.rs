//! Builds wide trees. Input: boxes of primitives and how many children a node has. Output: the tree, the same bytes for
//! any number of threads. Nodes are split from the top; each may hold only as many primitives as fit below it in the
//! levels that are left.

use glam::Vec3;
use rayon::prelude::*;

use super::split::{Bounds, Part, Parts, parts};
use super::{Child, Growing, MOST, Tree, WIDEST};

/// Nodes of more primitives have the subtrees of their children built at the same time.
const AT_ONCE: usize = 1 << 14;
/// Boxes that a thread asks for at once.
const MIN_RUN: usize = 1 << 12;

/// Builds a tree over boxes, each given by its least and greatest finite coordinates.
///
/// # Panics
///
/// If `width` is not 2 to 8, or for more boxes than `MOST` or than the levels have room for.
pub fn build(boxes: &[[Vec3; 2]], growing: Growing) -> Tree {
    build_over(boxes.len(), |index| boxes[index], growing)
}

/// Builds a tree over as many boxes, which need not be in memory: each is asked for once.
///
/// # Panics
///
/// As [`build`].
pub fn build_over(count: usize, box_of: impl Fn(usize) -> [Vec3; 2] + Sync, growing: Growing) -> Tree {
    let Growing { width, leaf, levels } = growing;
    assert!((2..=WIDEST).contains(&width), "nodes have 2 to {WIDEST} children, not {width}");
    let most = MOST.min(leaf.saturating_mul(width.saturating_pow(levels)));
    assert!(count <= most, "{count} boxes are more than {most}");
    let item = |index: usize| {
        let [min, max] = box_of(index).map(|corner| corner.to_array());
        Child { min, reference: index as u32, max, count: 1 }
    };
    let mut items: Vec<Child> = (0..count).into_par_iter().with_min_len(MIN_RUN).map(item).collect();
    let mut growth = Growth { children: Vec::new(), depth: 0, growing };
    let bounds = Bounds::of(&items);
    growth.node(&mut items, bounds, 0, 1);
    let order = items.par_iter().with_min_len(MIN_RUN).map(|item| item.reference).collect();
    Tree { children: growth.children, order, width, depth: growth.depth }
}

/// A subtree while it grows.
struct Growth {
    children: Vec<Child>,
    depth: u32,
    growing: Growing,
}

impl Growth {
    /// Adds the node of primitives that begin at a place, and all nodes below it.
    fn node(&mut self, items: &mut [Child], bounds: Bounds, place: usize, level: u32) {
        let Growing { width, leaf: most, levels } = self.growing;
        let own = self.children.len();
        self.children.resize(own + width, Child::UNUSED);
        self.depth = self.depth.max(level);
        if items.is_empty() {
            return;
        }
        // What fits below a child if it is balanced. A node never has more than its parent's children have room for, and
        // so on up to the root, which has room for all.
        let below = levels - level;
        let room = most.saturating_mul(width.saturating_pow(below));
        let parts = parts(items, bounds, self.growing, room);
        let subtrees =
            if items.len() > AT_ONCE { self.subtrees(items, &parts, place, level) } else { Vec::new() };
        let mut subtrees = subtrees.into_iter();
        for (slot, part) in parts.all().iter().enumerate() {
            let leaf = part.count <= most;
            let first = place + part.first;
            self.children[own + slot] = Child {
                min: part.bounds.min.to_array(),
                reference: if leaf { first } else { self.children.len() } as u32,
                max: part.bounds.max.to_array(),
                count: if leaf { part.count as u32 } else { 0 },
            };
            match subtrees.next() {
                _ if leaf => {}
                Some(subtree) => self.append(&subtree),
                None => {
                    let items = &mut items[part.first..part.first + part.count];
                    self.node(items, part.bounds, first, level + 1);
                }
            }
        }
    }

    /// Grows the subtree of each part by itself, that of a leaf stays empty.
    fn subtrees(&self, items: &mut [Child], parts: &Parts, place: usize, level: u32) -> Vec<Growth> {
        let mut rest = items;
        let mut runs = Vec::new();
        for part in parts.all() {
            let (run, others) = rest.split_at_mut(part.count);
            runs.push((run, part));
            rest = others;
        }
        let grow = |(run, part): (&mut [Child], &Part)| {
            let mut growth = Growth { children: Vec::new(), depth: 0, growing: self.growing };
            if part.count > self.growing.leaf {
                growth.node(run, part.bounds, place + part.first, level + 1);
            }
            growth
        };
        runs.into_par_iter().map(grow).collect()
    }

    /// Appends a subtree that counted its children from zero.
    fn append(&mut self, subtree: &Growth) {
        let base = self.children.len() as u32;
        self.depth = self.depth.max(subtree.depth);
        self.children.extend(subtree.children.iter().map(|child| {
            let inner = child.count == 0 && child.is_used();
            Child { reference: if inner { child.reference + base } else { child.reference }, ..*child }
        }));
    }
}
