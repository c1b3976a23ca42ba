//! Extreme and stiff cases: sweeps of one parameter over many decades on a device, each compared
//! with an exact or float64 reference and a derived bound.

mod areas;
pub mod case;
mod coordinates;
mod dielectric;
mod filters;
mod horizon;
mod mirrors;
mod origins;
pub mod page;
#[cfg(test)]
mod planted;
mod probing;
mod procedurals;
pub mod report;
pub mod run;
mod scenes;
mod seams;
mod sizes;
mod spheres;
mod stiff;
mod sums;
mod texels;
pub mod text;
mod transforms;
mod triangles;
mod view;

use case::Case;

/// Returns every case in the order of the report.
pub fn all() -> Vec<Case> {
    let groups = [
        coordinates::cases(),
        horizon::cases(),
        transforms::cases(),
        spheres::cases(),
        triangles::cases(),
        origins::cases(),
        stiff::cases(),
        texels::cases(),
        filters::cases(),
        procedurals::cases(),
        seams::cases(),
        sums::cases(),
        sizes::cases(),
        mirrors::cases(),
        dielectric::cases(),
    ];
    groups.into_iter().flatten().collect()
}
