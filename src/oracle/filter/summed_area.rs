//! The mean over a box from a summed-area table. Twin of `glsl/shared/filter/summed_area.glsl`.

use glam::{DVec2, DVec4};

use crate::oracle::address::reduced_coordinate;
use crate::oracle::mapping::Coordinate;
use crate::oracle::texture::addresses;
use crate::pack::PackedScene;
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Address, TexelCenter};

/// An interval of texels that represents a part of the box along one axis, and the length of that part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    pub from: f64,
    pub to: f64,
    pub amount: f64,
}

/// Splits the box along one axis into up to three parts; the rest of the box is border.
pub fn axis_parts(mode: Address, from: f64, to: f64, size: f64) -> [Part; 3] {
    let mut parts = [Part::default(); 3];
    let whole = |from: f64, to: f64| Part { from, to, amount: to - from };
    let inside = |x: f64| x.clamp(0.0, size);
    let below = (to.min(0.0) - from).max(0.0);
    let above = (to - from.max(size)).max(0.0);
    match mode {
        Address::Repeat => {
            // Whole periods, whose sum is the same from any start, and the remainder.
            let periods = ((to - from) / size).floor() * size;
            let start = inside(from - (from / size).floor() * size);
            let end = start + inside(to - from - periods);
            parts[0] = whole(start, end.min(size));
            parts[1] = whole(0.0, (end - size).max(0.0));
            parts[2] = Part { from: 0.0, to: size, amount: periods };
        }
        Address::MirroredRepeat => {
            let periods = ((to - from) / (2.0 * size)).floor() * 2.0 * size;
            let width = (to - from - periods).clamp(0.0, 2.0 * size);
            let start = (from - (from / (2.0 * size)).floor() * 2.0 * size).clamp(0.0, 2.0 * size);
            let first = (start / size).floor();
            for (k, part) in parts.iter_mut().enumerate() {
                let tile = first + k as f64;
                let (a, b) = (inside(start - tile * size), inside(start + width - tile * size));
                *part = if (0.5 * tile).fract() != 0.0 { whole(size - b, size - a) } else { whole(a, b) };
            }
            // Of three tiles the middle one is whole; if there are two, the third part is free.
            if parts[2].amount > 0.0 {
                parts[1].amount += periods;
            } else {
                parts[2] = Part { from: 0.0, to: size, amount: periods };
            }
        }
        Address::ClampToBorder => parts[0] = whole(inside(from), inside(to)),
        Address::ClampToEdge => {
            parts[0] = whole(inside(from), inside(to));
            parts[1] = Part { from: 0.0, to: 1.0, amount: below };
            parts[2] = Part { from: size - 1.0, to: size, amount: above };
        }
        Address::MirrorClampToEdge => {
            parts[0] = whole(inside(from), inside(to));
            parts[1] = whole(inside(-to), inside(-from));
            parts[2] = Part { from: size - 1.0, to: size, amount: above + below - parts[1].amount };
        }
    }
    parts
}

/// The table of one channel.
struct Table<'a> {
    words: &'a [u8],
    width: usize,
    last: DVec2,
}

impl Table<'_> {
    fn sum(&self, x: f64, y: f64) -> i128 {
        let at = 8 * (y as usize * (self.width + 1) + x as usize);
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&self.words[at..at + 8]);
        i128::from(u64::from_ne_bytes(bytes))
    }

    /// Returns the sum over [from, to], in steps of the fixed point.
    fn rectangle(&self, from: DVec2, to: DVec2) -> f64 {
        let (i0, i1) = (from.floor().min(self.last), to.floor().min(self.last));
        let (first, end) = (1.0 - (from - i0), to - i1);
        let lines = |a: f64, b: f64| [a, a + 1.0, b, b + 1.0];
        let (xs, ys) = (lines(i0.x, i1.x), lines(i0.y, i1.y));
        let (wx, wy) = ([first.x, 1.0, end.x], [first.y, 1.0, end.y]);
        let mut sum = 0.0;
        for r in 0..3 {
            for k in 0..3 {
                let row = |y: f64| self.sum(xs[k + 1], y) - self.sum(xs[k], y);
                sum += wx[k] * wy[r] * (row(ys[r + 1]) - row(ys[r])) as f64;
            }
        }
        sum
    }
}

/// Returns the mean; `place` is a coordinate of a 2D texture that has a table.
pub fn summed_area(scene: &PackedScene, image: &Texture, how: &Sampler, place: &Coordinate) -> DVec4 {
    let table = scene.level_word(image.first_word, image.levels) as usize * 4;
    let word = |i: usize| {
        let b = &scene.texels[table + 4 * i..table + 4 * i + 4];
        u32::from_ne_bytes([b[0], b[1], b[2], b[3]])
    };
    let [least, step] = [word(0), word(1)].map(|bits| f64::from(f32::from_bits(bits)));
    let channels = word(2) as usize;
    let [width, height] = [image.size.x, image.size.y].map(|n| n as usize);
    let wide = DVec2::new(width as f64, height as f64);
    let extent = 0.5 * (place.change[0].abs() + place.change[1].abs()).truncate() * wide;
    let reach = extent.clamp(DVec2::splat(0.5), wide * 1e6);
    let [mode_u, mode_v, _] = addresses(how);
    let shift = if how.texel_center == TexelCenter::Integer { 0.5 } else { 0.0 };
    let center = DVec2::new(
        reduced_coordinate(mode_u, place.at.x, wide.x),
        reduced_coordinate(mode_v, place.at.y, wide.y),
    ) + shift;
    let us = axis_parts(mode_u, center.x - reach.x, center.x + reach.x, wide.x);
    let vs = axis_parts(mode_v, center.y - reach.y, center.y + reach.y, wide.y);
    // The part of the box that is not border, as fractions, since the amounts may be large.
    let [inside_u, inside_v] = [us, vs].map(|parts| parts.iter().map(|p| p.amount).sum::<f64>());
    let mut sum = DVec4::ZERO;
    for u in us {
        for v in vs {
            if u.amount <= 0.0 || v.amount <= 0.0 {
                continue;
            }
            let share = (u.amount / inside_u) * (v.amount / inside_v);
            let (from, to) = (DVec2::new(u.from, v.from), DVec2::new(u.to, v.to));
            let area = (to - from).element_product();
            let mean = |c: usize| {
                let first = table + 12 + c * 8 * (width + 1) * (height + 1);
                let table = Table { words: &scene.texels[first..], width, last: wide - 1.0 };
                least + step * (table.rectangle(from, to) / area)
            };
            let value = match channels {
                1 => DVec4::new(mean(0), mean(0), mean(0), 1.0),
                2 => DVec4::new(mean(0), mean(0), mean(0), mean(1)),
                _ => DVec4::new(mean(0), mean(1), mean(2), mean(3)),
            };
            sum += share * value;
        }
    }
    // The part that an axis with a border does not cover.
    let share = |mode: Address, inside: f64, width: f64| match mode {
        Address::ClampToBorder => inside / width,
        _ => 1.0,
    };
    let covered = share(mode_u, inside_u, 2.0 * reach.x) * share(mode_v, inside_v, 2.0 * reach.y);
    how.border.as_dvec4().lerp(sum, covered)
}
