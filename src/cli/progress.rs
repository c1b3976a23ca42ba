//! The progress bar on a terminal, and cancellation by Ctrl-C: the first one lets the current slice
//! on the device finish.

use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::core::error::{Error, Result};
use crate::core::progress::Progress;

static CANCELLED: AtomicBool = AtomicBool::new(false);
const STEPS: u64 = 1000;
/// The look of the bar, without words for what is done and with them.
const PLAIN: &str = "{wide_bar} {percent:>3} % {eta:>4} left";
const DESCRIBED: &str = "{msg} {wide_bar} {percent:>3} % {eta:>4} left";

/// A progress bar on stderr if that is a terminal; in a pipe nothing is drawn.
pub struct Bar(ProgressBar);

impl Bar {
    pub fn new(quiet: bool) -> Result<Bar> {
        ctrlc::set_handler(|| CANCELLED.store(true, Ordering::Relaxed))
            .map_err(|e| Error::new(format!("cannot listen to Ctrl-C: {e}")))?;
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target);
        if let Ok(style) = ProgressStyle::with_template(PLAIN) {
            bar.set_style(style);
        }
        Ok(Bar(bar))
    }

    /// Begins anew after the end.
    pub fn restart(&self) {
        self.0.reset();
    }

    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

impl Progress for Bar {
    fn advance(&self, done: f64) {
        self.0.set_position((done * STEPS as f64) as u64);
    }

    fn cancelled(&self) -> bool {
        CANCELLED.load(Ordering::Relaxed)
    }

    fn describe(&self, what: &str) {
        if self.0.message().is_empty()
            && let Ok(style) = ProgressStyle::with_template(DESCRIBED)
        {
            self.0.set_style(style);
        }
        self.0.set_message(what.to_owned());
    }
}
