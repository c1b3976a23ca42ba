//! Headless Vulkan compute renderer for texture mapping and anti-aliasing.
//!
//! ```text
//! argv ─ cli ──┬─ scene::load ────▶ Scene (plain f64 data) ──┐
//!              └─ texture::decode ▶ TextureData ─────────────┤
//!                                                            ▼
//!               features: what this scene needs ◀─ pack ─▶ PackedScene (exact bytes)
//!                        ┌───────────────────────────────────┴──────────────┐
//!             render + gpu (ash, unsafe)                              oracle (f64, rayon)
//!             upload ▶ pipeline ▶ slices ▶ readback                   reads the same bytes
//!                        └────────▶ Film (linear RGB means) ◀───────────────┘
//!                                             │
//!                             output (PNG, EXR, …) · metrics ◀─ study (error against time)
//! ```
//!
//! Only [`gpu`] names Vulkan. Each file of [`oracle`] is the float64 twin of a file of `glsl/shared/`;
//! [`schema::layout`] and [`pack::features`] are the host's side of the two that hold declarations.

#[doc(hidden)]
pub mod internal;

mod cli;
mod core;
mod gpu;
mod integrators;
mod lab;
mod oracle;
mod output;
mod pack;
mod render;
mod sampling;
mod scene;
mod schema;
mod texture;
