//! Sums of samples, and the backends that take them: the basis of every picture. Input: ranges of pixels and
//! samples. Output: sums, merged in an order that depends on the ranges alone.

mod backend;
mod candidate;
mod pixels;
mod scheduler;
mod sums;

pub use backend::{Backend, HalfSums, PilotRun, wall_seconds};
pub use candidate::{Candidate, Made};
pub use pixels::{Aim, AuditPlan, Audited, Drawn, Estimated, Pixels, Plan, Planned, Raises};
pub use scheduler::Scheduler;
pub use sums::{Block, FilmSums, PixelSums, Signed};
