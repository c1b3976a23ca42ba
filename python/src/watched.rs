//! Long work on a thread of its own, while the calling thread listens. In: the work and a callback of Python. Out: its
//! result, or the exception of a signal or of the callback, after which the work ends at its next safe point.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ScopedJoinHandle};
use std::time::Duration;

use moire::internal::core::panics;
use moire::{Error, ErrorKind, Progress, Result};
use pyo3::prelude::*;

use crate::errors::exception;

/// How often signals are looked for and progress is reported.
const PERIOD: Duration = Duration::from_millis(30);
/// As large as that of a main thread, on which the program works.
const STACK_BYTES: usize = 8 << 20;

/// What the two threads tell each other.
#[derive(Default)]
struct Shared {
    /// The bits of the fraction that is done.
    done: AtomicU64,
    cancelled: AtomicBool,
    ended: Mutex<bool>,
    end: Condvar,
}

impl Progress for Shared {
    fn advance(&self, done: f64) {
        self.done.store(done.to_bits(), Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl Shared {
    fn done(&self) -> f64 {
        f64::from_bits(self.done.load(Ordering::Relaxed))
    }

    fn lock(&self) -> MutexGuard<'_, bool> {
        self.ended.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the end of the work, not longer than a period. Returns true at the end.
    fn wait(&self) -> bool {
        let waited = self.end.wait_timeout_while(self.lock(), PERIOD, |ended| !*ended);
        *waited.unwrap_or_else(PoisonError::into_inner).0
    }
}

/// Runs `work` without the lock of the interpreter. `callback` is called with the fraction that is done, from the calling
/// thread; where it returns `False` the work is cancelled.
pub fn watched<T: Send>(
    py: Python<'_>,
    stage: &'static str,
    callback: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&dyn Progress) -> Result<T> + Send,
) -> PyResult<T> {
    let shared = Shared::default();
    let (result, stopped) = thread::scope(|scope| {
        let own = &shared;
        let begun = thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, move || {
            let result = panics::contain(&stage, || work(own));
            *own.lock() = true;
            own.end.notify_all();
            result
        });
        match begun {
            Ok(worker) => listen(py, own, callback, worker),
            Err(error) => {
                let told = format!("{stage}: the system gives no thread: {error}");
                (Err(Error::new(told).of_kind(ErrorKind::OutOfHostMemory)), None)
            }
        }
    });
    if let Some(stopped) = stopped {
        return Err(stopped);
    }
    let value = result.map_err(|error| exception(py, &error))?;
    if let Some(callback) = callback
        && shared.done() < 1.0
    {
        callback.call1((1.0,))?;
    }
    Ok(value)
}

/// Calls back and looks for signals until the work ends. Returns its result, and the exception that stopped it.
fn listen<T: Send>(
    py: Python<'_>,
    shared: &Shared,
    callback: Option<&Bound<'_, PyAny>>,
    worker: ScopedJoinHandle<'_, Result<T>>,
) -> (Result<T>, Option<PyErr>) {
    let (mut told, mut stopped) = (0.0, None);
    loop {
        let ended = py.detach(|| shared.wait());
        if stopped.is_none() && !shared.cancelled() {
            let step = py.check_signals().and_then(|()| report(shared, callback, &mut told));
            match step {
                Ok(true) => {}
                Ok(false) => shared.cancelled.store(true, Ordering::Relaxed),
                Err(error) => {
                    shared.cancelled.store(true, Ordering::Relaxed);
                    stopped = Some(error);
                }
            }
        }
        if ended {
            break;
        }
    }
    let lost = |_| Err(Error::new("the work ended without a result").of_kind(ErrorKind::Internal));
    (py.detach(|| worker.join()).unwrap_or_else(lost), stopped)
}

/// Calls back if there is progress. Returns false if the work shall stop.
fn report(shared: &Shared, callback: Option<&Bound<'_, PyAny>>, told: &mut f64) -> PyResult<bool> {
    let done = shared.done();
    let Some(callback) = callback.filter(|_| done > *told) else { return Ok(true) };
    *told = done;
    let answer = callback.call1((done,))?;
    Ok(!answer.extract::<bool>().is_ok_and(|goes_on| !goes_on))
}
