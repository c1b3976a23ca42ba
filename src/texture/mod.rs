//! Textures as data: what a file holds, what a sampler does with it.

pub mod analysis;
mod analysis_steps;
mod cube;
pub mod data;
pub mod decode;
mod exr_color;
mod exr_layers;
mod exr_subsampled;
mod fixed_point;
mod jpeg_end;
pub mod load;
pub mod mips;
mod nrrd;
pub mod orientation;
pub mod procedural;
mod read_exr;
pub(crate) mod read_file;
pub mod row_sums;
pub mod sampler_spec;
mod sniff;
pub mod source;
mod stack;
pub mod summed;
pub mod synth;
mod value;
mod volume;
