//! What measures: verification of samplers, stability, studies, patterns, metrics, and their charts.

pub mod metrics;
pub mod pattern;
pub mod plot;
pub mod probe;
pub mod stability;
pub mod study;
pub mod verify;
