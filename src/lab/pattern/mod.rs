//! Analysis of sample patterns: points of one pixel, their measures, power spectrum and picture.

mod canvas;
pub mod measures;
pub mod picture;
pub mod points;
pub mod spectrum;
