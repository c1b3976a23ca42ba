//! Tests of trees: what `check` asks of them, over boxes that are hard to split, and `check` itself, by planted faults.
//! Input: none. Output: a failure that names the boxes.

use glam::Vec3;

use super::split::{Bounds, parts};
use super::{Child, Growing, LEAF, MOST, STACK, Tree, WIDEST, build, check, levels};

pub(super) type Boxes = Vec<[Vec3; 2]>;

pub(super) fn point(random: &mut fastrand::Rng) -> Vec3 {
    Vec3::new(random.f32(), random.f32(), random.f32()) * 2.0 - 1.0
}

fn around(at: Vec3, size: Vec3) -> [Vec3; 2] {
    [at, at + size.abs()]
}

/// Makes a right tree wrong.
type Plant<'a> = &'a dyn Fn(&mut Tree);

/// Coordinates of any size that floats have.
fn wild(random: &mut fastrand::Rng) -> f32 {
    (random.f32() * 2.0 - 1.0) * 2.0f32.powi(random.i32(-140..127))
}

/// Returns boxes that are hard for builders, by their names.
fn hard(count: usize) -> Vec<(&'static str, Boxes)> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut all: Vec<(&str, Boxes)> = Vec::new();
    let mut add =
        |name, make: &mut dyn FnMut(usize) -> [Vec3; 2]| all.push((name, (0..count).map(make).collect()));
    let power = |i: usize, size: usize| 2.0f32.powi((i % size) as i32 - 140);
    add("equal", &mut |_| [Vec3::ZERO, Vec3::ONE]);
    add("equal points", &mut |_| [Vec3::splat(3.0); 2]);
    add("both zeros", &mut |i| [Vec3::splat(if i % 2 == 0 { 0.0 } else { -0.0 }); 2]);
    add("strip", &mut |i| around(Vec3::X * i as f32, Vec3::ONE));
    add("line of points", &mut |i| [Vec3::Y * i as f32; 2]);
    add("progression", &mut |i| [Vec3::X * power(i, 260); 2]);
    add("progression of boxes", &mut |i| [Vec3::ZERO, Vec3::splat(power(i, 260))]);
    add("progressions on axes", &mut |i| [Vec3::AXES[i % 3] * power(i / 3, 260); 2]);
    add("progression, many of the least", &mut |i| [Vec3::X * power(259 - i.min(250), 260); 2]);
    add("slow progression", &mut |i| [Vec3::X * 1.01f32.powi((i % 8000) as i32 - 4000); 2]);
    add("nested", &mut |i| [Vec3::splat(-(i as f32)), Vec3::splat(i as f32)]);
    add("needles", &mut |i| around(Vec3::new(0.0, i as f32, 0.0), Vec3::new(1e6, 1e-6, 1e-6)));
    add("far", &mut |_| around(point(&mut random) * 1e30, Vec3::splat(1e28)));
    let limits = [Vec3::MIN, Vec3::ZERO, Vec3::MAX, Vec3::MAX];
    add("farthest", &mut |i| [limits[i % 3], limits[i % 3 + 1]]);
    add("least", &mut |_| [point(&mut random) * 1e-44; 2]);
    add("wild", &mut |_| {
        let [a, b] = [(); 2].map(|()| Vec3::new(wild(&mut random), wild(&mut random), wild(&mut random)));
        [a.min(b), a.max(b)]
    });
    add("random", &mut |_| around(point(&mut random), point(&mut random) * 0.01));
    add("flat", &mut |_| around(point(&mut random) * Vec3::new(1.0, 1.0, 0.0), Vec3::ZERO));
    all
}

#[test]
fn trees_over_hard_boxes_are_right() {
    for count in [0, 1, 2, 3, 4, 5, 9, 33, 2000, 40_000] {
        for (name, boxes) in hard(count) {
            for width in (2..=WIDEST).step_by(if count > 2000 { 6 } else { 1 }) {
                let tree = build(&boxes, Growing::alone(width));
                check(&tree, &boxes).unwrap_or_else(|fault| panic!("{count} {name}, {width} wide: {fault}"));
            }
        }
    }
}

#[test]
fn the_bound_of_the_depth_is_reached_and_kept() {
    assert_eq!([2, 4, 8].map(levels), [63, 21, 9]);
    for width in 2..=WIDEST {
        // Balanced trees of that depth hold any mesh.
        assert!(LEAF.saturating_mul(width.saturating_pow(levels(width))) >= MOST);
        assert!((width - 1) * (levels(width) as usize) < STACK);
    }
    let boxes: Boxes = hard(200_000).into_iter().flat_map(|(_, boxes)| boxes).take(1_200_000).collect();
    for width in [4, 8] {
        let tree = build(&boxes, Growing::alone(width));
        check(&tree, &boxes).unwrap();
    }
    let deep: Boxes = (0..260 * 800).map(|i| [Vec3::X * 2.0f32.powi(i % 260 - 140); 2]).collect();
    let tree = build(&deep, Growing::alone(8));
    check(&tree, &deep).unwrap();
    assert_eq!(tree.depth, levels(8));
}

/// Where no surface tells planes apart, halves keep trees far below the bound.
#[test]
fn trees_without_surfaces_are_balanced() {
    let boxes: Boxes = (0..1 << 16).map(|i| [Vec3::Y * i as f32; 2]).collect();
    assert!(build(&boxes, Growing::alone(2)).depth <= 17);
    assert!(build(&[[Vec3::ONE; 2]; 1 << 16], Growing::alone(2)).depth <= 15);
}

/// A node whose room is as tight as can be is what the induction over levels rests on.
#[test]
fn parts_fit_the_least_room() {
    for count in [5, 17, 64, 1000, 4096] {
        for (name, boxes) in hard(count) {
            for width in 2..=WIDEST {
                let mut items: Vec<Child> = (0u32..)
                    .zip(&boxes)
                    .map(|(reference, [min, max])| Child {
                        min: min.to_array(),
                        reference,
                        max: max.to_array(),
                        count: 1,
                    })
                    .collect();
                let room = count.div_ceil(width);
                let bounds = Bounds::of(&items);
                let parts = parts(&mut items, bounds, Growing::alone(width), room);
                let most = parts.all().iter().map(|part| part.count).max().unwrap();
                assert!(most <= room, "{count} {name}, {width} wide: {most} > {room}");
                assert_eq!(parts.all().iter().map(|part| part.count).sum::<usize>(), count);
            }
        }
    }
}

#[test]
fn trees_do_not_depend_on_threads() {
    let mut random = fastrand::Rng::with_seed(3);
    let boxes: Boxes = (0..100_000).map(|_| around(point(&mut random), point(&mut random) * 0.02)).collect();
    let trees = [1, 2, 3, 1].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| build(&boxes, Growing::alone(8)))
    });
    check(&trees[0], &boxes).unwrap();
    let bytes = |tree: &Tree| bytemuck::cast_slice::<Child, u8>(&tree.children).to_vec();
    for tree in &trees[1..] {
        assert_eq!(tree, &trees[0]);
        assert!(bytes(tree) == bytes(&trees[0]));
    }
}

#[test]
fn the_check_finds_planted_faults() {
    let mut random = fastrand::Rng::with_seed(4);
    let boxes: Boxes = (0..3000).map(|_| around(point(&mut random), point(&mut random) * 0.1)).collect();
    let tree = build(&boxes, Growing::alone(8));
    check(&tree, &boxes).unwrap();
    let are_leaves = |node: &[Child]| node[0].count > 1 && node[1].count > 0;
    let leaf = 8 * tree.children.chunks(8).position(are_leaves).unwrap();
    let inner = tree.children.iter().rposition(|child| child.count == 0 && child.is_used()).unwrap();
    let gap = tree.children.iter().position(|child| !child.is_used()).unwrap();
    let faults: [(&str, Plant); 14] = [
        ("no whole nodes", &|tree| tree.children.truncate(tree.children.len() - 1)),
        ("places for", &|tree| tree.order.truncate(1)),
        ("does not contain primitive", &|tree| tree.children[leaf].max[1] = tree.children[leaf].min[1]),
        ("does not contain", &|tree| tree.children[leaf].min[2] = f32::NAN),
        ("does not contain Child", &|tree| {
            tree.children[inner].min[0] = tree.children[inner].min[0].next_up()
        }),
        ("is in no leaf", &|tree| tree.children[leaf].count -= 1),
        ("which is taken", &|tree| tree.children[leaf + 1] = tree.children[leaf]),
        ("has 5 primitives", &|tree| tree.children[leaf].count = 5),
        ("is no node", &|tree| tree.children[inner].reference += 1),
        ("has a parent already", &|tree| tree.children[inner].reference = 0),
        ("has a gap", &|tree| tree.children[gap].max = [0.0; 3]),
        ("two places", &|tree| {
            // The same box twice, so that only the order is wrong.
            let [place, other] = [0, 1].map(|offset| tree.children[leaf].reference as usize + offset);
            tree.order[place] = tree.order[other];
        }),
        ("depth", &|tree| tree.depth += 1),
        ("is not reached", &|tree| tree.children.extend([Child::UNUSED; 8])),
    ];
    for (words, plant) in faults {
        let mut faulty = tree.clone();
        plant(&mut faulty);
        let found = check(&faulty, &boxes).unwrap_err();
        assert!(found.contains(words), "{words}: {found}");
    }
}
