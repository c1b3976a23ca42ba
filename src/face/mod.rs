//! The public interface of rendering, for other programs. Input: a scene and options. Output: a film and a report.

mod film;
mod options;
mod renderer;

pub use options::RenderOptions;
pub use renderer::{RenderReport, Renderer};
