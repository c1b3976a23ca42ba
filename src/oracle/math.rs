//! Twin of `glsl/shared/math.glsl`: products of vectors in f64, the angle by the standard library, and the
//! shader's f32 polynomial for comparison with it.

use glam::{DVec3, DVec4};

/// Returns row.xyz · p + row.w.
pub fn affine(row: DVec4, p: DVec3) -> f64 {
    row.dot(p.extend(1.0))
}

/// Returns atan(x) for x in [0, 1] by the polynomial of `math.glsl`, in f32 and in its order.
pub fn atan_unit_f32(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 9] = [
        0.002_849_889_8,
        -0.016_068_63,
        0.042_691_52,
        -0.075_042_95,
        0.106_409_34,
        -0.142_036_44,
        0.199_926_2,
        -0.333_330_73,
        1.0,
    ];
    let y = x * x;
    COEFFICIENTS.iter().copied().reduce(|sum, c| sum * y + c).unwrap_or(0.0) * x
}

/// Returns the angle of (x, y) from +x towards +y, in [-π, π]; 0 at the origin.
pub fn atan2_accurate(y: f64, x: f64) -> f64 {
    y.atan2(x)
}

/// Returns sin(2π t).
pub fn sine_turns(t: f64) -> f64 {
    (2.0 * std::f64::consts::PI * (t - t.round_ties_even())).sin()
}

/// Returns a unit vector perpendicular to the unit vector n (Duff et al. 2017).
pub fn any_tangent(n: DVec3) -> DVec3 {
    let side = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (side + n.z);
    DVec3::new(1.0 + side * n.x * n.x * a, side * n.x * n.y * a, -side * n.x)
}
