//! Scene files: TOML text in, validated [`model::Scene`] out.

pub mod model;
