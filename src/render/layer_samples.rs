//! Layers that count or compare the samples of a pixel: how many different shapes they meet, how many there are, and how
//! far their mean may be off. Input: a scene, and backends or its picture. Output: one number a pixel.

use super::aov::Aov;
use super::layers::lightless;
use super::picture::{On, Options, Picture, render_scene};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::layer::{Channel, Layer};
use crate::core::progress::{Progress, SubProgress};
use crate::core::range::{Range, Rect};
use crate::sampling::Backend;
use crate::scene::model::{Footprint, Pattern, PixelFilter, Quantity, Scene};

/// More different shapes in a pixel count as so many.
pub const MAX_SURFACES: usize = 8;
/// Samples that look for shapes: those of the scene, at most so many; or so many of another pattern, if the scene has
/// fewer than the least number.
const MAX_LOOKING: u32 = 64;
const LOOKING: u32 = 16;
const MIN_LOOKING: u32 = 4;
/// Rows of the picture whose samples are read together.
const ROWS: u32 = 256;

/// Returns the scene whose samples look for shapes, each within its own pixel.
pub(super) fn looking(scene: &Scene) -> Scene {
    let mut scene = lightless(scene);
    scene.pixel_filter = PixelFilter::default();
    let sampling = &mut scene.sampling;
    (sampling.footprint, sampling.quantity) = (Footprint::None, Quantity::Albedo);
    if sampling.samples() < MIN_LOOKING {
        (sampling.pattern, sampling.spp, sampling.shared) = (Pattern::SobolOwen, LOOKING, false);
    }
    sampling.spp = sampling.spp.min(MAX_LOOKING);
    scene
}

/// Returns the number of different shapes that the samples of each pixel meet, as the first of three values.
pub(super) fn count_surfaces(
    backend: &mut dyn Backend,
    [width, height]: [u32; 2],
    samples: u32,
    progress: &dyn Progress,
) -> Result<Film> {
    let mut counts = Film::new(width, height, samples);
    for pixels in Rect::whole([width, height]).strips(ROWS) {
        let mut met = vec![Vec::with_capacity(MAX_SURFACES); pixels.area()];
        for s in 0..samples {
            let done =
                (f64::from(pixels.y) + f64::from(pixels.height * s) / f64::from(samples)) / f64::from(height);
            let part = SubProgress { whole: progress, from: done, to: done };
            let sums = backend.sum(&Range { pixels, samples: s..s + 1 }, &part)?;
            for (met, [shape, ..]) in met.iter_mut().zip(sums.blocks().iter().flat_map(|block| &block.sums)) {
                if !met.contains(shape) && met.len() < MAX_SURFACES {
                    met.push(*shape);
                }
            }
        }
        let first = (pixels.y * width) as usize;
        for (pixel, met) in counts.pixels[first..].iter_mut().zip(&met) {
            *pixel = [met.len() as f32, 0.0, 1.0];
        }
    }
    Ok(counts)
}

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
