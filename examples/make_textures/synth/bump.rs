//! One height field twice: as heights for a bump map and as normals for a normal map. It has 4 × 4
//! round studs per tile.

use image::{GrayImage, Luma, Rgb, RgbImage};

use super::to_byte;

const SIZE: u32 = 128;
const STUDS: f64 = 4.0;
/// The height of a stud over the width of the tile.
const TALL: f64 = 0.05;

/// Returns the height map. White is a stud's top, `TALL` times the tile's width above black.
pub(super) fn heights() -> GrayImage {
    GrayImage::from_fn(SIZE, SIZE, |i, j| Luma([to_byte(stud(i, j).0)]))
}

/// Returns the normal map (n + 1) / 2 with n to the right, upwards (growing v with `flip_v`) and
/// outwards.
pub(super) fn normals() -> RgbImage {
    RgbImage::from_fn(SIZE, SIZE, |i, j| {
        let (_, slope) = stud(i, j);
        let n = [-TALL * slope[0], TALL * slope[1], 1.0];
        let length = n.iter().map(|a| a * a).sum::<f64>().sqrt();
        Rgb(n.map(|a| to_byte(0.5 + 0.5 * a / length)))
    })
}

/// Returns height from 0 to 1 and slope along u and v: (1 − r²)² within the stud's radius.
fn stud(i: u32, j: u32) -> (f64, [f64; 2]) {
    let place = |a: u32| {
        let scaled = (f64::from(a) + 0.5) / f64::from(SIZE) * STUDS;
        (scaled - scaled.floor() - 0.5) / 0.4
    };
    let (x, y) = (place(i), place(j));
    let inner = (1.0 - x * x - y * y).max(0.0);
    let slope = |a: f64| -4.0 * inner * a * STUDS / 0.4;
    (inner * inner, [slope(x), slope(y)])
}
