//! A tileable floor with strong contrast: cream and terracotta octagons, dark squares where four of
//! them meet, light joints. A high-contrast regular pattern is the hardest case of aliasing near
//! the horizon.

use image::RgbImage;

use super::{Color, mix, noise, rgb, scaled, supersampled, unit};

const SIZE: u32 = 256;
/// The octagons along one side of the texture.
const CELLS: u32 = 4;
const SEED: u32 = 0x7469_6c65;

pub(super) fn tiles() -> RgbImage {
    supersampled(SIZE, SIZE, 4, |x, y| floor(x / f64::from(SIZE), y / f64::from(SIZE)))
}

fn floor(u: f64, v: f64) -> Color {
    let cell = |a: f64| {
        let scaled = a * f64::from(CELLS);
        (scaled.floor() as u32, 2.0 * (scaled - scaled.floor()) - 1.0)
    };
    let ((i, x), (j, y)) = (cell(u), cell(v));
    // Distances in half cells to the two kinds of joint: between octagons, and around the squares.
    let straight = 1.0 - x.abs().max(y.abs());
    let diagonal = (1.46 - x.abs() - y.abs()) * 0.707_106_781_186_547_5;
    let joint = 0.045;
    if diagonal.abs() < joint || (diagonal > 0.0 && straight < joint) {
        let sand = 0.5 * noise(SEED, 64, u, v) + 0.5 * noise(SEED + 1, 128, u, v);
        return mix(rgb(150, 140, 124), rgb(206, 198, 182), sand);
    }
    let (base, corner) = if diagonal < 0.0 {
        let corner = |a: u32, t: f64| if t > 0.0 { (a + 1) % CELLS } else { a };
        (rgb(38, 42, 52), (corner(i, x) + 16, corner(j, y)))
    } else if (i + j) % 2 == 0 {
        (rgb(240, 230, 206), (i, j))
    } else {
        (rgb(178, 84, 52), (i, j))
    };
    let stone = 0.9 + 0.16 * unit(SEED + 2, corner.0, corner.1);
    let cloud =
        0.5 * noise(SEED + 3, 16, u, v) + 0.3 * noise(SEED + 4, 48, u, v) + 0.2 * noise(SEED + 5, 128, u, v);
    // The bevel is lit from the upper left.
    let edge = if diagonal < 0.0 { -diagonal } else { diagonal.min(straight) } - joint;
    let lit = if edge > 0.06 {
        1.0
    } else if x + y < 0.0 {
        1.1
    } else {
        0.8
    };
    scaled(base, stone * (0.86 + 0.22 * cloud) * lit)
}
