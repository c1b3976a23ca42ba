//! How many samples the next audit has, and what the last ones mean for the aim. In: what was sampled so far. Out:
//! audits, numbered so that none has samples of another.

use super::audit::{Audit, Audited};
use super::{Outcome, Tracer};
use crate::core::error::Result;
use crate::core::progress::Progress;

/// Samples of an audit over those of the picture; a picture of few has more, up to so many in all. Where something small
/// and bright is known to be, that is what audits must meet too.
const AUDIT_SHARE: f64 = 1.0 / 48.0;
const AUDIT_SHARE_OF_BRIGHT: f64 = 1.0 / 4.0;
const SMALL_AUDIT: f64 = (1u64 << 19) as f64;
const SMALL_AUDIT_OF_BRIGHT: f64 = (1u64 << 21) as f64;

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
    /// Samples of the next audit.
    pub fn budget(&self, taken: f64, bright: bool) -> f64 {
        let (share, least) = match bright {
            true => (AUDIT_SHARE_OF_BRIGHT, SMALL_AUDIT_OF_BRIGHT),
            false => (AUDIT_SHARE, SMALL_AUDIT),
        };
        (share * f64::from(1 << self.refusals.min(3)) * taken).max(least)
    }

    pub fn audit(
        &mut self,
        audited: &Audited,
        tracer: &mut dyn Tracer,
        budget: f64,
        outcome: &mut Outcome,
        progress: &dyn Progress,
    ) -> Result<Audit> {
        let audit = audited.audit(tracer, budget, self.rounds, progress)?;
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
