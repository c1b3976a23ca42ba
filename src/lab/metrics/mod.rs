//! Error metrics between pictures in linear RGB: reading, comparison, difference pictures.

pub mod compare;
pub mod difference;
pub mod flip;
mod flip_color;
pub mod halves;
pub mod overlap;
pub mod read;

pub use compare::{Comparison, compare};
pub use difference::difference_picture;
pub use flip::flip;
pub use halves::{Estimate, Halves};
pub use overlap::common;
pub use read::{read_picture, read_placed};
