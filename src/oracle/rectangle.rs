//! Samples a rectangle uniformly in solid angle from a point: Ureña, Fajardo & King 2013, "An Area-Preserving
//! Parametrization for Spherical Rectangles", in a form that is stable in f32. Twin of `glsl/shared/rectangle.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::math::atan2_accurate;

/// A smaller solid angle is too flat for f32, whose angles are off by 1.6e-7, and sampling its area is as good.
pub const MIN_SOLID_ANGLE: f64 = 1.0 / 1024.0;

/// Returns y₁ r₀ - y₀ r₁, where r² = y² + d².
fn height_gap(y: [f64; 2], [r0, r1]: [f64; 2], squared: f64) -> f64 {
    let sum = y[1] * r0 + y[0] * r1;
    if y[0] > 0.0 { squared * ((y[1] - y[0]) * (y[1] + y[0])) / sum } else { y[1] * r0 - y[0] * r1 }
}

/// Returns the solid angle of the half strip between x = 0 and x, as sine and cosine times a length; r are the
/// distances of its corners.
fn half_strip(x: f64, y: [f64; 2], z: f64, r: [f64; 2]) -> DVec2 {
    let gap = height_gap(y, r, x * x + z * z);
    DVec2::new(x * z * gap, z * z * r[0] * r[1] + x * x * y[0] * y[1])
}

/// Returns the same for the quarter plane beyond x > 0 between 0 and y; l = y² + z², r² = l + x².
fn beyond(x: f64, y: f64, z: f64, l: f64, r: f64) -> DVec2 {
    DVec2::new(y * z * l, (r + x) * (z * z * r + x * y * y))
}

/// Returns the angle of a less that of b.
fn angle_between(a: DVec2, b: DVec2) -> f64 {
    atan2_accurate(a.x * b.y - b.x * a.y, b.y * a.y + b.x * a.x)
}

/// Takes the `middle` of the rectangle along its edges, `half_sides`, and the `height` of the point above its plane.
/// Returns the sample along the edges and below the point, and the solid angle.
pub fn on_rectangle(middle: DVec2, half_sides: DVec2, height: f64, square: DVec2) -> (DVec3, f64) {
    let size = middle.abs() + half_sides;
    let reach = size.max_element().max(height);
    let z = height / reach;
    let flipped = middle.cmplt(DVec2::ZERO);
    let rest = DVec2::select(flipped, square, 1.0 - square);
    let (low, high) = ((middle.abs() - half_sides) / reach, size / reach);
    let (x, y) = ([low.x, high.x], [low.y, high.y]);
    let l = y.map(|y| y * y + z * z);
    let [near, far] = x.map(|x| l.map(|l| (x * x + l).sqrt()));
    let solid_angle = angle_between(half_strip(x[1], y, z, far), half_strip(x[0], y, z, near));
    // It exceeds half of all directions only if the rectangle extends to both sides.
    let solid_angle = solid_angle + if x[0] < 0.0 && solid_angle < 0.0 { 2.0 * PI } else { 0.0 };

    // Twice the half is the solid angle beyond the sample in the infinite strip. With T that of the strip from x = 0 to
    // the sample and B to its end, x / z is sin T over the root of (cos T - cos B) (cos T + cos C), where C is the sum
    // of the strip's angles; here as products, without the distances that cancel.
    let outside = angle_between(beyond(x[1], y[1], z, l[1], far[1]), beyond(x[1], y[0], z, l[0], far[0]));
    let (s, t) = (0.5 * (outside + rest.x * solid_angle)).sin_cos();
    let (sine_b, cosine_b) = (z * (y[1] - y[0]), z * z + y[0] * y[1]);
    let sine = sine_b * (1.0 - 2.0 * s * s) - cosine_b * (2.0 * s * t);
    let squared = (sine_b * t - cosine_b * s) * s * ((z * t + y[1] * s) * (z * t - y[0] * s));
    let along = (0.5 * z * sine / squared.max(1e-30).sqrt()).clamp(x[0], x[1]);

    // Sines of the angles to the sample's ends, less than 1 by e.
    let d = along * along + z * z;
    let r = y.map(|y| (d + y * y).sqrt());
    let e1 = d / (r[1] * (r[1] + y[1]));
    let e0 = if y[0] > 0.0 { d / (r[0] * (r[0] + y[0])) } else { 1.0 - y[0] / r[0] };
    let e = e1 + rest.y * (e0 - e1);
    let across = ((1.0 - e) * (d / (e * (2.0 - e)).max(1e-30)).sqrt()).clamp(y[0], y[1]);
    let place = DVec2::new(along, across);
    (DVec2::select(flipped, -place, place).extend(-z) * reach, solid_angle)
}
