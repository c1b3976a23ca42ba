//! Packed scene → picture, in f64 on all cores. Twin of `glsl/shared/render_main.glsl`.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::beam::beam;
use super::camera::{camera_at, camera_ray, through_lens};
use super::cone_shade;
use super::footprint::camera_differential;
use super::math::xyz;
use super::patterns::pixel_points;
use super::pixel_filter::filtered_place;
use super::rng::{pcg2d, pixel_key, sample_bits};
use super::sample_dimensions::{choose, unit_square};
use super::shade::{advance, camera_path};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::pack::{PackedScene, filtered_mean};
use crate::scene::model::Algorithm;
use crate::schema::layout::Header;

/// The mean radiance of pixel (x, y) of the film: of the crop, where there is one.
pub fn pixel(scene: &PackedScene, x: u32, y: u32) -> DVec3 {
    if scene.algorithm == Algorithm::Cone {
        return cone_shade::pixel(scene, x, y).0;
    }
    let (mut sum, mut negative, mut signs) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for s in 0..scene.samples {
        let (radiance, sign) = sample(scene, &scene.header, [x, y], 0, s);
        sum += sign * radiance;
        negative += if sign < 0.0 { radiance } else { DVec3::ZERO };
        signs += sign;
    }
    let samples = f64::from(scene.samples);
    let Some(mean) = scene.mean_sign else { return sum / samples };
    DVec3::from_array([0, 1, 2].map(|c| filtered_mean(sum[c], negative[c], signs, samples, mean)))
}

/// The radiance of one sample and the pixel filter's sign there, by a header that may differ from the scene's in the samples' share of the
/// pixel. The second half of an adaptive picture has another seed.
pub fn sample(scene: &PackedScene, header: &Header, [x, y]: [u32; 2], stream: u32, s: u32) -> (DVec3, f64) {
    let place = [x + header.image[2], y + header.image[3]];
    let seed = header.sampling[3].wrapping_add(stream.wrapping_mul(0x9E37_79B9));
    let key = pixel_key(place, seed, header.key[0] != 0);
    let points = pixel_points(header, place, key);
    let dimensions = choose(header, &points, s, 0, true);
    let moves = header.chances[2] != 0;
    let [_, _, opens, open] = header.lens.map(f64::from);
    let time = opens + open * unit_square(dimensions.time).x;
    let camera = if moves { &camera_at(header, time) } else { header };
    let at = filtered_place(scene, dimensions.place);
    let mut ray = camera_ray(camera, place, at.inside);
    if header.lens[0] > 0.0 {
        ray = through_lens(camera, &ray, unit_square(dimensions.lens));
    }
    ray.time = time;
    if moves {
        ray.origin += time * xyz(header.eye_motion);
    }
    // Bits that have nothing to do with the sample's position.
    let random = pcg2d(sample_bits(key, s).map(|bits| bits ^ 0x5BD1_E995));
    let mut path = camera_path(ray, camera_differential(camera, &ray), random);
    path.points = Some((points, s));
    let mut sum = DVec3::ZERO;
    while path.is_alive {
        sum += advance(scene, &mut path);
    }
    (sum, at.sign)
}

/// The whole film.
pub fn render(scene: &PackedScene, progress: &dyn Progress) -> Result<Film> {
    if scene.beams {
        return render_beams(scene, progress).map(|(film, _)| film);
    }
    rows(scene, progress, |x, y| pixel(scene, x, y))
}

/// The whole film by beams, and how many pixels took samples.
pub fn render_beams(scene: &PackedScene, progress: &dyn Progress) -> Result<(Film, u64)> {
    let sampled = AtomicU64::new(0);
    let film = rows(scene, progress, |x, y| {
        beam(scene, [x, y]).unwrap_or_else(|| {
            sampled.fetch_add(1, Ordering::Relaxed);
            pixel(scene, x, y)
        })
    })?;
    Ok((film, sampled.into_inner()))
}

/// Rows are shared out over the cores; the result does not depend on how.
fn rows(
    scene: &PackedScene,
    progress: &dyn Progress,
    pixel: impl Fn(u32, u32) -> DVec3 + Sync,
) -> Result<Film> {
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
            *out = pixel(x as u32, y as u32).as_vec3().to_array();
        }
        let rows = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress.advance(rows as f64 / f64::from(height));
    });
    if progress.cancelled() { Err(Error::Interrupted) } else { Ok(film) }
}
