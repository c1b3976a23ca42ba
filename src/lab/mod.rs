//! Measurement tools: sampler verification, stability sweeps, studies, pattern analysis, metrics,
//! and their charts.

pub mod inspect;
pub mod metrics;
pub mod pattern;
pub mod plot;
pub mod probe;
pub mod sheet;
pub mod stability;
pub mod study;
pub mod verify;
pub mod view;
