//! A pixel of a side: its value in the newest film and in the picture of it, and what it is made of. Input: a side and a
//! pixel. Output: JSON.

use std::sync::PoisonError;

use serde_json::{Value, json};

use super::inspector::Inspector;
use super::settings::Source;
use super::shown::Shown;
use super::tabs::Side;
use super::textures::Textures;
use crate::core::error::Result;
use crate::output::DisplayTransform;

/// Returns what a pixel of a side is made of.
pub fn pixel(side: &Side, source: &Source, textures: &Textures, place: [u32; 2]) -> Result<Value> {
    let refinement = &side.refinement;
    let shown = refinement.shown();
    let count = shown.as_ref().map_or(1, |shown| shown.count);
    let mut inspector = refinement.inspector.lock().unwrap_or_else(PoisonError::into_inner);
    let inspector = match &mut *inspector {
        Some(inspector) => inspector,
        empty => {
            // A file that has changed since is of another picture; meshes are then numbered as one.
            let is_same = refinement.stamp == source.stamp();
            let scene =
                if is_same { refinement.settings.load(source, true)? } else { refinement.scene.clone() };
            empty.insert(Inspector::new(scene, textures)?)
        }
    };
    let mut told = inspector.told(place, count)?;
    told["value"] = shown.map(|shown| value_of(&shown, &side.display, place)).into();
    Ok(told)
}

/// Returns the light of a film's pixel, and the numbers that the picture of it has.
fn value_of(shown: &Shown, display: &DisplayTransform, [x, y]: [u32; 2]) -> Value {
    let linear = shown.film.pixels[(y * shown.film.width + x) as usize];
    // What is not finite has no number in JSON.
    json!({
        "spp": shown.count,
        "linear": linear.map(|value| if value.is_finite() { json!(value) } else { json!(value.to_string()) }),
        "shown": display.codes(linear),
        "gamut": display.gamut.name(),
    })
}
