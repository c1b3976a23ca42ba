//! The modules of this crate, for its own program, tests and benchmarks, which are crates of their own. They are hidden
//! from the documentation, are no part of the public interface and follow no version: everything here may change or
//! disappear in any release.

macro_rules! rooms {
    ($($room:ident)+) => { $(pub mod $room { pub use crate::$room::*; })+ };
}

rooms! { cli core face gpu integrators lab mesh oracle output pack render sampling scene schema texture tree }
