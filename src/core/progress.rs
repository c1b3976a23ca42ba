//! Progress reports of long computations, and their cancellation.

use std::time::Instant;

/// Receives the progress of a render, and may cancel it.
pub trait Progress: Sync {
    /// Reports that the fraction `done` in [0, 1] of the work is finished.
    fn advance(&self, done: f64);
    /// Returns true once the user has requested to stop; the work then ends at the next safe point.
    fn cancelled(&self) -> bool;
    /// Names what is done at the moment, for a person who waits.
    fn describe(&self, _what: &str) {}
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
    /// Progress at the start of the part, in [0, 1].
    pub from: f64,
    /// Progress at its end.
    pub to: f64,
}

impl Progress for SubProgress<'_> {
    fn advance(&self, done: f64) {
        self.whole.advance(self.from + done * (self.to - self.from));
    }

    fn cancelled(&self) -> bool {
        self.whole.cancelled()
    }

    fn describe(&self, what: &str) {
        self.whole.describe(what);
    }
}

/// A computation that is also cancelled at a deadline.
pub struct WithDeadline<'a> {
    /// The computation.
    pub whole: &'a dyn Progress,
    /// The deadline.
    pub deadline: Instant,
}

impl Progress for WithDeadline<'_> {
    fn advance(&self, done: f64) {
        self.whole.advance(done);
    }

    fn cancelled(&self) -> bool {
        self.whole.cancelled() || Instant::now() >= self.deadline
    }

    fn describe(&self, what: &str) {
        self.whole.describe(what);
    }
}
