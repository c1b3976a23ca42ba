//! Fixed-point numbers over a range of values, in which summed tables count, so that differences of
//! sums are exact.

/// value = least + step · code
#[derive(Clone, Copy, Debug)]
pub struct FixedPoint {
    pub least: f32,
    /// The step, which is 0 if all values are equal.
    pub step: f32,
    most_code: f64,
}

impl FixedPoint {
    /// Returns a fixed point with `steps` steps from the smallest to the largest of the values.
    pub fn over(values: impl Iterator<Item = f64>, steps: u32) -> FixedPoint {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) = values.fold(ends, |(low, high), v| (low.min(v), high.max(v)));
        let (least, most) = (least as f32, most as f32);
        let step = ((f64::from(most) - f64::from(least)) / f64::from(steps)) as f32;
        FixedPoint { least, step, most_code: 2.0 * f64::from(steps) }
    }

    /// Returns the nearest code. Rounding of the ends may put a value slightly outside the range.
    pub fn code(&self, value: f64) -> u32 {
        if self.step > 0.0 {
            ((value - f64::from(self.least)) / f64::from(self.step)).round().clamp(0.0, self.most_code) as u32
        } else {
            0
        }
    }
}
