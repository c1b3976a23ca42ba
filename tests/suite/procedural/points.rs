//! Patterns at points computed by hand: parity of checkers, duty of stripes, lines of grids, bond
//! of bricks, whole rings and veins.

use glam::DVec3;
use moire::internal::texture::procedural::ProceduralKind::*;

use super::{default_record, record, share_at};

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

#[test]
fn checker_is_the_parity_of_the_cell() {
    let what = default_record(Checker);
    for (x, y, z) in (-3..=3).flat_map(|x| (-3..=3).flat_map(move |y| (-3..=3).map(move |z| (x, y, z)))) {
        let expected = f64::from(i32::rem_euclid(x + y + z, 2));
        for inside in [0.0, 0.25, 0.999] {
            let p = at(x.into(), y.into(), z.into()) + inside;
            assert_eq!(share_at(&what, p), expected, "{p}");
        }
    }
    // Just below a whole coordinate lies the cell before, also below 0.
    assert_eq!(share_at(&what, at(-1e-9, 0.5, 0.0)), 1.0);
    assert_eq!(share_at(&what, at(2e9 + 1.0, 0.5, 0.0)), 1.0);
}

#[test]
fn stripes_have_their_width_of_each_period() {
    let what = record(Stripes, |t| t.width = 0.25);
    for (x, expected) in
        [(0.0, 1.0), (0.2, 1.0), (0.249, 1.0), (0.25, 0.0), (0.9, 0.0), (-0.8, 1.0), (-0.1, 0.0), (7.1, 1.0)]
    {
        assert_eq!(share_at(&what, at(x, 0.3, -5.0)), expected, "x = {x}");
    }
    for (width, expected) in [(0.0, 0.0), (1.0, 1.0)] {
        let what = record(Stripes, |t| t.width = width);
        assert!((0..100).all(|i| share_at(&what, at(f64::from(i) * 0.05, 0.0, 0.0)) == expected));
    }
}

#[test]
fn lines_of_a_grid_are_centred_on_whole_coordinates() {
    let flat = record(Grid, |t| t.width = 0.2);
    let solid = record(Grid, |t| (t.width, t.dimensions) = (0.2, 3));
    for (p, in_flat, in_solid) in [
        (at(0.05, 0.5, 0.5), 1.0, 1.0),
        (at(-0.05, 0.5, 0.5), 1.0, 1.0),
        (at(0.5, 2.95, 0.5), 1.0, 1.0),
        (at(0.5, 0.5, 0.5), 0.0, 0.0),
        (at(0.15, 0.85, 0.5), 0.0, 0.0),
        (at(0.5, 0.5, 0.0), 0.0, 1.0),
    ] {
        assert_eq!((share_at(&flat, p), share_at(&solid, p)), (in_flat, in_solid), "{p}");
    }
}

#[test]
fn every_other_row_of_bricks_is_shifted() {
    let what = record(Brick, |t| (t.width, t.aspect, t.offset) = (0.1, 3.0, 0.5));
    for (x, y, expected) in [
        (1.5, 0.5, 1.0),
        (0.04, 0.5, 0.0), // the joint of even rows is at whole multiples of 3
        (0.06, 0.5, 1.0),
        (2.96, 0.5, 0.0),
        (1.5, 1.5, 0.0), // that of odd rows half a brick further
        (1.56, 1.5, 1.0),
        (3.0, 1.5, 1.0),
        (1.5, -0.5, 0.0),
        (1.5, 2.5, 1.0),
        (1.5, 1.04, 0.0), // between rows
        (1.5, 0.96, 0.0),
        (0.5, 0.94, 1.0),
    ] {
        assert_eq!(share_at(&what, at(x, y, 9.7)), expected, "({x}, {y})");
    }
}

#[test]
fn without_distortion_veins_and_rings_are_sines() {
    let veins = record(Marble, |t| t.distortion = 0.0);
    let rings = record(Wood, |t| t.distortion = 0.0);
    for (p, vein, ring) in [
        (at(0.0, 0.0, 0.0), 0.5, 0.0),
        (at(0.25, 0.0, 3.3), 1.0, 0.5),
        (at(-0.25, 0.0, 1.0), 0.0, 0.5),
        (at(0.3, 0.4, 0.0), 0.5 + 0.5 * (0.6 * std::f64::consts::PI).sin(), 1.0),
        (at(6.0, 8.0, 0.0), 0.5, 0.0),
    ] {
        // 24 bits of the records, and of the angle's sine.
        assert!((share_at(&veins, p) - vein).abs() < 1e-7, "vein at {p}: {}", share_at(&veins, p));
        assert!((share_at(&rings, p) - ring).abs() < 1e-7, "ring at {p}: {}", share_at(&rings, p));
    }
}

#[test]
fn cells_without_jitter_have_their_points_in_the_middle() {
    let what = record(Cellular, |t| t.jitter = 0.0);
    for p in [at(0.5, 0.5, 0.5), at(-3.25, 7.0, 0.9), at(0.0, 0.0, 0.0), at(1e6, -2.5, 0.5)] {
        let expected = (p - p.floor() - 0.5).length();
        assert!((share_at(&what, p) - expected).abs() < 1e-12, "{p}");
    }
}
