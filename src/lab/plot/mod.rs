//! Plots and pages that need no other file: SVG documents with logarithmic axes, and the HTML around them.
//! Numbers and words in, text out; what they mean is known to `study` and `stability`.

pub mod axis;
pub mod chart;
pub mod html;
pub mod svg;
