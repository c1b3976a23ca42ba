//! A poster that does not tile: text, an arrow, a zone plate and four different corners, so that a
//! picture that is flipped, rotated, mirrored or shifted by half a texel is recognised.

use image::RgbImage;

use super::lettering::text;
use super::{Color, mix, rgb, supersampled};

const WIDTH: u32 = 256;
const HEIGHT: u32 = 192;

pub(super) fn poster() -> RgbImage {
    supersampled(WIDTH, HEIGHT, 4, color)
}

fn color(x: f64, y: f64) -> Color {
    let ink = rgb(24, 32, 56);
    let (right, bottom) = (f64::from(WIDTH) - x, f64::from(HEIGHT) - y);
    if let Some(c) = corner(x, y, right, bottom) {
        return c;
    }
    if let Some(c) = rim(x, y, right, bottom) {
        return c;
    }
    if text("MOIRE", x, y, (55.0, 15.0), 5.0) || text("UP", x, y, (22.0, 116.0), 3.0) {
        return ink;
    }
    if text("256X192", x, y, (45.0, 170.0), 2.0) {
        return rgb(150, 60, 40);
    }
    if arrow(x - 70.0, y - 66.0) {
        return mix(rgb(236, 120, 24), rgb(150, 20, 60), (y - 66.0) / 90.0);
    }
    if let Some(c) = zone_plate(x - 176.0, y - 118.0) {
        return c;
    }
    mix(rgb(250, 244, 226), rgb(196, 218, 232), y / f64::from(HEIGHT))
}

/// Returns the colour of a corner: red square top left, green triangle top right, blue disc bottom
/// left, yellow ring bottom right.
fn corner(x: f64, y: f64, right: f64, bottom: f64) -> Option<Color> {
    let side = 36.0;
    let from_center =
        |a: f64, b: f64| ((a - 0.5 * side) * (a - 0.5 * side) + (b - 0.5 * side) * (b - 0.5 * side)).sqrt();
    if x < side && y < side {
        Some(rgb(206, 32, 40))
    } else if right + y < side * 1.4 {
        Some(rgb(24, 140, 64))
    } else if from_center(x, bottom) < 14.0 {
        Some(rgb(30, 76, 200))
    } else if (7.0..14.0).contains(&from_center(right, bottom)) {
        Some(rgb(240, 192, 20))
    } else {
        None
    }
}

/// Returns the colour of the border, four texels along each side, one colour per side, which
/// clamping repeats.
fn rim(x: f64, y: f64, right: f64, bottom: f64) -> Option<Color> {
    let sides = [
        (x, rgb(24, 32, 56)),
        (right, rgb(236, 120, 24)),
        (y, rgb(20, 130, 140)),
        (bottom, rgb(150, 20, 60)),
    ];
    sides.into_iter().find(|&(distance, _)| distance < 4.0).map(|(_, color)| color)
}

/// Returns true on an arrow that points up, its tip at (0, 0), 90 texels long.
fn arrow(x: f64, y: f64) -> bool {
    let head = (0.0..38.0).contains(&y) && x.abs() < 0.72 * y;
    let shaft = (38.0..90.0).contains(&y) && x.abs() < 10.0;
    head || shaft
}

/// Returns rings whose spacing shrinks like 1/radius, down to two texels at the rim: an
/// interference pattern appears wherever it is undersampled.
fn zone_plate(x: f64, y: f64) -> Option<Color> {
    let radius = 52.0;
    let squared = x * x + y * y;
    if squared > radius * radius {
        return None;
    }
    // Ring number r²/p; rings are p/2r apart, 2 texels at the rim.
    let phase = squared / (4.0 * radius);
    let t = phase - phase.floor();
    Some(mix(rgb(252, 250, 244), rgb(24, 32, 56), if t < 0.5 { 2.0 * t } else { 2.0 - 2.0 * t }))
}
