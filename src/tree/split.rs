//! Splits primitives into parts. Input: boxes of primitives. Output: the same in another order, and parts of it that
//! become the children of a node. Planes by surface areas over bins of centres (Wald 2007); where these would make the
//! tree too deep, halves of equal counts.

use glam::Vec3A;
use rayon::prelude::*;

use super::{Child, Growing, WIDEST};

/// Below so many primitives half the bins do: more would cost time and gain nothing.
const FEW: usize = 64;
/// More primitives than this are looked at by several threads, in runs of this many.
const RUN: usize = 1 << 14;

/// A box in registers.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    pub min: Vec3A,
    pub max: Vec3A,
}

impl Bounds {
    pub const NONE: Bounds = Bounds { min: Vec3A::MAX, max: Vec3A::MIN };

    fn with(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub fn of(items: &[Child]) -> Bounds {
        let of_run = |run: &[Child]| run.iter().fold(Bounds::NONE, |sum, item| sum.with(bounds(item)));
        over_runs(items, Bounds::NONE, of_run, Bounds::with)
    }

    /// Returns half the surface; in double precision, as squares of single coordinates overflow and vanish.
    fn area(&self) -> f64 {
        let [x, y, z] = (self.max.as_dvec3() - self.min.as_dvec3()).to_array();
        (x + y) * z + x * y
    }
}

/// A run of primitives that becomes a child.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub first: usize,
    pub count: usize,
    pub bounds: Bounds,
}

/// The parts of a node in the order of their primitives.
pub(super) struct Parts {
    parts: [Part; WIDEST],
    count: usize,
}

impl Parts {
    fn new() -> Parts {
        Parts { parts: [Part { first: 0, count: 0, bounds: Bounds::NONE }; WIDEST], count: 0 }
    }

    pub fn all(&self) -> &[Part] {
        &self.parts[..self.count]
    }

    fn insert(&mut self, at: usize, part: Part) {
        self.parts.copy_within(at..self.count, at + 1);
        self.parts[at] = part;
        self.count += 1;
    }
}

/// Returns at most `width` parts of at most `room` primitives each. The part with the greatest surface is split first,
/// as most rays meet it; if that leaves too many primitives in one part, the part with most primitives.
pub(super) fn parts(items: &mut [Child], bounds: Bounds, growing: Growing, room: usize) -> Parts {
    let width = growing.width;
    for by_area in [true, false] {
        let parts = split_greatest(items, bounds, growing, by_area);
        if parts.all().iter().all(|part| part.count <= room) {
            return parts;
        }
    }
    let mut parts = Parts::new();
    split_evenly(items, 0, width, &mut parts);
    parts
}

fn split_greatest(items: &mut [Child], bounds: Bounds, growing: Growing, by_area: bool) -> Parts {
    let mut parts = Parts::new();
    parts.insert(0, Part { first: 0, count: items.len(), bounds });
    while parts.count < growing.width {
        // Places that would stay empty take leaves apart.
        let Some(at) = greatest(&parts, growing.leaf, by_area).or_else(|| greatest(&parts, 1, by_area))
        else {
            break;
        };
        let Part { first, count, .. } = parts.parts[at];
        let (left, bounds) = split(&mut items[first..first + count]);
        parts.parts[at] = Part { first, count: left, bounds: bounds[0] };
        parts.insert(at + 1, Part { first: first + left, count: count - left, bounds: bounds[1] });
    }
    parts
}

/// Returns the part of more than `least` primitives with the greatest surface or the most primitives.
fn greatest(parts: &Parts, least: usize, by_area: bool) -> Option<usize> {
    let (mut best, mut best_key) = (None, (-1.0, 0));
    for (at, part) in parts.all().iter().enumerate() {
        let key = (if by_area { part.bounds.area() } else { 0.0 }, part.count);
        if part.count > least && key > best_key {
            (best, best_key) = (Some(at), key);
        }
    }
    best
}

/// Splits into runs of nearly equal counts, each half of them along the longest axis of its centres.
fn split_evenly(items: &mut [Child], first: usize, runs: usize, parts: &mut Parts) {
    if runs == 1 || items.len() <= 1 {
        parts.insert(parts.count, Part { first, count: items.len(), bounds: Bounds::of(items) });
        return;
    }
    let left_runs = runs / 2;
    // As exact as it must be: neither side takes more than its runs' share, rounded up.
    let left = (items.len() * left_runs).div_ceil(runs);
    let centres = centres(items);
    let axis = (centres.max - centres.min).max_position();
    let key = |item: &Child| (centre(bounds(item))[axis], item.reference);
    if left < items.len() {
        items.select_nth_unstable_by(left, |a, b| {
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
        });
    }
    let (low, high) = items.split_at_mut(left);
    split_evenly(low, first, left_runs, parts);
    if !high.is_empty() {
        split_evenly(high, first + left, runs - left_runs, parts);
    }
}

fn bounds(item: &Child) -> Bounds {
    Bounds { min: Vec3A::from_array(item.min), max: Vec3A::from_array(item.max) }
}

/// Returns half the centre, such that differences of two never overflow.
fn centre(item: Bounds) -> Vec3A {
    0.25 * item.min + 0.25 * item.max
}

fn centres(items: &[Child]) -> Bounds {
    let of_run = |run: &[Child]| {
        let points = run.iter().map(|item| centre(bounds(item)));
        points.fold(Bounds::NONE, |sum, at| sum.with(Bounds { min: at, max: at }))
    };
    over_runs(items, Bounds::NONE, of_run, Bounds::with)
}

/// Returns what is found of primitives; many are looked at in runs, by several threads, and the results joined.
fn over_runs<T: Copy + Send + Sync>(
    items: &[Child],
    none: T,
    of_run: impl Fn(&[Child]) -> T + Sync + Send,
    join: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    if items.len() <= RUN { of_run(items) } else { items.par_chunks(RUN).map(of_run).reduce(|| none, join) }
}

/// Reorders at least two primitives into two parts. Returns how many the first takes, and their boxes.
fn split(items: &mut [Child]) -> (usize, [Bounds; 2]) {
    let halves = |items: &[Child]| {
        let (low, high) = items.split_at(items.len() / 2);
        (low.len(), [Bounds::of(low), Bounds::of(high)])
    };
    if items.len() == 2 {
        return halves(items);
    }
    let centres = centres(items);
    if centres.min == centres.max {
        return halves(items);
    }
    if items.len() < FEW { split_binned::<8>(items, centres) } else { split_binned::<16>(items, centres) }
}

fn split_binned<const BINS: usize>(items: &mut [Child], centres: Bounds) -> (usize, [Bounds; 2]) {
    let extent = centres.max - centres.min;
    // The scale of a flat axis is infinite, its bins come out as 0 times infinity, which the cast takes to zero.
    let scale = BINS as f32 / extent;
    let none = [[Bin { bounds: Bounds::NONE, count: 0 }; BINS]; 3];
    let fill = |bins: &mut [[Bin; BINS]; 3], run: &[Child]| {
        for item in run {
            let own = bounds(item);
            let at = ((centre(own) - centres.min) * scale).to_array();
            for (bins, at) in bins.iter_mut().zip(at) {
                let bin = &mut bins[bin_of::<BINS>(at)];
                *bin = Bin { bounds: bin.bounds.with(own), count: bin.count + 1 };
            }
        }
    };
    let mut bins = none;
    if items.len() <= RUN {
        fill(&mut bins, items);
    } else {
        let of_run = |run: &[Child]| {
            let mut bins = none;
            fill(&mut bins, run);
            bins
        };
        let join = |mut one: [[Bin; BINS]; 3], other: [[Bin; BINS]; 3]| {
            one.iter_mut().flatten().zip(other.iter().flatten()).for_each(|(a, b)| *a = a.with(*b));
            one
        };
        bins = items.par_chunks(RUN).map(of_run).reduce(|| none, join);
    }
    // Of equal costs (all surfaces may vanish) the most even split, as the others would make a list of the tree.
    let mut best = (f64::INFINITY, usize::MAX);
    let (mut axis, mut plane, mut sides) = (0, 1, [Bounds::NONE; 2]);
    for at in (0..3).filter(|at| extent[*at] > 0.0) {
        let bins = &bins[at];
        let mut above = *bins;
        for bin in (1..BINS - 1).rev() {
            above[bin] = above[bin].with(above[bin + 1]);
        }
        let mut below = bins[0];
        for bin in 1..BINS {
            let rest = above[bin];
            // Behind an empty bin the parts are those of the plane before it.
            if bins[bin - 1].count > 0 && rest.count > 0 {
                let cost = below.count as f64 * below.bounds.area() + rest.count as f64 * rest.bounds.area();
                let key = (cost, below.count.abs_diff(rest.count));
                if key < best {
                    best = key;
                    (axis, plane, sides) = (at, bin, [below.bounds, rest.bounds]);
                }
            }
            below = below.with(bins[bin]);
        }
    }
    // The same operations on one axis.
    let (least, scale) = (centres.min[axis], scale[axis]);
    let is_below = |item: &Child| {
        let centre = 0.25 * item.min[axis] + 0.25 * item.max[axis];
        bin_of::<BINS>((centre - least) * scale) < plane
    };
    (partition(items, is_below), sides)
}

/// Returns the bin at a place in units of bins.
fn bin_of<const BINS: usize>(at: f32) -> usize {
    // By way of 32 bits, which takes the fewest instructions.
    (at as i32).clamp(0, BINS as i32 - 1) as usize
}

/// The primitives whose centres lie in one slice of a node.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

impl Bin {
    fn with(self, other: Bin) -> Bin {
        Bin { bounds: self.bounds.with(other.bounds), count: self.count + other.count }
    }
}

/// Moves the primitives that are `first` before the others and returns how many they are; without a branch that depends
/// on them, as it could not be foreseen.
fn partition(items: &mut [Child], first: impl Fn(&Child) -> bool) -> usize {
    let mut low = 0;
    for at in 0..items.len() {
        let is_first = first(&items[at]);
        items.swap(low, at);
        low += usize::from(is_first);
    }
    low
}
