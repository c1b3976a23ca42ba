//! Scene files: TOML text in, validated [`model::Scene`] out.

pub mod advice;
mod bsdf;
mod camera;
mod chance;
pub mod cone;
pub mod geometry;
mod lights;
mod load;
mod mapping;
mod materials;
pub mod model;
mod names;
mod pixel_filter;
mod procedural;
pub mod prune;
mod reader;
mod samplers;
mod sampling;
mod sections;
mod source;
pub mod synonyms;
mod table;
pub mod texture_advice;
mod textures;
mod validate;
mod vocabulary;

pub use load::{STANDARD_INPUT, is_standard_input, load, parse};
pub use pixel_filter::MAX_RADIUS;
pub use validate::{MAX_DEPTH, MAX_SIZE, MAX_SPP, both_filters, check_filters, check_shared, check_spp};
