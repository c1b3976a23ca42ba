//! Scene files: TOML text in, validated [`model::Scene`] out.

mod load;
pub mod model;
mod names;
mod procedural;
pub mod prune;
mod reader;
mod sections;
mod shapes;
mod source;
mod table;
mod textures;
mod validate;

pub use load::{load, parse};
pub use procedural::parse_procedural;
pub use validate::{MAX_DEPTH, MAX_SIZE, MAX_SPP, check_shared, check_spp};
