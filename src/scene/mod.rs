//! Scenes. Input: a file of some format, or parts from code. Output: the whole [`model::Scene`], which keeps
//! all rules.

pub mod advice;
mod bsdf;
pub mod builder;
mod built_in;
mod camera;
mod chance;
#[allow(missing_docs)]
pub mod changes;
mod checks;
pub mod cone;
mod formats;
pub mod geometry;
mod limits;
mod mapping;
mod material;
pub mod model;
mod pixel_filter;
pub mod prefiltered;
pub mod prune;
mod refusal;
mod sampling;
mod setting;
mod shorthands;
mod suggestion;
pub mod synonyms;
pub mod texture_advice;
mod tiles;
mod whole;

pub use builder::SceneBuilder;
pub use built_in::BuiltIn;
pub use formats::{
    ModelView, Reading, STANDARD_INPUT, SceneFile, is_model, is_scene_name, is_standard_input, load, load_as,
    load_recorded, load_seen_by, model_endings, model_view, parse, parse_as, path_of, setting_keys,
};
pub use limits::{MAX_DEPTH, MAX_RADIUS, MAX_SIZE, MAX_SPP, check_filters, check_shared, check_spp};
pub use setting::Setting;
pub use suggestion::{nearest, suggestion};
pub use whole::Scene;
