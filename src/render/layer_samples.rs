//! Layers of the samples of a pixel: how many there are, and how far their mean may be off. Input: a scene, or its picture.
//! Output: one number a pixel.

use super::aov::Aov;
use super::options::{On, Options};
use super::picture::{Picture, render_scene};
use crate::core::error::Result;
use crate::core::layer::{Channel, Layer};
use crate::core::progress::Progress;
use crate::scene::model::Scene;

/// Returns the layer of samples or of errors: those of an adaptive picture, the same number everywhere, or half the
/// difference of two pictures with different seeds.
pub(super) fn estimates(
    aov: Aov,
    scene: &Scene,
    options: &Options,
    on: &[On],
    picture: Option<&Picture>,
    progress: &dyn Progress,
) -> Result<Layer> {
    let [width, height] = options.crop.map_or([scene.width, scene.height], |crop| [crop.width, crop.height]);
    let numbers = |values: Vec<f32>| {
        let present = vec![true; values.len()];
        Layer { name: aov.name(), channels: vec![Channel { name: "Y", values }], present }
    };
    let adaptive = scene.sampling.algorithm.is_adaptive();
    if aov == Aov::Samples && !adaptive {
        let count = scene.sampling.samples() as f32;
        return Ok(numbers(vec![count; width as usize * height as usize]));
    }
    let own;
    let picture = match picture {
        Some(picture) => picture,
        None => {
            own = render_scene(scene, options, on, progress)?;
            &own
        }
    };
    if let Some(estimates) = &picture.estimates {
        return Ok(numbers(match aov {
            Aov::Samples => estimates.samples.iter().map(|&n| n as f32).collect(),
            _ => estimates.errors.clone(),
        }));
    }
    let mut again = scene.clone();
    again.sampling.seed = scene.sampling.seed.wrapping_add(1);
    let again = render_scene(&again, options, on, progress)?;
    let error = |(a, b): (&[f32; 3], &[f32; 3])| {
        let squares: f32 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
        // The mean over channels, and half of it for each of the two pictures.
        (squares / 6.0).sqrt()
    };
    Ok(numbers(picture.film.pixels.iter().zip(&again.film.pixels).map(error).collect()))
}
