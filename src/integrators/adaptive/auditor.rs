//! Decides the size of the next audit and the effect of the previous ones on the aim. Input: the samples so far, and
//! the budget that the goal leaves. Output: audits, numbered so that no two share samples.

use super::audit::{Audit, audit};
use super::{Goal, Outcome};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::sampling::Pixels;

/// Ratio of an audit's samples to those of the picture; pictures with few samples have larger audits, up to this many
/// in all. In scenes known to contain something small and bright an audit must be large enough to hit it too.
const AUDIT_SHARE: f64 = 1.0 / 48.0;
const AUDIT_SHARE_OF_BRIGHT: f64 = 1.0 / 4.0;
const SMALL_AUDIT: f64 = (1u64 << 19) as f64;
const SMALL_AUDIT_OF_BRIGHT: f64 = (1u64 << 21) as f64;

/// With a fixed number of samples, an audit takes a quarter of them, or at least this many.
const LITTLE_AUDIT: f64 = (1u64 << 18) as f64;
/// An audit with fewer samples is not significant.
const MIN_AUDIT: f64 = 4096.0;
/// Fraction of the remaining time for which an audit is planned.
const OF_TIME: f64 = 0.5;

/// Decides when and how much to audit, and keeps the last result.
#[derive(Default)]
pub struct Auditor {
    rounds: u32,
    /// The number of audits that refused the goal.
    pub refusals: u32,
    /// Mean squared error by the last audit.
    mse: f64,
}

impl Auditor {
    /// Returns the samples of the next audit, after `taken` samples of the picture. The device takes `rate` samples per
    /// second, and `elapsed` seconds have passed.
    pub fn budget(&self, goal: Goal, taken: f64, bright: bool, rate: f64, elapsed: f64) -> f64 {
        let (share, least) = match bright {
            true => (AUDIT_SHARE_OF_BRIGHT, SMALL_AUDIT_OF_BRIGHT),
            false => (AUDIT_SHARE, SMALL_AUDIT),
        };
        let most = match goal {
            Goal::Seconds(limit) => OF_TIME * rate * (limit - elapsed),
            Goal::Samples(_) => (taken / 4.0).max(LITTLE_AUDIT),
            Goal::Error(_) => f64::INFINITY,
        };
        (share * f64::from(1 << self.refusals.min(3)) * taken).max(least).min(most)
    }

    /// Returns true if a picture is audited with this budget; with an error as goal it always is.
    pub fn is_due(&self, goal: Goal, budget: f64) -> bool {
        budget >= MIN_AUDIT || matches!(goal, Goal::Error(_))
    }

    pub fn audit(
        &mut self,
        pixels: &mut dyn Pixels,
        size: [u32; 2],
        budget: f64,
        outcome: &mut Outcome,
        progress: &dyn Progress,
    ) -> Result<Audit> {
        let audit = audit(pixels, size, budget, self.rounds, progress)?;
        self.rounds += 1;
        self.mse = audit.mse;
        outcome.audited_pixels += audit.pixels as u64;
        outcome.audit_samples += audit.samples as u64;
        Ok(audit)
    }

    /// Returns the factor by which the aim is lowered after audits that found more than the halves or were not certain.
    pub fn strictness(&self, noise: f64) -> f64 {
        if self.refusals == 0 {
            return 1.0;
        }
        (noise / self.mse.max(noise)) * 0.8f64.powi(self.refusals as i32 - 1)
    }
}
