//! Transfer functions between sRGB values and linear light (IEC 61966-2-1) in f64, and the tables
//! of all codes that devices and the oracle share. Domain and range are [0, 1]; outside the
//! formulas are continued (negative values along the linear segment).

use std::sync::OnceLock;

/// Returns `c / 12.92` up to 0.04045, above it `((c + 0.055) / 1.055)^2.4`.
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Returns `12.92 · l` up to 0.0031308, above it `1.055 · l^(1/2.4) − 0.055`.
pub fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Returns a table whose element `i` is the linear value of code `i` of 256 or 65536, rounded once
/// to f32.
pub fn srgb_table(codes: usize) -> &'static [f32] {
    static TABLES: [OnceLock<Vec<f32>>; 2] = [const { OnceLock::new() }; 2];
    let light = |code: usize| srgb_to_linear(code as f64 / (codes - 1) as f64) as f32;
    TABLES[usize::from(codes > 256)].get_or_init(|| (0..codes).map(light).collect())
}
