//! Decides when it pays to resolve pixels without samples. Input: the state of sampling, and the result of a pilot run
//! on a part of the picture. Output: resolved pixels, which have no variance and gain no samples.

use super::Goal;
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::sampling::{PilotRun, Pixels};

/// Seconds of sampling that must remain for a pilot run to be worth compiling its pipeline; and with a time as the goal,
/// of which compiling takes none, to be worth the run.
const WORTH_A_PILOT: f64 = 1.0;
const WORTH_A_PILOT_OF_TIME: f64 = 0.3;
/// Passes before the time until an error can be predicted: a single one does not show how the error falls.
const PASSES: u32 = 2;
/// Ratio of the time that resolving may take to the pilot run's prediction: parts of a picture differ. Small parts take
/// longer than they should, so that less is enough to keep within a time.
const MARGIN: f64 = 1.5;
const MARGIN_OF_TIME: f64 = 1.15;
/// RMSE of pixels resolved by beams. A goal of less than twice this value is left to samples.
pub const OWN_ERROR: f64 = 5e-5;

/// The state of sampling, and the time that it would still take.
#[derive(Clone, Copy, Debug)]
pub struct Outlook {
    pub goal: Goal,
    pub passes: u32,
    /// Seconds of sampling so far, and the current mean squared error.
    pub elapsed: f64,
    pub mse: f64,
    /// The exponent with which the error falls with the number of samples.
    pub exponent: f64,
    /// Seconds that sampling alone would still take.
    pub left: f64,
}

impl Outlook {
    /// Returns the seconds that sampling alone would still take; `needed` are those until an error is reached.
    pub fn left(goal: Goal, elapsed: f64, needed: f64) -> f64 {
        match goal {
            Goal::Samples(_) => 0.0,
            Goal::Error(_) => needed.max(0.0),
            Goal::Seconds(limit) => (limit - elapsed).max(0.0),
        }
    }

    fn is_worth_a_pilot(&self) -> bool {
        let far_enough = !matches!(self.goal, Goal::Error(rmse) if rmse < 2.0 * OWN_ERROR);
        let (passes, worth) = match self.goal {
            Goal::Seconds(_) => (1, WORTH_A_PILOT_OF_TIME),
            _ => (PASSES, WORTH_A_PILOT),
        };
        far_enough && self.passes >= passes && self.left > worth
    }

    /// Returns true if resolving pixels and sampling the others reaches the goal sooner, or comes nearer to it. `cost`
    /// and `error` are the resolved pixels' shares of the remaining samples and of the squared error.
    fn gains(&self, seconds: f64, cost: f64, error: f64) -> bool {
        if let Goal::Error(_) = self.goal {
            return seconds < cost * self.left;
        }
        let rest = self.left - seconds;
        if rest <= 0.0 {
            return false;
        }
        // All remaining time goes to the other pixels.
        let fall = |seconds: f64, share: f64| {
            (1.0 + seconds / (self.elapsed * share.max(1e-3))).powf(-self.exponent)
        };
        self.mse * (1.0 - error) * fall(rest, 1.0 - cost) + OWN_ERROR.powi(2)
            < self.mse * fall(self.left, 1.0)
    }
}

/// The decision whether pixels are resolved.
#[derive(Default)]
pub struct Resolution {
    is_done: bool,
    /// The pilot run, once it was made; `Some(None)` if pixels cannot be resolved at all.
    pilot: Option<Option<PilotRun>>,
}

impl Resolution {
    /// Resolves the pixels if that pays: decided by one pilot run, whose result is weighed again after each pass.
    pub fn resolve(
        &mut self,
        pixels: &mut dyn Pixels,
        whole: Rect,
        outlook: &Outlook,
        progress: &dyn Progress,
    ) -> Result<bool> {
        if self.is_done || pixels.backend().prefilters() || !outlook.is_worth_a_pilot() {
            return Ok(false);
        }
        if self.pilot.is_none() {
            self.pilot = Some(pixels.backend().pilot(progress)?);
        }
        let Some(Some(pilot)) = &self.pilot else { return Ok(false) };
        let [cost, error] = pixels.shares(pilot, outlook.exponent)?;
        let margin = if let Goal::Seconds(_) = outlook.goal { MARGIN_OF_TIME } else { MARGIN };
        if !outlook.gains(margin * pilot.seconds, cost, error) {
            return Ok(false);
        }
        let resolved = pixels.backend().resolve(whole, progress)?;
        pixels.resolve(resolved)?;
        self.is_done = true;
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outlook(goal: Goal, left: f64) -> Outlook {
        Outlook { goal, passes: 2, elapsed: 0.5, mse: 1e-4, exponent: 1.3, left }
    }

    #[test]
    fn an_error_is_met_by_what_takes_less_time() {
        let of = outlook(Goal::Error(2e-4), 10.0);
        assert!(of.is_worth_a_pilot());
        assert!(of.gains(2.0, 1.0, 1.0), "all pixels resolved in a fifth of the time");
        assert!(!of.gains(2.0, 0.1, 0.1), "nine tenths of the samples are still to be taken");
        assert!(!of.gains(11.0, 1.0, 1.0), "resolving takes longer");
    }

    #[test]
    fn a_time_is_spent_on_what_leaves_less_error() {
        let of = outlook(Goal::Seconds(4.0), 3.5);
        assert!(of.gains(2.0, 1.0, 1.0));
        assert!(!of.gains(2.0, 0.05, 0.05));
        assert!(!of.gains(3.6, 1.0, 1.0), "not in the time that is left");
        let nearly = Outlook { mse: 1e-9, ..of };
        assert!(!nearly.gains(2.0, 1.0, 1.0), "samples err less than what is resolved");
    }

    #[test]
    fn goals_soon_met_or_below_what_beams_resolve_are_for_samples() {
        assert!(!outlook(Goal::Error(2e-3), 0.2).is_worth_a_pilot());
        assert!(!outlook(Goal::Error(0.9e-4), 100.0).is_worth_a_pilot());
        assert!(!outlook(Goal::Samples(16), 0.0).is_worth_a_pilot());
        let first = Outlook { passes: 1, ..outlook(Goal::Error(2e-4), 10.0) };
        assert!(!first.is_worth_a_pilot(), "one pass predicts nothing");
    }
}
