//! How many samples the next audit has, and what the last ones mean for the aim. In: what was sampled so far, and
//! what the goal leaves. Out:
//! audits, numbered so that none has samples of another.

use super::audit::{Audit, Audited};
use super::{Goal, Outcome};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::sampling::Backend;

/// Samples of an audit over those of the picture; a picture of few has more, up to so many in all. Where something small
/// and bright is known to be, that is what audits must meet too.
const AUDIT_SHARE: f64 = 1.0 / 48.0;
const AUDIT_SHARE_OF_BRIGHT: f64 = 1.0 / 4.0;
const SMALL_AUDIT: f64 = (1u64 << 19) as f64;
const SMALL_AUDIT_OF_BRIGHT: f64 = (1u64 << 21) as f64;

/// Of a picture with a number of samples to keep an audit has a quarter, or so many.
const LITTLE_AUDIT: f64 = (1u64 << 18) as f64;
/// With fewer an audit says nothing.
const MIN_AUDIT: f64 = 4096.0;
/// Part of the remaining time that an audit is planned for.
const OF_TIME: f64 = 0.5;

/// When to audit, how much, and what the last audit said.
#[derive(Default)]
pub struct Auditor {
    rounds: u32,
    /// How often an audit has refused the goal.
    pub refusals: u32,
    /// Mean squared error by the last audit.
    mse: f64,
}

impl Auditor {
    /// Returns the samples of the next audit, after `taken` samples of the picture. The device takes `rate` samples a
    /// second, and `elapsed` seconds are over.
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

    /// Whether a picture is audited with so many samples: one with an error to reach always is.
    pub fn is_owed(&self, goal: Goal, budget: f64) -> bool {
        budget >= MIN_AUDIT || matches!(goal, Goal::Error(_))
    }

    pub fn audit(
        &mut self,
        audited: &Audited,
        backend: &mut dyn Backend,
        budget: f64,
        outcome: &mut Outcome,
        progress: &dyn Progress,
    ) -> Result<Audit> {
        let audit = audited.audit(backend, budget, self.rounds, progress)?;
        self.rounds += 1;
        self.mse = audit.mse;
        outcome.audited_pixels += audit.pixels as u64;
        outcome.audit_samples += audit.samples as u64;
        Ok(audit)
    }

    /// What the aim is lowered by: audits found more than the halves, or were not sure.
    pub fn strictness(&self, noise: f64) -> f64 {
        if self.refusals == 0 {
            return 1.0;
        }
        (noise / self.mse.max(noise)) * 0.8f64.powi(self.refusals as i32 - 1)
    }
}
