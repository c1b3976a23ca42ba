//! The pictures that wait for the device, which renders one after the other: the one with the fewest samples first, so
//! that a changed setting is seen at once and two settings are compared at equal counts.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use super::refinement::Refinement;
use crate::core::progress::Progress;

/// Refinements, in the order in which they came or were rendered last.
pub struct Queue {
    waiting: Mutex<Vec<Arc<Refinement>>>,
    wake: Condvar,
    /// The fewest samples that some picture waits for.
    fewest: AtomicU32,
    is_stopped: AtomicBool,
}

impl Default for Queue {
    fn default() -> Queue {
        Queue {
            waiting: Mutex::default(),
            wake: Condvar::new(),
            fewest: AtomicU32::new(u32::MAX),
            is_stopped: AtomicBool::new(false),
        }
    }
}

impl Queue {
    fn waiting(&self) -> MutexGuard<'_, Vec<Arc<Refinement>>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a refinement, unless it is over.
    pub fn push(&self, refinement: Arc<Refinement>) {
        let mut waiting = self.waiting();
        waiting.push(refinement);
        self.count(&mut waiting);
        self.wake.notify_all();
    }

    /// Waits for the refinement whose next picture has the fewest samples, and takes it; none once stopped.
    pub fn take(&self) -> Option<Arc<Refinement>> {
        let mut waiting = self.waiting();
        loop {
            if self.is_stopped.load(Ordering::Relaxed) {
                return None;
            }
            self.count(&mut waiting);
            let next = |(at, own): (usize, &Arc<Refinement>)| Some((own.next()?, at));
            if let Some((_, at)) = waiting.iter().enumerate().filter_map(next).min() {
                let taken = waiting.remove(at);
                self.count(&mut waiting);
                return Some(taken);
            }
            waiting = self.wake.wait(waiting).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Forgets refinements that are over, and counts those that wait.
    fn count(&self, waiting: &mut Vec<Arc<Refinement>>) {
        waiting.retain(|own| own.next().is_some());
        let fewest = waiting.iter().filter_map(|own| own.next()).min().unwrap_or(u32::MAX);
        self.fewest.store(fewest, Ordering::Relaxed);
    }

    /// Ends rendering, and all that wait.
    pub fn stop(&self) {
        self.is_stopped.store(true, Ordering::Relaxed);
        let _waiting = self.waiting();
        self.wake.notify_all();
    }

    pub fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}

/// The render of a picture: it ends early when its setting is gone, the program ends, or a picture of fewer samples
/// waits.
pub struct Turn<'q> {
    pub queue: &'q Queue,
    pub refinement: &'q Refinement,
    pub count: u32,
}

impl Progress for Turn<'_> {
    fn advance(&self, _done: f64) {}

    fn cancelled(&self) -> bool {
        self.refinement.is_cancelled()
            || self.queue.is_stopped()
            || self.queue.fewest.load(Ordering::Relaxed) < self.count
    }
}
