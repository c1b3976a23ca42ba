//! The oracle against exact answers: rationals of the scene's own f64 numbers, and 256 bits where
//! an answer has a root, an angle or a sine. They are derived from the README's conventions, not
//! from the sources, so that a mistake common to shader and oracle is found. Every comparison is
//! tested with planted errors too, which it must detect.

mod address;
mod areas;
mod camera;
mod faces;
mod filters;
mod footprints;
mod glass;
mod lights;
mod lookups;
mod mapping;
mod numbers;
mod planes;
mod scenes;
mod spheres;
mod tiles;
mod triangles;

use numbers::{Q, off};

/// Unit roundoff of f64, the unit of all bounds here.
const U: f64 = f64::EPSILON / 2.0;

/// The greatest error over its bound; more than 1 is a failure.
#[derive(Default)]
struct Worst {
    ratio: f64,
    cases: u32,
}

impl Worst {
    fn add(&mut self, got: f64, exact: &Q, bound: f64) {
        let error = off(got, exact);
        let ratio = if error <= 0.0 { 0.0 } else { error / bound };
        self.ratio = if ratio.is_nan() { f64::INFINITY } else { self.ratio.max(ratio) };
        self.cases += 1;
    }

    /// A Boolean that must be correct.
    fn agree(&mut self, same: bool) {
        self.ratio = if same { self.ratio } else { f64::INFINITY };
        self.cases += 1;
    }

    fn holds(&self, what: &str) {
        println!("{what}: {:.3} of the bound in {} cases", self.ratio, self.cases);
        assert!(self.cases > 0, "{what}: nothing was compared");
        assert!(self.ratio <= 1.0, "{what}: {:.3e} times the bound", self.ratio);
    }

    /// A planted error is far above the bound.
    fn fails(&self, what: &str) {
        assert!(self.ratio > 2.0, "{what} was not told: {:.3} of the bound", self.ratio);
    }
}
