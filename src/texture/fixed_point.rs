//! Numbers as whole steps over their own range: what tables of sums count in, so that differences of sums are
//! exact.

/// value = least + step · code
#[derive(Clone, Copy, Debug)]
pub struct FixedPoint {
    pub least: f32,
    /// 0 where all values are one.
    pub step: f32,
    most_code: f64,
}

impl FixedPoint {
    /// `steps` of them from the least of the values to the greatest.
    pub fn over(values: impl Iterator<Item = f64>, steps: u32) -> FixedPoint {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) = values.fold(ends, |(low, high), v| (low.min(v), high.max(v)));
        let (least, most) = (least as f32, most as f32);
        let step = ((f64::from(most) - f64::from(least)) / f64::from(steps)) as f32;
        FixedPoint { least, step, most_code: 2.0 * f64::from(steps) }
    }

    /// The nearest code. Rounding of the ends may put a value just outside of them.
    pub fn code(&self, value: f64) -> u32 {
        if self.step > 0.0 {
            ((value - f64::from(self.least)) / f64::from(self.step)).round().clamp(0.0, self.most_code) as u32
        } else {
            0
        }
    }
}
