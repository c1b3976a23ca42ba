//! Packed scene → picture, in f64 on all cores. Twin of `glsl/shared/render_main.glsl`.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::camera::camera_ray;
use super::footprint::camera_beam;
use super::rng::{pcg2d, pixel_key, sample_bits};
use super::shade::{advance, camera_path};
use super::strata::sample_position;
use crate::error::{Error, Result};
use crate::film::Film;
use crate::pack::PackedScene;
use crate::progress::Progress;
use crate::scene::model::Pattern;

/// The mean radiance of pixel (x, y) of the film: of the crop, where there is one.
pub fn pixel(scene: &PackedScene, x: u32, y: u32) -> DVec3 {
    let header = &scene.header;
    let [pattern, side, side_log2, seed] = header.sampling;
    let pattern = Pattern::ALL[pattern as usize];
    let place = [x + header.image[2], y + header.image[3]];
    let key = pixel_key(place, seed, header.key[0] != 0);
    let mut sum = DVec3::ZERO;
    for s in 0..scene.samples {
        let position = sample_position(pattern, key, s, side, side_log2);
        let ray = camera_ray(header, place, position);
        // Bits that have nothing to do with the sample's position.
        let random = pcg2d(sample_bits(key, s).map(|bits| bits ^ 0x5BD1_E995));
        let mut path = camera_path(ray, camera_beam(header, &ray), random);
        while path.goes_on {
            sum += advance(scene, &mut path);
        }
    }
    sum / f64::from(scene.samples)
}

/// The whole film. Rows are shared out over the cores; the result does not depend on how.
pub fn render(scene: &PackedScene, progress: &dyn Progress) -> Result<Film> {
    if let Some(&texture) = scene.device_levels.first() {
        return Err(Error::new(format!(
            "the levels of texture \"{}\" are left to a device: the oracle reads what the host made",
            scene.texture_names[texture]
        )));
    }
    let [width, height, _, _] = scene.header.size;
    let mut film = Film::new(width, height, scene.samples);
    let done = AtomicUsize::new(0);
    film.pixels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
        for (x, out) in row.iter_mut().enumerate() {
            // A row can take minutes where a pixel has very many samples.
            if progress.cancelled() {
                return;
            }
            *out = pixel(scene, x as u32, y as u32).as_vec3().to_array();
        }
        let rows = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress.advance(rows as f64 / f64::from(height));
    });
    if progress.cancelled() { Err(Error::Interrupted) } else { Ok(film) }
}
