//! Packed scene → sums of samples and means of pixels, in f64. Twin of `glsl/shared/render_main.glsl`.

use std::ops;

use glam::DVec3;

use super::camera::{camera_at, camera_ray, through_lens};
use super::cone_shade;
use super::footprint::camera_differential;
use super::patterns::pixel_points;
use super::pixel_filter::filtered_place;
use super::rng::{pcg2d, pixel_key, sample_bits};
use super::sample_dimensions::{choose, unit_square};
use super::shade::{advance, camera_path};
use crate::pack::{PackedScene, filtered_mean};
use crate::scene::model::Algorithm;
use crate::schema::layout::Header;

/// The sums of a pixel's samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSums {
    /// Sum of radiance, each sample with the sign of the pixel filter at its position.
    pub sum: DVec3,
    /// Sum of the mean of the squared channels.
    pub squares: f64,
    /// Sum of radiance where the sign is negative, without the sign.
    pub negative: DVec3,
    pub signs: f64,
}

/// Sums samples of a pixel, one after the other; the header may differ from the scene's in the samples' share of the
/// pixel.
pub fn sums(
    scene: &PackedScene,
    header: &Header,
    place: [u32; 2],
    stream: u32,
    of: ops::Range<u32>,
) -> PixelSums {
    let mut sums = PixelSums::default();
    for s in of {
        let (radiance, sign) = sample(scene, header, place, stream, s);
        sums.sum += sign * radiance;
        sums.squares += radiance.length_squared() / 3.0;
        sums.negative += if sign < 0.0 { radiance } else { DVec3::ZERO };
        sums.signs += sign;
    }
    sums
}

/// Returns the mean radiance of pixel (x, y) of the film, that is of the crop if there is one.
pub fn pixel(scene: &PackedScene, x: u32, y: u32) -> DVec3 {
    if scene.algorithm == Algorithm::Cone {
        return cone_shade::pixel(scene, x, y).0;
    }
    let PixelSums { sum, negative, signs, .. } = sums(scene, &scene.header, [x, y], 0, 0..scene.samples);
    let samples = f64::from(scene.samples);
    let Some(mean) = scene.mean_sign else { return sum / samples };
    DVec3::from_array([0, 1, 2].map(|c| filtered_mean(sum[c], negative[c], signs, samples, mean)))
}

/// Returns the radiance of one sample and the pixel filter's sign; the header may differ from the scene's in the
/// samples' share of the pixel. The second half of an adaptive picture has a different seed.
pub fn sample(scene: &PackedScene, header: &Header, [x, y]: [u32; 2], stream: u32, s: u32) -> (DVec3, f64) {
    let place = [x + header.crop.x, y + header.crop.y];
    let seed = header.seed.wrapping_add(stream.wrapping_mul(0x9E37_79B9));
    let key = pixel_key(place, seed, header.shares_pattern);
    let points = pixel_points(header, place, key);
    let dimensions = choose(header, &points, s, 0, true);
    let moves = header.camera_moves;
    let [opens, open] = [header.shutter_opens, header.shutter_time].map(f64::from);
    let time = opens + open * unit_square(dimensions.time).x;
    let camera = if moves { &camera_at(header, time) } else { header };
    let at = filtered_place(scene, dimensions.place);
    let mut ray = camera_ray(camera, place, at.inside);
    if header.lens_radius > 0.0 {
        ray = through_lens(camera, &ray, unit_square(dimensions.lens));
    }
    ray.time = time;
    if moves {
        ray.origin += time * header.eye_motion;
    }
    // Bits that are independent of the sample's position.
    let random = pcg2d(sample_bits(key, s).map(|bits| bits ^ 0x5BD1_E995));
    let mut path = camera_path(ray, camera_differential(camera, &ray), random);
    path.points = Some((points, s));
    let mut sum = DVec3::ZERO;
    while path.is_alive {
        sum += advance(scene, &mut path);
    }
    (sum, at.sign)
}
