//! How far two pictures are apart, in linear RGB: read them, compare them, show where they differ.

pub mod compare;
pub mod difference;
pub mod flip;
mod flip_color;
pub mod place;
pub mod read;

pub use compare::{Comparison, compare};
pub use difference::difference_picture;
pub use flip::flip;
pub use place::common;
pub use read::{read_picture, read_placed};
