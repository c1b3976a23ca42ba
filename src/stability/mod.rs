//! Extreme and stiff cases: sweeps of one parameter over many decades on a device, each held against an
//! exact or float64 answer and a bound that is derived. A device in, a report out.

mod areas;
pub mod case;
mod filters;
#[cfg(test)]
mod planted;
mod probing;
mod procedurals;
mod seams;
mod texels;

use case::Case;

/// Every case, in the order of the report.
pub fn all() -> Vec<Case> {
    let lists = [texels::cases(), filters::cases(), procedurals::cases(), seams::cases()];
    lists.into_iter().flatten().collect()
}
