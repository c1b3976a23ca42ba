//! The mapping of the unit square to a rectangle by solid angle: uniform, equal on device and
//! oracle, near, far and grazing.

use glam::{DVec2, DVec3};
use moire::internal::lab::probe::{self, WarpQuery};
use moire::internal::oracle::rectangle::{MIN_SOLID_ANGLE, on_rectangle};
use moire::internal::scene::model::Pattern;

use crate::lookup::bench::Rng;
use crate::stage::device;

/// Of the rectangle between two corners, seen from `z` above the origin: the sum of four arc tangents.
fn solid_angle(low: DVec2, high: DVec2, z: f64) -> f64 {
    let corner = |x: f64, y: f64| (x * y / (z * (x * x + y * y + z * z).sqrt())).atan();
    corner(high.x, high.y) - corner(high.x, low.y) - corner(low.x, high.y) + corner(low.x, low.y)
}

/// (middle, half sides, height), some next to the plane, some aside, some far, some thin; 1/1024 or more of a solid
/// angle.
fn rectangles(count: usize, seed: u64) -> Vec<(DVec2, DVec2, f64)> {
    let mut rng = Rng::new(seed);
    let mut all = Vec::new();
    while all.len() < count {
        let half = DVec2::new(1.0, 10f64.powf(-3.0 * rng.between(0.0, 1.0).powi(2)));
        let spread = 10f64.powf(rng.between(-2.0, 1.0));
        let side = |rng: &mut Rng| rng.between(-1.0, 1.0);
        let middle = DVec2::new(side(&mut rng), side(&mut rng)) * (half + spread);
        let height = 10f64.powf(rng.between(-5.0, 1.5));
        let scale = 10f64.powf(rng.between(-3.0, 3.0));
        // As packed for a device.
        let narrow = |x: f64| f64::from((x * scale) as f32);
        let [m, h] = [middle, half].map(|v| DVec2::new(narrow(v.x), narrow(v.y)));
        let z = narrow(height);
        if solid_angle(m - h, m + h, z) >= MIN_SOLID_ANGLE {
            all.push((m, h, z));
        }
    }
    all
}

#[test]
fn equal_areas_of_the_square_are_equal_solid_angles() {
    const STEPS: u32 = 64;
    let mut rng = Rng::new(81);
    for (middle, half, z) in rectangles(200, 80) {
        let whole = solid_angle(middle - half, middle + half, z);
        // Any part of the rectangle is hit in proportion to its area in the square.
        let mut cut = || {
            let at = |rng: &mut Rng| DVec2::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0));
            let (a, b) = (at(&mut rng), at(&mut rng));
            (middle + half * a.min(b), middle + half * a.max(b))
        };
        let (low, high) = cut();
        let mut met = 0;
        for i in 0..STEPS * STEPS {
            let square =
                DVec2::new(f64::from(i % STEPS) + 0.5, f64::from(i / STEPS) + 0.5) / f64::from(STEPS);
            let (place, angle) = on_rectangle(middle, half, z, square);
            assert!((angle / whole - 1.0).abs() < 1e-8, "solid angle {angle}, {whole} by arc tangents");
            let p = place.truncate();
            let off = ((p - middle).abs() - half).max_element();
            assert!(
                off <= 1e-12 * p.length().max(1.0) && (place.z + z).abs() <= 1e-12 * z,
                "{place} beside it"
            );
            met += u32::from(p.cmpge(low).all() && p.cmple(high).all());
        }
        let share = solid_angle(low, high, z) / whole;
        let found = f64::from(met) / f64::from(STEPS * STEPS);
        // A grid's cells along the border of a convex part: at most this number on each of 4 sides.
        assert!(
            (found - share).abs() < 4.0 / f64::from(STEPS),
            "{found} of the square for {share}: {middle} {half} {z}"
        );
    }
}

/// Returns the solid angle between a device's position and the exact one.
#[test]
fn device_and_oracle_agree_in_solid_angle() {
    let mut rng = Rng::new(83);
    let cases: Vec<_> = rectangles(4000, 82)
        .into_iter()
        .map(|rectangle| {
            let square = [0, 1].map(|_| (rng.between(0.0, 16_777_216.0).floor() / 16_777_216.0) as f32);
            (rectangle, square)
        })
        .collect();
    let queries: Vec<WarpQuery> = cases
        .iter()
        .map(|((m, h, z), square)| WarpQuery {
            square: *square,
            rectangle: [m.x, m.y, h.x, h.y].map(|x| x as f32),
            normal: [0.0, 0.0, 1.0, *z as f32],
            ..Default::default()
        })
        .collect();
    let mut scene = super::packed(&super::parsed(super::lens::VIEW));
    scene.header.pattern = Pattern::Center;
    let answers = probe::warps(&device(), &scene, &queries).unwrap();
    for (((middle, half, z), square), answer) in cases.into_iter().zip(&answers) {
        let [x, y, below, angle] = answer.rectangle.map(f64::from);
        let what = format!("{middle} {half} {z} {square:?}: device {:?}", answer.rectangle);
        let right = solid_angle(middle - half, middle + half, z);
        // Angles up to pi in f32 arc tangents: 1.6e-7 were seen.
        assert!((angle - right).abs() < 4e-7 + 4e-7 * right, "{what}: {right} by arc tangents");
        assert!((below + z).abs() <= 4e-7 * z, "{what}");
        let [u, v] = square.map(f64::from);
        let (low, high) = (middle - half, middle + half);
        let before = solid_angle(low, DVec2::new(x.clamp(low.x, high.x), high.y), z);
        assert!(
            (before - u * right).abs() < 2e-6 * (1.0 + right),
            "{what}: {before} before x, {} wanted",
            u * right
        );
        // Along the strip through x: the sine of the angle from its foot grows evenly.
        let sine = |y: f64| y / DVec3::new(x, y, z).length();
        let along = (sine(y.clamp(low.y, high.y)) - sine(low.y)) - v * (sine(high.y) - sine(low.y));
        assert!(along.abs() < 1e-6, "{what}: off by {along} along the strip");
    }
}
