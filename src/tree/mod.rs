//! Acceleration trees. Input: the boxes of primitives. Output: a wide tree as devices read it, and the order of
//! primitives in its leaves. Top-down by binned surface areas (Wald 2007, "On fast
//! Construction of SAH-based Bounding Volume Hierarchies"), several children a node (Wald, Benthin, Boulos 2008,
//! "Getting Rid of Packets"). The depth is bounded, so that a fixed stack never overflows.

mod build;
mod check;
mod split;

#[cfg(test)]
mod tests;

use bytemuck::{Pod, Zeroable};

use crate::schema::constants::TREE_STACK;

pub use build::{build, build_over};
pub use check::check;

/// Most primitives in a leaf.
pub const LEAF: usize = 4;

/// Most children of a node.
pub const WIDEST: usize = 8;

/// Most primitives of a tree: what the narrowest of the bounds on the depth leaves room for, 4 · 8^9.
pub const MOST: usize = 1 << 29;

/// Entries of the stack of a traversal, on the device as well.
pub const STACK: usize = TREE_STACK as usize;

/// The shape of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Growing {
    /// Children of a node.
    pub width: usize,
    /// Most primitives of a leaf.
    pub leaf: usize,
    /// Most nodes one above the other.
    pub levels: u32,
}

impl Growing {
    /// The shape of the only tree that a traversal passes.
    pub fn alone(width: usize) -> Growing {
        Growing { width, leaf: LEAF, levels: levels(width) }
    }
}

/// One child of a node, as a device reads it in two texels of four words.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Child {
    /// The least coordinates of everything below.
    pub min: [f32; 3],
    /// For an inner child the index of the first child of its node, for a leaf the place of its first primitive.
    pub reference: u32,
    /// The greatest coordinates of everything below.
    pub max: [f32; 3],
    /// Primitives of a leaf, zero for an inner child.
    pub count: u32,
}

impl Child {
    /// Fills the places of a node that are not used; they follow those that are. The box is inside out and finite: as
    /// a traversal takes the planes of entry and of exit by the signs of the direction, each ray leaves it before it
    /// enters it, and no infinity meets a zero on the way. The reference tells it apart without arithmetic.
    pub const UNUSED: Child = Child { min: [f32::MAX; 3], reference: u32::MAX, max: [f32::MIN; 3], count: 0 };

    /// Returns whether the place is used.
    pub fn is_used(&self) -> bool {
        self.reference != u32::MAX
    }
}

/// A tree whose nodes are as many contiguous children each as it is wide. The root is the node of the first ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// All nodes, each before its descendants.
    pub children: Vec<Child>,
    /// The original index of the primitive at each place of the leaves.
    pub order: Vec<u32>,
    /// Children of a node.
    pub width: usize,
    /// Nodes from the root to the farthest leaf, at most `levels(width)`.
    pub depth: u32,
}

/// Returns the most nodes that may lie one above the other, such that the stack of a traversal holds what it puts off:
/// of each node all children but the one that it enters.
pub const fn levels(width: usize) -> u32 {
    ((STACK - 1) / (width - 1)) as u32
}
