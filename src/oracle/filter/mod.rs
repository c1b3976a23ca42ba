//! The filters of textures, one file each, behind [`sample_texture()`]; properties that matter outside are in
//! [`kinds`].

pub mod anisotropic;
pub mod cube;
pub mod ewa;
pub mod kernels;
pub mod kinds;
pub mod levels;
pub mod linear;
pub mod nearest;
pub mod sample_texture;
pub mod stochastic;
pub mod summed_area;

pub use sample_texture::sample_texture;
