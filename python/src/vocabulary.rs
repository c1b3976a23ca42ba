//! The names of options with a vocabulary, for the types that the package declares. Out: for each option its names.

use moire::internal::render::layers::Aov;
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Precision};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::{Filter, LevelUse, Method};
use moire::{Gamut, ToneMap};
use pyo3::prelude::*;

/// Returns the options with a vocabulary, and their names.
#[pyfunction]
pub fn vocabulary() -> Vec<(&'static str, Vec<&'static str>)> {
    let all = [
        ("algorithm", Algorithm::NAMES),
        ("aov", Aov::NAMES),
        ("color_space", ColorSpace::NAMES),
        ("filter", Filter::NAMES),
        ("footprint", Footprint::NAMES),
        ("gamut", Gamut::NAMES),
        ("method", Method::NAMES),
        ("mip", LevelUse::NAMES),
        ("pattern", Pattern::NAMES),
        ("pixel_filter", PixelFilterKind::NAMES),
        ("precision", Precision::NAMES),
        ("tone_map", ToneMap::NAMES),
    ];
    all.into_iter().map(|(option, names)| (option, names.to_vec())).collect()
}
