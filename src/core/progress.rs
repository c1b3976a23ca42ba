//! How a long computation tells how far it is, and learns that it shall stop.

use std::time::Instant;

/// Hears how far a render is, and may stop it.
pub trait Progress: Sync {
    /// `done` of the work is finished, in [0, 1].
    fn advance(&self, done: f64);
    /// True once the person asked to stop; the work then ends at the next safe place.
    fn cancelled(&self) -> bool;
}

/// Says nothing, never stops.
pub struct NoProgress;

impl Progress for NoProgress {
    fn advance(&self, _done: f64) {}

    fn cancelled(&self) -> bool {
        false
    }
}

/// A part of a longer computation, from `from` to `to` of it.
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

/// A computation that also stops when its time is over.
pub struct Until<'a> {
    /// The computation.
    pub whole: &'a dyn Progress,
    /// When its time is over.
    pub deadline: Instant,
}

impl Progress for Until<'_> {
    fn advance(&self, done: f64) {
        self.whole.advance(done);
    }

    fn cancelled(&self) -> bool {
        self.whole.cancelled() || Instant::now() >= self.deadline
    }
}
