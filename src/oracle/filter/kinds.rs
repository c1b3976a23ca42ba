//! What of the filters matters elsewhere: which of them a sampler has, by what it can do. Twin of
//! `glsl/shared/filter/kinds.glsl`.

use crate::schema::layout::Sampler;
use crate::texture::sampler_spec::Filter;

/// Whether beams know the integral of what it magnifies, and whether that has no steps.
pub fn is_integrable(how: &Sampler) -> bool {
    matches!(how.mag_filter, Filter::Nearest | Filter::Linear)
}

pub fn is_continuous(how: &Sampler) -> bool {
    how.mag_filter == Filter::Linear
}
