//! The declarations that host and device share: one table each for enums, constants, descriptors, specialization
//! constants and blocks of words. Here the tables become Rust; `build.rs` includes the same files and generates GLSL.

#[macro_use]
mod tables;

pub mod bindings;
pub mod blocks;
pub mod constants;
pub mod enums;
pub mod header;
pub mod layout;
pub mod models;
pub mod packing;
mod pixel_batch;
pub mod record;
pub mod records;
pub mod shapes;
pub mod specialization;
pub mod surface_enums;
