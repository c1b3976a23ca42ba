//! Types that every other module may use: colour, film, errors, names, progress.

pub mod built_in;
pub mod checksum;
pub mod color;
pub mod counted;
pub mod error;
pub mod film;
pub mod layer;
pub mod named;
pub mod number;
pub mod panics;
pub mod printable;
pub mod progress;
pub mod range;
