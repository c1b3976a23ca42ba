//! The renderer once more in f64, on the CPU, reading the same packed scene. Each file is the twin
//! of that of the same stem in `glsl/shared/` (of `render`: `render_main.glsl`), with the same
//! functions in the same order. Sample positions are
//! integers and equal bit for bit; everything after them differs by the rounding of f32 only.

pub mod address;
pub mod beam;
pub mod camera;
pub mod choices;
pub mod cone;
pub mod cone_shade;
pub mod coverage;
pub mod ellipse;
pub mod filter;
pub mod footprint;
pub mod forms;
pub mod glossy;
pub mod grid;
pub mod halton;
pub mod intersect;
pub mod jobs;
pub mod levels;
pub mod light;
pub mod mapping;
pub mod math;
pub mod noise;
pub mod paint;
pub mod patterns;
pub mod permute;
pub mod pieces;
pub mod pixel_filter;
pub mod polygon;
pub mod procedural;
pub mod rectangle;
pub mod render;
pub mod rng;
pub mod rows;
pub mod shade;
pub mod shading_normal;
pub mod sobol;
pub mod spread;
pub mod strata;
pub mod summed;
pub mod surface;
pub mod survey;
pub mod texture;
pub mod warps;
