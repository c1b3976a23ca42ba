//! Textures as data: what a file holds, what a sampler does with it.

pub mod data;
pub mod sampler_spec;
pub mod synth;
