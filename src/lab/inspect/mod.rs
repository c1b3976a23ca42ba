//! The layers of a picture as pictures, and what they say of a scene's textures: how dense they are seen, which of their
//! texels and levels are read, and which settings suit the view.

pub mod advice;
mod chart_grid;
mod charts;
mod colors;
pub mod density;
mod folder;
mod font;
mod legend;
mod marks;
pub mod page;
pub mod picture;
mod scale;
pub mod survey;
pub mod uses;

pub use charts::{Charts, Coordinates, charts, readers};
pub use density::Density;
pub use folder::{EXR, Inspected, Inspection, PAGE, file_of, files, inspect, write};
