//! (texture, sampler, coordinate, footprint) → linear RGBA in f64, from the packed bytes. Twin of
//! `glsl/shared/filter.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::mapping::{Coordinate, along_cube_face, face_uv, face_uv_change, on_cube_face};
use super::rng::pcg3d;
use super::texture::{
    Level, addresses, fetch_or_border, fetch_texel, flat_texel, level_at, reduced_coordinate,
};
use crate::layout::{Sampler, Texture};
use crate::pack::{PackedScene, TextureKind};
use crate::texture::sampler_spec::{Filter, MipMode, TexelCenter};

/// The footprint in texels of level 0.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// Squares of its axes: the singular values of its Jacobian.
    pub major: f64,
    pub minor: f64,
    /// The unit vector whose combination of the two changes is the major axis.
    pub along: DVec2,
}

/// What is not a number, or endless, is as wide as the widest.
pub fn bounded(squared: f64) -> f64 {
    if squared < 1e30 { squared } else { 1e30 }
}

pub fn kind_of(image: &Texture) -> TextureKind {
    TextureKind::ALL[image.link[3] as usize]
}

/// A direction on the cube as a place on its face; a flat or solid coordinate as it is.
pub fn in_texture(image: &Texture, c: &Coordinate) -> (Coordinate, u32) {
    if kind_of(image) != TextureKind::Cube {
        return (*c, 0);
    }
    let (stm, face) = on_cube_face(c.at);
    let change = c.change.map(|d| face_uv_change(stm, along_cube_face(d, face)).extend(0.0));
    (Coordinate { at: face_uv(stm).extend(0.0), change }, face)
}

pub fn texel_spread(image: &Texture, c: &Coordinate) -> Spread {
    let depth = if kind_of(image) == TextureKind::Volume { image.link[2] } else { 0 };
    let size = DVec3::new(image.place[1].into(), image.place[2].into(), depth.into());
    let [x, y] = c.change.map(|d| d * size);
    let (xx, yy, xy) = (bounded(x.dot(x)), bounded(y.dot(y)), x.dot(y));
    let half_difference = 0.5 * (xx - yy);
    let radius = half_difference.hypot(xy);
    let major = 0.5 * (xx + yy) + radius;
    let minor = (xx * (yy / major) - xy * (xy / major)).max(0.0);
    let along = if half_difference >= 0.0 {
        DVec2::new(half_difference + radius, xy)
    } else {
        DVec2::new(xy, radius - half_difference)
    };
    Spread {
        major: bounded(major),
        minor: if minor >= 0.0 { minor } else { 0.0 },
        along: along.try_normalize().unwrap_or(DVec2::X),
    }
}

/// What a look-up of one level needs to know.
struct Reader<'a> {
    scene: &'a PackedScene,
    image: &'a Texture,
    how: &'a Sampler,
}

impl Reader<'_> {
    fn flat(&self, level: &Level, x: f64, y: f64) -> DVec4 {
        flat_texel(self.scene, self.image, self.how, level, [x as i64, y as i64])
    }

    fn linear_flat(&self, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let row = |y: f64| {
            self.flat(level, low.x, y) * (1.0 - t.x) + self.flat(level, low.x + 1.0, y) * t.x
        };
        row(low.y) * (1.0 - t.y) + row(low.y + 1.0) * t.y
    }

    fn cubic_flat(&self, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let [b, c] = [self.how.more[2], self.how.more[3]].map(|bits| f64::from(f32::from_bits(bits)));
        let (wx, wy) = (cubic_weights(t.x, b, c), cubic_weights(t.y, b, c));
        let mut sum = DVec4::ZERO;
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                sum += self.flat(level, low.x - 1.0 + i as f64, low.y - 1.0 + j as f64) * (wx * wy);
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
            sum + fetch_or_border(self.scene, self.image, self.how, level, at, 3) * w.element_product()
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
            sum += value * w;
            three += value;
        }
        sum + three * (missing / 3.0)
    }

    /// A place of one level by one filter; `dice` in [0, 1) are of the stochastic one.
    fn level(&self, filter: Filter, level: &Level, at: DVec3, face: u32, dice: DVec3) -> DVec4 {
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
            let nearest = texel.floor().to_array().map(|x| x as i64);
            return self.one_texel(kind, level, nearest, face, dice.z);
        }
        let texel = texel - 0.5;
        match kind {
            TextureKind::Cube => self.linear_cube(level, face, texel.truncate()),
            TextureKind::Volume => self.linear_volume(level, texel),
            TextureKind::Flat if filter == Filter::Cubic => self.cubic_flat(level, texel.truncate()),
            TextureKind::Flat => self.linear_flat(level, texel.truncate()),
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
            TextureKind::Flat => flat_texel(self.scene, self.image, self.how, level, [at[0], at[1]]),
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
    (face_uv(stm).extend(0.0), other)
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

/// The level on which the minor axis, full width, lies between 2^-ELLIPSE_LEVEL and twice that in texels.
const ELLIPSE_LEVEL: f64 = 0.0;
const MAX_ELLIPSE_STEPS: u32 = 8192;

/// exp(-2 r²) - exp(-2) for r² in [0, 1], as a polynomial.
pub fn ellipse_weight(squared: f64) -> f64 {
    let r = 1.0 - squared;
    r * (0.2643662 + r * (0.3266478 + r * (0.0257909 + r * 0.2473448)))
}

/// All texels of the footprint's ellipse, weighted by a Gaussian.
fn ellipse(reader: &Reader<'_>, c: &Coordinate, spread: &Spread) -> DVec4 {
    let (image, how) = (reader.image, reader.how);
    let most = f64::from(how.link[3]);
    let minor = spread.minor.max(spread.major / (most * most));
    let last = f64::from(image.link[1] - 1);
    let index = (0.5 * minor.max(1e-30).log2() + ELLIPSE_LEVEL).floor().clamp(0.0, last);
    let level = level_at(reader.scene, image, index as u32);
    let size = DVec2::new(level.size[0] as f64, level.size[1] as f64);
    let [x, y] = c.change.map(|d| d.truncate() * size);
    let scale = (size.x / f64::from(image.place[1])).powi(2);
    let mut m = DVec3::new(x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y);
    let gap = spread.major - spread.minor;
    let widen = if gap > 0.0 { (minor - spread.minor) / gap } else { 0.0 };
    m += widen * (DVec3::new(spread.major * scale, 0.0, spread.major * scale) - m);
    m *= (16.0 * most * most / (m.x + m.z)).min(1.0);
    m += DVec3::new(1.0, 0.0, 1.0);
    let determinant = m.x * m.z - m.y * m.y;
    let (a, b, d) = (m.z / determinant, -m.y / determinant, m.x / determinant);

    let [u, v, _] = addresses(how);
    let shift = if how.modes[3] == TexelCenter::Integer as u32 { 0.0 } else { 0.5 };
    let center = DVec2::new(reduced_coordinate(u, c.at.x, size.x), reduced_coordinate(v, c.at.y, size.y)) - shift;
    let reach = m.z.sqrt();
    let mut sum = DVec4::ZERO;
    let mut weights = 0.0;
    let mut steps = 0;
    let mut row = (center.y - reach).ceil();
    while row <= (center.y + reach).floor() {
        let h = row - center.y;
        let half_width = (a - (a * d - b * b) * h * h).max(0.0).sqrt() / a;
        let middle = center.x - b * h / a;
        let mut column = (middle - half_width).ceil();
        steps += 1;
        while column <= (middle + half_width).floor() && steps < MAX_ELLIPSE_STEPS {
            let offset = DVec2::new(column, row) - center;
            let squared = a * offset.x * offset.x + 2.0 * b * offset.x * offset.y + d * offset.y * offset.y;
            let weight = ellipse_weight(squared.clamp(0.0, 1.0));
            sum += reader.flat(&level, column, row) * weight;
            weights += weight;
            column += 1.0;
            steps += 1;
        }
        row += 1.0;
    }
    sum / weights.max(1e-20)
}

/// Three numbers in [0, 1) from a sample's random bits.
pub fn look_up_dice(random: [u32; 2]) -> DVec3 {
    let bits = pcg3d([random[0], random[1], 0x7E41]);
    DVec3::from_array(bits.map(|b| f64::from(b >> 8) / 16_777_216.0))
}

/// Without a footprint in the scene all is magnification.
pub fn look_up(
    scene: &PackedScene,
    image: &Texture,
    how: &Sampler,
    place: &Coordinate,
    random: [u32; 2],
) -> DVec4 {
    let reader = Reader { scene, image, how };
    let mut dice = look_up_dice(random);
    let (c, face) = in_texture(image, place);
    let mag = Filter::ALL[how.modes[2] as usize];
    if !super::footprint::is_filtered(&scene.header) {
        return reader.level(mag, &level_at(scene, image, 0), c.at, face, dice);
    }
    let spread = texel_spread(image, &c);
    let magnified = spread.major <= 1.0;
    let mode = if magnified { mag } else { Filter::ALL[how.link[1] as usize] };
    if mode == Filter::Ewa {
        return ellipse(&reader, &c, &spread);
    }
    let last = image.link[1] - 1;
    let mut probes = 1.0;
    if mode == Filter::Anisotropic {
        let most = f64::from(how.link[3]);
        let ratio = spread.major / spread.minor.max(1e-30);
        probes = (ratio.min(most * most).sqrt() - 1e-3).ceil().max(1.0);
    }
    let level = if magnified { 0.0 } else { (0.5 * (spread.major / (probes * probes)).log2()).clamp(0.0, last.into()) };
    let (low, mut rest) = match MipMode::ALL[how.link[2] as usize] {
        MipMode::None => (0.0, 0.0),
        MipMode::Nearest => ((level + 0.5).ceil() - 1.0, 0.0),
        MipMode::Linear => (level.floor(), level - level.floor()),
    };
    let mut low = low as u32;
    if mode == Filter::Stochastic {
        low += u32::from(dice.z < rest);
        rest = 0.0;
        dice.z = (dice.z * 4096.0).fract();
    }
    // Of `probes` a share `rest` reads the next level, the one between reads both.
    let share = rest * probes;
    let mut sum = DVec4::ZERO;
    for probe in 0..probes as u32 {
        let probes_less_one = probes as u32 - 1;
        // From both ends inwards.
        let order = if probe & 1 != 0 { probes_less_one - probe / 2 } else { probe / 2 };
        let way = (f64::from(order) + 0.5) / probes - 0.5;
        let mut at = c.at;
        let mut at_face = face;
        if mode == Filter::Anisotropic {
            at += way * (spread.along.x * c.change[0] + spread.along.y * c.change[1]);
            if kind_of(image) == TextureKind::Cube {
                (at, at_face) = refaced(at, face);
            }
        }
        let upper = (share - f64::from(probe)).clamp(0.0, 1.0);
        for (index, weight) in [((low + 1).min(last), upper), (low, 1.0 - upper)] {
            if weight > 0.0 {
                sum += reader.level(mode, &level_at(scene, image, index), at, at_face, dice) * (weight / probes);
            }
        }
    }
    sum
}
