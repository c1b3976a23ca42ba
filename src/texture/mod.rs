//! Textures as data: what a file holds, what a sampler does with it.

pub mod analysis;
mod analysis_steps;
pub mod data;
pub mod decode;
mod jpeg_end;
pub mod load;
mod read_exr;
pub(crate) mod read_file;
pub mod sampler_spec;
mod sniff;
pub mod source;
pub mod synth;
mod value;
