//! What a sample pattern is like: points of one pixel → measures, power spectrum, picture.

mod canvas;
pub mod measures;
pub mod picture;
pub mod points;
pub mod spectrum;
