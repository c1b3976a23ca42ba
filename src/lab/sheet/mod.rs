//! Settings side by side: one labelled picture, or one page. Input: a plan of cells, each with its scene. Output: their
//! pictures with errors against a reference and times, put into a film or into HTML, and a record of all of it.
//!
//! ```text
//! plan ─▶ render (sessions, reference, judge) ─▶ record, pictures ─▶ content ─▶ compose (canvas) · page
//! ```

mod canvas;
mod compose;
mod content;
mod identity;
mod judge;
mod page;
pub mod plan;
pub mod record;
mod reference;
mod render;
mod sessions;
mod shown;

pub use compose::compose;
pub use content::Content;
pub use page::html;
pub use render::{Sheet, render};
