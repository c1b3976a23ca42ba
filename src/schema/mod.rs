//! What host and device share: one table each for enums, numbers, descriptors, specialization constants, blocks
//! of words and shaders. Here the tables become Rust; `build.rs` includes the same files and makes GLSL of them.

#[macro_use]
mod tables;

pub mod bindings;
pub mod blocks;
pub mod constants;
pub mod enums;
mod job;
pub mod layout;
pub mod packing;
pub mod record;
pub mod records;
pub mod shapes;
pub mod specialization;
