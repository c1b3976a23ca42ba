//! Headless Vulkan compute renderer for texture mapping and anti-aliasing.

pub mod cli;
pub mod color;
pub mod error;
pub mod film;
pub mod metrics;
mod named;
pub mod output;
pub mod scene;
pub mod texture;
