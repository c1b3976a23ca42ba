//! Progress reports of long computations, and their cancellation.

use std::time::Instant;

/// Hears how far a render is, and may stop it.
pub trait Progress: Sync {
    /// Reports that the fraction `done` in [0, 1] of the work is finished.
    fn advance(&self, done: f64);
    /// Returns true once the user has requested to stop; the work then ends at the next safe point.
    fn cancelled(&self) -> bool;
}

/// Reports nothing and is never cancelled.
pub struct NoProgress;

impl Progress for NoProgress {
    fn advance(&self, _done: f64) {}

    fn cancelled(&self) -> bool {
        false
    }
}

/// A part of a longer computation, from `from` to `to` of its progress.
pub struct SubProgress<'a> {
    /// The longer computation.
    pub whole: &'a dyn Progress,
    /// Where the part begins, in [0, 1].
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

impl Progress for SubProgress<'_> {
    fn advance(&self, done: f64) {
        self.whole.advance(self.from + done * (self.to - self.from));
    }

    fn cancelled(&self) -> bool {
        self.whole.cancelled()
    }
}

/// A computation that is also cancelled at a deadline.
pub struct WithDeadline<'a> {
    /// The computation.
    pub whole: &'a dyn Progress,
    /// When its time is over.
    pub deadline: Instant,
}

impl Progress for WithDeadline<'_> {
    fn advance(&self, done: f64) {
        self.whole.advance(done);
    }

    fn cancelled(&self) -> bool {
        self.whole.cancelled() || Instant::now() >= self.deadline
    }
}
