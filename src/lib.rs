//! Headless Vulkan compute renderer for texture mapping and anti-aliasing.

pub mod cli;
pub mod error;
pub mod film;
pub mod gpu;
mod named;
pub mod scene;
pub mod texture;
