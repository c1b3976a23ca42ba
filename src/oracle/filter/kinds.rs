//! Properties of a sampler's filters that matter outside the filters. Twin of
//! `glsl/shared/filter/kinds.glsl`.

use crate::schema::layout::Sampler;
use crate::texture::sampler_spec::Filter;

/// Returns true if beams can integrate the magnifying filter; `is_continuous`, if it has no steps.
pub fn is_integrable(how: &Sampler) -> bool {
    matches!(how.mag_filter, Filter::Nearest | Filter::Linear)
}

pub fn is_continuous(how: &Sampler) -> bool {
    how.mag_filter == Filter::Linear
}
