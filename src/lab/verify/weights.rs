//! The resolution of interpolation between two texels: the bits of the filter's weight, counted as
//! distinct steps in answers along a ramp from 0 to 1, as declared by
//! `VkPhysicalDeviceLimits::subTexelPrecisionBits`.

use serde::Serialize;

/// The steps of the ramp; finer weights are reported as "at least 16 bits".
pub const RAMP_STEPS: u32 = 1 << 16;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct WeightBits {
    pub bits: u32,
    /// True if every step of the ramp gave another answer: there may be more bits.
    pub at_least: bool,
}

impl std::fmt::Display for WeightBits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", if self.at_least { "≥" } else { "" }, self.bits)
    }
}

/// Counts the bits in answers along a ramp, in any order. 2ⁿ steps are n bits; so are 2ⁿ − 1, the
/// steps of a result rounded to n bits.
pub fn weight_bits(answers: impl Iterator<Item = f32>) -> WeightBits {
    let mut values: Vec<f32> = answers.collect();
    let all = values.len();
    values.sort_by(f32::total_cmp);
    values.dedup();
    let steps = values.len().saturating_sub(1).max(1);
    WeightBits { bits: (steps as f64).log2().round() as u32, at_least: all > 2 && values.len() == all }
}
