//! Extreme and stiff cases: sweeps of one parameter over many decades on a device, each held against an
//! exact or float64 answer and a bound that is derived. A device in, a report out.

pub mod case;
mod dielectric;
mod mirrors;
pub mod page;
pub mod report;
pub mod run;
mod scenes;
mod sizes;
mod sums;
pub mod text;

use case::Case;

/// Every case, in the order of the report.
pub fn all() -> Vec<Case> {
    [sums::cases(), sizes::cases(), mirrors::cases(), dielectric::cases()].into_iter().flatten().collect()
}
