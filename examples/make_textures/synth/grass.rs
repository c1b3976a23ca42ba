//! A tileable lawn seen from straight above: earth, then some thousand blades drawn from the ground
//! up on a torus. A blade is a quadratic curve of tapering width that first darkens what lies
//! beneath it (its shadow) and then covers it.

use image::RgbImage;

use super::{Color, lerp, mix, noise, rgb, scaled, supersampled, unit};

const SIZE: u32 = 256;
/// Texels are drawn at this many times the resolution, then averaged.
const FINE: u32 = 3;
const BLADES: u32 = 3400;
const SEED: u32 = 0x6772_6173;

pub(super) fn grass() -> RgbImage {
    let mut lawn = Lawn::earth();
    for k in 0..BLADES {
        Blade::new(k).draw(&mut lawn, k);
    }
    let fine = f64::from(FINE);
    supersampled(SIZE, SIZE, FINE, |x, y| lawn.colors[lawn.index(x * fine, y * fine)])
}

struct Lawn {
    side: u32,
    colors: Vec<Color>,
    /// The last stroke that touched each point, so that no stroke shades a point twice.
    touched: Vec<u32>,
}

impl Lawn {
    fn earth() -> Lawn {
        let side = SIZE * FINE;
        let at = |k: u32| (f64::from(k) + 0.5) / f64::from(side);
        let colors = (0..side * side)
            .map(|p| {
                let (u, v) = (at(p % side), at(p / side));
                let clods = 0.6 * noise(SEED, 32, u, v) + 0.4 * noise(SEED + 1, 96, u, v);
                mix(rgb(58, 42, 26), rgb(142, 110, 74), clods)
            })
            .collect::<Vec<_>>();
        Lawn { side, touched: vec![u32::MAX; colors.len()], colors }
    }

    fn index(&self, x: f64, y: f64) -> usize {
        let wrap = |a: f64| (a.floor() as i64).rem_euclid(i64::from(self.side)) as usize;
        wrap(y) * self.side as usize + wrap(x)
    }
}

/// A blade, with lengths in texels.
struct Blade {
    root: [f64; 2],
    middle: [f64; 2],
    tip: [f64; 2],
    width: f64,
    color: Color,
}

impl Blade {
    /// Returns blade `k` of `BLADES`; later ones are higher, longer and lighter.
    fn new(k: u32) -> Blade {
        let r = |what: u32| unit(SEED + 2, k, what);
        let height = f64::from(k) / f64::from(BLADES);
        let side = f64::from(SIZE);
        let mut root = [r(0) * side, r(1) * side];
        // Blades avoid bare patches: a root on one is moved to another position.
        if noise(SEED + 3, 7, root[0] / side, root[1] / side) > 0.62 {
            root = [r(2) * side, r(3) * side];
        }
        let (dx, dy) = direction(r(4), r(5));
        let length = lerp(9.0, 30.0, r(6)) * lerp(0.7, 1.1, height);
        let bend = (r(7) - 0.5) * 0.7 * length;
        let middle = [root[0] + 0.5 * length * dx - bend * dy, root[1] + 0.5 * length * dy + bend * dx];
        let tip = [root[0] + length * dx, root[1] + length * dy];
        let hue = match r(8) {
            h if h < 0.45 => mix(rgb(66, 104, 30), rgb(98, 146, 44), h / 0.45),
            h if h < 0.93 => mix(rgb(98, 146, 44), rgb(158, 184, 76), (h - 0.45) / 0.48),
            h => mix(rgb(158, 150, 84), rgb(198, 182, 118), (h - 0.93) / 0.07),
        };
        let light = lerp(0.62, 1.3, height) * lerp(0.85, 1.1, r(9));
        Blade { root, middle, tip, width: lerp(0.8, 1.5, r(10)), color: scaled(hue, light) }
    }

    fn draw(&self, lawn: &mut Lawn, k: u32) {
        let shadow = |color: &mut Color, _: f64, _: f64| *color = scaled(*color, 0.66);
        self.stroke(lawn, 2 * k, [0.9, 1.3], 1.25, shadow);
        self.stroke(lawn, 2 * k + 1, [0.0, 0.0], 1.0, |color, along, across| {
            let midrib = if across > 0.0 { 1.1 } else { 0.88 };
            *color = scaled(self.color, lerp(0.62, 1.14, along) * midrib);
        });
    }

    /// Calls `paint(color, along, across)` once for each point that the blade covers, displaced by
    /// `shift` and widened by the factor `widen`; along runs from 0 to 1, across is signed.
    fn stroke(
        &self,
        lawn: &mut Lawn,
        id: u32,
        shift: [f64; 2],
        widen: f64,
        paint: impl Fn(&mut Color, f64, f64),
    ) {
        let fine = f64::from(FINE);
        let steps = 120;
        for step in 0..=steps {
            let t = f64::from(step) / f64::from(steps);
            let on_curve = |c: usize| {
                let (a, b) = (lerp(self.root[c], self.middle[c], t), lerp(self.middle[c], self.tip[c], t));
                ((lerp(a, b, t) + shift[c]) * fine, b - a)
            };
            let ((x, tx), (y, ty)) = (on_curve(0), on_curve(1));
            let radius = self.width * widen * fine * (1.0 - t * t);
            let reach = radius.floor() as i32;
            for j in -reach..=reach {
                for i in -reach..=reach {
                    let (i, j) = (f64::from(i), f64::from(j));
                    if i * i + j * j > radius * radius {
                        continue;
                    }
                    let p = lawn.index(x + i, y + j);
                    if lawn.touched[p] != id {
                        lawn.touched[p] = id;
                        paint(&mut lawn.colors[p], t, tx * j - ty * i);
                    }
                }
            }
        }
    }
}

/// Returns a unit vector for two numbers in [0, 1): the point on the square's boundary, divided by
/// its length (slightly more diagonal than uniform, which is not visible in a lawn).
fn direction(a: f64, b: f64) -> (f64, f64) {
    let (s, sign) = (2.0 * a - 1.0, if b < 0.5 { -1.0 } else { 1.0 });
    let flat = 2.0 * b - (2.0 * b).floor() < 0.5;
    let (x, y) = if flat { (s, sign) } else { (sign, s) };
    let length = (x * x + y * y).sqrt();
    (x / length, y / length)
}
