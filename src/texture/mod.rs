//! Textures as data: the contents of image files and the states of samplers.

#[allow(missing_docs)]
pub mod analysis;
pub mod analysis_levels;
mod analysis_period;
mod analysis_rows;
mod analysis_steps;
#[allow(missing_docs)]
mod analysis_verdict;
pub(crate) mod color_profile;
mod container;
mod cube;
mod cutout;
pub mod data;
#[allow(missing_docs)]
pub mod decode;
mod decoder;
mod exr_color;
mod exr_layers;
mod exr_subsampled;
pub mod filter;
mod fixed_point;
pub mod formats;
mod jpeg_data;
pub mod load;
pub mod mips;
mod nrrd;
pub(crate) mod open_file;
pub mod orientation;
pub mod prefix_sums;
pub mod procedural;
pub(crate) mod profile_colors;
pub(crate) mod read_exr;
pub(crate) mod read_file;
mod read_hdr;
mod read_jpeg;
mod read_png;
mod read_tga;
mod read_webp;
pub mod room;
pub mod sampler_spec;
mod scalar;
mod sniff;
pub mod source;
mod stack;
pub mod summed;
mod tiff;
pub mod tiles;
mod value;
mod volume;
