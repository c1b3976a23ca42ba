//! Texture coordinates a billion tiles away: whole tiles are removed, and the lookup uses the exact
//! coordinate modulo 1 (`repeat`) or modulo 2 (`mirrored-repeat`).

use glam::{DVec2, DVec3};
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::appearance::map_input;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::footprint::Footprint;
use moire::internal::oracle::geometry::rays::hit_surface;
use moire::internal::oracle::geometry::rays::nearest_hit;
use moire::internal::oracle::mapping::texture_coordinate;
use moire::internal::pack::PackedScene;
use moire::internal::schema::layout::NO_SHAPE;

use super::mapping::placed;
use super::numbers::{Q, approx, frac, modulo, nearest_turn, q, v};
use super::planes::meet;
use super::scenes::{from, list, packed};
use super::{U, Worst};

struct Case {
    address: &'static str,
    period: i64,
    eye: DVec3,
    origin: DVec3,
    scale: DVec2,
    rotate: f64,
    offset: DVec2,
    /// Every step of the way can be held in an f64.
    exact: bool,
}

/// Offsets, places and scales of a billion tiles.
fn cases() -> Vec<Case> {
    let mut rng = Rng::new(61);
    let mut all = Vec::new();
    for i in 0..40 {
        let exact = i % 2 == 0;
        let (address, period) = [("repeat", 1), ("mirrored-repeat", 2)][i / 2 % 2];
        let whole = |rng: &mut Rng| {
            let tiles = rng.between(-2e9, 2e9);
            if exact { (tiles * 64.0).round() / 64.0 } else { tiles }
        };
        let [mut eye, mut origin] = [DVec3::ZERO, DVec3::new(0.0, 0.0, -1.0)];
        let (mut scale, mut offset) = (DVec2::ONE, DVec2::ZERO);
        match i / 4 % 3 {
            0 => (eye.x, eye.y) = (whole(&mut rng), whole(&mut rng)),
            1 => (origin.x, origin.y) = (whole(&mut rng), whole(&mut rng)),
            _ => {
                offset = DVec2::new(whole(&mut rng), whole(&mut rng));
                scale = DVec2::new(f64::from(1 << 20), -4.0);
                eye.x = 1027.25;
            }
        }
        let rotate = if exact { 0.0 } else { rng.between(-180.0, 180.0) };
        all.push(Case { address, period, eye, origin, scale, rotate, offset, exact });
    }
    all
}

impl Case {
    /// A plane of unit axes, met by its own coordinates, or by a planar map.
    fn scene(&self, kind: &str) -> PackedScene {
        let pair = |p: DVec2| format!("[{:?}, {:?}]", p.x, p.y);
        packed(&format!(
            "{}[[texture]]\nname = 't'\nfile = 'f'\n[[sampler]]\nname = 's'\naddress = '{}'\n[[material]]\nname = 'm'\n\
             texture = 't'\nsampler = 's'\n[material.mapping]\nkind = '{kind}'\nscale = {}\nrotate = {:?}\noffset = {}\n{}\
             [[plane]]\norigin = {}\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n",
            from(self.eye),
            self.address,
            pair(self.scale),
            self.rotate,
            pair(self.offset),
            if kind == "planar" { format!("origin = {}\naxis = [0, 1, 0]\n", list(self.origin)) } else { String::new() },
            list(self.origin),
        ))
        .1
    }

    /// The exact coordinate, and a bound from the largest number on the way.
    fn exact(&self, d: DVec3) -> ([Q; 2], f64) {
        let plane = [self.origin, DVec3::X, DVec3::Y].map(v);
        let [_, u, w] = meet(&v(self.eye), &v(d), [&plane[0], &plane[1], &plane[2]]).unwrap();
        let tiles = approx(&u).hypot(approx(&w)) * self.scale.abs().max_element();
        // Positions, sine and cosine, products, sums: 8 roundings of the largest.
        let bound = if self.exact { 0.0 } else { 8.0 * U * (tiles + self.offset.abs().max_element()) };
        // Along the ray: values relative to the eye are small.
        let near = 8.0 * U * (d.length() * self.scale.abs().max_element() + 2.0);
        (placed([u, w], self.scale, self.rotate, self.offset), bound + near)
    }
}

fn compare(change: impl Fn(DVec2) -> DVec2) -> Worst {
    let mut rng = Rng::new(62);
    let mut worst = Worst::default();
    for case in cases() {
        for kind in ["surface", "planar"] {
            let scene = case.scene(kind);
            for _ in 0..4 {
                let d = DVec3::new(rng.between(-3.0, 3.0), rng.between(-3.0, 3.0), -1.0);
                let ray = Ray { origin: DVec3::ZERO, direction: d, time: 0.0 };
                let hit = nearest_hit(&scene, &ray, NO_SHAPE);
                let surface = hit_surface(&scene, &ray, &hit);
                let map = &scene.records.uv_projections[surface.map as usize];
                let at = texture_coordinate(map, &map_input(map, &ray, &surface, &Footprint::default())).at;
                let at = change(at.truncate());
                let (exact, bound) = case.exact(d);
                // Small, and the same place of the same tile.
                worst.agree(at.abs().max_element() < 5.0 * case.scale.abs().max_element() + 4.0);
                for (got, exact) in [at.x, at.y].into_iter().zip(&exact) {
                    worst.add(got, &nearest_turn(&modulo(exact, case.period), got, case.period), bound);
                }
            }
        }
    }
    worst
}

#[test]
fn a_billion_tiles_away_the_place_within_the_tile_is_exact() {
    compare(|at| at).holds("a billion tiles");
}

#[test]
fn planted_errors_of_far_tiles_are_told() {
    compare(|at| at + 1.0).fails("an odd tile where two make a period");
    compare(|at| at + 1e-9).fails("a billionth of a tile");
    compare(|at| (at + 1e9) - 1e9).fails("tiles that are taken out too late");
}

#[test]
fn the_exact_remainder_is_that_of_a_floored_quotient() {
    for (x, period, rest) in [(7.25, 2, 1.25), (-0.25, 1, 0.75), (-7.25, 2, 0.75), (2e9 + 0.5, 1, 0.5)] {
        assert_eq!(modulo(&q(x), period), q(rest));
    }
    assert_eq!(modulo(&frac(-1, 3), 1), frac(2, 3));
}
