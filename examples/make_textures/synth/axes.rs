//! Textures that show their own coordinates: a square of 4 × 4 cells, each with the digits of its u
//! and its v, the u axis red and the v axis green, v growing upwards; and six faces of a cube with
//! their names.

use image::RgbImage;

use super::lettering::text;
use super::{Asset, Color, mix, rgb, scaled, supersampled};

const SIDE: f64 = 256.0;
const CELL: f64 = 64.0;
const INK: Color = [0.09, 0.12, 0.2];

pub(super) fn axes() -> RgbImage {
    supersampled(256, 256, 3, color)
}

fn color(x: f64, y: f64) -> Color {
    let up = SIDE - y;
    if let Some(axis) = axis(x, up) {
        return axis;
    }
    let (column, row) = ((x / CELL).floor(), (up / CELL).floor());
    let digits = ["0", "1", "2", "3"];
    let (left, top) = (column * CELL, SIDE - (row + 1.0) * CELL);
    let digit = |value: f64, shift: f64| text(digits[value as usize], x, y, (left + shift, top + 18.0), 4.0);
    if digit(column, 12.0) {
        return rgb(196, 30, 36);
    }
    if digit(row, 36.0) {
        return rgb(10, 110, 50);
    }
    let edge = (x - left).min(y - top).min(left + CELL - x).min(top + CELL - y);
    if edge < 1.0 {
        return rgb(120, 124, 132);
    }
    let ground = mix(
        mix(rgb(235, 235, 240), rgb(250, 186, 150), column / 3.0),
        mix(rgb(150, 200, 250), rgb(255, 222, 110), column / 3.0),
        row / 3.0,
    );
    if (column + row) % 2.0 == 0.0 { ground } else { scaled(ground, 0.86) }
}

/// Returns the colour of the axes: along the lower edge red, with an arrowhead at its end and a U;
/// along the left edge green, with a V.
fn axis(x: f64, up: f64) -> Option<Color> {
    let arrow = |along: f64, across: f64| {
        let head = (SIDE - 22.0..SIDE).contains(&along) && across < 0.55 * (SIDE - along);
        across < 5.0 || head
    };
    if arrow(x, up) && x >= up {
        return Some(rgb(214, 40, 44));
    }
    if arrow(up, x) {
        return Some(rgb(20, 150, 66));
    }
    let y = SIDE - up;
    (text("U", x, y, (219.0, 239.5), 1.5) || text("V", x, y, (16.0, 3.0), 1.5)).then_some(INK)
}

/// Returns the faces in file orientation: the name upright, a wedge that points along growing u.
pub(super) fn cube_faces() -> Vec<Asset> {
    const FACES: [(&str, &str, [u8; 3]); 6] = [
        ("cube/px.png", "+X", [240, 110, 100]),
        ("cube/nx.png", "-X", [150, 220, 225]),
        ("cube/py.png", "+Y", [150, 215, 120]),
        ("cube/ny.png", "-Y", [225, 150, 225]),
        ("cube/pz.png", "+Z", [120, 160, 245]),
        ("cube/nz.png", "-Z", [240, 215, 110]),
    ];
    let face = |(path, name, [r, g, b]): (&'static str, &str, [u8; 3])| {
        let image = supersampled(64, 64, 2, |x, y| {
            let edge = x.min(y).min(64.0 - x).min(64.0 - y);
            let wedge = (6.0..22.0).contains(&x) && (y - 54.0).abs() < 0.35 * (22.0 - x);
            if edge < 1.5 || text(name, x, y, (10.0, 14.0), 4.0) || wedge { INK } else { rgb(r, g, b) }
        });
        Asset { path, image: image.into() }
    };
    FACES.map(face).into()
}
