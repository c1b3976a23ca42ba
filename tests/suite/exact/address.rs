//! Address modes: the texel at every integer position, by stepping along the texture instead of by
//! remainders; and coordinates reduced to the texture, exactly.

use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::address::{addressed_texel, reduced_coordinate};
use moire::internal::texture::sampler_spec::Address;
use num_traits::Signed;

use super::numbers::{Q, approx, frac, modulo, q};
use super::{U, Worst};

/// Takes one step to the right from texel `at` in direction `way`; at an end the mode decides the
/// continuation.
fn step(mode: Address, at: i64, way: i64, size: i64) -> (i64, i64) {
    let inside = (0..size).contains(&(at + way));
    match mode {
        _ if inside => (at + way, way),
        Address::Repeat => (if way > 0 { 0 } else { size - 1 }, way),
        Address::MirroredRepeat => (at, -way),
        _ => (at, way),
    }
}

/// Texel `i`, found from texel 0 by single steps; none is the border.
pub fn walked(mode: Address, i: i64, size: i64) -> Option<i64> {
    let once = mode == Address::MirrorClampToEdge && i < 0;
    let (goal, start) = if once { (-1 - i, 0) } else { (i, 0) };
    if mode == Address::ClampToBorder && (goal < 0 || goal >= size) {
        return None;
    }
    let (mut at, mut way) = (start, goal.signum());
    for _ in 0..goal.abs() {
        (at, way) = step(mode, at, way, size);
    }
    Some(at)
}

fn compare(find: impl Fn(Address, i64, i64) -> Option<i64>) -> Worst {
    let mut worst = Worst::default();
    for &mode in Address::ALL {
        for size in [1, 2, 3, 4, 5, 7, 8, 13] {
            for i in -3 * size..=3 * size {
                worst.agree(find(mode, i, size) == walked(mode, i, size));
            }
        }
    }
    worst
}

#[test]
fn every_address_mode_reads_the_texel_that_walking_finds() {
    assert_eq!(
        (-4..5).map(|i| walked(Address::MirroredRepeat, i, 2).unwrap()).collect::<Vec<_>>(),
        [0, 1, 1, 0, 0, 1, 1, 0, 0]
    );
    compare(addressed_texel).holds("address modes");
}

#[test]
fn planted_errors_of_addresses_are_told() {
    compare(|mode, i, size| addressed_texel(mode, i + 1, size)).fails("a texel too far");
    let truncated = |mode, i: i64, size: i64| match mode {
        Address::Repeat => Some((i % size).abs()),
        _ => addressed_texel(mode, i, size),
    };
    compare(truncated).fails("a remainder that is cut off towards 0");
    // These modes repeat no end texel.
    let reflected = |mode, i: i64, size: i64| match mode {
        Address::MirroredRepeat if size > 1 => {
            let r = i.rem_euclid(2 * size - 2);
            Some(r.min(2 * size - 2 - r))
        }
        _ => addressed_texel(mode, i, size),
    };
    compare(reflected).fails("mirrors in the middles of the end texels");
}

/// Returns the position of a coordinate in texels: modulo one or two textures; in other modes limited to
/// where the result is constant.
fn exact_place(mode: Address, u: f64, size: i64) -> Q {
    let size = frac(size, 1);
    match mode {
        Address::Repeat => modulo(&q(u), 1) * size,
        Address::MirroredRepeat => modulo(&q(u), 2) * size,
        _ => q(u.clamp(-2.0, 3.0)) * size,
    }
}

fn places(reduce: impl Fn(Address, f64, f64) -> f64) -> Worst {
    let mut rng = Rng::new(81);
    let mut worst = Worst::default();
    for &mode in Address::ALL {
        for size in [1, 3, 256, 1000] {
            let few =
                [0.0, -0.0, 0.5, 1.0, -1.0, 2.0, -1e-9, 1e-20, 1e9 + 0.25, -1e9 - 0.25, 1e15 + 0.5, 1e300];
            let random = (0..40).map(|i| rng.between(-1.0, 1.0) * 10f64.powi(i % 12)).collect::<Vec<_>>();
            for u in few.into_iter().chain(random) {
                let exact = exact_place(mode, u, size);
                let bound = 2.0 * U * size as f64; // the remainder of a whole tile, and the product
                worst.add(reduce(mode, u, size as f64), &exact, bound);
            }
        }
    }
    worst
}

#[test]
fn coordinates_of_any_size_are_brought_near_without_moving() {
    places(reduced_coordinate).holds("reduced coordinates");
    // A negative coordinate within rounding of 0 lies at the texture's end.
    let end = reduced_coordinate(Address::Repeat, -1e-20, 8.0);
    assert!(approx(&(q(end) - frac(8, 1)).abs()) == 0.0);
}

#[test]
fn planted_errors_of_places_are_told() {
    places(|mode, u, size| reduced_coordinate(mode, u + 0.5 / size, size)).fails("half a texel");
    places(
        |mode, u, size| {
            if mode == Address::Repeat { u.fract() * size } else { reduced_coordinate(mode, u, size) }
        },
    )
    .fails("a fraction that keeps its sign");
}
