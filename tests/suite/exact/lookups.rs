//! Lookups as sums of texels under a kernel, in rationals: tents for `linear`, the cubics of
//! Mitchell and Netravali, in two and three dimensions, all address modes, both texel centres; 8-
//! and 16-bit and sRGB texels to 256 bits.

use glam::DVec3;
use moire::internal::core::color::srgb_to_linear;
use moire::internal::lab::verify::queries::{self, Rng};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::PackedScene;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};
use moire::internal::texture::sampler_spec::{Address, CATMULL_ROM, Filter, SamplerSpec, TexelCenter};
use num_traits::{Signed, Zero};

use super::address::walked;
use super::numbers::{Q, frac, power, q};
use super::scenes::grey;
use super::{U, Worst};

const BORDER: f32 = 7.5;

fn tent(x: &Q) -> Q {
    (frac(1, 1) - x.abs()).max(Q::zero())
}

/// Mitchell & Netravali 1988, equation 8.
fn cubic(x: &Q, [b, c]: [f32; 2]) -> Q {
    let (x, b, c) = (x.abs(), q(b.into()), q(c.into()));
    let n = |k: i64| frac(k, 1);
    let cube = |c3: Q, c2: Q, c1: Q, c0: Q| (((c3 * &x + c2) * &x + c1) * &x + c0) / n(6);
    if x < n(1) {
        let c3 = n(12) - n(9) * &b - n(6) * &c;
        cube(c3, n(-18) + n(12) * &b + n(6) * &c, n(0), n(6) - n(2) * b)
    } else if x < n(2) {
        let c1 = n(-12) * &b - n(48) * &c;
        cube(-&b - n(6) * &c, n(6) * &b + n(30) * &c, c1, n(8) * b + n(24) * c)
    } else {
        Q::zero()
    }
}

/// (texel or border, weight) along one axis of the endless texture.
fn along(spec: &SamplerSpec, axis: usize, u: f64, size: u32) -> Vec<(Option<i64>, Q)> {
    let mode = [spec.address[0], spec.address[1], spec.address_w][axis];
    let middle = if spec.texel_center == TexelCenter::Integer { Q::zero() } else { frac(1, 2) };
    let place = q(u) * frac(size.into(), 1) - middle;
    let low = place.floor().to_integer();
    let low = i64::try_from(low).unwrap();
    let weight = |i: i64| {
        let x = &place - frac(i, 1);
        if spec.mag == Filter::Cubic { cubic(&x, spec.cubic) } else { tent(&x) }
    };
    (low - 1..=low + 2)
        .map(|i| (walked(mode, i, size.into()), weight(i)))
        .filter(|w| !w.1.is_zero())
        .collect()
}

fn exact(spec: &SamplerSpec, size: [u32; 3], texels: &[f32], at: DVec3) -> Q {
    let [columns, rows, slices] = [0, 1, 2].map(|axis| match size[axis] {
        1 if axis == 2 => vec![(Some(0), frac(1, 1))],
        n => along(spec, axis, at[axis], n),
    });
    let mut sum = Q::zero();
    for (z, wz) in &slices {
        for (y, wy) in &rows {
            for (x, wx) in &columns {
                let texel = match (x, y, z) {
                    (Some(x), Some(y), Some(z)) => {
                        texels[((z * i64::from(size[1]) + y) * i64::from(size[0]) + x) as usize]
                    }
                    _ => BORDER,
                };
                sum += wx * wy * wz * q(texel.into());
            }
        }
    }
    sum
}

fn specs(flat: bool) -> Vec<SamplerSpec> {
    let mut all = Vec::new();
    let filters =
        [(Filter::Linear, CATMULL_ROM), (Filter::Cubic, CATMULL_ROM), (Filter::Cubic, [1.0 / 3.0; 2])];
    for (i, &u) in Address::ALL.iter().enumerate() {
        for (j, &(mag, cubic)) in filters.iter().take(if flat { 3 } else { 1 }).enumerate() {
            let texel_center = TexelCenter::ALL[(i + j) % 2];
            let [v, w] = [1, 2].map(|k| Address::ALL[(i + k) % 5]);
            let border_color = [BORDER; 4];
            all.push(SamplerSpec {
                address: [u, v],
                address_w: w,
                mag,
                min: mag,
                cubic,
                texel_center,
                border_color,
                ..Default::default()
            });
        }
    }
    all
}

fn read(scene: &PackedScene, sampler: usize, at: DVec3) -> f64 {
    let place = Coordinate { at, ..Default::default() };
    sample_texture(scene, &scene.records.textures[0], &scene.records.samplers[sampler], &place, [3, 4]).x
}

fn compare(read: impl Fn(&PackedScene, usize, DVec3) -> f64) -> Worst {
    let mut worst = Worst::default();
    let mut rng = Rng::new(91);
    let sizes = [[4, 3, 1], [8, 8, 1], [1, 5, 1], [3, 4, 5]];
    for size in sizes {
        let count = size.iter().product::<u32>();
        let texels: Vec<f32> = (0..count).map(|_| rng.between(-2.0, 6.0) as f32).collect();
        let flat = size[2] == 1;
        let dimension = if flat { Dimension::Two } else { Dimension::Three };
        let specs = specs(flat);
        let pairs: Vec<_> = (0..specs.len()).map(|s| (0, s)).collect();
        let scene = queries::pairs(vec![grey(dimension, size, &texels)], &specs, &pairs).unwrap();
        for (s, spec) in specs.iter().enumerate() {
            for i in 0..10 {
                let reach = [0.6, 3.0, 1.0][i % 3];
                let at = match i {
                    0 => DVec3::ZERO,
                    1 => DVec3::new(0.5, 1.0, -0.25),
                    2 => DVec3::new(-1e-9, 1.0 + 1e-9, 0.5),
                    _ => super::numbers::vector(&mut rng, reach) + 0.5,
                };
                // Within three textures; a place is rounded twice, a sum of 64 products of weights each time.
                let at = at.clamp(DVec3::splat(-1.9), DVec3::splat(2.9));
                let longest = f64::from(*size.iter().max().unwrap());
                let bound = 10.0 * U * (8.0 * longest + 40.0);
                worst.add(read(&scene, s, at), &exact(spec, size, &texels, at), bound);
            }
        }
    }
    worst
}

#[test]
fn linear_and_cubic_look_ups_are_the_sums_of_their_kernels() {
    compare(read).holds("look-ups");
}

#[test]
fn planted_errors_of_look_ups_are_told() {
    compare(|scene, s, at| read(scene, s, at + DVec3::splat(0.5 / 8.0))).fails("half a texel");
    compare(|scene, s, at| read(scene, s, at + 1e-12)).fails("a trillionth of a texture");
    compare(|scene, s, at| read(scene, s, DVec3::new(at.y, at.x, at.z))).fails("swapped axes");
    let other = |scene: &PackedScene, s: usize, at| {
        let mut scene = scene.clone();
        let center = &mut scene.records.samplers[s].texel_center;
        *center = match *center {
            TexelCenter::Half => TexelCenter::Integer,
            TexelCenter::Integer => TexelCenter::Half,
        };
        read(&scene, s, at)
    };
    compare(other).fails("the other texel centre");
}

/// Integers over their largest value, and sRGB's curve (IEC 61966-2-1).
fn texels(decode: impl Fn(f64) -> f64) -> Worst {
    let mut worst = Worst::default();
    for byte in 0..=255u8 {
        let linear = frac(byte.into(), 255);
        let encoded = f64::from(byte) / 255.0;
        let exact = if linear <= frac(4045, 100_000) {
            linear / frac(1292, 100)
        } else {
            power(&((linear + frac(55, 1000)) / frac(1055, 1000)), &frac(12, 5))
        };
        worst.add(decode(encoded), &exact, 2.4 * 6.0 * U); // 6 roundings, to the power of 2.4
    }
    worst
}

#[test]
fn stored_texels_are_the_fractions_and_powers_that_they_stand_for() {
    texels(srgb_to_linear).holds("sRGB");
    texels(|x| x.powf(2.2)).fails("a power of 2.2");
    let nearest = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    let formats = [(TexelFormat::Grey8, 255), (TexelFormat::Grey16, 65535)];
    for (format, most) in formats {
        let data = queries::texture(16, 16, format, ColorSpace::Linear, 5);
        let stored: Vec<i64> = match most {
            255 => data.texels.iter().map(|&b| b.into()).collect(),
            _ => data.texels.chunks(2).map(|b| u16::from_ne_bytes([b[0], b[1]]).into()).collect(),
        };
        let scene = queries::pairs(vec![data], &[nearest], &[(0, 0)]).unwrap();
        let mut worst = Worst::default();
        for (i, code) in stored.into_iter().enumerate() {
            let at = DVec3::new((i % 16) as f64 + 0.5, (i / 16) as f64 + 0.5, 0.0) / 16.0;
            worst.add(read(&scene, 0, at), &frac(code, most), U);
        }
        worst.holds("integer texels");
    }
}
