//! Sums of samples, and who takes them: what a picture is made from, whatever takes the samples. In: ranges of
//! pixels and samples. Out: sums, merged in an order that depends on nothing but the ranges.

mod backend;
mod scheduler;
mod sums;

pub use backend::{Backend, HalfSums, PilotRun};
pub use scheduler::Scheduler;
pub use sums::{Block, Count, FilmSums, Signed};
