//! Transfer functions between stored sRGB values and linear light (IEC 61966-2-1), in f64, and the
//! table of all 8-bit values that devices and the oracle share. Domain and range are [0, 1];
//! outside it the formulas continue (negative values along the straight piece).

use std::sync::OnceLock;

/// `c / 12.92` up to 0.04045, above it `((c + 0.055) / 1.055)^2.4`.
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// `12.92 · l` up to 0.0031308, above it `1.055 · l^(1/2.4) − 0.055`.
pub fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// `table[i]` is the linear value of the stored 8-bit value `i`, rounded once to f32.
pub fn srgb8_table() -> &'static [f32; 256] {
    static TABLE: OnceLock<[f32; 256]> = OnceLock::new();
    TABLE.get_or_init(|| std::array::from_fn(|i| srgb_to_linear(i as f64 / 255.0) as f32))
}
