//! How far two pictures are apart, in linear RGB: read them, compare them, show where they differ.

pub mod compare;
pub mod difference;
pub mod read;

pub use compare::{Comparison, compare};
pub use difference::difference_picture;
pub use read::read_picture;
