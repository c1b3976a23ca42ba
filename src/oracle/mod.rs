//! The renderer in f64 on the CPU, reading the same packed scene. Each file is the twin of the file with the
//! same stem in `glsl/shared/` (`render`: `render_main.glsl`), with the same functions in the same order.
//! Sample positions are integers and equal bit for bit; everything after them differs by the rounding of f32
//! only.

pub mod address;
pub mod appearance;
pub mod backend;
pub mod beam;
pub mod bsdf;
pub mod camera;
pub mod camera_sample;
pub mod cone;
pub mod cone_shade;
pub mod coverage;
pub mod disk_sampling;
pub mod environment;
pub mod filter;
pub mod footprint;
pub mod footprint_axes;
pub mod fragments;
pub mod geometry;
pub mod grid;
pub mod halton;
pub mod light;
pub mod mapping;
pub mod material_maps;
pub mod math;
pub mod noise;
pub mod patterns;
pub mod permute;
pub mod pixel_filter;
pub mod polygon;
pub mod prefix_sums;
pub mod procedural;
pub mod projective;
pub mod quantities;
pub mod rectangle;
pub mod render;
pub mod rng;
pub mod sample_dimensions;
pub mod shade;
pub mod shading_integral;
pub mod shading_normal;
pub mod sobol;
pub mod strata;
pub mod texture;
pub mod tile_culling;
