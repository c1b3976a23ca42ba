//! The kinds of shapes, one file each, behind the doors of [`rays`], [`cones`] and [`beams`]: outside this folder a shape
//! is a number.

pub mod beams;
pub mod cones;
pub mod hit;
pub mod kinds;
pub mod plane;
pub mod rays;
pub mod sphere;
pub mod triangle;
