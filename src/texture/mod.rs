//! Textures as data: what a file holds, what a sampler does with it.

pub mod analysis;
mod analysis_steps;
mod cube;
pub mod data;
pub mod decode;
mod fixed_point;
pub mod load;
pub mod mips;
mod nrrd;
pub mod procedural;
mod read_exr;
pub(crate) mod read_file;
mod read_hdr;
mod read_jpeg;
mod read_png;
pub mod row_sums;
pub mod sampler_spec;
mod scalar;
mod sniff;
pub mod source;
mod stack;
pub mod summed;
pub mod synth;
mod tiff;
mod value;
mod volume;
