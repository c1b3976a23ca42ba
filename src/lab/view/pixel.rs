//! A pixel of a refinement: its value in the newest picture, and what it is made of. Input: a refinement and a pixel.
//! Output: JSON.

use std::sync::PoisonError;

use serde_json::{Value, json};

use super::inspector::Inspector;
use super::refinement::{Refinement, Shown};
use super::settings::Source;
use crate::core::error::Result;

/// Returns what a pixel of a refinement is made of.
pub fn pixel(refinement: &Refinement, source: &Source, place: [u32; 2]) -> Result<Value> {
    let shown = refinement.shown();
    let count = shown.as_ref().map_or(1, |shown| shown.count);
    let mut inspector = refinement.inspector.lock().unwrap_or_else(PoisonError::into_inner);
    let inspector = match &mut *inspector {
        Some(inspector) => inspector,
        empty => empty.insert(Inspector::new(refinement.settings.load(source, true)?)?),
    };
    let mut told = inspector.told(place, count)?;
    told["value"] = shown.map(|shown| value_of(&shown, place)).into();
    Ok(told)
}

/// Returns the colour of a picture's pixel.
fn value_of(shown: &Shown, [x, y]: [u32; 2]) -> Value {
    let linear = shown.film.pixels[(y * shown.film.width + x) as usize];
    // What is not finite has no number in JSON.
    json!({
        "spp": shown.count,
        "linear": linear.map(|value| if value.is_finite() { json!(value) } else { json!(value.to_string()) }),
        "srgb": linear.map(crate::output::srgb8),
    })
}
