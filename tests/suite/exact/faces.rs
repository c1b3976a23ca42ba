//! Cube textures: the face selected by a direction and the position on it by Vulkan's table, and
//! the texel there.

use glam::{DVec2, DVec3};
use moire::internal::lab::verify::queries::{self, Rng};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::{Coordinate, on_cube_face, within_face};
use moire::internal::texture::data::Dimension;
use moire::internal::texture::sampler_spec::{Filter, SamplerSpec};
use num_traits::Signed;

use super::numbers::{Q, direction, frac, v};
use super::scenes::grey;
use super::{U, Worst};

/// Vulkan 1.3, table "Cube map face and coordinate selection": which axis is major and its sign, then s and t
/// as signed axes, counted from 1.
const FACES: [(i32, i32, i32); 6] =
    [(1, -3, -2), (-1, 3, -2), (2, 1, 3), (-2, 1, -3), (3, 1, -2), (-3, -1, -2)];

fn signed(d: DVec3, axis: i32) -> Q {
    let x = v(d).0[axis.unsigned_abs() as usize - 1].clone();
    if axis < 0 { -x } else { x }
}

/// Among equal axes z precedes y, and y precedes x.
fn exact(d: DVec3) -> (u32, [Q; 2]) {
    let a = v(d).0.map(|x| x.abs());
    let major = (0..3).rev().reduce(|best, axis| if a[axis] > a[best] { axis } else { best }).unwrap() as i32;
    let face = FACES.iter().position(|f| f.0.abs() == major + 1 && !signed(d, f.0).is_negative()).unwrap();
    let (ma, s, t) = FACES[face];
    let half = |axis: i32| (signed(d, axis) / signed(d, ma) + frac(1, 1)) / frac(2, 1);
    (face as u32, [half(s), half(t)])
}

fn directions() -> Vec<DVec3> {
    let mut rng = Rng::new(71);
    let mut all: Vec<DVec3> = (0..200).map(|_| direction(&mut rng)).collect();
    for k in 0..27 {
        let d = DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)) - 1.0;
        // All axes, edges and corners, and those with the last digit changed.
        if d != DVec3::ZERO {
            all.extend([d, d * DVec3::new(1.0 + 2.0 * U, 1.0, 1.0), d * DVec3::new(1.0, 1.0 - U, 1.0)]);
        }
    }
    all
}

fn compare(select: impl Fn(DVec3) -> (u32, DVec2)) -> Worst {
    let mut worst = Worst::default();
    for d in directions() {
        let (face, place) = exact(d);
        let (got, at) = select(d);
        worst.agree(got == face);
        for (got, exact) in at.to_array().into_iter().zip(&place) {
            worst.add(got, exact, 2.0 * U); // a quotient and a sum
        }
    }
    worst
}

fn selected(d: DVec3) -> (u32, DVec2) {
    let (stm, face) = on_cube_face(d);
    (face, within_face(stm))
}

#[test]
fn directions_meet_the_faces_of_vulkans_table() {
    compare(selected).holds("cube faces");
}

#[test]
fn planted_errors_of_faces_are_told() {
    compare(|d| (selected(d).0, 1.0 - selected(d).1)).fails("a face upside down");
    compare(|d| selected(d * DVec3::new(1.0, 1.0, -1.0))).fails("a left-handed cube");
    let x_first = |d: DVec3| {
        let tie = d.x.abs() == d.z.abs() && d.x.abs() >= d.y.abs();
        if tie { (u32::from(d.x < 0.0), selected(d).1) } else { selected(d) }
    };
    compare(x_first).fails("ties that go to x");
}

#[test]
fn every_texel_of_a_cube_is_read_along_the_direction_to_its_middle() {
    let size = 3;
    let texels: Vec<f32> = (0..size * size * 6).map(|i| i as f32).collect();
    let cube = grey(Dimension::Cube, [size as u32, size as u32, 6], &texels);
    let nearest = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    let scene = queries::pairs(vec![cube], &[nearest], &[(0, 0)]).unwrap();
    for (face, (ma, s, t)) in FACES.into_iter().enumerate() {
        for (x, y) in (0..size * size).map(|i| (i % size, i / size)) {
            let mut d = DVec3::ZERO;
            let middle = |i: i32| (2.0 * f64::from(i) + 1.0) / f64::from(size) - 1.0;
            for (axis, along) in [(ma, 1.0), (s, middle(x)), (t, middle(y))] {
                d[axis.unsigned_abs() as usize - 1] = along * f64::from(axis.signum());
            }
            let place = Coordinate { at: d, ..Default::default() };
            let read = sample_texture(
                &scene,
                &scene.records.textures[0],
                &scene.records.samplers[0],
                &place,
                [0, 0],
            )
            .x;
            assert_eq!(read, f64::from((face as i32 * size + y) * size + x), "face {face}, texel {x} {y}");
        }
    }
}
