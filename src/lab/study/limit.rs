//! The time limit of a study: the remaining seconds, and work that is cancelled at the deadline.

use std::time::{Duration, Instant};

use crate::core::error::{Error, Result};
use crate::core::progress::{Progress, WithDeadline};

/// A century: longer limits count as unlimited.
const UNLIMITED: f64 = 3e9;
/// The tolerated overrun, as a factor of the limit.
const TOLERANCE: f64 = 1.05;

#[derive(Clone, Copy, Debug)]
pub struct Limit {
    started: Instant,
    pub seconds: f64,
}

impl Limit {
    pub fn new(started: Instant, seconds: f64) -> Limit {
        Limit { started, seconds: seconds.min(UNLIMITED) }
    }

    pub fn spent(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    pub fn left(&self) -> f64 {
        (self.seconds - self.spent()).max(0.0)
    }

    /// Returns a note if the study exceeded its limit.
    pub fn note(&self) -> Option<String> {
        let (spent, seconds) = (self.spent(), self.seconds);
        let note =
            || format!("it took {spent:.1} s: the least that a study does is more than --seconds {seconds}");
        (spent > TOLERANCE * seconds).then(note)
    }

    /// Runs `work` until this many seconds after the start of the study. Returns `None` if it did
    /// not finish by then.
    pub fn until<T>(
        &self,
        seconds: f64,
        progress: &dyn Progress,
        work: impl FnOnce(&dyn Progress) -> Result<T>,
    ) -> Result<Option<T>> {
        let deadline = self.started + Duration::from_secs_f64(seconds.clamp(0.0, UNLIMITED));
        match work(&WithDeadline { whole: progress, deadline }) {
            Err(Error::Interrupted) if !progress.cancelled() => Ok(None),
            outcome => outcome.map(Some),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::core::progress::NoProgress;

    fn asked(progress: &dyn Progress) -> Result<()> {
        if progress.cancelled() { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// A progress that was cancelled by the user.
    struct Cancelled;

    impl Progress for Cancelled {
        fn advance(&self, _done: f64) {}

        fn cancelled(&self) -> bool {
            true
        }
    }

    #[test]
    fn work_ends_with_the_time_and_with_the_persons_patience() {
        let limit = Limit::new(Instant::now(), 1e300);
        assert!(matches!(limit.until(1e300, &NoProgress, asked), Ok(Some(()))));
        assert!(matches!(limit.until(0.0, &NoProgress, asked), Ok(None)));
        assert!(matches!(limit.until(1e300, &Cancelled, asked), Err(Error::Interrupted)));
        assert!(limit.left() > 0.0 && Limit::new(Instant::now(), 0.0).left() == 0.0);
        assert!(limit.note().is_none() && Limit::new(Instant::now(), 1e-9).note().is_some());
    }
}
