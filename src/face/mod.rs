//! The public face of rendering: a scene and options in, a film and a report out. It is what programs use that are not
//! this crate's own.

mod film;
mod options;
mod renderer;

pub use options::RenderOptions;
pub use renderer::{RenderReport, Renderer};
