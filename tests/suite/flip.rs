//! FLIP against values of its authors' program (FLIP.h of version 1.7, CPU, default parameters,
//! linear input), and its invariants.

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::flip;
use moire::internal::lab::metrics::flip::PerceptualFeatures;

use crate::support::{gradient, told};

/// Both sides compute in single precision, in different orders: of the smallest difference below, which is
/// 0.199467 in double precision, the authors' program is off by 4.2e-5, ours by 1.3e-5.
const SINGLE: f64 = 5e-5;

fn film(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [f32; 3]) -> Film {
    let pixels =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    Film { width, height, pixels, samples: 1 }
}

fn blue(x: u32, y: u32) -> f32 {
    if (x / 5 + y / 5) % 2 == 1 { 0.75 } else { 0.25 }
}

/// Checks, a ramp of lower contrast, and noise in blue on the right half.
fn pair() -> [Film; 2] {
    let noise = |i: u32| ((i.wrapping_mul(2_654_435_761) >> 8) & 0xff) as f32 / 255.0;
    [
        film(40, 24, |x, y| [x as f32 / 40.0, y as f32 / 24.0, blue(x, y)]),
        film(40, 24, |x, y| {
            let b = if x < 20 { blue(x, y) } else { noise(y * 40 + x) };
            [x as f32 / 40.0, y as f32 / 24.0 * 0.75 + 0.125, b]
        }),
    ]
}

#[test]
fn mean_and_single_pixels_agree_with_the_authors_program() {
    let [a, b] = pair();
    let mean = flip(&a, &b).unwrap();
    assert!((mean - 0.334_977_6).abs() < SINGLE, "{mean}");
    let map = PerceptualFeatures::of(&a).map(&PerceptualFeatures::of(&b));
    for (x, y, expected) in [(0, 0, 0.6861), (19, 12, 0.171_911), (30, 3, 0.362_581), (39, 23, 0.426_463)] {
        let found = f64::from(map[y * 40 + x]);
        assert!((found - expected).abs() < SINGLE, "({x}, {y}): {found} for {expected}");
    }
}

#[test]
fn uniform_colours_agree_with_the_authors_program() {
    for (a, b, expected) in [
        ([0.0; 3], [1.0; 3], 0.967_388),
        ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], 1.0),
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.986_665),
        ([0.5; 3], [0.6, 0.5, 0.5], 0.199_509),
    ] {
        let found = flip(&film(16, 16, |_, _| a), &film(16, 16, |_, _| b)).unwrap();
        assert!((found - expected).abs() < SINGLE, "{a:?} {b:?}: {found} for {expected}");
    }
}

#[test]
fn equal_pictures_differ_by_nothing_and_the_order_does_not_matter() {
    let [a, b] = pair();
    assert_eq!(flip(&a, &a).unwrap(), 0.0);
    assert_eq!(flip(&a, &b).unwrap(), flip(&b, &a).unwrap());
}

#[test]
fn planted_shift_by_a_pixel_is_seen() {
    let edge = |at: u32| film(32, 32, move |x, _| if x < at { [0.2; 3] } else { [0.8; 3] });
    assert!(flip(&edge(16), &edge(17)).unwrap() > 0.02);
}

#[test]
fn values_beyond_the_screen_are_clipped_and_nan_gives_no_number() {
    let over = |v: f32| film(8, 8, move |_, _| [v; 3]);
    assert_eq!(flip(&over(1.0), &over(7.0)).unwrap(), 0.0);
    let mut nan = over(1.0);
    nan.pixels[3][1] = f32::NAN;
    assert!(flip(&nan, &over(1.0)).unwrap().is_nan());
}

#[test]
fn one_pixel_and_odd_sizes_are_pictures_too() {
    for (width, height) in [(1, 1), (1, 9), (7, 1), (23, 3)] {
        let value = flip(&gradient(width, height), &film(width, height, |_, _| [1.0; 3])).unwrap();
        assert!(value > 0.0 && value <= 1.0, "{width}×{height}: {value}");
    }
    assert!(told(flip(&gradient(3, 3), &gradient(4, 3))).contains("differ in size"));
}
