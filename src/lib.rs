//! Headless Vulkan compute renderer for texture mapping and anti-aliasing.

pub mod error;
pub mod film;
mod named;
pub mod scene;
pub mod texture;
