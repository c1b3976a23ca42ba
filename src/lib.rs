//! Headless Vulkan compute renderer for texture mapping and anti-aliasing, with or without a GPU.
//!
//! A [`Scene`] comes from a file or is built in code from the parts in [`model`]; a [`Renderer`], which is an open
//! device with [`RenderOptions`], makes a [`Film`] of it, whose colours are linear light.
//!
//! ```no_run
//! use moire::{RenderOptions, Renderer, Scene};
//!
//! # fn main() -> moire::Result<()> {
//! let scene = Scene::from_file("scene.toml")?;
//! let renderer = Renderer::new(RenderOptions::new().samples(64))?;
//! renderer.render(&scene)?.save("picture.png")?;
//! # Ok(())
//! # }
//! ```
//!
//! Errors are of type [`Error`]: the message names the place, and programs can act on its [`kind`](Error::kind).

#![deny(missing_docs)]

#[doc(hidden)]
pub mod internal;
pub mod model;

#[allow(missing_docs)]
mod cli;
mod core;
mod face;
#[allow(missing_docs)]
mod gpu;
#[allow(missing_docs)]
mod integrators;
#[allow(missing_docs)]
mod lab;
mod mesh;
#[allow(missing_docs)]
mod oracle;
#[allow(missing_docs)]
mod output;
#[allow(missing_docs)]
mod pack;
#[allow(missing_docs)]
mod render;
#[allow(missing_docs)]
mod sampling;
mod scene;
#[allow(missing_docs)]
mod schema;
mod texture;
mod tree;

pub use crate::core::error::{Error, ErrorKind, Result};
pub use crate::core::film::Film;
pub use crate::core::progress::Progress;
pub use crate::face::{RenderOptions, RenderReport, Renderer, SaveOptions};
pub use crate::lab::metrics::Comparison;
pub use crate::output::{Gamut, ToneMap};
pub use crate::scene::{Scene, SceneBuilder};
