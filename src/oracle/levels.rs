//! One place of one level by one filter. Twin of `glsl/shared/levels.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::address::reduced_coordinate;
use super::footprint_axes::kind_of;
use super::mapping::{face_uv, on_cube_face, within_face};
use super::texture::{Level, add_weighted, addresses, fetch_or_border, fetch_texel, flat_texel, weighted};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Filter, TexelCenter};

/// What a look-up of one level needs to know.
pub struct Reader<'a> {
    pub scene: &'a PackedScene,
    pub image: &'a Texture,
    pub how: &'a Sampler,
}

impl Reader<'_> {
    pub fn flat(&self, level: &Level, x: f64, y: f64) -> DVec4 {
        flat_texel(self.scene, self.image, self.how, level, [x as i64, y as i64])
    }

    fn linear_flat(&self, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let row = |y: f64| {
            let left = weighted(1.0 - t.x, self.flat(level, low.x, y));
            add_weighted(t.x, self.flat(level, low.x + 1.0, y), left)
        };
        add_weighted(t.y, row(low.y + 1.0), weighted(1.0 - t.y, row(low.y)))
    }

    fn cubic_flat(&self, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let [b, c] = [self.how.more[2], self.how.more[3]].map(|bits| f64::from(f32::from_bits(bits)));
        let (wx, wy) = (cubic_weights(t.x, b, c), cubic_weights(t.y, b, c));
        let mut sum = DVec4::ZERO;
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                let texel = self.flat(level, low.x - 1.0 + i as f64, low.y - 1.0 + j as f64);
                sum = add_weighted(wx * wy, texel, sum);
            }
        }
        sum
    }

    fn linear_volume(&self, level: &Level, texel: DVec3) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        (0..8).map(corner).fold(DVec4::ZERO, |sum, corner| {
            let w = (1.0 - t) * (1.0 - corner) + t * corner;
            let at = (low + corner).to_array().map(|x| x as i64);
            let texel = fetch_or_border(self.scene, self.image, self.how, level, at, 3);
            add_weighted(w.element_product(), texel, sum)
        })
    }

    /// Beyond a corner there is no texel: its weight goes to the three that meet there.
    fn linear_cube(&self, level: &Level, face: u32, texel: DVec2) -> DVec4 {
        let size = level.size[0];
        let low = texel.floor();
        let t = texel - low;
        let mut sum = DVec4::ZERO;
        let mut three = DVec4::ZERO;
        let mut missing = 0.0;
        for k in 0..4 {
            let corner = DVec2::new(f64::from(k & 1), f64::from(k >> 1));
            let w = ((1.0 - t) * (1.0 - corner) + t * corner).element_product();
            let at = (low + corner).to_array().map(|x| x as i64);
            if is_corner(at, size) {
                missing = w;
                continue;
            }
            let value = fetch_texel(self.scene, self.image, level, cube_texel(face, at, size));
            sum = add_weighted(w, value, sum);
            three += value;
        }
        add_weighted(missing / 3.0, three, sum)
    }

    /// A place of one level by one filter; `dice` in [0, 1) are of the stochastic one.
    pub fn level(&self, filter: Filter, level: &Level, at: DVec3, face: u32, dice: DVec3) -> DVec4 {
        let kind = kind_of(self.image);
        let size = DVec3::from_array(level.size.map(|n| n as f64));
        let mut texel = if kind == TextureKind::Cube {
            at * size.x
        } else {
            let [u, v, w] = addresses(self.how);
            let integer_centers = self.how.modes[3] == TexelCenter::Integer as u32;
            let depth = if kind == TextureKind::Volume { reduced_coordinate(w, at.z, size.z) } else { 0.0 };
            DVec3::new(reduced_coordinate(u, at.x, size.x), reduced_coordinate(v, at.y, size.y), depth)
                + if integer_centers { 0.5 } else { 0.0 }
        };
        if filter == Filter::Stochastic {
            texel += dice - 0.5;
        }
        if matches!(filter, Filter::Nearest | Filter::Stochastic) {
            let mut nearest = texel.floor().to_array().map(|x| x as i64);
            // A place on the far edge belongs to the face that the direction meets.
            if filter == Filter::Nearest && kind == TextureKind::Cube {
                nearest = nearest.map(|n| n.min(level.size[0] - 1));
            }
            return self.one_texel(kind, level, nearest, face, dice.z);
        }
        let texel = texel - 0.5;
        match kind {
            TextureKind::Cube => self.linear_cube(level, face, texel.truncate()),
            TextureKind::Volume => self.linear_volume(level, texel),
            TextureKind::Flat | TextureKind::Procedural if filter == Filter::Cubic => {
                self.cubic_flat(level, texel.truncate())
            }
            TextureKind::Flat | TextureKind::Procedural => self.linear_flat(level, texel.truncate()),
        }
    }

    fn one_texel(&self, kind: TextureKind, level: &Level, at: [i64; 3], face: u32, dice: f64) -> DVec4 {
        match kind {
            TextureKind::Cube => {
                let size = level.size[0];
                let [mut x, mut y, _] = at;
                // Beyond a corner: one of the three texels there.
                if is_corner([x, y], size) {
                    let inside = |n: i64| n.clamp(0, size - 1);
                    (x, y) = match dice {
                        d if d < 1.0 / 3.0 => (inside(x), y),
                        d if d < 2.0 / 3.0 => (x, inside(y)),
                        _ => (inside(x), inside(y)),
                    };
                }
                fetch_texel(self.scene, self.image, level, cube_texel(face, [x, y], size))
            }
            TextureKind::Flat | TextureKind::Procedural => {
                flat_texel(self.scene, self.image, self.how, level, [at[0], at[1]])
            }
            TextureKind::Volume => fetch_or_border(self.scene, self.image, self.how, level, at, 3),
        }
    }
}

/// Weights of the four texels around a place t between the middle two (Mitchell & Netravali 1988).
pub fn cubic_weights(t: f64, b: f64, c: f64) -> [f64; 4] {
    let r = 1.0 - t;
    let outer = |near: f64, far: f64| near * near * (b / 6.0 * near - c * far);
    let inner = |t: f64| 1.0 - b / 3.0 + t * t * ((-3.0 + 2.0 * b + c) + (2.0 - 1.5 * b - c) * t);
    [outer(r, t), inner(t), inner(r), outer(t, r)]
}

fn is_corner([x, y]: [i64; 2], size: i64) -> bool {
    !(0..size).contains(&x) && !(0..size).contains(&y)
}

/// The direction from a cube's centre to a place of a face's plane, (s, t) in [-1, 1] on the face.
pub fn face_direction(face: u32, st: DVec2) -> DVec3 {
    let (s, t) = (st.x, st.y);
    match face {
        0 => DVec3::new(1.0, -t, -s),
        1 => DVec3::new(-1.0, -t, s),
        2 => DVec3::new(s, 1.0, t),
        3 => DVec3::new(s, -1.0, -t),
        4 => DVec3::new(s, -t, 1.0),
        _ => DVec3::new(-s, -t, -1.0),
    }
}

/// A place of a face's plane, on the face that lies behind it.
pub fn refaced(at: DVec3, face: u32) -> (DVec3, u32) {
    let (stm, other) = on_cube_face(face_direction(face, 2.0 * at.truncate() - 1.0));
    (within_face(stm).extend(0.0), other)
}

/// The texel of a cube at a place of a face, or beyond its edge: of the neighbour that the extended plane
/// of the face reaches there.
pub fn cube_texel(face: u32, [x, y]: [i64; 2], size: i64) -> [i64; 3] {
    if (0..size).contains(&x) && (0..size).contains(&y) {
        return [x, y, i64::from(face)];
    }
    let st = DVec2::new((2 * x + 1) as f64, (2 * y + 1) as f64) / size as f64 - 1.0;
    let (stm, other) = on_cube_face(face_direction(face, st));
    let [x, y] = (face_uv(stm) * size as f64).floor().to_array().map(|n| (n as i64).clamp(0, size - 1));
    [x, y, i64::from(other)]
}
