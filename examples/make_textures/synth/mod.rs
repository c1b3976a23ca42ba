//! Generators of the textures in `data/textures`: `all()` returns every picture and `volumes()`
//! every volume that `cargo run --release --example make_textures` writes. A test, which includes
//! this module too, compares the files with them. Only integers and correctly rounded f64 operations
//! (+ − × ÷ √ floor) are used, so that every platform produces the same bytes.

mod axes;
mod bump;
mod coded;
mod grass;
mod lettering;
mod poster;
mod sky;
mod solid;
mod tiles;

use image::{DynamicImage, RgbImage};

/// A colour during generation, from 0 to 1 in the encoding of the file.
type Color = [f64; 3];

/// A texture file: its path below `data/textures` and its picture.
pub struct Asset {
    pub path: &'static str,
    pub image: DynamicImage,
}

/// Returns every generated texture file. (`bench/noise.png` is not among them: it is a third-party
/// test texture, committed as a file.)
pub fn all() -> Vec<Asset> {
    let mut assets = vec![
        Asset { path: "grass.png", image: grass::grass().into() },
        Asset { path: "tiles.png", image: tiles::tiles().into() },
        Asset { path: "poster.png", image: poster::poster().into() },
        Asset { path: "axes.png", image: axes::axes().into() },
        Asset { path: "sky.png", image: sky::equirectangular().into() },
        Asset { path: "sky-cross.png", image: sky::cross().into() },
        Asset { path: "studs.png", image: bump::heights().into() },
        Asset { path: "studs-normal.png", image: bump::normals().into() },
        Asset { path: "bench/checker.png", image: coded::checker().into() },
    ];
    assets.extend(coded::small());
    assets.extend(axes::cube_faces());
    assets.extend(solid::slices());
    assets
}

/// A volume file: its path below `data/textures` and its bytes.
pub struct Volume {
    pub path: &'static str,
    pub bytes: Vec<u8>,
}

/// Returns every generated volume.
pub fn volumes() -> Vec<Volume> {
    vec![Volume { path: "onion.nrrd", bytes: solid::onion() }]
}

/// Returns a hash of two integers and a seed: Wellons' `lowbias32` finaliser between additions.
fn hash(seed: u32, x: u32, y: u32) -> u32 {
    let mix = |mut h: u32| {
        h ^= h >> 16;
        h = h.wrapping_mul(0x7feb_352d);
        h ^= h >> 15;
        h = h.wrapping_mul(0x846c_a68b);
        h ^ (h >> 16)
    };
    mix(mix(mix(seed.wrapping_add(0x9e37_79b9)).wrapping_add(x)).wrapping_add(y))
}

/// Returns a uniform number in [0, 1), a multiple of 2⁻²⁴.
fn unit(seed: u32, x: u32, y: u32) -> f64 {
    f64::from(hash(seed, x, y) >> 8) / 16_777_216.0
}

/// Returns value noise in [0, 1] over the unit square with `period` lattice cells along each side,
/// which therefore repeats seamlessly; (u, v) may be anywhere.
fn noise(seed: u32, period: u32, u: f64, v: f64) -> f64 {
    let cell = |a: f64| {
        let scaled = (a - a.floor()) * f64::from(period);
        let whole = scaled.floor();
        let t = scaled - whole;
        let i = whole as u32 % period;
        (i, (i + 1) % period, t * t * (3.0 - 2.0 * t))
    };
    let ((i0, i1, s), (j0, j1, t)) = (cell(u), cell(v));
    let row = |j| lerp(unit(seed, i0, j), unit(seed, i1, j), s);
    lerp(row(j0), row(j1), t)
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

fn mix(a: Color, b: Color, t: f64) -> Color {
    [0, 1, 2].map(|c| lerp(a[c], b[c], t))
}

fn scaled(a: Color, k: f64) -> Color {
    a.map(|x| x * k)
}

fn rgb(r: u8, g: u8, b: u8) -> Color {
    [r, g, b].map(|x| f64::from(x) / 255.0)
}

/// Returns an image in which every texel is the mean of `n` × `n` values of `color`, rounded to 8
/// bits. `color` takes positions in texels, y downwards.
fn supersampled(width: u32, height: u32, n: u32, color: impl Fn(f64, f64) -> Color) -> RgbImage {
    let step = 1.0 / f64::from(n);
    RgbImage::from_fn(width, height, |i, j| {
        let mut sum = [0.0; 3];
        for s in 0..n * n {
            let x = f64::from(i) + (f64::from(s % n) + 0.5) * step;
            let y = f64::from(j) + (f64::from(s / n) + 0.5) * step;
            let sample = color(x, y);
            for c in 0..3 {
                sum[c] += sample[c];
            }
        }
        image::Rgb(sum.map(|x| to_byte(x * step * step)))
    })
}

fn to_byte(x: f64) -> u8 {
    (x * 255.0 + 0.5).floor().clamp(0.0, 255.0) as u8
}
