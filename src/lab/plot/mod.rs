//! Self-contained plots and pages: SVG documents with logarithmic axes, and the HTML around them.
//! Their meaning is defined by `study` and `stability`.

pub mod axis;
pub mod chart;
pub mod html;
mod labels;
pub mod svg;
