//! A sky around the origin as a function of direction: a sun, clouds, a paved ground, and the name
//! of each axis in its direction, upright as seen from inside. The same sky is generated as an
//! equirectangular picture and as a horizontal cross, so that a scene looks the same with either.

use image::RgbImage;

use super::lettering::text;
use super::{Color, mix, noise, rgb, supersampled};

const SEED: u32 = 0x736b_7921;
/// The side of a face of the cross.
const FACE: u32 = 72;
const SUN: [f64; 3] = [0.48, 0.6, -0.64];
const PI: f64 = std::f64::consts::PI;

/// Returns the equirectangular picture: the centre looks along −z, +x is to its right, +y at the
/// top.
pub(super) fn equirectangular() -> RgbImage {
    supersampled(288, 144, 3, |x, y| {
        let (sin_turn, cos_turn) = sin_cos(2.0 * PI * (x / 288.0 - 0.5));
        let (sin_tilt, cos_tilt) = sin_cos(PI * y / 144.0);
        sky([sin_tilt * sin_turn, cos_tilt, -sin_tilt * cos_turn])
    })
}

/// Returns the cross with faces by Vulkan's table (Vulkan 1.3, "Cube Map Face Selection") and black
/// cells beside them.
pub(super) fn cross() -> RgbImage {
    supersampled(4 * FACE, 3 * FACE, 3, |x, y| {
        let face = f64::from(FACE);
        let (column, row) = ((x / face).floor(), (y / face).floor());
        let s = 2.0 * (x / face - column) - 1.0;
        let t = 2.0 * (y / face - row) - 1.0;
        match (column as u32, row as u32) {
            (2, 1) => sky([1.0, -t, -s]),
            (0, 1) => sky([-1.0, -t, s]),
            (1, 0) => sky([s, 1.0, t]),
            (1, 2) => sky([s, -1.0, -t]),
            (1, 1) => sky([s, -t, 1.0]),
            (3, 1) => sky([-s, -t, -1.0]),
            _ => [0.0; 3],
        }
    })
}

fn sky(direction: [f64; 3]) -> Color {
    let length = direction.iter().map(|a| a * a).sum::<f64>().sqrt();
    let d = direction.map(|a| a / length);
    if named(d) {
        return rgb(30, 24, 60);
    }
    if d[1] < 0.0 {
        return ground(d);
    }
    let sun = d[0] * SUN[0] + d[1] * SUN[1] + d[2] * SUN[2];
    let blue = mix(rgb(196, 220, 240), rgb(40, 92, 190), d[1].sqrt());
    let glow = mix(blue, rgb(255, 246, 214), 0.8 * smooth(0.85, 1.0, sun));
    // A layer of clouds over a flat ground, thinner towards the horizon.
    let (u, v) = (0.05 * d[0] / (d[1] + 0.12), 0.05 * d[2] / (d[1] + 0.12));
    let puffs = 0.6 * noise(SEED, 16, u, v) + 0.4 * noise(SEED + 1, 48, u, v);
    let clouded = mix(glow, rgb(250, 250, 252), 0.85 * smooth(0.5, 0.8, puffs) * smooth(0.0, 0.3, d[1]));
    mix(clouded, rgb(255, 252, 230), smooth(0.985, 0.99, sun))
}

/// Returns slabs one unit wide on the plane y = −1, fading into the haze of the horizon.
fn ground(d: [f64; 3]) -> Color {
    let (x, z) = (d[0] / -d[1].min(-1e-9), d[2] / -d[1].min(-1e-9));
    let odd = (x.floor() + z.floor()) - 2.0 * (0.5 * (x.floor() + z.floor())).floor() > 0.5;
    let slab = if odd { rgb(148, 126, 100) } else { rgb(112, 92, 74) };
    mix(rgb(176, 172, 158), slab, smooth(0.05, 0.45, -d[1]))
}

/// Returns true on the name of the axis nearest to `d`, which is about 25 degrees wide; right is
/// forward × up.
fn named(d: [f64; 3]) -> bool {
    let [x, y, z] = d;
    let a = d.map(f64::abs);
    let (name, right, up, along) = if a[2] >= a[0] && a[2] >= a[1] {
        if z > 0.0 { ("+Z", -x, y, a[2]) } else { ("-Z", x, y, a[2]) }
    } else if a[1] >= a[0] {
        if y > 0.0 { ("+Y", x, z, a[1]) } else { ("-Y", x, -z, a[1]) }
    } else if x > 0.0 {
        ("+X", z, y, a[0])
    } else {
        ("-X", -z, y, a[0])
    };
    text(name, right / along, -up / along, (-0.22, -0.14), 0.04)
}

fn smooth(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns sine and cosine by Taylor series for |angle| ≤ π: library functions may differ between
/// platforms.
fn sin_cos(angle: f64) -> (f64, f64) {
    let (mut sin, mut cos, mut term) = (0.0, 0.0, 1.0);
    for k in 0..24 {
        match k % 4 {
            0 => cos += term,
            1 => sin += term,
            2 => cos -= term,
            _ => sin -= term,
        }
        term *= angle / f64::from(k + 1);
    }
    (sin, cos)
}
