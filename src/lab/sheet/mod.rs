//! Settings side by side: one labelled picture, or one page. Input: a plan of cells, each with its scene. Output: their
//! pictures with errors against a reference and times, put into a film or into HTML, and a record of all of it.
//!
//! ```text
//! plan ─▶ check ─▶ render (views, sessions, reference, judge, same) ─▶ record, pictures ─▶ content ─▶ compose (canvas) · page
//! ```

mod canvas;
mod check;
mod compose;
mod content;
mod identity;
mod judge;
mod page;
pub mod plan;
pub mod record;
mod reference;
mod render;
mod same;
mod sessions;
mod shown;
mod views;

pub use check::check;
pub use compose::compose;
pub use content::Content;
pub use page::html;
pub use render::{Sheet, render};
