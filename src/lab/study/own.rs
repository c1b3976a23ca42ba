//! The error of a picture without that of the reference. Input: squared differences of the picture from the reference and
//! of the reference's halves from each other, by parts of the picture. Output: an RMSE with an interval.
//!
//! The picture p and the halves a and b of the reference are independent, so that the mean of (p − a)(p − b) is the squared
//! error of p alone, however noisy the halves are; it is that of (p − (a + b)/2)² less that of ((a − b)/2)².

use super::bootstrap;
use super::record::{PointRecord, ReferenceRecord};
use super::results::OwnError;

impl OwnError {
    /// Returns the error of a picture that differs from the reference by this RMSE and these parts.
    pub fn of(rmse: f64, parts: &[f32], reference: &ReferenceRecord) -> OwnError {
        let own = (rmse * rmse - reference.rmse.unwrap_or(0.0).powi(2)).max(0.0).sqrt();
        let sum: f64 = parts.iter().map(|part| f64::from(*part)).sum();
        let interval = bootstrap::sum(&less(parts, &reference.blocks), 0.95);
        let [low, high] = match interval.filter(|_| sum > 0.0) {
            Some(ends) => ends.map(|end| (end / sum).max(0.0).sqrt() * rmse),
            None => [own, own],
        };
        OwnError { rmse: own, low: low.min(own), high: high.max(own) }
    }

    /// Returns true if it can be told from none.
    pub fn is_known(&self) -> bool {
        self.low > 0.0
    }
}

impl PointRecord {
    /// Returns the error without the reference's; all of it if nothing is known of the reference.
    pub fn own(&self) -> OwnError {
        let rmse = self.errors.rmse;
        self.own.unwrap_or(OwnError { rmse, low: rmse, high: rmse })
    }

    /// Returns the squared errors of parts of the picture without the reference's; some may be below 0.
    pub(super) fn own_blocks(&self, reference: &ReferenceRecord) -> Vec<f32> {
        less(&self.blocks, &reference.blocks)
    }
}

fn less(parts: &[f32], of_reference: &[f32]) -> Vec<f32> {
    if parts.len() != of_reference.len() {
        return parts.to_vec();
    }
    parts.iter().zip(of_reference).map(|(part, own)| part - own).collect()
}
