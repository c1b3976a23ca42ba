//! The time that a study may take. In: when it began and how many seconds it has. Out: what is left of them, and
//! work that ends when they do.

use std::time::{Duration, Instant};

use crate::core::error::{Error, Result};
use crate::core::progress::{Progress, WithDeadline};

/// A century: longer limits are none.
const ENDLESS: f64 = 3e9;
/// A limit is kept up to this part of it.
const KEPT: f64 = 1.05;

#[derive(Clone, Copy, Debug)]
pub struct Limit {
    started: Instant,
    pub seconds: f64,
}

impl Limit {
    pub fn new(started: Instant, seconds: f64) -> Limit {
        Limit { started, seconds: seconds.min(ENDLESS) }
    }

    pub fn spent(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    pub fn left(&self) -> f64 {
        (self.seconds - self.spent()).max(0.0)
    }

    /// What to say where the study took longer.
    pub fn note(&self) -> Option<String> {
        let (spent, seconds) = (self.spent(), self.seconds);
        let note =
            || format!("it took {spent:.1} s: the least that a study does is more than --seconds {seconds}");
        (spent > KEPT * seconds).then(note)
    }

    /// Runs `work` until this many seconds after the study began. None: it was not done by then.
    pub fn until<T>(
        &self,
        seconds: f64,
        progress: &dyn Progress,
        work: impl FnOnce(&dyn Progress) -> Result<T>,
    ) -> Result<Option<T>> {
        let deadline = self.started + Duration::from_secs_f64(seconds.clamp(0.0, ENDLESS));
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

    /// Interrupted by a person.
    struct Stopped;

    impl Progress for Stopped {
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
        assert!(matches!(limit.until(1e300, &Stopped, asked), Err(Error::Interrupted)));
        assert!(limit.left() > 0.0 && Limit::new(Instant::now(), 0.0).left() == 0.0);
        assert!(limit.note().is_none() && Limit::new(Instant::now(), 1e-9).note().is_some());
    }
}
