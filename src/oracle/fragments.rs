//! The shapes that a cone meets, in order of depth, and the visible part of each. Twin of `glsl/shared/fragments.glsl`.

use glam::{DVec2, DVec3};

use super::cone::{Cone, FlatDepth};
use super::coverage::{Covered, Cuts, MIN_SHARE, NOTHING};
use super::geometry::cones::{covered_by, cut_shape, depth_of, meet};
use super::geometry::hit::FAR;
use super::geometry::kinds::shape_count;
use crate::pack::PackedScene;

/// Most shapes that a cone keeps: the nearest ones.
pub const MAX_FRAGMENTS: usize = 8;
/// Planes whose depths differ by a smaller relative amount are coplanar: the first in the list is visible.
const COPLANAR: f64 = 4e-6;

/// A shape in the cone.
#[derive(Clone, Copy, Debug)]
pub struct Fragment {
    pub shape: u32,
    /// At the centroid; the least and the largest over the disc.
    pub t: f64,
    pub near: f64,
    pub far: f64,
    /// Fraction of the cone's cross-section; the part of it that nothing nearer hides; the centroid of that part.
    pub area: f64,
    pub seen: f64,
    pub center: DVec2,
}

/// The nearest fragments, in order.
#[derive(Clone, Debug)]
pub struct Pieces {
    pub list: Vec<Fragment>,
    /// The transmittance of the fragments that were not kept.
    pub clear: f64,
}

/// Returns t of a plane at the two ends of the disc between which it varies.
fn depths(cone: &Cone, depth: &FlatDepth) -> [f64; 2] {
    let tilt = depth.tilt.length();
    let [first, second] = [tilt, -tilt].map(|tilt| {
        let facing = depth.facing + tilt * cone.spread;
        if facing > 0.0 { ((depth.height - tilt * cone.width) / facing).max(0.0) } else { FAR }
    });
    [first.min(second), first.max(second)]
}

fn keep(fragments: &mut Pieces, scene: &PackedScene, cone: &Cone, shape: u32, covered: Covered, t_max: f64) {
    let Covered { share, center } = covered;
    let ray = cone.ray_at(center);
    let t = meet(scene, &ray, shape).t;
    if !(share > MIN_SHARE && t > 0.0 && t < t_max && cone.rises_to(ray.origin + t * ray.direction)) {
        return;
    }
    let [near, far] = depths(cone, &depth_of(scene, cone, shape, t, share));
    let at = fragments.list.partition_point(|p| p.t <= t);
    fragments.list.insert(at, Fragment { shape, t, near, far, area: share, seen: share, center });
    if fragments.list.len() > MAX_FRAGMENTS
        && let Some(farthest) = fragments.list.pop()
    {
        fragments.clear *= 1.0 - farthest.area;
    }
}

/// Returns the nearest shapes except `skip` that the cone meets before t_max, in order.
pub fn collect_fragments(scene: &PackedScene, cone: &Cone, skip: u32, t_max: f64) -> Pieces {
    let mut fragments = Pieces { list: Vec::new(), clear: 1.0 };
    for shape in (0..shape_count(scene)).filter(|shape| *shape != skip) {
        let covered = covered_by(scene, cone, shape);
        if covered.share > 0.0 {
            keep(&mut fragments, scene, cone, shape, covered, t_max);
        }
    }
    // Nothing behind the first fragment that covers everything is visible, unless part of it is nearer.
    let (mut far, mut count) = (FAR, 0);
    for (i, fragment) in fragments.list.iter().enumerate() {
        count = if fragment.near < far { i + 1 } else { count };
        far = if fragment.area >= 1.0 { far.min(fragment.far) } else { far };
    }
    fragments.list.truncate(count);
    fragments
}

/// Returns the overlap in which one of two fragments hides the other: a hides b, or b hides a if `turned`. Also returns
/// true if b is in front of a anywhere on the disc: because their planes intersect, or because b's centroid is behind
/// a's although b is in front where both are.
fn hidden(scene: &PackedScene, cone: &Cone, a: &Fragment, b: &Fragment, turned: bool) -> (Covered, bool) {
    let mut cuts = Cuts::default();
    let mut has_lines = |p: &Fragment| p.area >= 1.0 || cut_shape(&mut cuts, scene, cone, p.shape);
    let (a_has_lines, b_has_lines) = (has_lines(a), has_lines(b));
    if !a_has_lines || !b_has_lines {
        // The position hardly matters.
        let center = if a_has_lines { b.center } else { a.center };
        return (Covered { share: if turned { 0.0 } else { a.area * b.area }, center }, false);
    }
    let [p, q] = [a, b].map(|fragment| depth_of(scene, cone, fragment.shape, fragment.t, fragment.area));
    let tilt = (q.height * cone.spread + cone.width * q.facing) * p.tilt
        - (p.height * cone.spread + cone.width * p.facing) * q.tilt;
    let mut before = tilt.extend(q.height * p.facing - p.height * q.facing);
    if before.abs().element_sum() <= COPLANAR * (q.height * p.facing).abs() {
        before = if a.shape < b.shape { DVec3::Z } else { -DVec3::Z };
    }
    cuts.by(if turned { -before } else { before });
    (cuts.covered(), before.z < before.truncate().length())
}

fn within_disc(center: DVec2) -> DVec2 {
    center / center.length().max(1.0)
}

/// Composites the fragments: computes the visible part of each and its centroid, and returns the part that nothing
/// covers. A partly visible fragment hides others in proportion.
pub fn composite(fragments: &mut Pieces, scene: &PackedScene, cone: &Cone) -> Covered {
    let list = &mut fragments.list;
    let mut rest = 1.0 - list.first().map_or(0.0, |p| p.area);
    for i in 1..list.len() {
        let fragment = list[i];
        let (mut seen, mut moment) = (fragment.area, fragment.area * fragment.center);
        for other in &mut list[..i] {
            let (lost, turns) = hidden(scene, cone, other, &fragment, false);
            let share = lost.share * (other.seen / other.area);
            seen -= share;
            moment -= share * lost.center;
            if turns {
                let (lost, _) = hidden(scene, cone, other, &fragment, true);
                let left = (other.seen - lost.share).max(0.0);
                rest += other.seen - left;
                if left > MIN_SHARE {
                    other.center = within_disc((other.seen * other.center - lost.share * lost.center) / left);
                }
                other.seen = left;
            }
        }
        seen = seen.min(rest);
        let fragment = &mut list[i];
        if seen > MIN_SHARE {
            fragment.center = within_disc(moment / seen);
            fragment.seen = seen;
        } else {
            fragment.seen = 0.0;
        }
        rest -= fragment.seen;
    }
    // Nothing is visible through a covered place, however many fragments overlap there: the excess belongs to the
    // hidden ones.
    let most = list.iter().map(|p| p.area).fold(0.0, f64::max);
    let concealed: f64 = list.iter().map(|p| p.area - p.seen).sum();
    let excess = rest - (1.0 - most);
    if excess > MIN_SHARE && concealed > 0.0 {
        let shown = excess / concealed;
        list.iter_mut().for_each(|p| p.seen += shown * (p.area - p.seen));
        rest -= excess;
    }
    if rest.is_nan() || rest <= MIN_SHARE {
        return NOTHING;
    }
    let moment: DVec2 = list.iter().map(|p| p.seen * p.center).sum();
    Covered { share: rest, center: within_disc(-moment / rest) }
}
