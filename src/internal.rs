//! The rooms of this crate, for its own program, tests and benches, which are crates of their own. In: nothing. Out:
//! every room under its name. It is hidden from the documentation, is no part of the public face and follows no
//! version: whatever is reached through it may change or go in any release.

macro_rules! rooms {
    ($($room:ident)+) => { $(pub mod $room { pub use crate::$room::*; })+ };
}

rooms! { cli core face gpu integrators lab oracle output pack render sampling scene schema texture }
