//! The public interface of rendering, for other programs. Input: a scene and options. Output: a film and a report.

mod film;
mod options;
mod renderer;
mod save;

pub use options::RenderOptions;
pub use renderer::{RenderReport, Renderer};
pub use save::SaveOptions;
