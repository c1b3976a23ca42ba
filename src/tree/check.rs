//! Checks trees. Input: a tree and the boxes it was built over. Output: the first thing that is wrong with it, in words.
//! Nothing is taken from the builder but the layout.

use glam::Vec3;

use super::{Child, LEAF, Tree, levels};

/// Checks that each primitive is in exactly one leaf, that each node is reached once, that boxes contain all that is
/// below them, and that the depth is as stated and fits the stack of a traversal.
pub fn check(tree: &Tree, boxes: &[[Vec3; 2]]) -> Result<(), String> {
    let Tree { children, order, width, depth } = tree;
    if order.len() != boxes.len() {
        return Err(format!("{} places for {} primitives", order.len(), boxes.len()));
    }
    if children.is_empty() || children.len() % width != 0 {
        return Err(format!("{} children are no whole nodes of {width}", children.len()));
    }
    let mut walk = Walk {
        tree,
        boxes,
        is_placed: vec![false; boxes.len()],
        is_reached: vec![false; children.len() / width],
        pending: vec![(0, 1)],
        deepest: 0,
    };
    walk.is_reached[0] = true;
    while let Some((first, level)) = walk.pending.pop() {
        walk.node(first, level)?;
    }
    if let Some(place) = walk.is_placed.iter().position(|is_placed| !is_placed) {
        return Err(format!("place {place} is in no leaf"));
    }
    if let Some(node) = walk.is_reached.iter().position(|is_reached| !is_reached) {
        return Err(format!("node {node} is not reached"));
    }
    let mut is_seen = vec![false; boxes.len()];
    for index in order {
        match is_seen.get_mut(*index as usize) {
            Some(is_seen) if !*is_seen => *is_seen = true,
            _ => return Err(format!("primitive {index} has two places or does not exist")),
        }
    }
    if *depth != walk.deepest || *depth > levels(*width) {
        return Err(format!("depth {} instead of {depth}, at most {}", walk.deepest, levels(*width)));
    }
    Ok(())
}

struct Walk<'a> {
    tree: &'a Tree,
    boxes: &'a [[Vec3; 2]],
    is_placed: Vec<bool>,
    is_reached: Vec<bool>,
    pending: Vec<(usize, u32)>,
    deepest: u32,
}

impl Walk<'_> {
    fn node(&mut self, first: usize, level: u32) -> Result<(), String> {
        self.deepest = self.deepest.max(level);
        let node = &self.tree.children[first..first + self.tree.width];
        let used = node.iter().take_while(|child| child.is_used()).count();
        if node[used..].iter().any(|child| *child != Child::UNUSED) {
            return Err(format!("node at {first} has a gap"));
        }
        for (slot, child) in node[..used].iter().enumerate() {
            let what = format!("child {}", first + slot);
            if child.count > 0 { self.leaf(child, &what)? } else { self.inner(child, &what, level)? }
        }
        Ok(())
    }

    fn leaf(&mut self, child: &Child, what: &str) -> Result<(), String> {
        if child.count as usize > LEAF {
            return Err(format!("{what} has {} primitives", child.count));
        }
        let first = child.reference as usize;
        for place in first..first + child.count as usize {
            match self.is_placed.get_mut(place) {
                Some(is_placed) if !*is_placed => *is_placed = true,
                _ => return Err(format!("{what} has place {place}, which is taken or does not exist")),
            }
            let index = self.tree.order[place] as usize;
            let Some([min, max]) = self.boxes.get(index) else {
                return Err(format!("place {place} has primitive {index}, which does not exist"));
            };
            if !contains(child, min.to_array(), max.to_array()) {
                return Err(format!("{what} does not contain primitive {index}"));
            }
        }
        Ok(())
    }

    fn inner(&mut self, child: &Child, what: &str, level: u32) -> Result<(), String> {
        let (first, width) = (child.reference as usize, self.tree.width);
        match self.is_reached.get_mut(first / width) {
            Some(is_reached) if first % width == 0 && !*is_reached => *is_reached = true,
            _ => return Err(format!("{what} refers to {first}, which is no node or has a parent already")),
        }
        self.pending.push((first, level + 1));
        let node = &self.tree.children[first..first + width];
        match node.iter().find(|below| below.is_used() && !contains(child, below.min, below.max)) {
            Some(below) => Err(format!("{what} does not contain {below:?}")),
            None if !node[0].is_used() => Err(format!("{what} is empty")),
            None => Ok(()),
        }
    }
}

/// Returns whether a child's box contains another one, false for anything that is no number.
fn contains(outer: &Child, min: [f32; 3], max: [f32; 3]) -> bool {
    (0..3).all(|axis| outer.min[axis] <= min[axis] && max[axis] <= outer.max[axis])
}
