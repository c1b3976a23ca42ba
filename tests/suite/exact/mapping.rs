//! Projective mappings: planar, cylindrical and spherical coordinates about any axis, of positions,
//! normals and reflected directions, by angles to 256 bits; scale, then rotation, then offset;
//! environments.

use std::sync::OnceLock;

use glam::{DVec2, DVec3, Vec2Swizzles};
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::mapping::{Coordinate, MapInput, texture_coordinate};
use moire::internal::schema::layout::UvProjection;

use super::numbers::{
    Q, V, angle, approx, cos, degrees, direction, frac, nearest_turn, pi, q, sin, v, vector,
};
use super::scenes::{AHEAD, TEXTURED, from, list, packed};
use super::{U, Worst};

/// Scale, then rotation, then offset (KHR_texture_transform).
pub fn placed(uv: [Q; 2], scale: DVec2, rotate: f64, offset: DVec2) -> [Q; 2] {
    let [u, w] = [&uv[0] * q(scale.x), &uv[1] * q(scale.y)];
    let (s, c) = (sin(&degrees(rotate)), cos(&degrees(rotate)));
    [&c * &u - &s * &w + q(offset.x), s * u + c * w + q(offset.y)]
}

/// Coordinates in a frame whose y is `axis`: the world's axes, turned by the smallest rotation that takes
/// +y there.
fn in_frame(x: &V, axis: DVec3) -> V {
    let a = v(axis).unit();
    let y = v(DVec3::Y);
    let turn = y.cross(&a);
    let share = (frac(1, 1) + y.dot(&a)).recip();
    V([DVec3::X, DVec3::Y, DVec3::Z].map(|unit| {
        let unit = v(unit);
        let once = turn.cross(&unit);
        unit.plus(&once).plus(&turn.cross(&once).times(&share)).dot(x)
    }))
}

/// φ/2π in [0, 1), from +x towards +z.
fn around(local: &V) -> Q {
    let turn = angle(&local.0[2], &local.0[0]) / (pi() * frac(2, 1));
    if turn < frac(0, 1) { turn + frac(1, 1) } else { turn }
}

/// θ/π, from the axis.
fn from_axis(local: &V) -> Q {
    let [x, y, z] = &local.0;
    angle(&V([x.clone(), frac(0, 1), z.clone()]).length(), y) / pi()
}

struct Case {
    kind: &'static str,
    axis: DVec3,
    origin: DVec3,
    eye: DVec3,
    scale: DVec2,
    rotate: f64,
    offset: DVec2,
}

fn cases() -> Vec<Case> {
    let mut rng = Rng::new(51);
    let mut all = Vec::new();
    for i in 0..30 {
        let kind = ["planar", "cylindrical", "spherical"][i % 3];
        let axis = match i / 3 % 5 {
            0 | 1 => DVec3::Y,
            2 => DVec3::new(0.0, -1.0, 1e-3),
            _ => direction(&mut rng),
        };
        let eye = vector(&mut rng, [0.0, 10.0, 1e6][i % 5 % 3]);
        let origin = eye + vector(&mut rng, 3.0);
        let plain = i % 4 == 0;
        let scale = if plain { DVec2::ONE } else { DVec2::new(rng.between(0.1, 9.0), -3.0) };
        let rotate = if plain { 0.0 } else { rng.between(-180.0, 180.0) };
        let offset = if plain { DVec2::ZERO } else { DVec2::new(rng.between(-2.0, 2.0), 0.25) };
        all.push(Case { kind, axis, origin, eye, scale, rotate, offset });
    }
    all
}

impl Case {
    fn map(&self) -> UvProjection {
        let [axis, origin] = [self.axis, self.origin].map(list);
        let pair = |p: DVec2| format!("[{:?}, {:?}]", p.x, p.y);
        let text = format!(
            "{}{TEXTURED}[[material]]\nname = 'm'\ntexture = 't'\nsampler = 's'\n[material.mapping]\nkind = '{}'\n\
             axis = {axis}\norigin = {origin}\nscale = {}\nrotate = {:?}\noffset = {}\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n",
            from(self.eye),
            self.kind,
            pair(self.scale),
            self.rotate,
            pair(self.offset)
        );
        packed(&text).1.records.uv_projections[0]
    }

    fn local(&self, p: DVec3) -> V {
        in_frame(&v(p).plus(&v(self.eye)).minus(&v(self.origin)), self.axis)
    }

    /// How far the angle is from the seam, in turns.
    fn seam(&self, p: DVec3) -> f64 {
        let turn = approx(&around(&self.local(p)));
        if self.kind == "planar" { 1.0 } else { turn.min(1.0 - turn) }
    }

    fn exact(&self, p: DVec3) -> ([Q; 2], f64) {
        let local = self.local(p);
        let [lx, ly, _] = local.0.clone();
        let uv = match self.kind {
            "planar" => [lx, ly],
            "cylindrical" => [around(&local), ly],
            _ => [from_axis(&local), around(&local)],
        };
        // Of the local place: eye − origin, the frame's axes (a quaternion's: 12 U) and the sums.
        let size = p.length() + (self.eye - self.origin).length();
        // Near the opposite axis the smallest rotation itself is as ill-conditioned as 1 / cos of half its angle.
        let near_opposite = (2.0 / (1.0 + self.axis.normalize().y)).sqrt();
        let e_local = U * 20.0 * size * near_opposite * near_opposite;
        let local = local.approx();
        let across = local.x.hypot(local.z);
        let e_uv = match self.kind {
            "planar" => e_local,
            "cylindrical" => e_local.max(e_local / across) + 3.0 * U,
            _ => e_local / local.length() + e_local / across + 3.0 * U,
        };
        let most = self.scale.abs().element_sum();
        let reach = most * (1.0 + size) + self.offset.abs().element_sum();
        (placed(uv, self.scale, self.rotate, self.offset), most * e_uv + 10.0 * U * reach)
    }
}

/// A map, a place, its exact coordinate and a bound.
type Known = (UvProjection, DVec3, [Q; 2], f64);

fn known() -> &'static [Known] {
    static KNOWN: OnceLock<Vec<Known>> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let mut rng = Rng::new(52);
        let mut all = Vec::new();
        for case in cases() {
            let map = case.map();
            for i in 0..16 {
                // Anywhere, near the axis, near the seam on either side, on the world's axes.
                let near = [1.0, 1e-3, 1e-9][i % 3];
                let p = case.origin - case.eye
                    + match i / 3 {
                        0 | 1 => vector(&mut rng, 2.0),
                        2 => case.axis * rng.between(-1.0, 1.0) + near * direction(&mut rng),
                        3 => DVec3::new(1.5, 0.2, near * rng.between(-1.0, 1.0)),
                        4 => [DVec3::X, DVec3::NEG_Z, DVec3::NEG_X][i % 3],
                        _ => DVec3::ZERO,
                    };
                let (exact, bound) = case.exact(p);
                // At the axis the angle is undefined; at the seam rounding chooses the side.
                let edge = case.seam(p);
                if bound < 0.01 && edge > bound {
                    all.push((map, p, exact, bound));
                }
            }
        }
        all
    })
}

fn compare(read: impl Fn(&UvProjection, &MapInput) -> Coordinate) -> Worst {
    let mut worst = Worst::default();
    for (map, p, exact, bound) in known() {
        let at = read(map, &MapInput { entity: *p, ..Default::default() }).at;
        for (got, exact) in [at.x, at.y].into_iter().zip(exact) {
            // `repeat` does not distinguish whole tiles.
            worst.add(got, &nearest_turn(exact, got, 1), *bound);
        }
    }
    worst
}

#[test]
fn angles_and_heights_about_any_axis_are_exact_to_their_condition() {
    compare(texture_coordinate).holds("projecting maps");
}

#[test]
fn planted_errors_of_maps_are_told() {
    let with = |f: fn(DVec3) -> DVec3| {
        move |map: &UvProjection, seen: &MapInput| Coordinate {
            at: f(texture_coordinate(map, seen).at),
            ..Default::default()
        }
    };
    compare(with(|c| DVec3::new(c.x, -c.y, 0.0))).fails("φ from +x towards −z");
    compare(with(|c| c.truncate().yx().extend(0.0))).fails("swapped axes");
    compare(with(|c| c + 1e-6)).fails("a millionth of a tile");
    compare(|map, seen| {
        let turned = UvProjection { m01: map.m10, m10: map.m01, ..*map };
        texture_coordinate(&turned, seen)
    })
    .fails("rotation the other way");
}

/// Equirectangular: the middle of the picture looks along −z, +x lies to its right, or mirrored to its left,
/// v = 0 at +y.
fn environment(read: impl Fn(&UvProjection, DVec3) -> DVec2) -> Worst {
    let mut rng = Rng::new(53);
    let mut worst = Worst::default();
    for (rotate, mirror) in [(0.0, false), (90.0, false), (-33.3, false), (0.0, true), (-33.3, true)] {
        let text = format!(
            "{AHEAD}{TEXTURED}[background]\nenvironment = 't'\nsampler = 's'\nrotate = {rotate:?}\nmirror = {mirror}\n"
        );
        let (_, scene) = packed(&text);
        let map = scene.records.uv_projections[scene.header.environment_projection as usize];
        for i in 0..40 {
            let d = match i {
                0 => DVec3::NEG_Z,
                1 => DVec3::X,
                2 => DVec3::new(1e-7, 1.0, 1e-7).normalize(),
                _ => direction(&mut rng),
            };
            let [x, y, z] = v(d).0;
            let across = V([x.clone(), frac(0, 1), z.clone()]).length();
            // Rotated about +y: the visible part moves with the picture, against the direction's own angle.
            let turn = frac(2, 1) * pi();
            let around = angle(&x, &-z) / &turn + degrees(rotate) / turn;
            let u = if mirror { frac(1, 2) - around } else { frac(1, 2) + around };
            let polar = angle(&across, &y) / pi();
            let at = read(&map, d);
            let bound = 8.0 * U * (1.0 + 1.0 / approx(&across)); // the axes, their products and the angle
            worst.add(at.x, &nearest_turn(&u, at.x, 1), bound);
            worst.add(at.y, &polar, bound);
        }
    }
    worst
}

fn looked_up(map: &UvProjection, d: DVec3) -> DVec2 {
    texture_coordinate(map, &MapInput { entity: d, ..Default::default() }).at.truncate()
}

#[test]
fn environments_lie_about_the_scene_as_documented() {
    environment(looked_up).holds("environments");
}

#[test]
fn planted_errors_of_environments_are_told() {
    environment(|map, d| looked_up(map, d * DVec3::new(-1.0, 1.0, 1.0))).fails("a mirrored environment");
    environment(|map, d| looked_up(map, d) + DVec2::new(0.5, 0.0)).fails("half a turn");
    environment(|map, d| looked_up(map, d * DVec3::new(1.0, -1.0, 1.0))).fails("upside down");
}
